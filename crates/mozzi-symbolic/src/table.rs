//! The atoms of one derivation, and products of polynomials in them.

use crate::atom::{Angle, Atom, Class, Id, Name, Trig};
use crate::polynomial::{Monomial, Polynomial, Sum};
use crate::rational::Rational;
use num_bigint::BigInt;
use std::collections::HashMap;

/// A group of angles of parallel axes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Group {
    /// Base to tips.
    pub angles: Vec<Angle>,
    /// How each angle's cumulative sum ends: the index of the angle before, and the sign that it is added with.
    pub before: Vec<Option<(usize, i64)>>,
    /// The sign with which the first angle is in each cumulative sum.
    pub signs: Vec<i64>,
}

impl Group {
    pub fn new(angles: Vec<Angle>, before: Vec<Option<(usize, i64)>>) -> Self {
        let sign_of = |mut at: usize| {
            let mut sign = 1;
            while let Some((other, turned)) = before[at] {
                (at, sign) = (other, sign * turned);
            }
            sign
        };
        let signs = (0..before.len()).map(sign_of).collect();
        Group { angles, before, signs }
    }
}

/// The atoms.
#[derive(Clone, Debug, Default)]
pub(crate) struct Table {
    atoms: Vec<Atom>,
    known: HashMap<Atom, Id>,
    pub groups: Vec<Group>,
    products: HashMap<(Id, Id), Polynomial>,
    /// Why there is no result, if an operation left the polynomials, or there are too many terms.
    pub fault: Option<Fault>,
}

/// Why a kernel has no result in polynomials.
#[derive(Clone, Debug)]
pub(crate) enum Fault {
    /// The operation of the kernel that has no polynomial result.
    Left(String),
    /// So many terms, and the most that there may be.
    TooLong([usize; 2]),
}

/// The different primes of roots in a number by which is divided.
const MOST_PRIMES: usize = 16;

/// A product of more terms is not computed.
const MOST: usize = 500_000;

impl Table {
    /// The index of an atom, which is added if it is new.
    pub fn id(&mut self, atom: Atom) -> Id {
        if let Some(&id) = self.known.get(&atom) {
            return id;
        }
        let id = self.atoms.len() as Id;
        self.known.insert(atom.clone(), id);
        self.atoms.push(atom);
        id
    }

    /// The atom of an index.
    pub fn atom(&self, id: Id) -> &Atom {
        &self.atoms[id as usize]
    }

    /// The number of atoms.
    pub fn len(&self) -> usize {
        self.atoms.len()
    }

    /// The class of an atom.
    pub fn class(&self, id: Id) -> Class {
        match self.atom(id) {
            Atom::Parameter { class, .. } | Atom::State { class, .. } => *class,
            Atom::Real { .. } => Class::Position,
            Atom::Root(_) | Atom::Pi => Class::Inertia,
            Atom::Trig(_) => Class::Trigonometric,
            Atom::Sign(_) => Class::Rate,
            Atom::Inverse(_) => Class::Inertia,
        }
    }

    /// The name of a parameter or a state's number.
    pub fn name(&self, id: Id) -> Option<&Name> {
        match self.atom(id) {
            Atom::Parameter { name, .. } | Atom::State { name, .. } | Atom::Real { name, .. } => Some(name),
            _ => None,
        }
    }

    /// The group of a sine or cosine.
    pub fn group(&self, id: Id) -> Option<usize> {
        match self.atom(id) {
            Atom::Trig(trig) => Some(trig.group),
            _ => None,
        }
    }

    /// The sine or cosine of a sum of angles.
    pub fn trig(&mut self, group: usize, is_cosine: bool, mut harmonic: Vec<i64>) -> Polynomial {
        let Some(first) = harmonic.iter().find(|k| **k != 0).copied() else {
            return Polynomial::constant(if is_cosine { Rational::ONE } else { Rational::ZERO });
        };
        if first < 0 {
            harmonic.iter_mut().for_each(|k| *k = -*k);
        }
        let p = Polynomial::atom(self.id(Atom::Trig(Trig { group, is_cosine, harmonic })));
        if first < 0 && !is_cosine { p.negated() } else { p }
    }

    /// The square of an atom that is rewritten.
    fn square(&mut self, id: Id) -> Option<Polynomial> {
        match self.atom(id) {
            Atom::Root(n) => Some(Polynomial::constant(Rational::new(*n as i64, 1))),
            Atom::Real { imaginary, .. } => {
                let mut sum = Sum::default();
                sum.add(Monomial::default(), &Rational::ONE);
                imaginary.iter().for_each(|&id| sum.add(Monomial::atom(id, 2), &Rational::new(-1, 1)));
                Some(sum.end())
            }
            _ => None,
        }
    }

