//! The steady motion near the start, and its stability, in words.

use pc_analysis::{NearbySteadyMotion, SteadySearch};
use pc_print::{eigenvalues_in_words, short, stability_in_words, wrapped};
use serde_json::{Map, Value, json};

/// The state of a steady motion, its distance from the start, its eigenvalues and the verdict, on lines of
/// `width` characters.
fn motion_lines(steady: &NearbySteadyMotion, width: usize) -> Vec<String> {
    let assigned = |name: &str, value: f64| format!("{name} = {}", rounded(value));
    let state = steady.state.iter().map(|(name, value)| assigned(name, *value));
    let rates = steady.rates.iter().map(|(name, rate)| assigned(&format!("{name}'"), *rate));
    let mut lines = wrapped(state.chain(rates), width);
    lines.push(match (rounded(steady.distance).as_str(), steady.same.as_slice()) {
        ("0", _) => "the start itself".to_owned(),
        (_, []) => format!("{} from the start", short(steady.distance, 3)),
        (_, same) => format!("{} from the start, with its {}", short(steady.distance, 3), same.join(", ")),
    });
    let eigenvalues =
        wrapped(eigenvalues_in_words(&steady.eigenvalues, steady.tolerance.max(ZERO)), width - 12);
    lines.extend((0..).zip(eigenvalues).map(|(i, line)| match i {
        0 => format!("eigenvalues {line}"),
        _ => format!("            {line}"),
    }));
    lines.push(stability_in_words(&steady.stability()));
    lines
}

fn motion_object(steady: &NearbySteadyMotion) -> Value {
    let map = |pairs: &[(String, f64)]| -> Map<String, Value> {
        pairs.iter().map(|(name, value)| (name.clone(), json!(value))).collect()
    };
    json!({
        "state": map(&steady.state),
        "rates": map(&steady.rates),
        "distance": steady.distance,
        "same": steady.same,
        "eigenvalues": steady.eigenvalues.iter().map(|l| [l.real, l.imaginary]).collect::<Vec<_>>(),
        "first_approximation": steady.first_approximation.to_string(),
        "second_variation": steady.second_variation.as_ref().map(|second| second.verdict.to_string()),
        "verdict": stability_in_words(&steady.stability()),
    })
}

/// The reason why there is no motion to describe; none if one was found.
fn missing(search: &SteadySearch) -> Option<String> {
    Some(match search {
        SteadySearch::NotAutonomous => "not looked for: the equations depend on time".to_owned(),
        SteadySearch::SurfaceUnknown => {
            "not looked for: the functions of the coordinates that the frame keeps are unknown".to_owned()
        }
        SteadySearch::Nonlinear => "not looked for: a constraint is not affine in the velocities".to_owned(),
        SteadySearch::TooLarge { components } => {
            format!("not looked for: {components} components of the state are too many")
        }
        SteadySearch::None => "none found near the start".to_owned(),
        SteadySearch::Found(_) => return None,
    })
}

/// The lines to print; none if no steady motion is expected.
pub(super) fn lines(search: &SteadySearch, width: usize) -> Vec<String> {
    match search {
        SteadySearch::NotAutonomous => Vec::new(),
        SteadySearch::Found(steady) => motion_lines(steady, width),
        other => missing(other).into_iter().collect(),
    }
}

/// The verdict on stability, or the reason why there is none.
pub(super) fn verdict(search: &SteadySearch) -> String {
    match search {
        SteadySearch::Found(steady) => stability_in_words(&steady.stability()),
        other => missing(other).unwrap_or_default(),
    }
}

/// The distance of the motion from the start; NaN if none was found.
pub(super) fn distance(search: &SteadySearch) -> f64 {
    match search {
        SteadySearch::Found(steady) => steady.distance,
        _ => f64::NAN,
    }
}

/// The motion as JSON; null if none was found.
pub(super) fn object(search: &SteadySearch) -> Value {
    match search {
        SteadySearch::Found(steady) => motion_object(steady),
        _ => Value::Null,
    }
}

/// Numbers up to this size count as zero: Newton's method leaves such remainders in place of zeros.
const ZERO: f64 = 1e-9;

/// A number to six digits; remainders that Newton's method leaves in place of zeros are printed as zero.
fn rounded(value: f64) -> String {
    if value.abs() <= ZERO { "0".to_owned() } else { short(value, 6) }
}
