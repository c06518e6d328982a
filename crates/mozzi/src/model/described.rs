//! The description of a model whose parameters were replaced.

use super::{Description, Error, Freedom, Model};
use crate::spatial::SpatialInertia;
use alloc::format;

impl Model<f64> {
    /// The [`description`](Self::description) with this model's [`parameters`](Self::parameters), to build another
    /// robot from. Parameters that [replaced](Self::with_parameters) its own are written to the links that joints move,
    /// less what is fixed to them, and to source joints.
    ///
    /// # Errors
    /// [`Error::BadArgument`] for a preload without stiffness, which no joint describes.
    pub fn described(&self) -> Result<Description, Error> {
        let mut robot = self.description().clone();
        if self.is_described {
            return Ok(robot);
        }
        let parameters = self.parameters();
        let (of_bodies, of_joints, of_rotors) = self.parts_of(&parameters);
        for (slot, &body) in self.bodies().zip(of_bodies) {
            let (link, mut own) = (self.link_at(slot), body);
            for k in (0..robot.links.len()).filter(|&k| k != link && self.frames[k].slot == slot) {
                let fixed = robot.links[k].inertia.transformed(self.frames[link].T.inverse() * self.frames[k].T);
                own.iter_mut().zip(fixed.to_parameters()).for_each(|(own, fixed)| *own -= fixed);
            }
            robot.links[link].inertia = SpatialInertia::from_parameters(own);
        }
        for joint in robot.joints.iter_mut().filter(|joint| joint.mimic.is_some()) {
            [joint.armature, joint.damping, joint.friction, joint.stiffness] = [0.0; 4];
        }
        for (&i, (place, &[armature, damping, friction, stiffness, preload])) in
            self.structure.joints.iter().zip(self.places().iter().zip(of_joints))
        {
            let joint = &mut robot.joints[i];
            [joint.armature, joint.damping, joint.friction, joint.stiffness] = [armature, damping, friction, stiffness];
            if stiffness != 0.0 && place.freedom == Freedom::One {
                joint.spring_reference = preload / stiffness;
            } else if preload != 0.0 {
                let found = format!("{preload} of `{}`, whose stiffness is 0", joint.name);
                return Err(Error::BadArgument { what: "a preload", found, expected: "0, or a stiffness above 0" });
            }
        }
        robot.rotors.iter_mut().zip(of_rotors).for_each(|(rotor, &armature)| rotor.armature = armature);
        Ok(robot)
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{floating_tree, state, tree};
    use crate::{SpatialInertia, Vec3};

    #[test]
    fn edits_keep_parameters_that_were_replaced() {
        for model in [tree(3, 6, 1), floating_tree(4, 5, 0)] {
            let other: Vec<f64> =
                model.parameters().iter().enumerate().map(|(k, x)| x * (1.1 + 0.02 * (k % 7) as f64)).collect();
            let model = model.with_parameters(&other);
            let (frame, _) = model.frames().last().expect("a frame");
            let gravity = model.gravity();
            let edited = model.with_end_effector(frame).expect("sound").with_gravity(gravity.0).expect("sound");
            let scale = other.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            for ((name, a), b) in edited.parameter_names().iter().zip(edited.parameters()).zip(&other) {
                assert!((a - b).abs() < 1e-13 * scale, "{name}: {a} instead of {b}");
            }
            let [theta, dtheta, ddtheta] = state(&model, 1);
            let tau = |robot: &crate::Model| {
                robot.inverse_dynamics(&theta, &dtheta, &ddtheta, &robot.environment()).expect("lengths")
            };
            assert!((tau(&edited) - tau(&model)).amax() < 1e-11 * tau(&model).amax());
            let payload = SpatialInertia::point_mass(2.0, Vec3([0.1, 0.0, 0.2]));
            let heavier = model.with_payload(frame, payload).expect("sound").mass();
            assert!((heavier - model.mass() - 2.0).abs() < 1e-12 * heavier);
        }
    }

    #[test]
    fn a_preload_without_stiffness_is_refused() {
        let model = tree(3, 6, 1);
        let mut other = model.parameters();
        let joint = model.parameters_of_joint(0);
        (other[joint.start + 3], other[joint.start + 4]) = (0.0, 1.5);
        let error = model.with_parameters(&other).with_gravity([0.0; 3]).expect_err("a preload");
        assert!(error.to_string().contains("1.5 of `joint1`, whose stiffness is 0"), "{error}");
    }
}
