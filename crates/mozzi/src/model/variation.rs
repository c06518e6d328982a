//! A model whose parameters vary: constants that are dual numbers, their derivatives along a change of the robot.

use super::description::Joint;
use super::{Error, Freedom, JOINT_PARAMETERS, Model, Motion};
use crate::lie::SE3;
use crate::linalg::Vec3;
use crate::scalar::Dual;
use crate::spatial::{SpatialInertia, Twist};
use alloc::format;
use alloc::string::ToString;
use alloc::vec;

/// A change of a robot's parameters, for [`Model::with_parameter_tangent`]. ε is the size of the change:
#[derive(Clone, Copy, Debug)]
pub enum Variation<'a> {
    /// π + δπ ε: change of the [`parameters`](Model::parameters), which include armature, damping, friction and
    /// springs; p numbers.
    Parameters(&'a [f64]),
    /// 𝒢 + δ𝒢 ε: change of a link's own inertia, in its frame.
    Inertia {
        /// A link of the description, fixed to others or not.
        link: &'a str,
        /// δ𝒢.
        rate: SpatialInertia,
    },
    /// m + ε: change of a link's mass; its centre of mass and the inertia about it are kept.
    Mass {
        /// A link of the description.
        link: &'a str,
    },
    /// c + δc ε: change of a link's centre of mass; its mass and the inertia about the centre of mass are kept.
    CenterOfMass {
        /// A link of the description.
        link: &'a str,
        /// δc, in its frame.
        rate: Vec3,
    },
    /// e^{`[ξ]`ε} moves a joint's axis, while the links stay where they are at 0.
    Axis {
        /// A joint that moves.
        joint: &'a str,
        /// ξ, in the frame of the child link at 0. (ω, 0) turns the axis, (0, v) shifts it.
        motion: Twist,
    },
    /// h + ε: metres per radian of a joint that turns.
    Pitch {
        /// A revolute or helical joint.
        joint: &'a str,
    },
    /// T e^{`[ξ]`ε}: the placement of a joint on its parent, moving all links beyond it.
    Placement {
        /// A joint, moving or fixed.
        joint: &'a str,
        /// ξ, in the frame of the child link at 0.
        motion: Twist,
    },
}

impl Model<f64> {
    /// A copy of the robot with dual constants, whose derivatives are the sum of these changes. Every result then has
    /// its exact derivative in this direction:
    ///
    /// ```
    /// use mozzi::model::description::{Joint, JointKind};
    /// use mozzi::model::Variation;
    /// use mozzi::{Description, Dual, SE3, ScrewAxis, SpatialInertia, Vec3, Workspace};
    /// use mozzi::dynamics::inverse_dynamics;
    /// // a pendulum of 2 kg at 0.7 m from its pivot, on a bracket
    /// let axis = JointKind::Screw(ScrewAxis::new([0.0, -1.0, 0.0], [0.0; 3])?);
    /// let pendulum = Description::new("pendulum")
    ///     .link("base", SpatialInertia::zero())
    ///     .link("bob", SpatialInertia::point_mass(2.0, Vec3([0.0, 0.0, -0.7])))
    ///     .joint(Joint::new("pivot", "base", "bob", SE3::identity(), axis))
    ///     .build()?;
    /// let longer = Variation::CenterOfMass { link: "bob", rate: Vec3([0.0, 0.0, -1.0]) };
    /// let with_parameter_tangent = pendulum.with_parameter_tangent(&[longer])?;
    ///
    /// let (theta, still) = (Dual::constants(&[0.3]), Dual::constants(&[0.0]));
    /// let (mut workspace, mut tau) = (Workspace::new(&with_parameter_tangent), Dual::constants(&[0.0]));
    /// let environment = with_parameter_tangent.environment();
    /// inverse_dynamics(&with_parameter_tangent, &theta, &still, &still, &environment, &mut workspace, &mut tau);
    /// assert!((tau[0].derivative - 2.0 * 9.81 * 0.3_f64.sin()).abs() < 1e-12); // τ = m g l sin θ
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Cost O(N) for each change.
    ///
    /// # Errors
    /// [`Error::NoSuchFrame`] or [`Error::NoSuchJoint`] with the names that exist; [`Error::WrongLength`] for δπ;
    /// [`Error::BadArgument`] for the axis or pitch of a joint that has none.
    pub fn with_parameter_tangent(&self, changes: &[Variation]) -> Result<Model<Dual>, Error> {
        let mut model = self.map(Dual::constant);
        for &change in changes {
            match change {
                Variation::Parameters(rate) => self.vary_parameters(&mut model, rate)?,
                Variation::Inertia { link, rate } => {
                    let T = self.frames[self.link_named(link)?];
                    *inertia(&mut model, T.slot) += rate.transformed(T.T).map(seed);
                }
                Variation::Mass { link } => {
                    let i = self.link_named(link)?;
                    let c = self.description().links[i].inertia.center_of_mass();
                    let rate = SpatialInertia::point_mass(1.0, c).transformed(self.frames[i].T);
                    *inertia(&mut model, self.frames[i].slot) += rate.map(seed);
                }
                Variation::CenterOfMass { link, rate } => {
                    let i = self.link_named(link)?;
                    let (G, T) = (self.description().links[i].inertia, self.frames[i].T.map(Dual::constant));
                    let (m, I_c) = (Dual::constant(G.mass), G.about_center_of_mass().map(Dual::constant));
                    let c = G.center_of_mass().map(Dual::constant) + rate.map(seed);
                    let moved = SpatialInertia::new(m, c, I_c).transformed(T).map(|x| seed(x.derivative));
                    *inertia(&mut model, self.frames[i].slot) += moved;
                }
                Variation::Axis { joint, motion } => {
                    let slot = self.slot_of_one_axis(joint)?;
                    // the slot's normal frame moves along, so everything expressed in it moves back
                    move_contents(&mut model, slot, small_motion(self.link_frame(slot), -motion));
                }
                Variation::Pitch { joint } => {
                    let slot = self.slot_of_one_axis(joint)?;
                    if self.links[slot - 1].screw.a == 0.0 {
                        return Err(bad_joint(joint, "prismatic", "a joint that turns"));
                    }
                    let link = &mut model.links[slot - 1];
                    link.screw.b += seed(1.0);
                    link.A.b += seed(1.0) * link.ratio;
                }
                Variation::Placement { joint, motion } => self.vary_placement(&mut model, joint, motion)?,
            }
        }
        Ok(model)
    }
}

