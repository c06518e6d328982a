//! From a polynomial to the shortest of several groupings, in a fixed order.

use crate::atom::{Class, Id};
use crate::expression::Expression;
use crate::order::compare;
use crate::polynomial::Monomial;
use crate::rational::Rational;
use std::collections::HashMap;

type Term = (Monomial, Rational);

/// The properties of atoms that grouping uses.
pub(crate) struct Grouping<'a> {
    /// The class of each atom.
    pub classes: &'a [Class],
    /// The place of each atom in the order of printing.
    pub ranks: &'a [usize],
}

/// With more terms, only one atom after another is factored out.
const MANY: usize = 48;

/// How many times one group is split again.
const DEPTH: usize = 4;

/// The ways to split each monomial into a factor to be put outside, and a rest.
#[derive(Clone, Copy)]
enum Split {
    Only(Class),
    AllBut(Class),
}

const SPLITS: [Split; 6] = [
    Split::Only(Class::Inertia),
    Split::AllBut(Class::Inertia),
    Split::Only(Class::Rate),
    Split::AllBut(Class::Rate),
    Split::Only(Class::Trigonometric),
    Split::AllBut(Class::Trigonometric),
];

impl Grouping<'_> {
    /// As an equation of motion: each acceleration (joint force, given number) with its factor, then the terms of
    /// velocities, then the others, each in its shortest grouping.
    pub fn shortest(&self, terms: &[Term]) -> Expression {
        let has = |m: &Monomial, class: Class| m.factors().any(|(id, _)| self.classes[id as usize] == class);
        let (linear, others): (Vec<Term>, Vec<Term>) = terms.iter().cloned().partition(|(m, _)| has(m, Class::Linear));
        let (rates, others): (Vec<Term>, Vec<Term>) = others.into_iter().partition(|(m, _)| has(m, Class::Rate));
        let mut parts: Vec<Expression> = self.by_class(&linear, Class::Linear);
        parts.extend([self.sum(&rates), self.sum(&others)]);
        Expression::sum(parts)
    }

    /// As [`shortest`](Self::shortest), with the factors that all terms have outside.
    pub fn factored(&self, terms: &[Term]) -> Expression {
        let plain = self.shortest(terms);
        let mut common: Option<Monomial> = None;
        for (monomial, _) in terms {
            let least = |known: Monomial| {
                let powers = known.factors().map(|(id, k)| (id, k.min(monomial.power(id)))).filter(|(_, k)| *k > 0);
                powers.fold(Monomial::default(), |product, (id, k)| product.times(&Monomial::atom(id, k)))
            };
            common = Some(common.map_or_else(|| monomial.clone(), least));
        }
        let common = common.unwrap_or_default();
        if terms.len() < 2 {
            return plain;
        }
        let inverse = common.inverse();
        let inner: Vec<Term> = terms.iter().map(|(m, x)| (m.times(&inverse), x.clone())).collect();
        let (size, inner) = content(&inner);
        let outside = times(size, self.with_factor(&common, self.shortest(&inner)));
        if outside.cost() <= plain.cost() { outside } else { plain }
    }

    /// Terms by the products of velocities, each with the shortest grouping of its factor.
    pub fn by_velocities(&self, terms: &[Term]) -> Expression {
        Expression::sum(self.by_class(terms, Class::Rate))
    }

    fn sum(&self, terms: &[Term]) -> Expression {
        match terms {
            [] => Expression::ZERO,
            [(monomial, x)] => self.monomial(monomial, x),
            _ if terms.len() > MANY => self.by_frequent_atom(terms),
            _ => {
                let plain = self.search(terms, DEPTH);
                // halves outside: ½(a + b)
                let denominator = |(_, x): &Term| match x {
                    Rational::Small(a, b) if a.abs() < 100 && *b <= 8 => Some(*b),
                    _ => None,
                };
                let common = terms.iter().map(denominator).try_fold(1, |lcm, b| b.map(|b| num_integer::lcm(lcm, b)));
                let Some(common) = common.filter(|common| *common > 1) else { return plain };
                let by = Rational::new(common, 1);
                let whole: Vec<Term> = terms.iter().map(|(m, x)| (m.clone(), x * &by)).collect();
                let outside = times(by.inverse(), self.search(&whole, DEPTH));
                if outside.cost() < plain.cost() { outside } else { plain }
            }
        }
    }

    fn by_class(&self, terms: &[Term], class: Class) -> Vec<Expression> {
        let mut groups: HashMap<Monomial, Vec<Term>> = HashMap::new();
        for (monomial, x) in terms {
            let (key, rest) = monomial.split(|id| self.classes[id as usize] == class);
            groups.entry(key).or_default().push((rest, x.clone()));
        }
        let mut groups: Vec<(Monomial, Vec<Term>)> = groups.into_iter().collect();
        groups.sort_by(|a, b| compare(self.ranks, &a.0, &b.0));
        groups.iter().map(|(key, rest)| self.with_factor(key, self.sum(rest))).collect()
    }

    fn search(&self, terms: &[Term], depth: usize) -> Expression {
        if let [(monomial, x)] = terms {
            return self.monomial(monomial, x);
        }
        let mut best = self.flat(terms);
        let mut cost = best.cost();
        if depth == 0 || terms.is_empty() {
            return best;
        }
        // gravity is put outside of a coefficient of a sine, not of all sines, as in books
        let gravity = (depth < DEPTH).then_some(Split::Only(Class::Gravity));
        let splits = SPLITS.into_iter().chain(gravity).filter_map(|split| self.grouped(terms, split, depth - 1));
        let (outside, inside) = content(terms);
        let number = (!outside.is_one()).then(|| times(outside, self.search(&inside, depth)));
        for candidate in splits.chain([self.by_frequent_atom(terms)]).chain(number) {
            let candidate_cost = candidate.cost();
            if candidate_cost < cost {
                (best, cost) = (candidate, candidate_cost);
            }
        }
        best
    }

    fn sorted(&self, mut terms: Vec<Term>) -> Vec<Term> {
        terms.sort_by(|a, b| compare(self.ranks, &a.0, &b.0));
        terms
    }

    fn flat(&self, terms: &[Term]) -> Expression {
        let (outside, inside) = content(terms);
        let inside = self.sorted(inside).iter().map(|(monomial, x)| self.monomial(monomial, x)).collect();
        times(outside, Expression::sum(inside))
    }

    /// Σ key · (the shortest grouping of what it multiplies); none if nothing is grouped.
    fn grouped(&self, terms: &[Term], split: Split, depth: usize) -> Option<Expression> {
        let wanted = |id: Id| match split {
            Split::Only(class) => self.classes[id as usize] == class,
            Split::AllBut(class) => self.classes[id as usize] != class,
        };
        let mut groups: HashMap<Monomial, Vec<Term>> = HashMap::new();
        for (monomial, x) in terms {
            let (key, rest) = monomial.split(wanted);
            groups.entry(key).or_default().push((rest, x.clone()));
        }
        let is_one = groups.len() == 1;
        if groups.len() == terms.len() || is_one && groups.contains_key(&Monomial::default()) {
            return None;
        }
        let mut groups: Vec<(Monomial, Vec<Term>)> = groups.into_iter().collect();
        // by the first term of each group, not by its factor outside
        let first = |(key, rest): &(Monomial, Vec<Term>)| {
            let products = rest.iter().map(|(monomial, _)| key.times(monomial));
            products.min_by(|a, b| compare(self.ranks, a, b)).unwrap_or_default()
        };
        groups.sort_by(|a, b| compare(self.ranks, &first(a), &first(b)));
        let sum = groups.iter().map(|(key, rest)| self.with_factor(key, self.search(rest, depth))).collect();
        Some(Expression::sum(sum))
    }

    /// Puts the atom of most terms outside, and so on.
    fn by_frequent_atom(&self, terms: &[Term]) -> Expression {
        if let [(monomial, x)] = terms {
            return self.monomial(monomial, x);
        }
        let mut counts: HashMap<Id, usize> = HashMap::new();
        for (monomial, _) in terms {
            for (id, _) in monomial.factors().filter(|(_, power)| *power > 0) {
                if !matches!(self.classes[id as usize], Class::Length | Class::Gravity | Class::Rate) {
                    *counts.entry(id).or_default() += 1;
                }
            }
        }
        let order = |(id, count): &(Id, usize)| (*count, std::cmp::Reverse(self.ranks[*id as usize]));
        let Some((id, _)) = counts.into_iter().filter(|(_, count)| *count > 1).max_by_key(order) else {
            return self.flat(terms);
        };
        let inverse = Monomial::atom(id, -1);
        let (with, without): (Vec<Term>, Vec<Term>) = terms.iter().cloned().partition(|(m, _)| m.power(id) > 0);
        let with: Vec<Term> = with.iter().map(|(m, x)| (m.times(&inverse), x.clone())).collect();
        let first = self.with_factor(&Monomial::atom(id, 1), self.by_frequent_atom(&with));
        if without.is_empty() {
            return first;
        }
        Expression::sum(vec![first, self.by_frequent_atom(&without)])
    }

    fn monomial(&self, monomial: &Monomial, x: &Rational) -> Expression {
        self.with_factor(monomial, Expression::Number(x.clone()))
    }

    /// A monomial times an expression.
    fn with_factor(&self, monomial: &Monomial, inner: Expression) -> Expression {
        let power = |(id, k): (Id, i32)| match k {
            1 => Expression::Atom(id),
            _ => Expression::Power(Box::new(Expression::Atom(id)), k),
        };
        let mut factors: Vec<Expression> = monomial.factors().map(power).collect();
        let mut outside = Rational::ONE;
        match inner {
            Expression::Product(k, inner) => {
                outside = k;
                factors.extend(inner);
            }
            Expression::Number(k) => outside = k,
            other => factors.push(other),
        }
        let mut factors = equal_as_powers(factors);
        factors.sort_by_key(|factor| self.place(factor));
        Expression::product(outside, factors)
    }

    /// The place of a factor: sums of masses first, other sums last; rates before sines.
    fn place(&self, factor: &Expression) -> (usize, usize) {
        let class = |id: Id| match self.classes[id as usize] {
            Class::Trigonometric => 20,
            Class::Linear => 30,
            class => class as usize,
        };
        match factor {
            Expression::Atom(id) => (2 * class(*id) + 1, self.ranks[*id as usize]),
            Expression::Power(base, _) => self.place(base),
            Expression::Sum(_) => {
                let mut atoms = std::collections::BTreeSet::new();
                factor.atoms(&mut atoms);
                let is_inertial = atoms.iter().all(|&id| self.classes[id as usize] == Class::Inertia);
                (if is_inertial { 0 } else { 50 }, 0)
            }
            _ => (60, 0),
        }
    }
}

