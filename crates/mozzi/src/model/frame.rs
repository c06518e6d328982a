//! Named frames: every link of the file, folded or not, and every frame that was added.

use super::{Error, Model};
use crate::lie::SE3;
use crate::scalar::{Real, Scalar};
use alloc::string::ToString;
use alloc::vec::Vec;

/// Handle of a named frame, valid for one model only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FrameId(pub(crate) usize);

impl FrameId {
    /// The frame's index among those of its model.
    pub fn index(self) -> usize {
        self.0
    }
}

/// A frame fixed to a link.
#[derive(Clone, Copy, Debug)]
pub struct Frame<C = f64> {
    /// Slot of the moving link that carries it; 0 for the base.
    pub(crate) slot: usize,
    /// Its configuration in that link's normal frame.
    pub(crate) T: SE3<C>,
}

impl<C: Scalar> Frame<C> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn lift<S: Scalar + From<C>>(&self) -> Frame<S> {
        Frame { slot: self.slot, T: self.T.map(S::from) }
    }
}

impl<C: Scalar> Model<C> {
    /// The frame of this name: a link of the file, or a frame that was added.
    ///
    /// # Errors
    /// [`Error::NoSuchFrame`] with the names that exist.
    pub fn frame(&self, name: &str) -> Result<FrameId, Error> {
        self.frames().find(|(_, known)| *known == name).map(|(id, _)| id).ok_or_else(|| Error::NoSuchFrame {
            name: name.to_string(),
            known: self.frames().map(|(_, name)| name.to_string()).collect(),
        })
    }

    /// All frames with their names: the links in the order of the file, then the added ones.
    pub fn frames(&self) -> impl ExactSizeIterator<Item = (FrameId, &str)> {
        (0..self.frames.len()).map(|k| (FrameId(k), self.frame_name(FrameId(k))))
    }

    /// The name of a frame.
    pub fn frame_name(&self, frame: FrameId) -> &str {
        let (description, k) = (self.description(), frame.0);
        let links = description.links.len();
        if k < links { &description.links[k].name } else { &description.frames[k - links].name }
    }

    /// The end-effector frame: the one set in the description; else the leaf that is named as a tool (`tool0`, `tcp`,
    /// `ee_link`, `end_effector`, alone or after a prefix; the first of these words, if all so named have one origin);
    /// else the only leaf of a serial chain, or the first of equal frames.
    ///
    /// # Errors
    /// [`Error::NoEndEffector`] with the candidates if the robot branches and none of these is one frame.
    pub fn end_effector(&self) -> Result<FrameId, Error> {
        self.structure.end_effector.ok_or_else(|| Error::NoEndEffector {
            leaves: self.structure.leaves.iter().map(|&leaf| self.frame_name(leaf).to_string()).collect(),
        })
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn frame_at<S: Scalar + From<C>>(&self, frame: FrameId) -> Frame<S> {
        self.frames[frame.0].lift()
    }
}

/// Leaves may be this far apart to have one origin, m.
const APART: f64 = 1e-9;

/// Names by which robots' files mark the tool's frame, alone or after a prefix: `tool0`, `panda_hand_tcp`.
const TOOLS: [&str; 4] = ["tool0", "tcp", "ee_link", "end_effector"];

/// The rank of a name in `TOOLS`.
fn tool_rank(name: &str) -> Option<usize> {
    let is_word_after = |prefix: &str| !prefix.ends_with(char::is_alphanumeric);
    TOOLS.iter().position(|tool| name.strip_suffix(*tool).is_some_and(is_word_after))
}

/// The end effector of a robot with these leaves: the one that is named as a tool, if all that are so named have one
/// origin on one moving link; else the leaves' only frame.
pub(super) fn last_frame<'n, C: Real>(
    leaves: &[FrameId],
    frames: &[Frame<C>],
    name: impl Fn(usize) -> &'n str,
) -> Option<FrameId> {
    let is_near = |a: C, b: C| (a - b).abs() < C::from_f64(APART);
    let all_near = |a: &[C], b: &[C]| a.iter().zip(b).all(|(&a, &b)| is_near(a, b));
    let of = |leaf: &FrameId| &frames[leaf.0];
    let share = |a: &FrameId, b: &FrameId| of(a).slot == of(b).slot && all_near(&of(a).T.p.0, &of(b).T.p.0);
    let tools: Vec<FrameId> = leaves.iter().copied().filter(|leaf| tool_rank(name(leaf.0)).is_some()).collect();
    if let Some(tool) = tools.iter().min_by_key(|leaf| tool_rank(name(leaf.0))) {
        return tools.iter().all(|other| share(tool, other)).then_some(*tool);
    }
    let (first, rows) = (*leaves.first()?, |leaf: &FrameId| of(leaf).T.to_matrix().concat());
    let is_equal = |leaf: &FrameId| share(&first, leaf) && all_near(&rows(leaf), &rows(&first));
    leaves.iter().all(is_equal).then_some(first)
}
