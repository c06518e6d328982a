//! Derivations as text, LaTeX, Markdown, and as code of other tools.

mod code;
mod latex;
mod legend;
mod sympy;
mod text;

use crate::atom::{Angle, Atom, Id, Name, Trig};
use crate::derivation::{Derivation, Formula};
use crate::expression::Expression;
use crate::polynomial::Polynomial;
use crate::rational::Rational;
use crate::steps::Steps;
use crate::table::Table;

/// A form of output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// Text with the book's letters.
    Text,
    /// LaTeX with amsmath.
    Latex,
    /// Markdown with LaTeX formulas.
    Markdown,
    /// A Python module of SymPy expressions.
    Sympy,
    /// A Python function of NumPy arrays.
    Python,
    /// A MATLAB function.
    Matlab,
    /// A Julia function.
    Julia,
}

impl Derivation {
    /// The derivation as a text of this language.
    pub fn print(&self, language: Language) -> String {
        match language {
            Language::Text => text::page(self),
            Language::Latex => latex::page(self),
            Language::Markdown => latex::markdown(self),
            Language::Sympy => sympy::module(&[self]),
            Language::Python | Language::Matlab | Language::Julia => code::function(self, language),
        }
    }
}

/// Derivations of one robot as one text: in SymPy a module of all, in which no name is assigned twice.
pub fn print_all(derivations: &[Derivation], language: Language) -> String {
    if language == Language::Sympy {
        let mut different: Vec<&Derivation> = Vec::new();
        for derivation in derivations {
            if !different.iter().any(|known| known.quantity == derivation.quantity) {
                different.push(derivation);
            }
        }
        return sympy::module(&different);
    }
    derivations.iter().map(|derivation| derivation.print(language)).collect::<Vec<_>>().join("\n")
}

impl Steps {
    /// The recursion as text, LaTeX or Markdown; `None` for code.
    pub fn print(&self, language: Language) -> Option<String> {
        match language {
            Language::Text => Some(text::steps(self)),
            Language::Latex => Some(latex::steps(self, false)),
            Language::Markdown => Some(latex::steps(self, true)),
            _ => None,
        }
    }
}

/// The digits of a fraction that is too long to read, with dots for the further ones.
fn approximate(x: &Rational) -> Option<String> {
    let (a, b) = x.parts();
    (a.bits().max(b.bits()) > 40).then(|| format!("{}…", x.to_f64()))
}

/// How a language writes the parts of an expression.
pub(crate) trait Style {
    fn number(&self, x: &Rational) -> String;
    fn name(&self, name: &Name) -> String;
    /// A sine or cosine of an angle, to a power; `is_single` if the angle is one name.
    fn sine(&self, is_cosine: bool, angle: &str, is_single: bool, power: i32) -> String;
    fn root(&self, n: u64) -> String;
    fn pi(&self) -> &'static str;
    fn sign(&self, inner: &str) -> String;
    fn inverse(&self, inner: &str) -> String;
    fn power(&self, base: &str, k: i32) -> String;
    /// Two factors side by side; `are_plain` if both are short names.
    fn times(&self, left: &str, right: &str) -> String;
    /// A multiple of an angle.
    fn multiple(&self, k: &Rational, angle: &str) -> String;
}

/// Writes expressions in a style.
pub(crate) struct Printer<'a, S> {
    pub style: &'a S,
    pub table: &'a Table,
    /// The letter of named sub-expressions, and how many have numbers before the first.
    pub letter: &'static str,
    pub first: usize,
}

impl<'a, S: Style> Printer<'a, S> {
    /// A printer of a derivation's expressions.
    pub fn of(derivation: &'a Derivation, style: &'a S) -> Self {
        Printer { style, table: &derivation.table, letter: derivation.letter_of_names, first: 0 }
    }

    /// The name of a sub-expression: x₁ for the first.
    pub fn named(&self, k: usize) -> String {
        self.style.name(&Name::new(self.letter, self.first + k + 1, ""))
    }

    pub fn expression(&self, expression: &Expression) -> String {
        match expression {
            Expression::Number(x) => self.style.number(x),
            Expression::Atom(id) => self.atom(*id, 1),
            Expression::Named(k) => self.named(*k),
            Expression::Power(base, k) => match &**base {
                Expression::Atom(id) => self.atom(*id, *k),
                Expression::Named(name) => self.style.power(&self.named(*name), *k),
                other => self.style.power(&format!("({})", self.expression(other)), *k),
            },
            Expression::Product(x, factors) => self.product(x, factors),
            Expression::Sum(terms) => {
                let mut sum = String::new();
                for (k, term) in terms.iter().enumerate() {
                    match (k, term.is_negative()) {
                        (0, _) => sum.push_str(&self.expression(term)),
                        (_, true) => match term.negated() {
                            inner @ Expression::Sum(_) => sum.push_str(&format!(" - ({})", self.expression(&inner))),
                            inner => sum.push_str(&format!(" - {}", self.expression(&inner))),
                        },
                        (_, false) => sum.push_str(&format!(" + {}", self.expression(term))),
                    }
                }
                sum
            }
        }
    }

