//! The motors of a simulated robot.

use mozzi::nalgebra::DVector;
use mozzi::{Error, Model};
use mozzi_motion::controllers::{ComputedTorque, Gains, PdGravity};
use mozzi_motion::trajectories::{Desired, Reference};
use mozzi_sim::{GravityCompensation, Input, Zero};

/// How the motors act.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// τ = 0.
    Off,
    /// τ = g(θ).
    Gravity,
    /// τ = g(θ) + K_p e + K_d ė.
    Pd,
    /// τ = M(θ)(K_p e + K_d ė) + h(θ, θ̇).
    ComputedTorque,
}

impl Kind {
    pub fn named(name: &str) -> Result<Self, String> {
        match name {
            "off" => Ok(Kind::Off),
            "gravity" => Ok(Kind::Gravity),
            "pd" => Ok(Kind::Pd),
            "computed-torque" => Ok(Kind::ComputedTorque),
            other => Err(format!("`{other}` are no motors, expected off, gravity, pd or computed-torque")),
        }
    }
}

/// A goal at rest.
struct Goal<'a> {
    theta: &'a [f64],
    n: usize,
}

impl Reference for Goal<'_> {
    fn duration(&self) -> f64 {
        0.0
    }

    fn at(&self, _: f64) -> Desired {
        Desired { theta: self.theta.to_vec(), dtheta: vec![0.0; self.n], ddtheta: vec![0.0; self.n] }
    }
}

/// Motors that hold or reach a configuration.
pub fn motors<'m>(
    model: &'m Model,
    kind: Kind,
    gains: &Gains,
    target: &'m [f64],
) -> Result<Box<dyn Input + 'm>, String> {
    let goal = Goal { theta: target, n: model.n() };
    let said = |error: mozzi_motion::Error| error.to_string();
    Ok(match kind {
        Kind::Off => Box::new(Zero),
        Kind::Gravity => Box::new(GravityCompensation::new(model)),
        Kind::Pd => Box::new(PdGravity::new(model, goal, gains.clone()).map_err(said)?),
        Kind::ComputedTorque => Box::new(ComputedTorque::new(model, goal, gains.clone()).map_err(said)?),
    })
}

/// K_p = ω² I and K_d = 2ζω I. Under computed torque I = 1. Under PD control I is the inertia that the joint's motor
/// turns or shifts: M_jj, or, of a floating base, that of the whole robot about the joint's axis, if it is larger: a
/// foot on the ground moves the robot.
pub fn gains(model: &Model, kind: Kind, theta: &[f64], omega: f64, zeta: f64) -> Result<Gains, Error> {
    let inertia = match kind {
        Kind::ComputedTorque => vec![1.0; model.n()],
        _ => driven_inertia(model, theta)?,
    };
    let of = |factor: f64| inertia.iter().map(|I| factor * I).collect();
    Ok(Gains { p: of(omega * omega), d: of(2.0 * zeta * omega) })
}

fn driven_inertia(model: &Model, theta: &[f64]) -> Result<Vec<f64>, Error> {
    let M = model.mass_matrix(theta)?;
    let mut inertia: Vec<f64> = M.diagonal().iter().copied().collect();
    if !model.is_floating() {
        return Ok(inertia);
    }
    // the base's columns of M are the inertia of the whole robot, in the base's coordinates
    let whole = M.view((0, 0), (6, 6));
    let base = model.frame(model.folded_links()[0].links[0].0)?;
    let from_space = model.forward_kinematics(theta, base)?.inverse();
    for (joint, place) in model.joints().zip(model.places()) {
        let child = model.frame(&joint.child)?;
        let to_base = (from_space * model.forward_kinematics(theta, child)?).Ad();
        let J = model.body_jacobian(theta, child)?;
        for j in place.velocities() {
            let A = DVector::from_row_slice(&(to_base * J.0[j]).to_array());
            inertia[j] = inertia[j].max(A.dot(&(whole * &A)));
        }
    }
    Ok(inertia)
}
