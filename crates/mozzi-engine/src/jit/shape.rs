//! The registers and number types of machine code.

/// The encoding of instructions, which determines what the processor must support.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// AVX2 and FMA: 16 registers of 256 bits.
    Vex,
    /// AVX-512: 32 registers; those of 512 bits take constants repeated by the instruction that reads them.
    Evex,
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
}

impl Shape {
    /// All of them.
    pub const ALL: [Shape; 7] = [
        Shape::OneF64,
        Shape::FourF64,
        Shape::OneF32,
        Shape::EightF32,
        Shape::EightF64,
        Shape::SixteenF32,
        Shape::OneF64Evex,
    ];

    /// The fastest shape for one state in `f64` on this processor.
    pub fn one_f64() -> Self {
        if Shape::OneF64Evex.is_supported() { Shape::OneF64Evex } else { Shape::OneF64 }
    }

    /// The number of states that one call computes.
    pub fn lanes(self) -> usize {
        match self {
            Shape::OneF64 | Shape::OneF32 | Shape::OneF64Evex => 1,
            Shape::FourF64 => 4,
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
        matches!(self, Shape::OneF64 | Shape::OneF64Evex | Shape::FourF64 | Shape::EightF64)
    }

    /// The required instructions, as text.
    pub fn instruction_set(self) -> &'static str {
        match self.encoding() {
            Encoding::Vex => "avx2 + fma",
            Encoding::Evex if self.is_scalar() => "avx512f + avx512vl",
            Encoding::Evex => "avx512f",
        }
    }

    /// True if this processor can run it.
    pub fn is_supported(self) -> bool {
        #[cfg(target_arch = "x86_64")]
        {
            use std::is_x86_feature_detected as has;
            match self.encoding() {
                Encoding::Vex => has!("avx2") && has!("fma"),
                Encoding::Evex => {
                    has!("avx512f") && (!self.is_scalar() || has!("avx512vl") && has!("avx2") && has!("fma"))
                }
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        false
    }

    pub(crate) fn encoding(self) -> Encoding {
        match self {
            Shape::EightF64 | Shape::SixteenF32 | Shape::OneF64Evex => Encoding::Evex,
            _ => Encoding::Vex,
        }
    }

    /// The longest code in bytes. Long code is fetched from the second-level cache all along: beyond it the kernels'
    /// loops are faster.
    pub fn longest_code(self) -> usize {
        match self.encoding() {
            _ if self.is_scalar() => 256 << 10,
            Encoding::Vex => 512 << 10,
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
            Encoding::Evex => 32,
        }
    }
}
