//! The number type: an expression of this thread's derivation.

use crate::atom::{Angle, Atom, Id};
use crate::evaluate;
use crate::point::Point;
use crate::polynomial::{Monomial, Polynomial, Sum};
use crate::rational::Rational;
use crate::table::{Fault, Table};
use mozzi::{Real, Scalar};
use std::cell::RefCell;
use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};
use std::rc::Rc;

/// An exact expression: a number for mozzi's kernels, `Model<Symbol>`. It is an index into the expressions of this
/// thread's derivation, without meaning after it.
#[derive(Clone, Copy, Debug)]
pub struct Symbol(u32);

#[derive(Default)]
struct Session {
    table: Table,
    values: Vec<Rc<Polynomial>>,
    /// The terms of all values.
    terms: usize,
    /// Where sines are numbers at once: see `proof.rs`.
    point: Option<Point>,
}

/// Values of more terms in all are not computed: half a GB.
const MOST_TERMS: usize = 4_000_000;

thread_local! {
    static SESSION: RefCell<Session> = RefCell::default();
}

fn with<R>(f: impl FnOnce(&mut Session) -> R) -> R {
    SESSION.with(|session| f(&mut session.borrow_mut()))
}

/// Starts a derivation: forgets the expressions of the one before.
pub(crate) fn start(table: Table) {
    let constants = [Rational::ZERO, Rational::ONE];
    let values = constants.map(|x| Rc::new(Polynomial::constant(x))).to_vec();
    with(|session| *session = Session { table, values, terms: 0, point: None });
}

/// The atoms; the expressions are forgotten.
pub(crate) fn end() -> Table {
    with(std::mem::take).table
}

pub(crate) fn with_table<R>(f: impl FnOnce(&mut Table) -> R) -> R {
    with(|session| f(&mut session.table))
}

/// Counts the terms of values anew: a proof's are numbers.
pub(crate) fn recount() {
    with(|session| session.terms = 0);
}

/// From now on sines and cosines are those of this point.
pub(crate) fn set_point(point: Option<Point>) {
    with(|session| session.point = point);
}

const ZERO: Symbol = Symbol(0);
const ONE: Symbol = Symbol(1);

impl Session {
    fn get(&self, x: Symbol) -> Rc<Polynomial> {
        Rc::clone(&self.values[x.0 as usize])
    }

    fn put(&mut self, p: Polynomial) -> Symbol {
        match p.number() {
            Some(x) if x.is_zero() => ZERO,
            Some(x) if x.is_one() => ONE,
            _ => {
                self.terms += p.terms().len();
                if self.terms > MOST_TERMS {
                    self.table.fault.get_or_insert(Fault::TooLong([self.terms, MOST_TERMS]));
                    return ZERO;
                }
                self.values.push(Rc::new(p));
                Symbol(self.values.len() as u32 - 1)
            }
        }
    }

    fn fail(&mut self, what: impl Into<String>) -> Symbol {
        self.table.fault.get_or_insert(Fault::Left(what.into()));
        ZERO
    }
}

impl Symbol {
    pub(crate) fn new(p: Polynomial) -> Self {
        with(|session| session.put(p))
    }

    pub(crate) fn atom(id: Id) -> Self {
        Self::new(Polynomial::atom(id))
    }

    pub(crate) fn polynomial(self) -> Polynomial {
        with(|session| (*session.get(self)).clone())
    }

    /// The atom, if the expression is one.
    pub(crate) fn single_atom(self) -> Option<Id> {
        with(|session| match session.get(self).terms() {
            [(monomial, x)] if x.is_one() && monomial.factors().len() == 1 => {
                monomial.factors().next().map(|(id, _)| id)
            }
            _ => None,
        })
    }

    fn is_zero(self) -> bool {
        self.0 == 0
    }

    fn is_one(self) -> bool {
        self.0 == 1
    }
}

/// A number, exactly.
impl From<Rational> for Symbol {
    fn from(x: Rational) -> Self {
        Self::new(Polynomial::constant(x))
    }
}

/// The value with the file's numbers, and 0 for the state.
impl From<Symbol> for f64 {
    fn from(x: Symbol) -> f64 {
        with(|session| {
            let p = session.get(x);
            p.number().map_or_else(|| evaluate::at_file(&session.table, &p), |x| x.to_f64())
        })
    }
}

