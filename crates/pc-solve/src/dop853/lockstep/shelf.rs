//! A cache of kernels.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use pc_expr::LaneField;

use super::kernels::{Kernels, Key};
use super::plan::Plan;

/// The number of pairs of a program and a plan whose kernels are cached.
const KEPT: usize = 8;

/// The latest kernels, for all threads; clones share these kernels.
#[derive(Debug, Clone, Default)]
pub(crate) struct Shelf(Arc<Mutex<VecDeque<Made>>>);

/// The kernels of a program and a plan, if the cache has any.
#[derive(Debug)]
struct Made {
    key: Key,
    plan: Plan,
    kernels: Option<Arc<Kernels>>,
}

impl Shelf {
    /// The kernels of a field, compiled if necessary; none if lanes do not support it.
    pub(crate) fn kernels(&self, field: &LaneField, plan: &Plan) -> Option<Arc<Kernels>> {
        // While one thread compiles them, the others wait.
        let mut shelf = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let fits = |made: &&Made| made.key.is_of(field) && made.plan.is_like(plan);
        if let Some(made) = shelf.iter().find(fits) {
            return made.kernels.clone();
        }
        let kernels = Kernels::new(field, plan, None).map(Arc::new);
        shelf.truncate(KEPT - 1);
        shelf.push_front(Made { key: Key::of(field), plan: plan.clone(), kernels: kernels.clone() });
        kernels
    }
}
