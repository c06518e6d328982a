//! The numbers of a robot in a recording.

use crate::program::Traced;
use mozzi::Scalar;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number of the robot: a constant, or one that depends on arguments. A kernel turns it into a [`Traced`] where it
/// uses it, and a constant gets its node then: the speed of the machine code depends on that. One type for both, so
/// that each kernel is compiled once.
#[derive(Clone, Copy, Debug)]
pub enum RobotNumber {
    Constant(f64),
    Recorded(Traced),
}

impl From<f64> for RobotNumber {
    fn from(x: f64) -> Self {
        RobotNumber::Constant(x)
    }
}

impl From<RobotNumber> for Traced {
    #[inline(never)] // recorded kernels are long, and are not in a hurry
    fn from(x: RobotNumber) -> Self {
        match x {
            RobotNumber::Constant(x) => x.into(),
            RobotNumber::Recorded(x) => x,
        }
    }
}

/// Arithmetic is that of recorded numbers.
impl RobotNumber {
    fn of(self, f: impl FnOnce(Traced) -> Traced) -> Self {
        RobotNumber::Recorded(f(self.into()))
    }
}

macro_rules! operators {
    ($($Op:ident $op:ident),*) => { $(impl $Op for RobotNumber {
        type Output = Self;
        fn $op(self, other: Self) -> Self { self.of(|x| x.$op(Traced::from(other))) }
    })* };
}
operators!(Add add, Sub sub, Mul mul, Div div);

impl Neg for RobotNumber {
    type Output = Self;
    fn neg(self) -> Self {
        self.of(Traced::neg)
    }
}
impl AddAssign for RobotNumber {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl SubAssign for RobotNumber {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Scalar for RobotNumber {
    type Lanes<const L: usize> = [Self; L];
    const IS_ONE: bool = Traced::IS_ONE;
    fn from_f64(x: f64) -> Self {
        x.into()
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = Traced::from(self).sin_cos();
        (RobotNumber::Recorded(sin), RobotNumber::Recorded(cos))
    }
    fn sqrt(self) -> Self {
        self.of(Traced::sqrt)
    }
    fn tanh(self) -> Self {
        self.of(Traced::tanh)
    }
    fn sgn(self) -> Self {
        self.of(Traced::sgn)
    }
    fn mul_add(self, a: Self, b: Self) -> Self {
        self.of(|x| x.mul_add(a.into(), b.into()))
    }
}
