//! The tape of a recording: each distinct operation once, in the order in which it first occurred.
//!
//! Operations on constants, x + 0, x − x, x · 0, x · 1 and −(−x) are folded away. x · 0 is 0 for finite x only: if a
//! number of the robot is zero, a NaN or ∞ does not propagate through its products. Signs are stored outside the nodes
//! ([`Traced`]), so that x and −x, a − b and b − a, share one node.

use crate::program::Count;
use crate::program::Function;
use crate::program::Traced;
use crate::program::too_long::TooLong;
use mozzi::Scalar;
use std::cell::RefCell;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// One operation on earlier nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Node {
    /// The bits of a number whose sign is +.
    Constant(u64),
    /// Array and index.
    Input(u32, u32),
    /// Operands; those of a commutative operation are in increasing order; unused ones are 0.
    Apply(Function, [u32; 3]),
}

#[derive(Debug, Default)]
pub(crate) struct Tape {
    pub nodes: Vec<Node>,
    places: HashMap<Node, u32, BuildHasherDefault<MixHasher>>,
    /// The kernel's operations before folding.
    pub asked: Count,
}

thread_local!(static TAPE: RefCell<Tape> = RefCell::default());

/// Runs a function on this thread's tape.
pub(crate) fn with<R>(f: impl FnOnce(&mut Tape) -> R) -> R {
    TAPE.with_borrow_mut(f)
}

/// Replaces this thread's tape, and returns the old one.
pub(crate) fn replace(tape: Tape) -> Tape {
    TAPE.replace(tape)
}

impl Tape {
    /// Whether operations were left out, because there were too many. A kernel has no branch, so that it ends.
    pub fn is_full(&self) -> bool {
        self.nodes.len() > TooLong::MOST_STEPS
    }

    fn node(&mut self, node: Node) -> u32 {
        if self.is_full() {
            return 0;
        }
        let next = self.nodes.len() as u32;
        let place = *self.places.entry(node).or_insert(next);
        if place == next {
            self.nodes.push(node);
        }
        place
    }

    fn apply(&mut self, function: Function, operands: [u32; 3], is_negative: bool) -> Traced {
        Traced::new(self.node(Node::Apply(function, operands)), is_negative)
    }

    pub fn input(&mut self, array: u32, index: u32) -> Traced {
        Traced::new(self.node(Node::Input(array, index)), false)
    }

    pub fn constant(&mut self, x: f64) -> Traced {
        let is_negative = x < 0.0;
        let size = if x.is_nan() { f64::NAN } else { x.abs() };
        Traced::new(self.node(Node::Constant(size.to_bits())), is_negative)
    }

