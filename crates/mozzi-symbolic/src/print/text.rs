//! Text with the book's letters.

use super::legend::legend;
use super::{Letter, Printer, Style, approximate};
use crate::atom::Name;
use crate::derivation::{Derivation, Formula};
use crate::expression::Expression;
use crate::letters::below;
use crate::rational::Rational;
use crate::steps::Steps;

pub(crate) struct Text {
    /// Fractions are written as such, not as decimals.
    pub has_fractions: bool,
}

const SUPERSCRIPTS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

fn above(k: i32) -> String {
    let digits = k.unsigned_abs().to_string();
    let sign = if k < 0 { "⁻" } else { "" };
    sign.to_string() + &digits.bytes().map(|digit| SUPERSCRIPTS[usize::from(digit - b'0')]).collect::<String>()
}

/// A letter with dots: θ̇.
pub(crate) fn dotted(letter: &str, dots: u8) -> String {
    format!("{letter}{}", ["", "\u{307}", "\u{308}"][usize::from(dots.min(2))])
}

impl Style for Text {
    fn number(&self, x: &Rational) -> String {
        let (a, b) = x.parts();
        let is_small = a.bits() < 8 && b.bits() < 8;
        match (self.has_fractions && is_small && x.integer().is_none(), x) {
            (true, Rational::Small(1, 2)) => "½".into(),
            (true, Rational::Small(1, 4)) => "¼".into(),
            (true, Rational::Small(3, 4)) => "¾".into(),
            (true, Rational::Small(1, 8)) => "⅛".into(),
            (true, _) => format!("({a}/{b})"),
            _ => x.to_decimal().or_else(|| approximate(x)).unwrap_or_else(|| format!("({x})")),
        }
    }
    fn name(&self, name: &Name) -> String {
        let number = name.number.map_or(String::new(), below);
        let clean = name.part.replace(|c: char| !c.is_alphanumeric() && c != '\'', "_"); // a hyphen is no minus
        let part = match (&clean[..], name.number) {
            ("", _) => String::new(),
            (part, Some(_)) if part.len() <= 2 => part.to_string(),
            (part, _) => format!("_{part}"),
        };
        format!("{}{number}{part}", dotted(name.letter, name.dots))
    }
    fn sine(&self, is_cosine: bool, angle: &str, is_single: bool, power: i32) -> String {
        let function = if is_cosine { "cos" } else { "sin" };
        let power = if power == 1 { String::new() } else { above(power) };
        if is_single { format!("{function}{power} {angle}") } else { format!("{function}{power}({angle})") }
    }
    fn root(&self, n: u64) -> String {
        format!("√{n}")
    }
    fn pi(&self) -> &'static str {
        "π"
    }
    fn sign(&self, inner: &str) -> String {
        format!("sgn({inner})")
    }
    fn inverse(&self, inner: &str) -> String {
        format!("({inner})⁻¹")
    }
    fn power(&self, base: &str, k: i32) -> String {
        format!("{base}{}", above(k))
    }
    fn times(&self, left: &str, right: &str) -> String {
        let is_function = |text: &str| ["sin", "cos", "sgn"].iter().any(|name| text.starts_with(name));
        let last = left.rsplit(' ').next().unwrap_or("");
        // a function's argument ends at a space; names with letters below the line need one
        let ends_open = left.rsplit(['(', ')']).next().is_some_and(|text| text.contains("sin") || text.contains("cos"));
        let ends_in_letters = last.chars().last().is_some_and(|c| c.is_ascii_lowercase() && last.chars().count() > 1);
        let starts_long = right.contains('_') || last.contains('√');
        let digits = right.starts_with(|c: char| c.is_ascii_digit());
        let ends_open = ends_open || right.starts_with('(') && (left.contains("sin") || left.contains("cos"));
        match is_function(right) || ends_open || ends_in_letters || starts_long || digits || left.contains('_') {
            true => format!("{left} {right}"),
            false => format!("{left}{right}"),
        }
    }
    fn multiple(&self, k: &Rational, angle: &str) -> String {
        match k.parts() {
            (a, b) if a == 1.into() => format!("{angle}/{b}"),
            _ => format!("{k}{angle}"),
        }
    }
}

/// Columns of a line of text.
const WIDE: usize = 80;

/// Columns that a text takes: the dots above letters take none.
fn width(text: &str) -> usize {
    text.chars().filter(|c| !('\u{300}'..'\u{370}').contains(c)).count()
}

/// Lines of at most [`WIDE`] columns, broken before a sign or after a comma; further parts are indented.
fn page_of(lines: &[String]) -> String {
    let mut page = String::new();
    for line in lines {
        let mut part = String::new();
        for piece in pieces(line) {
            if !part.trim().is_empty() && width(&part) + width(piece) > WIDE {
                page += part.trim_end();
                part = "\n   ".into();
                part += if piece.starts_with(' ') { "" } else { " " };
            }
            part += piece;
        }
        page += part.trim_end();
        page.push('\n');
    }
    page
}

/// The parts of a line between which it may be broken.
fn pieces(line: &str) -> impl Iterator<Item = &str> {
    let mut rest = line;
    std::iter::from_fn(move || {
        let after_first = rest.chars().next()?.len_utf8();
        let signs = [" + ", " − "].map(|sign| rest[after_first..].find(sign));
        let comma = rest.find(", ").map(|at| at + 2 - after_first);
        let end = signs.into_iter().chain([comma]).flatten().min().map_or(rest.len(), |at| at + after_first);
        let (piece, tail) = rest.split_at(end);
        rest = tail;
        Some(piece)
    })
}

