//! The contact points that may touch a plane in a step. Bounding spheres exclude points that are far from every plane.
//! If many points of a body are near a plane, only a few count: the deepest, and those farthest from the ones before.

use super::{Impulses, Key};
use crate::contacts::{Contacts, Surface, Touch};
use alloc::collections::BTreeMap;
use alloc::vec::Vec;
use mozzi::kinematics::forward_kinematics;
use mozzi::linalg::Vec3;
use mozzi::model::ContactPoint;
use mozzi::model::FrameId;

/// Points of a body that touch a plane at once.
const MOST: usize = 8;
/// Points that do not touch act if they are nearer than this part of their body's size: else a long step would take its
/// upper side for a foot.
const SHARE: f64 = 2e-3;
/// The points of the last step act again, unless one is deeper by more than this, m, or others would leave no candidate
/// nearly as far from all that act: bodies at rest would stand on other points in each step.
const DEEPER: f64 = 1e-8;
const NEARER: f64 = 0.9;

/// The contact points of a frame, within a sphere.
pub(super) struct Cloud {
    frame: FrameId,
    /// Their numbers, and the sphere around each.
    points: Vec<(usize, Vec3, f64)>,
    center: Vec3,
    radius: f64,
}

/// A point that may touch, how deep it may come, and whether it acted in the last step.
struct Candidate {
    point: usize,
    touch: Touch,
    gap: f64,
    acted: bool,
}

/// The pairs of a point and a plane within reach.
#[derive(Default)]
pub(super) struct Near {
    /// Those that act. Those of a frame follow each other.
    pub acting: Vec<(usize, usize, Touch)>,
    /// Those that others of their body stand for.
    pub others: Vec<(usize, usize)>,
}

impl Cloud {
    /// One for each frame with points.
    pub fn all(contacts: &Contacts) -> Vec<Self> {
        let mut frames: BTreeMap<FrameId, Vec<usize>> = BTreeMap::new();
        for (k, point) in contacts.points.iter().enumerate() {
            frames.entry(point.frame).or_default().push(k);
        }
        let of_frame = |(frame, points): (FrameId, Vec<usize>)| {
            let at = |k: usize| contacts.points[k].center.0;
            let side = |i: usize, pick: fn(f64, f64) -> f64| points.iter().map(|&k| at(k)[i]).reduce(pick);
            let middle = |i| 0.5 * (side(i, f64::min).unwrap_or(0.0) + side(i, f64::max).unwrap_or(0.0));
            let center = Vec3([0, 1, 2].map(middle));
            let sizes = points.iter().map(|&k| &contacts.points[k]);
            let radius = sizes.map(|point| (point.center - center).norm() + point.radius()).fold(0.0, f64::max);
            let sphere = |k: usize| (k, contacts.points[k].center, contacts.points[k].radius());
            Cloud { frame, points: points.into_iter().map(sphere).collect(), center, radius }
        };
        frames.into_iter().map(of_frame).collect()
    }
}

impl Impulses<'_> {
    /// The pairs within reach at θ, or at the robot's next configuration at the time `then`; with their touch at θ.
    pub(super) fn near(&self, [t, then]: [f64; 2], theta: &[f64], next: &[f64]) -> Near {
        let (now, later) = (self.surfaces(t), self.surfaces(then));
        let mut found = Near::default();
        for cloud in &self.clouds {
            let [T, T_next] = [theta, next].map(|theta| forward_kinematics(self.model, theta, cloud.frame));
            for (plane, (surface, surface_next)) in now.iter().zip(&later).enumerate() {
                let is_pressed = |point: usize| self.pressed.contains(&(point, plane));
                let height = |surface: &Surface, at: Vec3| surface.height(at) - cloud.radius;
                let reach = if cloud.radius > 0.0 { self.reach.min(SHARE * cloud.radius) } else { self.reach };
                let nearest = height(surface, T * cloud.center).min(height(surface_next, T_next * cloud.center));
                if nearest > reach && !cloud.points.iter().any(|(point, ..)| is_pressed(*point)) {
                    continue;
                }
                let planes = [surface.seen_from(T), surface_next.seen_from(T_next)];
                let candidate = |&(point, center, radius): &(usize, Vec3, f64)| {
                    let [now, then] = planes.map(|(n, d)| -(n.dot(center) + d));
                    if now.min(then) - radius > reach && !is_pressed(point) {
                        return None;
                    }
                    let of: &ContactPoint = &self.contacts.points[point];
                    let [now, then] = planes.map(|(n, d)| -(n.dot(of.farthest(n)) + d));
                    let gap = now.min(then);
                    (gap <= reach || is_pressed(point)).then(|| {
                        let key = Key::Contact(point, plane);
                        let acted = self.memory.acted(key);
                        Candidate { point, touch: surface.touch(of, T), gap, acted }
                    })
                };
                let near: Vec<Candidate> = cloud.points.iter().filter_map(candidate).collect();
                let acting = few(&near);
                for (k, one) in near.into_iter().enumerate() {
                    if acting.contains(&k) {
                        found.acting.push((one.point, plane, one.touch));
                    } else {
                        found.others.push((one.point, plane));
                    }
                }
            }
        }
        found
    }
}

