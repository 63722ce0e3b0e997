//! The steady motion near the start, and its stability.

use pc_analysis::{AnalysisError, Integrals, Linearization, Stability, SteadyOptions};
use pc_mech::{Equations, Expr};
use pc_model::Assembly;
use pc_print::{LinearModel, eigenvalues_in_words, short, stability_in_words, wrapped};
use serde_json::{Map, Value, json};

/// The largest number of components of the state: each step decomposes a full matrix of that size, which beyond this takes some
/// tenths of a second.
const MOST_COMPONENTS: usize = 200;

/// The result of the search.
#[derive(Clone, Debug)]
pub(super) enum SteadyFinding {
    NotAutonomous,
    /// A function has no value.
    NoValue {
        function: String,
    },
    /// Fewer functions of the coordinates are known than the frame keeps: a solution might be unreachable.
    LeafUnknown,
    TooLarge {
        components: usize,
    },
    /// The equations are long.
    TooLong,
    None,
    Found(Box<NearbySteadyMotion>),
}

/// An equilibrium or a steady motion near the start.
#[derive(Clone, Debug)]
pub(super) struct NearbySteadyMotion {
    linear: Linearization,
    stability: Stability,
    /// The cyclic coordinates whose rates are not constant.
    varying: Vec<String>,
    /// The integrals that have the same values as at the start.
    same: Vec<String>,
}

/// Values of an integral that differ by this fraction are the same.
const SAME: f64 = 1e-9;

/// The steady motion near the start of a model: the same as that of its linear theory.
pub(super) fn near_start<'g>(
    assembly: &Assembly<'g>,
    equations: &Equations<'g>,
    integrals: &Integrals<'g>,
) -> SteadyFinding {
    if let Some(function) = assembly.undetermined_functions().into_iter().next() {
        return SteadyFinding::NoValue { function };
    }
    if assembly.start.len() > MOST_COMPONENTS {
        return SteadyFinding::TooLarge { components: assembly.start.len() };
    }
    let Ok(mut model) = LinearModel::of(assembly, equations, || integrals.clone(), &[]) else {
        return SteadyFinding::None;
    };
    let conserved = model.conserved(equations, integrals);
    model.linearizer.until(equations.system().graph().budget().deadline());
    let found = model.linearizer.steady(assembly.t_start, &model.start, &SteadyOptions::default());
    let found = found.and_then(|linear| {
        let stability = model.linearizer.stability(&linear, &conserved)?;
        Ok((linear, stability))
    });
    match found {
        Err(AnalysisError::DependsOnTime) => SteadyFinding::NotAutonomous,
        Err(AnalysisError::LeafUnknown { .. }) => SteadyFinding::LeafUnknown,
        Err(_) => SteadyFinding::None,
        Ok((linear, stability)) => {
            let same = same(assembly, equations, integrals, &linear);
            let varying = model.linearizer.varying_rates();
            SteadyFinding::Found(Box::new(NearbySteadyMotion { linear, stability, varying, same }))
        }
    }
}

/// The names of the integrals, besides the energy, that have the same values in a steady motion as at the start.
fn same<'g>(
    assembly: &Assembly<'g>,
    equations: &Equations<'g>,
    integrals: &Integrals<'g>,
    steady: &Linearization,
) -> Vec<String> {
    let system = equations.system();
    let (state, parameters) = (system.state(), system.parameters());
    let start = assembly.start_of(&state);
    let named = |y: &Expr<'g>| steady.state.iter().find(|(name, _)| *name == y.to_string());
    let there: Vec<f64> = state.iter().filter_map(named).map(|&(_, value)| value).collect();
    let left_out = |y: &Expr<'g>| steady.cyclic.iter().any(|(name, _)| *name == y.to_string());
    let left_out: Vec<Expr<'g>> =
        state.iter().copied().filter(left_out).chain([system.frame().time()]).collect();
    let value = |f: Expr<'g>, at: &[f64]| {
        let at: Vec<_> =
            state.iter().copied().zip(at.iter().copied()).chain(parameters.iter().copied()).collect();
        system.graph().evaluate(&[f], &at).map_or(f64::NAN, |values| values[0])
    };
    let is_same = |f: Expr<'g>| {
        let (before, now) = (value(f, &start), value(f, &there));
        (before - now).abs() <= SAME * (1.0 + before.abs())
    };
    let kept = integrals.list().iter().filter(|integral| integral.is_conserved() && !integral.is_energy());
    let of_others = kept.filter(|integral| !left_out.iter().any(|&y| integral.value.depends_on(y)));
    of_others.filter(|integral| is_same(integral.value)).map(|integral| integral.name.clone()).collect()
}

