//! Control of a frame by its task-space dynamics (Modern Robotics, sections 11.4.3 and 11.7; Khatib 1987, Hogan 1985).

use super::Gains;
use crate::Error;
use crate::error::{check, check_driven, check_open};
use crate::trajectories::Reference;
use mozzi::kinematics::forward_kinematics;
use mozzi::nalgebra::{DVector, Vector6};
use mozzi::{FrameId, Model, SE3, Task, TaskFrame, Twist};
use mozzi_sim::Input;

/// The control law for the frame's error; gains are diagonal in the frame's own coordinates, angular first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Accelerations K_p X_e + K_d 𝒱_e: the frame follows, whatever its inertia. 1/s², 1/s.
    Acceleration {
        /// K_p.
        p: [f64; 6],
        /// K_d.
        d: [f64; 6],
    },
    /// A wrench K X_e + B 𝒱_e: the frame behaves like a spring and a damper, with the robot's own inertia Λ. N m/rad,
    /// N/m; N m s/rad, N s/m.
    Impedance {
        /// K.
        stiffness: [f64; 6],
        /// B.
        damping: [f64; 6],
    },
}

/// 𝓕 = Λ(θ)a + η(θ, 𝒱) + the [`Law`]'s wrench, τ = Jᵀ𝓕 and, if the robot is redundant, control of its posture. The
/// reference is a joint motion: the frame follows the frame's motion in it, and the null space follows the joints'
/// motion.
///
/// In one formula, whatever the number of joints, with z the acceleration of the posture: τ = Mz + h + f + Jᵀ(Λ(a −
/// J̇θ̇ − Jz) + …), which is Jᵀ(Λa + η + …) if J is square.
pub struct TaskSpace<'m, R> {
    model: &'m Model,
    /// The reference to follow.
    pub reference: R,
    frame: FrameId,
    law: Law,
    posture: Gains,
}

/// The frame's error, in the frame's own coordinates.
struct FrameError {
    /// X_e = log(T⁻¹T_d).
    X: Twist,
    /// 𝒱_e = `[Ad_T⁻¹T_d]`𝒱_d − 𝒱.
    V: Twist,
    /// The acceleration at which 𝒱̇_e = 0.
    a: Twist,
}

impl<'m, R: Reference> TaskSpace<'m, R> {
    /// For a frame of a robot with this model, which need not be exact; the posture's gains are gains on accelerations.
    ///
    /// # Errors
    /// [`mozzi::Error::WrongLength`]; [`mozzi::Error::BadArgument`] for gains that are negative or not finite, a frame
    /// of another model, or a floating base.
    pub fn new(model: &'m Model, reference: R, frame: FrameId, law: Law, posture: Gains) -> Result<Self, Error> {
        model.check_frame(frame)?;
        posture.check(model)?;
        let (Law::Acceleration { p, d } | Law::Impedance { stiffness: p, damping: d }) = law;
        for (what, list) in [("the task's K_p", p), ("the task's K_d", d)] {
            let fine = list.iter().all(|x| *x >= 0.0 && x.is_finite());
            check(fine, what, format!("{list:?}"), "finite numbers that are not negative")?;
        }
        check_driven(model, "a robot under task-space control")?;
        check_open(model, "a robot under task-space control")?;
        Ok(TaskSpace { model, reference, frame, law, posture })
    }

    fn frame_error(
        &self,
        desired: &crate::trajectories::Desired,
        theta: &[f64],
        dtheta: &[f64],
    ) -> Result<FrameError, mozzi::Error> {
        let model = self.model;
        let T_bd = forward_kinematics(model, theta, self.frame).inverse()
            * model.forward_kinematics(&desired.theta, self.frame)?;
        let V = &model.body_jacobian(theta, self.frame)? * dtheta;
        let J = model.body_jacobian(&desired.theta, self.frame)?;
        let dJ = model.body_jacobian_rate(&desired.theta, &desired.dtheta, self.frame)?;
        // in the frame's coordinates: 𝒱_d, and its rate
        let V_d = T_bd.Ad() * (&J * &desired.dtheta[..]);
        let dV_d = T_bd.Ad() * (&J * &desired.ddtheta[..] + &dJ * &desired.dtheta[..]);
        let V_e = V_d - V;
        Ok(FrameError { X: SE3::log(T_bd), V: V_e, a: dV_d + V_e.ad() * V_d })
    }
}

fn six(V: Twist) -> Vector6<f64> {
    V.to_array().into()
}

impl<R: Reference> Input for TaskSpace<'_, R> {
    fn torque(&mut self, t: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), mozzi_sim::Error> {
        let (model, desired) = (self.model, self.reference.at(t));
        let [e, de] = super::errors(model, &desired, theta, dtheta)?;
        let FrameError { X, V, a } = self.frame_error(&desired, theta, dtheta)?;
        let (X, V, mut a) = (six(X), six(V), six(a));
        let mut F = Vector6::zeros();
        let weighted = |p: [f64; 6], d: [f64; 6]| Vector6::from_fn(|r, _| p[r] * X[r] + d[r] * V[r]);
        match self.law {
            Law::Acceleration { p, d } => a += weighted(p, d),
            Law::Impedance { stiffness, damping } => F = weighted(stiffness, damping),
        }
        let environment = model.environment();
        let task = model.task_space_dynamics(theta, dtheta, Task::all(self.frame, TaskFrame::Body), &environment)?;
        let z: Vec<f64> =
            (0..model.n()).map(|j| desired.ddtheta[j] + self.posture.d[j] * de[j] + self.posture.p[j] * e[j]).collect();
        let short =
            DVector::from_column_slice(a.as_slice()) - &task.dJ_dtheta - &task.J * DVector::from_column_slice(&z);
        let F = &task.Lambda * short + DVector::from_column_slice(F.as_slice());
        let sum = model.inverse_dynamics(theta, dtheta, &z, &environment)? + task.J.transpose() * F;
        tau.iter_mut().zip(sum.iter()).for_each(|(tau, x)| *tau += x);
        Ok(())
    }
}
