//! Programs as processor instructions: sines, signs and the like are expressed by arithmetic and bit operations.

/// A number of the lowered program: the index of its node.
pub(crate) type Value = u32;

/// An instruction on a register's lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Operation {
    Add,
    Sub,
    Mul,
    Div,
    /// The second operand if either is NaN; likewise `Max`.
    Min,
    Max,
    Sqrt,
    /// a b + c.
    MulAdd,
    /// a b − c.
    MulSub,
    /// c − a b.
    NegMulAdd,
    /// −a b − c.
    NegMulSub,
    /// −a; this and the next by AArch64 alone, see [`signs`](super::signs).
    Neg,
    /// b where the bits of a are set, else c.
    Select,
    /// Bitwise; likewise the rest.
    And,
    Xor,
    SubBits,
    ShiftLeft(u8),
    /// Moves numbers: of each 128 bits, their lower or upper halves, a's and b's in turns.
    Interleave(Half, Grain),
    /// Moves 128 bits at a time: those of a, then those of b, at the places that the bits name.
    Pick(u8),
}

/// Which half of 128 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Half {
    Lower,
    Upper,
}

/// The unit that [`Interleave`](Operation::Interleave) moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Grain {
    Bits32,
    Bits64,
}

use Operation::*;

impl Operation {
    pub fn arity(self) -> usize {
        match self {
            Sqrt | Neg | ShiftLeft(_) => 1,
            MulAdd | MulSub | NegMulAdd | NegMulSub | Select => 3,
            _ => 2,
        }
    }

    pub fn commutes(self) -> bool {
        matches!(self, Add | Mul | And | Xor)
    }

    /// True if it works on bits, not on numbers.
    pub fn is_of_bits(self) -> bool {
        matches!(self, And | Xor | SubBits | ShiftLeft(_) | Select)
    }

    /// True if it moves numbers from lane to lane.
    pub fn moves_lanes(self) -> bool {
        matches!(self, Interleave(..) | Pick(_))
    }
}

/// The array of the sines and cosines that are computed in advance.
pub(crate) const SINES: u32 = u32::MAX;

/// A node of the lowered program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Node {
    /// The bits of a number, the same in every lane.
    Constant(u64),
    /// An entry of an array of the caller, or of [`SINES`].
    Input(u32, u32),
    Apply(Operation, [Value; 3]),
}

impl Node {
    pub fn operands(&self) -> &[Value] {
        match self {
            Node::Apply(operation, operands) => &operands[..operation.arity()],
            _ => &[],
        }
    }
}
