//! Forward dynamics as methods: three ways, each looking at its pivots.

use crate::dynamics as kernel;
use crate::model::{Environment, Error, Model, Workspace};
use alloc::string::ToString;
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

impl Model<f64> {
    /// θ̈ from τ: by articulated bodies, or by the mass matrix where joints follow others. See
    /// [`forward_dynamics`](kernel::forward_dynamics()).
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::SingularMassMatrix`] naming the joint.
    pub fn forward_dynamics(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        tau: &[f64],
        environment: &Environment,
    ) -> Result<DVector<f64>, Error> {
        self.check_lengths(theta, [("dtheta", dtheta), ("tau", tau)])?;
        self.check_environment(environment)?;
        let (mut workspace, mut ddtheta) = (Workspace::new(self), vec![0.0; self.n()]);
        kernel::forward_dynamics(self, theta, dtheta, tau, environment, &mut workspace, &mut ddtheta);
        self.check_pivots(theta, &mut workspace)?;
        Ok(DVector::from_vec(ddtheta))
    }

    /// θ̈ from τ by composite rigid bodies and the factors of M along the tree: see
    /// [`forward_dynamics_by_mass_matrix`](kernel::forward_dynamics_by_mass_matrix).
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::SingularMassMatrix`] naming the joint.
    pub fn forward_dynamics_by_mass_matrix(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        tau: &[f64],
        environment: &Environment,
    ) -> Result<DVector<f64>, Error> {
        self.check_lengths(theta, [("dtheta", dtheta), ("tau", tau)])?;
        self.check_environment(environment)?;
        let (n, mut workspace) = (self.n(), Workspace::new(self));
        let (mut M, mut ddtheta) = (vec![0.0; n * n], vec![0.0; n]);
        kernel::forward_dynamics_by_mass_matrix(
            self,
            theta,
            dtheta,
            tau,
            environment,
            &mut workspace,
            &mut M,
            &mut ddtheta,
        );
        self.check_pivots(theta, &mut workspace)?;
        Ok(DVector::from_vec(ddtheta))
    }

    /// θ̈ from τ as the book has it (Modern Robotics, section 8.5): h by one call of inverse dynamics, M by n calls with
    /// θ̈ = e_i, and a general solver (Cholesky). O(n³): to read and to compare.
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::SingularMassMatrix`] naming the joint.
    pub fn forward_dynamics_by_inverse_dynamics(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        tau: &[f64],
        environment: &Environment,
    ) -> Result<DVector<f64>, Error> {
        self.check_lengths(theta, [("dtheta", dtheta), ("tau", tau)])?;
        self.check_environment(environment)?;
        let (n, rest) = (self.n(), Environment::with_gravity(crate::Vec3::zero()));
        let zero = vec![0.0; n];
        let h_and_friction = self.inverse_dynamics(theta, dtheta, &zero, environment)?;
        let columns: Result<Vec<_>, _> = (0..n)
            .map(|i| {
                let mut e = zero.clone();
                e[i] = 1.0;
                self.inverse_dynamics(theta, &zero, &e, &rest)
            })
            .collect();
        let columns = columns?;
        let M = DMatrix::from_fn(n, n, |i, j| columns[j][i]);
        let diagonal = M.diagonal();
        match M.cholesky() {
            Some(factors) => Ok(factors.solve(&(DVector::from_column_slice(tau) - h_and_friction))),
            None => {
                let weakest = (1..n).fold(0, |m, j| if diagonal[j] < diagonal[m] { j } else { m });
                Err(self.singular(weakest, 0.0, diagonal[weakest], theta))
            }
        }
    }

    /// Is what a solve divided by more than rounding? A pivot is a joint's inertia with the joints beyond it free; the
    /// matrix is singular where it is rounding of the joint's inertia with all of them locked, M_jj.
    pub(crate) fn check_pivots(&self, theta: &[f64], workspace: &mut Workspace) -> Result<(), Error> {
        let n = self.n();
        if workspace.is_regular() || theta.iter().any(|x| !x.is_finite()) {
            return Ok(());
        }
        let pivots = workspace.pivots.clone();
        let mut M = vec![0.0; n * n];
        kernel::mass_matrix(self, theta, workspace, &mut M);
        // the outermost first: what it divided by spoils those below
        for (j, &pivot) in pivots.iter().enumerate().rev() {
            let diagonal = M[j * n + j];
            if !(pivot > 64.0 * f64::EPSILON * diagonal && pivot.is_finite()) {
                return Err(self.singular(j, pivot, diagonal, theta));
            }
        }
        Ok(())
    }

    fn singular(&self, j: usize, pivot: f64, diagonal: f64, theta: &[f64]) -> Error {
        let joint = self.velocity_names().nth(j).unwrap_or_default().to_string();
        Error::SingularMassMatrix { joint, pivot, diagonal, theta: theta.to_vec() }
    }
}
