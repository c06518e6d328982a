//! The motors' torques of a motion of a robot with constraints.

use super::ConstrainedDynamics;
use super::rows::{Rows, SINGULAR, least_squares};
use crate::model::{Environment, Error, Model};
use crate::scalar::Scalar;
use alloc::format;
use alloc::string::ToString;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

impl Model<f64> {
    /// The velocities that have motors: those of the description's [`motors`], by default all joints; a floating base
    /// has none.
    ///
    /// [`motors`]: crate::Description::motors
    pub fn motors(&self) -> Vec<usize> {
        let named = |name: &str| {
            self.description().motors.as_ref().is_none_or(|motors| motors.iter().any(|motor| motor == name))
        };
        self.joints()
            .zip(self.places())
            .filter(|(joint, _)| named(&joint.name))
            .flat_map(|(_, place)| place.velocities())
            .collect()
    }

    /// τ of the motors, and λ, of a motion that satisfies the constraints:
    ///
    /// > τ = Mθ̈ + h + f + Aᵀλ, with τ_j = 0 for velocities without a [motor](Self::motors)
    ///
    /// If there are more motors than degrees of freedom, τ is the one with the least Σ w_j τ_j²; weights w > 0, one for
    /// each velocity, are 1 by default. λ is the one of least norm. Motor torques that only stress the mechanism
    /// internally are then zero.
    ///
    /// By singular values, O(n³).
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] for weights that are not positive;
    /// [`Error::Unreachable`] if θ̈ violates a constraint (see [`assemble_accelerations`]);
    /// [`Error::Underactuated`] with the joint for which a motor is missing.
    ///
    /// [`assemble_accelerations`]: Self::assemble_accelerations
    pub fn constrained_inverse_dynamics(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        ddtheta: &[f64],
        environment: &Environment,
        weights: Option<&[f64]>,
    ) -> Result<ConstrainedDynamics, Error> {
        let needed = self.inverse_dynamics(theta, dtheta, ddtheta, environment)?;
        let n = self.n();
        if let Some(weights) = weights {
            if weights.len() != n {
                return Err(Error::WrongLength { what: "weights", found: weights.len(), expected: n });
            }
            if let Some((j, weight)) = weights.iter().enumerate().find(|(_, w)| !(**w > 0.0 && w.is_finite())) {
                let found = format!("{weight} for `{}`", self.velocity_name(j));
                return Err(Error::BadArgument { what: "a weight", found, expected: "a positive, finite number" });
            }
        }
        let Rows { A, bias, .. } = self.constraint_rows_at(theta, dtheta);
        let acceleration = DVector::from_column_slice(ddtheta);
        let (violation, size) = (&A * &acceleration + &bias, 1.0 + acceleration.amax() * A.amax() + bias.amax());
        if let Some((row, x)) = violation.iter().enumerate().find(|(_, x)| !(x.abs() < 1e-6 * size)) {
            let (constraint, residual) = (self.constraint_of_row(row), x.abs());
            return Err(Error::Unreachable { constraint, residual, what: "not with this acceleration" });
        }

        // Nᵀτ = Nᵀ(Mθ̈ + h + f), N the motions that the constraints allow
        let N = null_space(&A, n);
        let motors = self.motors();
        let scale = |j: usize| weights.map_or(1.0, |weights| 1.0 / Scalar::sqrt(weights[j]));
        let B = DMatrix::from_fn(N.ncols(), motors.len(), |r, c| N[(motors[c], r)] * scale(motors[c]));
        let right = N.transpose() * &needed;
        let scaled = least_squares(&B, &right);
        let missing = &right - &B * &scaled;
        let forces = needed.amax().max(f64::MIN_POSITIVE);
        if missing.amax() > 1e-8 * forces {
            let force = &N * &missing; // of the motion that no motor drives
            let j = force.iamax();
            let joint = self.velocity_names().nth(j).unwrap_or_default().to_string();
            return Err(Error::Underactuated {
                joint,
                force: force[j].abs(),
                motors: motors.len(),
                freedom: N.ncols(),
            });
        }
        let mut tau = DVector::zeros(n);
        motors.iter().zip(scaled.iter()).for_each(|(&j, x)| tau[j] = x * scale(j));
        let lambda = least_squares(&A.transpose(), &(&tau - &needed));
        let wrenches = self.constraint_wrenches(theta, lambda.as_slice())?;
        Ok(ConstrainedDynamics { ddtheta: acceleration, tau, lambda, wrenches })
    }
}

/// An orthonormal basis of the x with Ax = 0, by columns.
fn null_space(A: &DMatrix<f64>, n: usize) -> DMatrix<f64> {
    if A.nrows() == 0 || n == 0 {
        return DMatrix::identity(n, n);
    }
    // a square matrix has all right singular vectors
    let padded = A.clone().resize_vertically(A.nrows().max(n), 0.0);
    let svd = padded.svd(false, true);
    let (values, Some(V_t)) = (svd.singular_values, svd.v_t) else { return DMatrix::zeros(n, 0) };
    let tolerance = SINGULAR * values.max();
    let null: Vec<usize> = (0..n).filter(|&k| values[k] <= tolerance).collect();
    V_t.select_rows(&null).transpose()
}
