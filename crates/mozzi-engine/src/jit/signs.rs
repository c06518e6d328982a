//! Signs outside the instructions, for AArch64. Its vectors have c + a b and c − a b, but not a b − c and not −a b − c:
//! these are computed as −(c − a b) and −(c + a b), and the sign goes on into what uses them, where it costs nothing.
//! Results agree bit for bit, except for the sign of zeros. Operations on bits take the number itself; exchanges by
//! three operations on bits become selections.

use super::instruction::{Node, Operation, Value};
use super::lower::Lowered;
use super::shape::Shape;

/// A value, and whether its negative is meant.
#[derive(Clone, Copy)]
struct Signed(Value, bool);

struct Line {
    nodes: Vec<Node>,
    /// For each new node its negative, once one was needed.
    negated: Vec<Option<Value>>,
    sign_bit: u64,
    /// True if all four signs of a fused product are instructions.
    has_all: bool,
}

/// Moves the signs of a program out of its instructions. Results agree bit for bit, except for the sign of zeros.
pub(crate) fn moved_out(lowered: Lowered, shape: Shape) -> Lowered {
    let Lowered { nodes, mut outputs, stores, before } = lowered;
    let sign_bit = if shape.is_f64() { 1 << 63 } else { 1 << 31 };
    let mut line = Line { nodes: Vec::new(), negated: Vec::new(), sign_bit, has_all: shape.is_scalar() };
    let mut place: Vec<Signed> = Vec::with_capacity(nodes.len());
    for (value, node) in nodes.iter().enumerate() {
        let signed = match *node {
            Node::Apply(operation, operands) => match exchange(&nodes, value) {
                Some([odd, a, b]) => line.select([odd, a, b].map(|operand| place[operand as usize])),
                None => line.apply(operation, operands.map(|operand| place.get(operand as usize).copied())),
            },
            other => Signed(line.push(other), false),
        };
        place.push(signed);
    }
    outputs.iter_mut().flatten().for_each(|value| *value = line.plain(place[*value as usize]));
    let before = before.map(|before| Box::new(moved_out(*before, shape.together())));
    Lowered { nodes: line.nodes, outputs, stores, before }
}

/// [odd, a, b] if the node is x ⊕ ((p ⊕ q) ∧ odd), with x either p or q: a where odd is set, else b.
fn exchange(nodes: &[Node], value: usize) -> Option<[Value; 3]> {
    let of = |value: Value, wanted: Operation| match nodes[value as usize] {
        Node::Apply(operation, [a, b, _]) if operation == wanted => Some([a, b]),
        _ => None,
    };
    let [x, masked] = of(value as Value, Operation::Xor)?;
    let [both, odd] = of(masked, Operation::And)?;
    let [p, q] = of(both, Operation::Xor)?;
    match x {
        _ if x == p => Some([odd, q, p]),
        _ if x == q => Some([odd, p, q]),
        _ => None,
    }
}

impl Line {
    fn push(&mut self, node: Node) -> Value {
        self.nodes.push(node);
        self.negated.push(None);
        (self.nodes.len() - 1) as Value
    }

    fn node<const K: usize>(&mut self, operation: Operation, operands: [Value; K]) -> Value {
        let mut three = [0; 3];
        three[..K].copy_from_slice(&operands);
        self.push(Node::Apply(operation, three))
    }

    /// The number itself.
    fn plain(&mut self, Signed(value, is_negative): Signed) -> Value {
        if !is_negative {
            return value;
        }
        if let Some(negated) = self.negated[value as usize] {
            return negated;
        }
        let negated = match self.nodes[value as usize] {
            Node::Constant(bits) => self.push(Node::Constant(bits ^ self.sign_bit)),
            _ => self.node(Operation::Neg, [value]),
        };
        self.negated[value as usize] = Some(negated);
        negated
    }

    fn select(&mut self, [odd, a, b]: [Signed; 3]) -> Signed {
        let operands = [odd, a, b].map(|operand| self.plain(operand));
        Signed(self.node(Operation::Select, operands), false)
    }

    fn is_sign_bit(&self, Signed(value, is_negative): Signed) -> bool {
        !is_negative && self.nodes[value as usize] == Node::Constant(self.sign_bit)
    }

    fn apply(&mut self, operation: Operation, operands: [Option<Signed>; 3]) -> Signed {
        let operand = |k: usize| operands[k].expect("recorded before");
        let a = operand(0);
        match operation {
            Operation::Add => self.sum(a, operand(1)),
            Operation::Sub => {
                let Signed(b, is_negative) = operand(1);
                self.sum(a, Signed(b, !is_negative))
            }
            Operation::Mul | Operation::Div => {
                let Signed(b, is_negative) = operand(1);
                Signed(self.node(operation, [a.0, b]), a.1 != is_negative)
            }
            Operation::MulAdd => self.fused(a, operand(1), operand(2), [false, false]),
            Operation::MulSub => self.fused(a, operand(1), operand(2), [false, true]),
            Operation::NegMulAdd => self.fused(a, operand(1), operand(2), [true, false]),
            Operation::NegMulSub => self.fused(a, operand(1), operand(2), [true, true]),
            Operation::Neg => Signed(a.0, !a.1),
            Operation::Xor if self.is_sign_bit(operand(1)) => Signed(a.0, !a.1),
            Operation::Xor if self.is_sign_bit(a) => Signed(operand(1).0, !operand(1).1),
            _ => {
                let mut plain = [0; 3];
                for (k, plain) in plain.iter_mut().enumerate().take(operation.arity()) {
                    *plain = self.plain(operand(k));
                }
                Signed(self.node(operation, plain), false)
            }
        }
    }

