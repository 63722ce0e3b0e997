//! Instruction sets for lanes.

/// The instruction set of a [`LaneKernel`](crate::LaneKernel). All instruction sets give the same results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InstructionSet {
    /// Vectors of eight numbers: AVX-512 F and DQ.
    Avx512,
    /// Vectors of four numbers: AVX2 and FMA.
    Avx2,
    /// No machine code.
    Portable,
}

impl InstructionSet {
    /// The sets of this processor, the fastest first.
    pub fn available() -> Vec<InstructionSet> {
        let all = [InstructionSet::Avx512, InstructionSet::Avx2, InstructionSet::Portable];
        all.into_iter().filter(|set| set.is_available()).collect()
    }

    #[cfg(all(feature = "jit", target_arch = "x86_64", unix))]
    fn is_available(self) -> bool {
        match self {
            InstructionSet::Avx512 => {
                is_x86_feature_detected!("fma")
                    && is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512dq")
            }
            InstructionSet::Avx2 => is_x86_feature_detected!("fma") && is_x86_feature_detected!("avx2"),
            InstructionSet::Portable => true,
        }
    }

    #[cfg(not(all(feature = "jit", target_arch = "x86_64", unix)))]
    fn is_available(self) -> bool {
        self == InstructionSet::Portable
    }
}
