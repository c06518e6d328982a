//! Operation counts of mozzi's kernels, measured with a counting scalar.

use crate::states::{State, inputs};
use mozzi::quantities::{Memory, Query};
use mozzi::{Model, Scalar};
use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// How often each operation was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// a + b, a − b.
    pub sums: u64,
    pub products: u64,
    /// a·b + c.
    pub fused: u64,
    /// Divisions and square roots.
    pub divisions: u64,
    /// Pairs (sin x, cos x).
    pub sin_cos: u64,
}

impl Count {
    /// Floating-point operations: a fused multiply-add counts as two, sine and cosine as none.
    pub fn flops(self) -> u64 {
        self.sums + self.products + 2 * self.fused + self.divisions
    }
}

std::thread_local!(static COUNT: Cell<Count> = const {
    Cell::new(Count { sums: 0, products: 0, fused: 0, divisions: 0, sin_cos: 0 })
});

/// A number that counts the operations on it.
#[derive(Clone, Copy, Debug)]
struct Counted(f64);

impl Counted {
    fn done(x: f64, what: impl FnOnce(&mut Count)) -> Self {
        let mut count = COUNT.get();
        what(&mut count);
        COUNT.set(count);
        Counted(x)
    }
}

macro_rules! operators {
    ($($Op:ident $op:ident $kind:ident),*) => { $(impl $Op for Counted {
        type Output = Self;
        fn $op(self, other: Self) -> Self { Counted::done($Op::$op(self.0, other.0), |count| count.$kind += 1) }
    })* };
}
operators!(Add add sums, Sub sub sums, Mul mul products, Div div divisions);

impl AddAssign for Counted {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl SubAssign for Counted {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Counted(-self.0) // merged into the next operation
    }
}
impl From<f64> for Counted {
    fn from(x: f64) -> Self {
        Counted(x)
    }
}
impl Scalar for Counted {
    type Lanes<const L: usize> = [Self; L];
    fn from_f64(x: f64) -> Self {
        Counted(x)
    }
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.0.sin_cos();
        (Counted::done(s, |count| count.sin_cos += 1), Counted(c))
    }
    fn sqrt(self) -> Self {
        Counted::done(self.0.sqrt(), |count| count.divisions += 1)
    }
    fn tanh(self) -> Self {
        Counted(self.0.tanh())
    }
    fn sgn(self) -> Self {
        Counted(Scalar::sgn(self.0))
    }
    fn mul_add(self, a: Self, b: Self) -> Self {
        Counted::done(self.0.mul_add(a.0, b.0), |count| count.fused += 1)
    }
}

/// The operations of one evaluation. They do not depend on the state.
pub fn count(query: Query, model: &Model, state: State) -> Count {
    let state = state.map(|x| x.iter().map(|&x| Counted(x)).collect::<Vec<_>>());
    let inputs = inputs(query, state.each_ref().map(Vec::as_slice));
    let mut outputs: Vec<_> = query.output_lengths(model).map(|length| vec![Counted(0.0); length]).collect();
    let mut outputs: Vec<&mut [Counted]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
    let (environment, mut memory) = (model.environment(), Memory::new(model));
    COUNT.set(Count::default());
    query.evaluate(model, &inputs, &environment, &mut memory, &mut outputs);
    COUNT.get()
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi::quantities::InverseDynamics;

    #[test]
    fn each_operation_is_counted_once() {
        COUNT.set(Count::default());
        let (a, b) = (Counted(3.0), Counted(4.0));
        let mut c = (a * a + b * b).sqrt();
        c += a.mul_add(b, -a) / b - a;
        let (s, _) = c.sin_cos();
        assert!(s.0.is_finite());
        let expected = Count { sums: 3, products: 2, fused: 1, divisions: 2, sin_cos: 1 };
        assert_eq!(COUNT.get(), expected);
        assert_eq!(expected.flops(), 9);
    }

    #[test]
    fn a_long_chain_costs_in_proportion() {
        let model = crate::robots::chain();
        let states = crate::states::States::new(&model, 1);
        let state = states.iter().next().expect("one state");
        let count = count(InverseDynamics.into(), &model, state);
        assert_eq!(count.sin_cos, 100);
        assert!((100 * 100..100 * 400).contains(&count.flops()), "{count:?}");
    }
}
