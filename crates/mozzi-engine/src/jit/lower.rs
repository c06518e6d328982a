//! Lowers a program to operations that the processor has.

use super::instruction::{Node, Operation, SINES, Value};
use super::shape::Shape;
use super::sin_cos::SinCos;
use crate::program::Function;
use crate::program::{Program, Step};
use std::collections::HashMap;

/// A lowered program. It has one output more than the program: the sum of the squares of all angles.
pub(crate) struct Lowered {
    pub nodes: Vec<Node>,
    /// Entries of arrays in blocks.
    pub outputs: Vec<Vec<Value>>,
    /// Values that are written into tables: see [`by_rows`](super::rows::by_rows).
    pub stores: Vec<Store>,
    /// The code that runs first, on registers of several numbers: the sines and cosines of neighbouring angles of one
    /// state, in the shape [`together`](Shape::together). Its inputs are a register of an array from an entry on; its
    /// only output is the array that [`SINES`] refers to.
    pub before: Option<Box<Lowered>>,
}

/// The first numbers of a register, written to a byte of an output.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Store {
    pub value: Value,
    pub array: usize,
    pub byte: usize,
    pub numbers: usize,
}

impl Lowered {
    /// Floating-point operations; a fused multiply-add counts as two.
    pub fn flops(&self, shape: Shape) -> usize {
        let work = |node: &Node| match node {
            Node::Apply(operation, _) if !operation.is_of_bits() && !operation.moves_lanes() => {
                operation.arity().saturating_sub(1).max(1)
            }
            _ => 0,
        };
        let before = self.before.as_ref().map_or(0, |before| shape.together().lanes() * before.flops(shape));
        before + self.nodes.iter().map(work).sum::<usize>()
    }
}

/// A builder of nodes, for `f64` or for `f32`.
pub(crate) struct Builder {
    pub is_f64: bool,
    nodes: Vec<Node>,
    constants: HashMap<u64, Value>,
}

impl Builder {
    pub fn push(&mut self, node: Node) -> Value {
        self.nodes.push(node);
        (self.nodes.len() - 1) as Value
    }

    pub fn bits(&mut self, bits: u64) -> Value {
        if let Some(&value) = self.constants.get(&bits) {
            return value;
        }
        let value = self.push(Node::Constant(bits));
        self.constants.insert(bits, value);
        value
    }

    /// The number nearest to x.
    pub fn constant(&mut self, x: f64) -> Value {
        self.bits(if self.is_f64 { x.to_bits() } else { u64::from((x as f32).to_bits()) })
    }

    pub fn apply<const K: usize>(&mut self, operation: Operation, operands: [Value; K]) -> Value {
        debug_assert_eq!(K, operation.arity());
        let mut three = [0; 3];
        three[..K].copy_from_slice(&operands);
        self.push(Node::Apply(operation, three))
    }

    /// The sign bit.
    pub fn sign_bit(&mut self) -> Value {
        self.bits(if self.is_f64 { 1 << 63 } else { 1 << 31 })
    }

    /// −1, 0 or 1: multiplied twice by a power of two, every number except 0 is far beyond ±1. NaN stays NaN, as the
    /// second operand.
    fn sgn(&mut self, x: Value) -> Value {
        let huge = self.constant(2.0_f64.powi(if self.is_f64 { 600 } else { 100 }));
        let (one, minus_one) = (self.constant(1.0), self.constant(-1.0));
        let x = self.apply(Operation::Mul, [x, huge]);
        let x = self.apply(Operation::Mul, [x, huge]);
        let x = self.apply(Operation::Max, [minus_one, x]);
        self.apply(Operation::Min, [one, x])
    }
}

