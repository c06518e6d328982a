//! Mimic joints, which have entries of their own in MuJoCo's lists: there they are joints that an equality ties.

use super::super::JointOrder;
use crate::model::{Error, Model};
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// A mimic joint: θ = ratio · θ_source + offset.
#[derive(Clone, Debug)]
pub(super) struct Follower {
    pub name: String,
    /// Its index in `qpos`.
    pub q: usize,
    /// Its index in `qvel`.
    pub v: usize,
    /// Its source joint's index in θ.
    pub theta: usize,
    /// Its source joint's index in θ̇.
    pub dtheta: usize,
    pub ratio: f64,
    pub offset: f64,
}

/// Those in a list of joint names, and the order of the other joints.
pub(super) fn split(model: &Model, names: &[&str]) -> Result<(JointOrder, Vec<Follower>), Error> {
    let source = |name: &str| {
        let mut moving = model.moving_joints().zip(model.sources());
        moving.find(|(joint, _)| joint.name == name && joint.mimic.is_some()).map(|(_, source)| source)
    };
    let sources: Vec<_> = names.iter().map(|name| source(name)).collect();
    let independent: Vec<&str> =
        names.iter().zip(&sources).filter(|(_, source)| source.is_none()).map(|(name, _)| *name).collect();
    let order = JointOrder::by_name(model, &independent)?;
    let first = order.places().len() - independent.len();
    let (base, joints) = order.places().split_at(first);
    let (mut q, mut v) = base.first().map_or((0, 0), |place| (place.freedom.positions(), place.freedom.velocities()));
    let (mut joints, mut followers) = (joints.iter(), Vec::new());
    for (k, source) in sources.iter().enumerate() {
        let Some(source) = source else {
            if let Some(place) = joints.next() {
                q += place.freedom.positions();
                v += place.freedom.velocities();
            }
            continue;
        };
        if names[..k].contains(&names[k]) {
            let found = format!("`{}`, a second time", names[k]);
            return Err(Error::BadArgument { what: "a joint name", found, expected: "each joint once" });
        }
        let place = model.places()[source.joint];
        let (ratio, offset) = (source.ratio, source.offset);
        followers.push(Follower { name: names[k].into(), q, v, theta: place.q, dtheta: place.j, ratio, offset });
        q += 1;
        v += 1;
    }
    Ok((order, followers))
}

/// The entries of a list that are not a follower's.
pub(super) fn without(followers: &[Follower], at: impl Fn(&Follower) -> usize, list: &[f64]) -> Vec<f64> {
    let mut places = followers.iter().map(at).peekable();
    let is_kept = |k: &usize| places.next_if_eq(k).is_none();
    (0..list.len()).filter(is_kept).map(|k| list[k]).collect()
}

/// A list with the followers' entries added.
pub(super) fn with(
    followers: &[Follower],
    at: impl Fn(&Follower) -> usize,
    value: impl Fn(&Follower) -> f64,
    list: DVector<f64>,
) -> DVector<f64> {
    if followers.is_empty() {
        return list;
    }
    let mut list: Vec<f64> = list.iter().copied().collect();
    followers.iter().for_each(|follower| list.insert(at(follower), value(follower)));
    DVector::from_vec(list)
}

/// G of `qvel` = G ν, where ν are the velocities without the followers'.
pub(super) fn couplings(followers: &[Follower], order: &JointOrder) -> DMatrix<f64> {
    let n = order.n();
    let mut G = DMatrix::zeros(n + followers.len(), n);
    let is_follower = |row: &usize| followers.iter().any(|follower| follower.v == *row);
    (0..n + followers.len()).filter(|row| !is_follower(row)).enumerate().for_each(|(k, row)| G[(row, k)] = 1.0);
    for follower in followers {
        (0..n).filter(|&k| order.velocity(k) == follower.dtheta).for_each(|k| G[(follower.v, k)] = follower.ratio);
    }
    G
}
