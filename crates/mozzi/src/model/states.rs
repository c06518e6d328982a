//! Named states: the initial state of a robot, and states of its file such as MuJoCo's keyframes.

use super::error::Error;
use super::{Freedom, Model};
use crate::scalar::Scalar;
use alloc::collections::BTreeMap;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;

/// A named state, stored by joint name, so that it does not depend on the numbering. Missing joints, and a missing
/// floating base, are neutral and at rest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedState {
    /// Unique among the robot's states.
    pub name: String,
    /// s
    pub time: f64,
    /// The state of a floating base; `None` for a fixed base.
    pub base: Option<BaseState>,
    /// Independent joints, each at most once, in any order. Mimic joints follow from their source joints.
    pub joints: Vec<JointState>,
}

/// A floating base's numbers in a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseState {
    /// `T_sb`: the unit quaternion (w, x, y, z), then the origin (x, y, z), m.
    pub pose: [f64; 7],
    /// 𝒱_b = (ω, v) in the base link's coordinates, rad/s and m/s.
    pub twist: [f64; 6],
}

/// A joint's numbers in a state.
#[derive(Clone, Debug, PartialEq)]
pub struct JointState {
    /// The joint.
    pub name: String,
    /// As in θ: 1 number (rad or m), 4 for a ball, 7 for a free joint.
    pub positions: Vec<f64>,
    /// As in θ̇: 1 number (rad/s or m/s), 3 for a ball, 6 for a free joint.
    pub velocities: Vec<f64>,
}

/// A state in the order of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// s
    pub time: f64,
    /// θ, nq numbers.
    pub theta: Vec<f64>,
    /// θ̇, n numbers.
    pub dtheta: Vec<f64>,
}

impl<C: Scalar> Model<C> {
    /// The names of the robot's states, in the order of its file.
    pub fn state_names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.description().states.iter().map(|state| state.name.as_str())
    }

    /// The state of this name.
    ///
    /// # Errors
    /// [`Error::NoSuchState`] with the names that exist.
    pub fn state(&self, name: &str) -> Result<State, Error> {
        let found = self.description().states.iter().find(|state| state.name == name);
        let unknown = || Error::NoSuchState {
            name: name.to_string(),
            known: self.state_names().map(ToString::to_string).collect(),
        };
        found.map(|state| self.numbered(state)).ok_or_else(unknown)
    }

    /// The initial state: the one named by [`Description::start`](super::Description::start), else the neutral
    /// configuration at rest.
    pub fn start(&self) -> State {
        let named = self.description().start.as_deref().and_then(|name| self.state(name).ok());
        named.unwrap_or_else(|| self.at_rest())
    }

    /// (θ, θ̇) as a named state for a [`Description`](super::Description).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn named_state(&self, name: impl Into<String>, state: &State) -> Result<NamedState, Error> {
        let State { time, theta, dtheta } = state;
        for (what, found, expected) in [("theta", theta.len(), self.nq()), ("dtheta", dtheta.len(), self.n())] {
            if found != expected {
                return Err(Error::WrongLength { what, found, expected });
            }
        }
        let base = self.is_floating().then(|| BaseState {
            pose: core::array::from_fn(|k| theta[k]),
            twist: core::array::from_fn(|k| dtheta[k]),
        });
        let joints = self.joint_names().zip(self.places()).map(|(name, place)| JointState {
            name: name.to_string(),
            positions: theta[place.positions()].to_vec(),
            velocities: dtheta[place.velocities()].to_vec(),
        });
        Ok(NamedState { name: name.into(), time: *time, base, joints: joints.collect() })
    }

    fn at_rest(&self) -> State {
        State { time: 0.0, theta: self.neutral_configuration(), dtheta: vec![0.0; self.n()] }
    }

    /// A checked state, in the order of the model.
    fn numbered(&self, named: &NamedState) -> State {
        let mut state = State { time: named.time, ..self.at_rest() };
        if let (true, Some(base)) = (self.is_floating(), &named.base) {
            state.theta[..base.pose.len()].copy_from_slice(&base.pose);
            state.dtheta[..base.twist.len()].copy_from_slice(&base.twist);
        }
        let places: BTreeMap<&str, _> = self.joint_names().zip(self.places()).collect();
        for joint in &named.joints {
            if let Some(place) = places.get(joint.name.as_str()) {
                state.theta[place.positions()].copy_from_slice(&joint.positions);
                state.dtheta[place.velocities()].copy_from_slice(&joint.velocities);
            }
        }
        state
    }
}

