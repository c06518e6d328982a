//! Points at which expressions are compared.

use crate::atom::{Atom, Id};
use crate::rational::Rational;
use crate::table::Table;
use mozzi::random::Random;
use std::collections::HashMap;

/// A random rational point: numbers for all parameters and states, and for each angle a rational point of the circle.
/// Roots stay symbols, so that equality is exact.
#[derive(Clone, Debug, Default)]
pub(crate) struct Point {
    values: HashMap<Id, Rational>,
    /// (sine, cosine) by group and place.
    circle: HashMap<(usize, usize), (Rational, Rational)>,
}

fn number(random: &mut Random) -> Rational {
    let sign = if random.below(2) == 0 { 1 } else { -1 };
    Rational::new(sign * (1 + random.below(997) as i64), 1 + random.below(8) as i64)
}

/// ((1 − t²)/(1 + t²), 2t/(1 + t²)).
fn circle(random: &mut Random) -> (Rational, Rational) {
    let (a, b) = (1 + random.below(40) as i64, 1 + random.below(40) as i64);
    let sign = if random.below(2) == 0 { 1 } else { -1 };
    let over = a * a + b * b;
    (Rational::new(sign * 2 * a * b, over), Rational::new(a * a - b * b, over))
}

impl Point {
    pub fn random(table: &Table, random: &mut Random) -> Self {
        let mut point = Point::default();
        for id in 0..table.len() as Id {
            if let Atom::Parameter { .. } | Atom::State { .. } = table.atom(id) {
                point.values.insert(id, number(random));
            }
        }
        for id in 0..table.len() as Id {
            if let Atom::Real { imaginary, .. } = table.atom(id).clone() {
                // a rational unit quaternion, by two points of circles
                let [(a, b), (c, d), (e, f)] = [circle(random), circle(random), circle(random)];
                let parts = [&a * &c, &a * &d, &b * &e, &b * &f];
                for (id, x) in [id].into_iter().chain(imaginary).zip(parts) {
                    point.values.insert(id, x);
                }
            }
        }
        for (g, group) in table.groups.iter().enumerate() {
            for k in 0..group.angles.len() {
                point.circle.insert((g, k), circle(random));
            }
        }
        point
    }

    /// The value of an atom; roots are their own. None for a sign or inverse, which is made of others.
    pub fn value(&self, atom: &Atom, id: Id) -> Option<Rational> {
        match atom {
            Atom::Trig(trig) => {
                let (mut s, mut c) = (Rational::ZERO, Rational::ONE);
                for (k, times) in trig.harmonic.iter().enumerate() {
                    let (sine, cosine) = &self.circle[&(trig.group, k)];
                    let sine = if *times < 0 { -sine } else { sine.clone() };
                    for _ in 0..times.abs() {
                        (s, c) = (&(&s * cosine) + &(&c * &sine), &(&c * cosine) - &(&s * &sine));
                    }
                }
                Some(if trig.is_cosine { c } else { s })
            }
            _ => self.values.get(&id).cloned(),
        }
    }
}
