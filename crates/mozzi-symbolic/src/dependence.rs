//! Linear dependence of columns over the constants: columns of functions of the state, whose coefficients are
//! polynomials in lengths, by exact elimination.

use crate::atom::{Angle, Atom, Id};
use crate::polynomial::{Monomial, Polynomial, Sum};
use crate::rational::Rational;
use crate::table::Table;
use std::collections::{BTreeMap, HashMap, HashSet};

/// The entries ≠ 0 of a row by column.
type Row = BTreeMap<usize, Polynomial>;

/// The rows by their first column, in which no other row has an entry.
type Reduced = BTreeMap<usize, Row>;

/// True for parameters and constants, false for functions of the state.
fn is_constant(table: &Table, id: Id) -> bool {
    match table.atom(id) {
        Atom::Parameter { .. } | Atom::Root(_) | Atom::Pi | Atom::Inverse(_) => true,
        Atom::Trig(trig) => {
            let angles = &table.groups[trig.group].angles;
            angles.iter().all(|angle| matches!(angle, Angle::Constant(_)))
        }
        Atom::State { .. } | Atom::Real { .. } | Atom::Sign(_) => false,
    }
}

/// For each column that does not depend on the ones before, how the columns depend on it: column k is Σ_j (entry k of
/// row j) · column j. `columns` has the entries of each column. None if a quotient is no polynomial, and none of
/// lengths.
pub(crate) fn dependence(table: &mut Table, columns: &[Vec<Polynomial>]) -> Option<Reduced> {
    let mut rows = rows(table, columns);
    let size = |row: &Row| (row.len(), row.values().map(|p| p.terms().len()).sum::<usize>());
    rows.sort_by_cached_key(|row| (size(row), row.keys().copied().collect::<Vec<_>>()));
    let mut reduced = Reduced::new();
    let mut known = HashSet::new();
    for row in rows {
        let row = scaled(table, row);
        if known.insert(row.clone().into_iter().collect::<Vec<_>>()) {
            insert(table, &mut reduced, row);
        }
        table.fault.is_none().then_some(())?;
    }
    for (pivot, row) in &mut reduced {
        let below = row[pivot].clone();
        for p in row.values_mut() {
            *p = table.exact_quotient(p, &below).unwrap_or_else(|| table.over(p, &below));
        }
    }
    table.fault.is_none().then_some(reduced)
}

/// A row for each entry and function of the state.
fn rows(table: &Table, columns: &[Vec<Polynomial>]) -> Vec<Row> {
    let mut rows: HashMap<(usize, Monomial), BTreeMap<usize, Sum>> = HashMap::new();
    for (k, column) in columns.iter().enumerate() {
        for (i, entry) in column.iter().enumerate() {
            for (monomial, x) in entry.terms() {
                let (constant, function) = monomial.split(|id| is_constant(table, id));
                let row = rows.entry((i, function)).or_default();
                row.entry(k).or_default().add(constant, x);
            }
        }
    }
    let row = |sums: BTreeMap<usize, Sum>| sums.into_iter().map(|(k, sum)| (k, sum.end())).collect();
    rows.into_values().map(row).collect()
}

/// The row over its first entry, if that is a monomial; else over that entry's first coefficient.
fn scaled(table: &mut Table, row: Row) -> Row {
    let Some(first) = row.values().next() else { return row };
    let Some((_, x)) = first.terms().first() else { return row };
    let is_plain = |id: Id| !matches!(table.atom(id), Atom::Trig(_) | Atom::Root(_));
    let is_monomial = first.terms().len() == 1 && first.terms()[0].0.factors().all(|(id, _)| is_plain(id));
    let by = if is_monomial { first.clone() } else { Polynomial::constant(x.clone()) };
    row.into_iter().map(|(k, p)| (k, table.over(&p, &by))).collect()
}

/// Reduces a row by the others, and the others by it.
fn insert(table: &mut Table, reduced: &mut Reduced, mut row: Row) {
    for (pivot, other) in reduced.iter() {
        if row.contains_key(pivot) {
            row = without(table, row, other, *pivot);
        }
    }
    let Some(&first) = row.keys().next() else { return };
    let row = scaled(table, row);
    for other in reduced.values_mut().filter(|other| other.contains_key(&first)) {
        *other = without(table, std::mem::take(other), &row, first);
    }
    reduced.insert(first, row);
}

/// b_c a − a_c b, whose entry c is 0.
fn without(table: &mut Table, a: Row, b: &Row, c: usize) -> Row {
    let (of_a, of_b) = (a[&c].negated(), b[&c].clone());
    let mut sum = Row::new();
    for (k, p) in &a {
        sum.insert(*k, table.times(p, &of_b));
    }
    for (k, p) in b {
        let product = table.times(p, &of_a);
        let entry = sum.entry(*k).or_default();
        *entry = entry.plus(&product);
    }
    sum.retain(|_, p| !p.is_zero());
    // the row stays small if its pivot divides it
    let pivot = sum.values().next().cloned().unwrap_or_default();
    let quotients: Option<Vec<Polynomial>> = sum.values().map(|p| table.exact_quotient(p, &pivot)).collect();
    match quotients {
        Some(quotients) => sum.keys().copied().zip(quotients).collect(),
        None => sum,
    }
}

/// The rational value of a polynomial of parameters, with the file's numbers.
pub(crate) fn file_value(table: &Table, p: &Polynomial) -> Option<Rational> {
    let mut sum = Rational::ZERO;
    for (monomial, x) in p.terms() {
        let mut product = x.clone();
        for (id, k) in monomial.factors() {
            let Atom::Parameter { value, .. } = table.atom(id) else { return None };
            product = &product * &value.power(k);
        }
        sum = &sum + &product;
    }
    Some(sum)
}