    /// cos a cos b = ½(cos(a−b) + cos(a+b)), and the like; roots likewise: √a √b = d √(ab/d²).
    fn pair(&mut self, a: Id, b: Id) -> Polynomial {
        let key = (a.min(b), a.max(b));
        if let Some(known) = self.products.get(&key) {
            return known.clone();
        }
        let product = match (self.atom(a).clone(), self.atom(b).clone()) {
            (Atom::Trig(a), Atom::Trig(b)) => self.product_to_sum(&a, &b),
            (Atom::Root(a), Atom::Root(b)) if a != b => {
                let d = num_integer::gcd(a, b);
                let root = Polynomial::atom(self.id(Atom::Root(a / d * (b / d))));
                root.scaled(&Rational::new(d as i64, 1))
            }
            _ => self.square(a).unwrap_or_default(),
        };
        self.products.insert(key, product.clone());
        product
    }

    fn product_to_sum(&mut self, a: &Trig, b: &Trig) -> Polynomial {
        let combined = |sign: i64| a.harmonic.iter().zip(&b.harmonic).map(|(x, y)| x + sign * y).collect();
        let is_cosine = a.is_cosine == b.is_cosine;
        let (sum, difference) =
            (self.trig(a.group, is_cosine, combined(1)), self.trig(a.group, is_cosine, combined(-1)));
        let both = match (a.is_cosine, b.is_cosine) {
            (true, true) | (false, true) => sum.plus(&difference),
            (false, false) => difference.plus(&sum.negated()),
            (true, false) => sum.plus(&difference.negated()),
        };
        if both.is_zero() { both } else { both.scaled(&Rational::new(1, 2)) }
    }

    /// True if the product of two atoms is rewritten.
    fn meet(&self, a: Id, b: Id) -> bool {
        match (self.atom(a), self.atom(b)) {
            (Atom::Trig(a), Atom::Trig(b)) => a.group == b.group,
            (Atom::Root(_), Atom::Root(_)) => true,
            (Atom::Real { .. }, Atom::Real { .. }) => a == b,
            _ => false,
        }
    }

    /// p q.
    pub fn times(&mut self, p: &Polynomial, q: &Polynomial) -> Polynomial {
        match (p.number(), q.number()) {
            (Some(x), _) => return if x.is_zero() { Polynomial::default() } else { q.scaled(&x) },
            (_, Some(x)) => return if x.is_zero() { Polynomial::default() } else { p.scaled(&x) },
            _ => {}
        }
        let products = p.terms().len().saturating_mul(q.terms().len());
        if self.fault.is_some() || products > MOST {
            self.fault.get_or_insert(Fault::TooLong([products, MOST]));
            return Polynomial::default();
        }
        let mut sum = Sum::default();
        for (a, x) in p.terms() {
            let special: Vec<Id> = a.factors().map(|(id, _)| id).filter(|&id| self.is_special(id)).collect();
            for (b, y) in q.terms() {
                let mut pairs = Vec::new();
                for &i in &special {
                    pairs.extend(b.factors().filter(|&(j, _)| self.meet(i, j)).map(|(j, _)| (i, j)));
                }
                let xy = x * y;
                if pairs.is_empty() {
                    sum.add(a.times(b), &xy);
                    continue;
                }
                let (_, a) = a.split(|id| pairs.iter().any(|pair| pair.0 == id));
                let (_, b) = b.split(|id| pairs.iter().any(|pair| pair.1 == id));
                let mut terms = vec![(a.times(&b), xy)];
                for (i, j) in pairs {
                    let product = self.pair(i, j);
                    let each = |(m, x): &(Monomial, Rational)| {
                        product.terms().iter().map(|(n, y)| (m.times(n), x * y)).collect::<Vec<_>>()
                    };
                    terms = terms.iter().flat_map(each).collect();
                }
                terms.into_iter().for_each(|(monomial, x)| sum.add(monomial, &x));
            }
        }
        sum.end()
    }

    fn is_special(&self, id: Id) -> bool {
        matches!(self.atom(id), Atom::Trig(_) | Atom::Root(_) | Atom::Real { .. })
    }

    /// p / q for a number, a sum of roots, a monomial, or a polynomial of parameters; else leaves a
    /// [`fault`](Self::fault).
    pub fn over(&mut self, p: &Polynomial, q: &Polynomial) -> Polynomial {
        if let [(monomial, x)] = q.terms() {
            let (special, plain) = monomial.split(|id| self.is_special(id));
            let mut inverse = Polynomial(vec![(plain.inverse(), x.inverse())]);
            for (id, _) in special.factors() {
                let Atom::Root(n) = *self.atom(id) else { return self.fail(q) };
                let root = Polynomial::atom(id).scaled(&Rational::new(1, n as i64));
                inverse = self.times(&inverse, &root);
            }
            return self.times(p, &inverse);
        }
        if q.terms().iter().all(|(monomial, _)| monomial.factors().all(|(id, _)| self.root_of(id).is_some())) {
            return self.over_roots(p, q);
        }
        let is_parameter = |(id, _): (Id, i32)| matches!(self.atom(id), Atom::Parameter { .. });
        if q.is_zero() || !q.terms().iter().all(|(monomial, _)| monomial.factors().all(is_parameter)) {
            return self.fail(q);
        }
        // the first coefficient becomes 1, so that equal denominators are one atom
        let first = &q.terms()[0].1;
        let atom = Atom::Inverse(q.scaled(&first.inverse()));
        let inverse = Polynomial::atom(self.id(atom)).scaled(&first.inverse());
        self.times(p, &inverse)
    }

