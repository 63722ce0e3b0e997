//! The compiled tapes of a program.

use std::sync::Arc;

use pc_expr::{InstructionSet, LaneField, LaneKernel, Program};

use super::dense::{polynomial, value};
use super::field::FIXED;
use super::plan::Plan;
use super::problem::Problem;
use super::start::start;
use super::step::step;

/// The maximum number of operations in a step: longer code is slow to compile and slow to fetch.
const LONGEST: usize = 20_000;

/// The kernels of a program, for members with any parameters.
#[derive(Debug, Clone)]
pub(crate) struct Kernels {
    key: Key,
    pub(super) dim: usize,
    pub(super) parameters: usize,
    /// The number of rows that hold a member's constants.
    pub(super) numbers: usize,
    pub(super) start: LaneKernel,
    pub(super) step: LaneKernel,
    /// The kernels for states inside steps, if needed.
    pub(super) inside: Option<Inside>,
}

/// The kernels for the polynomial of a step and for a value of the polynomial.
#[derive(Debug, Clone)]
pub(super) struct Inside {
    pub(super) polynomial: LaneKernel,
    pub(super) value: LaneKernel,
}

impl Kernels {
    /// The kernels of a field; none if the program of the field reads the time, or if the code of a
    /// step would be too long.
    pub(crate) fn new(field: &LaneField, plan: &Plan, set: Option<InstructionSet>) -> Option<Kernels> {
        let program = &field.program;
        let dim = program.state_len();
        let (pivots, vanishing) = (field.watched.pivots, field.watched.vanishing);
        if dim == 0 || 12 * program.code().len() > LONGEST || program.reads_time() {
            return None;
        }
        let absolute = plan.absolute(dim)?;
        let (numbers, rest) = program.factored();
        let unit_quaternions = &field.unit_quaternions;
        let problem = Problem {
            plan,
            numbers: &numbers,
            program: &rest,
            pivots,
            vanishing,
            absolute,
            unit_quaternions,
        };
        let has_inside = plan.has_inside();
        let tape = step(&problem, has_inside);
        if tape.operations() > LONGEST {
            return None;
        }
        let kernel = |tape| match set {
            Some(set) => LaneKernel::with_instructions(tape, set),
            None => Some(LaneKernel::new(tape)),
        };
        let inside = match has_inside {
            true => {
                Some(Inside { polynomial: kernel(polynomial(&problem))?, value: kernel(value(&problem))? })
            }
            false => None,
        };
        Some(Kernels {
            key: Key::of(field),
            dim,
            parameters: program.parameters_len(),
            numbers: rest.parameters_len() + FIXED,
            start: kernel(start(&problem))?,
            step: kernel(tape)?,
            inside,
        })
    }

    /// Whether these are the kernels of this field.
    pub(crate) fn are_of(&self, field: &LaneField) -> bool {
        self.key.is_of(field)
    }
}

/// What the kernels depend on besides the plan.
#[derive(Debug, Clone)]
pub(super) struct Key {
    program: Arc<Program>,
    pivots: usize,
    vanishing: f64,
    unit_quaternions: Vec<[usize; 4]>,
}

impl Key {
    pub(super) fn of(field: &LaneField) -> Key {
        let (pivots, vanishing) = (field.watched.pivots, field.watched.vanishing);
        let unit_quaternions = field.unit_quaternions.clone();
        Key { program: Arc::clone(&field.program), pivots, vanishing, unit_quaternions }
    }

    pub(super) fn is_of(&self, field: &LaneField) -> bool {
        let (a, b) = (&self.program, &field.program);
        let bits = |program: &Program| program.constants().iter().map(|c| c.to_bits()).collect::<Vec<_>>();
        (self.pivots, self.vanishing) == (field.watched.pivots, field.watched.vanishing)
            && self.unit_quaternions == field.unit_quaternions
            && (Arc::ptr_eq(a, b)
                || (a.state_len(), a.parameters_len()) == (b.state_len(), b.parameters_len())
                    && a.outputs() == b.outputs()
                    && a.code() == b.code()
                    && bits(a) == bits(b))
    }
}