/// None if the program has a function without machine code: tanh. Each output from `condensed` on is replaced by its
/// smallest entry and the sum of its entries, which is not finite if an entry is not.
pub(crate) fn lower(program: &Program, shape: Shape, condensed: usize) -> Option<Lowered> {
    let is_f64 = shape.is_f64();
    let width = shape.together().lanes() as u32;
    let windows = if shape.is_scalar() && is_f64 { windows(program, width) } else { Vec::new() };
    let mut builder = Builder { is_f64, nodes: Vec::with_capacity(2 * program.steps.len()), constants: HashMap::new() };
    let mut place: Vec<Value> = Vec::with_capacity(program.steps.len());
    let mut angles: HashMap<u32, (Value, Value)> = HashMap::new();
    let mut squares = builder.constant(0.0);
    let sin_cos = if is_f64 { SinCos::of::<f64>() } else { SinCos::of::<f32>() };
    for step in &program.steps {
        place.push(match *step {
            Step::Constant(x) => builder.constant(x),
            Step::Input(array, index) => builder.push(Node::Input(array, index)),
            Step::Apply(function, operands) => {
                let [a, b, c] = operands.map(|operand| place.get(operand as usize).copied().unwrap_or_default());
                match function {
                    Function::Add => builder.apply(Operation::Add, [a, b]),
                    Function::Sub => builder.apply(Operation::Sub, [a, b]),
                    Function::Mul => builder.apply(Operation::Mul, [a, b]),
                    Function::Div => builder.apply(Operation::Div, [a, b]),
                    Function::MulAdd => builder.apply(Operation::MulAdd, [a, b, c]),
                    Function::MulSub => builder.apply(Operation::MulSub, [a, b, c]),
                    Function::NegMulAdd => builder.apply(Operation::NegMulAdd, [a, b, c]),
                    Function::NegMulSub => builder.apply(Operation::NegMulSub, [a, b, c]),
                    Function::Sqrt => builder.apply(Operation::Sqrt, [a]),
                    Function::Neg => {
                        let sign = builder.sign_bit();
                        builder.apply(Operation::Xor, [a, sign])
                    }
                    Function::Sgn => builder.sgn(a),
                    Function::Sin | Function::Cos => {
                        let angle = operands[0];
                        let (sin, cos) = match angles.get(&angle) {
                            Some(&known) => known,
                            None => {
                                squares = builder.apply(Operation::MulAdd, [a, a, squares]);
                                let both = match program.steps[angle as usize] {
                                    Step::Input(array, index)
                                        if let Some(sin) = together(&windows, width, array, index) =>
                                    {
                                        let entry = |entry: u32| Node::Input(SINES, entry);
                                        (builder.push(entry(sin)), builder.push(entry(sin + width)))
                                    }
                                    _ => sin_cos.at(&mut builder, a),
                                };
                                angles.insert(angle, both);
                                both
                            }
                        };
                        if function == Function::Sin { sin } else { cos }
                    }
                    Function::Tanh => return None,
                }
            }
        });
    }
    let of = |values: &Vec<u32>| values.iter().map(|&value| place[value as usize]).collect();
    let mut outputs: Vec<Vec<Value>> = program.outputs.iter().map(|output| of(&output.values)).collect();
    for output in outputs.iter_mut().skip(condensed) {
        let by = |builder: &mut Builder, operation| {
            output
                .iter()
                .copied()
                .reduce(|a, b| builder.apply(operation, [a, b]))
                .unwrap_or_else(|| builder.constant(0.0))
        };
        *output = vec![by(&mut builder, Operation::Min), by(&mut builder, Operation::Add)];
    }
    outputs.push(vec![squares]);
    let before = (!windows.is_empty()).then(|| Box::new(sines(&windows, &sin_cos)));
    Some(Lowered { nodes: builder.nodes, outputs, stores: Vec::new(), before })
}

/// The beginning of a register's angles: array, entry.
type Window = (u32, u32);

/// Windows of neighbouring inputs that cover all angles, except in arrays shorter than a register.
fn windows(program: &Program, width: u32) -> Vec<Window> {
    let mut angles: Vec<Window> = program
        .steps
        .iter()
        .filter_map(|step| match *step {
            Step::Apply(Function::Sin | Function::Cos, [angle, ..]) => match program.steps[angle as usize] {
                Step::Input(array, index) => Some((array, index)),
                _ => None,
            },
            _ => None,
        })
        .collect();
    angles.sort_unstable();
    let mut windows: Vec<Window> = Vec::new();
    for (array, index) in angles {
        let length = program.inputs[array as usize].length as u32;
        if length >= width && together(&windows, width, array, index).is_none() {
            windows.push((array, index.min(length - width)));
        }
    }
    windows
}

/// The index of an angle's sine; its cosine is a register's width further on.
fn together(windows: &[Window], width: u32, array: u32, index: u32) -> Option<u32> {
    let of = |&(its, first): &Window| its == array && (first..first + width).contains(&index);
    let k = windows.iter().position(of)?;
    Some(2 * k as u32 * width + index - windows[k].1)
}

fn sines(windows: &[Window], sin_cos: &SinCos) -> Lowered {
    let mut builder = Builder { is_f64: true, nodes: Vec::new(), constants: HashMap::new() };
    let both = windows.iter().flat_map(|&(array, first)| {
        let angles = builder.push(Node::Input(array, first));
        <[Value; 2]>::from(sin_cos.at(&mut builder, angles))
    });
    let outputs = vec![both.collect()];
    Lowered { nodes: builder.nodes, outputs, stores: Vec::new(), before: None }
}
