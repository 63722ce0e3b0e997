//! Integrals that are proved to be conserved but that a computed motion has lost.

use pc_expr::Weighed;
use pc_mech::{Expr, Neighbourhood};
use pc_model::{Assembly, Flow, Variables};
use pc_print::integrals_of;

use crate::motion::lost::LostIntegral;
use crate::motion::table::Table;
use crate::plan::tolerances::Tolerances;

/// The largest drift allowed, as a fraction of the scale of the integral.
const MOST: f64 = 1e-3;

/// A drift of this many units in the last place of the terms of an integral is rounding error, as with a large
/// constant in the energy or near an equilibrium.
const ROUNDINGS: f64 = 1e3;

/// A drift is within the requested accuracy if it can be caused by errors of this many tolerances in each
/// component.
const TOLERANCES: f64 = 100.0;

/// The integrals that, if they are conserved, have drifted too far at these states of the motion; the energy
/// may be one of them.
///
/// A drift is measured not only against the scale of the integral but also against the tolerances of the components: in E =
/// e^{2γt} (p² + x²)/2 of a damped motion, the absolute tolerance of a component that has long come to rest is multiplied
/// by e^{γt}.
pub(crate) fn suspects(
    table: &Table,
    keeps_energy: bool,
    flow: &mut Flow,
    (tolerances, rtol): (&Tolerances, f64),
    states: &[(f64, &[f64])],
) -> Vec<LostIntegral> {
    let first = table.conserved().start;
    let Some(energy) = table.conserved().end.checked_sub(1) else { return Vec::new() };
    let too_far = |flow: &mut Flow, j: usize| {
        let drift = table.drift(j);
        // The value at the start is a scale of others than the energy, whose zero is arbitrary.
        if j != energy && drift.absolute <= MOST * drift.start.abs() {
            return None;
        }
        let scale = match j == energy {
            true => scale_of_energy(flow, energy - first, states),
            false => states.iter().map(|(t, y)| contributions(flow, j - first, *t, y)).fold(0.0, f64::max),
        };
        let name = table.columns()[j].clone();
        let lost = LostIntegral { name, start: drift.start, drift: drift.absolute, scale };
        if drift.start.is_finite() && !drift.absolute.is_finite() {
            return Some(lost);
        }
        let is_far = drift.absolute > MOST * scale;
        let allowed =
            |(t, y): &(f64, &[f64])| effect_of_errors(flow, j - first, (*t, y), tolerances.errors(rtol, y));
        (is_far && states.iter().map(allowed).all(|effect| drift.absolute > effect)).then_some(lost)
    };
    let wanted = |j: &usize| *j != energy || keeps_energy;
    (first..=energy).filter(wanted).filter_map(|j| too_far(flow, j)).collect()
}

/// The first of these integrals that is proved to be conserved and has drifted by more than rounding error.
pub(crate) fn lost(
    suspects: Vec<LostIntegral>,
    energy: &str,
    assembly: &Assembly<'_>,
    flow: &mut Flow,
    states: &[(f64, &[f64])],
) -> Option<LostIntegral> {
    let mut proved = proved(assembly);
    proved.push(energy.to_owned());
    suspects
        .into_iter()
        .filter(|lost| proved.contains(&lost.name))
        .find(|lost| !lost.drift.is_finite() || lost.drift > rounding(assembly, flow, &lost.name, states))
}

/// The largest kinetic energy or the range of the remaining energy, whichever is larger, found from energies with
/// and without velocities, so that constants do not count. Infinite if nothing is known, since constraints that are
/// not affine may allow no state of rest.
fn scale_of_energy(flow: &mut Flow, place: usize, states: &[(f64, &[f64])]) -> f64 {
    let (mut kinetic, mut least, mut most) = (0.0f64, f64::INFINITY, f64::NEG_INFINITY);
    for (t, y) in states {
        let mut at_rest = y.to_vec();
        at_rest[moving(flow)].fill(0.0);
        let (energy, rest) = (flow.motion.observe(*t, y)[place], flow.motion.observe(*t, &at_rest)[place]);
        if energy.is_finite() && rest.is_finite() {
            kinetic = kinetic.max((energy - rest).abs());
            (least, most) = (least.min(rest), most.max(rest));
        }
    }
    if least > most { f64::INFINITY } else { kinetic.max(most - least) }
}

