//! Sine and cosine as source text: the library's own, from the same recording as the machine code.

use super::Precision;
use super::dialect::Dialect;
use crate::jit::{Node, Operation, SinCos};

/// Lines that compute the sine and the cosine of the number `x`, and the two expressions.
pub(super) fn lines(precision: Precision, dialect: &dyn Dialect) -> (Vec<String>, [String; 2]) {
    let SinCos { nodes, sin, cos } = match precision {
        Precision::F64 => SinCos::of::<f64>(),
        Precision::F32 => SinCos::of::<f32>(),
    };
    let is_bits = |node: u32| matches!(nodes[node as usize], Node::Apply(operation, _) if operation.is_of_bits());
    let number = |node: u32| match nodes[node as usize] {
        Node::Constant(bits) => {
            let x = if precision.is_f64() { f64::from_bits(bits) } else { f32::from_bits(bits as u32).into() };
            if x.is_sign_negative() { format!("(-{})", dialect.literal(-x)) } else { dialect.literal(x) }
        }
        Node::Input(..) => "x".to_string(),
        Node::Apply(..) if is_bits(node) => dialect.number_of_bits(&format!("r{node}")),
        Node::Apply(..) => format!("r{node}"),
    };
    let bits = |node: u32| match nodes[node as usize] {
        Node::Constant(bits) => dialect.bits(bits),
        Node::Apply(..) if is_bits(node) => format!("r{node}"),
        _ => dialect.to_bits(&number(node)),
    };
    // products that were fused into sums are still in the list
    let mut is_needed: Vec<bool> = (0..).zip(&nodes).map(|(place, _)| place == sin || place == cos).collect();
    for (place, node) in nodes.iter().enumerate().rev() {
        if is_needed[place] {
            node.operands().iter().for_each(|&operand| is_needed[operand as usize] = true);
        }
    }
    let mut lines = Vec::new();
    for (place, node) in (0..).zip(&nodes).filter(|(place, _)| is_needed[*place as usize]) {
        let Node::Apply(operation, [a, b, c]) = *node else { continue };
        let fused = |sign_a: &str, sign_c: &str| {
            let [a, b, c] = [a, b, c].map(&number);
            format!("{}({sign_a}{a}, {b}, {sign_c}{c})", dialect.helper("mul_add"))
        };
        let with = |sign: &str| format!("{} {sign} {}", number(a), number(b));
        let of_bits = |sign: &str| format!("{} {sign} {}", bits(a), bits(b));
        let expression = match operation {
            Operation::Add => with("+"),
            Operation::Sub => with("-"),
            Operation::Mul => with("*"),
            Operation::Div => with("/"),
            Operation::MulAdd => fused("", ""),
            Operation::MulSub => fused("", "-"),
            Operation::NegMulAdd => fused("-", ""),
            Operation::NegMulSub => fused("-", "-"),
            Operation::And => of_bits("&"),
            Operation::Xor => of_bits("^"),
            Operation::SubBits => dialect.difference_of_bits(&bits(a), &bits(b)),
            Operation::ShiftLeft(by) => format!("{} << {by}", bits(a)),
            Operation::Neg | Operation::Select | Operation::Min | Operation::Max | Operation::Sqrt => {
                unreachable!("the sine has none")
            }
            Operation::Interleave(..) | Operation::Pick(_) => unreachable!("of machine code"),
        };
        let name = format!("r{place}");
        lines.push(match operation.is_of_bits() {
            true => dialect.bind_bits(&name, &expression),
            false => dialect.bind(&name, &expression),
        });
    }
    (lines, [sin, cos].map(number))
}
