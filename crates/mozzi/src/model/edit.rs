//! Edits that return a new robot: payloads, locked joints, sub-chains, further frames.

use super::description::{Constraint, ConstraintKind, Gear, JointKind, NamedFrame, NamedState, Rotor};
use super::{Base, Description, Error, FrameId, Model, State};
use crate::lie::SE3;
use crate::spatial::SpatialInertia;
use alloc::collections::BTreeSet;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

impl Model<f64> {
    /// A copy of the robot with a payload fixed to a frame; its spatial inertia is in the frame's coordinates.
    ///
    /// # Errors
    /// [`Error::Invalid`] when the numbers are not finite.
    pub fn with_payload(&self, frame: FrameId, inertia: SpatialInertia) -> Result<Model, Error> {
        let mut robot = self.described()?;
        let (link, T) = self.link_of(frame);
        robot.links[link].inertia += inertia.transformed(T);
        robot.build()
    }

    /// A copy of the robot with an additional frame at `T` relative to an existing frame.
    ///
    /// # Errors
    /// [`Error::Invalid`] when the name is taken.
    pub fn with_frame(&self, name: impl Into<String>, on: FrameId, T: SE3) -> Result<Model, Error> {
        let (mut robot, (link, T_link_on)) = (self.described()?, self.link_of(on));
        let link = robot.links[link].name.clone();
        robot.frames.push(NamedFrame { name: name.into(), link, T: T_link_on * T });
        robot.build()
    }

    /// A copy of the robot with additional constraints, such as closed loops or pinned feet. See [`constraints`].
    ///
    /// # Errors
    /// [`Error::Invalid`] for a name that is taken, an anchor that does not exist, anchors that are fixed to each
    /// other, numbers that are not finite.
    ///
    /// [`constraints`]: crate::constraints
    pub fn with_constraints(&self, constraints: impl IntoIterator<Item = Constraint>) -> Result<Model, Error> {
        let mut robot = self.described()?;
        robot.constraints.extend(constraints);
        robot.build()
    }

    /// A copy of the robot without constraints: the tree.
    pub fn without_constraints(&self) -> Result<Model, Error> {
        let mut robot = self.described()?;
        robot.constraints.clear();
        robot.build()
    }

    /// A copy of the robot with a further rotor of the given inertia, kg m² or kg, which these joints turn together:
    /// its rate is Σ ratio θ̇, as in coupled wrists. With armature 0 it is there to be identified.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a name that is taken, a joint that does not exist or is no joint of one axis, numbers
    /// that are not finite.
    pub fn with_rotor(&self, name: impl Into<String>, armature: f64, gears: &[(&str, f64)]) -> Result<Model, Error> {
        let mut robot = self.described()?;
        let gears = gears.iter().map(|&(joint, ratio)| Gear { joint: joint.to_string(), ratio }).collect();
        robot.rotors.push(Rotor { name: name.into(), armature, gears });
        robot.build()
    }

    /// A copy of the robot with this frame as its end effector.
    pub fn with_end_effector(&self, frame: FrameId) -> Result<Model, Error> {
        let mut robot = self.described()?;
        robot.end_effector = Some(self.frame_name(frame).to_string());
        robot.build()
    }

    /// A copy of the robot with this gravity, in {s} coordinates, m/s².
    ///
    /// # Errors
    /// [`Error::Invalid`] when the numbers are not finite.
    pub fn with_gravity(&self, gravity: [f64; 3]) -> Result<Model, Error> {
        let mut robot = self.described()?;
        robot.gravity = gravity;
        robot.build()
    }

    /// A copy of the robot with a fixed or a floating base. Named states keep the joints' numbers; if the base was
    /// fixed, they place it at {s}, at rest.
    ///
    /// # Errors
    /// Only those that the model had before.
    pub fn with_base(&self, base: Base) -> Result<Model, Error> {
        let mut robot = self.described()?;
        robot.base = base;
        if base == Base::Fixed {
            robot.states.iter_mut().for_each(|state| state.base = None);
        }
        robot.build()
    }

