//! Remarks on parts of the equations.

use crate::equations::sheet::{Balance, Sheet};
use crate::layout::part::Heading;

const WITHOUT_ACCELERATIONS: &str = "Terms without accelerations are left out: they do not matter.";

/// The remark that belongs to a part.
pub(crate) fn remark(sheet: &Sheet<'_>, heading: Heading) -> Option<&'static str> {
    match (heading, &sheet.balance) {
        (Heading::Energy | Heading::Hamiltonian, _) => sheet.energy_remark,
        (Heading::GibbsFunction, _) => Some(WITHOUT_ACCELERATIONS),
        (Heading::ActiveForces, Balance::Forces(forces)) => forces.remark,
        _ => None,
    }
}