pub(crate) fn page(derivation: &Derivation) -> String {
    let style = Text { has_fractions: derivation.has_fractions };
    let printer = Printer::of(derivation, &style);
    let mut lines = Vec::new();
    for (k, name) in derivation.names.iter().enumerate() {
        lines.push(format!("{} = {}", printer.named(k), minus(&printer.expression(name))));
    }
    for formula in &derivation.formulas {
        let Letter { letter, dots, frame } = derivation.letter(formula);
        let frame = if frame.is_empty() { String::new() } else { format!("_{frame}") };
        let symbol = format!("{}{frame}", dotted(letter, dots));
        let below = derivation.denominator_number(formula).map(delta);
        let left = format!("{symbol}{}", arguments(derivation, formula));
        lines.extend(equation(&printer, formula, &symbol, &left, below.as_deref()));
    }
    for (k, denominator) in derivation.denominators() {
        let name = delta(derivation.denominator_name(k));
        lines.push(format!("{name} = {}", minus(&printer.expression(denominator))));
    }
    lines.extend(legend(&derivation.legend, &derivation.angles, &style));
    page_of(&lines)
}

/// The recursion, part by part.
pub(crate) fn steps(steps: &Steps) -> String {
    let style = Text { has_fractions: steps.has_fractions };
    let printer = Printer { style: &style, table: &steps.table, letter: "", first: 0 };
    let mut lines = Vec::new();
    for step in &steps.steps {
        if let Some(title) = &step.title {
            lines.extend([String::new(), title.clone()]);
        }
        let formula = &step.formula;
        let inline =
            formula.entries.iter().map(|entry| minus(&printer.expression(entry))).collect::<Vec<_>>().join(", ");
        match formula.shape[..] {
            [6] if width(&inline) + width(&step.text) + 5 <= WIDE => lines.push(format!("{} = ({inline})", step.text)),
            _ => lines.extend(equation(&printer, formula, &step.text, &step.text, None)),
        }
    }
    lines.extend(legend(&steps.legend, &[], &style));
    page_of(&lines).trim_start().to_string()
}

/// The symbol of a denominator.
fn delta(number: Option<usize>) -> String {
    format!("Δ{}", number.map_or(String::new(), below))
}

/// A formula as a matrix, or entry by entry, with the symbol of its denominator.
fn equation(printer: &Printer<Text>, formula: &Formula, symbol: &str, left: &str, over: Option<&str>) -> Vec<String> {
    let mut written: Vec<String> = formula.entries.iter().map(|entry| minus(&printer.expression(entry))).collect();
    if let Some(rows) = matrix(formula, &written) {
        let outside = over.map_or(String::new(), |delta| format!(" 1/{delta} ·"));
        return [vec![format!("{left} ={outside}")], rows].concat();
    }
    if let Some(delta) = over {
        for (text, entry) in written.iter_mut().zip(&formula.entries) {
            let is_sum = matches!(entry, Expression::Sum(_));
            *text = if is_sum { format!("({text})/{delta}") } else { format!("{text}/{delta}") };
        }
    }
    entries(formula, symbol, left, &written)
}

fn minus(text: &str) -> String {
    text.replace('-', "−")
}

/// (θ, θ̇), for the inputs of a formula.
fn arguments(derivation: &Derivation, formula: &Formula) -> String {
    let symbol = |name: &'static str| match name {
        "theta" => "θ".to_string(),
        "dtheta" => dotted("θ", 1),
        "ddtheta" => dotted("θ", 2),
        "tau" => "τ".to_string(),
        name => name.to_string(),
    };
    let symbols: Vec<String> = formula.arguments(derivation).map(symbol).collect();
    if symbols.is_empty() { String::new() } else { format!("({})", symbols.join(", ")) }
}

/// Rows in brackets, if they fit a line.
fn matrix(formula: &Formula, written: &[String]) -> Option<Vec<String>> {
    let columns = match formula.shape[..] {
        [_] => 1,
        [_, columns] => columns.max(1),
        _ => return None,
    };
    let widest = |j| written.iter().skip(j).step_by(columns).map(|text| width(text)).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(widest).collect();
    if widths.iter().sum::<usize>() + 3 * columns + 4 > WIDE {
        return None;
    }
    let pad = |text: &String, to: usize| format!("{text}{}", " ".repeat(to - width(text)));
    let row = |row: &[String]| {
        let cells: Vec<String> = row.iter().zip(&widths).map(|(cell, &to)| pad(cell, to)).collect();
        format!("  [ {} ]", cells.join("   "))
    };
    Some(written.chunks(columns).map(row).collect())
}

/// One entry a line; of a symmetric matrix those on and above the diagonal; zeros together.
fn entries(formula: &Formula, letter: &str, left: &str, written: &[String]) -> Vec<String> {
    if formula.shape.is_empty() {
        return vec![format!("{left} = {}", written.first().map_or("0", String::as_str))];
    }
    let index = |k: usize| {
        let index = formula.index(k);
        let separator = if index.iter().any(|i| *i > 9) { "," } else { "" };
        index.iter().map(|i| below(*i)).collect::<Vec<_>>().join(separator)
    };
    let mut lines = Vec::new();
    let mut zeros = 0;
    for k in formula.distinct() {
        if formula.entries[k] == Expression::ZERO {
            zeros += 1;
            continue;
        }
        let mut name = format!("{letter}{}", index(k));
        if formula.is_symmetric && formula.is_matrix() {
            let n = formula.shape[1];
            if k / n != k % n {
                name = format!("{name} = {letter}{}", index(k % n * n + k / n));
            }
        }
        lines.push(format!("{name} = {}", written[k]));
    }
    if zeros > 0 {
        let which = if lines.is_empty() { "all" } else { "the other" };
        lines.push(format!("{which} entries of {left} are 0"));
    }
    lines
}
