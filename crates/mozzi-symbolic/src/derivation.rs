//! Formulas of a quantity.

use crate::atom::{Class, Id};
use crate::expression::{Expression, Operations};
use crate::letters::plain_name;
use crate::parameters::Meaning;
use crate::rational::Rational;
use crate::table::Table;

/// An output of a quantity in symbols.
#[derive(Clone, Debug)]
pub struct Formula {
    /// Its declared name: `M`, `c` …
    pub name: &'static str,
    /// Its shape; empty for a number.
    pub shape: Vec<usize>,
    /// Whether it is a symmetric matrix.
    pub is_symmetric: bool,
    pub(crate) entries: Vec<Expression>,
    /// The denominator of all entries.
    pub(crate) denominator: Option<Expression>,
}

/// The formulas of a quantity, proven.
#[derive(Clone, Debug)]
pub struct Derivation {
    /// The quantity's name.
    pub quantity: &'static str,
    /// Its outputs.
    pub formulas: Vec<Formula>,
    pub(crate) names: Vec<Expression>,
    /// The letter of the names, which no other name has.
    pub(crate) letter_of_names: &'static str,
    /// The numbers of the state, by input.
    pub(crate) inputs: Vec<(&'static str, Vec<Id>)>,
    /// Angles that were read as multiples of π, in multiples.
    pub angles: Vec<(String, Rational)>,
    /// The sum of these readings' differences from the file, rad.
    pub(crate) angle_error: f64,
    /// The symbols that occur.
    pub legend: Vec<Meaning>,
    /// Whether its numbers are those of formulas, ½, and not the file's.
    pub(crate) has_fractions: bool,
    pub(crate) table: Table,
}

/// The names of symbols, inputs and outputs in code.
pub(crate) fn plain_names<'a>(
    table: &Table,
    inputs: impl Iterator<Item = &'a str>,
    formulas: &[Formula],
) -> Vec<String> {
    let symbols = (0..table.len() as Id).filter_map(|id| table.name(id)).map(plain_name);
    symbols.chain(inputs.chain(formulas.iter().map(|formula| formula.name)).map(String::from)).collect()
}

impl Derivation {
    /// The names of its symbols, inputs and outputs in code.
    pub(crate) fn plain_names(&self) -> Vec<String> {
        plain_names(&self.table, self.inputs.iter().map(|(name, _)| *name), &self.formulas)
    }

    /// Different denominators, each with its index in order.
    pub(crate) fn denominators(&self) -> impl Iterator<Item = (usize, &Expression)> {
        let all = self.formulas.iter().filter_map(|formula| formula.denominator.as_ref());
        let mut known: Vec<&Expression> = Vec::new();
        all.for_each(|x| {
            if !known.contains(&x) {
                known.push(x)
            }
        });
        known.into_iter().enumerate()
    }

    /// The number of a formula's denominator among several, from 1: Δ₂; `Some(None)` if there is only one.
    pub(crate) fn denominator_number(&self, formula: &Formula) -> Option<Option<usize>> {
        let own = formula.denominator.as_ref()?;
        self.denominators().find(|(_, other)| *other == own).map(|(k, _)| self.denominator_name(k))
    }

    /// The number of a denominator by its index; none for the only one.
    pub(crate) fn denominator_name(&self, index: usize) -> Option<usize> {
        (self.denominators().count() > 1).then_some(index + 1)
    }

    /// All expressions that are printed.
    pub(crate) fn expressions(&self) -> impl Iterator<Item = &Expression> {
        self.names
            .iter()
            .chain(self.formulas.iter().flat_map(|formula| formula.entries.iter().chain(&formula.denominator)))
    }

    /// The operations of all that is printed; entries below the diagonal of symmetric matrices are not counted.
    pub fn operations(&self) -> Operations {
        let mut atoms = std::collections::BTreeSet::new();
        let mut all = Operations::default();
        let mut add = |expression: &Expression| {
            let count = expression.count();
            all.additions += count.additions;
            all.products += count.products;
            expression.atoms(&mut atoms);
        };
        self.names.iter().for_each(&mut add);
        for formula in &self.formulas {
            formula.distinct().for_each(|k| add(&formula.entries[k]));
        }
        self.denominators().for_each(|(_, denominator)| add(denominator));
        // 1/Δ, and each entry times it
        for formula in self.formulas.iter().filter(|formula| formula.denominator.is_some()) {
            all.products += 1 + formula.distinct().filter(|&k| formula.entries[k] != Expression::ZERO).count();
        }
        all.sines = atoms.iter().filter(|&&id| self.table.class(id) == Class::Trigonometric).count();
        all
    }
}

impl Formula {
    /// The entries that are printed by themselves: of a symmetric matrix those on and above the diagonal.
    pub(crate) fn distinct(&self) -> impl Iterator<Item = usize> + '_ {
        let columns = self.shape.last().copied().unwrap_or(1).max(1);
        (0..self.entries.len()).filter(move |k| !self.is_symmetric || k / columns <= k % columns)
    }
}
