//! The parts of a source text, and the differences between languages.

use super::Precision;
use crate::program::Function;
use crate::program::{Program, Step};

/// An array that a function takes.
pub(super) struct Argument {
    pub name: String,
    pub length: usize,
    /// Shape, meaning, unit, frame.
    pub about: String,
}

/// A program with the names used in its function.
pub(super) struct Emitted<'p> {
    pub name: String,
    pub program: &'p Program,
    pub inputs: Vec<Argument>,
    pub outputs: Vec<Argument>,
    pub about: Vec<String>,
}

impl Emitted<'_> {
    /// A description of the arguments, and of the cost.
    pub fn lines(&self) -> Vec<String> {
        let mut lines = self.about.clone();
        for argument in self.inputs.iter().chain(&self.outputs).filter(|argument| !argument.about.is_empty()) {
            lines.push(format!("{}: {}", argument.name, argument.about));
        }
        lines.push(format!("{}.", self.program.count()));
        lines
    }

    /// Describes the arrays by their names in the program.
    pub fn describe_arrays(&mut self, about: impl Fn(&str) -> String) {
        let Program { inputs, outputs, .. } = self.program;
        let names = inputs.iter().map(|input| &input.name).chain(outputs.iter().map(|output| &output.name));
        for (argument, name) in self.inputs.iter_mut().chain(&mut self.outputs).zip(names) {
            argument.about = about(name);
        }
    }

    pub fn has(&self, of_kind: impl Fn(Function) -> bool) -> bool {
        self.program.steps.iter().any(|step| matches!(step, Step::Apply(function, _) if of_kind(*function)))
    }

    /// Inputs that no step reads.
    pub fn unused(&self) -> impl Iterator<Item = &Argument> {
        let is_read = |k: usize| {
            self.program.steps.iter().any(|step| matches!(step, Step::Input(array, _) if *array as usize == k))
        };
        (0..).zip(&self.inputs).filter(move |(k, _)| !is_read(*k)).map(|(_, argument)| argument)
    }
}

/// A whole source text.
pub(super) struct Source<'p> {
    pub name: String,
    pub about: Vec<String>,
    pub functions: Vec<Emitted<'p>>,
    pub precision: Precision,
}

impl Source<'_> {
    pub fn has(&self, of_kind: impl Fn(Function) -> bool) -> bool {
        self.functions.iter().any(|function| function.has(&of_kind))
    }

    pub fn has_sines(&self) -> bool {
        self.has(|function| matches!(function, Function::Sin | Function::Cos))
    }

    /// `float` or `double`.
    pub fn c_type(&self) -> &'static str {
        if self.precision.is_f64() { "double" } else { "float" }
    }
}

/// A sine and a cosine to be computed.
pub(super) struct Sines {
    pub angle: String,
    /// The names of the results; none if a result is not needed.
    pub sin: Option<String>,
    pub cos: Option<String>,
}

/// Sines that a loop computes: a name for its arrays, the arrays' length, and the angles, padded with zeros. The length
/// is a multiple of four, or two, so that compilers vectorize the loop.
pub(super) fn abreast<'s>(sines: &'s [Sines], zero: &str) -> Option<(&'s str, usize, String)> {
    let name = sines.iter().find_map(|sines| sines.sin.as_ref().or(sines.cos.as_ref()))?;
    let count = if sines.len() <= 2 { sines.len() } else { sines.len().next_multiple_of(4) };
    let angles = sines.iter().map(|sines| &sines.angle[..]).chain(std::iter::repeat(zero)).take(count);
    Some((name, count, angles.collect::<Vec<_>>().join(", ")))
}

/// How a language writes a step.
pub(super) trait Dialect {
    /// A constant that is not negative.
    fn literal(&self, x: f64) -> String;
    /// An entry of an argument.
    fn entry(&self, array: &str, index: usize) -> String;
    /// Sets an entry of an argument.
    fn store(&self, array: &str, index: usize, value: &str) -> String {
        format!("{} = {value};", self.entry(array, index))
    }
    /// The name in the file of a helper or of a function of the language: `mul_add`, `sgn`, `sqrt`, `tanh`, `sin_cos`.
    fn helper(&self, name: &str) -> String;
    /// A quotient.
    fn quotient(&self, a: &str, b: &str) -> String {
        format!("{a} / {b}")
    }
    /// Defines a new number.
    fn bind(&self, name: &str, expression: &str) -> String;
    /// Defines new numbers: sines and cosines.
    fn bind_sines(&self, sines: &[Sines]) -> Vec<String>;
    /// True if sines are computed together, as soon as their angles are known; false if each is computed when it is
    /// needed.
    fn has_sines_abreast(&self) -> bool {
        true
    }
    /// Defines new bits, as wide as a number.
    fn bind_bits(&self, name: &str, expression: &str) -> String;
    /// A constant's bits.
    fn bits(&self, bits: u64) -> String;
    /// The bits of a number.
    fn to_bits(&self, x: &str) -> String;
    /// The number with these bits.
    fn number_of_bits(&self, x: &str) -> String;
    /// A wrapping difference of bits.
    fn difference_of_bits(&self, a: &str, b: &str) -> String;
}

/// A constant with all digits of its precision, in a form that all languages read.
pub(super) fn digits(x: f64, precision: Precision) -> String {
    let text = if precision.is_f64() { format!("{x:?}") } else { format!("{:?}", x as f32) };
    if text.starts_with('-') { format!("({text})") } else { text }
}
