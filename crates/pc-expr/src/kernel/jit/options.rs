//! Choices in compiling.

/// Choices in compiling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JitOptions {
    /// Fuse products into sums where the processor has fused multiply-add.
    ///
    /// Without it, and without `inline_trig`, results are those of the [`Interpreter`](crate::Interpreter) bit for bit.
    pub fma: bool,
    /// Compute sines and cosines in line, to 2 units in the last place, where the processor has fused multiply-add.
    pub inline_trig: bool,
    /// How many values are held in machine registers; the others wait in memory.
    pub registers: u32,
    /// Instructions in a function, for programs of more than 50 000 instructions.
    pub chunk: usize,
}

impl Default for JitOptions {
    fn default() -> JitOptions {
        // Of 16 or 32 registers, some hold what an instruction or the generator is about.
        let registers = if cfg!(target_arch = "x86_64") { 14 } else { 28 };
        JitOptions { fma: true, inline_trig: true, registers, chunk: 1000 }
    }
}
