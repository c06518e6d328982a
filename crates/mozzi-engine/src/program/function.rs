//! The operations that programs are made of.

use mozzi::Scalar;
use std::fmt;

/// An operation on at most three numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Function {
    /// a + b.
    Add,
    /// a − b.
    Sub,
    /// a b.
    Mul,
    /// a / b.
    Div,
    /// −a.
    Neg,
    /// a b + c, rounded once where the number's type offers it; likewise the next three.
    MulAdd,
    /// a b − c.
    MulSub,
    /// c − a b.
    NegMulAdd,
    /// −a b − c.
    NegMulSub,
    /// √a.
    Sqrt,
    /// sin a.
    Sin,
    /// cos a.
    Cos,
    /// tanh a.
    Tanh,
    /// sgn a.
    Sgn,
}

use Function::*;

impl Function {
    /// All of them.
    pub const ALL: [Function; 14] =
        [Add, Sub, Mul, Div, Neg, MulAdd, MulSub, NegMulAdd, NegMulSub, Sqrt, Sin, Cos, Tanh, Sgn];

    /// The number of operands.
    pub fn arity(self) -> usize {
        match self {
            Neg | Sqrt | Sin | Cos | Tanh | Sgn => 1,
            Add | Sub | Mul | Div => 2,
            MulAdd | MulSub | NegMulAdd | NegMulSub => 3,
        }
    }

    /// Its name in text.
    pub fn name(self) -> &'static str {
        match self {
            Add => "add",
            Sub => "sub",
            Mul => "mul",
            Div => "div",
            Neg => "neg",
            MulAdd => "fma",
            MulSub => "fms",
            NegMulAdd => "fnma",
            NegMulSub => "fnms",
            Sqrt => "sqrt",
            Sin => "sin",
            Cos => "cos",
            Tanh => "tanh",
            Sgn => "sgn",
        }
    }

    /// The function of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|function| function.name() == name)
    }

    /// Its value. Operands beyond [`arity`](Self::arity) are ignored.
    #[inline(always)] // into code compiled for an instruction set
    pub fn apply<S: Scalar>(self, [a, b, c]: [S; 3]) -> S {
        match self {
            Add => a + b,
            Sub => a - b,
            Mul => a * b,
            Div => a / b,
            Neg => -a,
            MulAdd => a.mul_add(b, c),
            MulSub => a.mul_add(b, -c),
            NegMulAdd => (-a).mul_add(b, c),
            NegMulSub => (-a).mul_add(b, -c),
            Sqrt => a.sqrt(),
            Sin => a.sin_cos().0,
            Cos => a.sin_cos().1,
            Tanh => a.tanh(),
            Sgn => a.sgn(),
        }
    }
}

impl fmt::Display for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
