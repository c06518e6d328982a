//! Derivatives of constrained forward dynamics.

use super::Rows;
use crate::ConstraintMemory;
use crate::constraints::{constraint_jacobian, delassus};
use crate::kinematics::joint_transforms;
use crate::linalg::ldlt;
use crate::model::seed_direction;
use crate::model::{Environment, Error, Model};
use crate::scalar::Dual;
use crate::workspace::Workspace;
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// The derivatives of θ̈ and λ of [`constrained_forward_dynamics`](crate::constraints::constrained_forward_dynamics): n
/// × n and m × n.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstrainedForwardDynamicsDerivatives {
    /// ∂θ̈/∂θ; a floating base and balls along their velocities.
    pub d_theta: DMatrix<f64>,
    /// ∂θ̈/∂θ̇.
    pub d_dtheta: DMatrix<f64>,
    /// ∂θ̈/∂τ = PᵀM⁻¹.
    pub d_tau: DMatrix<f64>,
    /// ∂λ/∂θ.
    pub lambda_d_theta: DMatrix<f64>,
    /// ∂λ/∂θ̇.
    pub lambda_d_dtheta: DMatrix<f64>,
    /// ∂λ/∂τ.
    pub lambda_d_tau: DMatrix<f64>,
}

impl Model<f64> {
    /// The derivatives of θ̈ and λ of constrained forward dynamics, by the implicit function theorem:
    ///
    /// > M dθ̈ + Aᵀdλ = dτ − ∂(ID + Aᵀλ),  A dθ̈ = −∂(Aθ̈ + Ȧθ̇)
    ///
    /// with ID inverse dynamics at θ̈, whose derivatives are analytic, and those of A by dual numbers.
    ///
    /// Cost O(n²(n + m)).
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::SingularMassMatrix`] naming the joint.
    pub fn constrained_forward_dynamics_derivatives(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        tau: &[f64],
        environment: &Environment,
    ) -> Result<ConstrainedForwardDynamicsDerivatives, Error> {
        let at = self.constrained_forward_dynamics(theta, dtheta, tau, environment)?;
        let (m, n) = (self.constraint_rows(), self.n());
        let of_tau = self.inverse_dynamics_derivatives(theta, dtheta, at.ddtheta.as_slice(), environment)?;
        // ∂(ID + Aᵀλ) and ∂(Aθ̈ + Ȧθ̇), by θ and by θ̇
        let (mut forces, mut accelerations) =
            ([of_tau.d_theta, of_tau.d_dtheta], [DMatrix::zeros(m, n), DMatrix::zeros(m, n)]);
        let mut workspace = Workspace::new(self);
        let (still, zero) = (self.map(Dual::constant), |k: usize| Dual::constants(&vec![0.0; k]));
        let (mut A, mut bias) = (zero(m * n), zero(m));
        for j in 0..n {
            let mut e = vec![0.0; n];
            e[j] = 1.0;
            let moving = [seed_direction(self, theta, &e), Dual::constants(theta)];
            let rates = [Dual::constants(dtheta), Dual::list(dtheta, &e)];
            for k in 0..2 {
                constraint_jacobian(&still, &moving[k], &rates[k], &mut workspace, &mut A, &mut bias, &mut []);
                for r in 0..m {
                    let mut sum = bias[r].derivative;
                    for i in 0..n {
                        let dA = A[r * n + i].derivative;
                        sum += dA * at.ddtheta[i];
                        forces[k][(i, j)] += dA * at.lambda[r];
                    }
                    accelerations[k][(r, j)] = sum;
                }
            }
        }
        let Rows { A, .. } = self.constraint_rows_at(theta, dtheta);
        let mut solver = Solver::new(self, theta, &A);
        let [by_theta, by_dtheta] = [0, 1].map(|k| solver.solve(&-&forces[k], &-&accelerations[k]));
        let by_tau = solver.solve(&DMatrix::identity(n, n), &DMatrix::zeros(m, n));
        Ok(ConstrainedForwardDynamicsDerivatives {
            d_theta: by_theta.0,
            d_dtheta: by_dtheta.0,
            d_tau: by_tau.0,
            lambda_d_theta: by_theta.1,
            lambda_d_dtheta: by_dtheta.1,
            lambda_d_tau: by_tau.1,
        })
    }
}

/// M x + Aᵀy = f, A x = a.
struct Solver<'m> {
    model: &'m Model,
    memory: ConstraintMemory,
}

impl<'m> Solver<'m> {
    fn new(model: &'m Model, theta: &[f64], A: &DMatrix<f64>) -> Self {
        let mut memory = ConstraintMemory::new(model);
        memory.A.copy_from_slice(A.transpose().as_slice());
        let mut workspace = Workspace::new(model);
        joint_transforms(model, theta, &mut workspace);
        delassus::factor(model, &mut workspace, &mut memory);
        Solver { model, memory }
    }

    /// Solves for each column.
    fn solve(&mut self, f: &DMatrix<f64>, a: &DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
        let (mut x, mut y) = (Vec::new(), Vec::new());
        for (f, a) in f.column_iter().zip(a.column_iter()) {
            let mut column: Vec<f64> = f.iter().copied().collect();
            ldlt::solve(&self.model.structure.pattern, &self.memory.M, &mut column);
            for (right, a) in self.memory.right.iter_mut().zip(a.iter()) {
                *right = -a;
            }
            delassus::add_products(self.model, &self.memory.A, &column, &mut self.memory.right);
            let mut change = vec![0.0; column.len()];
            crate::constraints::change(self.model, &mut self.memory, &mut change);
            x.push(DVector::from_vec(column) + DVector::from_vec(change));
            y.push(DVector::from_column_slice(&self.memory.lambda));
        }
        let matrix = |columns: &[DVector<f64>], rows: usize| match columns {
            [] => DMatrix::zeros(rows, 0),
            columns => DMatrix::from_columns(columns),
        };
        (matrix(&x, f.nrows()), matrix(&y, a.nrows()))
    }
}
