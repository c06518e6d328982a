//! LaTeX with amsmath.

use super::legend::angles;
use super::{Letter, Printer, Style, approximate};
use crate::atom::Name;
use crate::derivation::{Derivation, Formula};
use crate::expression::Expression;
use crate::letters::printable;
use crate::parameters::Meaning;
use crate::rational::Rational;
use crate::steps::Steps;
use num_traits::ToPrimitive;

pub(crate) struct Latex;

/// A Greek letter, or the letter itself.
fn letter(letter: &str) -> &str {
    match letter {
        "θ" => r"\theta",
        "τ" => r"\tau",
        "φ" => r"\varphi",
        "μ" => r"\mu",
        "η" => r"\eta",
        "λ" => r"\lambda",
        "Λ" => r"\Lambda",
        "M⁻¹" => "M^{-1}",
        "π_b" => r"{\pi_b}",
        "Y_b" => "{Y_b}",
        other => other,
    }
}

fn dotted(text: &str, dots: u8) -> String {
    match dots {
        0 => letter(text).to_string(),
        1 => format!(r"\dot{{{}}}", letter(text)),
        _ => format!(r"\ddot{{{}}}", letter(text)),
    }
}

/// True for x, zz, ωx, and for links of so short names.
fn is_axis(part: &str) -> bool {
    part.chars().count() <= 2 && part.chars().all(|c| c.is_ascii_alphanumeric() || c == 'ω' || c == '\'')
}

/// The text of a link's name.
fn escaped(text: &str) -> String {
    let each = |c: char| match c {
        '_' | '%' | '$' | '#' | '&' | '{' | '}' => format!(r"\{c}"),
        '\\' => r"\backslash ".into(),
        '^' => r"\wedge ".into(), // accents of text are none of formulas
        '~' => r"\sim ".into(),
        c => c.to_string(),
    };
    printable(text).chars().map(each).collect()
}

impl Style for Latex {
    fn number(&self, x: &Rational) -> String {
        let (a, b) = x.parts();
        match x.to_decimal() {
            Some(text) if x.integer().is_some() || ![2, 4, 8].contains(&b.to_u64().unwrap_or(0)) => text,
            _ => match approximate(x) {
                Some(text) => text.replace('…', r"\ldots "),
                None => format!(r"\tfrac{{{a}}}{{{b}}}"),
            },
        }
    }
    fn name(&self, name: &Name) -> String {
        let part = match &name.part[..] {
            part if is_axis(part) => part.replace('ω', r"\omega "),
            part => format!(r"\mathrm{{{}}}", escaped(part)),
        };
        let number = name.number.map(|n| n.to_string());
        let below: Vec<String> = number.into_iter().chain([part]).filter(|part| !part.is_empty()).collect();
        match below.is_empty() {
            true => dotted(name.letter, name.dots),
            false => format!("{}_{{{}}}", dotted(name.letter, name.dots), below.join(",")),
        }
    }
    fn sine(&self, is_cosine: bool, angle: &str, is_single: bool, power: i32) -> String {
        let function = if is_cosine { r"\cos" } else { r"\sin" };
        let power = if power == 1 { String::new() } else { format!("^{{{power}}}") };
        match is_single {
            true => format!("{function}{power} {angle}"),
            false => format!("{function}{power}({angle})"),
        }
    }
    fn root(&self, n: u64) -> String {
        format!(r"\sqrt{{{n}}}")
    }
    fn pi(&self) -> &'static str {
        r"\pi"
    }
    fn sign(&self, inner: &str) -> String {
        format!(r"\operatorname{{sgn}}({inner})")
    }
    fn inverse(&self, inner: &str) -> String {
        format!(r"\frac{{1}}{{{inner}}}")
    }
    fn power(&self, base: &str, k: i32) -> String {
        match base.starts_with(r"\frac") {
            true => format!("({base})^{{{k}}}"),
            false => format!("{base}^{{{k}}}"),
        }
    }
    fn times(&self, left: &str, right: &str) -> String {
        let is_digit = |c: char| c.is_ascii_digit();
        match left.ends_with(is_digit) && right.starts_with(is_digit) {
            true => format!(r"{left} \cdot {right}"),
            false => format!(r"{left} \, {right}"),
        }
    }
    fn multiple(&self, k: &Rational, angle: &str) -> String {
        format!("{}{angle}", self.number(k))
    }
}

pub(crate) fn page(derivation: &Derivation) -> String {
    let page: String = formulas(derivation).iter().map(|formula| format!("\\[\n{formula}\n\\]\n")).collect();
    let note = angles(&derivation.angles).map_or(String::new(), |note| format!("% {}\n", note.replace('π', "pi")));
    page + &note.replace('−', "-")
}

/// Markdown, with the symbols in a table.
pub(crate) fn markdown(derivation: &Derivation) -> String {
    let page: String = formulas(derivation).iter().map(|formula| format!("$$\n{formula}\n$$\n\n")).collect();
    let note = angles(&derivation.angles).map_or(String::new(), |note| format!("\n{note}\n"));
    page + &symbols(&derivation.legend) + &note
}

