//! Straight-line programs: recorded from a kernel, differentiated, counted, printed and read.

mod arguments;
mod count;
mod derivative;
mod estimate;
mod function;
mod jacobian;
mod needed;
mod record;
mod robot_number;
mod tape;
mod text;
mod too_long;
mod traced;

pub use arguments::{Arguments, pivot_names, record_numbers, record_quantity};
pub use count::Count;
pub use derivative::{Derivative, Product};
pub use estimate::{LONGEST_TEXT, estimate, is_too_long};
pub use function::Function;
pub(crate) use jacobian::jacobian;
pub use record::record;
pub use text::NotAProgram;
pub use too_long::TooLong;
pub use traced::Traced;

use mozzi::Scalar;
use std::collections::BTreeSet;

/// A number of a program: the index of the step that computes it.
pub type Value = u32;

/// One step of a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// A constant of the robot.
    Constant(f64),
    /// An input: the array and the entry.
    Input(u32, u32),
    /// An operation on results of earlier steps; operands beyond its arity are 0.
    Apply(Function, [Value; 3]),
}

impl Step {
    /// The values that it uses.
    pub fn operands(&self) -> &[Value] {
        match self {
            Step::Apply(function, operands) => &operands[..function.arity()],
            _ => &[],
        }
    }
}

/// An input array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Array {
    /// Its name, such as `theta`.
    pub name: String,
    /// Its length.
    pub length: usize,
}

/// An output array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Output {
    /// Its name, such as `tau`.
    pub name: String,
    /// The step that computes each entry.
    pub values: Vec<Value>,
}

/// A recorded computation on one robot: steps one after the other, without loops, branches or memory.
///
/// ```
/// use mozzi::Scalar;
/// let program = mozzi_engine::record("norm", &[("x", 2)], |x| {
///     let zero = mozzi_engine::Traced::zero();
///     vec![("length", vec![(x[0][0] * x[0][0] + x[0][1] * x[0][1] + zero * x[0][0]).sqrt()])]
/// })?;
/// assert_eq!(program.evaluate(&[&[3.0, 4.0]]), [[5.0]]);
/// assert_eq!(program.to_string(), "\
/// program norm
/// input x 2
/// %0 = x 0
/// %1 = x 1
/// %2 = mul %0 %0
/// %3 = fma %1 %1 %2
/// %4 = sqrt %3
/// output length %4
/// ");
/// # Ok::<(), mozzi_engine::TooLong>(())
/// ```
///
/// Its text ([`Display`](std::fmt::Display)) can be parsed again by [`FromStr`](std::str::FromStr).
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    pub(crate) name: String,
    pub(crate) inputs: Vec<Array>,
    pub(crate) steps: Vec<Step>,
    pub(crate) outputs: Vec<Output>,
    pub(crate) asked: Option<Count>,
}

impl Program {
    /// The name of its computation.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The arrays that it reads.
    pub fn inputs(&self) -> &[Array] {
        &self.inputs
    }

    /// The steps, each after the steps whose values it uses.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// The arrays that it fills.
    pub fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    /// Its operation counts.
    pub fn count(&self) -> Count {
        let (mut count, mut angles) = (Count::default(), BTreeSet::new());
        for step in &self.steps {
            let Step::Apply(function, values) = step else { continue };
            *match function {
                Function::Add | Function::Sub => &mut count.add,
                Function::Mul => &mut count.mul,
                Function::Div => &mut count.div,
                Function::MulAdd | Function::MulSub | Function::NegMulAdd | Function::NegMulSub => &mut count.fma,
                Function::Sqrt => &mut count.sqrt,
                // a pair of one angle
                Function::Sin | Function::Cos if !angles.insert(values[0]) => continue,
                Function::Sin | Function::Cos => &mut count.sin_cos,
                Function::Neg | Function::Tanh | Function::Sgn => &mut count.other,
            } += 1;
        }
        count
    }

    /// The kernel's operations before folding; `None` if the program was parsed from text.
    pub fn count_before_folding(&self) -> Option<Count> {
        self.asked
    }

    /// The outputs at these inputs, by interpretation, in any scalar type: the reference for every other way to run the
    /// program.
    ///
    /// # Panics
    /// If the number of inputs differs from [`inputs`](Self::inputs), or one is too short.
    pub fn evaluate<S: Scalar>(&self, inputs: &[&[S]]) -> Vec<Vec<S>> {
        assert!(inputs.len() == self.inputs.len(), "{} arrays, expected {}", inputs.len(), self.inputs.len());
        for (given, Array { name, length }) in inputs.iter().zip(&self.inputs) {
            assert!(given.len() >= *length, "{name} has {} entries, expected {length}", given.len());
        }
        let values = self.values(inputs);
        self.outputs.iter().map(|output| output.values.iter().map(|&value| values[value as usize]).collect()).collect()
    }

    /// The number that each step computes.
    pub(crate) fn values<S: Scalar>(&self, inputs: &[&[S]]) -> Vec<S> {
        let mut values: Vec<S> = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            values.push(match *step {
                Step::Constant(x) => S::from_f64(x),
                Step::Input(array, index) => inputs[array as usize][index as usize],
                Step::Apply(function, operands) => function.apply(operands.map(|value| values[value as usize])),
            });
        }
        values
    }
}
