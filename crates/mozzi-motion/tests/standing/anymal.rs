//! ANYmal, its feet, and motors with springs and dampers.

use mozzi::{Model, Vec3};
use mozzi_sim::{ContactPoint, Contacts, Input, Plane};

pub const FEET: [&str; 4] = ["LF_FOOT", "RF_FOOT", "LH_FOOT", "RH_FOOT"];
pub const POSE: [f64; 12] = [0.0, 0.7, -1.0, 0.0, 0.7, -1.0, 0.0, -0.7, 1.0, 0.0, -0.7, 1.0];

/// ANYmal with dry friction in its joints.
pub fn anymal(friction: f64) -> Model {
    let text = mozzi_urdf::embedded::text("anymal").expect("embedded");
    let loaded = mozzi_urdf::parse("anymal.urdf", text).expect("sound");
    let mut description = loaded.description.floating();
    for joint in &mut description.joints {
        joint.friction = friction;
    }
    description.build().expect("sound")
}

/// The origins of its feet on the ground.
pub fn feet(model: &Model, mu: f64) -> Contacts<'static> {
    let point = |name: &str| ContactPoint::new(name, model.frame(name).expect("there"), Vec3::zero(), mu);
    Contacts { points: FEET.map(point).to_vec(), planes: vec![Plane::ground()] }
}

/// θ with the lowest foot at a height.
pub fn start(model: &Model, contacts: &Contacts, height: f64) -> Vec<f64> {
    let mut theta = model.neutral_configuration::<f64>();
    theta[7..].copy_from_slice(&POSE);
    let lowest = contacts.gaps(model, 0.0, &theta).into_iter().fold(f64::INFINITY, f64::min);
    theta[6] += height - lowest;
    theta
}

/// τ = k (θ_d − θ) − d θ̇ of each joint, θ_d as a function of time.
pub struct Springs<F> {
    pub k: f64,
    pub d: f64,
    pub pose: F,
}

impl<F: Fn(f64) -> [f64; 12]> Input for Springs<F> {
    fn torque(&mut self, t: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), mozzi_sim::Error> {
        let pose = (self.pose)(t);
        for j in 0..12 {
            tau[6 + j] += self.k * (pose[j] - theta[7 + j]) - self.d * dtheta[6 + j];
        }
        Ok(())
    }

    fn gains(&self, stiffness: &mut [f64], damping: &mut [f64]) {
        stiffness[6..].iter_mut().for_each(|x| *x += self.k);
        damping[6..].iter_mut().for_each(|x| *x += self.d);
    }
}

/// The mass of everything that moves.
pub fn mass(model: &Model) -> f64 {
    model.mass_matrix(&model.neutral_configuration::<f64>()).expect("lengths")[(3, 3)]
}
