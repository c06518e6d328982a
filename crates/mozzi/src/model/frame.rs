//! Named frames: every link of the file, folded or not, and every frame that was added.

use super::{Error, Model};
use crate::lie::SE3;
use crate::scalar::Scalar;
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

    /// The end-effector frame: the one set in the description, or the only leaf of a serial chain.
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
