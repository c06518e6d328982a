//! The convex hull of points (quickhull), with exact signs of all determinants.

use mozzi::Vec3;
use robust::{Coord3D, orient3d};
use std::collections::BTreeMap;

/// A facet with the points that are beyond its plane and of which no earlier facet took charge.
struct Facet {
    corners: [usize; 3],
    /// Across the edge from corner k to corner k + 1.
    neighbours: [usize; 3],
    outside: Vec<usize>,
    is_gone: bool,
}

struct Hull<'p> {
    points: &'p [Vec3],
    facets: Vec<Facet>,
}

/// The triangles of the hull, counterclockwise seen from outside; None if all points are in one plane. Points in a
/// facet's plane are corners only where the hull needs them.
pub(crate) fn convex_hull(points: &[Vec3]) -> Option<Vec<[usize; 3]>> {
    let [a, b, c, d] = simplex(points)?;
    let mut hull = Hull { points, facets: Vec::new() };
    for corners in [[a, b, c], [a, d, b], [b, d, c], [c, d, a]] {
        hull.facets.push(Facet { corners, neighbours: [0; 3], outside: Vec::new(), is_gone: false });
    }
    let edges: BTreeMap<[usize; 2], usize> =
        (0..4).flat_map(|f| edges(hull.facets[f].corners).map(|edge| (edge, f))).collect();
    for facet in &mut hull.facets {
        facet.neighbours = self::edges(facet.corners).map(|[p, q]| edges[&[q, p]]);
    }
    hull.distribute((0..points.len()).collect(), &[0, 1, 2, 3]);
    let mut open = vec![0, 1, 2, 3];
    while let Some(f) = open.pop() {
        if !hull.facets[f].is_gone && !hull.facets[f].outside.is_empty() {
            open.push(f);
            open.extend(hull.add_farthest(f));
        }
    }
    Some(hull.facets.into_iter().filter(|facet| !facet.is_gone).map(|facet| facet.corners).collect())
}