impl PartialEq for Symbol {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0 || with(|session| session.get(*self) == session.get(*other))
    }
}

/// By the values with the file's numbers; only the search for a robot's axes compares.
impl PartialOrd for Symbol {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match self == other {
            true => Some(Ordering::Equal),
            false => f64::from(*self).partial_cmp(&f64::from(*other)),
        }
    }
}

impl Add for Symbol {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        match (self.is_zero(), other.is_zero()) {
            (true, _) => other,
            (_, true) => self,
            _ => with(|session| {
                let sum = session.get(self).plus(&session.get(other));
                session.put(sum)
            }),
        }
    }
}
impl Sub for Symbol {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}
impl Mul for Symbol {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        match () {
            () if self.is_zero() || other.is_zero() => ZERO,
            () if self.is_one() => other,
            () if other.is_one() => self,
            () => with(|session| {
                let (a, b) = (session.get(self), session.get(other));
                let product = session.table.times(&a, &b);
                session.put(product)
            }),
        }
    }
}
impl Div for Symbol {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        if other.is_one() {
            return self;
        }
        with(|session| {
            let (a, b) = (session.get(self), session.get(other));
            let quotient = session.table.over(&a, &b);
            session.put(quotient)
        })
    }
}
impl Neg for Symbol {
    type Output = Self;
    fn neg(self) -> Self {
        if self.is_zero() {
            return self;
        }
        with(|session| {
            let negative = session.get(self).negated();
            session.put(negative)
        })
    }
}
impl AddAssign for Symbol {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl SubAssign for Symbol {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Scalar for Symbol {
    type Lanes<const L: usize> = [Self; L];
    const IS_ONE: bool = false;

    fn from_f64(x: f64) -> Self {
        match Rational::binary(x) {
            Some(x) => x.into(),
            None => with(|session| session.fail(format!("needs the number {x}"))),
        }
    }

    fn sin_cos(self) -> (Self, Self) {
        with(|session| {
            let x = session.get(self);
            match sin_cos(&mut session.table, &x) {
                Some((s, c)) => {
                    let Session { table, point, .. } = &mut *session;
                    let [s, c] = match point {
                        Some(point) => [s, c].map(|p| with_numbers(table, point, &p)),
                        None => [s, c],
                    };
                    (session.put(s), session.put(c))
                }
                None => {
                    let fault = session.fail("needs the sine of an expression that is no sum of angles");
                    (fault, fault)
                }
            }
        })
    }

    fn sqrt(self) -> Self {
        with(|session| {
            let x = session.get(self).number();
            match x.and_then(|x| session.table.root(&x)) {
                Some(root) => session.put(root),
                None => session.fail("needs the square root of an expression"),
            }
        })
    }

    fn tanh(self) -> Self {
        with(|session| session.fail("needs the hyperbolic tangent of an expression"))
    }

