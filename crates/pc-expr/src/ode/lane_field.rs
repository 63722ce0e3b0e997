//! Fields as programs, to be evaluated at many states at once.

use std::sync::Arc;

use crate::program::program::Program;

/// f of one member of an ensemble as a program, which its members may have in common, and numbers of its own.
#[derive(Clone, Debug)]
pub struct LaneField {
    /// The rates, then the pivots that are watched, then the sizes that these are compared with.
    pub program: Arc<Program>,
    /// The numbers that the program takes for parameters.
    pub parameters: Vec<f64>,
    /// Which states are regular.
    pub watched: Watched,
}

/// Pivots that must not vanish, as far as they do not depend on the state, and how those are found among the
/// outputs of a [`LaneField`] that do.
///
/// A state is regular where each pivot is larger than `vanishing` times the largest of all sizes. Where not,
/// the member is integrated alone, where it is examined more closely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Watched {
    /// The number of pivots after the rates.
    pub pivots: usize,
    /// The smallest of those that the state does not change.
    pub smallest: f64,
    /// The largest of such sizes.
    pub largest: f64,
    /// The bound of what is small against them.
    pub vanishing: f64,
}

impl Watched {
    /// No pivots: all states are regular.
    pub const NOTHING: Watched = Watched { pivots: 0, smallest: f64::INFINITY, largest: 0.0, vanishing: 0.0 };
}

impl Program {
    /// Whether the outputs may depend on time.
    pub fn reads_time(&self) -> bool {
        let time = self.first_input();
        let mut reads = vec![false; self.registers_len()];
        reads[time] = true;
        for (i, instruction) in self.code().iter().enumerate() {
            let result = instruction.operands().any(|operand| reads[operand.index()]);
            reads[self.first_result() + i] = result;
        }
        self.outputs().iter().any(|output| reads[output.index()])
    }
}
