//! Polynomials in atoms, sorted, with exact coefficients.

use crate::atom::Id;
use crate::rational::Rational;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// Atoms with their powers, sorted by atom: each is `id << 8 | power + 128`.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Monomial(Vec<u32>);

const ZEROTH: i32 = 128;

fn packed(id: Id, power: i32) -> u32 {
    assert!((-100..100).contains(&power), "a power of {power}"); // no kernel multiplies so often
    id << 8 | (power + ZEROTH) as u32
}

impl Monomial {
    /// One atom.
    pub fn atom(id: Id, power: i32) -> Self {
        Monomial(vec![packed(id, power)])
    }

    /// The atoms with their powers.
    pub fn factors(&self) -> impl ExactSizeIterator<Item = (Id, i32)> + Clone {
        self.0.iter().map(|&factor| (factor >> 8, (factor & 255) as i32 - ZEROTH))
    }

    /// True for 1.
    pub fn is_one(&self) -> bool {
        self.0.is_empty()
    }

    /// The power of an atom.
    pub fn power(&self, id: Id) -> i32 {
        self.factors().find(|(other, _)| *other == id).map_or(0, |(_, power)| power)
    }

    /// The monomial of those factors that are wanted, and that of the others.
    pub fn split(&self, wanted: impl Fn(Id) -> bool) -> (Monomial, Monomial) {
        let (a, b) = self.0.iter().partition(|factor| wanted(**factor >> 8));
        (Monomial(a), Monomial(b))
    }

    /// The product; no atom is rewritten.
    pub fn times(&self, other: &Monomial) -> Monomial {
        let (mut a, mut b) = (&self.0[..], &other.0[..]);
        let mut product = Vec::with_capacity(a.len() + b.len());
        while let ([x, a_rest @ ..], [y, b_rest @ ..]) = (a, b) {
            let (i, j) = (x >> 8, y >> 8);
            if i == j {
                let power = (x & 255) as i32 + (y & 255) as i32 - 2 * ZEROTH;
                if power != 0 {
                    product.push(packed(i, power));
                }
                (a, b) = (a_rest, b_rest);
            } else if i < j {
                product.push(*x);
                a = a_rest;
            } else {
                product.push(*y);
                b = b_rest;
            }
        }
        product.extend_from_slice(a);
        product.extend_from_slice(b);
        Monomial(product)
    }

    /// 1 over it.
    pub fn inverse(&self) -> Monomial {
        Monomial(self.factors().map(|(id, power)| packed(id, -power)).collect())
    }
}

/// A sum of monomials with coefficients ≠ 0, sorted by monomial.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Polynomial(pub Vec<(Monomial, Rational)>);

impl Polynomial {
    /// A constant.
    pub fn constant(x: Rational) -> Self {
        Polynomial(if x.is_zero() { Vec::new() } else { vec![(Monomial::default(), x)] })
    }

    /// An atom.
    pub fn atom(id: Id) -> Self {
        Polynomial(vec![(Monomial::atom(id, 1), Rational::ONE)])
    }

    /// The terms.
    pub fn terms(&self) -> &[(Monomial, Rational)] {
        &self.0
    }

    /// True for 0.
    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// The number, if there are no atoms.
    pub fn number(&self) -> Option<Rational> {
        match &self.0[..] {
            [] => Some(Rational::ZERO),
            [(monomial, x)] if monomial.is_one() => Some(x.clone()),
            _ => None,
        }
    }

    /// Each coefficient times k ≠ 0.
    pub fn scaled(&self, k: &Rational) -> Self {
        Polynomial(self.0.iter().map(|(monomial, x)| (monomial.clone(), x * k)).collect())
    }

    /// −p.
    pub fn negated(&self) -> Self {
        Polynomial(self.0.iter().map(|(monomial, x)| (monomial.clone(), -x)).collect())
    }

    /// p + q.
    pub fn plus(&self, other: &Self) -> Self {
        let (mut a, mut b) = (&self.0[..], &other.0[..]);
        let mut sum = Vec::with_capacity(a.len() + b.len());
        while let ([x, a_rest @ ..], [y, b_rest @ ..]) = (a, b) {
            match x.0.cmp(&y.0) {
                std::cmp::Ordering::Less => {
                    sum.push(x.clone());
                    a = a_rest;
                }
                std::cmp::Ordering::Greater => {
                    sum.push(y.clone());
                    b = b_rest;
                }
                std::cmp::Ordering::Equal => {
                    let coefficient = &x.1 + &y.1;
                    if !coefficient.is_zero() {
                        sum.push((x.0.clone(), coefficient));
                    }
                    (a, b) = (a_rest, b_rest);
                }
            }
        }
        sum.extend_from_slice(a);
        sum.extend_from_slice(b);
        Polynomial(sum)
    }
}

/// Terms to be added up.
#[derive(Default)]
pub(crate) struct Sum(HashMap<Monomial, Rational, BuildHasherDefault<Mixer>>);

impl Sum {
    /// Adds a term.
    pub fn add(&mut self, monomial: Monomial, x: &Rational) {
        match self.0.entry(monomial) {
            std::collections::hash_map::Entry::Occupied(mut entry) => {
                let sum = entry.get() + x;
                entry.insert(sum);
            }
            std::collections::hash_map::Entry::Vacant(entry) => {
                entry.insert(x.clone());
            }
        }
    }

    /// The sum.
    pub fn end(self) -> Polynomial {
        let mut terms: Vec<_> = self.0.into_iter().filter(|(_, x)| !x.is_zero()).collect();
        terms.sort_unstable_by(|a, b| a.0.cmp(&b.0));
        Polynomial(terms)
    }
}

/// A hash of whole words by one multiplication each; nothing depends on its order.
#[derive(Default)]
pub(crate) struct Mixer(u64);

impl Hasher for Mixer {
    fn finish(&self) -> u64 {
        self.0 ^ self.0 >> 29
    }
    fn write(&mut self, bytes: &[u8]) {
        for word in bytes.chunks(4) {
            let mut padded = [0; 4];
            padded[..word.len()].copy_from_slice(word);
            self.write_u32(u32::from_le_bytes(padded));
        }
    }
    fn write_u32(&mut self, x: u32) {
        self.0 = (self.0.rotate_left(5) ^ u64::from(x)).wrapping_mul(0x517c_c1b7_2722_0a95);
    }
    fn write_usize(&mut self, x: usize) {
        self.write_u32(x as u32);
    }
}
