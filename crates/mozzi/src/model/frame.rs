//! Named frames: every link of the file, folded or not, and every frame that was added.

use super::{Error, Model};
use crate::lie::SE3;
use crate::scalar::{Real, Scalar};
use alloc::string::ToString;

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

    /// The end-effector frame: the one set in the description, or the only leaf of a serial chain. Leaves of one origin
    /// on one moving link are no ambiguity: `tool0` of a ROS robot before its `ee_link`; of equal frames, the first.
    ///
    /// # Errors
    /// [`Error::NoEndEffector`] with the candidates if the robot branches and no end effector is set.
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

/// The end effector of a robot with these leaves, if they are one, or are in one place.
pub(super) fn last_frame<'n, C: Real>(
    leaves: &[FrameId],
    frames: &[Frame<C>],
    name: impl Fn(usize) -> &'n str,
) -> Option<FrameId> {
    let first = *leaves.first()?;
    let is_near = |a: C, b: C| (a - b).abs() < C::from_f64(APART);
    let all_near = |a: &[C], b: &[C]| a.iter().zip(b).all(|(&a, &b)| is_near(a, b));
    let at = &frames[first.0];
    let has_its_origin = |leaf: &&FrameId| frames[leaf.0].slot == at.slot && all_near(&frames[leaf.0].T.p.0, &at.T.p.0);
    if leaves.iter().filter(has_its_origin).count() < leaves.len() {
        return None;
    }
    let rows = |T: SE3<C>| T.to_matrix().concat();
    let is_equal = |leaf: &&FrameId| all_near(&rows(frames[leaf.0].T), &rows(at.T));
    match leaves.iter().find(|leaf| name(leaf.0) == "tool0") {
        Some(tool) => Some(*tool),
        None if leaves.iter().filter(is_equal).count() == leaves.len() => Some(first),
        None => None,
    }
}
