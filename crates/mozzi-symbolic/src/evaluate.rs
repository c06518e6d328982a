//! Values of expressions at a point.

use crate::atom::{Angle, Atom, Id, Trig};
use crate::polynomial::Polynomial;
use crate::rational::Rational;
use crate::table::Table;
use mozzi::Scalar;

/// The value with the file's numbers, and with 0 for the state.
pub(crate) fn at_file(table: &Table, p: &Polynomial) -> f64 {
    let numbers = Numbers {
        number: &|x: &Rational| x.to_f64(),
        position: &|_| 0.0,
        parameter: &|_, value| value.to_f64(),
        pi: std::f64::consts::PI,
    };
    polynomial(table, p, &numbers)
}

/// The numbers of a point, of any kind.
pub(crate) struct Numbers<'a, S> {
    /// A rational number.
    pub number: &'a dyn Fn(&Rational) -> S,
    /// A number of the state.
    pub position: &'a dyn Fn(Id) -> S,
    /// A parameter, with its value in the file.
    pub parameter: &'a dyn Fn(Id, &Rational) -> S,
    /// π.
    pub pi: S,
}

/// The value of an atom.
pub(crate) fn atom<S: Scalar>(table: &Table, id: Id, numbers: &Numbers<S>) -> S {
    match table.atom(id) {
        Atom::Parameter { value, .. } => (numbers.parameter)(id, value),
        Atom::State { .. } | Atom::Real { .. } => (numbers.position)(id),
        Atom::Root(n) => (numbers.number)(&Rational::new(*n as i64, 1)).sqrt(),
        Atom::Pi => numbers.pi,
        Atom::Trig(trig) => {
            let (s, c) = angle(table, trig, numbers).sin_cos();
            if trig.is_cosine { c } else { s }
        }
        Atom::Sign(p) => polynomial(table, p, numbers).sgn(),
        Atom::Inverse(p) => S::one() / polynomial(table, p, numbers),
    }
}

/// The sum of angles.
fn angle<S: Scalar>(table: &Table, trig: &Trig, numbers: &Numbers<S>) -> S {
    let mut sum = S::zero();
    for (k, angle) in trig.harmonic.iter().zip(&table.groups[trig.group].angles).filter(|(k, _)| **k != 0) {
        sum += match angle {
            Angle::Joint { position, over } => {
                (numbers.position)(*position) * (numbers.number)(&Rational::new(*k, *over))
            }
            Angle::Constant(x) => (numbers.number)(&(x * &Rational::new(*k, 1))),
        };
    }
    sum
}

/// xᵏ.
pub(crate) fn power<S: Scalar>(x: S, k: i32) -> S {
    let product = (1..k.unsigned_abs()).fold(x, |product, _| product * x);
    if k < 0 { S::one() / product } else { product }
}

/// The value of a polynomial.
pub(crate) fn polynomial<S: Scalar>(table: &Table, p: &Polynomial, numbers: &Numbers<S>) -> S {
    let mut sum = S::zero();
    for (monomial, x) in p.terms() {
        sum += monomial
            .factors()
            .fold((numbers.number)(x), |product, (id, k)| product * power(atom(table, id, numbers), k));
    }
    sum
}