fn symbols(legend: &[Meaning]) -> String {
    let mut page = String::new();
    if !legend.is_empty() {
        page.push_str("| symbol | in the file | unit | where |\n|---|---|---|---|\n");
    }
    for meaning in legend {
        let name = Latex.name(&meaning.name);
        let places = meaning.places.join("; ").replace('|', r"\|").replace('<', r"\<");
        page.push_str(&format!("| ${name}$ | {} | {} | {places} |\n", meaning.value, meaning.unit));
    }
    page
}

/// The recursion, part by part, in LaTeX or Markdown.
pub(crate) fn steps(steps: &Steps, is_markdown: bool) -> String {
    let printer = Printer { style: &Latex, table: &steps.table, letter: "", first: 0 };
    let mut page = String::new();
    for step in &steps.steps {
        if let Some(title) = &step.title {
            page.push_str(&if is_markdown { format!("**{title}**\n\n") } else { format!("\n% {title}\n") });
        }
        let formula = equation(&step.latex, &step.formula, &step.latex, &printer, None);
        page.push_str(&if is_markdown { format!("$$\n{formula}\n$$\n\n") } else { format!("\\[\n{formula}\n\\]\n") });
    }
    if is_markdown { page + &symbols(&steps.legend) } else { page.trim_start().to_string() }
}

/// Each output as a formula without delimiters.
pub(crate) fn formulas(derivation: &Derivation) -> Vec<String> {
    let printer = Printer::of(derivation, &Latex);
    let mut all = Vec::new();
    if !derivation.names.is_empty() {
        let line = |(k, name): (usize, &Expression)| format!("{} &= {}", printer.named(k), printer.expression(name));
        let lines: Vec<String> = derivation.names.iter().enumerate().map(line).collect();
        all.push(format!("\\begin{{aligned}}\n{}\n\\end{{aligned}}", lines.join(" \\\\\n")));
    }
    for formula in &derivation.formulas {
        let Letter { letter: name, dots, frame } = derivation.letter(formula);
        let name = match name.len() > 2 && name.is_ascii() && letter(name) == name {
            true => format!(r"\mathrm{{{}}}", name.replace('_', r"\_")),
            false => dotted(name, dots),
        };
        let name = if frame.is_empty() { name } else { format!("{name}^{{{frame}}}") };
        let below = derivation.denominator_number(formula).map(delta);
        all.push(equation(
            &format!("{name}{}", arguments(derivation, formula)),
            formula,
            &name,
            &printer,
            below.as_deref(),
        ));
    }
    for (k, denominator) in derivation.denominators() {
        all.push(format!("{} = {}", delta(derivation.denominator_name(k)), printer.expression(denominator)));
    }
    all
}

/// Wider matrices are written entry by entry.
const WIDE: usize = 700;

/// The symbol of a denominator.
fn delta(number: Option<usize>) -> String {
    format!(r"\Delta{}", number.map_or(String::new(), |k| format!("_{{{k}}}")))
}

fn equation(left: &str, formula: &Formula, name: &str, printer: &Printer<Latex>, over: Option<&str>) -> String {
    let mut written: Vec<String> = formula.entries.iter().map(|entry| printer.expression(entry)).collect();
    let columns = match formula.shape[..] {
        [] => return format!("{left} = {}", written.first().map_or("0", String::as_str)),
        [_] => 1,
        [_, columns] => columns.max(1),
        _ => 0,
    };
    let longest = written.chunks(columns.max(1)).map(|row| row.iter().map(String::len).sum()).max().unwrap_or(0);
    if columns > 0 && longest <= WIDE {
        let rows: Vec<String> = written.chunks(columns).map(|row| row.join(" & ")).collect();
        let outside = over.map_or(String::new(), |delta| format!(r"\frac{{1}}{{{delta}}}"));
        return format!("{left} = {outside}\\begin{{bmatrix}}\n{}\n\\end{{bmatrix}}", rows.join(" \\\\\n"));
    }
    if let Some(delta) = over {
        written.iter_mut().for_each(|text| *text = format!(r"\frac{{{text}}}{{{delta}}}"));
    }
    let mut lines = Vec::new();
    for k in formula.distinct().filter(|&k| formula.entries[k] != Expression::ZERO) {
        let index: Vec<String> = formula.index(k).iter().map(usize::to_string).collect();
        lines.push(format!("{name}_{{{}}} &= {}", index.join(","), written[k]));
    }
    if lines.is_empty() {
        return format!("{left} = 0");
    }
    format!("\\begin{{aligned}}\n{}\n\\end{{aligned}}", lines.join(" \\\\\n"))
}

fn arguments(derivation: &Derivation, formula: &Formula) -> String {
    let symbol = |name: &'static str| match name {
        "theta" => r"\theta",
        "dtheta" => r"\dot{\theta}",
        "ddtheta" => r"\ddot{\theta}",
        "tau" => r"\tau",
        name => name,
    };
    let symbols: Vec<&str> = formula.arguments(derivation).map(symbol).collect();
    if symbols.is_empty() { String::new() } else { format!("({})", symbols.join(", ")) }
}
