//! The frame, task or point that a quantity refers to.

use crate::linalg::Vec3;
use crate::model::{FrameId, Task, TaskFrame};

/// The frame, task or point that a quantity refers to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Subject<'a> {
    /// The frame, if there is one.
    pub frame: Option<FrameId>,
    /// Coordinates of a task's twist and wrench.
    pub coordinates: TaskFrame,
    /// A task's rows of (ω_x, ω_y, ω_z, v_x, v_y, v_z).
    pub rows: &'a [usize],
    /// A point of {s}.
    pub point: Vec3,
}

impl Subject<'_> {
    /// The frame; [`Query::check`] ensures that there is one.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn frame(&self) -> FrameId {
        self.frame.expect("a frame: checked by Query::check")
    }
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn task(&self) -> Task<'_> {
        Task { frame: self.frame(), coordinates: self.coordinates, rows: self.rows }
    }
}