    fn sum(&mut self, Signed(a, minus_a): Signed, Signed(b, minus_b): Signed) -> Signed {
        match (minus_a, minus_b) {
            (false, true) => Signed(self.node(Operation::Sub, [a, b]), false),
            (true, false) => Signed(self.node(Operation::Sub, [b, a]), false),
            _ => Signed(self.node(Operation::Add, [a, b]), minus_a),
        }
    }

    /// ± a b ± c, where `minus` are the signs of the product and of c.
    fn fused(&mut self, a: Signed, b: Signed, c: Signed, minus: [bool; 2]) -> Signed {
        let (minus_product, minus_c) = (minus[0] != (a.1 != b.1), minus[1] != c.1);
        let operands = [a.0, b.0, c.0];
        let (operation, is_negative) = match (minus_product, minus_c) {
            (false, false) => (Operation::MulAdd, false),
            (true, false) => (Operation::NegMulAdd, false),
            (false, true) if self.has_all => (Operation::MulSub, false),
            (true, true) if self.has_all => (Operation::NegMulSub, false),
            (false, true) => (Operation::NegMulAdd, true),
            (true, true) => (Operation::MulAdd, true),
        };
        Signed(self.node(operation, operands), is_negative)
    }
}

#[cfg(test)]
mod tests {
    use super::super::lower::lower;
    use super::*;
    use crate::{Arguments, Program, record, record_quantity};
    use mozzi::Scalar;
    use mozzi::quantities::{ForwardDynamics, InverseDynamicsDerivatives};

    /// The outputs of a lowered program in `f64`, by interpretation.
    fn outputs(lowered: &Lowered, inputs: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let mut values: Vec<f64> = Vec::new();
        for node in &lowered.nodes {
            values.push(match *node {
                Node::Constant(bits) => f64::from_bits(bits),
                Node::Input(array, entry) => inputs[array as usize][entry as usize],
                Node::Apply(operation, operands) => {
                    let [a, b, c] = operands.map(|operand| values.get(operand as usize).copied().unwrap_or_default());
                    let bits = |f: fn(u64, u64) -> u64| f64::from_bits(f(a.to_bits(), b.to_bits()));
                    match operation {
                        Operation::Add => a + b,
                        Operation::Sub => a - b,
                        Operation::Mul => a * b,
                        Operation::Div => a / b,
                        Operation::Min => a.min(b),
                        Operation::Max => a.max(b),
                        Operation::Sqrt => a.sqrt(),
                        Operation::MulAdd => f64::mul_add(a, b, c),
                        Operation::MulSub => f64::mul_add(a, b, -c),
                        Operation::NegMulAdd => f64::mul_add(-a, b, c),
                        Operation::NegMulSub => f64::mul_add(-a, b, -c),
                        Operation::Neg => -a,
                        Operation::Select => {
                            let odd = a.to_bits();
                            f64::from_bits(odd & b.to_bits() | !odd & c.to_bits())
                        }
                        Operation::And => bits(|a, b| a & b),
                        Operation::Xor => bits(|a, b| a ^ b),
                        Operation::SubBits => bits(u64::wrapping_sub),
                        Operation::ShiftLeft(by) => f64::from_bits(a.to_bits() << by),
                        Operation::Interleave(..) | Operation::Pick(_) => unreachable!("of rows"),
                    }
                }
            });
        }
        lowered.outputs.iter().map(|list| list.iter().map(|&value| values[value as usize]).collect()).collect()
    }

    fn arithmetic(lowered: &Lowered) -> [usize; 2] {
        let count = |is: fn(Operation) -> bool| {
            lowered.nodes.iter().filter(|node| matches!(node, Node::Apply(operation, _) if is(*operation))).count()
        };
        [
            count(|operation| matches!(operation, Operation::MulSub | Operation::NegMulSub)),
            count(|operation| operation == Operation::Neg),
        ]
    }

    /// The same numbers, by instructions that vectors have; few changes of sign are left.
    fn check(program: &Program) {
        let number = |array: usize, k: usize| ((7 * array + 3 * k) % 11) as f64 / 4.0 - 1.3;
        let length = |array: &crate::Array| array.length;
        let inputs: Vec<Vec<f64>> = (program.inputs().iter().map(length).enumerate())
            .map(|(array, length)| (0..length).map(|k| number(array, k)).collect())
            .collect();
        for shape in [Shape::TwoF64, Shape::FourF64] {
            let of = || lower(program, shape, usize::MAX).expect("no tanh");
            let moved = moved_out(of(), shape);
            let (expected, found) = (outputs(&of(), &inputs), outputs(&moved, &inputs));
            assert!(expected == found, "{}, {shape:?}", program.name()); // 0 and −0 are equal
            assert!(expected.iter().flatten().any(|&x| x != 0.0));
            let ([products, _], [left, signs]) = (arithmetic(&of()), arithmetic(&moved));
            assert!(left == 0 && 4 * signs <= products + 16, "{}: {products} and {signs}", program.name());
        }
    }

    #[test]
    fn numbers_stay_and_signs_move() {
        let model = mozzi_urdf::open("panda").unwrap().build().unwrap();
        check(&record_quantity(&model, InverseDynamicsDerivatives, Arguments::default()).unwrap());
        check(&record_quantity(&model, ForwardDynamics, Arguments::default()).unwrap());
        let program = record("signs", &[("x", 3)], |x| {
            let [a, b, c] = [x[0][0], x[0][1], x[0][2]];
            let difference = a.mul_add(b, -c);
            let roots = [(difference * difference).sqrt(), (-difference).sgn(), difference.sin_cos().1];
            vec![("y", roots.to_vec()), ("z", vec![-difference, (-a).mul_add(b, -c), difference / (a - b)])]
        });
        check(&program.expect("short"));
    }
}
