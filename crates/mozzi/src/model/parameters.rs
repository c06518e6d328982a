//! The vector π of a model's parameters in which its forces and energies are linear.

use super::{Freedom, Model, Place, Spring};
use crate::lie::SE3;
use crate::scalar::Scalar;
use crate::spatial::SpatialInertia;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::ops::Range;

/// Names of a body's parameters, in the order of
/// [`SpatialInertia::to_parameters`](crate::SpatialInertia::to_parameters).
const OF_BODY: [&str; 10] = ["m", "mcx", "mcy", "mcz", "Ixx", "Ixy", "Ixz", "Iyy", "Iyz", "Izz"];
const OF_JOINT: [&str; 5] = ["armature", "damping", "friction", "stiffness", "preload"];
/// The number of parameters of an independent joint.
pub(crate) const JOINT_PARAMETERS: usize = OF_JOINT.len();

impl<C: Scalar> Model<C> {
    /// The length of π: ten for each moving link and a floating base, five for each independent joint, one for each
    /// rotor.
    pub fn parameter_count(&self) -> usize {
        10 * self.bodies().count() + JOINT_PARAMETERS * self.places().len() + self.rotors.len()
    }

    /// Where the armature, damping, Coulomb friction, stiffness and preload of independent joint k are in π.
    pub fn parameters_of_joint(&self, k: usize) -> Range<usize> {
        let first = 10 * self.bodies().count() + JOINT_PARAMETERS * k;
        first..first + JOINT_PARAMETERS
    }

    /// π, the parameters in which τ and the energies are linear:
    ///
    /// - for a floating base and then for each moving link, base to tips, ten numbers in the coordinates of that
    ///   **link's frame in the file**: mass, m c, and the rotational inertia about the frame's origin, (m, m c_x, m
    ///   c_y, m c_z, I_xx, I_xy, I_xz, I_yy, I_yz, I_zz) in kg, kg m, kg m², including links fixed to it;
    /// - for each independent joint its armature, damping, Coulomb friction, stiffness and preload kθ₀, including its
    ///   mimic joints: Σ ratio² armature, Σ ratio² d, Σ |ratio| μ, Σ ratio² k, Σ ratio k (θ₀ − offset). For a ball or a
    ///   free joint the first three apply to each velocity; the preload of a ball and the spring of a free joint are 0;
    /// - for each rotor that several joints turn its armature.
    ///
    /// The springs' energy at θ = 0, Σ ½k(θ₀ − offset)², is not a parameter: no force depends on it.
    ///
    /// Names: [`parameter_names`](Self::parameter_names). Their matrix: [`regressor`](crate::dynamics::regressor()).
    pub fn parameters(&self) -> Vec<C> {
        let bodies = self.bodies().flat_map(|slot| {
            let G = if slot == 0 { self.base_inertia } else { self.links[slot - 1].G };
            G.congruence(self.link_frame(slot).Ad()).to_parameters()
        });
        let joints = self.places().iter().flat_map(|&Place { j, .. }| {
            let spring = self.springs.iter().find(|spring| spring.place.j == j);
            let (stiffness, preload) =
                spring.map_or((C::zero(), C::zero()), |spring| (spring.stiffness, spring.preload));
            [self.armature[j], self.damping[j], self.friction[j], stiffness, preload]
        });
        bodies.chain(joints).chain(self.rotors.iter().map(|rotor| rotor.armature)).collect()
    }

    /// The names of [`parameters`](Self::parameters): `link.m`, `link.mcx`, …, `link.Izz`, and `joint.armature`,
    /// `joint.damping`, `joint.friction`, `joint.stiffness`, `joint.preload`, and `rotor.armature`.
    pub fn parameter_names(&self) -> Vec<String> {
        let named = |name: &str, of: &[&str]| of.iter().map(|kind| format!("{name}.{kind}")).collect::<Vec<_>>();
        let bodies = self.bodies().flat_map(|slot| named(&self.description().links[self.link_at(slot)].name, &OF_BODY));
        let joints = self.joint_names().flat_map(|joint| named(joint, &OF_JOINT));
        let rotors = self.description().rotors.iter().flat_map(|rotor| named(&rotor.name, &OF_JOINT[..1]));
        bodies.chain(joints).chain(rotors).collect()
    }

