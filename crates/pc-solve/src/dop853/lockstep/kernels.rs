//! What the steps of a program become.

use std::sync::Arc;

use pc_expr::{InstructionSet, LaneField, LaneKernel, Program};

use super::dense::{polynomial, value};
use super::plan::Plan;
use super::problem::Problem;
use super::start::start;
use super::step::step;

/// Longer steps are left to single members: their code would be slow to make, and too long to be read fast.
const LONGEST: usize = 20_000;

/// The kernels of a program, for members of any parameters.
#[derive(Debug, Clone)]
pub(crate) struct Kernels {
    program: Arc<Program>,
    pivots: usize,
    pub(super) dim: usize,
    pub(super) parameters: usize,
    pub(super) start: LaneKernel,
    pub(super) step: LaneKernel,
    /// For states inside steps, if these are asked for.
    pub(super) inside: Option<Inside>,
}

/// The polynomial of a step, and a value of it.
#[derive(Debug, Clone)]
pub(super) struct Inside {
    pub(super) polynomial: LaneKernel,
    pub(super) value: LaneKernel,
}

impl Kernels {
    /// None where the program reads time, or its steps would be too long.
    pub(crate) fn new(field: &LaneField, plan: &Plan, set: Option<InstructionSet>) -> Option<Kernels> {
        let program = &field.program;
        let dim = program.state_len();
        let (pivots, vanishing) = (field.watched.pivots, field.watched.vanishing);
        if dim == 0 || 12 * program.code().len() > LONGEST || program.reads_time() {
            return None;
        }
        let problem = Problem { plan, program, pivots, vanishing, absolute: plan.absolute(dim)? };
        // The start, if it is asked for, and the end are no states inside a step.
        let has_inside = plan.times.iter().any(|&t| t != plan.start && t != plan.end());
        let tape = step(&problem, has_inside);
        if tape.operations() > LONGEST {
            return None;
        }
        let kernel = |tape| match set {
            Some(set) => LaneKernel::with_instructions(tape, set),
            None => Some(LaneKernel::new(tape)),
        };
        let inside = match has_inside {
            true => Some(Inside { polynomial: kernel(polynomial(&problem))?, value: kernel(value(dim))? }),
            false => None,
        };
        Some(Kernels {
            program: Arc::clone(program),
            pivots,
            dim,
            parameters: program.parameters_len(),
            start: kernel(start(&problem))?,
            step: kernel(tape)?,
            inside,
        })
    }

    /// Whether they are those of a field.
    pub(crate) fn are_of(&self, field: &LaneField) -> bool {
        self.pivots == field.watched.pivots && same(&self.program, &field.program)
    }

    /// Whether those of one field are those of the other.
    pub(crate) fn same_program(a: &LaneField, b: &LaneField) -> bool {
        a.watched.pivots == b.watched.pivots && same(&a.program, &b.program)
    }
}

fn same(a: &Arc<Program>, b: &Arc<Program>) -> bool {
    let bits = |program: &Program| program.constants().iter().map(|c| c.to_bits()).collect::<Vec<_>>();
    Arc::ptr_eq(a, b)
        || (a.state_len(), a.parameters_len()) == (b.state_len(), b.parameters_len())
            && a.outputs() == b.outputs()
            && a.code() == b.code()
            && bits(a) == bits(b)
}
