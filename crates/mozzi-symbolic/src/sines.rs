//! The shortest way to write sines and cosines: of sums of angles, or as products of those of single sums.

use crate::atom::{Atom, Class, Id, Trig};
use crate::polynomial::{Monomial, Polynomial, Sum};
use crate::rational::Rational;
use crate::table::Table;
use std::collections::{BTreeMap, BTreeSet, HashMap};

type Term = (Monomial, Rational);

/// The terms with shorter sines. Each coefficient of parameters and rates is rewritten by itself: ½ − ½ cos 2θ is
/// sin² θ, ½ cos θ₂ + ½ cos(2θ₁ + θ₂) is cos θ₁ cos(θ₁ + θ₂).
pub(crate) fn shortened(table: &mut Table, p: &Polynomial) -> Vec<Term> {
    let mut coefficients: BTreeMap<Monomial, Vec<Term>> = BTreeMap::new();
    for (monomial, x) in p.terms() {
        let (sines, rest) = monomial.split(|id| table.class(id) == Class::Trigonometric);
        coefficients.entry(rest).or_default().push((sines, x.clone()));
    }
    let mut terms = Vec::new();
    for (rest, mut sines) in coefficients {
        let groups: BTreeSet<usize> =
            sines.iter().flat_map(|(m, _)| m.factors()).filter_map(|(id, _)| table.group(id)).collect();
        for group in groups {
            let [sums, angles] = [true, false].map(|by_sums| shorter(table, sines.clone(), group, by_sums));
            sines = if size(table, &angles) < size(table, &sums) { angles } else { sums };
        }
        terms.extend(sines.into_iter().map(|(sines, x)| (rest.times(&sines), x)));
    }
    terms
}

/// The terms, then the products, then the minus signs; a multiple of an angle, or of a sum of angles, is a product.
fn size(table: &Table, terms: &[Term]) -> (usize, i32, usize) {
    let doubled = |id: Id| {
        let multiples = |k: Vec<i64>| k.iter().filter(|k| k.abs() > 1).count() as i32;
        [true, false].map(|by_sums| multiples(coordinates(table, id, by_sums))).into_iter().min().unwrap_or(0)
    };
    let degree = |m: &Monomial| m.factors().map(|(id, k)| k.abs() + doubled(id)).sum::<i32>();
    let products = |(m, x): &Term| degree(m) + i32::from(!x.abs().is_one() && !m.is_one());
    let negative = terms.iter().filter(|(_, x)| x.is_negative()).count();
    (terms.len(), terms.iter().map(products).sum(), negative)
}

/// A sine or cosine of one cumulative sum, with its power.
type Single = (usize, bool);

/// The shortest of: the sum as it is; products with cosines, or sines, of each cumulative sum, or else of each angle,
/// to the first power only.
fn shorter(table: &mut Table, terms: Vec<Term>, group: usize, by_sums: bool) -> Vec<Term> {
    let groups: HashMap<Id, Option<usize>> =
        terms.iter().flat_map(|(m, _)| m.factors()).map(|(id, _)| (id, table.group(id))).collect();
    let of_group = |m: &Monomial| m.factors().map(|(id, _)| id).find(|id| groups[id] == Some(group));
    let harmonics: BTreeSet<Id> = terms.iter().filter_map(|(m, _)| of_group(m)).collect();
    let coordinates: HashMap<Id, Vec<i64>> =
        harmonics.iter().map(|&id| (id, coordinates(table, id, by_sums))).collect();
    let is_single = |k: &[i64]| k.iter().map(|k| k.abs()).sum::<i64>() <= 1;
    if coordinates.values().all(|k| is_single(k)) {
        return terms;
    }
    if coordinates.values().any(|k| k.iter().map(|k| k.abs()).sum::<i64>() > 6) {
        return terms; // of third and higher degree nothing is gained
    }
    let expanded: HashMap<Id, Vec<Product>> = coordinates
        .iter()
        .map(|(&id, k)| {
            let is_cosine = matches!(table.atom(id), Atom::Trig(trig) if trig.is_cosine);
            (id, expand(k, is_cosine))
        })
        .collect();
    let sums: BTreeSet<usize> =
        coordinates.values().flat_map(|k| (0..k.len()).filter(|&i| k[i] != 0).collect::<Vec<_>>()).collect();
    let sums: Vec<usize> = sums.into_iter().collect();
    let masks = if sums.len() <= 3 { (0..1_u32 << sums.len()).collect() } else { vec![0, u32::MAX] };
    let mut best = terms.clone();
    let mut is_given = true;
    for mask in masks {
        let keeps_cosine = |sum: usize| sums.iter().position(|&s| s == sum).is_some_and(|k| mask >> k & 1 == 0);
        let mut total: HashMap<(Monomial, BTreeMap<Single, i32>), Rational> = HashMap::new();
        for (monomial, x) in &terms {
            let Some(id) = of_group(monomial) else {
                let entry = total.entry((monomial.clone(), BTreeMap::new())).or_insert(Rational::ZERO);
                *entry = &*entry + x;
                continue;
            };
            let (_, rest) = monomial.split(|other| other == id);
            for (powers, y) in &expanded[&id] {
                for (powers, z) in reduced(powers, &keeps_cosine) {
                    let entry = total.entry((rest.clone(), powers)).or_insert(Rational::ZERO);
                    *entry = &*entry + &(&(x * y) * &z);
                }
            }
        }
        let total: Vec<_> = total.into_iter().filter(|(_, x)| !x.is_zero()).collect();
        if total.len() > best.len() {
            continue;
        }
        let mut sum = Sum::default();
        for ((rest, powers), x) in total {
            let mut product = rest;
            for ((angle, is_cosine), k) in powers {
                let (id, sign) = single(table, group, angle, is_cosine, by_sums);
                product = product.times(&Monomial::atom(id, k));
                assert!(sign > 0 || is_cosine, "a cumulative sum starts with a positive angle");
            }
            sum.add(product, &x);
        }
        let candidate = sum.end().0;
        let (new, old) = (size(table, &candidate), size(table, &best));
        if new < old || is_given && (new.0, new.1) == (old.0, old.1) {
            (best, is_given) = (candidate, false);
        }
    }
    best
}