impl Model<f64> {
    fn vary_parameters(&self, model: &mut Model<Dual>, rate: &[f64]) -> Result<(), Error> {
        let (found, expected) = (rate.len(), self.parameter_count());
        if found != expected {
            return Err(Error::WrongLength { what: "a rate of the parameters", found, expected });
        }
        let (of_bodies, of_joints) = rate.split_at(10 * self.bodies().count());
        let (of_joints, of_rotors) = of_joints.split_at(JOINT_PARAMETERS * self.places().len());
        for (slot, rate) in self.bodies().zip(of_bodies.as_chunks().0) {
            let rate = SpatialInertia::from_parameters(*rate).transformed(self.link_frame(slot));
            *inertia(model, slot) += rate.map(seed);
        }
        for (place, &[armature, damping, friction, stiffness, preload]) in
            self.places().iter().zip(of_joints.as_chunks().0)
        {
            for j in place.velocities() {
                model.armature[j] += seed(armature);
                model.damping[j] += seed(damping);
                model.friction[j] += seed(friction);
            }
            if let Some(spring) = model.spring_mut(place) {
                spring.stiffness += seed(stiffness);
                if place.freedom == Freedom::One {
                    spring.preload += seed(preload);
                }
            }
        }
        for (rotor, &armature) in model.rotors.iter_mut().zip(of_rotors) {
            rotor.armature += seed(armature);
        }
        Ok(())
    }

    /// A moving joint moves its link; a fixed joint moves all links fixed to its child, and the links that they carry.
    fn vary_placement(&self, model: &mut Model<Dual>, name: &str, motion: Twist) -> Result<(), Error> {
        let robot = self.description();
        let joint = &robot.joints[robot.joint_at(name)?];
        if let Ok(slot) = self.slot_of(name) {
            let link = &mut model.links[slot - 1];
            link.M = small_motion(self.link_frame(slot), -motion) * link.M; // (T_pc e^{[ξ]ε} T_ci)⁻¹
            return Ok(());
        }
        let mut moved = vec![self.link_named(&joint.child)?];
        let mut next = 0;
        while let Some(&link) = moved.get(next) {
            let carried = |joint: &&Joint| joint.parent == robot.links[link].name;
            for joint in robot.joints.iter().filter(carried) {
                match self.slot_of(&joint.name) {
                    Ok(slot) => {
                        let M = &mut model.links[slot - 1].M;
                        *M = *M * small_motion(self.frames[moved[0]].T, -motion);
                    }
                    Err(_) => moved.push(self.link_named(&joint.child)?),
                }
            }
            next += 1;
        }
        let E = small_motion(self.frames[moved[0]].T, motion);
        for &link in &moved {
            let (slot, T) = (self.frames[link].slot, E * self.frames[link].T.map(Dual::constant));
            let G = robot.links[link].inertia.map(Dual::constant).transformed(T);
            *inertia(model, slot) += G.map(|x| seed(x.derivative));
        }
        let of_frames = (0..).zip(&robot.frames).filter_map(|(k, frame)| {
            moved.iter().any(|&link| robot.links[link].name == frame.link).then_some(robot.links.len() + k)
        });
        for frame in moved.iter().copied().chain(of_frames) {
            model.frames[frame].T = E * model.frames[frame].T;
        }
        Ok(())
    }

