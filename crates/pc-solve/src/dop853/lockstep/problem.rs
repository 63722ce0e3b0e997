//! What the tapes are made of.

use pc_expr::{LaneTape, Program};

use super::field::Field;
use super::plan::Plan;

/// f and the plan, for the tapes.
pub(super) struct Problem<'a> {
    pub(super) plan: &'a Plan,
    pub(super) program: &'a Program,
    pub(super) pivots: usize,
    pub(super) vanishing: f64,
    pub(super) absolute: Vec<f64>,
}

impl<'a> Problem<'a> {
    pub(super) fn dim(&self) -> usize {
        self.program.state_len()
    }

    pub(super) fn field(&self, tape: &mut LaneTape) -> Field<'a> {
        Field::new(tape, self.program, self.pivots, self.vanishing)
    }
}
