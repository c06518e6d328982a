//! A mechanism in its own coordinates: M, h and g of independent joints.

use super::rows::{Rows, SINGULAR, columns, least_squares};
use crate::model::{Environment, Error, Model};
use alloc::format;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// The dynamics of a mechanism in d independent velocities u:
///
/// > θ̇ = N u,  θ̈ = N u̇ + n₀,  Nᵀτ = (NᵀMN) u̇ + Nᵀ(h + M n₀)
#[derive(Clone, Debug, PartialEq)]
pub struct Reduction {
    /// The indices of u among the velocities.
    pub independent: Vec<usize>,
    /// N(θ), n × d.
    pub N: DMatrix<f64>,
    /// n₀(θ, θ̇), n: the accelerations at u̇ = 0.
    pub bias: DVector<f64>,
    /// NᵀMN, d × d, symmetric and positive definite.
    pub M: DMatrix<f64>,
    /// Nᵀ(h + M n₀), d, in this environment, without friction and springs.
    pub h: DVector<f64>,
    /// Nᵀg, d.
    pub g: DVector<f64>,
}

impl Model<f64> {
    /// The dynamics in the velocities of these joints, from which the constraints determine all others.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NoSuchJoint`]; [`Error::BadArgument`] if a joint is not determined by them, if
    /// they depend on each other, or if the constraints are not finite.
    pub fn reduce(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        independent: &[&str],
        environment: &Environment,
    ) -> Result<Reduction, Error> {
        self.check_lengths(theta, [("dtheta", dtheta)])?;
        let independent = self.velocities_of(independent)?;
        let n = self.n();
        let dependent: Vec<usize> = (0..n).filter(|j| !independent.contains(j)).collect();
        let rows = self.constraint_rows_at(theta, dtheta);
        self.check_rows(&rows)?;
        let Rows { A, bias, .. } = rows;
        let (A_d, A_i) = (columns(&A, &dependent), columns(&A, &independent));
        self.check_determined(&A_d, &dependent)?;
        let mut N = DMatrix::zeros(n, independent.len());
        for (c, &j) in independent.iter().enumerate() {
            let right = -A_i.column(c).clone_owned();
            let x = least_squares(&A_d, &right);
            let left = (&A_d * &x - &right).amax();
            if left > 1e-8 * (1.0 + right.amax()) {
                let (what, found) = ("the set of independent joints", format!("one with `{}`", self.velocity_name(j)));
                let expected = "joints that can move independently of each other";
                return Err(Error::BadArgument { what, found, expected });
            }
            N[(j, c)] = 1.0;
            dependent.iter().zip(x.iter()).for_each(|(&k, x)| N[(k, c)] = *x);
        }
        let mut accelerations = DVector::zeros(n);
        let x = least_squares(&A_d, &-bias);
        dependent.iter().zip(x.iter()).for_each(|(&k, x)| accelerations[k] = *x);
        let M = self.mass_matrix(theta)?;
        let h = self.bias_forces(theta, dtheta, environment)?;
        let g = self.vector(crate::quantities::GravityForces, &[theta], environment)?;
        Ok(Reduction {
            M: N.transpose() * &M * &N,
            h: N.transpose() * (h + M * &accelerations),
            g: N.transpose() * g,
            N,
            bias: accelerations,
            independent,
        })
    }

    /// Checks that the constraints determine these velocities from the others.
    fn check_determined(&self, A_d: &DMatrix<f64>, dependent: &[usize]) -> Result<(), Error> {
        if dependent.is_empty() {
            return Ok(());
        }
        let undetermined = if A_d.nrows() == 0 {
            Some(dependent[0])
        } else {
            let padded = A_d.clone().resize_vertically(A_d.nrows().max(dependent.len()), 0.0);
            let svd = padded.svd(false, true);
            let least = svd.singular_values.imin();
            let is_free = svd.singular_values[least] <= SINGULAR * svd.singular_values.max();
            svd.v_t.filter(|_| is_free).map(|V_t| dependent[V_t.row(least).transpose().iamax()])
        };
        match undetermined {
            None => Ok(()),
            Some(j) => Err(Error::BadArgument {
                what: "the set of independent joints",
                found: format!("one from which `{}` is not determined", self.velocity_name(j)),
                expected: "one joint for each degree of freedom",
            }),
        }
    }
}
