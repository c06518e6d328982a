//! CUDA C: a function for one state, and kernels with one thread for each state in two layouts.
//!
//! The function reads and writes entries that are `stride` apart; each kernel calls it with its own stride, so that a
//! program is emitted only once.

mod kernels;
mod parts;
mod staging;

pub use kernels::CudaLayout;
pub use staging::Block;

use super::c::C;
use super::dialect::{Dialect, Sines, Source};
use super::{SourceFile, sin_cos};
use crate::program::Function;
use staging::Slots;
use std::cell::RefCell;
use std::collections::BTreeMap;

struct Cuda<'s> {
    c: C,
    /// The robot's name, with which all names of the file begin.
    prefix: &'s str,
    /// The file's constants of 64 bits, other than zero.
    constants: RefCell<Vec<f64>>,
    /// The results of the present function whose rows are in slots.
    slots: RefCell<BTreeMap<String, Slots>>,
}

/// No slot.
const NONE: usize = 65535;

impl Cuda<'_> {
    fn is_f64(&self) -> bool {
        self.c.0.is_f64()
    }
}

impl Dialect for Cuda<'_> {
    /// Instructions take numbers of 32 bits themselves; of 64 bits they take them from constant memory.
    fn literal(&self, x: f64) -> String {
        if !self.is_f64() || x == 0.0 {
            return self.c.literal(x);
        }
        let mut constants = self.constants.borrow_mut();
        let index = constants.iter().position(|known| known.to_bits() == x.to_bits()).unwrap_or_else(|| {
            constants.push(x);
            constants.len() - 1
        });
        format!("{}_constant[{index}]", self.prefix)
    }
    fn entry(&self, array: &str, index: usize) -> String {
        format!("{array}[{index} * stride]")
    }
    fn store(&self, array: &str, index: usize, value: &str) -> String {
        let slots = self.slots.borrow();
        let slot = slots.get(array).map(|slots| slots.of[index].filter(|_| slots.is_first(index)).unwrap_or(NONE));
        let slot = slot.map_or(String::new(), |slot| format!(", {slot}"));
        format!("{}_put<columns, {index}{slot}>({array}, stride, {value});", self.prefix)
    }
    fn helper(&self, name: &str) -> String {
        match name {
            "mul_add" if self.is_f64() => "fma".to_string(),
            "mul_add" => "fmaf".to_string(),
            "sgn" | "sin_cos" => format!("{}_{name}", self.prefix),
            _ => self.c.helper(name),
        }
    }
    /// In `float` within 2 ulp for divisors up to 2¹²⁶: the exact quotient has a branch, around which the compiler
    /// moves nothing, and makes the Panda's forward dynamics a sixth longer.
    fn quotient(&self, a: &str, b: &str) -> String {
        if self.is_f64() { format!("{a} / {b}") } else { format!("__fdividef({a}, {b})") }
    }
    fn bind(&self, name: &str, expression: &str) -> String {
        self.c.bind(name, expression)
    }
    fn bind_sines(&self, sines: &[Sines]) -> Vec<String> {
        sines.iter().flat_map(|one| self.c.bind_sines_by(&self.helper("sin_cos"), one)).collect()
    }
    /// Threads already run in parallel, and numbers computed early would occupy registers.
    fn has_sines_abreast(&self) -> bool {
        false
    }
    fn bind_bits(&self, name: &str, expression: &str) -> String {
        let bits = if self.is_f64() { "unsigned long long" } else { "unsigned int" };
        format!("const {bits} {name} = {expression};")
    }
    fn bits(&self, bits: u64) -> String {
        if self.is_f64() { format!("{bits:#x}ull") } else { format!("{bits:#x}u") }
    }
    fn to_bits(&self, x: &str) -> String {
        let function = if self.is_f64() { "(unsigned long long) __double_as_longlong" } else { "__float_as_uint" };
        format!("{function}({x})")
    }
    fn number_of_bits(&self, x: &str) -> String {
        match self.is_f64() {
            true => format!("__longlong_as_double((long long) ({x}))"),
            false => format!("__uint_as_float({x})"),
        }
    }
    fn difference_of_bits(&self, a: &str, b: &str) -> String {
        self.c.difference_of_bits(a, b)
    }
}

/// One file.
pub(super) fn files(source: &Source) -> Vec<SourceFile> {
    let name = &source.name;
    let cuda = Cuda { c: C(source.precision), prefix: name, constants: RefCell::default(), slots: RefCell::default() };
    // the constants are known once the code that uses them is written, and are emitted before it
    let helpers = helpers(source, &cuda);
    let mut functions = kernels::put(&cuda);
    functions.extend(kernels::copies(source, &cuda));
    functions.extend(source.functions.iter().flat_map(|function| kernels::lines(function, &cuda)));
    let mut lines: Vec<String> = source.about.iter().map(|line| format!("// {line}").trim_end().to_string()).collect();
    let constants = cuda.constants.take();
    if !constants.is_empty() {
        lines.push(format!("\n__constant__ {} {name}_constant[{}] = {{", source.c_type(), constants.len()));
        lines.extend(constants.chunks(4).map(|row| {
            let row: Vec<String> = row.iter().map(|&x| format!("{},", cuda.c.literal(x))).collect();
            format!("    {}", row.join(" "))
        }));
        lines.push("};".to_string());
    }
    lines.extend(helpers);
    lines.extend(functions);
    let text = lines.iter().flat_map(|line| [line, "\n"]).collect();
    vec![SourceFile { name: format!("{name}.cu"), text }]
}

fn helpers(source: &Source, cuda: &Cuda) -> Vec<String> {
    let (number, mut lines) = (cuda.c.number(), Vec::new());
    if source.has(|function| function == Function::Sgn) {
        let (name, [zero, one]) = (cuda.helper("sgn"), [0.0, 1.0].map(|x| cuda.c.literal(x)));
        lines.push(format!(
            "\n// -1, 0 or 1; NaN of NaN.\nstatic __device__ __forceinline__ {number} {name}({number} x)\n{{\n    return x > {zero} ? {one} : x < {zero} ? -{one} : x;\n}}"
        ));
    }
    if source.has_sines() {
        let (name, largest) = (cuda.helper("sin_cos"), cuda.c.literal(source.precision.largest_angle()));
        let nan = if cuda.is_f64() { 0x7ff8_0000_0000_0000 } else { 0x7fc0_0000 };
        lines.push(format!("\n// Of |x| <= {largest}; beyond, NaN."));
        lines.push(format!(
            "static __device__ __forceinline__ void {name}({number} x, {number} *sin_x, {number} *cos_x)\n{{"
        ));
        lines
            .push(format!("    x = x >= -{largest} && x <= {largest} ? x : {};", cuda.number_of_bits(&cuda.bits(nan))));
        let (body, [sin, cos]) = sin_cos::lines(source.precision, cuda);
        lines.extend(body.iter().map(|line| format!("    {line}")));
        lines.push(format!("    if (sin_x) *sin_x = {sin};\n    if (cos_x) *cos_x = {cos};\n}}"));
    }
    lines
}
