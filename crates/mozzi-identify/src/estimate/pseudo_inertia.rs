//! The pseudo-inertia of a body (Wensing, Kim and Slotine 2018): the 4 × 4 second moment of its mass.

use crate::Error;
use nalgebra::{Matrix3, Matrix4, SMatrix, SymmetricEigen};

/// Ten parameters to whitened coordinates and back.
pub type Map = SMatrix<f64, 10, 10>;

/// J = [Σ h; hᵀ m] with Σ = ½ tr(I) 1 − I = ∫ r rᵀ dm and h = m c. A density that is nowhere negative has a positive
/// semidefinite J, and every positive definite J is that of some density.
pub fn pseudo_inertia(p: &[f64]) -> Matrix4<f64> {
    let half = 0.5 * (p[4] + p[7] + p[9]);
    #[rustfmt::skip]
    let J = Matrix4::new(
        half - p[4], -p[5], -p[6], p[1],
        -p[5], half - p[7], -p[8], p[2],
        -p[6], -p[8], half - p[9], p[3],
        p[1], p[2], p[3], p[0],
    );
    J
}

/// The ten parameters (m, m c, I) of a pseudo-inertia.
pub fn parameters(J: &Matrix4<f64>) -> [f64; 10] {
    let trace = J[(0, 0)] + J[(1, 1)] + J[(2, 2)];
    let mean = |i: usize, j: usize| 0.5 * (J[(i, j)] + J[(j, i)]);
    let (xx, yy, zz) = (trace - J[(0, 0)], trace - J[(1, 1)], trace - J[(2, 2)]);
    [J[(3, 3)], mean(0, 3), mean(1, 3), mean(2, 3), xx, -mean(0, 1), -mean(0, 2), yy, -mean(1, 2), zz]
}

/// An orthonormal basis of symmetric 4 × 4 matrices.
pub fn basis() -> [Matrix4<f64>; 10] {
    let mut all = [Matrix4::zeros(); 10];
    let mut k = 0;
    for i in 0..4 {
        for j in 0..=i {
            let entry = if i == j { 1.0 } else { 0.5_f64.sqrt() };
            (all[k][(i, j)], all[k][(j, i)]) = (entry, entry);
            k += 1;
        }
    }
    all
}

/// A body is at least this thick in every direction, m: a thinner prior would be no guide.
const THIN: f64 = 0.005;
/// The thickness that a thinner prior gets, m.
const THICKENED: f64 = 0.01;
/// The mass that a massless prior gets, kg.
const LIGHTEST: f64 = 1e-3;

/// A prior body: J₀ = C Cᵀ.
#[derive(Clone, Debug)]
pub struct Prior {
    /// The Cholesky factor of J₀.
    pub C: Matrix4<f64>,
    /// Whether the robot's own value was massless or too thin, and was changed.
    pub is_repaired: bool,
}

impl Prior {
    /// The pseudo-inertia of ten inertial parameters.
    ///
    /// # Errors
    /// [`Error::BadOption`] if they are not finite.
    pub fn new(p: &[f64], name: &str) -> Result<Self, Error> {
        let wrong = || Error::BadOption {
            option: "a prior inertia",
            found: format!("{p:?} of {name}"),
            expected: "finite numbers".into(),
        };
        if !p.iter().all(|x| x.is_finite()) {
            return Err(wrong());
        }
        let mut J = pseudo_inertia(p);
        let mass = J[(3, 3)].max(LIGHTEST);
        let c = J.fixed_view::<3, 1>(0, 3) / mass;
        let mut about = J.fixed_view::<3, 3>(0, 0) - mass * c * c.transpose();
        let eigen = SymmetricEigen::try_new(about, f64::EPSILON, 1000).ok_or_else(wrong)?;
        let is_repaired = J[(3, 3)] < LIGHTEST || eigen.eigenvalues.min() < mass * THIN * THIN;
        if is_repaired {
            let thick = eigen.eigenvalues.map(|x| x.max(mass * THICKENED * THICKENED));
            about = eigen.eigenvectors * Matrix3::from_diagonal(&thick) * eigen.eigenvectors.transpose();
        }
        let h = mass * c;
        J.fixed_view_mut::<3, 3>(0, 0).copy_from(&(about + mass * c * c.transpose()));
        J.fixed_view_mut::<3, 1>(0, 3).copy_from(&h);
        J.fixed_view_mut::<1, 3>(3, 0).copy_from(&h.transpose());
        J[(3, 3)] = mass;
        let J = 0.5 * (J + J.transpose());
        let C = J.cholesky().ok_or_else(wrong)?.l();
        Ok(Prior { C, is_repaired })
    }

    /// From whitened coordinates y, J = C (Σ y_k B_k) Cᵀ, to the ten parameters.
    pub fn map(&self) -> Map {
        let mut T = Map::zeros();
        for (k, B) in basis().iter().enumerate() {
            for (i, x) in parameters(&(self.C * B * self.C.transpose())).into_iter().enumerate() {
                T[(i, k)] = x;
            }
        }
        T
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi::testing::inertia;

    #[test]
    fn a_sum_of_points_has_the_second_moment_of_its_mass() {
        let points =
            [(0.3, [0.1, -0.2, 0.5]), (1.2, [0.0, 0.4, -0.1]), (0.7, [-0.3, 0.1, 0.2]), (0.2, [0.5, 0.5, 0.0])];
        let mut J = Matrix4::zeros();
        let mut G = mozzi::SpatialInertia::zero();
        for (m, r) in points {
            let r1 = nalgebra::Vector4::new(r[0], r[1], r[2], 1.0);
            J += m * r1 * r1.transpose();
            G += mozzi::SpatialInertia::point_mass(m, mozzi::Vec3(r));
        }
        assert!((pseudo_inertia(&G.to_parameters()) - J).amax() < 1e-14);
        let back = parameters(&J);
        assert!(back.iter().zip(G.to_parameters()).all(|(a, b)| (a - b).abs() < 1e-14));
    }

    #[test]
    fn the_prior_is_the_identity_in_its_own_coordinates() {
        for seed in 0..5 {
            let p = inertia(seed).to_parameters();
            let prior = Prior::new(&p, "link").expect("finite");
            assert!(!prior.is_repaired);
            let y = nalgebra::SVector::<f64, 10>::from_iterator(basis().iter().map(|B| B.trace()));
            let found = prior.map() * y;
            assert!(found.iter().zip(&p).all(|(a, b)| (a - b).abs() < 1e-12 * p[0].max(1.0)));
        }
        let thin = Prior::new(&[1.0, 0.0, 0.0, 0.0, 1e-3, 0.0, 0.0, 1e-3, 0.0, 2e-3], "plate").expect("finite");
        assert!(thin.is_repaired && Prior::new(&[0.0; 10], "none").expect("finite").is_repaired);
        assert!(Prior::new(&[f64::NAN; 10], "none").is_err());
    }
}
