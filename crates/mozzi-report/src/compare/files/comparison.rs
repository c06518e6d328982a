//! The comparison of two files.

use super::cause::{Cause, Change, exchange};
use super::forces::{Gaps, States, agree, agree_at_rest};
use super::matching::matched;
use super::number::shown;
use super::places::Places;
use super::{RobotFile, actuation, constraints, frames, joints, merged, report, rotors, shapes, starts, trial};
use crate::compare::Result;
use serde_json::Value;

/// The result of comparing two files of a robot.
#[derive(Debug)]
pub struct FilesComparison {
    pub(super) names: [String; 2],
    pub(super) states: usize,
    pub(super) seed: u64,
    pub(super) tolerance: f64,
    /// The moving joints that both have.
    pub(super) common: usize,
    /// The velocities whose forces are compared: those of these joints and of a base that floats in both.
    pub(super) rows: usize,
    pub(super) renamed: Vec<(String, String)>,
    /// Those of them that are not known by their places.
    pub(super) named: Vec<String>,
    /// Links under other names in the second file.
    pub(super) links: Vec<(String, String)>,
    pub(super) only: [Vec<String>; 2],
    /// A sentence about the base, if it is floating in one file only.
    pub(super) base: Option<String>,
    /// As the files are, and with all causes accounted for.
    pub(super) before: Gaps,
    pub(super) after: Gaps,
    pub(super) causes: Vec<Cause>,
    /// Differences without an effect on the verdict.
    pub(super) notes: Vec<String>,
}

/// Compares two files of a robot at random states within the first one's limits. `tolerance` is the largest accepted
/// difference of M and of the forces, as a part of each joint's largest, and of limits and places.
///
/// # Errors
/// [`Error`](crate::compare::Error) if a robot with independent joints cannot be built.
pub fn compare_files(
    a: &RobotFile,
    b: &RobotFile,
    states: usize,
    seed: u64,
    tolerance: f64,
) -> Result<FilesComparison> {
    let (mut one, mut two) = (without_states(a), without_states(b));
    let base = (one.base != two.base).then(|| {
        let free = if one.base == mozzi::Base::Floating { &a.name } else { &b.name };
        (one.base, two.base) = (mozzi::Base::Fixed, mozzi::Base::Fixed);
        format!("the base is free in {free} only; compared with a fixed base")
    });
    let mut matched = matched(&one, &two)?;
    let states_of = States::random(&one, &matched.a, states, seed)?;
    let (mine, theirs) = (states_of.numbers(&matched.a)?, states_of.numbers(&matched.b)?);
    let before = states_of.gaps(&mine, &theirs);
    // causes are sought behind exchanged names
    let exchanged = matched.exchanged();
    exchanged.iter().for_each(|names| exchange(&mut matched.b, names));
    // what hangs on another body is compared there
    let mut causes = joints::tree(&Places::of([&matched.a, &matched.b])?, &b.name);
    let mut moved = matched.a.clone();
    causes.iter().for_each(|cause| cause.change.apply(&mut moved));
    let moved = if moved.clone().build().is_ok() { moved } else { matched.a.clone() };
    let places = Places::of([&moved, &matched.b])?;
    causes.extend(joints::causes(&places, &b.name, base.is_some()));
    causes.extend(rotors::causes(&matched, &b.name));
    let (of_bodies, mut notes) = merged::causes(&matched, &places, [a, b])?;
    let of_frames = frames::causes(&places, &b.name);
    notes.extend(frames::notes(&matched, [&one, &two], [&a.name, &b.name])?);
    causes.extend(of_bodies);
    if let Some(names) = exchanged {
        let sentence = format!("{} has the names of `{}` and `{}` exchanged", b.name, names[0], names[1]);
        causes.push(Cause::new("names", &names[0].clone(), sentence, true, Change::Names(names)));
    }
    let after = trial::tried(&mut causes, &states_of, &matched.a, [&mine, &theirs]);
    let there = |name: &str| matched.joint_there(name).to_string();
    causes.extend(of_frames);
    let (of_limits, unheld) = joints::silent(&one, &two, &there, [a, b]);
    causes.extend(of_limits);
    notes.extend(unheld);
    causes.extend(constraints::causes([&one, &two], &there, [&a.name, &b.name])?);
    let (of_starts, states_alone) = starts::compared(&matched, [a, b], base.is_none())?;
    causes.extend(of_starts);
    notes.extend(states_alone);
    let (compensated, of_actuators) = actuation::compared([a, b]);
    causes.extend(compensated);
    notes.extend(of_actuators);
    let is_link = |robot: &mozzi::Description, name: &str| robot.links.iter().any(|link| link.name == name);
    notes.extend(shapes::notes([a, b], &|link| is_link(&one, link) && is_link(&two, link)));
    notes.extend(base_masses([&one, &two], [a, b])?);
    let rows = states_of.names().len();
    if rows == 0 && !(matched.only_a.is_empty() && matched.only_b.is_empty()) {
        (causes, notes) = (Vec::new(), Vec::new()); // nothing was compared
    }
    let common =
        matched.a.joints.iter().filter(|joint| joint.kind != mozzi::model::description::JointKind::Fixed).count();
    Ok(FilesComparison {
        names: [a.name.clone(), b.name.clone()],
        states,
        seed,
        tolerance,
        common,
        rows,
        renamed: matched.renamed,
        named: matched.named,
        links: matched.links,
        only: [matched.only_a, matched.only_b],
        base,
        before,
        after,
        causes,
        notes,
    })
}