fn times(outside: Rational, inside: Expression) -> Expression {
    if outside.is_one() { inside } else { Expression::product(outside, vec![inside]) }
}

/// The number that may stand outside: −1 if all terms are negative, a size that all have.
fn content(terms: &[Term]) -> (Rational, Vec<Term>) {
    let size = terms[0].1.abs();
    let mut outside = if terms.iter().all(|(_, x)| x.abs() == size) { size } else { Rational::ONE };
    if terms.iter().all(|(_, x)| x.is_negative()) {
        outside = -&outside;
    }
    if outside.is_one() {
        return (outside, terms.to_vec());
    }
    let inverse = outside.inverse();
    (outside, terms.iter().map(|(m, x)| (m.clone(), x * &inverse)).collect())
}

/// a a² as a³.
fn equal_as_powers(factors: Vec<Expression>) -> Vec<Expression> {
    let mut powers: Vec<(Expression, i32)> = Vec::new();
    for factor in factors {
        let (base, k) = match factor {
            Expression::Power(base, k) => (*base, k),
            other => (other, 1),
        };
        match powers.iter_mut().find(|(known, _)| *known == base) {
            Some((_, power)) => *power += k,
            None => powers.push((base, k)),
        }
    }
    let power = |(base, k): (Expression, i32)| match k {
        1 => base,
        _ => Expression::Power(Box::new(base), k),
    };
    powers.into_iter().filter(|(_, k)| *k != 0).map(power).collect()
}
