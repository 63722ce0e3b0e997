//! The conserved quantities, in words.

use pc_analysis::{ConservationVerdict, Integral, Origin};
use pc_mech::{Identity, Style};
use pc_print::{columns, level_in_words, short};
use serde_json::{Value, json};

/// A formula wider than this, in columns, is not printed after the verdict.
const WIDEST: usize = 100;

/// What is said of a function that is not conserved although its rate vanishes at the start.
const CHANGES_LATER: &str = ", though it does not change at the start";

/// The origin of an integral, in words.
fn how(origin: &Origin) -> &'static str {
    match origin {
        Origin::Declared => "declared",
        Origin::DeclaredCasimir => "declared; a Casimir",
        Origin::Energy => "energy",
        Origin::EnergyOfAll => "energy of all velocities",
        Origin::CyclicDisplacement { .. } => "cyclic displacement",
        Origin::Casimir => "Casimir",
        Origin::Found => "found",
    }
}

/// The verdict in words, with the level on which the function is conserved.
fn words(integral: &Integral<'_>) -> String {
    let verdict = verdict_in_words(integral.verdict, integral.jumps);
    match (level_in_words(integral), integral.verdict) {
        (None, _) => verdict,
        (Some(level), ConservationVerdict::OnLevel { always }) => {
            let between = if integral.jumps { " between events" } else { "" };
            let here = if always { "" } else { " for these parameters" };
            format!("conserved{between}{here} where {level}, as at the start (proved)")
        }
        (Some(level), _) => format!("{verdict}; conserved where {level} (proved)"),
    }
}

/// The verdict in words; `jumps` says whether an event may change the integral.
fn verdict_in_words(verdict: ConservationVerdict<'_>, jumps: bool) -> String {
    let between = if jumps { " between events" } else { "" };
    match verdict {
        ConservationVerdict::Conserved => format!("conserved{between} (proved)"),
        ConservationVerdict::ConservedHere => format!("conserved{between} for these parameters (proved)"),
        ConservationVerdict::BetweenJumps => "conserved where it does not jump (proved)".to_owned(),
        ConservationVerdict::OnLevel { .. } => format!("conserved{between} on a level (proved)"),
        ConservationVerdict::NoFunction => {
            "not decided: it is not a function of time and state alone".to_owned()
        }
        ConservationVerdict::Rate { at_start: Some(rate), part_left: Some(left), .. }
            if matches!(Identity::of(left), Identity::Disproved { .. }) =>
        {
            format!("not conserved: changes at the rate {} at the start", short(rate, 4))
        }
        ConservationVerdict::Rate { at_start: Some(_), near: Some(left), .. }
            if matches!(Identity::of(left), Identity::Disproved { .. }) =>
        {
            format!("not conserved{CHANGES_LATER}")
        }
        ConservationVerdict::Rate { at_start: Some(_), .. } => {
            "not proved to be conserved, though it does not change at the start".to_owned()
        }
        ConservationVerdict::Rate { at_start: None, .. } => "not proved to be conserved".to_owned(),
    }
}

/// The verdict, with the formula for an integral that is not declared, and that for the rate of change of the
/// energy.
pub(super) fn lines(integral: &Integral<'_>) -> Vec<String> {
    let words = words(integral);
    if let (Origin::Energy, ConservationVerdict::Rate { rate, at_start, .. }) =
        (&integral.origin, integral.verdict)
    {
        let formula = rate.display(Style::Book);
        let width = columns(&formula);
        let verdict =
            words.strip_suffix(CHANGES_LATER).map_or_else(String::new, |words| format!("{words}: "));
        let at_start = at_start.map_or_else(String::new, |rate| format!(", {} at the start", short(rate, 4)));
        let rate = format!("{verdict}dE/dt = {formula}");
        return match width {
            width if width > WIDEST => vec![words],
            _ if columns(&rate) + columns(&at_start) <= WIDEST => vec![rate + &at_start],
            _ => vec![rate, at_start.trim_start_matches(", ").to_owned()],
        };
    }
    match integral.origin {
        Origin::DeclaredCasimir => vec![format!("{words}, a Casimir")],
        Origin::CyclicDisplacement { .. } | Origin::Casimir | Origin::Found => {
            let formula = integral.value.display(Style::Book);
            let whole = format!("{words}: {formula}");
            match columns(&formula) {
                _ if columns(&whole) <= WIDEST => vec![whole],
                width if width <= WIDEST => vec![format!("{words}:"), formula],
                _ => vec![words],
            }
        }
        Origin::Declared | Origin::Energy | Origin::EnergyOfAll => vec![words],
    }
}

/// The integral as JSON.
pub(super) fn object(integral: &Integral<'_>) -> Value {
    let mut object = json!({
        "name": integral.name,
        "expression": integral.value.to_string(),
        "how": how(&integral.origin),
        "verdict": words(integral),
    });
    if let ConservationVerdict::Rate { rate, at_start, .. } = integral.verdict {
        object["rate"] = json!(rate.to_string());
        object["rate_at_start"] = json!(at_start);
    }
    object
}
