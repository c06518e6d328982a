//! The machine's instruction sets, detected once at run time.

use crate::lanes::Lane;
use crate::number::Number;

/// The instruction set of a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum InstructionSet {
    /// Plain arithmetic, one state at a time, on any processor: bit for bit the results of `mozzi`'s kernels at one
    /// state.
    Portable,
    /// 128 bits, on AArch64: 2 `f64` or 4 `f32`.
    Neon,
    /// 256 bits, with fused multiply-add: 4 `f64` or 8 `f32`.
    Avx2,
    /// 512 bits: 8 `f64` or 16 `f32`.
    Avx512,
}

impl InstructionSet {
    /// All of them, of any machine.
    pub const ALL: [InstructionSet; 4] =
        [InstructionSet::Portable, InstructionSet::Neon, InstructionSet::Avx2, InstructionSet::Avx512];

    /// The instruction sets of this machine, the fastest last.
    pub fn available() -> Vec<InstructionSet> {
        Self::ALL.into_iter().filter(|set| set.is_available()).collect()
    }

    /// The fastest instruction set of this machine.
    pub fn best() -> InstructionSet {
        Self::available().last().copied().unwrap_or(InstructionSet::Portable)
    }

    /// Whether this machine supports it.
    pub fn is_available(self) -> bool {
        match self {
            InstructionSet::Portable => true,
            InstructionSet::Neon => cfg!(target_arch = "aarch64"),
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2 => std::is_x86_feature_detected!("avx2") && std::is_x86_feature_detected!("fma"),
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => {
                std::is_x86_feature_detected!("avx512f")
                    && std::is_x86_feature_detected!("avx512dq")
                    && std::is_x86_feature_detected!("avx512vl")
            }
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }

    /// The number of states in a register of this number type.
    pub fn lanes<T: Number>(self) -> usize {
        match self {
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => T::Avx512::WIDTH,
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2 => T::Avx2::WIDTH,
            #[cfg(target_arch = "aarch64")]
            InstructionSet::Neon => T::Neon::WIDTH,
            _ => T::Portable::WIDTH,
        }
    }

    /// "portable", "neon", "avx2" or "avx512".
    pub fn name(self) -> &'static str {
        match self {
            InstructionSet::Portable => "portable",
            InstructionSet::Neon => "neon",
            InstructionSet::Avx2 => "avx2",
            InstructionSet::Avx512 => "avx512",
        }
    }
}
