//! Rust without `std`.

use super::dialect::{Argument, Dialect, Emitted, Sines, Source, abreast, digits};
use super::{Precision, SourceFile, body, sin_cos};
use crate::program::Function;

struct Rust(Precision);

impl Rust {
    fn number(&self) -> &'static str {
        if self.0.is_f64() { "f64" } else { "f32" }
    }
}

impl Dialect for Rust {
    fn literal(&self, x: f64) -> String {
        digits(x, self.0)
    }
    fn entry(&self, array: &str, index: usize) -> String {
        format!("{array}[{index}]")
    }
    fn helper(&self, name: &str) -> String {
        if name == "sqrt" { "square_root".to_string() } else { name.to_string() }
    }
    fn bind(&self, name: &str, expression: &str) -> String {
        format!("let {name}: {} = {expression};", self.number())
    }
    fn bind_sines(&self, sines: &[Sines]) -> Vec<String> {
        let name = |name: &Option<String>| name.clone().unwrap_or("_".into());
        if let [Sines { angle, sin, cos }] = sines {
            return vec![format!("let ({}, {}) = sin_cos({angle});", name(sin), name(cos))];
        }
        // a loop, which the compiler vectorizes
        let Some((first, count, angles)) = abreast(sines, &self.literal(0.0)) else { return Vec::new() };
        let number = self.number();
        let names = |pick: fn(&Sines) -> &Option<String>| {
            sines.iter().map(|sines| name(pick(sines))).collect::<Vec<_>>().join(", ")
        };
        let (sin_names, cos_names) = (names(|sines| &sines.sin), names(|sines| &sines.cos));
        vec![
            format!("let x_{first}: [{number}; {count}] = [{angles}];"),
            format!("let (mut sin_{first}, mut cos_{first}) = ([0.0; {count}], [0.0; {count}]);"),
            format!("for ((x, sin), cos) in x_{first}.iter().zip(&mut sin_{first}).zip(&mut cos_{first}) {{"),
            "    (*sin, *cos) = sin_cos(*x);".to_string(),
            "}".to_string(),
            format!("let [{sin_names}, ..] = sin_{first};"),
            format!("let [{cos_names}, ..] = cos_{first};"),
        ]
    }
    fn bind_bits(&self, name: &str, expression: &str) -> String {
        format!("let {name} = {expression};")
    }
    fn bits(&self, bits: u64) -> String {
        format!("{bits:#x}_u{}", &self.number()[1..])
    }
    fn to_bits(&self, x: &str) -> String {
        format!("{x}.to_bits()")
    }
    fn number_of_bits(&self, x: &str) -> String {
        format!("{}::from_bits({x})", self.number())
    }
    fn difference_of_bits(&self, a: &str, b: &str) -> String {
        format!("{a}.wrapping_sub({b})")
    }
}

/// One file.
pub(super) fn files(source: &Source) -> Vec<SourceFile> {
    let rust = Rust(source.precision);
    let mut text = String::new();
    let mut line = |line: &str| {
        text.push_str(line.trim_end());
        text.push('\n');
    };
    source.about.iter().for_each(|about| line(&format!("// {about}")));
    for function in &source.functions {
        line("");
        written(function, &rust).iter().for_each(|text| line(text));
    }
    helpers(source, &rust).iter().for_each(|text| line(text));
    vec![SourceFile { name: format!("{}.rs", source.name), text }]
}

const ALLOW: &str =
    "#[allow(clippy::all, clippy::pedantic, clippy::nursery, non_snake_case, unused_variables, unused_parens)]";

fn written(function: &Emitted, rust: &Rust) -> Vec<String> {
    let array = |prefix: &str, argument: &Argument| {
        format!("{}: &{prefix}[{}; {}]", argument.name, rust.number(), argument.length)
    };
    let inputs = function.inputs.iter().map(|input| array("", input));
    let arguments: Vec<String> = inputs.chain(function.outputs.iter().map(|output| array("mut ", output))).collect();
    // one paragraph for each line: rustdoc would join the lines
    let mut lines: Vec<String> =
        function.lines().iter().flat_map(|line| [format!("/// {line}"), "///".into()]).collect();
    lines.pop();
    lines.extend(["#[rustfmt::skip]".to_string(), ALLOW.to_string()]);
    lines.push(format!("pub fn {}({}) {{", function.name, arguments.join(", ")));
    lines.extend(body::lines(function, rust).iter().map(|line| format!("    {line}")));
    lines.push("}".to_string());
    lines
}

fn helpers(source: &Source, rust: &Rust) -> Vec<String> {
    let (number, is_f64) = (rust.number(), source.precision.is_f64());
    let mut lines = Vec::new();
    if source.has(|function| function.arity() == 3) || source.has_sines() {
        lines.extend([
            String::new(),
            "/// a b + c. Where there is `std` and the processor has it, `a.mul_add(b, c)` is one instruction."
                .to_string(),
            "#[inline(always)]".to_string(),
            format!("fn mul_add(a: {number}, b: {number}, c: {number}) -> {number} {{"),
            "    a * b + c".to_string(),
            "}".to_string(),
        ]);
    }
    if source.has(|function| function == Function::Sgn) {
        lines.extend([
            String::new(),
            "/// -1, 0 or 1; NaN of NaN.".to_string(),
            "#[inline(always)]".to_string(),
            format!("fn sgn(x: {number}) -> {number} {{"),
            "    if x > 0.0 { 1.0 } else if x < 0.0 { -1.0 } else { x }".to_string(),
            "}".to_string(),
        ]);
    }
    if source.has_sines() {
        let largest = rust.literal(source.precision.largest_angle());
        let (body, [sin, cos]) = sin_cos::lines(source.precision, rust);
        lines.extend([
            String::new(),
            format!("/// (sin x, cos x) of |x| <= {largest}; beyond, NaN."),
            "#[inline]".to_string(),
            "#[allow(clippy::all, clippy::pedantic, clippy::nursery, unused_parens)]".to_string(),
            format!("fn sin_cos(x: {number}) -> ({number}, {number}) {{"),
            format!("    let x = if x >= -{largest} && x <= {largest} {{ x }} else {{ {number}::NAN }};"),
        ]);
        lines.extend(body.iter().map(|line| format!("    {line}")));
        lines.extend([format!("    ({sin}, {cos})"), "}".to_string()]);
    }
    if source.has(|function| function == Function::Sqrt) {
        // halving the exponent is 6 % off at most, and each Heron step squares the relative error
        let (half_exponents, steps, up, down) = match is_f64 {
            true => ("1023 << 51", 4, "18014398509481984.0", "7.450580596923828e-9"),
            false => ("127 << 22", 3, "16777216.0", "0.000244140625"),
        };
        lines.extend([
            String::new(),
            "/// The square root, by Heron's steps from half the exponent; NaN below 0.".to_string(),
            format!("fn square_root(x: {number}) -> {number} {{"),
            format!("    if x == 0.0 || x == {number}::INFINITY {{ return x; }}"),
            format!("    let (z, unit) = if x < {number}::MIN_POSITIVE {{ (x * {up}, {down}) }} else {{ (x, 1.0) }};"),
            format!("    if !(z > 0.0) {{ return {number}::NAN; }}"),
            format!("    let mut y = {number}::from_bits((z.to_bits() >> 1).wrapping_add({half_exponents}));"),
            format!("    for _ in 0..{steps} {{ y = 0.5 * (y + z / y); }}"),
            "    y * unit".to_string(),
            "}".to_string(),
        ]);
    }
    lines
}
