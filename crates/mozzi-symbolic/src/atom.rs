//! The atoms of polynomials: parameters, the state, sines and cosines.

use crate::polynomial::Polynomial;
use crate::rational::Rational;

/// The index of an atom in its [`Table`](crate::table::Table).
pub(crate) type Id = u32;

/// The kind of a parameter or a state's number, in the order in which factors are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Class {
    /// Masses, rotational inertias, rotor inertias.
    Inertia,
    /// Friction and spring constants of joints.
    Joint,
    /// Distances.
    Length,
    /// Gravity.
    Gravity,
    /// A position that is no angle, or an angle outside sines.
    Position,
    /// Sines and cosines.
    Trigonometric,
    /// Velocities, in products.
    Rate,
    /// Accelerations, joint forces and given vectors.
    Linear,
}

/// A name as the book writes it: a letter, dots above it, and a subscript.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Name {
    /// `m`, `L`, `θ` …
    pub letter: &'static str,
    /// The dots: 1 for a rate, 2 for an acceleration.
    pub dots: u8,
    /// The number of a link or joint, if it has one.
    pub number: Option<usize>,
    /// Further parts of the subscript: `zz`, `x`, a link's name.
    pub part: String,
}

impl Name {
    pub(crate) fn new(letter: &'static str, number: impl Into<Option<usize>>, part: impl Into<String>) -> Self {
        Name { letter, dots: 0, number: number.into(), part: part.into() }
    }
}

/// A sine or cosine of a sum of angles of one group of parallel axes.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Trig {
    /// The group of angles.
    pub group: usize,
    /// A cosine, else a sine.
    pub is_cosine: bool,
    /// How often each of the group's angles is taken; the first that is not 0 is positive.
    pub harmonic: Vec<i64>,
}

/// A factor of monomials.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Atom {
    /// A parameter of the robot, with its number in the file.
    Parameter { name: Name, class: Class, value: Rational },
    /// A number of the state or of a given vector.
    State { name: Name, class: Class },
    /// The first number of a unit quaternion: its square is 1 less the squares of the other three.
    Real { name: Name, imaginary: [Id; 3] },
    /// √n, n without square factors.
    Root(u64),
    /// π; only angles of the file contain it.
    Pi,
    /// A sine or cosine.
    Trig(Trig),
    /// sgn of a polynomial.
    Sign(Polynomial),
    /// 1 over a polynomial of parameters.
    Inverse(Polynomial),
}

/// An angle under sines and cosines.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Angle {
    /// A joint's position over a whole number, which is 1 without fractional mimic ratios.
    Joint { position: Id, over: i64 },
    /// A constant of the file, radians.
    Constant(Rational),
}