fn edges([a, b, c]: [usize; 3]) -> [[usize; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Six times the volume of the tetrahedron, with the exact sign: above 0 if d is beyond the triangle abc.
fn volume(points: &[Vec3], [a, b, c]: [usize; 3], d: usize) -> f64 {
    let at = |i: usize| {
        let [x, y, z] = points[i].0;
        Coord3D { x, y, z }
    };
    -orient3d(at(a), at(b), at(c), at(d))
}

/// Four points that are not in one plane, far apart; d is behind abc.
fn simplex(points: &[Vec3]) -> Option<[usize; 4]> {
    let first = *points.first()?;
    let farthest = |measure: &dyn Fn(Vec3) -> f64| {
        let best = |best: (f64, usize), (i, &p): (usize, &Vec3)| {
            let x = measure(p);
            if x > best.0 { (x, i) } else { best }
        };
        points.iter().enumerate().fold((0.0, 0), best)
    };
    let a = farthest(&|p| p.0[0] - first.0[0]).1;
    let b = farthest(&|p| (p - points[a]).norm()).1;
    let along = points[b] - points[a];
    let c = farthest(&|p| along.cross(p - points[a]).norm()).1;
    let normal = along.cross(points[c] - points[a]);
    let d = farthest(&|p| normal.dot(p - points[a]).abs()).1;
    match volume(points, [a, b, c], d) {
        v if v < 0.0 => Some([a, b, c, d]),
        v if v > 0.0 => Some([a, c, b, d]),
        _ => None,
    }
}

impl Hull<'_> {
    /// Gives each point to the first of these facets that it is beyond of; points inside are dropped.
    fn distribute(&mut self, points: Vec<usize>, facets: &[usize]) {
        for p in points {
            let sees = |&&f: &&usize| volume(self.points, self.facets[f].corners, p) > 0.0;
            if let Some(&f) = facets.iter().find(sees) {
                self.facets[f].outside.push(p);
            }
        }
    }

    /// Replaces the facets that the farthest point beyond a facet sees by a cone from it. Facets in whose plane it lies
    /// count as seen, so that no new triangle is flat. Returns the new facets.
    fn add_farthest(&mut self, start: usize) -> Vec<usize> {
        let corners = self.facets[start].corners;
        let [a, b, c] = corners.map(|i| self.points[i]);
        let normal = (b - a).cross(c - a);
        let height = |&p: &usize| normal.dot(self.points[p] - a);
        let outside = &self.facets[start].outside;
        let tip = outside.iter().copied().max_by(|p, q| height(p).total_cmp(&height(q))).unwrap_or(outside[0]);

        let (mut seen, mut open, mut horizon) = (vec![start], vec![start], Vec::new());
        self.facets[start].is_gone = true;
        while let Some(f) = open.pop() {
            for (edge, next) in edges(self.facets[f].corners).into_iter().zip(self.facets[f].neighbours) {
                if self.facets[next].is_gone {
                    continue;
                }
                if volume(self.points, self.facets[next].corners, tip) >= 0.0 {
                    self.facets[next].is_gone = true;
                    seen.push(next);
                    open.push(next);
                } else {
                    horizon.push((edge, next));
                }
            }
        }
        let first = self.facets.len();
        let mut starts = BTreeMap::new();
        for (k, &([p, q], next)) in horizon.iter().enumerate() {
            let f = first + k;
            starts.insert(p, f);
            let across = edges(self.facets[next].corners).iter().position(|&edge| edge == [q, p]).unwrap_or(0);
            self.facets[next].neighbours[across] = f;
            let facet = Facet { corners: [p, q, tip], neighbours: [next; 3], outside: Vec::new(), is_gone: false };
            self.facets.push(facet);
        }
        // the cone's triangle that begins where another ends
        for (k, &([p, q], _)) in horizon.iter().enumerate() {
            if let Some(&after) = starts.get(&q) {
                self.facets[first + k].neighbours[1] = after;
                self.facets[after].neighbours[2] = first + k;
            }
            debug_assert_ne!(p, q);
        }
        let new: Vec<usize> = (first..self.facets.len()).collect();
        let orphans: Vec<usize> = seen.iter().flat_map(|&f| std::mem::take(&mut self.facets[f].outside)).collect();
        self.distribute(orphans.into_iter().filter(|&p| p != tip).collect(), &new);
        new
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume_of(points: &[Vec3]) -> f64 {
        let triangles = convex_hull(points).expect("a solid");
        triangles.iter().map(|&[a, b, c]| points[a].dot(points[b].cross(points[c])) / 6.0).sum()
    }

    #[test]
    fn a_grid_and_a_ball_are_convex() {
        // 5³ points, most of them in the planes of the facets and on their edges
        let grid: Vec<Vec3> = (0..125).map(|k| Vec3([k % 5, k / 5 % 5, k / 25].map(|i| f64::from(i) * 0.1))).collect();
        assert!((volume_of(&grid) - 0.064).abs() < 1e-15);
        let mut ball = Vec::new();
        for k in 0..2000 {
            let (z, turn) = (1.0 - (2 * k + 1) as f64 / 2000.0, 2.399_963_229_728_653 * f64::from(k));
            let r = (1.0 - z * z).sqrt();
            ball.push(Vec3([r * turn.cos(), r * turn.sin(), z]));
        }
        let triangles = convex_hull(&ball).expect("a solid");
        assert_eq!(triangles.len(), 2 * 2000 - 4, "Euler: all points are corners");
        for &triangle in &triangles {
            assert!((0..ball.len()).all(|p| volume(&ball, triangle, p) <= 0.0), "all points are behind each facet");
        }
        assert!((volume_of(&ball) / (4.0 / 3.0 * std::f64::consts::PI) - 1.0).abs() < 5e-3);
    }

    #[test]
    fn flat_points_have_none() {
        let flat: Vec<Vec3> = (0..9).map(|k| Vec3([f64::from(k % 3), f64::from(k / 3), 0.5])).collect();
        assert!(convex_hull(&flat).is_none() && convex_hull(&flat[..2]).is_none() && convex_hull(&flat[..1]).is_none());
        assert!(convex_hull(&[]).is_none());
    }
}
