//! Constrained forward dynamics with the wrenches of the constraints.

use super::rows::least_squares;
use super::wrench_of;
use crate::SE3;
use crate::model::{End, Environment, Error, Model, TieKind};
use crate::quantities as q;
use crate::scalar::Scalar;
use crate::spatial::Wrench;
use alloc::string::String;
use alloc::vec::Vec;
use nalgebra::DVector;

/// Forces and accelerations of a robot with constraints.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstrainedDynamics {
    /// θ̈, n.
    pub ddtheta: DVector<f64>,
    /// τ, n.
    pub tau: DVector<f64>,
    /// λ, m: the forces and moments that the robot applies through its constraints, row by row.
    pub lambda: DVector<f64>,
    /// For each constraint between two anchors its name and the wrench that {b} applies to {a}, in the axes of {a} and
    /// about the origin of {b}; N m, N.
    pub wrenches: Vec<(String, Wrench)>,
}

impl Model<f64> {
    /// θ̈ and λ from τ, with the wrench of each constraint: see
    /// [`constrained_forward_dynamics`](crate::constraints::constrained_forward_dynamics).
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::SingularMassMatrix`] naming the joint.
    pub fn constrained_forward_dynamics(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        tau: &[f64],
        environment: &Environment,
    ) -> Result<ConstrainedDynamics, Error> {
        let found = self.compute(q::ConstrainedForwardDynamics, &[theta, dtheta, tau], environment)?;
        let [ddtheta, lambda] = <[Vec<f64>; 2]>::try_from(found).expect("two outputs");
        let wrenches = self.constraint_wrenches(theta, &lambda)?;
        let tau = DVector::from_column_slice(tau);
        Ok(ConstrainedDynamics { ddtheta: ddtheta.into(), tau, lambda: lambda.into(), wrenches })
    }

    /// The wrenches of λ: see [`ConstrainedDynamics::wrenches`].
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn constraint_wrenches(&self, theta: &[f64], lambda: &[f64]) -> Result<Vec<(String, Wrench)>, Error> {
        self.check_configuration(theta)?;
        let expected = self.constraint_rows();
        if lambda.len() != expected {
            return Err(Error::WrongLength { what: "lambda", found: lambda.len(), expected });
        }
        let ties = self.ties.list.iter().zip(self.constraints());
        let of_anchors = ties.filter_map(|(tie, described)| match &tie.kind {
            TieKind::Frames { closure, .. } => Some((tie, closure, &described.name)),
            TieKind::Joint { .. } => None,
        });
        let found = of_anchors.zip(self.constraint_anchors(theta)?).map(|((tie, closure, name), [a, b])| {
            let rows = &lambda[tie.first..][..tie.kind.rows()];
            (name.clone(), wrench_of(*closure, a.inverse() * b, rows))
        });
        Ok(found.collect())
    }

    /// λ of a known motion and known torques, m numbers: Aᵀλ = τ − M θ̈ − h − f − JᵀF in this environment, of least
    /// norm.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn constraint_forces(
        &self,
        [theta, dtheta, ddtheta]: [&[f64]; 3],
        tau: &[f64],
        environment: &Environment,
    ) -> Result<DVector<f64>, Error> {
        self.check_velocities([("tau", tau)])?;
        let needed = self.inverse_dynamics(theta, dtheta, ddtheta, environment)?;
        let A = self.constraint_rows_at(theta, dtheta).A;
        Ok(least_squares(&A.transpose(), &(DVector::from_column_slice(tau) - needed)))
    }

    /// The configurations in {s} of the anchors {a} and {b} of every constraint that has anchors, in their order.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn constraint_anchors(&self, theta: &[f64]) -> Result<Vec<[SE3; 2]>, Error> {
        self.check_configuration(theta)?;
        Ok(self.anchors(theta))
    }
}

impl<S: Scalar> Model<S> {
    pub(super) fn anchors(&self, theta: &[S]) -> Vec<[SE3<S>; 2]> {
        let poses = self.link_poses(theta);
        let of = |end: &End<S>| end.slot.map_or(SE3::identity(), |slot| poses[slot]) * end.T;
        let anchors = self.ties.list.iter().filter_map(|tie| match &tie.kind {
            TieKind::Frames { a, b, .. } => Some([of(a), of(b)]),
            TieKind::Joint { .. } => None,
        });
        anchors.collect()
    }

    /// The configurations of the normal frames of all slots in {s}.
    fn link_poses(&self, theta: &[S]) -> Vec<SE3<S>> {
        let mut poses = alloc::vec![crate::kinematics::base_pose(self, theta)];
        for (_, link) in self.outward::<S>() {
            let T = poses[link.parent] * link.transform(theta).inverse();
            poses.push(T);
        }
        poses
    }
}
