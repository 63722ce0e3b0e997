//! What the verdicts mean where the model contains functions that are not given.

use crate::theory::basis::Basis;
use crate::theory::description::{Entry, Section};

/// The section on undetermined functions; without entries if all functions are given.
pub(crate) fn section<'g>(ground: &Basis<'_, 'g>) -> Section<'g> {
    let names = ground.assembly.undetermined_functions();
    let entries = match names.as_slice() {
        [] => Vec::new(),
        names => vec![Entry::words(format!(
            "{}: any smooth function; what is proved holds for every such function, what is disproved does not hold for a generic one",
            names.join(", ")
        ))],
    };
    Section { key: "functions", title: "Functions", names: Vec::new(), entries }
}
