//! Dynamics in the task space (Modern Robotics, section 8.6; for redundant robots Khatib 1987).

use crate::model::{Environment, Error, Model, Task};
use crate::quantities::{self as q, Memory, Query};
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// 𝓕 = Λ(θ)𝒱̇ + η(θ, 𝒱) for the k rows of a task.
#[derive(Clone, Debug)]
pub struct TaskSpaceDynamics {
    /// Λ = (J M⁻¹Jᵀ)⁻¹, k × k: the task-space mass matrix.
    pub Lambda: DMatrix<f64>,
    /// η = Λ(J M⁻¹h − J̇θ̇), k.
    pub eta: DVector<f64>,
    /// J, k × n.
    pub J: DMatrix<f64>,
    /// J̇θ̇, k: 𝒱̇ = J̇θ̇ + Jθ̈.
    pub dJ_dtheta: DVector<f64>,
}

impl TaskSpaceDynamics {
    /// 𝓕 = Λ𝒱̇ + η: the wrench that produces this acceleration by τ = Jᵀ𝓕.
    pub fn wrench(&self, dV: &DVector<f64>) -> DVector<f64> {
        &self.Lambda * dV + &self.eta
    }
}

impl Model<f64> {
    /// Λ and η of a task. If the task has n independent rows, they are the book's J⁻ᵀMJ⁻¹ and J⁻ᵀh − ΛJ̇J⁻¹𝒱; for
    /// redundant robots they are the dynamically consistent ones. h is [`bias_forces`](Self::bias_forces) in this
    /// environment, without friction and springs. O(n³).
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] for missing, invalid or repeated rows;
    /// [`Error::SingularMassMatrix`]; [`Error::SingularTask`] with the singular values of J if its rows are dependent
    /// (the smallest below 10⁻¹² of the largest).
    pub fn task_space_dynamics(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        task: Task,
        environment: &Environment,
    ) -> Result<TaskSpaceDynamics, Error> {
        let (n, k, memory) = (self.n(), task.rows.len(), &mut Memory::new(self));
        let query = Query::from(q::TaskSpaceDynamics).of_task(task);
        let found = self.compute_in(memory, query, &[theta, dtheta], environment)?;
        let [Lambda, eta] = <[Vec<f64>; 2]>::try_from(found).expect("two outputs");
        let memory = memory.task().expect("of this task");
        let J = DMatrix::from_row_slice(k, n, &memory.J);
        let (Lambda, eta) = (DMatrix::from_vec(k, k, Lambda), DVector::from_vec(eta)); // symmetric
        let dJ_dtheta = DVector::from_column_slice(&memory.dJ_dtheta);
        Ok(TaskSpaceDynamics { Lambda, eta, J, dJ_dtheta })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::TaskFrame;
    use crate::testing::{state, tree};

    /// A chain of this many joints whose tip can move in all six directions.
    fn chain(n: usize) -> Model {
        let serial = |model: &Model| model.links.iter().enumerate().all(|(k, link)| link.parent == k);
        (0..1000).map(|seed| tree(seed, n, 0)).find(serial).expect("one of a thousand trees is a chain")
    }

    #[test]
    fn six_joints_give_the_books_formulas() {
        let model = chain(6);
        let [theta, dtheta, ddtheta] = state(&model, 8);
        let (frame, environment) = (model.end_effector().expect("named"), model.environment());
        for coordinates in [TaskFrame::Body, TaskFrame::Space] {
            let found = model
                .task_space_dynamics(&theta, &dtheta, Task::all(frame, coordinates), &environment)
                .expect("regular");
            let (M, h) = (
                model.mass_matrix(&theta).expect("lengths"),
                model.bias_forces(&theta, &dtheta, &environment).expect("lengths"),
            );
            let inverse = found.J.clone().try_inverse().expect("regular");
            let (Lambda, J) = (inverse.transpose() * M * &inverse, &found.J);
            assert!((&found.Lambda - &Lambda).amax() < 1e-9 * Lambda.amax());
            let eta = inverse.transpose() * h - &Lambda * &found.dJ_dtheta;
            assert!((&found.eta - &eta).amax() < 1e-9 * (eta.amax() + (Lambda * &found.dJ_dtheta).amax()));
            // 𝓕 = Λ𝒱̇ + η with 𝒱̇ = J̇θ̇ + Jθ̈ gives τ = Jᵀ𝓕
            let dV = &found.dJ_dtheta + J * DVector::from_column_slice(&ddtheta);
            let tau = J.transpose() * found.wrench(&dV);
            let mut expected = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment).expect("lengths");
            expected -= model.spring_forces(&theta).expect("lengths");
            for j in 0..6 {
                expected[j] -= crate::dynamics::joint_friction(&model, j, dtheta[j]);
            }
            assert!((&tau - &expected).amax() < 1e-9 * expected.amax());
        }
    }

    #[test]
    fn a_redundant_robot_accelerates_its_task_as_the_consistent_dynamics_say() {
        let model = chain(9);
        let [theta, dtheta, _] = state(&model, 9);
        let (frame, environment) = (model.end_effector().expect("named"), model.environment());
        let task = Task { frame, coordinates: TaskFrame::Body, rows: &[3, 5, 1] };
        let found = model.task_space_dynamics(&theta, &dtheta, task, &environment).expect("regular");
        // τ = Jᵀ(Λa + η) (+ friction and springs, which h leaves out) moves the task's rows with 𝒱̇ = a
        let a = DVector::from_vec(vec![0.3, -1.0, 2.0]);
        let mut tau = found.J.transpose() * found.wrench(&a) + model.spring_forces(&theta).expect("lengths");
        for j in 0..model.n() {
            tau[j] += crate::dynamics::joint_friction(&model, j, dtheta[j]);
        }
        let ddtheta = model.forward_dynamics(&theta, &dtheta, tau.as_slice(), &environment).expect("regular");
        let moved = &found.J * ddtheta + &found.dJ_dtheta;
        assert!((&moved - &a).amax() < 1e-9 * (1.0 + found.dJ_dtheta.amax()), "{moved} {a}");
    }

    #[test]
    fn next_to_a_singularity_the_books_formula_still_holds() {
        let model = chain(6);
        let (frame, environment) = (model.end_effector().expect("named"), model.environment());
        let [mut theta, dtheta, _] = state(&model, 8);
        // from a random state to where det J changes its sign
        let task = Task::all(frame, TaskFrame::Body);
        let found = |theta: &[f64]| model.task_space_dynamics(theta, &dtheta, task, &environment);
        let det = |angle: f64, theta: &mut Vec<f64>| {
            theta[4] = angle;
            found(theta).map_or(0.0, |found| found.J.determinant())
        };
        let (mut low, mut high) = (theta[4], theta[4]);
        while det(low, &mut theta) * det(high, &mut theta) > 0.0 {
            high += 0.01;
        }
        while high - low > 1e-9 {
            let middle = (low + high) / 2.0;
            if det(low, &mut theta) * det(middle, &mut theta) > 0.0 { low = middle } else { high = middle }
        }
        for away in [1e-4, 1e-6, 3e-8] {
            theta[4] = low - away;
            let found = found(&theta).expect("regular");
            let inverse = found.J.clone().try_inverse().expect("regular");
            let M = model.mass_matrix(&theta).expect("lengths");
            let Lambda = inverse.transpose() * M * &inverse;
            let error = (&found.Lambda - &Lambda).amax() / Lambda.amax();
            assert!(error < 1e-13 / away, "{away}: {error:e}");
            assert!(found.Lambda.clone().cholesky().is_some() || away < 1e-7, "{away}: not positive definite");
        }
    }

    #[test]
    fn a_singular_task_answers_with_its_singular_values() {
        let model = chain(4);
        let [theta, dtheta, _] = state(&model, 3);
        let (frame, environment) = (model.end_effector().expect("named"), model.environment());
        let error = model.task_space_dynamics(&theta, &dtheta, Task::all(frame, TaskFrame::Body), &environment);
        let Err(Error::SingularTask { singular_values, .. }) = error else { panic!("six directions by four joints") };
        assert_eq!((singular_values.len(), singular_values[4]), (6, 0.0));
        let bad = Task { frame, coordinates: TaskFrame::Body, rows: &[3, 3] };
        let message =
            model.task_space_dynamics(&theta, &dtheta, bad, &environment).expect_err("twice the same").to_string();
        assert!(message.starts_with("the task's rows is [3, 3], expected distinct row numbers"), "{message}");
    }
}
