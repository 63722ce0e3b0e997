//! Compares a steady state with a second derivation, and the matrices A, B, C and D with differences of its rates.

use pc_analysis::Linearization;
use pc_mech::Matrix;
use pc_model::{Assembly, Flow, Model, Variables};
use pc_verify::{Second, Slope, VerifyError};

use crate::error::RunError;
use crate::observer::Observer;

/// The weights of the components in the direction along which A and C are compared, used in turn: no weight is a sum of
/// others.
const WEIGHTS: [f64; 5] = [1.0, -0.77, 0.59, -0.91, 0.68];

/// Compares linearizations before they are returned: the rates, reactions and outputs at their states, A and C along a
/// direction of all components of the reduced state, B and D along each input. Where this is not possible, the observer
/// is told so.
///
/// All of them have the components of one motion.
///
/// # Errors
/// [`RunError::Verify`] if the derivations disagree.
pub(crate) fn compare(
    model: &Model,
    assembly: &Assembly<'_>,
    all: &[&Linearization],
    observer: &dyn Observer,
) -> Result<(), RunError> {
    let Some(first) = all.first() else { return Ok(()) };
    let outcomes = match outcomes(model, assembly, (first, all), agrees) {
        Ok(outcomes) => outcomes,
        Err(error) => vec![Err(error)],
    };
    let count = all.len();
    let mut missing: Vec<(String, usize)> = Vec::new();
    for outcome in outcomes {
        match outcome {
            Ok(()) => {}
            Err(error @ VerifyError::Disagreement(_)) => return Err(RunError::Verify(Box::new(error))),
            Err(error) => {
                let why = error.to_string();
                match missing.iter_mut().find(|(known, _)| *known == why) {
                    Some((_, times)) => *times += 1,
                    None => missing.push((why, 1)),
                }
            }
        }
    }
    assembly.within_limits()?;
    for (why, times) in missing {
        let which = if count == 1 { String::new() } else { format!(" at {times} of {count} states") };
        observer.remark(&format!("the matrices are not compared with a second derivation{which}: {why}"));
    }
    Ok(())
}

/// Compares the rates, reactions and outputs at the state of one linearization, but not its matrices, for which differences need
/// to know how large each component is.
///
/// # Errors
/// [`VerifyError`], also where nothing can be compared.
pub(crate) fn steady_agrees(
    model: &Model,
    assembly: &Assembly<'_>,
    linear: &Linearization,
) -> Result<(), VerifyError> {
    outcomes(model, assembly, (linear, &[linear]), state_agrees)?.into_iter().collect()
}

/// A comparison of one linearization of a model in the variables of a flow.
type Comparison = fn(&Second, (&Model, &Assembly<'_>), &Flow, &Linearization) -> Result<(), VerifyError>;

fn outcomes(
    model: &Model,
    assembly: &Assembly<'_>,
    (first, all): (&Linearization, &[&Linearization]),
    compared: Comparison,
) -> Result<Vec<Result<(), VerifyError>>, VerifyError> {
    let (names, _): (Vec<String>, Vec<f64>) = first.state.iter().cloned().unzip();
    let each = |model: &Model, assembly: &Assembly<'_>, flow: &Flow| {
        let second = Second::new(model, assembly)?;
        let outcomes = all.iter().map(|linear| compared(&second, (model, assembly), flow, linear));
        Ok(outcomes.collect())
    };
    let flow = Flow::new(model, assembly, Variables::QuasiVelocities)?;
    if flow.motion.names() == names {
        return each(model, assembly, &flow);
    }
    // Constraints that a motion holds by multipliers leave these velocities independent.
    let system = &assembly.system;
    let others = system.frame().coordinates().iter().chain(system.states().iter().map(|(z, _)| z));
    let others: Vec<String> = others.map(ToString::to_string).collect();
    let mut chosen = model.clone();
    chosen.choose_independent(names.iter().filter(|name| !others.contains(name)).cloned());
    chosen.derived(|assembly| {
        let flow = Flow::new(&chosen, assembly, Variables::QuasiVelocities)?;
        if flow.motion.names() != names {
            let reason = "the motion has other variables".to_owned();
            return Err(VerifyError::NothingCompared { tried: 1, reason });
        }
        each(&chosen, assembly, &flow)
    })
}

fn state_agrees(
    second: &Second,
    (_, assembly): (&Model, &Assembly<'_>),
    flow: &Flow,
    linear: &Linearization,
) -> Result<(), VerifyError> {
    let state: Vec<f64> = linear.state.iter().map(|&(_, value)| value).collect();
    second.agrees("poincare", flow, assembly, linear.t, &state).map(drop)
}

fn agrees(
    second: &Second,
    (model, assembly): (&Model, &Assembly<'_>),
    flow: &Flow,
    linear: &Linearization,
) -> Result<(), VerifyError> {
    state_agrees(second, (model, assembly), flow, linear)?;
    let state: Vec<f64> = linear.state.iter().map(|&(_, value)| value).collect();
    if linear.components.is_empty() {
        return Ok(());
    }
    slopes(second, linear).iter().try_for_each(|slope| {
        second.slope_agrees((model, assembly), flow, (linear.t, &state), slope).map(drop)
    })
}

/// The slopes to compare: first along the state, then along each input.
fn slopes(second: &Second, linear: &Linearization) -> Vec<Slope> {
    let Linearization { state_matrix: a, input_matrix: b, output_matrix: c, feedthrough: d, .. } = linear;
    let value =
        |name: &String| linear.state.iter().find(|(known, _)| known == name).map_or(0.0, |&(_, value)| value);
    let weights = WEIGHTS.into_iter().cycle();
    // In parts of each component, so that none of them is a step of many times its size.
    let size = |name: &String| second.size(name, value(name));
    let along: Vec<f64> =
        linear.components.iter().zip(weights).map(|(name, weight)| weight * size(name)).collect();
    let mut slopes = vec![Slope {
        name: "the derivative by the state".to_owned(),
        state: times(&linear.extension, &along),
        parameters: Vec::new(),
        rates: named(&linear.components, times(a, &along)),
        observed: named(&linear.outputs, times(c, &along)),
    }];
    slopes.extend(linear.inputs.iter().enumerate().map(|(j, input)| Slope {
        name: format!("the derivative by {input}"),
        state: vec![0.0; linear.state.len()],
        parameters: vec![(input.clone(), 1.0)],
        rates: named(&linear.components, b.column(j)),
        observed: named(&linear.outputs, d.column(j)),
    }));
    slopes
}

fn times(matrix: &Matrix<f64>, vector: &[f64]) -> Vec<f64> {
    (0..matrix.rows()).map(|i| matrix.row(i).iter().zip(vector).map(|(entry, x)| entry * x).sum()).collect()
}

fn named(names: &[String], values: impl IntoIterator<Item = f64>) -> Vec<(String, f64)> {
    names.iter().cloned().zip(values).collect()
}