    /// Its value, if it is a constant.
    fn value(&self, x: Traced) -> Option<f64> {
        match self.nodes[x.node() as usize] {
            Node::Constant(bits) if x.is_negative() => Some(-f64::from_bits(bits)),
            Node::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    pub fn add(&mut self, a: Traced, b: Traced) -> Traced {
        self.asked.add += 1;
        self.sum(a, b)
    }

    pub fn sub(&mut self, a: Traced, b: Traced) -> Traced {
        self.asked.add += 1;
        self.sum(a, -b)
    }

    fn sum(&mut self, a: Traced, b: Traced) -> Traced {
        match (self.value(a), self.value(b)) {
            (Some(x), Some(y)) => return self.constant(x + y),
            (Some(0.0), _) => return b,
            (_, Some(0.0)) => return a,
            _ if a == -b => return self.constant(0.0),
            _ => {}
        }
        let (a, b) = if a.node() <= b.node() { (a, b) } else { (b, a) };
        let function = if a.is_negative() == b.is_negative() { Function::Add } else { Function::Sub };
        self.apply(function, [a.node(), b.node(), 0], a.is_negative())
    }

    pub fn mul(&mut self, a: Traced, b: Traced) -> Traced {
        self.asked.mul += 1;
        self.product(a, b)
    }

    /// a b if one of them is 0 or ±1, or both are constants.
    fn trivial_product(&mut self, a: Traced, b: Traced) -> Option<Traced> {
        match (self.value(a), self.value(b)) {
            (Some(x), Some(y)) => Some(self.constant(x * y)),
            (Some(0.0), _) => Some(a),
            (_, Some(0.0)) => Some(b),
            (Some(1.0 | -1.0), _) => Some(b.negate_if(a.is_negative())),
            (_, Some(1.0 | -1.0)) => Some(a.negate_if(b.is_negative())),
            _ => None,
        }
    }

    fn product(&mut self, a: Traced, b: Traced) -> Traced {
        if let Some(product) = self.trivial_product(a, b) {
            return product;
        }
        let is_negative = a.is_negative() != b.is_negative();
        let (a, b) = (a.node().min(b.node()), a.node().max(b.node()));
        self.apply(Function::Mul, [a, b, 0], is_negative)
    }

    pub fn mul_add(&mut self, a: Traced, b: Traced, c: Traced) -> Traced {
        self.asked.fma += 1;
        if let Some(product) = self.trivial_product(a, b) {
            return self.sum(product, c);
        }
        if self.value(c) == Some(0.0) {
            return self.product(a, b);
        }
        let is_negative = a.is_negative() != b.is_negative();
        let function = if is_negative == c.is_negative() { Function::MulAdd } else { Function::MulSub };
        let (a, b) = (a.node().min(b.node()), a.node().max(b.node()));
        self.apply(function, [a, b, c.node()], is_negative)
    }

    pub fn div(&mut self, a: Traced, b: Traced) -> Traced {
        self.asked.div += 1;
        match (self.value(a), self.value(b)) {
            (Some(x), Some(y)) => self.constant(x / y),
            (Some(0.0), _) => a,
            (_, Some(1.0 | -1.0)) => a.negate_if(b.is_negative()),
            _ => {
                let is_negative = a.is_negative() != b.is_negative();
                self.apply(Function::Div, [a.node(), b.node(), 0], is_negative)
            }
        }
    }

    pub fn sqrt(&mut self, x: Traced) -> Traced {
        self.asked.sqrt += 1;
        match self.value(x) {
            Some(x) => self.constant(x.sqrt()),
            None => {
                // the only function for which the operand's sign must be computed
                let neg = |tape: &mut Self| tape.apply(Function::Neg, [x.node(), 0, 0], false).node();
                let operand = if x.is_negative() { neg(self) } else { x.node() };
                self.apply(Function::Sqrt, [operand, 0, 0], false)
            }
        }
    }

    pub fn sin_cos(&mut self, x: Traced) -> (Traced, Traced) {
        self.asked.sin_cos += 1;
        match self.value(x) {
            Some(x) => {
                let (s, c) = Scalar::sin_cos(x);
                (self.constant(s), self.constant(c))
            }
            None => {
                let sin = self.apply(Function::Sin, [x.node(), 0, 0], x.is_negative());
                (sin, self.apply(Function::Cos, [x.node(), 0, 0], false))
            }
        }
    }

    pub fn tanh(&mut self, x: Traced) -> Traced {
        self.asked.other += 1;
        self.odd(Function::Tanh, x)
    }

    pub fn sgn(&mut self, x: Traced) -> Traced {
        self.asked.other += 1;
        self.odd(Function::Sgn, x)
    }

    fn odd(&mut self, function: Function, x: Traced) -> Traced {
        match self.value(x) {
            Some(x) => self.constant(function.apply([x; 3])),
            None => self.apply(function, [x.node(), 0, 0], x.is_negative()),
        }
    }
}

/// A fast hash of a few small numbers. Collisions are no concern: tapes are not chosen by an attacker.
#[derive(Default)]
struct MixHasher(u64);

impl Hasher for MixHasher {
    fn finish(&self) -> u64 {
        self.0 ^ (self.0 >> 29)
    }
    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut eight = [0; 8];
            eight[..chunk.len()].copy_from_slice(chunk);
            self.write_u64(u64::from_le_bytes(eight));
        }
    }
    fn write_u32(&mut self, x: u32) {
        self.write_u64(x.into());
    }
    fn write_u64(&mut self, x: u64) {
        self.0 = (self.0.rotate_left(23) ^ x).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
    fn write_isize(&mut self, x: isize) {
        self.write_u64(x as u64);
    }
    fn write_usize(&mut self, x: usize) {
        self.write_u64(x as u64);
    }
}
