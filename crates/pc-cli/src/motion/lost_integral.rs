//! Integrals that are proved to be kept, and that a computed motion has lost all the same.

use pc_mech::Neighbourhood;
use pc_model::{Assembly, Flow, Variables};
use pc_print::integrals_of;

use crate::motion::table::Table;

/// The part of its scale by which an integral may drift.
const MOST: f64 = 1e-3;

/// A drift of so many units in the last place of the integral is rounding, as under a large constant in the energy.
const ROUNDINGS: f64 = 1e3;

/// An integral that is proved to be kept, and has changed.
#[derive(Clone, Debug, PartialEq)]
pub struct LostIntegral {
    /// Its name.
    pub name: String,
    /// Its value at the start.
    pub start: f64,
    /// The largest change from it.
    pub drift: f64,
    /// The scale of its terms, which change by more than this along the motion.
    pub scale: f64,
}

/// The largest kinetic energy along a motion and the range of the rest, from energies with and without velocities:
/// constants of the energy are no part of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EnergyScale {
    kinetic: f64,
    least: f64,
    most: f64,
}

impl EnergyScale {
    pub(crate) fn new() -> EnergyScale {
        EnergyScale { kinetic: 0.0, least: f64::INFINITY, most: f64::NEG_INFINITY }
    }

    /// Takes the state y at t into account.
    pub(crate) fn note(&mut self, flow: &mut Flow, t: f64, y: &[f64]) {
        let mut at_rest = y.to_vec();
        at_rest[moving(flow)].fill(0.0);
        let (Some(energy), Some(rest)) = (energy(flow, t, y), energy(flow, t, &at_rest)) else { return };
        self.kinetic = self.kinetic.max((energy - rest).abs());
        (self.least, self.most) = (self.least.min(rest), self.most.max(rest));
    }

    fn size(&self) -> f64 {
        self.kinetic.max(self.most - self.least)
    }
}

/// The places of the velocities or momenta in the state.
fn moving(flow: &Flow) -> std::ops::Range<usize> {
    let motion = &flow.motion;
    motion.coordinates()..motion.names().len() - motion.states()
}

fn energy(flow: &mut Flow, t: f64, y: &[f64]) -> Option<f64> {
    let place = flow.motion.conserved_len().checked_sub(1)?;
    flow.motion.observe(t, y).get(place).copied()
}

/// The energy, if it has drifted too far.
pub(crate) fn lost_energy(table: &Table, scale: &EnergyScale) -> Option<LostIntegral> {
    lost(table, table.conserved().end.checked_sub(1)?, scale.size())
}

/// The first of the integrals of the text that has drifted too far and is proved to be kept. Their scale is that of
/// what each coordinate since the start, and each velocity, contributes to them at these states.
pub(crate) fn lost_declared(
    table: &Table,
    assembly: &Assembly<'_>,
    flow: &mut Flow,
    states: &[(f64, &[f64])],
) -> Option<LostIntegral> {
    let declared = table.conserved().start..table.conserved().end.checked_sub(1)?;
    let too_far = |flow: &mut Flow, j: usize| {
        let lost = lost(table, j, table.drift(j).start.abs())?;
        let place = j - table.conserved().start;
        let scale = states.iter().map(|(t, y)| contributions(flow, place, *t, y)).fold(lost.scale, f64::max);
        (lost.drift > MOST * scale).then_some(LostIntegral { scale, ..lost })
    };
    let found: Vec<LostIntegral> = declared.filter_map(|j| too_far(flow, j)).collect();
    if found.is_empty() {
        return None;
    }
    let proved = proved(assembly);
    found.into_iter().find(|lost| proved.contains(&lost.name))
}

fn lost(table: &Table, j: usize, scale: f64) -> Option<LostIntegral> {
    let drift = table.drift(j);
    let rounding = ROUNDINGS * f64::EPSILON * (drift.start.abs() + drift.absolute);
    let is_lost = drift.absolute > MOST * scale && drift.absolute > rounding;
    let name = table.columns()[j].clone();
    is_lost.then_some(LostIntegral { name, start: drift.start, drift: drift.absolute, scale })
}

/// Σ |I(y) − I(y without one of its components)|
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

/// The names of the integrals that are proved to be kept everywhere.
fn proved(assembly: &Assembly<'_>) -> Vec<String> {
    let system = &assembly.system;
    let mut centre = system.parameters().to_vec();
    centre.push((system.frame().time(), assembly.t_start));
    centre.extend(system.state().into_iter().zip(assembly.start.iter().copied()));
    let Ok((equations, _)) = assembly.equations_of(Variables::QuasiVelocities) else { return Vec::new() };
    let integrals = integrals_of(assembly, &equations, &Neighbourhood { centre }, false);
    let kept = integrals.list().iter().filter(|integral| integral.is_conserved() && !integral.jumps);
    kept.map(|integral| integral.name.clone()).collect()
}