/// Its name.
impl AsRef<str> for NamedState {
    fn as_ref(&self) -> &str {
        &self.name
    }
}

impl NamedState {
    /// Keeps only the joints for which `is_kept` is true.
    pub(super) fn retain(&mut self, is_kept: impl Fn(&str) -> bool) {
        self.joints.retain(|joint| is_kept(&joint.name));
    }
}

impl Freedom {
    /// The unit quaternion among the positions, if there is one.
    pub(super) fn quaternion(self, positions: &[f64]) -> Option<[f64; 4]> {
        if self == Freedom::One { None } else { positions.first_chunk().copied() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Base, Description};
    use crate::testing::{floating_mixed_tree, floating_tree, mixed_tree, state, tree};
    use alloc::format;

    /// A model with a state `home`, which is its start, and that state.
    fn with_home(model: &Model, seed: u64) -> (Model, State) {
        let [theta, dtheta, _] = state(model, seed);
        let home = State { time: 1.5, theta, dtheta };
        let model = model.with_state("home", &home).and_then(|model| model.with_start("home"));
        (model.expect("sound"), home)
    }

    fn models() -> [Model; 5] {
        [tree(4, 7, 0), tree(4, 7, 2), floating_tree(4, 7, 2), mixed_tree(4, 7, 0), floating_mixed_tree(5, 9, 2)]
    }

    #[test]
    fn a_state_is_given_back_as_it_was_named() {
        for model in models() {
            let neutral = model.start();
            assert_eq!((neutral.theta, neutral.time), (model.neutral_configuration(), 0.0));
            let (model, home) = with_home(&model, 3);
            assert_eq!(model.state("home").expect("named"), home);
            assert_eq!(model.start(), home);
            let error = model.state("hone").expect_err("no such state").to_string();
            assert_eq!(error, "there is no state `hone`; this robot has `home`");
        }
    }

    #[test]
    fn numbers_of_another_kind_carry_states() {
        let (model, home) = with_home(&floating_tree(4, 7, 2), 3);
        let single: Model<f32> = model.map(|x| x as f32);
        assert_eq!(single.state("home").expect("named"), home);
        assert_eq!(model.description().map(|x| x as f32).states, model.description().states);
    }

    #[test]
    fn order_does_not_matter_and_what_is_left_out_is_neutral() {
        let (model, home) = with_home(&mixed_tree(4, 7, 0), 3);
        let mut robot = model.description().clone();
        robot.states[0].joints.reverse();
        assert_eq!(robot.clone().build().expect("sound").state("home").expect("named"), home);
        let first = model.joint_names().next().expect("a joint");
        robot.states[0].retain(|name| name != first);
        let found = robot.build().expect("sound").state("home").expect("named");
        let place = &model.places()[0];
        assert_eq!(found.theta[place.positions()], model.neutral_configuration::<f64>()[place.positions()]);
        assert_eq!(found.theta[place.positions().end..], home.theta[place.positions().end..]);
    }

    #[test]
    fn edits_keep_states_right() {
        let (model, home) = with_home(&floating_tree(4, 7, 0), 3);
        let names: Vec<&str> = model.joint_names().collect();
        let without = |list: &[f64], at: usize| [&list[..at], &list[at + 1..]].concat();
        let locked = model.with_locked_joints(&[(names[2], 0.3)]).expect("a joint").state("home").expect("named");
        assert_eq!((locked.theta, locked.dtheta), (without(&home.theta, 9), without(&home.dtheta, 8)));
        let fixed = model.with_base(Base::Fixed).expect("sound").state("home").expect("named");
        assert_eq!((&fixed.theta[..], &fixed.dtheta[..]), (&home.theta[7..], &home.dtheta[6..]));
        let tip = model.frame(&model.description().links.last().expect("a link").name.clone()).expect("a link");
        let base = model.frame("link0").expect("the base");
        let part = model.sub_chain(base, tip).expect("a path");
        let found = part.state("home").expect("named");
        for (name, place) in part.joint_names().zip(part.places()) {
            let k = names.iter().position(|known| *known == name).expect("a joint");
            assert_eq!(found.theta[place.positions()], home.theta[model.places()[k].positions()]);
        }
        assert_eq!(found.theta[..7], home.theta[..7]);
        assert_eq!(part.start(), found);
        let loaded = model.with_gravity([0.0; 3]).expect("sound");
        assert_eq!(loaded.start(), home);
        assert!(model.with_start("away").is_err_and(|error| error.to_string().contains("no state `away`")));
        let other = State { time: 2.0, ..home.clone() };
        let replaced = model.with_state("home", &other).expect("sound");
        assert_eq!((replaced.state_names().len(), replaced.start()), (1, other));
    }

    #[test]
    fn wrong_states_are_told() {
        let (model, _) = with_home(&mixed_tree(4, 7, 0), 3);
        let ball = model.joints().position(|joint| joint.kind.name() == "ball").expect("a ball");
        let said = |change: &dyn Fn(&mut Description)| {
            let mut robot = model.description().clone();
            change(&mut robot);
            robot.check().iter().map(|problem| format!("{}: {problem}", problem.code)).collect::<Vec<_>>().join("; ")
        };
        let of_home = |change: &dyn Fn(&mut NamedState)| said(&|robot| change(&mut robot.states[0]));
        assert_eq!(
            of_home(&|state| state.joints[0].name = "knee".into()).split(", expected").next(),
            Some("unknown_joint: state `home`: joints: there is no joint `knee`")
        );
        let first = model.joint_names().next().expect("a joint").to_string();
        assert_eq!(
            of_home(&|state| state.joints.push(state.joints[0].clone())),
            format!("repeated_joint: state `home`: joints: names `{first}` twice, expected once")
        );
        assert!(of_home(&|state| state.joints[0].positions.push(0.0)).contains("numbers, expected"));
        assert!(
            of_home(&|state| state.joints[0].velocities.clear()).starts_with("wrong_count: state `home`: velocities")
        );
        assert!(
            of_home(&|state| state.joints[0].velocities[0] = f64::NAN).starts_with("not_finite: state `home`: velo")
        );
        assert!(of_home(&|state| state.joints[0].positions[0] = f64::INFINITY).starts_with("not_finite: state `home`"));
        assert!(of_home(&|state| state.time = f64::NAN).starts_with("not_finite: state `home`: time: is NaN"));
        let long = of_home(&|state| state.joints[ball].positions[0] += 1.0);
        assert!(
            long.starts_with("invalid_quaternion: state `home`: positions: ") && long.contains("of length"),
            "{long}"
        );
        let base = BaseState { pose: [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], twist: [0.0; 6] };
        let fixed = of_home(&|state| state.base = Some(base));
        assert!(
            fixed.starts_with("fixed_base: state `home`: base: is given, but the robot's base is fixed"),
            "{fixed}"
        );
        assert!(of_home(&|state| state.name.clear()).starts_with("empty_name: state ``: name"));
        assert!(said(&|robot| robot.states.push(robot.states[0].clone())).starts_with("duplicate_name: state `home`"));
        let start = said(&|robot| robot.start = Some("rest".into()));
        assert!(start.ends_with("start: there is no state `rest`, expected one of `home`"), "{start}");
        assert!(model.named_state("short", &State { time: 0.0, theta: vec![0.0], dtheta: vec![] }).is_err());
    }

    #[test]
    fn mimic_joints_stand_in_no_state() {
        let (model, _) = with_home(&tree(4, 7, 2), 3);
        let mut robot = model.description().clone();
        let mimic = robot.joints.iter().find(|joint| joint.mimic.is_some()).expect("a mimic joint").clone();
        let (name, source) = (mimic.name.clone(), mimic.mimic.expect("it follows").joint);
        robot.states[0].joints.push(JointState { name: name.clone(), positions: vec![0.0], velocities: vec![0.0] });
        let said: Vec<_> = robot.check().iter().map(ToString::to_string).collect();
        let expected = format!("state `home`: joints: `{name}` follows `{source}`, expected independent joints alone");
        assert_eq!(said, [expected]);
    }
}
