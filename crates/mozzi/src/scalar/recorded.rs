//! For the tests: a scalar that records what a kernel does, and can be played back. It has no order and no value, so a
//! kernel that compiles and plays back correctly never branches on a value.

use super::{Scalar, assign_ops};
use core::ops::{Add, Div, Mul, Neg, Sub};
use std::cell::RefCell;

#[derive(Clone, Copy, Debug)]
pub enum Recorded {
    Constant(f64),
    Step(usize),
}

#[derive(Clone, Copy, Debug)]
enum Step {
    Input(usize),
    Add(Recorded, Recorded),
    Sub(Recorded, Recorded),
    Mul(Recorded, Recorded),
    Div(Recorded, Recorded),
    Neg(Recorded),
    Sin(Recorded),
    Cos(Recorded),
    Sqrt(Recorded),
    Tanh(Recorded),
    Sgn(Recorded),
}

std::thread_local!(static TAPE: RefCell<Vec<Step>> = const { RefCell::new(Vec::new()) });

#[inline(never)] // thousands of calls in one function
fn record(step: Step) -> Recorded {
    TAPE.with_borrow_mut(|tape| {
        tape.push(step);
        Recorded::Step(tape.len() - 1)
    })
}

impl Recorded {
    pub fn input(k: usize) -> Self {
        record(Step::Input(k))
    }
}

/// Every recorded step on these inputs, and a new tape; then a recorded number's value can be read.
pub fn play(inputs: &[f64]) -> impl Fn(Recorded) -> f64 + use<> {
    let mut values: Vec<f64> = Vec::new();
    for step in TAPE.take() {
        let at = |x: Recorded| value(&values, x);
        let next = match step {
            Step::Input(k) => inputs[k],
            Step::Add(a, b) => at(a) + at(b),
            Step::Sub(a, b) => at(a) - at(b),
            Step::Mul(a, b) => at(a) * at(b),
            Step::Div(a, b) => at(a) / at(b),
            Step::Neg(a) => -at(a),
            Step::Sin(a) => Scalar::sin_cos(at(a)).0,
            Step::Cos(a) => Scalar::sin_cos(at(a)).1,
            Step::Sqrt(a) => Scalar::sqrt(at(a)),
            Step::Tanh(a) => Scalar::tanh(at(a)),
            Step::Sgn(a) => at(a).sgn(),
        };
        values.push(next);
    }
    move |x| value(&values, x)
}

fn value(values: &[f64], x: Recorded) -> f64 {
    match x {
        Recorded::Constant(x) => x,
        Recorded::Step(k) => values[k],
    }
}

macro_rules! ops {
    ($($Op:ident $op:ident),*) => { $(impl $Op for Recorded {
        type Output = Self;
        fn $op(self, other: Self) -> Self { record(Step::$Op(self, other)) }
    })* };
}
ops!(Add add, Sub sub, Mul mul, Div div);
assign_ops!([] Recorded);
impl Neg for Recorded {
    type Output = Self;
    fn neg(self) -> Self {
        record(Step::Neg(self))
    }
}
impl From<f64> for Recorded {
    fn from(x: f64) -> Self {
        Recorded::Constant(x)
    }
}
impl Scalar for Recorded {
    type Lanes<const L: usize> = [Self; L];
    fn from_f64(x: f64) -> Self {
        Recorded::Constant(x)
    }
    fn sin_cos(self) -> (Self, Self) {
        (record(Step::Sin(self)), record(Step::Cos(self)))
    }
    fn sqrt(self) -> Self {
        record(Step::Sqrt(self))
    }
    fn tanh(self) -> Self {
        record(Step::Tanh(self))
    }
    fn sgn(self) -> Self {
        record(Step::Sgn(self))
    }
}
