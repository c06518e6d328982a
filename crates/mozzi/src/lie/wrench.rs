//! Wrenches: elements of se(3)*, dual to twists.

use crate::linalg::{Vec3, linear_space};
use crate::scalar::Scalar;

/// F = (m, f), angular first: a moment about some frame's origin and a force, in that frame's coordinates. Also a
/// spatial momentum GV. N m and N.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Wrench<S = f64> {
    /// m.
    pub m: Vec3<S>,
    /// f.
    pub f: Vec3<S>,
}
linear_space!(Wrench { m, f });

impl<S: Scalar> Wrench<S> {
    /// 0.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn zero() -> Self {
        Wrench { m: Vec3::zero(), f: Vec3::zero() }
    }

    /// From (m, f) in one array, angular first.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn from_array([a, b, c, x, y, z]: [S; 6]) -> Self {
        Wrench { m: Vec3([a, b, c]), f: Vec3([x, y, z]) }
    }

    /// (m, f) in one array, angular first.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn to_array(self) -> [S; 6] {
        let ([a, b, c], [x, y, z]) = (self.m.0, self.f.0);
        [a, b, c, x, y, z]
    }

    /// (f, m) in one array, **linear first**, as Pinocchio and MuJoCo order it.
    pub fn to_linear_first(self) -> [S; 6] {
        let ([a, b, c], [x, y, z]) = (self.m.0, self.f.0);
        [x, y, z, a, b, c]
    }

    /// From (f, m), **linear first**.
    pub fn from_linear_first([x, y, z, a, b, c]: [S; 6]) -> Self {
        Wrench { m: Vec3([a, b, c]), f: Vec3([x, y, z]) }
    }

    /// This wrench or momentum, with its moment about a point p of its frame instead of the origin: (m − p × f, f).
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn about(self, p: Vec3<S>) -> Self {
        Wrench { m: self.f.cross_add(p, self.m), f: self.f }
    }

    /// √(‖m‖² + ‖f‖²), for tests and tolerances; it mixes units.
    pub fn norm(self) -> S {
        (self.m.dot(self.m) + self.f.dot(self.f)).sqrt()
    }

    /// Each component by f.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn map<U>(self, f: impl Fn(S) -> U + Copy) -> Wrench<U> {
        Wrench { m: self.m.map(f), f: self.f.map(f) }
    }
}