    /// A copy of the robot with these [`parameters`](Self::parameters), possibly of another number type. Geometry,
    /// frames, couplings and the springs' energy at θ = 0 do not change, nor does the
    /// [`description`](Self::description); edits such as [`with_payload`](Self::with_payload) keep the parameters.
    ///
    /// # Panics
    /// When there are not [`parameter_count`](Self::parameter_count) of them.
    pub fn with_parameters<U: Scalar + From<C>>(&self, parameters: &[U]) -> Model<U> {
        let (found, expected) = (parameters.len(), self.parameter_count());
        assert!(found == expected, "there are {found} parameters, expected {expected}");
        let mut model = self.map(U::from);
        let (of_bodies, of_joints, of_rotors) = self.parts_of(parameters);
        for (slot, parameters) in self.bodies().zip(of_bodies) {
            let G = SpatialInertia::from_parameters(*parameters).transformed(model.link_frame(slot));
            match slot.checked_sub(1) {
                None => model.base_inertia = G,
                Some(i) => model.links[i].G = G,
            }
        }
        for (place, &[armature, damping, friction, stiffness, preload]) in self.places().iter().zip(of_joints) {
            for j in place.velocities() {
                (model.armature[j], model.damping[j], model.friction[j]) = (armature, damping, friction);
            }
            if let Some(spring) = model.spring_mut(place) {
                spring.stiffness = stiffness;
                if place.freedom == Freedom::One {
                    spring.preload = preload;
                }
            }
        }
        for (rotor, &armature) in model.rotors.iter_mut().zip(of_rotors) {
            rotor.armature = armature;
        }
        model.is_described = false;
        model
    }

    /// π in parts: of each body, of each independent joint, of each rotor.
    pub(super) fn parts_of<'p, U>(&self, parameters: &'p [U]) -> (&'p [[U; 10]], &'p [[U; JOINT_PARAMETERS]], &'p [U]) {
        let (of_bodies, of_others) = parameters.split_at(10 * self.bodies().count());
        let (of_joints, of_rotors) = of_others.split_at(JOINT_PARAMETERS * self.places().len());
        (of_bodies.as_chunks().0, of_joints.as_chunks().0, of_rotors)
    }

    /// The spring of a joint, a new one of stiffness 0 if it has none; None for a free joint.
    pub(super) fn spring_mut(&mut self, &place: &Place) -> Option<&mut Spring<C>> {
        if place.freedom == Freedom::Free {
            return None;
        }
        let at = self.springs.iter().position(|spring| spring.place == place).unwrap_or_else(|| {
            self.springs.push(Spring { place, stiffness: C::zero(), preload: C::zero() });
            self.springs.len() - 1
        });
        self.springs.get_mut(at)
    }

    /// The slots of all moving bodies: a floating base, and the moving links.
    pub(crate) fn bodies(&self) -> impl Iterator<Item = usize> {
        self.is_floating().then_some(0).into_iter().chain(self.moving_slots())
    }

    /// The link of the description in whose frame a slot's body is expressed: the base, or the link that a joint moves.
    pub(super) fn link_at(&self, slot: usize) -> usize {
        slot.checked_sub(1).map_or(self.structure.base, |i| self.structure.moving_links[i])
    }

    /// That link's frame, relative to the slot's normal frame.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn link_frame(&self, slot: usize) -> SE3<C> {
        self.frames[self.link_at(slot)].T
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{floating_tree, tree};
    use crate::{Description, SE3};
    use nalgebra::DVector;

    #[test]
    fn a_robot_with_its_own_parameters_is_the_same_robot() {
        for model in [tree(3, 6, 1), floating_tree(4, 5, 0)] {
            let (pi, scale) = (model.parameters(), model.mass());
            let again = model.with_parameters(&vec![0.0; pi.len()]).with_parameters(&pi);
            let errors = again.parameters().iter().zip(&pi).map(|(a, b)| (a - b).abs()).collect::<Vec<_>>();
            assert!(errors.iter().all(|error| *error < 1e-12 * scale), "{errors:?}");
        }
    }

    #[test]
    fn they_are_told_in_the_files_frames() {
        for model in [tree(3, 6, 1), floating_tree(4, 5, 0)] {
            let (pi, names) = (model.parameters(), model.parameter_names());
            assert_eq!((pi.len(), names.len()), (model.parameter_count(), model.parameter_count()));
            // no link is fixed to link3
            let link3 = &model.description().links.iter().find(|link| link.name == "link3").expect("a link").inertia;
            let k = names.iter().position(|name| name == "link3.m").expect("a body");
            let error = DVector::from_column_slice(&pi[k..k + 10]) - DVector::from_column_slice(&link3.to_parameters());
            assert!(error.amax() < 1e-13 * link3.mass.max(1.0), "{error}");
            let total = names.iter().zip(&pi).filter(|(name, _)| name.ends_with(".m")).map(|(_, m)| m);
            assert!((total.sum::<f64>() - model.mass()).abs() < 1e-12 * model.mass());
            let last = model.joint_names().last().map(|joint| format!("{joint}.preload"));
            let rotor = (!model.description().rotors.is_empty()).then(|| String::from("differential.armature"));
            assert_eq!(names.last(), rotor.or(last).as_ref());
        }
        let body = Description::new("body").link("it", crate::testing::inertia(1)).floating().build().expect("sound");
        assert_eq!(body.parameters(), crate::testing::inertia(1).congruence(SE3::identity().Ad()).to_parameters());
    }
}
