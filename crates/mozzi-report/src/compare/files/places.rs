//! Where the second robot has what the first one has at home. A joint is at fault if its parent and its child, or its
//! axis, are not carried alike; what it carries is compared as if it were where the first robot has it.

use super::inertia::{Body, entries, size};
use super::matching::twin;
use super::number::length;
use crate::compare::Result;
use crate::compare::constants::home;
use mozzi::model::description::{Joint, JointKind};
use mozzi::{Base, Description, Mat3, SE3, SO3, SpatialInertia, Sym3, Twist, Vec3};
use std::collections::BTreeMap;

/// Both robots with their links' poses at home.
pub struct Places<'d> {
    pub robots: [&'d Description; 2],
    pub homes: [BTreeMap<String, SE3>; 2],
    /// The joint that moves each link, if one does.
    carriers: [BTreeMap<String, String>; 2],
    /// For each link of the first robot, the motion that takes its body from there to where the second robot has it.
    shifts: BTreeMap<&'d str, SE3>,
}

fn close(x: f64, y: f64) -> bool {
    (x - y).abs() <= 1e-9 * (1.0 + x.abs())
}

pub fn same_place(x: SE3, y: SE3) -> bool {
    (0..4).all(|i| (0..4).all(|j| close(x.to_matrix()[i][j], y.to_matrix()[i][j])))
}

pub fn same_screw(x: [f64; 6], y: [f64; 6]) -> bool {
    x.iter().zip(y).all(|(x, y)| close(*x, y))
}

/// The axis or the centre of a joint whose child's frame is at `T`.
pub fn screw(kind: JointKind, T: SE3) -> [f64; 6] {
    match kind {
        JointKind::Screw(A) => A.transformed(T).twist().to_array(),
        JointKind::Ball(center) => Twist { w: Vec3::zero(), v: T * center }.to_array(),
        _ => [0.0; 6],
    }
}

/// How far apart two places are: lengths as a part of 1 m or of the larger distance, and angles.
pub fn distance(p: SE3, q: SE3) -> f64 {
    ((p.p - q.p).norm() / (1.0 + p.p.norm())).max((p.R.inverse() * q.R).log().norm())
}

/// How far apart two axes are.
pub fn apart(x: [f64; 6], y: [f64; 6]) -> f64 {
    x.iter().zip(y).map(|(x, y)| (x - y).abs() / (1.0 + x.abs())).fold(0.0, f64::max)
}

/// The ratio of two origins of the same direction in other units.
pub fn unit(a: Vec3, b: Vec3) -> Option<f64> {
    let ratio = b.norm() / a.norm();
    length(ratio)?;
    let is_along = (a * (1.0 / a.norm()) - b * (1.0 / b.norm())).norm() <= 1e-9;
    is_along.then_some(ratio)
}

/// The weight of an error: 0 of one that no rounding gives, −6 of none.
fn weight(error: f64) -> f64 {
    error.clamp(1e-9, 1e-3).log10() + 3.0
}