/// The numbers of at most [`MOST`] of them.
fn few(all: &[Candidate]) -> Vec<usize> {
    if all.len() <= MOST {
        return (0..all.len()).collect();
    }
    let deepest = |of: &[usize]| of.iter().copied().min_by(|&a, &b| all[a].gap.total_cmp(&all[b].gap));
    let every: Vec<usize> = (0..all.len()).collect();
    let before: Vec<usize> = every.iter().copied().filter(|&k| all[k].acted).collect();
    let first = deepest(&every).unwrap_or(0);
    // how far each is from those chosen
    let apart = |distances: &mut [f64], chosen: usize| {
        for (distance, one) in distances.iter_mut().zip(all) {
            *distance = distance.min((one.touch.at - all[chosen].touch.at).norm());
        }
    };
    let farthest = |distances: &[f64]| every.iter().copied().max_by(|&a, &b| distances[a].total_cmp(&distances[b]));
    let (mut chosen, mut distances) = (Vec::with_capacity(MOST), alloc::vec![f64::INFINITY; all.len()]);
    let mut next = Some(first);
    while let Some(k) = next.filter(|&k| distances[k] > 0.0 && chosen.len() < MOST) {
        chosen.push(k);
        apart(&mut distances, k);
        next = farthest(&distances);
    }
    let left = |distances: &[f64]| distances.iter().copied().fold(0.0, f64::max);
    let mut distances_before = alloc::vec![f64::INFINITY; all.len()];
    before.iter().for_each(|&k| apart(&mut distances_before, k));
    let is_as_deep = deepest(&before).is_some_and(|k| all[k].gap <= all[first].gap + DEEPER);
    let serves = is_as_deep && before.len() <= MOST && NEARER * left(&distances_before) <= left(&distances);
    if serves { before } else { chosen }
}

#[cfg(test)]
mod tests {
    use super::{Candidate, MOST, few};
    use crate::contacts::Touch;
    use alloc::vec::Vec;
    use mozzi::linalg::Vec3;

    fn candidate(point: usize, [x, y]: [f64; 2], gap: f64) -> Candidate {
        let zero = Vec3::zero();
        let touch = Touch {
            at: Vec3([x, y, 0.0]),
            of_frame: zero,
            R: mozzi::SO3::identity(),
            axes: [zero; 3],
            speeds: [0.0; 3],
            gap,
        };
        Candidate { point, touch, gap, acted: false }
    }

    #[test]
    fn of_many_points_the_deepest_and_the_outermost_count() {
        // a grid of 11 × 11, deepest near the middle
        let grid = |k: usize| [(k % 11) as f64 - 5.0, (k / 11) as f64 - 5.0];
        let all = || (0..121).map(|k| candidate(k, grid(k), if k == 61 { -1e-6 } else { 0.0 })).collect::<Vec<_>>();
        let found = few(&all());
        assert_eq!(found.len(), MOST);
        for corner in [0, 10, 110, 120, 61] {
            assert!(found.contains(&corner), "{corner} in {found:?}");
        }
        // those that acted before act again, if they are as far apart and as deep
        let again = |points: &[usize], deep: f64| {
            let mut again = all();
            points.iter().for_each(|&k| again[k].acted = true);
            again[60].gap = deep;
            few(&again)
        };
        let other = [0, 5, 10, 55, 61, 110, 115, 120];
        assert!(other != found[..] && again(&other, 0.0) == other);
        assert!(again(&other, -2e-6).contains(&60) && again(&[0, 1, 2, 3, 4, 5, 6, 61], 0.0).contains(&120));
        // at one place there is one
        let same = |count| (0..count).map(|k| candidate(k, [1.0, 2.0], 0.0)).collect::<Vec<_>>();
        assert_eq!(few(&same(20)).len(), 1);
        assert_eq!(few(&same(8)).len(), 8);
    }
}
