//! C99: a header, which C++ reads, too, and a source file.

use super::dialect::{Argument, Dialect, Emitted, Sines, Source, abreast, digits};
use super::{Precision, SourceFile, body, sin_cos};
use crate::program::Function;

/// The part that C and CUDA C share.
pub(super) struct C(pub Precision);

impl C {
    pub fn number(&self) -> &'static str {
        if self.0.is_f64() { "double" } else { "float" }
    }

    /// A call of this function.
    pub fn bind_sines_by(&self, function: &str, Sines { angle, sin, cos }: &Sines) -> [String; 2] {
        let names: Vec<&str> = sin.iter().chain(cos).map(String::as_str).collect();
        let address = |name: &Option<String>| name.as_ref().map_or("0".to_string(), |name| format!("&{name}"));
        [
            format!("{} {};", self.number(), names.join(", ")),
            format!("{function}({angle}, {}, {});", address(sin), address(cos)),
        ]
    }

    /// The declarations of a function's arrays; `restrict` is that of outputs.
    pub fn parameters(&self, function: &Emitted, restrict: &str) -> String {
        let array = |before: &str, inside: &str, argument: &Argument| {
            let Argument { name, length, .. } = argument;
            // an empty array is a pointer
            match length {
                0 => format!("{before}{} *{name}", self.number()),
                _ => format!("{before}{} {name}[{inside}{length}]", self.number()),
            }
        };
        let inputs = function.inputs.iter().map(|input| array("const ", "", input));
        let outputs = function.outputs.iter().map(|output| array("", restrict, output));
        inputs.chain(outputs).collect::<Vec<_>>().join(", ")
    }

    /// A loop, which compilers vectorize.
    fn bind_sines_abreast(&self, sines: &[Sines]) -> Vec<String> {
        let Some((first, count, angles)) = abreast(sines, &self.literal(0.0)) else { return Vec::new() };
        let number = self.number();
        let mut lines = vec![
            format!("const {number} x_{first}[{count}] = {{{angles}}};"),
            format!("{number} sin_{first}[{count}], cos_{first}[{count}];"),
            format!(
                "for (int k = 0; k < {count}; ++k) {}(x_{first}[k], &sin_{first}[k], &cos_{first}[k]);",
                self.helper("sin_cos")
            ),
        ];
        for (k, Sines { sin, cos, .. }) in sines.iter().enumerate() {
            lines.extend(sin.iter().map(|sin| self.bind(sin, &format!("sin_{first}[{k}]"))));
            lines.extend(cos.iter().map(|cos| self.bind(cos, &format!("cos_{first}[{k}]"))));
        }
        lines
    }

    fn bits_type(&self) -> &'static str {
        if self.0.is_f64() { "uint64_t" } else { "uint32_t" }
    }
}

impl Dialect for C {
    fn literal(&self, x: f64) -> String {
        if self.0.is_f64() { digits(x, self.0) } else { format!("{}f", digits(x, self.0)) }
    }
    fn entry(&self, array: &str, index: usize) -> String {
        format!("{array}[{index}]")
    }
    fn helper(&self, name: &str) -> String {
        let is_math = matches!(name, "sqrt" | "tanh");
        if is_math && !self.0.is_f64() { format!("{name}f") } else { name.to_string() }
    }
    fn bind(&self, name: &str, expression: &str) -> String {
        format!("const {} {name} = {expression};", self.number())
    }
    fn bind_sines(&self, sines: &[Sines]) -> Vec<String> {
        match sines {
            [one] => self.bind_sines_by(&self.helper("sin_cos"), one).to_vec(),
            _ => self.bind_sines_abreast(sines),
        }
    }
    fn bind_bits(&self, name: &str, expression: &str) -> String {
        format!("const {} {name} = {expression};", self.bits_type())
    }
    fn bits(&self, bits: u64) -> String {
        if self.0.is_f64() { format!("UINT64_C({bits:#x})") } else { format!("UINT32_C({bits:#x})") }
    }
    fn to_bits(&self, x: &str) -> String {
        format!("to_bits({x})")
    }
    fn number_of_bits(&self, x: &str) -> String {
        format!("from_bits({x})")
    }
    fn difference_of_bits(&self, a: &str, b: &str) -> String {
        format!("{a} - {b}")
    }
}

