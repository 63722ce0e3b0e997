//! Random motions of several pieces, by all methods, against an integration from one surface to the next that is made here.
//!
//! ```text
//! seed, number ─ generator ─► Specimen ─ text ────────────────────────► product: rows and derivatives by every method
//!                                │ field: Lagrange's equations on        │
//!                                ▼ given sides of all surfaces           ▼
//!                             motion: extrapolation, filippov ─► comparison ─► findings
//! ```
//! Terms step, turn their sign or have a corner in time, coordinates, velocities and first-order states; the motion passes their
//! surfaces or slides along them. The program is given the text. The integration here knows the formulas of the specimen, and
//! holds all sides fixed between passages, which it decides on by Filippov's definition. What it cannot be sure of it
//! skips.

mod comparison;
mod extrapolation;
mod field;
mod filippov;
mod formula;
mod generator;
mod motion;
mod product;
mod reference;
mod shrink;
mod skip;
mod specimen;

use std::time::Duration;

use super::examination::{Examined, bounded};
use super::execution::Refusal;

pub use shrink::shrink;
use specimen::Specimen;

/// Examines model number `index` of a seed.
pub(super) fn examine(seed: u64, index: u64, limit: Duration) -> Examined {
    examine_specimen(&generator::specimen(seed, index), limit)
}

fn examine_specimen(specimen: &Specimen, limit: Duration) -> Examined {
    let (copy, text) = (specimen.clone(), specimen.text());
    let work = {
        let text = text.clone();
        move || examine_text(&copy, &text)
    };
    Examined { text, ..bounded(limit, work) }
}

fn examine_text(specimen: &Specimen, text: &str) -> Examined {
    let reference = match reference::reference(specimen) {
        Ok(reference) => reference,
        Err(skip) => {
            let refusal = Refusal { stage: "not judged", message: skip.to_string() };
            return Examined { refusals: vec![refusal], ..Examined::default() };
        }
    };
    let comparison::Compared { findings, refusals } = comparison::compare(specimen, text, &reference);
    Examined { ran: true, findings, refusals, ..Examined::default() }
}
