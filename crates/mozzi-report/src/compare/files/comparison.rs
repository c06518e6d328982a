//! The comparison of two files.

use super::cause::Cause;
use super::forces::{Gaps, States, agree};
use super::matching::matched;
use super::{RobotFile, joints, merged, report};
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
    pub(super) renamed: Vec<(String, String)>,
    pub(super) only: [Vec<String>; 2],
    /// A sentence about the base, if it is floating in one file only.
    pub(super) base: Option<String>,
    /// As the files are, and with all causes accounted for.
    pub(super) before: Gaps,
    pub(super) after: Gaps,
    pub(super) units: [String; 3],
    pub(super) causes: Vec<Cause>,
}

/// Compares two files of a robot at random states within the first one's limits. `tolerance` is the largest accepted
/// difference of M and of the forces, as a part of the largest of them.
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
    let (mut one, mut two) = (a.model.description().clone(), b.model.description().clone());
    let base = (one.base != two.base).then(|| {
        let free = if one.base == mozzi::Base::Floating { &a.name } else { &b.name };
        (one.base, two.base) = (mozzi::Base::Fixed, mozzi::Base::Fixed);
        format!("the base is free in {free} only; compared with a fixed base")
    });
    let matched = matched(&one, &two)?;
    let states_of = States::random(&one, &matched.a, states, seed)?;
    let (mine, theirs) = (states_of.numbers(&matched.a)?, states_of.numbers(&matched.b)?);
    let before = states_of.gaps(&mine, &theirs);
    let mut causes = joints::causes(&matched, &b.name)?;
    causes.extend(merged::causes(&matched, [a, b])?);
    let mut accounted = matched.a.clone();
    causes.iter().for_each(|cause| cause.change.apply(&mut accounted));
    let after = match states_of.numbers(&accounted) {
        Ok(accounted) => states_of.gaps(&accounted, &theirs),
        Err(_) => before.clone(), // a robot that cannot be built explains nothing
    };
    for cause in &mut causes {
        let mut robot = matched.a.clone();
        cause.change.apply(&mut robot);
        let Ok(changed) = states_of.numbers(&robot) else { continue };
        cause.effect = report::effect(&states_of, &states_of.gaps(&mine, &changed));
    }
    let there = |name: &str| {
        let renamed = matched.renamed.iter().find(|(here, _)| here == name);
        renamed.map_or_else(|| name.to_string(), |(_, there)| there.clone())
    };
    causes.extend(joints::silent(&one, &two, &there, &b.name));
    let common =
        matched.a.joints.iter().filter(|joint| joint.kind != mozzi::model::description::JointKind::Fixed).count();
    let units = [0, 1, 2].map(|k| before[k].joints.first().map_or("N m", |joint| states_of.unit(joint)).to_string());
    Ok(FilesComparison {
        names: [a.name.clone(), b.name.clone()],
        states,
        seed,
        tolerance,
        common,
        renamed: matched.renamed,
        only: [matched.only_a, matched.only_b],
        base,
        before,
        after,
        units,
        causes,
    })
}

impl FilesComparison {
    /// Whether M and all forces agree to the tolerance.
    pub fn forces_agree(&self) -> bool {
        agree(&self.before, self.tolerance) && self.base.is_none()
    }

    /// Whether the files describe the same robot: the same moving joints, limits and couplings, and the same forces to
    /// the tolerance.
    pub fn agrees(&self) -> bool {
        let is_silent = |cause: &Cause| !matches!(cause.change, super::cause::Change::NoForce);
        self.forces_agree() && self.only.iter().all(Vec::is_empty) && self.causes.iter().all(is_silent)
    }

    /// Whether the causes make the difference vanish, and each has a reason.
    pub fn is_explained(&self) -> bool {
        agree(&self.after, self.tolerance.max(1e-9)) && self.causes.iter().all(|cause| cause.has_reason)
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