/// Emits the header and the source file.
pub(super) fn files(source: &Source) -> Vec<SourceFile> {
    let (c, name) = (C(source.precision), &source.name);
    let prototype = |function: &Emitted, restrict: &str| {
        format!("void {name}_{}({})", function.name, c.parameters(function, restrict))
    };

    let guard = format!("{}_H", name.to_ascii_uppercase());
    let mut header = comment(&source.about);
    header.push(format!("#ifndef {guard}\n#define {guard}\n\n#ifdef __cplusplus\nextern \"C\" {{\n#endif\n"));
    for function in &source.functions {
        header.extend(comment(&function.lines()));
        header.push(format!("{};\n", prototype(function, "")));
    }
    header.push("#ifdef __cplusplus\n}\n#endif\n\n#endif".to_string());

    let mut text = vec![format!("/* See {name}.h. */"), format!("#include \"{name}.h\"\n")];
    text.push("#include <float.h>\n#include <math.h>\n#include <stdint.h>".to_string());
    text.extend(helpers(source, &c));
    for function in &source.functions {
        text.push(format!("\n{}\n{{", prototype(function, "restrict ")));
        text.extend(function.unused().map(|input| format!("    (void) {};", input.name)));
        text.extend(body::lines(function, &c).iter().map(|line| format!("    {line}")));
        text.push("}".to_string());
    }
    let file = |ending: &str, lines: Vec<String>| SourceFile {
        name: format!("{name}.{ending}"),
        text: lines.iter().flat_map(|line| [line, "\n"]).collect(),
    };
    vec![file("h", header), file("c", text)]
}

/// A comment of several lines; nothing if there are no lines.
pub(super) fn comment(lines: &[String]) -> Vec<String> {
    let spaced =
        |(k, line): (usize, &String)| format!("{} {line}", if k == 0 { "/*" } else { " *" }).trim_end().to_string();
    let mut text: Vec<String> = lines.iter().enumerate().map(spaced).collect();
    if let Some(last) = text.last_mut() {
        last.push_str(" */");
    }
    text
}

/// Emits a b + c as one instruction if the processor has it, and refuses compilers that reorder sums.
pub(super) fn helpers(source: &Source, c: &C) -> Vec<String> {
    let (number, is_f64) = (c.number(), source.precision.is_f64());
    let mut lines = Vec::new();
    if source.has(|function| function.arity() == 3) || source.has_sines() {
        let suffix = if is_f64 { "" } else { "f" };
        lines.push(format!(
            "\n#ifdef FP_FAST_FMA{}\n#define mul_add(a, b, c) fma{suffix}(a, b, c)\n#else\n#define mul_add(a, b, c) ((a) * (b) + (c))\n#endif",
            suffix.to_ascii_uppercase()
        ));
    }
    if source.has(|function| function == Function::Sgn) {
        let [zero, one] = [0.0, 1.0].map(|x| c.literal(x));
        lines.push(format!(
            "\n/* -1, 0 or 1; NaN of NaN. */\nstatic inline {number} sgn({number} x)\n{{\n    return x > {zero} ? {one} : x < {zero} ? -{one} : x;\n}}"
        ));
    }
    if source.has_sines() {
        let (bits, largest) = (c.bits_type(), c.literal(source.precision.largest_angle()));
        lines.push(format!(
            "\n#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || FLT_EVAL_METHOD == 2{}\n\
             #error \"sums must be rounded as they stand: compile without -ffast-math, and not for the x87\"\n#endif",
            if is_f64 { "" } else { " || FLT_EVAL_METHOD == 1" }
        ));
        for (name, from, to) in [("to_bits", number, bits), ("from_bits", bits, number)] {
            lines.push(format!(
                "\nstatic inline {to} {name}({from} x)\n{{\n    const union {{ {number} number; {bits} bits; }} u = {{ .{} = x }};\n    return u.{};\n}}",
                if name == "to_bits" { "number" } else { "bits" },
                if name == "to_bits" { "bits" } else { "number" },
            ));
        }
        lines.push(format!(
            "\n/* Of |x| <= {largest}; beyond, NaN. */\nstatic inline void sin_cos({number} x, {number} *sin_x, {number} *cos_x)\n{{"
        ));
        lines.push(format!("    x = x >= -{largest} && x <= {largest} ? x : ({number}) NAN;"));
        let (body, [sin, cos]) = sin_cos::lines(source.precision, c);
        lines.extend(body.iter().map(|line| format!("    {line}")));
        lines.push(format!("    if (sin_x) *sin_x = {sin};\n    if (cos_x) *cos_x = {cos};\n}}"));
    }
    lines
}
