//! Compares the matrices A, B, C and D with differences of the rates from a second derivation.

use pc_analysis::Linearization;
use pc_mech::Matrix;
use pc_model::{Assembly, Flow, Model, Variables};
use pc_verify::{Second, Slope, VerifyError};

use crate::error::RunError;
use crate::observer::Observer;

/// The weights of the components in the direction along which A and C are compared, used in turn: no weight is a sum of
/// others.
const WEIGHTS: [f64; 5] = [1.0, -0.77, 0.59, -0.91, 0.68];

/// Compares the matrices before they are returned: A and C along a direction of all components of the reduced
/// state, B and D along each input. If this is not possible, the observer is told so.
///
/// # Errors
/// [`RunError::Verify`] if the derivations disagree.
pub(crate) fn compare(
    model: &Model,
    assembly: &Assembly<'_>,
    linear: &Linearization,
    observer: &dyn Observer,
) -> Result<(), RunError> {
    if linear.components.is_empty() {
        return Ok(());
    }
    match outcome(model, assembly, linear) {
        Ok(()) => Ok(()),
        Err(error @ VerifyError::Disagreement(_)) => Err(RunError::Verify(Box::new(error))),
        Err(error) => {
            assembly.within_limits()?;
            observer.remark(&format!("the matrices are not compared with a second derivation: {error}"));
            Ok(())
        }
    }
}

fn outcome(model: &Model, assembly: &Assembly<'_>, linear: &Linearization) -> Result<(), VerifyError> {
    let (names, _): (Vec<String>, Vec<f64>) = linear.state.iter().cloned().unzip();
    let flow = Flow::new(model, assembly, Variables::QuasiVelocities)?;
    if flow.motion.names() == names {
        return agrees(model, assembly, &flow, linear);
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
        agrees(&chosen, assembly, &flow, linear)
    })
}

fn agrees(
    model: &Model,
    assembly: &Assembly<'_>,
    flow: &Flow,
    linear: &Linearization,
) -> Result<(), VerifyError> {
    let second = Second::new(model, assembly)?;
    let state: Vec<f64> = linear.state.iter().map(|&(_, value)| value).collect();
    slopes(linear).iter().try_for_each(|slope| {
        second.slope_agrees((model, assembly), flow, (linear.t, &state), slope).map(drop)
    })
}

/// The slopes to compare: first along the state, then along each input.
fn slopes(linear: &Linearization) -> Vec<Slope> {
    let Linearization { state_matrix: a, input_matrix: b, output_matrix: c, feedthrough: d, .. } = linear;
    let value =
        |name: &String| linear.state.iter().find(|(known, _)| known == name).map_or(0.0, |&(_, value)| value);
    let weights = WEIGHTS.into_iter().cycle();
    // In parts of each component, so that none of them is a step of many times its size.
    let size = |value: f64| if value == 0.0 { 1.0 } else { value.abs() };
    let along: Vec<f64> =
        linear.components.iter().zip(weights).map(|(name, weight)| weight * size(value(name))).collect();
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
