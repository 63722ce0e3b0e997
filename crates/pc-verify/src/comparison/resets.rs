//! States after resets, compared with the definitions of the text.

use pc_mech::VectorField;
use pc_model::{Flow, Model};

use crate::comparison::agreement::Agreement;
use crate::comparison::second::Second;
use crate::derivation::place::Place;
use crate::error::{Disagreement, Irregular, VerifyError};
use crate::numbers::rounding::{Rounding, within};
use crate::text::term::Term;

/// The tolerance for a reset: it takes some operations, and then the state is projected so that quaternions
/// have length 1.
const APART: f64 = 1e-12;
/// Velocities are projected onto constraints to within this fraction of their terms: rounding errors of
/// positions rotate the constraints.
const OFF: f64 = 1e-9;

/// Stops whose gap is at most this fraction of the way between the ends are reached.
const REACHED: f64 = 1.1e-9;

/// The effect of an event on a state.
#[derive(Clone, Copy, Debug)]
pub struct Jump<'a> {
    /// The name of the event.
    pub event: &'a str,
    /// When.
    pub t: f64,
    /// The state y⁻ of the flow before the event.
    pub before: &'a [f64],
    /// y⁺
    pub after: &'a [f64],
}

impl Second {
    /// Compares the state after an event with the definitions of its reset, evaluated at the state before the event:
    /// names that are reset have their new values, and coordinates and first-order states that are not reset have their
    /// old ones. Under constraints, new values may be adjusted to satisfy them; then the constraints are compared
    /// instead.
    ///
    /// # Errors
    /// As for [`verify`](crate::verify).
    pub fn reset_agrees(
        &self,
        model: &Model,
        flow: &Flow,
        jump: &Jump<'_>,
    ) -> Result<Agreement, VerifyError> {
        let mut agreement = self.nothing_yet();
        if flow.motion.breaks().contains(&jump.t) {
            return Err(VerifyError::NothingCompared {
                tried: 1,
                reason: "a table has a break there".to_owned(),
            });
        }
        match self.pairs(model, flow, jump) {
            Ok(pairs) => {
                for (label, first, second, size) in pairs {
                    let error = (first - second).abs() / if size > 0.0 { size } else { 1.0 };
                    if !within(error, APART) {
                        return Err(self.other(jump, flow, label, (first, second, size)));
                    }
                    agreement.note(error, &label);
                }
                agreement.states = 1;
                Ok(agreement)
            }
            Err(Irregular::Unable(unable)) => Err(unable.into()),
            Err(irregular) => Err(VerifyError::NothingCompared { tried: 1, reason: irregular.to_string() }),
        }
    }

    fn other(
        &self,
        jump: &Jump<'_>,
        flow: &Flow,
        label: String,
        (first, second, size): (f64, f64, f64),
    ) -> VerifyError {
        let row = self.row(&mut flow.clone(), jump.t, jump.before);
        let names = self.derivation.text.names.coordinates.iter().chain(&self.columns);
        VerifyError::Disagreement(Box::new(Disagreement {
            form: format!("after the event {}", jump.event),
            quantity: label,
            first,
            second,
            size,
            t: jump.t,
            state: names.cloned().zip(row).collect(),
        }))
    }

