//! A Python module of SymPy expressions, with exact numbers.

use super::code::delta;
use super::legend::angles;
use super::{Printer, Style};
use crate::atom::Name;
use crate::derivation::Derivation;
use crate::letters::plain_name;
use crate::rational::Rational;

pub(crate) struct Sympy;

impl Style for Sympy {
    fn number(&self, x: &Rational) -> String {
        let (a, b) = x.parts();
        if b == 1.into() { format!("{a}") } else { format!("Rational({a}, {b})") }
    }
    fn name(&self, name: &Name) -> String {
        plain_name(name)
    }
    fn sine(&self, is_cosine: bool, angle: &str, _: bool, power: i32) -> String {
        let function = if is_cosine { "cos" } else { "sin" };
        self.power(&format!("{function}({angle})"), power)
    }
    fn root(&self, n: u64) -> String {
        format!("sqrt({n})")
    }
    fn pi(&self) -> &'static str {
        "pi"
    }
    fn sign(&self, inner: &str) -> String {
        format!("sign({inner})")
    }
    fn inverse(&self, inner: &str) -> String {
        format!("(1/({inner}))")
    }
    fn power(&self, base: &str, k: i32) -> String {
        if k == 1 { base.to_string() } else { format!("{base}**{}", exponent(k)) }
    }
    fn times(&self, left: &str, right: &str) -> String {
        format!("{left}*{right}")
    }
    fn multiple(&self, k: &Rational, angle: &str) -> String {
        format!("{}*{angle}", self.number(k))
    }
}

fn exponent(k: i32) -> String {
    if k < 0 { format!("({k})") } else { k.to_string() }
}

pub(crate) fn module(derivation: &Derivation) -> String {
    let printer = Printer::of(derivation, &Sympy);
    let mut lines =
        vec!["from sympy import Matrix, Rational, cos, pi, sign, sin, sqrt, symbols".to_string(), String::new()];
    lines.extend(angles(&derivation.angles).map(|note| format!("# {note}")));
    for (input, ids) in derivation.inputs.iter().filter(|(_, ids)| !ids.is_empty()) {
        let names: Vec<String> = ids.iter().map(|&id| printer.atom(id, 1)).collect();
        let tuple = if names.len() == 1 { format!("{},", names[0]) } else { names.join(", ") };
        lines.push(format!("{input} = {tuple} = symbols(\"{}\", real=True, seq=True)", names.join(" ")));
    }
    for meaning in &derivation.legend {
        let name = Sympy.name(&meaning.name);
        let places = meaning.places.join("; ");
        lines.push(format!("{name} = symbols(\"{name}\", real=True)  # {} {}: {places}", meaning.value, meaning.unit));
    }
    let value = |meaning: &crate::parameters::Meaning| {
        format!("{}: {}", Sympy.name(&meaning.name), Sympy.number(&meaning.value))
    };
    let values: Vec<String> = derivation.legend.iter().map(value).collect();
    lines.extend([format!("values = {{{}}}  # of the file", values.join(", ")), String::new()]);
    for (k, name) in derivation.names.iter().enumerate() {
        lines.push(format!("{} = {}", printer.named(k), printer.expression(name)));
    }
    for (k, denominator) in derivation.denominators() {
        lines.push(format!("{} = {}", delta(derivation.denominator_name(k)), printer.expression(denominator)));
    }
    for formula in &derivation.formulas {
        let name = match derivation.formulas.len() {
            1 => derivation.quantity,
            _ => formula.name,
        };
        let entries: Vec<String> = formula.entries.iter().map(|entry| printer.expression(entry)).collect();
        let right = match formula.shape[..] {
            [] if formula.denominator.is_some() => format!("({})", entries.concat()),
            [] => entries.concat(),
            [rows] => format!("Matrix({rows}, 1, [{}])", entries.join(", ")),
            [rows, columns] => format!("Matrix({rows}, {columns}, [\n    {},\n])", entries.join(",\n    ")),
            _ => {
                let shape: Vec<String> = formula.shape.iter().map(usize::to_string).collect();
                lines[0] = lines[0].replace("import Matrix", "import ImmutableDenseNDimArray, Matrix");
                format!("ImmutableDenseNDimArray([{}], ({},))", entries.join(", "), shape.join(", "))
            }
        };
        let below = derivation.denominator_number(formula).map_or(String::new(), |k| format!("/{}", delta(k)));
        lines.push(format!("{name} = {right}{below}"));
    }
    lines.join("\n") + "\n"
}
