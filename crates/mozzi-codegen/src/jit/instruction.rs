//! Programs as the processor computes them: sines, signs and the like are arithmetic and bits.

/// A number of the lowered program: the place of its node.
pub(crate) type Value = u32;

/// What one instruction does to a register's lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Operation {
    Add,
    Sub,
    Mul,
    Div,
    /// The second where either is NaN; likewise `Max`.
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
    /// Of bits; likewise the rest.
    And,
    Xor,
    SubBits,
    ShiftLeft(u8),
}

use Operation::*;

impl Operation {
    pub fn arity(self) -> usize {
        match self {
            Sqrt | ShiftLeft(_) => 1,
            MulAdd | MulSub | NegMulAdd | NegMulSub => 3,
            _ => 2,
        }
    }

    pub fn commutes(self) -> bool {
        matches!(self, Add | Mul | And | Xor)
    }

    /// On bits, and not on numbers.
    pub fn is_of_bits(self) -> bool {
        matches!(self, And | Xor | SubBits | ShiftLeft(_))
    }
}

/// The array that sines and cosines stand in where they are computed before.
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
