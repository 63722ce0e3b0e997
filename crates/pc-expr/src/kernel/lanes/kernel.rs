//! Execution of tapes.

use std::sync::Arc;

use super::instruction_set::InstructionSet;
#[cfg(all(feature = "jit", target_arch = "x86_64", unix))]
use super::machine::code::Code;
use super::portable::CHUNK;
use super::tape::{LANES, LaneTape, Lanes};

/// A [`LaneTape`] that can be run, by machine code if it is available for this processor.
///
/// The results of a lane depend only on its own inputs: they are the same, bit for bit, whatever the other
/// lanes hold and on any processor; only functions that are not computed inline depend on the system's
/// library. (The bits of a NaN may differ.) Clones share the code.
#[derive(Clone, Debug)]
pub struct LaneKernel {
    tape: Arc<LaneTape>,
    #[cfg(all(feature = "jit", target_arch = "x86_64", unix))]
    code: Option<Arc<Code>>,
    set: InstructionSet,
}

impl LaneKernel {
    /// A kernel with the fastest instructions of this processor for which memory can be allocated.
    pub fn new(tape: LaneTape) -> LaneKernel {
        let tape = Arc::new(tape);
        let mut kernels =
            InstructionSet::available().into_iter().filter_map(|set| LaneKernel::of(Arc::clone(&tape), set));
        kernels.next().unwrap_or_else(|| unreachable!("the last needs nothing"))
    }

    /// A kernel with these instructions; `None` if this processor lacks these instructions, or if memory
    /// cannot be allocated.
    pub fn with_instructions(tape: LaneTape, set: InstructionSet) -> Option<LaneKernel> {
        LaneKernel::of(Arc::new(tape), set)
    }

    #[cfg(all(feature = "jit", target_arch = "x86_64", unix))]
    fn of(tape: Arc<LaneTape>, set: InstructionSet) -> Option<LaneKernel> {
        if set == InstructionSet::Portable {
            return Some(LaneKernel { tape, code: None, set });
        }
        if !InstructionSet::available().contains(&set) {
            return None;
        }
        let code = Code::new(&tape, set).ok()?;
        Some(LaneKernel { tape, code: Some(Arc::new(code)), set })
    }

    #[cfg(not(all(feature = "jit", target_arch = "x86_64", unix)))]
    fn of(tape: Arc<LaneTape>, set: InstructionSet) -> Option<LaneKernel> {
        (set == InstructionSet::Portable).then_some(LaneKernel { tape, set })
    }

    /// The instruction set of this kernel.
    pub fn instructions(&self) -> InstructionSet {
        self.set
    }

    /// Number of bytes of machine code.
    pub fn code_len(&self) -> usize {
        #[cfg(all(feature = "jit", target_arch = "x86_64", unix))]
        return self.code.as_ref().map_or(0, |code| code.len());
        #[cfg(not(all(feature = "jit", target_arch = "x86_64", unix)))]
        0
    }

    /// Number of rows of a frame: inputs, outputs, and work space.
    pub fn rows(&self) -> usize {
        #[cfg(all(feature = "jit", target_arch = "x86_64", unix))]
        if let Some(code) = &self.code {
            return code.rows();
        }
        self.first_free() + self.tape.rows()
    }

    /// A frame of zeros.
    pub fn frame(&self) -> Vec<Lanes> {
        vec![Lanes::splat(0.0); self.rows()]
    }

    /// The first row of the outputs, after those of the inputs.
    pub fn first_output(&self) -> usize {
        self.tape.inputs
    }

    fn first_free(&self) -> usize {
        self.tape.inputs + self.tape.outputs.len()
    }

    /// Computes all lanes of a frame; rows beyond inputs and outputs are work space.
    ///
    /// # Panics
    /// If the frame has fewer [`rows`](LaneKernel::rows).
    #[inline]
    pub fn run(&self, frame: &mut [Lanes]) {
        #[cfg(all(feature = "jit", target_arch = "x86_64", unix))]
        if let Some(code) = &self.code {
            return code.run(frame, |frame, first, width| self.again(frame, first, width));
        }
        let (frame, room) = frame.split_at_mut(self.first_free());
        for first in (0..LANES).step_by(CHUNK) {
            self.tape.walk(frame, room, first);
        }
    }

    /// Computes the lanes of a vector again if at least one of them is outside the range of inline functions.
    #[cfg(all(feature = "jit", target_arch = "x86_64", unix))]
    #[cold]
    fn again(&self, frame: &mut [Lanes], first: usize, width: usize) {
        let mut room = vec![Lanes::splat(0.0); self.tape.rows()];
        for first in (first..first + width).step_by(CHUNK) {
            self.tape.walk(frame, &mut room, first);
        }
    }
}
