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
/// Points that carried in the last step count as if they were farther from others by this factor.
const CARRIED: f64 = 1.02;

/// The contact points of a frame, within a sphere.
pub(super) struct Cloud {
    frame: FrameId,
    /// Their numbers, and the sphere around each.
    points: Vec<(usize, Vec3, f64)>,
    center: Vec3,
    radius: f64,
}

/// A point that may touch, and how deep it may come.
struct Candidate {
    point: usize,
    touch: Touch,
    gap: f64,
    carried: bool,
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
    /// The pairs of a point and a plane within reach at θ, or at the robot's next configuration at the time `then`;
    /// with their touch at θ. Those of a frame follow each other.
    pub fn near(&self, [t, then]: [f64; 2], theta: &[f64], next: &[f64]) -> Vec<(usize, usize, Touch)> {
        let (now, later) = (self.surfaces(t), self.surfaces(then));
        let mut found = Vec::new();
        for cloud in &self.clouds {
            let [T, T_next] = [theta, next].map(|theta| forward_kinematics(self.model, theta, cloud.frame));
            for (plane, (surface, surface_next)) in now.iter().zip(&later).enumerate() {
                let height = |surface: &Surface, at: Vec3| surface.height(at) - cloud.radius;
                let reach = if cloud.radius > 0.0 { self.reach.min(SHARE * cloud.radius) } else { self.reach };
                if height(surface, T * cloud.center).min(height(surface_next, T_next * cloud.center)) > reach {
                    continue;
                }
                let planes = [surface.seen_from(T), surface_next.seen_from(T_next)];
                let candidate = |&(point, center, radius): &(usize, Vec3, f64)| {
                    let [now, then] = planes.map(|(n, d)| -(n.dot(center) + d));
                    if now.min(then) - radius > reach {
                        return None;
                    }
                    let of: &ContactPoint = &self.contacts.points[point];
                    let [now, then] = planes.map(|(n, d)| -(n.dot(of.farthest(n)) + d));
                    let gap = now.min(then);
                    (gap <= reach).then(|| {
                        let key = Key::Contact(point, plane);
                        let carried = self.memory.carrying.iter().any(|&(other, _)| other == key);
                        Candidate { point, touch: surface.touch(of, T), gap, carried }
                    })
                };
                let near = cloud.points.iter().filter_map(candidate);
                found.extend(few(near.collect()).into_iter().map(|one| (one.point, plane, one.touch)));
            }
        }
        found
    }
}

/// At most [`MOST`] of them, in their order.
fn few(mut all: Vec<Candidate>) -> Vec<Candidate> {
    if all.len() <= MOST {
        return all;
    }
    let weight = |of: &Candidate| if of.carried { CARRIED } else { 1.0 };
    let deepest = all.iter().enumerate().min_by(|(_, a), (_, b)| a.gap.total_cmp(&b.gap)).map_or(0, |(k, _)| k);
    let mut chosen = alloc::vec![deepest];
    let mut distances: Vec<f64> = alloc::vec![f64::INFINITY; all.len()];
    while chosen.len() < MOST {
        let last = all[chosen[chosen.len() - 1]].touch.at;
        for (distance, one) in distances.iter_mut().zip(&all) {
            *distance = distance.min((one.touch.at - last).norm() * weight(one));
        }
        let farthest = (0..all.len()).max_by(|&a, &b| distances[a].total_cmp(&distances[b]));
        match farthest.filter(|&k| distances[k] > 0.0) {
            Some(k) => chosen.push(k),
            None => break,
        }
    }
    let mut k = 0;
    all.retain(|_| {
        k += 1;
        chosen.contains(&(k - 1))
    });
    all
}

#[cfg(test)]
mod tests {
    use super::{CARRIED, Candidate, MOST, few};
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
        Candidate { point, touch, gap, carried: false }
    }

    #[test]
    fn of_many_points_the_deepest_and_the_outermost_count() {
        // a grid of 11 × 11, deepest near the middle
        let grid = |k: usize| [(k % 11) as f64 - 5.0, (k / 11) as f64 - 5.0];
        let all = || (0..121).map(|k| candidate(k, grid(k), if k == 61 { -1e-6 } else { 0.0 })).collect::<Vec<_>>();
        let points = |found: &[Candidate]| found.iter().map(|one| one.point).collect::<Vec<_>>();
        let found = few(all());
        assert_eq!(found.len(), MOST);
        for corner in [0, 10, 110, 120, 61] {
            assert!(points(&found).contains(&corner), "{corner} in {:?}", points(&found));
        }
        assert!(found.is_sorted_by_key(|one| one.point));
        // of points that are as far, those that carried before
        let mut again = all();
        again.iter_mut().filter(|one| [55, 65].contains(&one.point)).for_each(|one| one.carried = true);
        assert!(CARRIED > 1.0 && points(&few(again)).contains(&55));
        // at one place there is one
        assert_eq!(few((0..20).map(|k| candidate(k, [1.0, 2.0], 0.0)).collect()).len(), 1);
        assert_eq!(few((0..8).map(|k| candidate(k, [1.0, 2.0], 0.0)).collect()).len(), 8);
    }
}
