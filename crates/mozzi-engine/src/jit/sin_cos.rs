//! Sine and cosine: [`mozzi`]'s own code, recorded as instructions.

use super::instruction::{Node, Operation, Value};
use super::lower::Builder;
use mozzi::Scalar;
use mozzi::scalar::{Bits, Float, sin_cos};
use std::cell::RefCell;
use std::marker::PhantomData;

/// The instructions from an angle, node 0, to its sine and cosine.
pub(crate) struct SinCos {
    pub nodes: Vec<Node>,
    pub sin: Value,
    pub cos: Value,
}

thread_local!(static NODES: RefCell<Vec<Node>> = const { RefCell::new(Vec::new()) });

impl SinCos {
    /// For `f64` or `f32`.
    pub fn of<T: Number>() -> Self {
        NODES.replace(vec![Node::Input(0, 0)]);
        let (sin, cos) = sin_cos(Wire::<T>(0, PhantomData));
        let mut this = SinCos { nodes: NODES.take(), sin: sin.0, cos: cos.0 };
        this.fuse();
        this
    }

    /// Fuses products that only sums use into those sums: a product that was exact without fusing still is.
    fn fuse(&mut self) {
        let product = |nodes: &[Node], x: Value| match nodes[x as usize] {
            Node::Apply(Operation::Mul, [p, q, _]) => Some([p, q]),
            _ => None,
        };
        let sum = |node: Node| match node {
            Node::Apply(operation @ (Operation::Add | Operation::Sub), [a, b, _]) => Some((operation, a, b)),
            _ => None,
        };
        for x in 0..self.nodes.len() as Value {
            let Some([p, q]) = product(&self.nodes, x) else { continue };
            let takes_it = |node: &Node| sum(*node).is_some_and(|(_, a, b)| (a == x) != (b == x));
            if !self.nodes.iter().filter(|node| node.operands().contains(&x)).all(takes_it) {
                continue;
            }
            for node in &mut self.nodes {
                *node = match sum(*node) {
                    Some((Operation::Add, a, b)) if a == x => Node::Apply(Operation::MulAdd, [p, q, b]),
                    Some((Operation::Add, a, b)) if b == x => Node::Apply(Operation::MulAdd, [p, q, a]),
                    Some((_, a, b)) if a == x => Node::Apply(Operation::MulSub, [p, q, b]),
                    Some((_, a, b)) if b == x => Node::Apply(Operation::NegMulAdd, [p, q, a]),
                    _ => continue,
                }
            }
        }
    }

    /// Computes them for this angle.
    pub fn at(&self, builder: &mut Builder, angle: Value) -> (Value, Value) {
        let mut place = vec![angle];
        for node in &self.nodes[1..] {
            place.push(match *node {
                Node::Constant(bits) => builder.bits(bits),
                Node::Apply(operation, operands) => {
                    builder.push(Node::Apply(operation, operands.map(|operand| place[operand as usize])))
                }
                Node::Input(..) => angle,
            });
        }
        (place[self.sin as usize], place[self.cos as usize])
    }
}

/// `f64` or `f32`, with its bits.
pub(crate) trait Number: Float {
    const SIGN: u64;
    fn raw(self) -> u64;
}
impl Number for f64 {
    const SIGN: u64 = 1 << 63;
    fn raw(self) -> u64 {
        self.to_bits()
    }
}
impl Number for f32 {
    const SIGN: u64 = 1 << 31;
    fn raw(self) -> u64 {
        self.to_bits().into()
    }
}

/// A number of the recording: its node.
#[derive(Clone, Copy, Debug)]
struct Wire<T>(Value, PhantomData<T>);

impl<T: Number> Wire<T> {
    fn new(node: Node) -> Self {
        let place = NODES.with_borrow_mut(|nodes| {
            nodes.iter().position(|known| *known == node).unwrap_or_else(|| {
                nodes.push(node);
                nodes.len() - 1
            })
        });
        Wire(place as Value, PhantomData)
    }

    fn apply<const K: usize>(operation: Operation, operands: [Self; K]) -> Self {
        let mut three = [0; 3];
        three.iter_mut().zip(operands).for_each(|(place, operand)| *place = operand.0);
        Self::new(Node::Apply(operation, three))
    }

    fn sign_bit() -> Self {
        Self::new(Node::Constant(T::SIGN))
    }
}

macro_rules! operators {
    ($($Op:ident $op:ident),*) => { $(impl<T: Number> std::ops::$Op for Wire<T> {
        type Output = Self;
        fn $op(self, other: Self) -> Self { Self::apply(Operation::$Op, [self, other]) }
    })* };
}
operators!(Add add, Sub sub, Mul mul, Div div);

impl<T: Number> std::ops::Neg for Wire<T> {
    type Output = Self;
    fn neg(self) -> Self {
        self.xor(Self::sign_bit())
    }
}
impl<T: Number> std::ops::AddAssign for Wire<T> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl<T: Number> std::ops::SubAssign for Wire<T> {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<T: Number> Scalar for Wire<T> {
    type Lanes<const L: usize> = [Self; L];
    const IS_ONE: bool = false;
    fn from_f64(x: f64) -> Self {
        Self::constant(T::from_f64(x))
    }
    fn sqrt(self) -> Self {
        Self::apply(Operation::Sqrt, [self])
    }
    fn mul_add(self, a: Self, b: Self) -> Self {
        // a negated operand becomes a subtraction
        let (sign, node) = (Self::sign_bit().0, NODES.with_borrow(|nodes| nodes[b.0 as usize]));
        match node {
            Node::Apply(Operation::Xor, [x, y, _]) if y == sign => {
                Self::apply(Operation::MulSub, [self, a, Wire(x, PhantomData)])
            }
            _ => Self::apply(Operation::MulAdd, [self, a, b]),
        }
    }
    fn sin_cos(self) -> (Self, Self) {
        unreachable!("sine and cosine are made of arithmetic and bits")
    }
    fn tanh(self) -> Self {
        unreachable!("sine and cosine are made of arithmetic and bits")
    }
    fn sgn(self) -> Self {
        unreachable!("sine and cosine are made of arithmetic and bits")
    }
}

impl<T: Number> Bits for Wire<T> {
    type Number = T;
    fn constant(x: T) -> Self {
        Self::new(Node::Constant(x.raw()))
    }
    fn xor(self, other: Self) -> Self {
        Self::apply(Operation::Xor, [self, other])
    }
    fn and(self, other: Self) -> Self {
        Self::apply(Operation::And, [self, other])
    }
    fn lowest_everywhere(self) -> Self {
        let (zero, one) = (Self::new(Node::Constant(0)), Self::new(Node::Constant(1)));
        Self::apply(Operation::SubBits, [zero, self.and(one)])
    }
    fn second_lowest_as_sign(self) -> Self {
        let by = T::SIGN.trailing_zeros() as u8 - 1;
        Self::apply(Operation::ShiftLeft(by), [self]).and(Self::sign_bit())
    }
}