    /// A copy of the robot in which a named state is added, or replaced if the name exists.
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::Invalid`] when the numbers are not finite, or a quaternion is not of length 1.
    pub fn with_state(&self, name: impl Into<String>, state: &State) -> Result<Model, Error> {
        let (mut robot, named) = (self.described()?, self.named_state(name, state)?);
        match robot.states.iter_mut().find(|known| known.name == named.name) {
            Some(known) => *known = named,
            None => robot.states.push(named),
        }
        robot.build()
    }

    /// A copy of the robot with this named state as its start.
    ///
    /// # Errors
    /// [`Error::NoSuchState`].
    pub fn with_start(&self, name: &str) -> Result<Model, Error> {
        self.state(name)?;
        let mut robot = self.described()?;
        robot.start = Some(name.to_string());
        robot.build()
    }

    /// A copy of the robot with joints locked at these positions (rad or m), and their mimic joints with them. Named
    /// states keep the other joints.
    ///
    /// # Errors
    /// [`Error::NoSuchJoint`]; [`Error::BadArgument`] for a mimic joint, a fixed, ball or free joint, or a position
    /// that is not finite.
    pub fn with_locked_joints(&self, positions: &[(&str, f64)]) -> Result<Model, Error> {
        let mut robot = self.described()?;
        for &(name, position) in positions {
            let i = robot.joint_at(name)?;
            if let Some(mimic) = &robot.joints[i].mimic {
                let found = alloc::format!("`{name}`, which follows `{}`", mimic.joint);
                return Err(Error::BadArgument {
                    what: "the joint to lock",
                    found,
                    expected: "a joint that follows none",
                });
            }
            if !position.is_finite() {
                let found = alloc::format!("{position} for `{name}`");
                return Err(Error::BadArgument { what: "the position to lock at", found, expected: "a finite number" });
            }
            let kind = robot.joints[i].kind;
            if !matches!(kind, JointKind::Screw(_)) {
                let found = alloc::format!("`{name}`, a {} joint", kind.name());
                let expected = "a joint of one axis, which moves";
                return Err(Error::BadArgument { what: "the joint to lock", found, expected });
            }
            // mimic joints of mimic joints too: each round locks those whose source joint was locked in the one before
            let mut locked = alloc::vec![(i, position)];
            while let Some((i, position)) = locked.pop() {
                let joint = &mut robot.joints[i];
                let name = joint.name.clone();
                if let JointKind::Screw(A) = joint.kind {
                    joint.origin = joint.origin * SE3::exp(A * position);
                    (joint.kind, joint.mimic) = (JointKind::Fixed, None);
                    robot.states.iter_mut().for_each(|state| state.retain(|kept| kept != name));
                    robot.motors.iter_mut().for_each(|motors| motors.retain(|motor| *motor != name));
                }
                locked.extend(robot.joints.iter().enumerate().filter_map(|(k, joint)| {
                    let mimic = joint.mimic.as_ref().filter(|mimic| mimic.joint == name)?;
                    Some((k, mimic.ratio * position + mimic.offset))
                }));
            }
        }
        robot.build()
    }

    /// The sub-chain from one link, which becomes the base (fixed, unless it was already a floating base), to another.
    /// Branches off the path are removed, also from named states. The end effector is the second frame. Gravity keeps
    /// its coordinates: set it if the new base is rotated.
    ///
    /// # Errors
    /// [`Error::BadArgument`] if `to` is not a descendant of `from`; if a joint on the path is coupled to one off the
    /// path by a mimic or a rotor; or if a constraint holds the path to what is off it, which {s} is unless `from` is
    /// the base.
    pub fn sub_chain(&self, from: FrameId, to: FrameId) -> Result<Model, Error> {
        let whole = &self.described()?;
        let end_effector = self.frame_name(to).to_string();
        let (from, to) = (self.link_of(from).0, self.link_of(to).0);
        let (mut links, mut joints, mut at) = (BTreeSet::from([to]), BTreeSet::new(), to);
        while at != from {
            let Some(i) = whole.joints.iter().position(|joint| joint.child == whole.links[at].name) else {
                let found = alloc::format!("from `{}` to `{}`", whole.links[from].name, whole.links[to].name);
                return Err(Error::BadArgument {
                    what: "the sub-chain",
                    found,
                    expected: "a link and one that hangs from it",
                });
            };
            joints.insert(i);
            at = whole.links.iter().position(|link| link.name == whole.joints[i].parent).unwrap_or(from);
            links.insert(at);
        }
        for &i in &joints {
            let joint = &whole.joints[i];
            if let Some(mimic) = &joint.mimic
                && !joints.iter().any(|&k| whole.joints[k].name == mimic.joint)
            {
                let found = alloc::format!("`{}`, which follows `{}` off the path", joint.name, mimic.joint);
                return Err(Error::BadArgument {
                    what: "a joint of the sub-chain",
                    found,
                    expected: "a source joint on the path",
                });
            }
        }
        let on_path = |name: &String| joints.iter().any(|&i| whole.joints[i].name == *name);
        let mut rotors = whole.rotors.clone();
        rotors.retain(|rotor| rotor.gears.iter().any(|gear| on_path(&gear.joint)));
        for rotor in &rotors {
            if let Some(gear) = rotor.gears.iter().find(|gear| !on_path(&gear.joint)) {
                let found = alloc::format!("`{}`, which `{}` off the path turns, too", rotor.name, gear.joint);
                return Err(Error::BadArgument {
                    what: "a rotor of the sub-chain",
                    found,
                    expected: "one that joints on the path turn alone",
                });
            }
        }
        let has = |name: &String| links.iter().any(|&i| whole.links[i].name == *name);
        let mut constraints = whole.constraints.clone();
        let links_of = |constraint: &Constraint| match &constraint.kind {
            ConstraintKind::Frames { a, b, .. } => {
                let is_on = |name: &str| self.is_on(name, &links);
                [a, b].map(|anchor| anchor.frame.as_deref().map_or(from == self.structure.base, is_on))
            }
            ConstraintKind::Joint { joints, source, .. } => {
                let mut of = joints.iter().chain(source).map(|gear| on_path(&gear.joint));
                let all = of.clone().all(|is_on| is_on);
                [of.any(|is_on| is_on), all]
            }
        };
        constraints.retain(|one| links_of(one) != [false, false]);
        if let Some(one) = constraints.iter().find(|one| links_of(one) != [true, true]) {
            let found = alloc::format!("`{}`, which holds {{s}} or a part off the path, too", one.name);
            let expected = "one that holds parts on the path alone";
            return Err(Error::BadArgument { what: "a constraint of the sub-chain", found, expected });
        }
        let kept: BTreeSet<&str> = joints.iter().map(|&i| whole.joints[i].name.as_str()).collect();
        let base = if from == self.structure.base { whole.base } else { Base::Fixed };
        let part = |state: &NamedState| {
            let mut state = state.clone();
            state.base = state.base.filter(|_| base == Base::Floating);
            state.retain(|name| kept.contains(name));
            state
        };
        Description {
            name: whole.name.clone(),
            links: links.iter().map(|&i| whole.links[i].clone()).collect(),
            joints: joints.iter().map(|&i| whole.joints[i].clone()).collect(),
            rotors,
            frames: whole.frames.iter().filter(|frame| has(&frame.link)).cloned().collect::<Vec<_>>(),
            constraints,
            motors: whole.motors.as_ref().map(|motors| motors.iter().filter(|name| on_path(name)).cloned().collect()),
            end_effector: Some(end_effector),
            gravity: whole.gravity,
            base,
            free_joint: whole.free_joint.clone(),
            states: whole.states.iter().map(part).collect(),
            start: whole.start.clone(),
        }
        .build()
    }

    /// True if the link or frame of this name is on one of these links.
    fn is_on(&self, name: &str, links: &BTreeSet<usize>) -> bool {
        self.frame(name).is_ok_and(|frame| links.contains(&self.link_of(frame).0))
    }

    /// The link of the description that carries a frame, and the frame relative to it.
    fn link_of(&self, frame: FrameId) -> (usize, SE3) {
        let robot = self.description();
        match frame.0.checked_sub(robot.links.len()) {
            None => (frame.0, SE3::identity()),
            Some(k) => {
                let frame = &robot.frames[k];
                (robot.links.iter().position(|link| link.name == frame.link).unwrap_or(0), frame.T)
            }
        }
    }
}

impl Description {
    pub(super) fn joint_at(&self, name: &str) -> Result<usize, Error> {
        self.joints.iter().position(|joint| joint.name == name).ok_or_else(|| Error::NoSuchJoint {
            name: name.to_string(),
            known: self.joints.iter().map(|joint| joint.name.clone()).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::ToString;
    use crate::SE3;
    use crate::model::description::NamedFrame;
    use crate::testing::{distance, state, tree};

    #[test]
    fn a_locked_joint_is_a_joint_that_does_not_move() {
        for (mimics, seed) in [(0, 1), (2, 2)] {
            let model = tree(seed, 7, mimics);
            let [mut theta, mut dtheta, mut ddtheta] = state(&model, seed);
            (dtheta[1], ddtheta[1]) = (0.0, 0.0);
            let name = model.joint_names().nth(1).expect("a joint").to_string();
            let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &model.environment()).expect("lengths");
            let locked = model.with_locked_joints(&[(&name, theta[1])]).expect("a joint");
            for list in [&mut theta, &mut dtheta, &mut ddtheta] {
                list.remove(1);
            }
            let without = locked.inverse_dynamics(&theta, &dtheta, &ddtheta, &locked.environment()).expect("lengths");
            for (a, b) in tau.iter().enumerate().filter(|(j, _)| *j != 1).map(|(_, x)| x).zip(without.iter()) {
                assert!((a - b).abs() < 1e-11 * tau.amax(), "{a} {b}");
            }
        }
    }

    #[test]
    fn mimic_joints_of_a_locked_joint_stand_where_it_puts_them() {
        let mut robot = tree(2, 7, 2).description().clone();
        let source = robot.joints.iter_mut().find_map(|joint| {
            let mimic = joint.mimic.as_mut()?;
            mimic.offset = 0.7;
            Some(mimic.joint.clone())
        });
        let source = source.expect("a mimic joint");
        let model = robot.clone().build().expect("sound");
        robot.motors = Some(model.joint_names().map(ToString::to_string).collect());
        let model = robot.build().expect("sound");
        let [theta, ..] = state(&model, 2);
        let j = model.joint_names().position(|name| name == source).expect("an independent joint");
        let locked = model.with_locked_joints(&[(&source, theta[j])]).expect("a joint");
        let rest: Vec<f64> = theta.iter().enumerate().filter(|(k, _)| *k != j).map(|(_, &x)| x).collect();
        for (frame, name) in model.frames() {
            let there = locked.frame(name).expect("the same frames");
            let apart = distance(
                model.forward_kinematics(&theta, frame).expect("lengths"),
                locked.forward_kinematics(&rest, there).expect("lengths"),
            );
            assert!(apart < 1e-13, "{name}: {apart}");
        }
        assert_eq!(locked.motors().len(), model.motors().len() - 1);
    }

    #[test]
    fn a_sub_chain_moves_as_in_the_whole() {
        let model = tree(11, 9, 0);
        let (base, tip) = (model.frame("link0").expect("base"), model.frame("link9").expect("a link"));
        let part = model.sub_chain(base, tip).expect("a path");
        let [theta, _, _] = state(&model, 11);
        let theta_part: Vec<f64> = part
            .joint_names()
            .map(|name| theta[model.joint_names().position(|known| known == name).expect("a joint")])
            .collect();
        let (whole, part) = (
            model.forward_kinematics(&theta, tip).expect("lengths"),
            part.forward_kinematics(&theta_part, part.end_effector().expect("named")).expect("lengths"),
        );
        assert!(distance(whole, part) < 1e-14);
        assert!(model.sub_chain(tip, base).is_err());
    }

    #[test]
    fn a_sub_chain_ends_in_the_frame_that_is_named() {
        let mut robot = tree(11, 9, 0).description().clone();
        let T = SE3::translation([0.1, 0.2, 0.3]);
        robot.frames.push(NamedFrame { name: "tool".into(), link: "link9".into(), T });
        let model = robot.build().expect("sound");
        let [base, link, tool] = ["link0", "link9", "tool"].map(|name| model.frame(name).expect("a frame"));
        let part = model.sub_chain(base, tool).expect("a path");
        assert_eq!(part.frame_name(part.end_effector().expect("named")), "tool");
        let part = model.sub_chain(base, link).expect("a path");
        assert_eq!(part.frame_name(part.end_effector().expect("named")), "link9");
    }
}
