//! The velocity that has lost its inertia where a motion cannot continue.

use pc_algebra::Matrix;
use pc_mech::SingularValues;
use pc_model::{Assembly, Flow, Variables};

/// If the mass matrix is this close to a singular one, compared with that at the start, it is the reason why
/// steps are short.
const VANISHES: f64 = 1e-6;

/// The largest number of velocities of a model for which the mass matrix is examined.
const MOST_VELOCITIES: usize = 12;

/// The velocity in whose direction the mass matrix is nearly singular at `state`, and the fraction of its inertia that
/// is left: the ratio of the smallest singular value of D M D there to that at the start, with D² = 1/diag M at the
/// start.
pub(crate) fn lost_inertia(
    assembly: &Assembly<'_>,
    flow: &mut Flow,
    t_start: f64,
    (t, state): (f64, &[f64]),
) -> Option<(String, f64)> {
    if assembly.system.quasi_velocities().len() > MOST_VELOCITIES {
        return None;
    }
    let equations = assembly.equations_in(Variables::QuasiVelocities).ok()?;
    let system = equations.system();
    let names: Vec<String> = system.state().iter().map(ToString::to_string).collect();
    if names != flow.motion.names() {
        return None;
    }
    let mut mass = equations.functions(&equations.mass_matrix().entries(), &[]).ok()?;
    let (parameters, k) = (flow.motion.parameters().to_vec(), system.quasi_velocities().len());
    let mut at = |t: f64, state: &[f64]| {
        let mut values = vec![f64::NAN; k * k];
        mass.eval(t, state, &parameters, &mut values);
        values
    };
    // Sensitivities follow the state.
    let (first, here) = (at(t_start, &flow.start), at(t, state.get(..flow.start.len())?));
    let unit = |i: usize| first[i * k + i].abs().sqrt();
    let scaled = |m: &[f64]| {
        SingularValues::of(&Matrix::from_fn(k, k, |i, j| m[i * k + j] / (unit(i) * unit(j)))).ok()
    };
    let (first, here) = (scaled(&first)?, scaled(&here)?);
    let part = here.values.last()? / first.values.last()?;
    let direction = |i: &usize| here.right[(*i, k - 1)].abs();
    let velocity = (0..k).max_by(|i, j| direction(i).total_cmp(&direction(j)))?;
    (part < VANISHES).then(|| (system.quasi_velocities()[velocity].to_string(), part))
}
