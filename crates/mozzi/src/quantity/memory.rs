//! Memory for any quantity.

use crate::lie::SE3;
use crate::linalg::{Vec3, ldlt::Pattern};
use crate::model::{Model, TaskMemory, Workspace};
use crate::scalar::Scalar;
use crate::spatial::{Twist, Wrench};
use alloc::vec;
use alloc::vec::Vec;

/// Memory without meaning between calls: the kernels' [`Workspace`], and what their results are gathered in. What a quantity
/// needs beyond that grows at its first call; later calls allocate nothing.
#[derive(Clone, Debug)]
pub struct Memory<S = f64> {
    /// The kernels' own.
    pub workspace: Workspace<S>,
    pub(crate) zeros: Vec<S>,
    pub(crate) twists: Vec<Twist<S>>,
    pub(crate) wrenches: Vec<Wrench<S>>,
    pub(crate) poses: Vec<SE3<S>>,
    pub(crate) matrix: Vec<S>,
    pub(crate) vector: Vec<S>,
    /// Of n × n without zeros.
    pub(crate) dense: Option<Pattern>,
    pub(crate) task: Option<(usize, TaskMemory<S>)>,
    /// In place of the query's point, for the next call.
    pub(crate) point: Option<Vec3<S>>,
}

impl<S: Scalar> Memory<S> {
    /// Memory for this model.
    pub fn new<C: Scalar>(model: &Model<C>) -> Self {
        Memory {
            workspace: Workspace::new(model),
            zeros: vec![S::zero(); model.nq()],
            twists: Vec::new(),
            wrenches: Vec::new(),
            poses: Vec::new(),
            matrix: Vec::new(),
            vector: Vec::new(),
            dense: None,
            task: None,
            point: None,
        }
    }

    /// The next call is about this point of {s} instead of the query's: one that is no constant.
    pub fn with_point(mut self, point: Vec3<S>) -> Self {
        self.point = Some(point);
        self
    }

    /// What the last call divided by: the pivots of the mass matrix, and those of a task's Λ⁻¹.
    pub fn pivots(&self) -> impl Iterator<Item = &[S]> {
        core::iter::once(&self.workspace.pivots[..]).chain(self.task.iter().map(|(_, task)| &task.pivots[..]))
    }

    /// What the last task-space dynamics found on its way.
    pub fn task(&self) -> Option<&TaskMemory<S>> {
        self.task.as_ref().map(|(_, task)| task)
    }

    /// Every number NaN: a test that results do not depend on what is here.
    pub fn fill_nan(&mut self) {
        let nan = S::from_f64(f64::NAN);
        self.workspace.fill_nan();
        self.twists.fill(Twist::from_array([nan; 6]));
        self.wrenches.fill(Wrench::from_array([nan; 6]));
        self.poses.fill(SE3::identity().map(|_: S| nan));
        self.matrix.fill(nan);
        self.vector.fill(nan);
        if let Some((_, task)) = &mut self.task {
            task.fill_nan();
        }
    }
}

/// The first numbers of a list, which grows where it is too short.
#[inline(always)]
pub(crate) fn sized<T: Clone>(list: &mut Vec<T>, length: usize, fill: T) -> &mut [T] {
    if list.len() < length {
        list.resize(length, fill);
    }
    &mut list[..length]
}

/// A matrix of six rows from its columns.
#[inline(always)]
pub(crate) fn by_rows<S: Scalar>(columns: impl ExactSizeIterator<Item = [S; 6]>, output: &mut [S]) {
    let n = columns.len();
    for (j, column) in columns.enumerate() {
        for (row, entry) in column.into_iter().enumerate() {
            output[row * n + j] = entry;
        }
    }
}
