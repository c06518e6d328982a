//! A weight hanging from the Panda's hand: as a wrench at the tip, and as a payload.
//!
//! F_tip is what the hand applies *to* the environment (Modern Robotics, section 8.3). A weight of mass m that hangs
//! still is held up by the hand, so the force on it is −mg, opposed to gravity; in the coordinates of the hand's
//! frame {b}, at the point p of the hand from which it hangs,
//!
//! > f_b = −m R_sbᵀg,  m_b = p × f_b,  τ = g(θ) + J_bᵀ(m_b, f_b)
//!
//! A weight that is fixed to the hand at p is a payload: it increases the mass matrix and g(θ). At rest, both need the
//! same torques; in motion, the payload has inertia, which a constant wrench does not model.

use mozzi::{Environment, SpatialInertia, Vec3, Wrench};
use mozzi_examples::{agree, difference, row};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    // the fingers locked in the open position: 7 joints are left
    let model = mozzi_urdf::open("panda")?.build()?.with_locked_joints(&[("panda_finger_joint1", 0.03)])?;
    let hand = model.frame("panda_hand")?;
    let (mass, p) = (2.0, Vec3([0.02, 0.0, 0.11]));
    let theta = [0.3, -0.5, 0.2, -2.0, 0.4, 1.8, 0.7];
    let zero = [0.0; 7];

    // as a wrench
    let R_sb = model.forward_kinematics(&theta, hand)?.R;
    let f = R_sb.inverse_mul(model.gravity()) * -mass;
    let held_up = Wrench { m: p.cross(f), f };
    let applied = [(hand, held_up)];
    let hanging = Environment { applied: &applied, ..model.environment() };
    let tau_wrench = model.inverse_dynamics(&theta, &zero, &zero, &hanging)?;

    // as a payload
    let loaded = model.with_payload(hand, SpatialInertia::point_mass(mass, p))?;
    let tau_payload = loaded.inverse_dynamics(&theta, &zero, &zero, &loaded.environment())?;

    println!("Panda, {mass} kg at {:?} m in the frame of its hand; torques in N m that hold it still:", p.0);
    println!("  empty hand     [{}]", row(&model.gravity_forces(&theta)?));
    println!("  with a wrench  [{}]", row(&tau_wrench));
    println!("  with a payload [{}]", row(&tau_payload));
    println!("F_tip = ({}) in the hand's frame", row(&held_up.to_array()));
    agree("wrench and payload, at rest", &tau_wrench, &tau_payload, 1e-14);
    let J = model.body_jacobian(&theta, hand)?;
    let sum = model.gravity_forces(&theta)? + J.transpose_mul(held_up);
    agree("g + J_bᵀF", sum.as_slice(), &tau_wrench, 1e-14);

    // in motion: the difference accelerates the point mass, m p̈ at p
    let (dtheta, ddtheta) = ([0.4, -0.3, 0.6, 0.5, -0.8, 0.3, 0.9], [1.0, 0.5, -1.0, 2.0, 1.5, -0.5, 1.0]);
    let tau_wrench = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &hanging)?;
    let tau_payload = loaded.inverse_dynamics(&theta, &dtheta, &ddtheta, &loaded.environment())?;
    println!("\nmoved, a hanging wrench and a payload differ by up to {:.2} N m", {
        difference(tau_wrench.as_slice(), tau_payload.as_slice())
    });
    let V = &J * &dtheta[..];
    let dV = &model.body_jacobian_rate(&theta, &dtheta, hand)? * &dtheta[..] + &J * &ddtheta[..];
    let velocity = V.v + V.w.cross(p); // of the point, in {b}
    let acceleration = dV.v + dV.w.cross(p) + V.w.cross(velocity);
    let inertial = Wrench { m: p.cross(acceleration * mass), f: acceleration * mass };
    let both = &tau_wrench + J.transpose_mul(inertial);
    agree("wrench + J_bᵀ(p × mp̈, mp̈) and payload", both.as_slice(), &tau_payload, 1e-14);
    Ok(())
}
