//! The order of instructions. A program lists them as they were recorded, where many wait for the one before; a
//! processor looks some hundreds of instructions ahead. Here the next is the first of [`WINDOW`] whose operands are
//! known, in a processor with two pipes for products and two for sums. More values are alive then, so this is for
//! machine code with 32 registers, and where too many are alive the recorded order goes on.
//!
//! Measured at eight states on Zen 4 (docs/performance-log.md): inverse dynamics 0.93 of the time, M 0.80 to 0.93,
//! forward dynamics 0.91 to 0.96; nothing at one state, nothing for longer programs, which wait for their code.

use super::instruction::{Node, Operation, Value};
use super::lower::{Lowered, Store};
use super::shape::Shape;

/// The longest program that is ordered.
pub(crate) const LONGEST: usize = 6000;

/// Instructions among which the next is chosen, in recorded order.
const WINDOW: usize = 128;

/// Reorders a program's nodes by [`order`], and renumbers its values.
pub(crate) fn ordered(lowered: Lowered, shape: Shape) -> Lowered {
    let order = order(&lowered.nodes, shape.most_alive(lowered.nodes.len()));
    let mut place = vec![0; order.len()];
    for (new, &old) in order.iter().enumerate() {
        place[old as usize] = new as Value;
    }
    let moved = |node: &Value| match lowered.nodes[*node as usize] {
        Node::Apply(operation, operands) => {
            let mut moved = [0; 3];
            let arity = operation.arity();
            moved[..arity].iter_mut().zip(operands).for_each(|(moved, operand)| *moved = place[operand as usize]);
            Node::Apply(operation, moved)
        }
        other => other,
    };
    let nodes = order.iter().map(moved).collect();
    let outputs =
        lowered.outputs.iter().map(|list| list.iter().map(|&value| place[value as usize]).collect()).collect();
    let moved = |store: &Store| Store { value: place[store.value as usize], ..*store };
    Lowered { nodes, outputs, stores: lowered.stores.iter().map(moved).collect(), before: lowered.before }
}

/// The pipe of an operation, and the cycles after which its result is known.
fn cost(operation: Operation) -> (usize, u32) {
    match operation {
        Operation::Mul | Operation::MulAdd | Operation::MulSub | Operation::NegMulAdd | Operation::NegMulSub => (0, 4),
        Operation::Div | Operation::Sqrt => (0, 13),
        Operation::Add | Operation::Sub | Operation::Min | Operation::Max | Operation::Neg => (1, 3),
        Operation::And | Operation::Xor | Operation::SubBits | Operation::ShiftLeft(_) | Operation::Select => (1, 1),
        Operation::Interleave(..) | Operation::Pick(_) => (1, 3),
    }
}

fn order(nodes: &[Node], most: usize) -> Vec<Value> {
    const UNKNOWN: u32 = u32::MAX;
    let mut uses = vec![0_u32; nodes.len()];
    nodes.iter().flat_map(Node::operands).for_each(|&operand| uses[operand as usize] += 1);
    let mut known_at = vec![UNKNOWN; nodes.len()];
    let (mut order, mut window) = (Vec::with_capacity(nodes.len()), Vec::with_capacity(WINDOW));
    let (mut next, mut now, mut alive) = (0, 0, 0_usize);
    loop {
        while window.len() < WINDOW && next < nodes.len() {
            match nodes[next] {
                Node::Apply(..) => window.push(next as Value),
                _ => {
                    known_at[next] = 0;
                    order.push(next as Value);
                }
            }
            next += 1;
        }
        if window.is_empty() {
            return order;
        }
        let (mut k, mut pipes) = (0, [2, 2]);
        while k < window.len() && pipes != [0, 0] {
            let value = window[k] as usize;
            let Node::Apply(operation, _) = nodes[value] else { unreachable!("only operations wait") };
            let (pipe, cycles) = cost(operation);
            let is_next = k == 0 && alive >= most; // whenever it is ready
            let is_ready = || nodes[value].operands().iter().all(|&operand| known_at[operand as usize] <= now);
            if !is_next && (alive >= most || pipes[pipe] == 0 || !is_ready()) {
                k += 1;
                continue;
            }
            window.remove(k);
            order.push(value as Value);
            pipes[pipe] = pipes[pipe].max(1) - 1;
            let mut from = now;
            for &operand in nodes[value].operands() {
                from = from.max(known_at[operand as usize]);
                let uses = &mut uses[operand as usize];
                *uses -= 1;
                alive -= usize::from(*uses == 0 && matches!(nodes[operand as usize], Node::Apply(..)));
            }
            known_at[value] = from + cycles;
            alive += usize::from(uses[value] > 0);
        }
        now += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn apply(operation: Operation, operands: [Value; 3]) -> Node {
        Node::Apply(operation, operands)
    }

    #[test]
    fn independent_chains_take_turns_and_operands_come_first() {
        // two chains of products, one recorded after the other
        let mut nodes = vec![Node::Input(0, 0), Node::Input(0, 1)];
        for chain in 0..2 {
            for k in 0..6 {
                let before = if k == 0 { chain } else { nodes.len() as Value - 1 };
                nodes.push(apply(Operation::Mul, [before, before, 0]));
            }
        }
        let outputs = vec![vec![7, 13]];
        let found =
            ordered(Lowered { nodes: nodes.clone(), outputs, stores: Vec::new(), before: None }, Shape::EightF64);
        assert_eq!(found.nodes.len(), nodes.len());
        for (place, node) in found.nodes.iter().enumerate() {
            assert!(node.operands().iter().all(|&operand| (operand as usize) < place));
        }
        let order = order(&nodes, 32);
        assert_eq!(order, [0, 1, 2, 8, 3, 9, 4, 10, 5, 11, 6, 12, 7, 13]);
        assert_eq!(found.outputs, [[12, 13]]);
    }

    #[test]
    fn where_many_values_are_alive_the_recorded_order_goes_on() {
        // a hundred products, then their sum
        let mut nodes = vec![Node::Input(0, 0)];
        (0..100).for_each(|_| nodes.push(apply(Operation::Mul, [0, 0, 0])));
        let mut sum = 1;
        for k in 2..=100 {
            nodes.push(apply(Operation::Add, [sum, k, 0]));
            sum = nodes.len() as Value - 1;
        }
        let order = order(&nodes, 32);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..nodes.len() as Value).collect::<Vec<_>>());
        let place = |value: Value| order.iter().position(|&v| v == value).expect("a permutation") as Value;
        assert!(place(101) < place(50), "while few are alive, the sum begins");
        assert!((51..=100).all(|k| place(k) == place(50) + k - 50), "then the products end first");
    }
}