    /// Labels, each with the value of the first derivation, the value from the text, and the size of both.
    fn pairs(
        &self,
        model: &Model,
        flow: &Flow,
        jump: &Jump<'_>,
    ) -> Result<Vec<(String, f64, f64, f64)>, Irregular> {
        let place = |state: &[f64]| self.place(jump.t, &self.row(&mut flow.clone(), jump.t, state));
        let (before, after) = (place(jump.before)?, place(jump.after)?);
        let names = &self.derivation.text.names;
        if !names.constraints.is_empty() {
            let all: Vec<usize> = (0..names.constraints.len()).collect();
            let residuals = self.derivation.constraints(&all, &after, &Rounding::none())?;
            let rows = self.derivation.constraint_matrix(&all, &after, &Rounding::none())?;
            // After a stop velocities are the rounding of those before.
            let fastest = largest(&before.w).max(largest(&after.w)) * OFF / APART;
            let pair = |(name, (residual, row)): (&String, (f64, Vec<f64>))| {
                let size = fastest * row.iter().map(|entry| entry.abs()).sum::<f64>();
                (format!("the constraint {name}"), residual, 0.0, size)
            };
            return Ok(names.constraints.iter().zip(residuals.into_iter().zip(rows)).map(pair).collect());
        }
        let events = &model.document().events;
        let resets =
            events.iter().filter(|event| event.name.text == jump.event).flat_map(|event| &event.reset);
        let exact = Rounding::none();
        let at = self.derivation.still(&before, &exact);
        let mut pairs = Vec::new();
        for reset in resets.clone() {
            let value = at.value(&names.resolve(&reset.expression.ast)?)?;
            let name = &reset.name.text;
            if let Some(found) = self.named_value(&after, name)? {
                pairs.push((name.clone(), found, value, value.abs().max(found.abs())));
            }
        }
        pairs.extend(self.struck(jump, (&before, &after))?);
        let is_reset = |name: &String| resets.clone().any(|reset| reset.name.text == *name);
        let kept = |names: &[String], old: &[f64], new: &[f64]| -> Vec<(String, f64, f64, f64)> {
            let all = names.iter().zip(old.iter().zip(new)).filter(|(name, _)| !is_reset(name));
            all.map(|(name, (&old, &new))| (name.clone(), new, old, old.abs().max(largest(&before.x))))
                .collect()
        };
        pairs.extend(kept(&names.coordinates, &before.x, &after.x));
        pairs.extend(kept(&names.states, &before.z, &after.z));
        Ok(pairs)
    }

    /// The rate of the gap before and after an impact on a stop, v⁺ = −e v⁻, and the momenta to which no impulse has a
    /// component, which stay; nothing for other events. Stops that are reached already may give impulses, too.
    fn struck(
        &self,
        jump: &Jump<'_>,
        (before, after): (&Place, &Place),
    ) -> Result<Vec<(String, f64, f64, f64)>, Irregular> {
        let stops = &self.derivation.text.stops;
        let Some(stop) = stops.iter().find(|stop| stop.event == jump.event) else { return Ok(Vec::new()) };
        let exact = Rounding::none();
        let value = |at: &Place, term: &Term| self.derivation.still(at, &exact).value(term);
        let mut reached = vec![stop];
        for other in stops.iter().filter(|other| other.event != stop.event) {
            if value(before, &other.gap)? <= REACHED * value(before, &other.way)? {
                reached.push(other);
            }
        }
        let mut pairs = Vec::new();
        if reached.len() == 1 {
            let (arrives, leaves) = (value(before, &stop.rate)?, value(after, &stop.rate)?);
            let restitution = value(before, &stop.restitution)?;
            let expected = if arrives < 0.0 { -restitution * arrives } else { arrives };
            pairs.push(("the rate of the gap".to_owned(), leaves, expected, arrives.abs()));
        }
        let (first, then) = (self.derivation.at(before, &exact)?, self.derivation.at(after, &exact)?);
        for s in 0..before.w.len() {
            let mut faster = before.clone();
            faster.w[s] += 1.0;
            let mut is_pushed = false;
            for stop in &reached {
                is_pushed |= value(&faster, &stop.rate)? != value(before, &stop.rate)?;
            }
            if !is_pushed {
                let size = first.momentum_sizes[s].max(then.momentum_sizes[s]);
                // The change of velocities is a solution of equations with this condition.
                let size = size * first.condition.max(1.0);
                pairs.push((
                    format!("the momentum number {}", s + 1),
                    then.momenta[s],
                    first.momenta[s],
                    size,
                ));
            }
        }
        Ok(pairs)
    }

    /// The value that a coordinate, velocity, quasi-velocity or first-order state has at a place.
    fn named_value(&self, at: &Place, name: &str) -> Result<Option<f64>, Irregular> {
        let exact = Rounding::none();
        let point = self.derivation.still(at, &exact);
        let names = &self.derivation.text.names;
        let place = |names: &[String], name: &str| names.iter().position(|known| known == name);
        if let Some(i) = place(&names.coordinates, name) {
            return Ok(Some(at.x[i]));
        }
        if let Some(j) = place(&names.states, name) {
            return Ok(Some(at.z[j]));
        }
        if let Some(s) = place(&self.columns, name) {
            return Ok(Some(self.derivation.columns(&point)?[s]));
        }
        let velocity = name.strip_suffix('\'').and_then(|x| place(&names.coordinates, x));
        velocity.map(|i| Ok(point.velocities()?[i])).transpose()
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| value.abs().max(largest))
}