/// The indices of the velocities or momenta in the state.
fn moving(flow: &Flow) -> std::ops::Range<usize> {
    let motion = &flow.motion;
    motion.coordinates()..motion.names().len() - motion.states()
}

/// The sum Σ |I(y) − I(y without one of its components)|, where a velocity is set to zero and a coordinate to
/// its value at the start.
fn contributions(flow: &mut Flow, place: usize, t: f64, y: &[f64]) -> f64 {
    let start = flow.start.clone();
    let moving = moving(flow);
    let whole = flow.motion.observe(t, y)[place];
    let mut without = y.to_vec();
    let mut sum = 0.0;
    for i in 0..y.len() {
        without[i] = if moving.contains(&i) { 0.0 } else { start[i] };
        let part = (whole - flow.motion.observe(t, &without)[place]).abs();
        sum += if part.is_finite() { part } else { 0.0 };
        without[i] = y[i];
    }
    sum
}

/// The sum Σ |I(y with an error in one component) − I(y)|, where the error is `TOLERANCES` times that in
/// `errors`.
fn effect_of_errors(flow: &mut Flow, place: usize, (t, y): (f64, &[f64]), errors: Vec<f64>) -> f64 {
    let whole = flow.motion.observe(t, y)[place];
    let mut wrong = y.to_vec();
    let mut sum = 0.0;
    for (i, error) in errors.into_iter().enumerate() {
        wrong[i] += TOLERANCES * error;
        let effect = (flow.motion.observe(t, &wrong)[place] - whole).abs();
        sum += if effect.is_finite() { effect } else { 0.0 };
        wrong[i] = y[i];
    }
    sum
}

/// The possible effect of rounding errors on an integral: a number of units in the last place of its largest
/// term, where the terms of the energy are taken to be those of the Lagrangian. Infinite where the terms cannot
/// be evaluated.
fn rounding(assembly: &Assembly<'_>, flow: &mut Flow, name: &str, states: &[(f64, &[f64])]) -> f64 {
    let system = &assembly.system;
    let declared = system.integrals().iter().find(|(known, _)| known == name);
    let function = declared.map_or_else(|| system.lagrangian(), |(_, value)| *value);
    let parameters = flow.motion.parameters().to_vec();
    let mut size = |t: f64, y: &[f64]| {
        let names: Vec<String> = flow.columns();
        let row = flow.row(t, y);
        let value = |symbol: &Expr<'_>| {
            names.iter().position(|known| *known == symbol.to_string()).map(|place| row[place])
        };
        let mut at = vec![(system.frame().time(), Weighed::rounded(t))];
        at.extend(
            system.parameters().iter().zip(&parameters).map(|((p, _), value)| (*p, Weighed::rounded(*value))),
        );
        let known = system.state().into_iter().filter_map(|symbol| Some((symbol, value(&symbol)?)));
        at.extend(known.map(|(symbol, value)| (symbol, Weighed::rounded(value))));
        system.graph().evaluate(&[function], &at).map_or(f64::INFINITY, |values| values[0].size())
    };
    ROUNDINGS * f64::EPSILON * states.iter().map(|(t, y)| size(*t, y)).fold(0.0, f64::max)
}

/// The names of the integrals of the text that are proved to be constant along the motion from the start.
fn proved(assembly: &Assembly<'_>) -> Vec<String> {
    let system = &assembly.system;
    if system.integrals().is_empty() {
        return Vec::new();
    }
    let mut centre = system.parameters().to_vec();
    centre.push((system.frame().time(), assembly.t_start));
    centre.extend(system.state().into_iter().zip(assembly.start.iter().copied()));
    let Ok((equations, _)) = assembly.equations_of(Variables::QuasiVelocities) else { return Vec::new() };
    let integrals = integrals_of(assembly, &equations, &Neighbourhood { centre }, false);
    let kept =
        integrals.list().iter().filter(|integral| integral.is_constant_from_start() && !integral.jumps);
    kept.map(|integral| integral.name.clone()).collect()
}