impl NearbySteadyMotion {
    /// The components that are not cyclic.
    fn state(&self) -> impl Iterator<Item = &(String, f64)> {
        let is_cyclic = |name: &String| self.linear.cyclic.iter().any(|(cyclic, _)| cyclic == name);
        self.linear.state.iter().filter(move |(name, _)| !is_cyclic(name))
    }

    /// The cyclic coordinates with their constant rates, except where these are components of the state.
    fn rates(&self) -> impl Iterator<Item = &(String, f64)> {
        let is_component = |name: &str| self.linear.state.iter().any(|(y, _)| *y == format!("{name}'"));
        let is_own = move |name: &String| !is_component(name) && !self.varying.contains(name);
        self.linear.cyclic.iter().filter(move |(name, _)| is_own(name))
    }

    /// The lines to print, of `width` characters.
    fn lines(&self, width: usize) -> Vec<String> {
        let assigned = |name: &str, value: f64| format!("{name} = {}", rounded(value));
        let state = self.state().map(|(name, value)| assigned(name, *value));
        let rates = self.rates().map(|(name, rate)| assigned(&format!("{name}'"), *rate));
        let mut lines = wrapped(state.chain(rates), width);
        let distance = self.linear.distance;
        lines.push(match (rounded(distance).as_str(), self.same.as_slice()) {
            ("0", _) => "the start itself".to_owned(),
            (_, []) => format!("{} from the start", short(distance, 3)),
            (_, same) => format!("{} from the start, with its {}", short(distance, 3), same.join(", ")),
        });
        let eigenvalues = eigenvalues_in_words(self.linear.spectrum.eigenvalues(), 0.0);
        lines.extend((0..).zip(wrapped(eigenvalues, width - 12)).map(|(i, line)| match i {
            0 => format!("eigenvalues {line}"),
            _ => format!("            {line}"),
        }));
        lines.push(stability_in_words(&self.stability));
        lines
    }

    fn object(&self) -> Value {
        let map = |pairs: &mut dyn Iterator<Item = &(String, f64)>| -> Map<String, Value> {
            pairs.map(|(name, value)| (name.clone(), json!(value))).collect()
        };
        let spectrum = &self.linear.spectrum;
        json!({
            "state": map(&mut self.state()),
            "rates": map(&mut self.rates()),
            "distance": self.linear.distance,
            "same": self.same,
            "eigenvalues": spectrum.eigenvalues().iter().map(|l| [l.real, l.imaginary]).collect::<Vec<_>>(),
            "first_approximation": spectrum.verdict().to_string(),
            "verdict": stability_in_words(&self.stability),
        })
    }
}

/// The linear theory of the motion, if one was found.
pub(super) fn linearization(found: &SteadyFinding) -> Option<&Linearization> {
    match found {
        SteadyFinding::Found(steady) => Some(&steady.linear),
        _ => None,
    }
}

/// The reason why there is no motion to describe; none if one was found.
fn missing(found: &SteadyFinding) -> Option<String> {
    Some(match found {
        SteadyFinding::NotAutonomous => "not looked for: the model depends on time".to_owned(),
        SteadyFinding::NoValue { function } => format!("not looked for: `{function}` has no value"),
        SteadyFinding::LeafUnknown => {
            "not looked for: the functions of the coordinates that the frame keeps are unknown".to_owned()
        }
        SteadyFinding::TooLarge { components } => {
            format!("not looked for: {components} components of the state are too many")
        }
        SteadyFinding::TooLong => "not looked for: the equations are long".to_owned(),
        SteadyFinding::None => "none found near the start".to_owned(),
        SteadyFinding::Found(_) => return None,
    })
}

/// The lines to print.
pub(super) fn lines(found: &SteadyFinding, width: usize) -> Vec<String> {
    match found {
        SteadyFinding::Found(steady) => steady.lines(width),
        other => missing(other).into_iter().collect(),
    }
}

/// The verdict on stability, or the reason why there is none.
pub(super) fn verdict(found: &SteadyFinding) -> String {
    match found {
        SteadyFinding::Found(steady) => stability_in_words(&steady.stability),
        other => missing(other).unwrap_or_default(),
    }
}

/// The distance of the motion from the start; NaN if none was found.
pub(super) fn distance(found: &SteadyFinding) -> f64 {
    match found {
        SteadyFinding::Found(steady) => steady.linear.distance,
        _ => f64::NAN,
    }
}

/// The motion as JSON; null if none was found.
pub(super) fn object(found: &SteadyFinding) -> Value {
    match found {
        SteadyFinding::Found(steady) => steady.object(),
        _ => Value::Null,
    }
}

/// Numbers up to this size count as zero: Newton's method leaves such remainders in place of zeros.
const ZERO: f64 = 1e-9;

/// A number to six digits; remainders that Newton's method leaves in place of zeros are printed as zero.
fn rounded(value: f64) -> String {
    if value.abs() <= ZERO { "0".to_owned() } else { short(value, 6) }
}
