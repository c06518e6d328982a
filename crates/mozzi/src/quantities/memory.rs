//! Memory for any quantity.

use crate::lie::SE3;
use crate::linalg::{Vec3, ldlt::Pattern};
use crate::model::{Model, TaskMemory};
use crate::scalar::Scalar;
use crate::spatial::{Twist, Wrench};
use crate::workspace::{ConstraintMemory, Workspace};
use alloc::vec;
use alloc::vec::Vec;

/// Scratch memory: the kernels' [`Workspace`] and buffers for their results; nothing in it survives a call. Buffers
/// grow at a quantity's first call; later calls do not allocate.
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
    /// The dense n × n pattern.
    pub(crate) dense: Option<Pattern>,
    /// Cached per number of task rows, most recent first.
    pub(crate) tasks: Vec<TaskMemory<S>>,
    pub(crate) constraints: Option<ConstraintMemory<S>>,
    /// Replaces the query's point in the next call.
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
            tasks: Vec::new(),
            constraints: None,
            point: None,
        }
    }

    /// Uses this reference point of {s} in the next call instead of the query's, which is constant.
    pub fn with_point(mut self, point: Vec3<S>) -> Self {
        self.point = Some(point);
        self
    }

    /// The pivots of the last call: of the mass matrix, and of a task's Λ⁻¹.
    pub fn pivots(&self) -> impl Iterator<Item = &[S]> {
        core::iter::once(&self.workspace.pivots[..]).chain(self.task().map(|task| &task.pivots[..]))
    }

    /// Intermediate results of the last task-space dynamics.
    pub fn task(&self) -> Option<&TaskMemory<S>> {
        self.tasks.first()
    }

    /// Sets every number to NaN, to test that results do not depend on old contents.
    pub fn fill_nan(&mut self) {
        let nan = S::from_f64(f64::NAN);
        self.workspace.fill_nan();
        self.twists.fill(Twist::from_array([nan; 6]));
        self.wrenches.fill(Wrench::from_array([nan; 6]));
        self.poses.fill(SE3::identity().map(|_: S| nan));
        self.matrix.fill(nan);
        self.vector.fill(nan);
        self.tasks.iter_mut().for_each(TaskMemory::fill_nan);
        if let Some(constraints) = &mut self.constraints {
            constraints.fill_nan();
        }
    }
}

/// The first `length` entries of a list, which grows if it is too short.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn sized<T: Clone>(list: &mut Vec<T>, length: usize, fill: T) -> &mut [T] {
    if list.len() < length {
        list.resize(length, fill);
    }
    &mut list[..length]
}

/// The six numbers of a twist or a wrench.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn six<S: Copy>(x: &[S]) -> [S; 6] {
    core::array::from_fn(|k| x[k])
}

/// A matrix of six rows from its columns.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn by_rows<S: Scalar>(columns: impl ExactSizeIterator<Item = [S; 6]>, output: &mut [S]) {
    let n = columns.len();
    for (j, column) in columns.enumerate() {
        for (row, entry) in column.into_iter().enumerate() {
            output[row * n + j] = entry;
        }
    }
}
