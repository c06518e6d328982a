//! A computed-torque controller for a Panda: no `std`, no allocation, no panic, no dependency.
#![no_std]

/// The arm's equations, as `build.rs` wrote them.
#[allow(missing_docs)]
pub mod panda {
    include!(concat!(env!("OUT_DIR"), "/panda.rs"));
}

/// One number for each joint.
pub type Joints = [f64; 7];

/// Desired position, velocity and acceleration: rad, rad/s, rad/s².
pub struct Reference {
    pub theta: Joints,
    pub dtheta: Joints,
    pub ddtheta: Joints,
}

/// τ = ID(θ, θ̇, θ̈_d + K_d ė + K_p e), e = θ_d − θ: if the equations match the arm, ë + K_d ė + K_p e = 0.
pub struct ComputedTorque {
    /// s⁻².
    pub k_p: f64,
    /// s⁻¹; 2 √k_p is critical damping.
    pub k_d: f64,
    /// The motors' effort limits, in N m.
    pub limits: Joints,
}

impl ComputedTorque {
    /// The motors' torques, within their limits; none if a measurement is NaN or infinite, or an angle is beyond 10⁶
    /// rad: stop the arm then.
    pub fn torque(&self, reference: &Reference, theta: &Joints, dtheta: &Joints) -> Option<Joints> {
        let mut ddtheta = reference.ddtheta;
        for j in 0..7 {
            ddtheta[j] += self.k_d * (reference.dtheta[j] - dtheta[j]) + self.k_p * (reference.theta[j] - theta[j]);
        }
        let mut tau = [0.0; 7];
        panda::inverse_dynamics(theta, dtheta, &ddtheta, &mut tau);
        for (tau, limit) in tau.iter_mut().zip(&self.limits) {
            if !tau.is_finite() {
                return None;
            }
            *tau = tau.clamp(-limit, *limit);
        }
        Some(tau)
    }
}
