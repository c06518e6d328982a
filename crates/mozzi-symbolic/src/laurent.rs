//! Exact division of polynomials with sines and cosines, as polynomials in e^{iθ}: where it leaves no rest.

use crate::atom::{Atom, Id};
use crate::polynomial::Polynomial;
use crate::rational::Rational;
use crate::table::Table;
use std::collections::{BTreeMap, BTreeSet};

/// Longer polynomials are not divided.
const MOST: usize = 5_000;

/// Real and imaginary part.
type Complex = (Rational, Rational);

fn times((a, b): &Complex, (c, d): &Complex) -> Complex {
    (&(a * c) - &(b * d), &(a * d) + &(b * c))
}

fn over(x: &Complex, (a, b): &Complex) -> Complex {
    let size = (&(a * a) + &(b * b)).inverse();
    times(x, &(a * &size, -&(b * &size)))
}

/// Powers of atoms, then of e^{iθ} of each group's angles; each with its coefficient.
type Terms = BTreeMap<Vec<i32>, Complex>;

/// The places of atoms and angles in powers.
struct Places {
    atoms: Vec<Id>,
    /// The first angle of each group.
    groups: Vec<usize>,
    length: usize,
}

impl Places {
    /// None if an atom has a power that is rewritten.
    fn of(table: &Table, polynomials: [&Polynomial; 2]) -> Option<Self> {
        let terms = polynomials.into_iter().flat_map(|p| p.terms());
        let all: BTreeSet<Id> = terms.flat_map(|(monomial, _)| monomial.factors()).map(|(id, _)| id).collect();
        if all.iter().any(|&id| matches!(table.atom(id), Atom::Root(_) | Atom::Real { .. })) {
            return None;
        }
        let atoms: Vec<Id> = all.into_iter().filter(|&id| table.group(id).is_none()).collect();
        let (mut groups, mut length) = (Vec::new(), atoms.len());
        for group in &table.groups {
            groups.push(length);
            length += group.angles.len();
        }
        Some(Places { atoms, groups, length })
    }

    fn terms(&self, table: &Table, p: &Polynomial) -> Terms {
        let mut sum = Terms::new();
        for (monomial, x) in p.terms() {
            let mut products: Vec<(Vec<i32>, Complex)> = vec![(vec![0; self.length], (x.clone(), Rational::ZERO))];
            for (id, k) in monomial.factors() {
                let Atom::Trig(trig) = table.atom(id) else {
                    let place = self.atoms.binary_search(&id).unwrap_or_default();
                    products.iter_mut().for_each(|(powers, _)| powers[place] += k);
                    continue;
                };
                // cos φ = ½e^{iφ} + ½e^{−iφ}, sin φ = −½i e^{iφ} + ½i e^{−iφ}
                let half = Rational::new(1, 2);
                let factor = |sign: i64| match trig.is_cosine {
                    true => (half.clone(), Rational::ZERO),
                    false => (Rational::ZERO, &half * &Rational::new(-sign, 1)),
                };
                let turned = |(powers, x): &(Vec<i32>, Complex), sign: i64| {
                    let mut powers = powers.clone();
                    let places = &mut powers[self.groups[trig.group]..];
                    places.iter_mut().zip(&trig.harmonic).for_each(|(power, times)| *power += (sign * times) as i32);
                    (powers, times(x, &factor(sign)))
                };
                products = products.iter().flat_map(|term| [turned(term, 1), turned(term, -1)]).collect();
            }
            products.into_iter().for_each(|(powers, x)| add(&mut sum, powers, &x));
        }
        sum
    }

    /// The polynomial of terms that are a real function.
    fn polynomial(&self, table: &mut Table, terms: &Terms) -> Polynomial {
        let mut sum = crate::polynomial::Sum::default();
        for (powers, x) in terms {
            let atoms = self.atoms.iter().zip(powers).filter(|(_, k)| **k != 0);
            let monomial = atoms.fold(crate::polynomial::Monomial::default(), |product, (&id, &k)| {
                product.times(&crate::polynomial::Monomial::atom(id, k))
            });
            let part = |x: &Rational| Polynomial::constant(x.clone());
            let (mut real, mut imaginary) = (part(&x.0), part(&x.1));
            for group in 0..self.groups.len() {
                let angles = table.groups[group].angles.len();
                let harmonic: Vec<i64> = powers[self.groups[group]..][..angles].iter().map(|&k| k.into()).collect();
                let (c, s) = (table.trig(group, true, harmonic.clone()), table.trig(group, false, harmonic));
                let [ac, bs, as_, bc] =
                    [(&real, &c), (&imaginary, &s), (&real, &s), (&imaginary, &c)].map(|(a, b)| table.times(a, b));
                (real, imaginary) = (ac.plus(&bs.negated()), as_.plus(&bc));
            }
            real.terms().iter().for_each(|(sines, y)| sum.add(monomial.times(sines), y));
        }
        sum.end()
    }
}

