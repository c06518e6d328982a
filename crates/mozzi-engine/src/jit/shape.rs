//! The registers and number types of machine code.

use super::Refusal;

/// The processors for which there is machine code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Machine {
    X86_64,
    AArch64,
}

impl Machine {
    /// This one, if there is machine code for it.
    const HERE: Option<Machine> = if cfg!(target_arch = "x86_64") {
        Some(Machine::X86_64)
    } else if cfg!(all(target_arch = "aarch64", target_endian = "little")) {
        Some(Machine::AArch64)
    } else {
        None
    };
}

/// The encoding of instructions, which determines what the processor must support.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// AVX2 and FMA: 16 registers of 256 bits.
    Vex,
    /// AVX-512: 32 registers; those of 512 bits take constants repeated by the instruction that reads them.
    Evex,
    /// AArch64's NEON, which all of them have: 32 registers of 128 bits, and no operands in memory.
    Neon,
}

/// The kinds of machine code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// One state in `f64`; AVX2 and FMA, as the next three.
    OneF64,
    /// Four states in `f64`.
    FourF64,
    /// One state in `f32`.
    OneF32,
    /// Eight states in `f32`.
    EightF32,
    /// Eight states in `f64`; AVX-512 F, as the next.
    EightF64,
    /// Sixteen states in `f32`.
    SixteenF32,
    /// One state in `f64` with twice the registers of [`OneF64`](Self::OneF64); AVX-512 F and VL.
    OneF64Evex,
    /// One state in `f64` on AArch64; NEON, as the rest.
    OneF64Neon,
    /// Two states in `f64`.
    TwoF64,
    /// One state in `f32` on AArch64.
    OneF32Neon,
    /// Four states in `f32`.
    FourF32,
}

impl Shape {
    /// All of them.
    pub const ALL: [Shape; 11] = [
        Shape::OneF64,
        Shape::FourF64,
        Shape::OneF32,
        Shape::EightF32,
        Shape::EightF64,
        Shape::SixteenF32,
        Shape::OneF64Evex,
        Shape::OneF64Neon,
        Shape::TwoF64,
        Shape::OneF32Neon,
        Shape::FourF32,
    ];

    /// The fastest shape for one state in `f64` on this processor.
    pub fn one_f64() -> Self {
        match Machine::HERE {
            Some(Machine::AArch64) => Shape::OneF64Neon,
            _ if Shape::OneF64Evex.is_supported() => Shape::OneF64Evex,
            _ => Shape::OneF64,
        }
    }

    /// The shape for one state in `f32` on this processor.
    pub fn one_f32() -> Self {
        if Machine::HERE == Some(Machine::AArch64) { Shape::OneF32Neon } else { Shape::OneF32 }
    }

    /// The number of states that one call computes.
    pub fn lanes(self) -> usize {
        match self {
            Shape::OneF64 | Shape::OneF32 | Shape::OneF64Evex | Shape::OneF64Neon | Shape::OneF32Neon => 1,
            Shape::TwoF64 => 2,
            Shape::FourF64 | Shape::FourF32 => 4,
            Shape::EightF32 | Shape::EightF64 => 8,
            Shape::SixteenF32 => 16,
        }
    }

    /// Bytes in a number.
    pub fn number(self) -> usize {
        if self.is_f64() { 8 } else { 4 }
    }

    /// True if numbers are `f64`, not `f32`.
    pub fn is_f64(self) -> bool {
        matches!(
            self,
            Shape::OneF64 | Shape::OneF64Evex | Shape::FourF64 | Shape::EightF64 | Shape::OneF64Neon | Shape::TwoF64
        )
    }

