//! The forces of MJCF's actuators and of gravity compensation on a simulated robot.

use super::actuator::{Actuation, Actuator};
use mozzi::dynamics::gravity_forces;
use mozzi::{Error, Model, SpatialInertia, Workspace};
use std::ops::Range;

/// The actuators of a file with constant controls, and its gravity compensation, as MuJoCo computes them. The forces of
/// a joint's actuators together are clamped to its effort limit (`actuatorfrcrange`).
pub struct Actuated {
    drives: Vec<Drive>,
    /// Largest |τ| of each velocity.
    limits: Vec<f64>,
    /// The robot with only the compensated parts of its links' masses.
    compensated: Option<(Model, Workspace)>,
    own: Vec<f64>,
}

/// An actuator whose joints are resolved.
struct Drive {
    /// Index in θ, index in θ̇, ∂l/∂θ.
    terms: Vec<(usize, usize, f64)>,
    /// l at θ = 0, of mimic joints.
    offset: f64,
    gain: [f64; 3],
    bias: [f64; 3],
    control: f64,
    range: [f64; 2],
}

impl Actuated {
    /// With the controls of a file's actuators; missing ones are 0.
    ///
    /// # Errors
    /// [`Error`] if the robot lacks a joint of the actuation.
    pub fn new(model: &Model, actuation: &Actuation, controls: &[f64]) -> Result<Self, Error> {
        let controls = controls.iter().copied().chain(std::iter::repeat(0.0));
        let given = actuation.actuators.iter().zip(controls);
        let drives = given.filter_map(|(one, control)| Some((one.as_ref()?, control)));
        let drives = drives.map(|(one, control)| Drive::new(model, one, control)).collect::<Result<_, _>>()?;
        let mut limits = vec![f64::INFINITY; model.n()];
        for (place, joint) in model.places().iter().zip(model.joints()) {
            limits[place.velocities()].fill(joint.limits.effort.unwrap_or(f64::INFINITY));
        }
        let compensated = match actuation.compensated.is_empty() {
            true => None,
            false => {
                let model = compensated(model, &actuation.compensated)?;
                let workspace = Workspace::new(&model);
                Some((model, workspace))
            }
        };
        Ok(Actuated { drives, limits, compensated, own: vec![0.0; model.n()] })
    }

    /// Whether some force is not 0 at all times.
    pub fn acts(&self) -> bool {
        let acts = |drive: &Drive| drive.control != 0.0 || drive.bias != [0.0; 3];
        self.compensated.is_some() || self.drives.iter().any(acts)
    }

    /// Adds their forces at a state to τ.
    pub fn add_forces(&mut self, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) {
        self.own.fill(0.0);
        for drive in &self.drives {
            let force = drive.force(theta, dtheta);
            drive.terms.iter().for_each(|(_, v, gear)| self.own[*v] += gear * force);
        }
        self.own.iter_mut().zip(&self.limits).for_each(|(own, limit)| *own = own.max(-limit).min(*limit));
        tau.iter_mut().zip(&self.own).for_each(|(sum, own)| *sum += own);
        if let Some((model, workspace)) = &mut self.compensated {
            gravity_forces(model, theta, model.gravity(), workspace, &mut self.own);
            tau.iter_mut().zip(&self.own).for_each(|(sum, own)| *sum += own);
        }
    }

    /// Adds −∂τ_j/∂θ_j and −∂τ_j/∂θ̇_j, as `mozzi_sim::Input::gains`.
    pub fn gains(&self, stiffness: &mut [f64], damping: &mut [f64]) {
        for drive in &self.drives {
            let [_, by_length, by_rate] = drive.coefficients();
            for (_, v, gear) in &drive.terms {
                stiffness[*v] += (-gear * gear * by_length).max(0.0);
                damping[*v] += (-gear * gear * by_rate).max(0.0);
            }
        }
    }
}

/// The robot with these parts of its links' inertias, and no others. A description has no negative mass; the
/// parameters have, as the difference of two robots.
fn compensated(model: &Model, parts: &[(String, f64)]) -> Result<Model, Error> {
    let of_sign = |sign: f64| {
        let mut robot = model.description().clone();
        for link in &mut robot.links {
            let part =
                parts.iter().find(|(name, _)| *name == link.name).map_or(0.0, |(_, part)| (sign * part).max(0.0));
            link.inertia = SpatialInertia::from_parameters(link.inertia.to_parameters().map(|x| part * x));
        }
        robot.build()?.with_gravity(model.gravity().0)
    };
    let [up, down] = [of_sign(1.0)?, of_sign(-1.0)?];
    let parameters: Vec<f64> = up.parameters().iter().zip(down.parameters()).map(|(up, down)| up - down).collect();
    Ok(up.with_parameters(&parameters))
}

impl Drive {
    fn new(model: &Model, one: &Actuator, control: f64) -> Result<Self, Error> {
        let (mut terms, mut offset) = (Vec::new(), 0.0);
        for (name, gear) in &one.gears {
            let mimic = model.description().joints.iter().find(|joint| joint.name == *name);
            let mimic = mimic.and_then(|joint| joint.mimic.as_ref());
            let (source, ratio) = mimic.map_or((name, 1.0), |mimic| (&mimic.joint, mimic.ratio));
            offset += gear * mimic.map_or(0.0, |mimic| mimic.offset);
            let Some(index) = model.joint_names().position(|known| known == source) else { continue }; // locked
            let place = &model.places()[index];
            let first = |range: Range<usize>| range.start;
            terms.push((first(place.positions()), first(place.velocities()), gear * ratio));
        }
        let [low, high] = one.control_range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let range = one.force_range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        Ok(Drive { terms, offset, gain: one.gain, bias: one.bias, control: control.max(low).min(high), range })
    }

    /// ∂F/∂(1, l, l̇) with the control.
    fn coefficients(&self) -> [f64; 3] {
        std::array::from_fn(|k| self.gain[k] * self.control + self.bias[k])
    }

    fn force(&self, theta: &[f64], dtheta: &[f64]) -> f64 {
        let l = self.terms.iter().map(|(q, _, gear)| gear * theta[*q]).sum::<f64>() + self.offset;
        let dl = self.terms.iter().map(|(_, v, gear)| gear * dtheta[*v]).sum::<f64>();
        let [c, by_length, by_rate] = self.coefficients();
        (c + by_length * l + by_rate * dl).max(self.range[0]).min(self.range[1])
    }
}