fn add(sum: &mut Terms, powers: Vec<i32>, x: &Complex) {
    let entry = sum.entry(powers.clone()).or_insert((Rational::ZERO, Rational::ZERO));
    *entry = (&entry.0 + &x.0, &entry.1 + &x.1);
    if entry.0.is_zero() && entry.1.is_zero() {
        sum.remove(&powers);
    }
}

/// The least and the greatest power at each place.
fn bounds(terms: &Terms, length: usize) -> Vec<(i32, i32)> {
    let of = |k: usize| {
        let powers = || terms.keys().map(move |powers| powers[k]);
        (powers().min().unwrap_or(0), powers().max().unwrap_or(0))
    };
    (0..length).map(of).collect()
}

impl Table {
    /// p / q, if it is a polynomial; none also for long ones, and for those with roots or quaternions.
    pub fn exact_quotient(&mut self, p: &Polynomial, q: &Polynomial) -> Option<Polynomial> {
        if p.is_zero() || p == q {
            return Some(if p.is_zero() { Polynomial::default() } else { Polynomial::constant(Rational::ONE) });
        }
        if p.terms().len() > MOST || q.terms().len() > MOST {
            return None;
        }
        let places = Places::of(self, [p, q])?;
        let (mut rest, q) = (places.terms(self, p), places.terms(self, q));
        let (lead, first) = q.last_key_value()?;
        // least and greatest powers of a product are the sums of its factors'
        let (of_rest, of_q) = (bounds(&rest, places.length), bounds(&q, places.length));
        let fits = |powers: &[i32]| {
            let each = powers.iter().zip(&of_rest).zip(&of_q);
            each.into_iter().all(|((k, p), q)| (p.0 - q.0..=p.1 - q.1).contains(k))
        };
        let mut quotient = Terms::new();
        while let Some((powers, x)) = rest.last_key_value() {
            let powers: Vec<i32> = powers.iter().zip(lead).map(|(a, b)| a - b).collect();
            if !fits(&powers) || quotient.len() > MOST {
                return None;
            }
            let x = over(x, first);
            for (others, y) in &q {
                let (a, b) = times(&x, y);
                add(&mut rest, others.iter().zip(&powers).map(|(a, b)| a + b).collect(), &(-&a, -&b));
            }
            quotient.insert(powers, x);
        }
        Some(places.polynomial(self, &quotient))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atom::Angle;
    use crate::table::Group;

    #[test]
    fn products_are_divided_by_their_factors_and_by_no_others() {
        let mut table = Table::default();
        let angle = |position| Angle::Joint { position, over: 1 };
        table.groups.push(Group::new(vec![angle(0), angle(1)], vec![None, None]));
        let root = table.id(Atom::Root(2));
        let [x, y] = [0, 1].map(|k| {
            let name = crate::atom::Name::new("x", k, "");
            let id = table.id(Atom::State { name, class: crate::atom::Class::Length });
            Polynomial::atom(id)
        });
        let (s, c) = (table.trig(0, false, vec![1, 0]), table.trig(0, true, vec![0, 1]));
        let a = table.times(&x, &s).plus(&table.times(&y, &c)).plus(&y);
        let b = table.times(&s, &c).plus(&x.negated());
        let product = table.times(&a, &b);
        assert_eq!(table.exact_quotient(&product, &a), Some(b.clone()));
        assert_eq!(table.exact_quotient(&product, &b), Some(a.clone()));
        let other = product.plus(&x);
        assert_eq!(table.exact_quotient(&other, &a), None);
        // ½ − ½ cos 2θ over sin θ
        let square = table.times(&s, &s);
        assert_eq!(table.exact_quotient(&square, &s), Some(s.clone()));
        assert_eq!(table.exact_quotient(&Polynomial::atom(root), &s), None);
    }
}
