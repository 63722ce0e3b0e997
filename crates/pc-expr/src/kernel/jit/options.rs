//! Options of the compiler.

/// Options of the compiler.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JitOptions {
    /// Fuse products into sums if the processor has fused multiply-add.
    ///
    /// Without `fma` and `inline_trig`, results equal those of the
    /// [`Interpreter`](crate::Interpreter) bit for bit.
    pub fma: bool,
    /// Compute sines and cosines inline, to 2 units in the last place, if the processor has fused
    /// multiply-add.
    pub inline_trig: bool,
    /// Number of values held in machine registers; the others stay in memory.
    pub registers: u32,
    /// Number of instructions of the processor in a function, for programs of more than 50 000 of them.
    pub chunk: usize,
    /// Number of outputs that go to the memory for outputs; the code writes any others to the start
    /// of its scratch memory.
    pub leading: usize,
}

impl Default for JitOptions {
    fn default() -> JitOptions {
        // Some of the 16 or 32 registers are needed for temporary values.
        let registers = if cfg!(target_arch = "x86_64") { 14 } else { 28 };
        JitOptions { fma: true, inline_trig: true, registers, chunk: 1000, leading: usize::MAX }
    }
}
