//! Rows within the program: a state's numbers are contiguous in the caller's tables, a register holds one number of
//! each state. Squares of as many rows as columns are transposed by instructions among those of the program, where they
//! fill pipes that products leave idle, and results are stored into the tables.

use super::instruction::{Grain, Half, Node, Operation, Value};
use super::lower::{Lowered, Store};
use super::shape::{Encoding, Shape};

/// The numbers of an array that one run of the code may touch, and the step to those of the next run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extent {
    /// From the array's address on.
    pub size: usize,
    /// A register's states.
    pub step: usize,
}

impl Extent {
    /// The numbers that several runs may touch.
    #[inline(always)]
    pub fn of(self, runs: usize) -> usize {
        self.size.saturating_add((runs - 1).saturating_mul(self.step))
    }

    /// An array in blocks: entry after entry, the lanes of each contiguous.
    pub(crate) fn of_block(entries: usize, shape: Shape) -> Self {
        let size = entries * shape.lanes();
        Extent { size, step: size }
    }

    /// Reads a row-major table of this width; narrow rows are loaded with one full register.
    pub(crate) fn of_input(width: usize, shape: Shape) -> Self {
        let lanes = shape.lanes();
        let beyond = if width == 0 { 0 } else { lanes.saturating_sub(width) };
        Extent { size: lanes * width + beyond, step: lanes * width }
    }

    /// Writes a row-major table of this width. Only AVX2 writes beyond a row.
    pub(crate) fn of_output(width: usize, shape: Shape) -> Self {
        match shape.encoding() {
            Encoding::Vex => Self::of_input(width, shape),
            Encoding::Evex | Encoding::Neon => Self::of_block(width, shape),
        }
    }
}

/// The first column of the square that has this one. The last square of a wide table ends with the row.
fn square_of(column: usize, width: usize, lanes: usize) -> usize {
    (column / lanes * lanes).min(width.saturating_sub(lanes))
}

/// Makes the inputs and the first `own` outputs of a program row-major tables with these numbers of columns.
pub(crate) fn by_rows(lowered: Lowered, shape: Shape, widths: &[usize], own: usize) -> Lowered {
    let Lowered { nodes, mut outputs, .. } = lowered;
    let mut line = Line { shape, nodes: Vec::with_capacity(2 * nodes.len()), read: Vec::new(), stores: Vec::new() };
    // the squares of the outputs, and those that wait for each value
    let mut squares = Vec::new();
    let mut waiting = vec![Vec::new(); nodes.len()];
    for (array, values) in outputs[..own].iter().enumerate() {
        let mut first = None;
        for column in 0..values.len() {
            let start = square_of(column, values.len(), shape.lanes());
            if first.replace(start) != Some(start) {
                let columns = &values[start..values.len().min(start + shape.lanes())];
                columns.iter().for_each(|&value| waiting[value as usize].push(squares.len()));
                squares.push(Square {
                    array,
                    start,
                    width: values.len(),
                    columns: columns.to_vec(),
                    missing: columns.len(),
                });
            }
        }
    }
    let mut place: Vec<Value> = Vec::with_capacity(nodes.len());
    for (value, node) in nodes.iter().enumerate() {
        place.push(match *node {
            Node::Input(array, column) => line.column(array, column as usize, widths[array as usize]),
            Node::Apply(operation, operands) => {
                let mut moved = [0; 3];
                let arity = operation.arity();
                moved[..arity].iter_mut().zip(operands).for_each(|(moved, operand)| *moved = place[operand as usize]);
                line.push(Node::Apply(operation, moved))
            }
            constant => line.push(constant),
        });
        for &square in &waiting[value] {
            let square = &mut squares[square];
            square.missing -= 1;
            if square.missing == 0 {
                line.write(square, &place);
            }
        }
    }
    outputs[..own].iter_mut().for_each(Vec::clear);
    outputs.iter_mut().flatten().for_each(|value| *value = place[*value as usize]);
    Lowered { nodes: line.nodes, outputs, stores: line.stores, before: None }
}

/// Columns of an output that are written together.
struct Square {
    array: usize,
    start: usize,
    width: usize,
    columns: Vec<Value>,
    missing: usize,
}