    fn root_of(&self, id: Id) -> Option<u64> {
        match *self.atom(id) {
            Atom::Root(n) => Some(n),
            _ => None,
        }
    }

    /// p over a sum of roots: 1/(a + b√n) = (a − b√n)/(a² − b²n), for one prime of the roots after the other.
    fn over_roots(&mut self, p: &Polynomial, q: &Polynomial) -> Polynomial {
        let (mut above, mut below) = (p.clone(), q.clone());
        for _ in 0..MOST_PRIMES {
            if let Some(x) = below.number().filter(|x| !x.is_zero()) {
                return above.scaled(&x.inverse());
            }
            let roots = |monomial: &Monomial| monomial.factors().find_map(|(id, _)| self.root_of(id));
            let Some(first) = below.terms().iter().find_map(|(monomial, _)| roots(monomial)) else { break };
            let prime = (2..1 << 20).find(|prime| first % prime == 0).unwrap_or(first);
            let is_turned = |monomial: &Monomial| roots(monomial).is_some_and(|n| n % prime == 0);
            let sign = |(monomial, x): &(Monomial, Rational)| match is_turned(monomial) {
                true => (monomial.clone(), -x),
                false => (monomial.clone(), x.clone()),
            };
            let conjugate = Polynomial(below.terms().iter().map(sign).collect());
            (above, below) = (self.times(&above, &conjugate), self.times(&below, &conjugate));
        }
        self.fail(q)
    }

    fn fail(&mut self, q: &Polynomial) -> Polynomial {
        let what = if q.is_zero() {
            "divides by 0".to_string()
        } else {
            format!("divides by a sum of {} terms", q.terms().len())
        };
        self.fault.get_or_insert(Fault::Left(what));
        Polynomial::default()
    }

    /// √x of a number ≥ 0; of long decimals the nearest number, such as the length of an axis that is a unit vector but
    /// for rounding.
    pub fn root(&mut self, x: &Rational) -> Option<Polynomial> {
        let nearest = || Rational::decimal(&format!("{}", x.to_f64().sqrt())).map(Polynomial::constant);
        self.short_root(x).or_else(nearest)
    }

    /// √x as an integer's root times a fraction.
    fn short_root(&mut self, x: &Rational) -> Option<Polynomial> {
        let Rational::Small(a, b) = *x else { return large_square_root(x).map(Polynomial::constant) };
        if a <= 0 {
            return (a == 0).then(Polynomial::default);
        }
        // √(a/b) = √(ab)/b
        let mut rest = u128::from(a.unsigned_abs()) * u128::from(b.unsigned_abs());
        let mut outside: i64 = 1;
        let mut prime: u128 = 2;
        while prime * prime <= rest && prime < 1 << 20 {
            while rest % (prime * prime) == 0 {
                (rest, outside) = (rest / (prime * prime), outside.checked_mul(i64::try_from(prime).ok()?)?);
            }
            prime += 1;
        }
        let whole = rest.isqrt();
        if whole * whole == rest {
            return Some(Polynomial::constant(
                &Rational::new(i64::try_from(whole).ok()?, 1) * &Rational::new(outside, b),
            ));
        }
        let rest = u64::try_from(rest).ok().filter(|rest| *rest < 1 << 62)?;
        Some(Polynomial::atom(self.id(Atom::Root(rest))).scaled(&Rational::new(outside, b)))
    }
}

/// The root of the square of a fraction of any size.
fn large_square_root(x: &Rational) -> Option<Rational> {
    let (a, b) = x.parts();
    let root = |n: &BigInt| Some(n.sqrt()).filter(|root| root * root == *n);
    if x.is_negative() { None } else { Some(Rational::of_big(root(&a)?, root(&b)?)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_roots_are_in_the_shortest_form() {
        let mut table = Table::default();
        let mut root = |x: i64| table.root(&Rational::new(x, 1)).expect("a root");
        let (two, six, three) = (root(2), root(6), root(3));
        assert_eq!(table.times(&two, &two), Polynomial::constant(Rational::new(2, 1)));
        assert_eq!(table.times(&two, &six), three.scaled(&Rational::new(2, 1)));
    }

    #[test]
    fn numbers_are_divided_by_sums_of_roots() {
        let mut table = Table::default();
        let mut root = |x: i64| table.root(&Rational::new(x, 1)).expect("a root");
        let one = Polynomial::constant(Rational::ONE);
        let sum = root(2).plus(&root(6)).plus(&root(10038)).plus(&one);
        let inverse = table.over(&one, &sum);
        assert_eq!((table.times(&inverse, &sum), table.fault.is_none()), (one, true));
    }
}
