//! Vector fields as programs, for evaluation at many states at once.

use std::sync::Arc;

use crate::program::program::Program;

/// f of one member of an ensemble: a program, which members may share, and its own parameters.
#[derive(Clone, Debug)]
pub struct LaneField {
    /// The rates, then the watched pivots, then the sizes with which these are compared.
    pub program: Arc<Program>,
    /// The values of the program's parameters.
    pub parameters: Vec<f64>,
    /// The conditions for regular states.
    pub watched: Watched,
    /// The indices of quaternions in the state, which are divided by their lengths at the end of each step.
    pub unit_quaternions: Vec<[usize; 4]>,
}

/// The pivots that must not vanish: the smallest of those independent of the state, and the number of the
/// others among the outputs of a [`LaneField`].
///
/// A state is regular if each pivot is larger than `vanishing` times the largest of all sizes. Otherwise the
/// member of the ensemble is integrated alone and examined more closely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Watched {
    /// The number of pivots after the rates.
    pub pivots: usize,
    /// The smallest pivot independent of the state.
    pub smallest: f64,
    /// The largest size independent of the state.
    pub largest: f64,
    /// A pivot counts as zero if it is below this fraction of the largest size.
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
