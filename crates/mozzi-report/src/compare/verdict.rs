//! Checks whether a library agrees and, if not, which causes make the difference vanish.

use crate::compare::Result;
use crate::compare::answer::{Answer, Robot};
use crate::compare::cause::{Cause, suspects};
use crate::compare::numbers::{Entry, Errors, Pair, Side};
use crate::compare::question::Question;
use mozzi::Description;

/// A cause, and the errors if all causes but this one are accounted for.
#[derive(Clone, Debug)]
pub struct Found {
    pub cause: Cause,
    pub without: Errors,
}

/// The result of a comparison with a library that loaded the robot.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// Before accounting for causes, on the joints that both have.
    pub before: Errors,
    /// After accounting for the causes.
    pub after: Errors,
    pub causes: Vec<Found>,
    /// Joints that move only in the library, with their velocities; held at 0.
    pub extra: Vec<(String, usize)>,
    /// The first entry that still differs.
    pub first: Option<Entry>,
    /// mozzi's indices of the joints in the library's order, if the orders differ.
    pub order: Option<Vec<usize>>,
}

impl Verdict {
    pub fn agrees(&self) -> bool {
        self.before.agree() && self.causes.is_empty() && self.extra.is_empty()
    }

    /// True if it agrees, or differs for known reasons.
    pub fn is_explained(&self) -> bool {
        self.after.agree() && self.causes.iter().all(|found| found.cause.is_explanation())
    }
}

/// Tests the causes together, then drops those that make no difference. `coupled`: see [`suspects`].
pub fn judge(
    robot: &Description,
    question: &Question,
    answer: &Answer,
    from: &Robot,
    coupled: bool,
) -> Result<Verdict> {
    let with = |causes: &[&Cause]| -> Result<(Side, Side)> {
        let (mut robot, mut theirs) = (robot.clone(), from.side.clone());
        causes.iter().try_for_each(|cause| cause.apply(&mut robot, &mut theirs, from))?;
        Ok((Side::of(&robot, question, answer.library)?, theirs))
    };
    let errors = |causes: &[&Cause]| -> Errors {
        match with(causes) {
            Ok((mine, theirs)) => Pair::new(&mine, &theirs, question).errors(),
            Err(_) => Errors([f64::NAN; 4]), // a robot that mozzi cannot build explains nothing
        }
    };
    let all = suspects(robot, answer, from, coupled)?;
    let (mine, theirs) = with(&[])?;
    let before = Pair::new(&mine, &theirs, question).errors();
    let is_structure = |cause: &Cause| matches!(cause, Cause::Mimics(_) | Cause::Held(_));
    let mut kept: Vec<&Cause> = all.iter().collect();
    let mut after = errors(&kept);
    if !after.agree() {
        // a free body may have another home pose but the same dynamics: then its place is no cause
        let known: Vec<&Cause> = kept.iter().copied().filter(|cause| cause.is_explanation()).collect();
        let errors = errors(&known);
        if errors.agree() {
            (kept, after) = (known, errors);
        }
    }
    // explanations are kept in preference: a body that only differs, without a reason, is dropped if a known reason
    // suffices
    let mut droppable: Vec<&Cause> = kept.iter().copied().filter(|cause| !is_structure(cause)).collect();
    droppable.sort_by_key(|cause| cause.is_explanation());
    if after.agree() {
        for cause in droppable {
            let fewer: Vec<&Cause> = kept.iter().copied().filter(|other| !std::ptr::eq(*other, cause)).collect();
            let errors = errors(&fewer);
            if errors.agree() {
                (kept, after) = (fewer, errors);
            }
        }
    }
    let found = |cause: &&Cause| {
        let others: Vec<&Cause> = kept.iter().copied().filter(|other| !std::ptr::eq(*other, *cause)).collect();
        Found { cause: (*cause).clone(), without: errors(&others) }
    };
    let causes: Vec<Found> = kept.iter().map(found).collect();
    let first = match with(&kept) {
        Ok((mine, theirs)) => Pair::new(&mine, &theirs, question).first(),
        Err(_) => Pair::new(&mine, &theirs, question).first(),
    };
    let joints = &from.constants.joints;
    let is_extra = |name: &String| !question.names.contains(name);
    let extra =
        joints.iter().filter(|joint| is_extra(&joint.name)).map(|joint| (joint.name.clone(), joint.nv)).collect();
    Ok(Verdict { before, after, causes, extra, first, order: order(question, from) })
}

/// mozzi's indices of the joints in the library's order.
fn order(question: &Question, from: &Robot) -> Option<Vec<usize>> {
    let names = from.constants.joints.iter().map(|joint| &joint.name);
    let order: Vec<usize> = names.filter_map(|name| question.names.iter().position(|known| known == name)).collect();
    (!order.is_sorted()).then_some(order)
}
