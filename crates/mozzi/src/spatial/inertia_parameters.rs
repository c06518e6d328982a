//! A spatial inertia as the ten numbers in which forces and energies are linear.

use super::{SpatialInertia, Twist};
use crate::linalg::{Sym3, Vec3};
use crate::scalar::Scalar;

impl<S: Scalar> SpatialInertia<S> {
    /// (m, m c_x, m c_y, m c_z, I_xx, I_xy, I_xz, I_yy, I_yz, I_zz), I about the frame's origin; kg, kg m, kg m².
    pub fn to_parameters(self) -> [S; 10] {
        let (SpatialInertia { mass, I, .. }, [x, y, z]) = (self, self.mc.0);
        [mass, x, y, z, I.xx, I.xy, I.xz, I.yy, I.yz, I.zz]
    }

    /// From the ten numbers of [`to_parameters`](Self::to_parameters).
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn from_parameters([mass, x, y, z, xx, xy, xz, yy, yz, zz]: [S; 10]) -> Self {
        SpatialInertia { mass, mc: Vec3([x, y, z]), I: Sym3 { xx, xy, xz, yy, yz, zz } }
    }

    /// Xᵀ𝒢A = Σ y_k π_k as the ten numbers y_k of twists X and A.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[rustfmt::skip] // as the parameters: mass, first moments, inertia
    pub fn by_parameters(X: Twist<S>, A: Twist<S>) -> [S; 10] {
        let ([x, y, z], [a, b, c], mc) = (X.w.0, A.w.0, A.v.cross_add(X.w, X.v.cross(A.w)).0);
        let mixed = |x: S, b: S, y: S, a: S| x.mul_add(b, y * a);
        [
            X.v.dot(A.v), mc[0], mc[1], mc[2],
            x * a, mixed(x, b, y, a), mixed(x, c, z, a), y * b, mixed(y, c, z, b), z * c,
        ]
    }

    /// The ten inertias with one parameter 1 and the others 0; only weighted sums of them are bodies.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn units() -> [Self; 10] {
        core::array::from_fn(|k| {
            Self::from_parameters(core::array::from_fn(|i| if i == k { S::one() } else { S::zero() }))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::inertia;

    #[test]
    fn an_inertia_is_the_weighted_sum_of_units() {
        let G = inertia(3);
        let terms = SpatialInertia::units().into_iter().zip(G.to_parameters()).map(|(unit, weight)| unit * weight);
        assert_eq!(terms.fold(SpatialInertia::zero(), |sum, term| sum + term), G);
        assert_eq!(SpatialInertia::from_parameters(G.to_parameters()), G);
    }
}
