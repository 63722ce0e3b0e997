//! Which way friction points where the slip is nothing but rounding.
//!
//! Where a body rolls, the two derivations find slips of different signs, which say nothing. Either direction is one of the
//! motions between which friction holds the body, so that the second derivation takes that of the first.

use pc_model::Flow;

use crate::comparison::second::Second;
use crate::derivation::place::Place;
use crate::error::Irregular;
use crate::numbers::rounding::Rounding;

/// A slip below this fraction of its terms says nothing.
const NO_SLIP: f64 = 1e-8;

impl Second {
    /// The same derivation for a state at which contacts do not slip; `None` if all of them do.
    pub(crate) fn held_at(
        &self,
        flow: &mut Flow,
        (t, state): (f64, &[f64]),
        at: &Place,
    ) -> Result<Option<Second>, Irregular> {
        let mut held = None;
        for (number, friction) in self.derivation.text.frictions.iter().enumerate() {
            if !friction.jumps || self.slips(number, at)? {
                continue;
            }
            let name = &self.derivation.text.names.constraints[friction.constraint];
            let (columns, row) = (flow.columns(), flow.row_beside(t, state));
            let value =
                |name: String| columns.iter().position(|known| *known == name).map_or(0.0, |i| row[i]);
            let pull = [1, 2].map(|i| value(format!("T_{name}_{i}")));
            let size = pull[0].hypot(pull[1]).copysign(-value(format!("N_{name}")));
            let text = &mut held.get_or_insert_with(|| self.clone()).derivation.text;
            text.parameters[friction.held] = 1.0;
            for (i, pull) in pull.into_iter().enumerate() {
                text.parameters[friction.held + 1 + i] = if pull == 0.0 { 0.0 } else { pull / size };
            }
        }
        Ok(held)
    }

    /// Whether a contact slips.
    fn slips(&self, number: usize, at: &Place) -> Result<bool, Irregular> {
        let exact = Rounding::none();
        let mut size = 0.0f64;
        let still = self.derivation.still(at, &exact);
        for slip in &self.derivation.text.frictions[number].slips {
            size = size.hypot(still.value(slip)?);
        }
        let mut terms = 0.0f64;
        for (s, w) in at.w.iter().enumerate() {
            let moved = self.derivation.once(at, &at.along_velocity(s), &exact);
            for slip in &self.derivation.text.frictions[number].slips {
                terms = terms.max((moved.value(slip)?.eps * w).abs());
            }
        }
        Ok(size > NO_SLIP * terms)
    }
}
