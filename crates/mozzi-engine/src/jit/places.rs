//! Where straight-line code finds its operands in memory.

use super::instruction::Node;
use super::lower::Lowered;
use super::operand::Memory;
use super::shape::Shape;

/// For each constant node, its byte offset in the pool.
pub(crate) fn put_constants(shape: Shape, lowered: &Lowered, pool: &mut Vec<u8>) -> Vec<usize> {
    let repeat = if shape.repeats() { 1 } else { shape.lanes() };
    let put = |node: &Node| {
        let byte = pool.len();
        if let Node::Constant(bits) = node {
            (0..repeat).for_each(|_| pool.extend(&bits.to_le_bytes()[..shape.number()]));
        }
        byte
    };
    lowered.nodes.iter().map(put).collect()
}

/// Where straight-line code finds its operands in memory.
pub(crate) struct Places {
    /// For each constant, its byte offset in the pool.
    pub constants: Vec<usize>,
    /// The array of constants.
    pub pool: Memory,
    /// The first array of outputs.
    pub first_output: Memory,
    /// The stride between entries of an input, in bytes.
    pub stride: usize,
    /// Bytes of the frame that are already in use.
    pub used: usize,
    /// The bytes after which a segment ends.
    pub segment: usize,
}
