//! The scalar type that records.

use crate::program::tape;
use mozzi::Scalar;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number of this thread's recording. It has neither value nor order, so a kernel runs on it unchanged and leaves its
/// operations on the tape. See [`record`](crate::record()).
///
/// It consists of a node's index on the tape and a sign: −x is x with the other sign, and needs no operation of its
/// own. It is meaningless outside the recording that made it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Traced(u32);

impl Traced {
    /// The number of a node, or its negative.
    pub(crate) fn new(node: u32, is_negative: bool) -> Self {
        Traced(node << 1 | u32::from(is_negative))
    }

    pub(crate) fn node(self) -> u32 {
        self.0 >> 1
    }

    pub(crate) fn is_negative(self) -> bool {
        self.0 & 1 == 1
    }

    /// −x if `negate`, else x.
    pub(crate) fn negate_if(self, negate: bool) -> Self {
        Traced(self.0 ^ u32::from(negate))
    }
}

impl From<f64> for Traced {
    #[inline(never)]
    fn from(x: f64) -> Self {
        tape::with(|tape| tape.constant(x))
    }
}

impl Neg for Traced {
    type Output = Self;
    fn neg(self) -> Self {
        self.negate_if(true)
    }
}

macro_rules! operators {
    ($($Op:ident $op:ident),*) => { $(impl $Op for Traced {
        type Output = Self;
        #[inline(never)] // recorded kernels are long, and are not in a hurry
        fn $op(self, other: Self) -> Self { tape::with(|tape| tape.$op(self, other)) }
    })* };
}
operators!(Add add, Sub sub, Mul mul, Div div);

impl AddAssign for Traced {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl SubAssign for Traced {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Scalar for Traced {
    type Lanes<const L: usize> = [Self; L];
    const IS_ONE: bool = false;
    fn from_f64(x: f64) -> Self {
        x.into()
    }
    fn sin_cos(self) -> (Self, Self) {
        tape::with(|tape| tape.sin_cos(self))
    }
    fn sqrt(self) -> Self {
        tape::with(|tape| tape.sqrt(self))
    }
    fn tanh(self) -> Self {
        tape::with(|tape| tape.tanh(self))
    }
    fn sgn(self) -> Self {
        tape::with(|tape| tape.sgn(self))
    }
    #[inline(never)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        tape::with(|tape| tape.mul_add(self, a, b))
    }
}
