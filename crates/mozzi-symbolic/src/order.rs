//! The order in which atoms, factors and terms are printed.

use crate::atom::{Atom, Class, Id, Name};
use crate::polynomial::Monomial;
use crate::table::Table;
use std::cmp::Ordering;

/// The place of an atom among the others: by class, number, letter.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Key {
    class: Class,
    letter: usize,
    number: Option<usize>,
    name: Option<Name>,
    harmonic: (usize, Vec<i64>, bool),
    rest: String,
}

/// Masses precede inertias.
fn letter(name: &Name) -> usize {
    ["m", "I", "L", "r"].iter().position(|known| *known == name.letter).unwrap_or(9)
}

/// The place of an atom.
pub(crate) fn key(table: &Table, id: Id) -> Key {
    let name = table.name(id);
    let harmonic = match table.atom(id) {
        // the sines of outer joints last; those of fewer angles first; cosines before sines
        Atom::Trig(trig) => {
            let last = trig.harmonic.iter().rposition(|k| *k != 0).unwrap_or(0);
            let joint = match &table.groups[trig.group].angles[last] {
                crate::atom::Angle::Joint { position, .. } => *position as usize,
                crate::atom::Angle::Constant(_) => usize::MAX,
            };
            let size: i64 = trig.harmonic.iter().map(|k| k.abs()).sum();
            let mut harmonic = vec![size];
            harmonic.extend(trig.harmonic.iter().map(|k| -k));
            (joint, harmonic, !trig.is_cosine)
        }
        _ => (0, Vec::new(), false),
    };
    let rest = match table.atom(id) {
        Atom::Root(n) => format!("{n:020}"),
        Atom::Sign(p) | Atom::Inverse(p) => format!("{p:?}"),
        _ => String::new(),
    };
    Key {
        class: table.class(id),
        letter: name.map_or(0, letter),
        number: name.and_then(|name| name.number),
        name: name.cloned(),
        harmonic,
        rest,
    }
}

/// For each atom its place in the order: a smaller number is printed first.
pub(crate) fn ranks(table: &Table) -> Vec<usize> {
    let mut ids: Vec<(Key, Id)> = (0..table.len() as Id).map(|id| (key(table, id), id)).collect();
    ids.sort_unstable();
    let mut ranks = vec![0; ids.len()];
    for (rank, (_, id)) in ids.iter().enumerate() {
        ranks[*id as usize] = rank;
    }
    ranks
}

/// The order of terms: higher powers of earlier atoms first.
pub(crate) fn compare(ranks: &[usize], a: &Monomial, b: &Monomial) -> Ordering {
    let sorted = |m: &Monomial| {
        let mut factors: Vec<(usize, i32)> = m.factors().map(|(id, k)| (ranks[id as usize], k)).collect();
        factors.sort_unstable();
        factors
    };
    let (a, b) = (sorted(a), sorted(b));
    for (x, y) in a.iter().zip(&b) {
        if x.0 != y.0 {
            return x.0.cmp(&y.0);
        }
        if x.1 != y.1 {
            return y.1.cmp(&x.1);
        }
    }
    b.len().cmp(&a.len())
}
