//! The input of the tapes.

use pc_expr::{LaneTape, LaneValue, Program};

use super::field::Field;
use super::plan::Plan;

/// The function f and the plan, from which the tapes are made.
pub(super) struct Problem<'a> {
    pub(super) plan: &'a Plan,
    /// Computes a member's constants from its parameters; `program` computes f from these
    /// constants.
    pub(super) numbers: &'a Program,
    pub(super) program: &'a Program,
    pub(super) pivots: usize,
    pub(super) vanishing: f64,
    pub(super) absolute: Vec<f64>,
    pub(super) unit_quaternions: &'a [[usize; 4]],
}

impl<'a> Problem<'a> {
    pub(super) fn dim(&self) -> usize {
        self.program.state_len()
    }

    /// The function f, if the next rows of the tape hold a member's constants.
    pub(super) fn field(&self, tape: &mut LaneTape) -> Field<'a> {
        let numbers = tape.inputs(self.program.parameters_len());
        self.field_of(tape, numbers)
    }

    /// The function f, if the next rows of the tape hold a member's parameters.
    pub(super) fn field_of_parameters(&self, tape: &mut LaneTape) -> Field<'a> {
        let parameters = tape.inputs(self.numbers.parameters_len());
        let none = tape.constant(0.0);
        let numbers = tape.inline(self.numbers, none, &[], &parameters);
        self.field_of(tape, numbers)
    }

    fn field_of(&self, tape: &mut LaneTape, numbers: Vec<LaneValue>) -> Field<'a> {
        let fixed = [tape.input(), tape.input()];
        let Problem { program, pivots, vanishing, .. } = *self;
        Field { program, pivots, vanishing, numbers, fixed }
    }
}