/// The atom of a cumulative sum's, or an angle's, sine or cosine.
fn single(table: &mut Table, group: usize, angle: usize, is_cosine: bool, by_sums: bool) -> (Id, i64) {
    let angles = table.groups[group].angles.len();
    let mut harmonic = vec![0; angles];
    let (mut at, mut sign) = (angle, 1);
    loop {
        harmonic[at] = sign;
        match table.groups[group].before[at] {
            Some((before, turned)) if by_sums => (at, sign) = (before, sign * turned),
            _ => break,
        }
    }
    // the sum's sign is chosen so that the first angle is positive: see `coordinates`
    let first = harmonic.iter().find(|k| **k != 0).copied().unwrap_or(1);
    harmonic.iter_mut().for_each(|k| *k *= first);
    (table.id(Atom::Trig(Trig { group, is_cosine, harmonic })), 1)
}

/// How often each angle is taken, or each cumulative sum: θ_i is that of i less, or plus, that of the angle before.
fn coordinates(table: &Table, id: Id, by_sums: bool) -> Vec<i64> {
    let Atom::Trig(trig) = table.atom(id) else { return Vec::new() };
    let group = &table.groups[trig.group];
    if !by_sums {
        return trig.harmonic.clone();
    }
    let mut k = vec![0; trig.harmonic.len()];
    for (i, times) in trig.harmonic.iter().enumerate() {
        k[i] += times * group.signs[i];
        if let Some((before, turned)) = group.before[i] {
            k[before] -= times * turned * group.signs[before];
        }
    }
    k
}

/// Powers of sines and cosines of single angles, and their factor.
type Product = (BTreeMap<Single, i32>, Rational);

/// cos or sin of Σ k_i φ_i as a sum of products.
fn expand(k: &[i64], is_cosine: bool) -> Vec<Product> {
    let one = || vec![(BTreeMap::new(), Rational::ONE)];
    let (mut c, mut s) = (one(), Vec::new());
    for (i, times) in k.iter().enumerate() {
        for _ in 0..times.abs() {
            let sign = Rational::new(times.signum(), 1);
            let with = |sum: &[Product], is_cosine: bool, by: &Rational| {
                sum.iter()
                    .map(|(powers, x)| {
                        let mut powers = powers.clone();
                        *powers.entry((i, is_cosine)).or_insert(0) += 1;
                        (powers, x * by)
                    })
                    .collect::<Vec<_>>()
            };
            let plus = Rational::ONE;
            let next_c = [with(&c, true, &plus), with(&s, false, &-&sign)].concat();
            let next_s = [with(&s, true, &plus), with(&c, false, &sign)].concat();
            (c, s) = (next_c, next_s);
        }
    }
    if is_cosine { c } else { s }
}

/// With cos² or sin² of each sum replaced by Pythagoras.
fn reduced(powers: &BTreeMap<Single, i32>, keeps_cosine: &dyn Fn(usize) -> bool) -> Vec<Product> {
    let mut sum = vec![(powers.clone(), Rational::ONE)];
    loop {
        let high = |(powers, _): &Product| {
            powers.iter().find(|((i, is_cosine), k)| *is_cosine != keeps_cosine(*i) && **k > 1).map(|(key, _)| *key)
        };
        let Some(place) = sum.iter().position(|term| high(term).is_some()) else { return sum };
        let (mut powers, x) = sum.swap_remove(place);
        let Some((i, is_cosine)) = high(&(powers.clone(), x.clone())) else { return sum };
        // x² = 1 − y²
        match powers.get_mut(&(i, is_cosine)) {
            Some(2) => {
                powers.remove(&(i, is_cosine));
            }
            Some(k) => *k -= 2,
            None => {}
        }
        let mut other = powers.clone();
        *other.entry((i, !is_cosine)).or_insert(0) += 2;
        sum.push((powers, x.clone()));
        sum.push((other, -&x));
    }
}
