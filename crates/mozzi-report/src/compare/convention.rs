//! Converts a model's states and results to the coordinates of a library.

use crate::compare::Result;
use crate::compare::terms::Numbers;
use mozzi::conventions::{MuJoCo, Pinocchio};
use mozzi::{Freedom, Model, Place};

/// Both libraries order a free joint's velocities linear first; a ball has only the last three.
const PARTS: [&str; 6] = ["vx", "vy", "vz", "wx", "wy", "wz"];

/// The names of a joint's velocities, in the order of the libraries.
pub fn velocity_names(joint: &str, nv: usize) -> Vec<String> {
    match nv {
        1 => vec![joint.into()],
        3 | 6 => PARTS[6 - nv..].iter().map(|part| format!("{joint}.{part}")).collect(),
        many => (1..=many).map(|k| format!("{joint} ({k} of {many})")).collect(),
    }
}

/// A library's coordinates, with the joints in mozzi's order.
pub enum Convention {
    Pinocchio(Pinocchio),
    MuJoCo(MuJoCo),
}

/// Positions, velocities and accelerations, one list for each joint.
pub type Lists = [Vec<Vec<f64>>; 3];

impl Convention {
    /// The convention of "Pinocchio" or "MuJoCo".
    pub fn new(library: &str, model: &Model) -> Result<Self> {
        if library == "MuJoCo" {
            return Ok(Convention::MuJoCo(MuJoCo::new(model)));
        }
        let names: Vec<&str> = model.joint_names().collect();
        let nqs: Vec<usize> = model.places().iter().map(|place| place.freedom.positions()).collect();
        Ok(Convention::Pinocchio(Pinocchio::with_joints(model, &names, &nqs)?))
    }

    /// A state, joint by joint; a floating base, which stays at rest, is left out.
    pub fn lists(&self, model: &Model, theta: &[f64], dtheta: &[f64], ddtheta: &[f64]) -> Result<Lists> {
        let [q, v, a] = match self {
            Convention::Pinocchio(to) => [to.configuration(theta)?, to.velocity(dtheta)?, to.acceleration(ddtheta)?],
            Convention::MuJoCo(to) => {
                [to.configuration(theta)?, to.velocity(theta, dtheta)?, to.acceleration(theta, dtheta, ddtheta)?]
            }
        };
        type Width = fn(Freedom) -> usize;
        let split = |numbers: &[f64], first: usize, width: Width| {
            let mut rest = &numbers[first..];
            let next = |place: &Place| {
                let (own, others) = rest.split_at(width(place.freedom));
                rest = others;
                own.to_vec()
            };
            model.places().iter().map(next).collect()
        };
        let (base, velocities): (_, Width) = (model.base(), Freedom::velocities);
        Ok([
            split(q.as_slice(), base.positions(), Freedom::positions),
            split(v.as_slice(), base.velocities(), velocities),
            split(a.as_slice(), base.velocities(), velocities),
        ])
    }

    /// mozzi's results.
    pub fn numbers(&self, theta: &[f64], dtheta: &[f64], own: &Numbers) -> Result<Numbers> {
        let Numbers { M, g, h, tau } = own;
        Ok(match self {
            Convention::Pinocchio(to) => Numbers {
                M: to.mass_matrix(M)?,
                g: to.force(g.as_slice())?,
                h: to.force(h.as_slice())?,
                tau: to.force(tau.as_slice())?,
            },
            Convention::MuJoCo(to) => Numbers {
                M: to.mass_matrix(theta, M)?,
                g: to.force(theta, g.as_slice())?,
                h: to.bias_forces(theta, dtheta, M, h.as_slice())?,
                tau: to.force(theta, tau.as_slice())?,
            },
        })
    }
}
