//! Contacts that do not slip, where friction has no direction.
//!
//! The two derivations find slips of different signs there, which are nothing but rounding. The equations hold beside such a state as
//! they do at it, so that they are compared at a state near it.

use crate::comparison::second::Second;
use crate::derivation::place::Place;
use crate::error::Irregular;
use crate::numbers::rounding::Rounding;

/// A slip below this fraction of its terms says nothing.
const NO_SLIP: f64 = 1e-8;

/// The number of states near one that are tried.
const TRIES: usize = 8;

impl Second {
    /// The place itself, or one near it at which all contacts with friction slip.
    pub(crate) fn slipping(&self, at: Place) -> Result<Place, Irregular> {
        if self.derivation.text.frictions.is_empty() || self.slips(&at)? {
            return Ok(at);
        }
        let near = (0..TRIES).filter_map(|number| self.derivation.random(&at, number).ok());
        for near in near {
            if self.slips(&near)? {
                return Ok(near);
            }
        }
        Err(Irregular::Corner { function: "the friction of a contact" })
    }

    /// Whether all contacts at which friction jumps slip.
    fn slips(&self, at: &Place) -> Result<bool, Irregular> {
        let exact = Rounding::none();
        let still = self.derivation.still(at, &exact);
        for friction in self.derivation.text.frictions.iter().filter(|friction| friction.jumps) {
            let (mut size, mut terms) = (0.0f64, 0.0f64);
            for slip in &friction.slips {
                size = size.hypot(still.value(slip)?);
                for (s, w) in at.w.iter().enumerate() {
                    let slope = self.derivation.once(at, &at.along_velocity(s), &exact).value(slip)?.eps;
                    terms = terms.max((slope * w).abs());
                }
            }
            if size <= NO_SLIP * terms {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