    /// The required instructions, as text.
    pub fn instruction_set(self) -> &'static str {
        match self.encoding() {
            Encoding::Vex => "avx2 + fma",
            Encoding::Evex if self.is_scalar() => "avx512f + avx512vl",
            Encoding::Evex => "avx512f",
            Encoding::Neon => "neon",
        }
    }

    /// Instructions that this processor has for wide registers and that no shape uses: AArch64's SVE.
    pub fn unused() -> Option<&'static str> {
        #[cfg(target_arch = "aarch64")]
        if std::arch::is_aarch64_feature_detected!("sve") {
            return Some("sve");
        }
        None
    }

    /// True if this processor can run it.
    pub fn is_supported(self) -> bool {
        self.check().is_ok()
    }

    /// Whether this processor and this system can run it.
    ///
    /// # Errors
    /// [`Refusal::Processor`] or [`Refusal::System`].
    pub fn check(self) -> Result<(), Refusal> {
        let is_arm = Machine::HERE == Some(Machine::AArch64);
        match self.has_instructions() {
            false => Err(Refusal::Processor),
            true if is_arm && !cfg!(any(target_os = "linux", target_os = "android", target_os = "macos")) => {
                Err(Refusal::System)
            }
            true => Ok(()),
        }
    }

    fn has_instructions(self) -> bool {
        #[cfg(target_arch = "x86_64")]
        {
            use std::is_x86_feature_detected as has;
            match self.encoding() {
                Encoding::Vex => has!("avx2") && has!("fma"),
                Encoding::Evex => {
                    has!("avx512f") && (!self.is_scalar() || has!("avx512vl") && has!("avx2") && has!("fma"))
                }
                Encoding::Neon => false,
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            Machine::HERE == Some(self.machine())
        }
    }

    pub(crate) fn machine(self) -> Machine {
        if self.encoding() == Encoding::Neon { Machine::AArch64 } else { Machine::X86_64 }
    }

    pub(crate) fn encoding(self) -> Encoding {
        match self {
            Shape::EightF64 | Shape::SixteenF32 | Shape::OneF64Evex => Encoding::Evex,
            Shape::OneF64Neon | Shape::TwoF64 | Shape::OneF32Neon | Shape::FourF32 => Encoding::Neon,
            _ => Encoding::Vex,
        }
    }

    /// The longest code in bytes. Long code is fetched from the second-level cache all along: beyond it the kernels'
    /// loops are faster.
    pub fn longest_code(self) -> usize {
        match self.encoding() {
            _ if self.is_scalar() => 256 << 10,
            Encoding::Vex | Encoding::Neon => 512 << 10,
            Encoding::Evex => 2 << 20,
        }
    }

    /// True if an instruction can repeat a number in memory.
    pub(crate) fn repeats(self) -> bool {
        self.encoding() == Encoding::Evex && !self.is_scalar()
    }

    pub(crate) fn is_scalar(self) -> bool {
        self.lanes() == 1
    }

    /// Bytes in a register of numbers.
    pub(crate) fn width(self) -> usize {
        self.number() * self.lanes()
    }

    pub(crate) fn registers(self) -> usize {
        match self.encoding() {
            Encoding::Vex => 16,
            Encoding::Evex | Encoding::Neon => 32,
        }
    }

    /// The shape in which code for one state computes the sines of neighbouring angles.
    pub(crate) fn together(self) -> Self {
        match self.machine() {
            Machine::X86_64 => Shape::FourF64,
            Machine::AArch64 => Shape::TwoF64,
        }
    }

    /// How much further away, in halves, the need of a value that is in memory seems when a register is to be freed:
    /// without operands in memory, to store a value and to load it again costs as much as two loads of constants.
    pub(crate) fn further(self) -> u64 {
        match self.machine() {
            Machine::X86_64 => 1,
            Machine::AArch64 => 4,
        }
    }

    /// Values that may be alive where instructions are [ordered](super::order): the registers, twice as many in a long
    /// program, whose values are in memory anyway; on AArch64 fewer, as constants take registers, too.
    pub(crate) fn most_alive(self, nodes: usize) -> usize {
        match self.machine() {
            Machine::AArch64 => 24,
            Machine::X86_64 if nodes > 2500 => 64,
            Machine::X86_64 => 32,
        }
    }

    /// True if instructions are [ordered](super::order).
    pub(crate) fn is_ordered(self) -> bool {
        self.repeats() || self.encoding() == Encoding::Neon && !self.is_scalar()
    }
}
