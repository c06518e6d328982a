//! The physical inertia nearest to one that no body can have.

use super::SpatialInertia;
use crate::linalg::Sym3;
use nalgebra::{Matrix3, SymmetricEigen};

impl SpatialInertia<f64> {
    /// The physical inertia nearest to this one, with the same mass and mass centre; this one if it is physical. None
    /// if the mass is negative or a number is not finite.
    ///
    /// With the rotational inertia I about the centre of mass, Σ = ½ tr(I) 1 − I is the second moment of the mass,
    /// ∫ r rᵀ dm. A body can have every positive semidefinite Σ and no other, so negative eigenvalues of Σ are set to
    /// zero, the nearest in the Frobenius norm (Wensing, Kim and Slotine, IEEE RA-L 3(1), 2018, for the condition).
    pub fn nearest_physical(&self) -> Option<Self> {
        if !(self.mass >= 0.0) || !self.to_matrix().as_flattened().iter().all(|x| x.is_finite()) {
            return None;
        }
        if self.verdict().is_physical() {
            return Some(*self);
        }
        let I = self.about_center_of_mass();
        let scale = I.to_mat3().rows().as_flattened().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let half = 0.5 * I.trace() / scale;
        let sigma = Matrix3::from_fn(|i, j| if i == j { half } else { 0.0 } - I.to_mat3().rows()[i][j] / scale);
        let mut eigen = SymmetricEigen::try_new(sigma, f64::EPSILON, 1000)?;
        eigen.eigenvalues.iter_mut().for_each(|x| *x = x.max(0.0));
        let sigma = eigen.recompose();
        let I = Matrix3::from_diagonal_element(sigma.trace()) - sigma;
        let entry = |i: usize, j: usize| 0.5 * scale * (I[(i, j)] + I[(j, i)]);
        let (xx, xy, xz) = (entry(0, 0), entry(0, 1), entry(0, 2));
        let I = Sym3 { xx, xy, xz, yy: entry(1, 1), yz: entry(1, 2), zz: entry(2, 2) };
        Some(SpatialInertia::new(self.mass, self.center_of_mass(), I))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::Vec3;
    use crate::testing::inertia;

    #[test]
    fn what_is_physical_stays_and_what_is_not_becomes_so() {
        assert_eq!(inertia(1).nearest_physical(), Some(inertia(1)));
        for I in [[1.0, 1.0, 3.0], [-1.0, 1.0, 1.0], [-1.0, -2.0, 1.0], [1e-9, 1e-9, 1.0]] {
            let R = crate::SO3::exp(Vec3([0.4, 1.0, -2.0])).matrix();
            let I = Sym3::diagonal(I[0], I[1], I[2]).congruence(R);
            let given = SpatialInertia::new(2.0, Vec3([0.1, -0.2, 0.3]), I);
            assert!(!given.verdict().is_physical());
            let nearest = given.nearest_physical().expect("finite");
            assert!(nearest.verdict().is_physical(), "{}", nearest.verdict());
            assert_eq!((nearest.mass, nearest.mc), (given.mass, given.mc));
        }
        assert_eq!(SpatialInertia::point_mass(-1.0, Vec3::zero()).nearest_physical(), None);
    }

    #[test]
    fn a_plate_that_breaks_the_inequality_becomes_thin() {
        // Σ = diag(1.5, 1.5, −0.5) → diag(1.5, 1.5, 0): I = diag(1.5, 1.5, 3)
        let given = SpatialInertia::new(1.0, Vec3::zero(), Sym3::diagonal(1.0, 1.0, 3.0));
        let found = given.nearest_physical().expect("finite").verdict().principal_moments;
        assert!(
            found.iter().zip([1.5, 1.5, 3.0]).all(|(found, expected)| (found - expected).abs() < 1e-14),
            "{found:?}"
        );
    }
}
