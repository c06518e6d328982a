//! Entries with one denominator, and what can be cancelled.

use crate::atom::{Atom, Id};
use crate::polynomial::{Monomial, Polynomial};
use crate::rational::Rational;
use crate::sines::shortened;
use crate::table::Table;
use std::collections::{BTreeMap, BTreeSet};

/// The entries of an output and the denominator that they share.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fraction {
    pub numerators: Vec<Polynomial>,
    /// Its terms; 1 for an output without an inverse.
    pub denominator: Polynomial,
}

impl Fraction {
    /// Entries without a denominator.
    pub fn whole(numerators: Vec<Polynomial>) -> Self {
        Fraction { numerators, denominator: Polynomial::constant(Rational::ONE) }
    }

    /// True without a denominator.
    pub fn is_whole(&self) -> bool {
        self.denominator.number().is_some_and(|x| x.is_one())
    }

    /// All polynomials.
    pub fn polynomials(&self) -> impl Iterator<Item = &Polynomial> {
        self.numerators.iter().chain([&self.denominator])
    }

    /// Cancels the monomial of all terms, and those of these factors that divide all polynomials.
    pub fn reduced(mut self, table: &mut Table, factors: &[Polynomial], are_fractions: bool) -> Self {
        if self.is_whole() {
            return self;
        }
        self.cancel_monomial(table);
        let sines = single_sines(table, &self.denominator);
        for factor in factors.iter().chain(&sines).filter(|factor| factor.number().is_none()) {
            // the monomial of a factor's terms is cancelled already
            let common = common(table, std::slice::from_ref(factor).iter());
            let factor = times(factor, &common.inverse());
            if factor.number().is_some() {
                continue;
            }
            while let Some(quotient) = self.over(table, &factor) {
                self = quotient;
            }
        }
        self.cancel_monomial(table);
        if are_fractions {
            self.cancel_size(table);
        }
        self
    }

    fn over(&self, table: &mut Table, factor: &Polynomial) -> Option<Fraction> {
        let denominator = table.exact_quotient(&self.denominator, factor)?;
        let mut numerators = Vec::new();
        for p in &self.numerators {
            numerators.push(table.exact_quotient(p, factor)?);
        }
        Some(Fraction { numerators, denominator })
    }

    fn cancel_monomial(&mut self, table: &Table) {
        let inverse = common(table, self.polynomials()).inverse();
        self.numerators.iter_mut().for_each(|p| *p = times(p, &inverse));
        self.denominator = times(&self.denominator, &inverse);
    }

    /// The number that all printed terms of the denominator have is cancelled.
    fn cancel_size(&mut self, table: &mut Table) {
        let printed = shortened(table, &self.denominator);
        let Some((_, first)) = printed.first() else { return };
        if printed.iter().all(|(_, x)| x.abs() == first.abs()) {
            let is_negative = printed.iter().all(|(_, x)| x.is_negative());
            let inverse = if is_negative { first.inverse() } else { first.abs().inverse() };
            self.numerators.iter_mut().for_each(|p| *p = p.scaled(&inverse));
            self.denominator = self.denominator.scaled(&inverse);
        }
    }
}

/// No atom of a monomial's factors is rewritten.
fn times(p: &Polynomial, monomial: &Monomial) -> Polynomial {
    let mut terms: Vec<_> = p.terms().iter().map(|(m, x)| (m.times(monomial), x.clone())).collect();
    terms.sort_unstable_by(|a, b| a.0.cmp(&b.0));
    Polynomial(terms)
}

/// The lowest powers in all terms of atoms that are not rewritten.
fn common<'a>(table: &Table, polynomials: impl Iterator<Item = &'a Polynomial>) -> Monomial {
    let mut lowest: Option<BTreeMap<Id, i32>> = None;
    for (monomial, _) in polynomials.flat_map(|p| p.terms()) {
        let is_plain = |id: Id| !matches!(table.atom(id), Atom::Trig(_) | Atom::Root(_) | Atom::Real { .. });
        let powers: BTreeMap<Id, i32> = monomial.factors().filter(|(id, _)| is_plain(*id)).collect();
        let Some(known) = &mut lowest else {
            lowest = Some(powers);
            continue;
        };
        // an atom that a term lacks has the power 0 there
        powers.keys().for_each(|id| _ = known.entry(*id).or_insert(0));
        known.iter_mut().for_each(|(id, k)| *k = (*k).min(powers.get(id).copied().unwrap_or(0)));
    }
    let powers = lowest.unwrap_or_default().into_iter().filter(|(_, k)| *k != 0);
    powers.fold(Monomial::default(), |product, (id, k)| product.times(&Monomial::atom(id, k)))
}

/// Sines and cosines of single angles that occur in a polynomial.
fn single_sines(table: &mut Table, p: &Polynomial) -> Vec<Polynomial> {
    let mut angles = BTreeSet::new();
    for (id, _) in p.terms().iter().flat_map(|(monomial, _)| monomial.factors()) {
        if let Atom::Trig(trig) = table.atom(id) {
            angles.extend(trig.harmonic.iter().enumerate().filter(|(_, k)| **k != 0).map(|(at, _)| (trig.group, at)));
        }
    }
    let mut sines = Vec::new();
    for (group, at) in angles {
        for is_cosine in [false, true] {
            let mut harmonic = vec![0; table.groups[group].angles.len()];
            harmonic[at] = 1;
            sines.push(table.trig(group, is_cosine, harmonic));
        }
    }
    sines
}