    fn link_named(&self, name: &str) -> Result<usize, Error> {
        let links = &self.description().links;
        links.iter().position(|link| link.name == name).ok_or_else(|| Error::NoSuchFrame {
            name: name.to_string(),
            known: links.iter().map(|link| link.name.clone()).collect(),
        })
    }

    fn slot_of_one_axis(&self, name: &str) -> Result<usize, Error> {
        let slot = self.slot_of(name)?;
        match self.links[slot - 1].motion {
            Motion::Screw => Ok(slot),
            Motion::Ball => Err(bad_joint(name, "a ball", "a joint of one axis")),
            _ => Err(bad_joint(name, "free", "a joint of one axis")),
        }
    }

    /// The slot that a joint moves; for a ball or a free joint, that of its first axis.
    fn slot_of(&self, name: &str) -> Result<usize, Error> {
        let joint = self.description().joint_at(name)?;
        let slot = self.structure.moving_joints.iter().position(|&moving| moving == joint);
        slot.map(|i| i + 1).ok_or_else(|| bad_joint(name, "fixed", "a joint that moves"))
    }
}

/// 0 + ẋε.
fn seed(rate: f64) -> Dual {
    Dual { value: 0.0, derivative: rate }
}

/// e^{`[Ad_T ξ]`ε}: the motion ξ of a frame at T, expressed in the frame in which T is given.
fn small_motion(T: SE3, xi: Twist) -> SE3<Dual> {
    SE3::exp(Twist::from_array((T.Ad() * xi).to_array().map(seed)))
}

fn inertia(model: &mut Model<Dual>, slot: usize) -> &mut SpatialInertia<Dual> {
    match slot.checked_sub(1) {
        None => &mut model.base_inertia,
        Some(i) => &mut model.links[i].G,
    }
}

/// Moves a link and the links that it carries relative to its joint's axis: D is in the slot's normal frame.
fn move_contents(model: &mut Model<Dual>, slot: usize, D: SE3<Dual>) {
    for (i, link) in (1..).zip(&mut model.links) {
        if i == slot {
            (link.M, link.G) = (D * link.M, link.G.transformed(D));
        } else if link.parent == slot {
            link.M = link.M * D.inverse();
        }
    }
    for frame in model.frames.iter_mut().filter(|frame| frame.slot == slot) {
        frame.T = D * frame.T;
    }
}