/// The robot without its named states: they enter no force, and a free base's pose in them fits no fixed base.
fn without_states(file: &RobotFile) -> mozzi::Description {
    let mut robot = file.model.description().clone();
    (robot.states, robot.start) = (Vec::new(), None);
    robot
}

/// A note if the bases differ in mass, which no force shows while they are fixed.
fn base_masses(robots: [&mozzi::Description; 2], files: [&RobotFile; 2]) -> Result<Option<String>> {
    let mass = |robot: &mozzi::Description| -> Result<f64> {
        let model = robot.clone().build()?;
        let bodies = model.folded_links();
        Ok(bodies.iter().filter(|body| body.joint.is_none()).flat_map(|body| &body.links).map(|(_, mass)| mass).sum())
    };
    let [x, y] = [mass(robots[0])?, mass(robots[1])?];
    let differs = robots[0].base == mozzi::Base::Fixed && (x - y).abs() > 1e-5 * x.abs().max(y.abs());
    Ok(differs.then(|| {
        let [one, two] = files.map(|file| &file.name);
        format!("the base has {} kg in {two}, {} kg in {one}: no force shows it while it is fixed", shown(y), shown(x))
    }))
}

impl FilesComparison {
    /// Whether there was something to compare: a joint that moves in both, or a base that floats in both. True if
    /// neither has a joint.
    pub fn is_compared(&self) -> bool {
        self.rows > 0 || self.has_same_joints()
    }

    fn has_same_joints(&self) -> bool {
        self.only.iter().all(Vec::is_empty)
    }

    /// Whether M and all forces agree to the tolerance.
    pub fn forces_agree(&self) -> bool {
        agree(&self.before, self.tolerance) && self.base.is_none() && self.is_compared()
    }

    /// Whether the files describe the same robot: the same moving joints, limits, couplings and constraints, and the
    /// same places, starts and forces to the tolerance.
    pub fn agrees(&self) -> bool {
        let is_small = |cause: &Cause| cause.size <= self.tolerance;
        self.forces_agree() && self.has_same_joints() && self.causes.iter().all(is_small)
    }

    /// Whether the causes make the difference vanish, and each has a reason.
    pub fn is_explained(&self) -> bool {
        self.is_compared() && self.is_accounted_for() && self.causes.iter().all(|cause| cause.has_reason)
    }

    /// Whether the causes make the difference vanish, with or without reasons.
    pub(super) fn is_accounted_for(&self) -> bool {
        agree(&self.after, self.tolerance.max(1e-9))
    }

    /// "limits and damping", if robots of the same masses and geometry differ in these alone.
    pub(super) fn differing_kinds(&self) -> Option<String> {
        const KINDS: [(&str, &str); 9] = [
            ("limits", "limits"),
            ("mimic", "mimic joints"),
            ("constraint", "constraints"),
            ("damping", "damping"),
            ("friction", "friction"),
            ("stiffness", "stiffness"),
            ("spring", "springs"),
            ("start", "starts"),
            ("state", "named states"),
        ];
        let is_rest_same = self.is_compared() && self.has_same_joints() && self.base.is_none();
        if !is_rest_same || !agree_at_rest(&self.before, self.tolerance) || !self.is_accounted_for() {
            return None;
        }
        let is_of = |cause: &Cause| KINDS.iter().any(|(kind, _)| *kind == cause.kind);
        let mut words: Vec<&str> = (KINDS.iter())
            .filter(|(kind, _)| self.causes.iter().any(|cause| cause.kind == *kind))
            .map(|(_, words)| *words)
            .collect();
        let last = words.pop().filter(|_| self.causes.iter().all(is_of))?;
        Some(if words.is_empty() { last.to_string() } else { format!("{} and {last}", words.join(", ")) })
    }

    /// The causes in words, in the order of the report.
    pub fn causes(&self) -> impl Iterator<Item = &str> {
        self.causes.iter().map(|cause| cause.sentence.as_str())
    }

    /// The report as text.
    pub fn text(&self) -> String {
        report::text(self)
    }

    /// The report as JSON.
    pub fn json(&self) -> Value {
        report::json(self)
    }
}
