//! Rotations of some entries of lists and matrices.

use crate::lie::{SE3, SO3};
use crate::linalg::Vec3;
use crate::scalar::Scalar;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// A configuration relative to a frame at T, expressed in the frame in which T is given.
pub(super) fn seen(pose: [f64; 7], T: Option<SE3>) -> [f64; 7] {
    T.map_or(pose, |T| (T * SE3::from_pose(pose)).to_pose())
}

/// A quaternion as MuJoCo reads it: of length 1 (to the bit if it is, up to rounding), and no rotation if its length is
/// 0.
pub(super) fn normalized(q: [f64; 4]) -> [f64; 4] {
    /// MuJoCo's mjMINVAL.
    const LEAST: f64 = 1e-15;
    let length = Scalar::sqrt(q.iter().map(|x| x * x).sum::<f64>());
    if length < LEAST {
        return [1.0, 0.0, 0.0, 0.0];
    }
    if (length - 1.0).abs() > LEAST { q.map(|x| x / length) } else { q }
}

/// The inverse rotations.
pub(super) fn back(turns: Vec<(usize, SO3)>) -> Vec<(usize, SO3)> {
    turns.into_iter().map(|(at, R)| (at, R.inverse())).collect()
}

/// Multiplies the three entries from each index on by R.
pub(super) fn turned(mut list: DVector<f64>, turns: Vec<(usize, SO3)>) -> DVector<f64> {
    turn(list.as_mut_slice(), &turns);
    list
}

fn turn(list: &mut [f64], turns: &[(usize, SO3)]) {
    for &(at, R) in turns {
        let three = R * Vec3([list[at], list[at + 1], list[at + 2]]);
        list[at..at + 3].copy_from_slice(&three.0);
    }
}

/// Diag(R, I) M diag(R, I)ᵀ.
pub(super) fn congruent(mut M: DMatrix<f64>, turns: Vec<(usize, SO3)>) -> DMatrix<f64> {
    if turns.is_empty() {
        return M;
    }
    for _ in 0..2 {
        M.column_iter_mut().for_each(|mut column| turn(column.as_mut_slice(), &turns));
        M = M.transpose();
    }
    M
}