    fn sgn(self) -> Self {
        with(|session| {
            let x = session.get(self);
            match x.terms() {
                [] => ZERO,
                [(_, first), ..] => {
                    let is_negative = first.is_negative();
                    let size = first.abs();
                    let unit = (if is_negative { x.negated() } else { (*x).clone() }).scaled(&size.inverse());
                    let sign = Polynomial::atom(session.table.id(Atom::Sign(unit)));
                    session.put(if is_negative { sign.negated() } else { sign })
                }
            }
        })
    }

    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }
}

impl Real for Symbol {
    fn epsilon() -> Self {
        ZERO
    }
    fn atan2(self, _: Self) -> Self {
        with(|session| session.fail("needs the angle of a point"))
    }
}

/// Sines and cosines replaced by their numbers at a point.
fn with_numbers(table: &Table, point: &Point, p: &Polynomial) -> Polynomial {
    let mut sum = Sum::default();
    for (monomial, x) in p.terms() {
        let (mut rest, mut x) = (Monomial::default(), x.clone());
        for (id, k) in monomial.factors() {
            match (table.atom(id), point.value(table.atom(id), id)) {
                (Atom::Trig(_), Some(value)) => x = &x * &value.power(k),
                _ => rest = rest.times(&Monomial::atom(id, k)),
            }
        }
        sum.add(rest, &x);
    }
    sum.end()
}

/// Sine and cosine of a sum of multiples of joints' angles, of π, and a constant.
fn sin_cos(table: &mut Table, x: &Polynomial) -> Option<(Polynomial, Polynomial)> {
    let mut found = (Polynomial::default(), Polynomial::constant(Rational::ONE));
    for (monomial, k) in x.terms() {
        let mut factors = monomial.factors();
        let one = match (factors.next(), factors.next()) {
            (None, _) => constant(table, k),
            (Some((id, 1)), None) => match table.atom(id) {
                Atom::Pi => of_pi(table, k)?,
                _ => of_joint(table, id, k)?,
            },
            _ => return None,
        };
        found = sum_of_angles(table, &found, &one);
    }
    Some(found)
}

fn sum_of_angles(
    table: &mut Table,
    a: &(Polynomial, Polynomial),
    b: &(Polynomial, Polynomial),
) -> (Polynomial, Polynomial) {
    let s = table.times(&a.0, &b.1).plus(&table.times(&a.1, &b.0));
    let c = table.times(&a.1, &b.1).plus(&table.times(&a.0, &b.0).negated());
    (s, c)
}

/// (sin kπ, cos kπ) for k a multiple of 1/12.
fn of_pi(table: &mut Table, k: &Rational) -> Option<(Polynomial, Polynomial)> {
    let twelfths = (k * &Rational::new(12, 1)).integer()?.rem_euclid(24);
    let root = |table: &mut Table, n: i64| table.root(&Rational::new(n, 1));
    let half = Rational::new(1, 2);
    // sin 15° = (√6 − √2)/4
    let sine = |table: &mut Table, twelfths: i32| {
        let (quarter, sign) = match twelfths.rem_euclid(24) {
            k @ 0..=6 => (k, 1),
            k @ 7..=12 => (12 - k, 1),
            k @ 13..=18 => (k - 12, -1),
            k => (24 - k, -1),
        };
        let quarter_of = Rational::new(1, 4);
        let size = match quarter {
            0 => Polynomial::default(),
            1 => root(table, 6)?.plus(&root(table, 2)?.negated()).scaled(&quarter_of),
            2 => Polynomial::constant(half.clone()),
            3 => root(table, 2)?.scaled(&half),
            4 => root(table, 3)?.scaled(&half),
            5 => root(table, 6)?.plus(&root(table, 2)?).scaled(&quarter_of),
            _ => Polynomial::constant(Rational::ONE),
        };
        Some(if sign < 0 { size.negated() } else { size })
    };
    Some((sine(table, twelfths)?, sine(table, twelfths + 6)?))
}

/// (sin k, cos k) of a constant in radians; each |k| is an angle of its own.
fn constant(table: &mut Table, k: &Rational) -> (Polynomial, Polynomial) {
    let angle = Angle::Constant(k.abs());
    let group = table.groups.iter().position(|group| group.angles.contains(&angle)).unwrap_or_else(|| {
        table.groups.push(crate::table::Group::new(vec![angle], vec![None]));
        table.groups.len() - 1
    });
    let sign = if k.is_negative() { -1 } else { 1 };
    (table.trig(group, false, vec![sign]), table.trig(group, true, vec![sign]))
}

/// (sin kθ, cos kθ) of a joint's position θ.
fn of_joint(table: &mut Table, id: Id, k: &Rational) -> Option<(Polynomial, Polynomial)> {
    let is_it = |angle: &Angle| matches!(angle, Angle::Joint { position, .. } if *position == id);
    let find = |(group, one): (usize, &crate::table::Group)| Some((group, one.angles.iter().position(is_it)?));
    let (group, place) = table.groups.iter().enumerate().find_map(find)?;
    let Angle::Joint { over, .. } = table.groups[group].angles[place] else { return None };
    let times = (k * &Rational::new(over, 1)).integer()?;
    let mut harmonic = vec![0; table.groups[group].angles.len()];
    harmonic[place] = times.into();
    Some((table.trig(group, false, harmonic.clone()), table.trig(group, true, harmonic)))
}