fn bad_joint(name: &str, kind: &str, expected: &'static str) -> Error {
    Error::BadArgument { what: "the joint to vary", found: format!("`{name}`, which is {kind}"), expected }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{forward_dynamics, inverse_dynamics};
    use crate::kinematics::forward_kinematics;
    use crate::model::description::JointKind;
    use crate::spatial::ScrewAxis;
    use crate::testing::{floating_tree, state, tree, twist, wrench};
    use crate::{Description, Environment, Workspace, Wrench};
    use alloc::vec::Vec;

    /// τ, θ̈ and the tip's position, and their derivatives along the changes, from dual constants.
    fn by_duals(model: &Model, changes: &[Variation], seed: u64) -> Vec<Dual> {
        let with_parameter_tangent = model.with_parameter_tangent(changes).expect("known names");
        let [theta, dtheta, ddtheta] = state(model, seed).map(|x| Dual::constants(&x));
        let (mut w, tip) = (Workspace::<Dual>::new(&with_parameter_tangent), model.end_effector().expect("named"));
        let applied = [(tip, Wrench::from_array(wrench(seed).to_array().map(Dual::constant)))];
        let environment = Environment { applied: &applied, ..with_parameter_tangent.environment() };
        let (mut tau, mut found) = (ddtheta.clone(), ddtheta.clone());
        inverse_dynamics(&with_parameter_tangent, &theta, &dtheta, &ddtheta, &environment, &mut w, &mut tau);
        forward_dynamics(&with_parameter_tangent, &theta, &dtheta, &ddtheta, &environment, &mut w, &mut found);
        let p = forward_kinematics(&with_parameter_tangent, &theta, tip).p;
        tau.into_iter().chain(found).chain(p.0).collect()
    }

    fn values(model: &Model, seed: u64) -> Vec<f64> {
        by_duals(model, &[], seed).into_iter().map(|x| x.value).collect()
    }

    /// Compares with central differences of the rebuilt description.
    fn check(model: &Model, change: Variation, what: &str, perturb: impl Fn(&mut Description, f64)) {
        let h = 1e-5;
        let at = |step: f64| {
            let mut robot = model.description().clone();
            perturb(&mut robot, step);
            values(&robot.build().expect("sound"), 7)
        };
        let (plus, minus, found) = (at(h), at(-h), by_duals(model, &[change], 7));
        let n = model.n();
        for part in [0..n, n..2 * n, 2 * n..2 * n + 3] {
            let differences: Vec<f64> = part.clone().map(|k| (plus[k] - minus[k]) / (2.0 * h)).collect();
            let size = part.clone().map(|k| found[k].value.abs()).chain(differences.iter().map(|x| x.abs()));
            let size = size.fold(1.0, f64::max);
            for (k, difference) in part.zip(differences) {
                let error = (found[k].derivative - difference).abs() / size;
                assert!(error < 1e-7, "{what}, entry {k}: {} {difference}", found[k].derivative);
            }
        }
    }

    #[test]
    fn duals_equal_differences_of_the_description() {
        for model in [tree(3, 7, 0), tree(5, 8, 2), floating_tree(2, 6, 0)] {
            let places = model.description().clone();
            let link = |name: &str| places.links.iter().position(|link| link.name == name).expect("a link");
            for name in ["link0", "link2", "tool2", "link5"] {
                let i = link(name);
                let G = places.links[i].inertia;
                let (c, I_c) = (G.center_of_mass(), G.about_center_of_mass());
                check(&model, Variation::Mass { link: name }, name, |robot, h| {
                    robot.links[i].inertia = SpatialInertia::new(G.mass + h, c, I_c);
                });
                let rate = Vec3([0.3, -0.2, 0.5]);
                check(&model, Variation::CenterOfMass { link: name, rate }, name, |robot, h| {
                    robot.links[i].inertia = SpatialInertia::new(G.mass, c + rate * h, I_c);
                });
                let rate = crate::testing::inertia(9);
                check(&model, Variation::Inertia { link: name, rate }, name, |robot, h| {
                    robot.links[i].inertia += rate * h;
                });
            }
            let motion = twist(4);
            for (i, joint) in places.joints.iter().enumerate() {
                let name = joint.name.as_str();
                check(&model, Variation::Placement { joint: name, motion }, name, |robot, h| {
                    robot.joints[i].origin = joint.origin * SE3::exp(motion * h);
                });
                let JointKind::Screw(A) = joint.kind else { continue };
                let set = |robot: &mut Description, V: Twist| {
                    robot.joints[i].kind = JointKind::Screw(ScrewAxis::normalize(V).expect("a screw").0);
                };
                check(&model, Variation::Axis { joint: name, motion }, name, |robot, h| {
                    set(robot, SE3::exp(motion * h).Ad() * A.twist());
                });
                if !A.is_prismatic() {
                    check(&model, Variation::Pitch { joint: name }, name, |robot, h| {
                        set(robot, Twist { v: A.twist().v + A.twist().w * h, ..A.twist() });
                    });
                }
            }
        }
    }

    #[test]
    fn changes_add_up_and_parameters_are_the_regressors_columns() {
        for model in [tree(3, 7, 2), floating_tree(2, 6, 1)] {
            let [theta, dtheta, ddtheta] = state(&model, 7);
            let Y = model.regressor(&theta, &dtheta, &ddtheta, &model.environment()).expect("lengths");
            let p = model.parameter_count();
            for k in 0..p {
                let mut unit = vec![0.0; p];
                unit[k] = 1.0;
                let found = by_duals(&model, &[Variation::Parameters(&unit)], 7);
                for (j, y) in Y.column(k).iter().enumerate() {
                    assert!((found[j].derivative - y).abs() < 1e-12 * Y.amax(), "{k}: {} {y}", found[j].derivative);
                }
            }
            let (a, b) = (Variation::Mass { link: "link2" }, Variation::Axis { joint: "joint3", motion: twist(1) });
            let (one, other, both) =
                (by_duals(&model, &[a], 7), by_duals(&model, &[b], 7), by_duals(&model, &[a, b], 7));
            for ((a, b), both) in one.iter().zip(&other).zip(&both) {
                let sum = a.derivative + b.derivative;
                assert!((sum - both.derivative).abs() <= 1e-9 * (1.0 + sum.abs()), "{sum} {both:?}");
            }
        }
    }

    #[test]
    fn what_cannot_vary_is_refused() {
        let model = tree(1, 5, 0);
        let fails = |change: Variation| model.with_parameter_tangent(&[change]).expect_err("refused").to_string();
        assert!(fails(Variation::Mass { link: "tip" }).contains("there is no frame `tip`"));
        assert!(fails(Variation::Axis { joint: "weld2", motion: twist(1) }).contains("`weld2`, which is fixed"));
        assert!(fails(Variation::Pitch { joint: "joint4" }).contains("`joint4`, which is prismatic"));
        assert!(fails(Variation::Placement { joint: "x", motion: twist(1) }).contains("there is no joint `x`"));
        assert!(fails(Variation::Parameters(&[0.0])).contains("has 1 entries, expected 75"));
    }
}
