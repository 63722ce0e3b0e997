//! What claims find of a model, to be summed over all models.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::divergence::Compared;
use crate::subject::Subject;

/// The costs that are kept of pages, by model and form.
pub(crate) type Costs = BTreeMap<(String, String), [usize; 4]>;

/// What was found of one model.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    /// The costs of its pages.
    pub(crate) costs: Costs,
    /// Pages that were read back and compared.
    pub(crate) pages: usize,
    /// Integrals that are said to be kept, and states at which one of them was tried.
    pub(crate) integrals: usize,
    pub(crate) integrals_tried: usize,
    /// Whether it has cyclic coordinates, and equations that remain without them.
    pub(crate) has_cyclic: bool,
    /// Whether its reduced equations were compared.
    pub(crate) is_reduced: bool,
    /// Its invariant measures.
    pub(crate) measures: Compared,
    /// Its right-hand side as a program and as source.
    pub(crate) subject: Option<Arc<Subject>>,
}
