//! Printed expressions: sums and products, as they are grouped on paper.

use crate::atom::Id;
use crate::rational::Rational;
use mozzi::Scalar;
use std::collections::BTreeSet;

/// An expression as it is printed.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Expression {
    Number(Rational),
    Atom(Id),
    /// To a power ≠ 0, 1.
    Power(Box<Expression>, i32),
    /// A number times factors; without factors it is a [`Number`](Expression::Number).
    Product(Rational, Vec<Expression>),
    /// At least two terms.
    Sum(Vec<Expression>),
    /// A named sub-expression.
    Named(usize),
}

/// Operations of an expression, as a person counts them: a sign is none, aᵏ is |k| − 1 products.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Additions and subtractions.
    pub additions: usize,
    /// Products and quotients.
    pub products: usize,
    /// Different sines and cosines.
    pub sines: usize,
}

impl Operations {
    /// Additions and products.
    pub fn total(&self) -> usize {
        self.additions + self.products
    }
}

impl Expression {
    pub const ZERO: Expression = Expression::Number(Rational::ZERO);

    /// k · factors, in the simplest form.
    pub fn product(k: Rational, factors: Vec<Expression>) -> Self {
        let (mut k, mut all) = (k, Vec::with_capacity(factors.len()));
        for factor in factors {
            match factor {
                Expression::Number(x) => k = &k * &x,
                Expression::Product(x, inner) => {
                    k = &k * &x;
                    all.extend(inner);
                }
                other => all.push(other),
            }
        }
        match (all.len(), k.is_one()) {
            _ if k.is_zero() => Expression::ZERO,
            (0, _) => Expression::Number(k),
            (1, true) => all.swap_remove(0),
            _ => Expression::Product(k, all),
        }
    }

    /// A sum of terms, none of which is 0.
    pub fn sum(terms: Vec<Expression>) -> Self {
        let mut all = Vec::with_capacity(terms.len());
        for term in terms {
            match term {
                Expression::Sum(inner) => all.extend(inner),
                Expression::Number(x) if x.is_zero() => {}
                // −(a + b) is −a − b
                Expression::Product(x, mut factors) if factors.len() == 1 && (-&x).is_one() => {
                    match factors.remove(0) {
                        Expression::Sum(inner) => all.extend(inner.iter().map(Expression::negated)),
                        other => all.push(Expression::Product(x, vec![other])),
                    }
                }
                other => all.push(other),
            }
        }
        match all.len() {
            0 => Expression::ZERO,
            1 => all.swap_remove(0),
            _ => Expression::Sum(all),
        }
    }

    /// Additions and products.
    pub fn cost(&self) -> usize {
        let count = self.count();
        count.additions + count.products
    }

    /// Its operations, without those of named sub-expressions and of sines.
    pub fn count(&self) -> Operations {
        let mut count = Operations::default();
        self.count_into(&mut count);
        count
    }

    fn count_into(&self, count: &mut Operations) {
        match self {
            Expression::Number(_) | Expression::Atom(_) | Expression::Named(_) => {}
            Expression::Power(base, k) => {
                count.products += k.unsigned_abs() as usize - usize::from(*k > 0);
                base.count_into(count);
            }
            Expression::Product(k, factors) => {
                count.products += factors.len() - 1 + usize::from(!k.abs().is_one());
                factors.iter().for_each(|factor| factor.count_into(count));
            }
            Expression::Sum(terms) => {
                count.additions += terms.len() - 1;
                terms.iter().for_each(|term| term.count_into(count));
            }
        }
    }

    /// Its atoms.
    pub fn atoms(&self, found: &mut BTreeSet<Id>) {
        match self {
            Expression::Number(_) | Expression::Named(_) => {}
            Expression::Atom(id) => {
                found.insert(*id);
            }
            Expression::Power(base, _) => base.atoms(found),
            Expression::Product(_, parts) | Expression::Sum(parts) => parts.iter().for_each(|part| part.atoms(found)),
        }
    }

    /// True if the first printed sign is a minus.
    pub fn is_negative(&self) -> bool {
        match self {
            Expression::Number(x) | Expression::Product(x, _) => x.is_negative(),
            _ => false,
        }
    }

    /// −x.
    pub fn negated(&self) -> Expression {
        match self {
            Expression::Number(x) => Expression::Number(-x),
            Expression::Product(x, factors) => Expression::product(-x, factors.clone()),
            Expression::Sum(terms) => Expression::Sum(terms.iter().map(Expression::negated).collect()),
            other => Expression::Product(Rational::new(-1, 1), vec![other.clone()]),
        }
    }

    /// Its value, given those of atoms, numbers and named sub-expressions.
    pub fn value<S: Scalar>(&self, atom: &dyn Fn(Id) -> S, number: &dyn Fn(&Rational) -> S, named: &[S]) -> S {
        match self {
            Expression::Number(x) => number(x),
            Expression::Atom(id) => atom(*id),
            Expression::Power(base, k) => crate::evaluate::power(base.value(atom, number, named), *k),
            Expression::Product(k, factors) => {
                factors.iter().fold(number(k), |product, factor| product * factor.value(atom, number, named))
            }
            Expression::Sum(terms) => terms.iter().fold(S::zero(), |sum, term| sum + term.value(atom, number, named)),
            Expression::Named(k) => named[*k],
        }
    }
}
