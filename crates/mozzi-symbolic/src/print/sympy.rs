//! A Python module of SymPy expressions, with exact numbers.

use super::code::delta;
use super::legend::angles;
use super::{Printer, Style};
use crate::atom::Name;
use crate::cse::free_letter;
use crate::derivation::{Derivation, Formula};
use crate::letters::plain_name;
use crate::parameters::Meaning;
use crate::rational::Rational;
use std::collections::HashMap;

#[derive(Default)]
pub(crate) struct Sympy {
    /// Symbols that are not written by their plain names, which mean something else in the module.
    renamed: HashMap<Name, String>,
}

impl Style for Sympy {
    fn number(&self, x: &Rational) -> String {
        let (a, b) = x.parts();
        if b == 1.into() { format!("{a}") } else { format!("Rational({a}, {b})") }
    }
    fn name(&self, name: &Name) -> String {
        self.renamed.get(name).cloned().unwrap_or_else(|| plain_name(name))
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

/// A module of one robot's derivations, in which each name has one meaning.
pub(crate) fn module(derivations: &[&Derivation]) -> String {
    let mut module = Module::default();
    let styles: Vec<Sympy> = derivations.iter().map(|derivation| module.declare(derivation)).collect();
    let names: Vec<String> = derivations.iter().flat_map(|derivation| derivation.plain_names()).collect();
    let letter = free_letter(&names);
    module.outputs = derivations.iter().flat_map(|derivation| outputs(derivation)).collect();
    module.denominators = derivations.iter().map(|derivation| derivation.denominators().count()).sum();
    let (mut named, mut divided) = (0, 0);
    for (derivation, style) in derivations.iter().zip(&styles) {
        let printer = Printer {
            letter: letter.unwrap_or(derivation.letter_of_names),
            first: named,
            ..Printer::of(derivation, style)
        };
        module.define(derivation, &printer, divided);
        named += derivation.names.len();
        divided += derivation.denominators().count();
    }
    module.text()
}

/// The name of an output in a module of its own.
fn output<'d>(derivation: &'d Derivation, formula: &'d Formula) -> &'d str {
    if derivation.formulas.len() == 1 { derivation.quantity } else { formula.name }
}

fn outputs(derivation: &Derivation) -> impl Iterator<Item = String> {
    derivation.formulas.iter().map(|formula| output(derivation, formula).to_string())
}

#[derive(Default)]
struct Module {
    notes: Vec<String>,
    /// The vectors of the state and their entries.
    inputs: Vec<(&'static str, Vec<String>)>,
    symbols: Vec<(String, Meaning)>,
    outputs: Vec<String>,
    denominators: usize,
    definitions: Vec<String>,
}

impl Module {
    /// Adds a derivation's inputs and symbols; the style that writes them.
    fn declare(&mut self, derivation: &Derivation) -> Sympy {
        let mut style = Sympy::default();
        for meaning in &derivation.legend {
            let mut name = plain_name(&meaning.name);
            let known = self.symbols.iter().find(|(known, _)| *known == name);
            if known.is_some_and(|(_, known)| (&known.value, &known.places) != (&meaning.value, &meaning.places)) {
                name = format!("{name}_{}", derivation.quantity);
                style.renamed.insert(meaning.name.clone(), name.clone());
            } else if known.is_some() {
                continue;
            }
            self.symbols.push((name, meaning.clone()));
        }
        let note = angles(&derivation.angles).filter(|note| !self.notes.contains(note));
        self.notes.extend(note);
        let printer = Printer::of(derivation, &style);
        for (input, ids) in derivation.inputs.iter().filter(|(_, ids)| !ids.is_empty()) {
            if !self.inputs.iter().any(|(known, _)| known == input) {
                self.inputs.push((*input, ids.iter().map(|&id| printer.atom(id, 1)).collect()));
            }
        }
        style
    }

    /// The name of an output: with the quantity's where others have it, too.
    fn name(&self, derivation: &Derivation, formula: &Formula) -> String {
        let name = output(derivation, formula);
        let mut given = self.inputs.iter().flat_map(|(input, names)| names.iter().map(String::as_str).chain([*input]));
        let is_given = given.any(|other| other == name) || self.symbols.iter().any(|(other, _)| other == name);
        if is_given || self.outputs.iter().filter(|other| *other == name).count() > 1 {
            format!("{}_{}", derivation.quantity, formula.name)
        } else {
            name.to_string()
        }
    }

    fn define(&mut self, derivation: &Derivation, printer: &Printer<Sympy>, divided: usize) {
        for (k, name) in derivation.names.iter().enumerate() {
            self.definitions.push(format!("{} = {}", printer.named(k), printer.expression(name)));
        }
        let number = |k: usize| delta((self.denominators > 1).then_some(divided + k + 1));
        for (k, denominator) in derivation.denominators() {
            self.definitions.push(format!("{} = {}", number(k), printer.expression(denominator)));
        }
        for formula in &derivation.formulas {
            let own = derivation.denominators().find(|(_, other)| Some(*other) == formula.denominator.as_ref());
            let below = own.map_or(String::new(), |(k, _)| format!("/{}", number(k)));
            let name = self.name(derivation, formula);
            self.definitions.push(format!("{name} = {}{below}", array(formula, printer)));
        }
    }

    fn text(self) -> String {
        let has_arrays = self.definitions.iter().any(|line| line.contains("ImmutableDenseNDimArray("));
        let arrays = if has_arrays { "ImmutableDenseNDimArray, " } else { "" };
        let mut lines = vec![
            format!("from sympy import {arrays}Matrix, Rational, cos, pi, sign, sin, sqrt, symbols"),
            String::new(),
        ];
        lines.extend(self.notes.iter().map(|note| format!("# {note}")));
        for (input, names) in &self.inputs {
            let tuple = if names.len() == 1 { format!("{},", names[0]) } else { names.join(", ") };
            lines.push(format!("{input} = {tuple} = symbols(\"{}\", real=True, seq=True)", names.join(" ")));
        }
        for (name, meaning) in &self.symbols {
            let (value, places) = (format!("{} {}", meaning.value, meaning.unit), meaning.places.join("; "));
            lines.push(format!("{name} = symbols(\"{name}\", real=True)  # {value}: {places}"));
        }
        let value =
            |(name, meaning): &(String, Meaning)| format!("{name}: {}", Sympy::default().number(&meaning.value));
        let values: Vec<String> = self.symbols.iter().map(value).collect();
        lines.extend([format!("values = {{{}}}  # of the file", values.join(", ")), String::new()]);
        lines.extend(self.definitions);
        lines.join("\n") + "\n"
    }
}

/// The entries as SymPy's matrix or array.
fn array(formula: &Formula, printer: &Printer<Sympy>) -> String {
    let entries: Vec<String> = formula.entries.iter().map(|entry| printer.expression(entry)).collect();
    match formula.shape[..] {
        [] if formula.denominator.is_some() => format!("({})", entries.concat()),
        [] => entries.concat(),
        [rows] => format!("Matrix({rows}, 1, [{}])", entries.join(", ")),
        [rows, columns] => format!("Matrix({rows}, {columns}, [\n    {},\n])", entries.join(",\n    ")),
        _ => {
            let shape: Vec<String> = formula.shape.iter().map(usize::to_string).collect();
            format!("ImmutableDenseNDimArray([{}], ({},))", entries.join(", "), shape.join(", "))
        }
    }
}