impl<'d> Places<'d> {
    pub fn of(robots: [&'d Description; 2]) -> Result<Self> {
        let carriers = |robot: &Description| -> Result<BTreeMap<String, String>> {
            let model = robot.clone().build()?;
            let bodies = model.folded_links();
            let moved = bodies.iter().filter_map(|body| Some((body.joint?, &body.links)));
            Ok(moved
                .flat_map(|(joint, links)| links.iter().map(move |(link, _)| (link.to_string(), joint.to_string())))
                .collect())
        };
        let [a, b] = robots;
        let (homes, carriers) = ([home(a)?, home(b)?], [carriers(a)?, carriers(b)?]);
        let mut places = Places { robots, homes, carriers, shifts: BTreeMap::new() };
        let mut open = vec![(root(a), places.of_root())];
        while let Some((link, shift)) = open.pop() {
            places.shifts.insert(link, shift);
            let next = a.joints.iter().filter(|joint| joint.parent == link);
            open.extend(next.map(|joint| (joint.child.as_str(), places.of_child(joint, shift))));
        }
        Ok(places)
    }

    /// The motion of a link's body; that of the root for a link that the first robot lacks.
    pub fn shift(&self, link: &str) -> SE3 {
        let known = |link: &str| self.shifts.get(link).copied();
        known(link).or_else(|| known(root(self.robots[0]))).unwrap_or_else(SE3::identity)
    }

    /// Where the first robot would have a link or a frame of the second one.
    pub fn seen(&self, name: &str) -> Option<SE3> {
        let two = self.robots[1];
        let of_frame = two.frames.iter().find(|frame| frame.name == name).map(|frame| frame.link.as_str());
        let mut link = of_frame.unwrap_or(name);
        while !self.shifts.contains_key(link) {
            let Some(up) = two.joints.iter().find(|joint| joint.child == link) else { break };
            link = &up.parent;
        }
        self.homes[1].get(name).map(|T| self.shift(link).inverse() * *T)
    }

    /// The joint that moves a link.
    pub fn carrier(&self, k: usize, link: &str) -> Option<&str> {
        self.carriers[k].get(link).map(String::as_str)
    }

    /// A root of the same name is at the same place. Another one stands where the first joints agree best.
    fn of_root(&self) -> SE3 {
        let [a, b] = self.robots;
        let here = root(a);
        if here == root(b) || a.base == Base::Floating {
            return SE3::identity();
        }
        let moves = |joint: &&Joint| joint.kind != JointKind::Fixed && self.carrier(0, &joint.parent).is_none();
        let pairs = a.joints.iter().filter(moves).filter_map(|joint| {
            let there = twin(joint, b)?;
            let is_one = joint.parent == there.parent || same_place(joint.origin, there.origin);
            let homes = [self.homes[0].get(&joint.parent)?, self.homes[1].get(&there.parent)?];
            is_one.then_some((homes[0], homes[1]))
        });
        let own = a.links.iter().filter(|link| [0, 1].iter().all(|k| self.carrier(*k, &link.name).is_none()));
        let links = own.filter_map(|link| Some((self.homes[0].get(&link.name)?, self.homes[1].get(&link.name)?)));
        let all = pairs.chain(links).map(|(here, there)| *there * here.inverse());
        least(all.chain([SE3::identity()]).map(|T| (self.carried(here, T), T)))
    }

    /// The motion of a joint's child: its parent's, or what makes the links' frames or the inertias equal.
    fn of_child(&self, joint: &Joint, parent: SE3) -> SE3 {
        let Some(there) = twin(joint, self.robots[1]) else { return parent };
        let same_frames = self.homes[1][&there.child] * self.homes[0][&joint.child].inverse();
        if same_place(same_frames, parent) {
            return parent;
        }
        let is_fixed = joint.kind == JointKind::Fixed && there.kind == JointKind::Fixed;
        let axis = |T: SE3| if is_fixed { 0.0 } else { self.axis_error(joint, there, T) };
        let is_unit = unit(joint.origin.p, there.origin.p).is_some();
        let cost = |T: SE3| {
            let own = weight(axis(parent).max(distance(T, parent))) / 2.0;
            let known = if is_unit && same_place(T, same_frames) { weight(0.0) * 0.6 } else { 0.0 };
            own + known + weight(axis(T)) + self.carried(&joint.child, T)
        };
        let own = [same_frames, parent].map(|T| (cost(T) + self.inertia_weight(&joint.child, &there.child, T), T));
        // their inertias agree by construction
        let turns = self.turns(&joint.child, &there.child).into_iter().map(|T| (cost(T), T));
        least(own.into_iter().chain(turns))
    }

    fn axis_error(&self, joint: &Joint, there: &Joint, T: SE3) -> f64 {
        if joint.kind.name() != there.kind.name() {
            return 1.0;
        }
        let [p, q] = [T * self.homes[0][&joint.child], self.homes[1][&there.child]];
        match joint.kind {
            JointKind::Fixed => distance(p, q),
            _ => apart(screw(joint.kind, p), screw(there.kind, q)),
        }
    }

    /// How well the joints on a link agree, behind joints that the second robot lacks, too.
    fn carried(&self, link: &str, T: SE3) -> f64 {
        let next = self.robots[0].joints.iter().filter(|joint| joint.parent == link);
        next.map(|joint| match twin(joint, self.robots[1]) {
            Some(there) => weight(self.axis_error(joint, there, T)),
            None if joint.kind == JointKind::Fixed => self.carried(&joint.child, T),
            None => 0.0,
        })
        .sum()
    }

    /// A link's inertia in both worlds.
    fn inertias(&self, here: &str, there: &str) -> [SpatialInertia; 2] {
        [(0, here), (1, there)].map(|(k, name)| {
            let link = self.robots[k].links.iter().find(|link| link.name == name);
            link.map_or_else(SpatialInertia::zero, |link| link.inertia.transformed(self.homes[k][name]))
        })
    }

    fn inertia_weight(&self, here: &str, there: &str, T: SE3) -> f64 {
        let [a, b] = self.inertias(here, there);
        if a == SpatialInertia::zero() && b == SpatialInertia::zero() {
            return 0.0;
        }
        let [x, y] = [Body::of(a.transformed(T)), Body::of(b)];
        let scale = size(x.I).max(size(y.I));
        let moments = entries(x.I).iter().zip(entries(y.I)).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        let error = ((x.m - y.m).abs() / x.m.abs().max(y.m.abs())).max((x.c - y.c).norm() / (1.0 + x.c.norm()));
        weight(if scale > 0.0 { error.max(moments / scale) } else { error })
    }

    /// The motions that take a link's principal axes and centre of mass to those of the other.
    fn turns(&self, here: &str, there: &str) -> Vec<SE3> {
        let [x, y] = self.inertias(here, there).map(Body::of);
        let axes = |I: Sym3| {
            let rows = I.to_mat3().rows();
            let eigen = nalgebra::Matrix3::from_fn(|i, j| rows[i][j]).symmetric_eigen();
            let mut order = [0, 1, 2];
            order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
            let R = nalgebra::Matrix3::from_fn(|i, j| eigen.eigenvectors[(i, order[j])]);
            (order.map(|k| eigen.eigenvalues[k]), if R.determinant() < 0.0 { -R } else { R })
        };
        let ((moments, P), (others, Q)) = (axes(x.I), axes(y.I));
        let most = moments[2].abs();
        let is_near = |x: f64, y: f64| (x - y).abs() <= 1e-5 * most;
        let is_same = moments.iter().zip(others).all(|(x, y)| is_near(*x, y));
        if !is_same || is_near(moments[0], moments[1]) || is_near(moments[1], moments[2]) {
            return Vec::new();
        }
        let signs = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
        let turn = |signs: [f64; 3]| {
            let R = Q * nalgebra::Matrix3::from_diagonal(&signs.into()) * P.transpose();
            let rows = core::array::from_fn(|i| core::array::from_fn(|j| R[(i, j)]));
            let R = SO3::from_matrix(Mat3::from_rows(rows)).ok()?;
            Some(SE3::new(R, y.c - R * x.c))
        };
        signs.into_iter().filter_map(turn).collect()
    }
}

/// The first motion of the least cost.
fn least(costs: impl Iterator<Item = (f64, SE3)>) -> SE3 {
    costs.reduce(|best, next| if next.0 < best.0 - 1e-6 { next } else { best }).map_or(SE3::identity(), |(_, T)| T)
}

/// The link that no joint moves.
fn root(robot: &Description) -> &str {
    let is_root = |name: &str| robot.joints.iter().all(|joint| joint.child != name);
    robot.links.iter().find(|link| is_root(&link.name)).map_or("", |link| link.name.as_str())
}