    fn product(&self, x: &Rational, factors: &[Expression]) -> String {
        let mut product = String::new();
        for factor in factors {
            let factor = match factor {
                Expression::Sum(_) => format!("({})", self.expression(factor)),
                Expression::Number(x) if x.is_negative() => format!("({})", self.expression(factor)),
                _ => self.expression(factor),
            };
            product = if product.is_empty() { factor } else { self.style.times(&product, &factor) };
        }
        let sign = if x.is_negative() { "-" } else { "" };
        match x.abs() {
            size if size.is_one() => format!("{sign}{product}"),
            size => format!("{sign}{}", self.style.times(&self.style.number(&size), &product)),
        }
    }

    pub fn atom(&self, id: Id, power: i32) -> String {
        let plain = |text: String| if power == 1 { text } else { self.style.power(&text, power) };
        match self.table.atom(id) {
            Atom::Parameter { name, .. } | Atom::State { name, .. } | Atom::Real { name, .. } => {
                plain(self.style.name(name))
            }
            Atom::Root(n) => plain(self.style.root(*n)),
            Atom::Pi => plain(self.style.pi().to_string()),
            Atom::Trig(trig) => {
                let (angle, is_single) = self.angle(trig);
                self.style.sine(trig.is_cosine, &angle, is_single, power)
            }
            Atom::Sign(p) => plain(self.style.sign(&self.polynomial(p))),
            Atom::Inverse(p) => plain(self.style.inverse(&self.polynomial(p))),
        }
    }

    /// A sum of angles, and whether it is a single one.
    fn angle(&self, trig: &Trig) -> (String, bool) {
        let mut sum = String::new();
        let angles = trig.harmonic.iter().zip(&self.table.groups[trig.group].angles).filter(|(k, _)| **k != 0);
        let is_single = angles.clone().count() == 1 && angles.clone().all(|(k, _)| *k == 1);
        let mut is_plain = is_single;
        for (k, angle) in angles {
            let (size, text) = match angle {
                Angle::Joint { position, over } => (Rational::new(k.abs(), *over), self.atom(*position, 1)),
                Angle::Constant(x) => (&Rational::new(k.abs(), 1) * x, String::new()),
            };
            is_plain &= size.is_one() || text.is_empty();
            let one = match (text.is_empty(), size.is_one()) {
                (true, _) => self.style.number(&size),
                (_, true) => text,
                _ => self.style.multiple(&size, &text),
            };
            let sign = if *k < 0 { "-" } else { "+" };
            sum = if sum.is_empty() { one } else { format!("{sum} {sign} {one}") };
        }
        (sum, is_plain)
    }

    /// Its terms as they are.
    fn polynomial(&self, p: &Polynomial) -> String {
        let factor = |(id, k): (Id, i32)| match k {
            1 => Expression::Atom(id),
            _ => Expression::Power(Box::new(Expression::Atom(id)), k),
        };
        let term = |(m, x): &(crate::polynomial::Monomial, Rational)| {
            Expression::product(x.clone(), m.factors().map(factor).collect())
        };
        let ranks = crate::order::ranks(self.table);
        let mut terms = p.terms().to_vec();
        terms.sort_by(|a, b| crate::order::compare(&ranks, &a.0, &b.0));
        self.expression(&Expression::sum(terms.iter().map(term).collect()))
    }
}

/// The symbol of a result: J̇_b.
pub(crate) struct Letter {
    pub letter: &'static str,
    pub dots: u8,
    /// The frame below it.
    pub frame: &'static str,
}

impl Formula {
    /// The index of an entry, from 1: `12`, or `1,12` beyond nine.
    fn index(&self, mut entry: usize) -> Vec<usize> {
        let mut index = Vec::new();
        for &size in self.shape.iter().rev() {
            index.push(entry % size.max(1) + 1);
            entry /= size.max(1);
        }
        index.reverse();
        index
    }

    /// The letter and its accents: dots, and whether it is a derivative.
    pub(crate) fn letter(&self) -> (&'static str, u8) {
        match self.name {
            "dM" | "dJ" | "dc" | "dh" | "dtau" => (&self.name[1..], 1),
            "ddc" => ("c", 2),
            "ddtheta" => ("θ", 2),
            "tau" => ("τ", 0),
            "phi" => ("φ", 0),
            "eta" => ("η", 0),
            "Lambda" => ("Λ", 0),
            "inverse" => ("M⁻¹", 0),
            "multipliers" => ("λ", 0),
            "pi_b" => ("π_b", 0),
            name => (name, 0),
        }
    }

    /// Those of a quantity's inputs that it depends on.
    pub(crate) fn arguments<'d>(&self, derivation: &'d Derivation) -> impl Iterator<Item = &'static str> + use<'d> {
        let most = match self.name {
            "pi_b" => 0,
            "Lambda" => 1,
            _ => derivation.inputs.len(),
        };
        derivation.inputs.iter().take(most).map(|(name, _)| *name)
    }

    fn is_matrix(&self) -> bool {
        self.shape.len() == 2
    }
}

impl Derivation {
    /// The letter of a formula: K or P for energies, whichever the quantity is.
    pub(crate) fn letter(&self, formula: &Formula) -> Letter {
        let (letter, dots) = match (self.quantity, formula.name) {
            ("kinetic_energy", _) => ("K", 0),
            ("potential_energy", _) => ("P", 0),
            _ => formula.letter(),
        };
        let frame = match () {
            () if self.quantity.starts_with("body_jacobian") => "b",
            () if self.quantity.starts_with("space_jacobian") => "s",
            () => "",
        };
        Letter { letter, dots, frame }
    }
}
