//! A model whose parameters vary: constants that are dual numbers, their derivatives along a change of the robot.

use crate::lie::SE3;
use crate::linalg::Vec3;
use crate::model::description::{Anchor, ConstraintKind, Joint};
use crate::model::{Error, Freedom, Model, Motion, TieKind};
use crate::scalar::Dual;
use crate::spatial::{SpatialInertia, Twist};
use alloc::format;
use alloc::string::ToString;
use alloc::vec;
use alloc::vec::Vec;

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
                    let moved = transformed(SpatialInertia::new(m, c, I_c), T).map(|x| seed(x.derivative));
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
        let (of_bodies, of_joints, of_rotors) = self.parts_of(rate);
        for (slot, rate) in self.bodies().zip(of_bodies) {
            let rate = SpatialInertia::from_parameters(*rate).transformed(self.link_frame(slot));
            *inertia(model, slot) += rate.map(seed);
        }
        for (place, &[armature, damping, friction, stiffness, preload]) in self.places().iter().zip(of_joints) {
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
            link.M = product(small_motion(self.link_frame(slot), -motion), link.M); // (T_pc e^{[ξ]ε} T_ci)⁻¹
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
                        *M = product(*M, small_motion(self.frames[moved[0]].T, -motion));
                    }
                    Err(_) => moved.push(self.link_named(&joint.child)?),
                }
            }
            next += 1;
        }
        let E = small_motion(self.frames[moved[0]].T, motion);
        for &link in &moved {
            let (slot, T) = (self.frames[link].slot, product(E, self.frames[link].T.map(Dual::constant)));
            let G = transformed(robot.links[link].inertia.map(Dual::constant), T);
            *inertia(model, slot) += G.map(|x| seed(x.derivative));
        }
        let of_frames = (0..).zip(&robot.frames).filter_map(|(k, frame)| {
            moved.iter().any(|&link| robot.links[link].name == frame.link).then_some(robot.links.len() + k)
        });
        let moved: Vec<usize> = moved.iter().copied().chain(of_frames).collect();
        for &frame in &moved {
            model.frames[frame].T = product(E, model.frames[frame].T);
        }
        let is_moved = |anchor: &Anchor| {
            let frame = anchor.frame.as_ref().and_then(|name| self.frame(name).ok());
            frame.is_some_and(|frame| moved.contains(&frame.index()))
        };
        for (tie, constraint) in model.ties.list.iter_mut().zip(&robot.constraints) {
            if let (TieKind::Frames { a, b, .. }, ConstraintKind::Frames { a: A, b: B, .. }) =
                (&mut tie.kind, &constraint.kind)
            {
                [(a, A), (b, B)]
                    .into_iter()
                    .filter(|(_, of)| is_moved(of))
                    .for_each(|(end, _)| end.T = product(E, end.T));
            }
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

/// One copy each: operations on dual numbers are long where they are inlined.
#[inline(never)]
fn product(T: SE3<Dual>, U: SE3<Dual>) -> SE3<Dual> {
    T * U
}

#[inline(never)]
fn transformed(G: SpatialInertia<Dual>, T: SE3<Dual>) -> SpatialInertia<Dual> {
    G.transformed(T)
}

/// e^{`[Ad_T ξ]`ε}: the motion ξ of a frame at T, expressed in the frame in which T is given.
#[inline(never)]
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
            (link.M, link.G) = (product(D, link.M), transformed(link.G, D));
        } else if link.parent == slot {
            link.M = product(link.M, D.inverse());
        }
    }
    for frame in model.frames.iter_mut().filter(|frame| frame.slot == slot) {
        frame.T = product(D, frame.T);
    }
    for tie in &mut model.ties.list {
        let TieKind::Frames { a, b, .. } = &mut tie.kind else { continue };
        [a, b].into_iter().filter(|end| end.slot == Some(slot)).for_each(|end| end.T = product(D, end.T));
    }
}

fn bad_joint(name: &str, kind: &str, expected: &'static str) -> Error {
    Error::BadArgument { what: "the joint to vary", found: format!("`{name}`, which is {kind}"), expected }
}

#[cfg(test)]
mod tests;
