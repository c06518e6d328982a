//! Functions in Python, MATLAB and Julia, on doubles. Parameters are arguments with the file's numbers as defaults; in
//! MATLAB they are assigned at the function's head.

use super::legend::angles;
use super::{Language, Printer, Style};
use crate::atom::{Class, Id, Name};
use crate::derivation::{Derivation, Formula};
use crate::expression::Expression;
use crate::letters::plain_name;
use crate::parameters::Meaning;
use crate::rational::Rational;
use std::collections::BTreeSet;

pub(crate) struct Code {
    language: Language,
}

impl Style for Code {
    fn number(&self, x: &Rational) -> String {
        let text = format!("{:?}", x.to_f64());
        if x.is_negative() { format!("({text})") } else { text }
    }
    fn name(&self, name: &Name) -> String {
        plain_name(name)
    }
    fn sine(&self, is_cosine: bool, angle: &str, _: bool, power: i32) -> String {
        let function = if is_cosine { "cos" } else { "sin" };
        let one = format!("{function}({angle})");
        if power == 1 { one } else { self.power(&one, power) }
    }
    fn root(&self, n: u64) -> String {
        format!("sqrt({n}.0)")
    }
    fn pi(&self) -> &'static str {
        "pi"
    }
    fn sign(&self, inner: &str) -> String {
        format!("sign({inner})")
    }
    fn inverse(&self, inner: &str) -> String {
        format!("(1.0/({inner}))")
    }
    fn power(&self, base: &str, k: i32) -> String {
        let operator = if self.language == Language::Python { "**" } else { "^" };
        if k < 0 { format!("{base}{operator}({k})") } else { format!("{base}{operator}{k}") }
    }
    fn times(&self, left: &str, right: &str) -> String {
        format!("{left}*{right}")
    }
    fn multiple(&self, k: &Rational, angle: &str) -> String {
        format!("{}*{angle}", self.number(k))
    }
}

pub(crate) fn function(derivation: &Derivation, language: Language) -> String {
    let style = Code { language };
    let printer = Printer::of(derivation, &style);
    let (name, inputs) = (derivation.quantity, derivation.inputs.iter().map(|(name, _)| *name).collect::<Vec<_>>());
    let parameters: Vec<(String, String, &Meaning)> = derivation
        .legend
        .iter()
        .map(|meaning| (style.name(&meaning.name), format!("{:?}", meaning.value.to_f64()), meaning))
        .collect();
    let mut body = Vec::new();
    let used = used(derivation);
    for (input, ids) in &derivation.inputs {
        for (k, id) in ids.iter().enumerate().filter(|(_, id)| used.contains(id)) {
            let at = match language {
                Language::Python => format!("{input}[{k}]"),
                Language::Matlab => format!("{input}({})", k + 1),
                _ => format!("{input}[{}]", k + 1),
            };
            body.push(format!("{} = {at}", printer.atom(*id, 1)));
        }
    }
    for (k, expression) in derivation.names.iter().enumerate() {
        body.push(format!("{} = {}", printer.named(k), printer.expression(expression)));
    }
    let results: Vec<&str> = derivation.formulas.iter().map(|formula| formula.name).collect();
    let outputs: Vec<String> = results.iter().map(|name| format!("out_{name}")).collect();
    for (k, denominator) in derivation.denominators() {
        body.push(format!("{} = {}", delta(derivation.denominator_name(k)), printer.expression(denominator)));
    }
    for (formula, output) in derivation.formulas.iter().zip(&outputs) {
        let below = derivation.denominator_number(formula).map_or(String::new(), |k| format!("/{}", delta(k)));
        body.push(format!("{output} = {}{below}", array(formula, &printer, language)));
    }
    let note = angles(&derivation.angles).map_or(String::new(), |note| format!("; {note}"));
    let about = format!("{name}: {} in this order{note}", results.join(", "));
    let all = outputs.join(", ");
    match language {
        Language::Python => {
            let arguments: Vec<String> = inputs
                .iter()
                .map(|x| x.to_string())
                .chain(parameters.iter().map(|(name, value, _)| format!("{name}={value}")))
                .collect();
            let note = |(name, _, meaning): &(String, String, &Meaning)| {
                format!("    # {name}: {}, {}", meaning.places.join("; "), meaning.unit)
            };
            let notes: Vec<String> = parameters.iter().map(note).collect();
            let body: Vec<String> = body.iter().map(|line| format!("    {line}")).collect();
            let head = "from numpy import array, cos, pi, sign, sin, sqrt\n\n\n";
            let lines = [vec![format!("    \"\"\"{about}.\"\"\"")], notes, body, vec![format!("    return {all}")]];
            format!("{head}def {name}({}):\n{}\n", arguments.join(", "), lines.concat().join("\n"))
        }
        Language::Matlab => {
            let given = parameters.iter().map(|(name, value, meaning)| {
                format!("{name} = {value}; % {}, {}", meaning.places.join("; "), meaning.unit)
            });
            let lines = given.chain(body.iter().map(|line| format!("{line};")));
            let lines: Vec<String> = lines.map(|line| format!("  {line}")).collect();
            let outputs = if results.len() == 1 { all } else { format!("[{all}]") };
            format!("function {outputs} = {name}({})\n  % {about}\n{}\nend\n", inputs.join(", "), lines.join("\n"))
        }
        _ => {
            let keywords: Vec<String> = parameters.iter().map(|(name, value, _)| format!("{name}={value}")).collect();
            let keywords = if keywords.is_empty() { String::new() } else { format!("; {}", keywords.join(", ")) };
            let lines: Vec<String> = body.iter().map(|line| format!("    {line}")).collect();
            let head = format!("\"{about}\"\nfunction {name}({}{keywords})", inputs.join(", "));
            format!("{head}\n{}\n    return {all}\nend\n", lines.join("\n"))
        }
    }
}