struct Line {
    shape: Shape,
    nodes: Vec<Node>,
    /// The squares that were read: array, first column, its columns.
    read: Vec<(u32, usize, Vec<Value>)>,
    stores: Vec<Store>,
}

impl Line {
    fn push(&mut self, node: Node) -> Value {
        self.nodes.push(node);
        (self.nodes.len() - 1) as Value
    }

    fn apply(&mut self, operation: Operation, a: Value, b: Value) -> Value {
        self.push(Node::Apply(operation, [a, b, 0]))
    }

    /// A column of an input; its square is read where the first of its columns is needed.
    fn column(&mut self, array: u32, column: usize, width: usize) -> Value {
        let start = square_of(column, width, self.shape.lanes());
        let is_of = |square: &&(u32, usize, Vec<Value>)| (square.0, square.1) == (array, start);
        if let Some((_, _, columns)) = self.read.iter().find(is_of) {
            return columns[column - start];
        }
        let rows: Vec<Value> =
            (0..self.shape.lanes()).map(|row| self.push(Node::Input(array, (row * width + start) as u32))).collect();
        let columns = self.transposed(&rows);
        self.read.push((array, start, columns.clone()));
        columns[column - start]
    }

    /// Stores the rows of a square. Rows are in their order: without masks, what is stored beyond the end of a narrow
    /// row is overwritten by the next.
    fn write(&mut self, square: &Square, place: &[Value]) {
        let numbers = square.columns.len();
        let columns: Vec<Value> = (0..self.shape.lanes())
            .map(|k| place[*square.columns.get(k).unwrap_or(&square.columns[0]) as usize])
            .collect();
        for (row, value) in self.transposed(&columns).into_iter().enumerate() {
            let number = row * square.width + square.start;
            self.stores.push(Store { value, array: square.array, byte: number * self.shape.number(), numbers });
        }
    }

    /// The columns of a square of rows, or its rows from its columns.
    fn transposed(&mut self, square: &[Value]) -> Vec<Value> {
        let grain = 16 / self.shape.number(); // numbers in 128 bits
        let groups: Vec<Vec<Value>> = square.chunks(grain).map(|group| self.interleaved(group)).collect();
        // entry k of chunk j of group g belongs to place g of chunk j of the result's (j · grain + k)-th register
        let of = |k: usize| groups.iter().map(|group| group[k]).collect::<Vec<_>>();
        let mut result = vec![0; square.len()];
        match groups.len() {
            1 => return groups.concat(),
            2 => {
                for (j, places) in [0x20, 0x31].into_iter().enumerate() {
                    for k in 0..grain {
                        result[j * grain + k] = self.apply(Operation::Pick(places), groups[0][k], groups[1][k]);
                    }
                }
            }
            _ => {
                const EVEN: Operation = Operation::Pick(0x88);
                const ODD: Operation = Operation::Pick(0xdd);
                for k in 0..grain {
                    let [a, b, c, d] = of(k)[..] else { unreachable!("four times 128 bits") };
                    for (first, pick) in [EVEN, ODD].into_iter().enumerate() {
                        let (low, high) = (self.apply(pick, a, b), self.apply(pick, c, d));
                        result[first * grain + k] = self.apply(EVEN, low, high);
                        result[(first + 2) * grain + k] = self.apply(ODD, low, high);
                    }
                }
            }
        }
        result
    }

    /// Squares of numbers within each 128 bits, transposed.
    fn interleaved(&mut self, group: &[Value]) -> Vec<Value> {
        let both = |line: &mut Self, grain, a, b| {
            [Half::Lower, Half::Upper].map(|half| line.apply(Operation::Interleave(half, grain), a, b))
        };
        match *group {
            [a, b] => both(self, Grain::Bits64, a, b).to_vec(),
            [a, b, c, d] => {
                let (ab, cd) = (both(self, Grain::Bits32, a, b), both(self, Grain::Bits32, c, d));
                let halves = [0, 1].map(|half| both(self, Grain::Bits64, ab[half], cd[half]));
                halves.concat()
            }
            _ => unreachable!("two or four numbers in 128 bits"),
        }
    }
}