/// The name of a denominator.
pub(super) fn delta(number: Option<usize>) -> String {
    format!("Delta{}", number.map_or(String::new(), |k| k.to_string()))
}

/// Atoms of the state that occur, also within sines and signs.
fn used(derivation: &Derivation) -> BTreeSet<Id> {
    use crate::atom::{Angle, Atom};
    let mut found = BTreeSet::new();
    derivation.expressions().for_each(|expression| expression.atoms(&mut found));
    let mut all = found.clone();
    for id in found {
        match derivation.table.atom(id) {
            Atom::Trig(trig) => {
                let angles = trig.harmonic.iter().zip(&derivation.table.groups[trig.group].angles);
                all.extend(angles.filter(|(k, _)| **k != 0).filter_map(|(_, angle)| match angle {
                    Angle::Joint { position, .. } => Some(*position),
                    Angle::Constant(_) => None,
                }));
            }
            Atom::Sign(p) | Atom::Inverse(p) => {
                all.extend(p.terms().iter().flat_map(|(m, _)| m.factors().map(|(id, _)| id)));
            }
            _ => {}
        }
    }
    all.retain(|&id| derivation.table.class(id) != Class::Trigonometric);
    all
}

/// The entries as the language's array; more than two axes by their shape, in the order of C.
fn array(formula: &Formula, printer: &Printer<Code>, language: Language) -> String {
    let entries: Vec<String> = formula.entries.iter().map(|entry| printer.expression(entry)).collect();
    let zero = printer.expression(&Expression::ZERO);
    let rows = |open: &str, join: &str, close: &str, columns: usize| {
        let rows: Vec<String> = entries.chunks(columns.max(1)).map(|row| row.join(join)).collect();
        rows.iter().map(|row| format!("{open}{row}{close}")).collect::<Vec<String>>()
    };
    match (&formula.shape[..], language) {
        ([], _) => entries.first().cloned().unwrap_or(zero),
        ([_], Language::Python) => format!("array([{}])", entries.join(", ")),
        ([_, columns], Language::Python) => {
            format!("array([{}])", rows("[", ", ", "]", *columns).join(",\n        "))
        }
        (shape, Language::Python) => format!("array([{}]).reshape({shape:?})", entries.join(", ")),
        ([_], Language::Matlab) => format!("[{}]", entries.join("; ")),
        ([_, columns], Language::Matlab) => format!("[{}]", rows("", ", ", "", *columns).join("; ...\n    ")),
        (shape, Language::Matlab) => {
            // MATLAB's arrays are by columns
            let (reversed, order): (Vec<String>, Vec<String>) =
                (0..shape.len()).rev().map(|k| (shape[k].to_string(), (k + 1).to_string())).unzip();
            format!("permute(reshape([{}], [{}]), [{}])", entries.join(", "), reversed.join(", "), order.join(", "))
        }
        ([_], _) => format!("[{}]", entries.join(", ")),
        ([rows, 1], _) => format!("reshape([{}], ({rows}, 1))", entries.join(", ")), // [a; b] is a vector
        ([_, columns], _) => {
            format!("[{}]", rows("", " ", "", *columns).join("; ").replace(" + ", "+").replace(" - ", "-"))
        }
        (shape, _) => {
            let (reversed, order): (Vec<String>, Vec<String>) =
                (0..shape.len()).rev().map(|k| (shape[k].to_string(), (k + 1).to_string())).unzip();
            format!("permutedims(reshape([{}], ({})), ({}))", entries.join(", "), reversed.join(", "), order.join(", "))
        }
    }
}
