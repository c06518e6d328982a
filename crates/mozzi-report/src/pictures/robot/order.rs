//! Painter's order: farther bodies first.

use super::solid::Solid;
use super::view::{Point, Projection, area_and_center, common};
use std::collections::BTreeSet;

/// The bodies' indices in the order in which they are drawn. Of two bodies that overlap in the picture, the one whose
/// front is farther in the mean over the overlap comes first; bodies in a circle are cut open at the farthest.
pub(super) fn order(bodies: &[&[Solid]], P: &Projection) -> Vec<usize> {
    let is_behind = |a: usize, b: usize| {
        let pairs = bodies[a].iter().flat_map(|one| bodies[b].iter().map(move |other| (one, other)));
        pairs.map(|(one, other)| nearer(one, other, P)).sum::<f64>()
    };
    // the bodies in front of each, and how many behind it are not drawn yet
    let (mut before, mut farther) = (vec![Vec::new(); bodies.len()], vec![0; bodies.len()]);
    for [a, b] in overlapping(bodies) {
        let (near, far) = match is_behind(a, b) {
            volume if volume > 0.0 => (a, b),
            volume if volume < 0.0 => (b, a),
            _ => continue,
        };
        before[far].push(near);
        farther[near] += 1;
    }
    let depth = |k: usize| {
        let depths = bodies[k].iter().map(|solid| solid.depth);
        depths.sum::<f64>() / bodies[k].len().max(1) as f64
    };
    let mut by_depth: Vec<usize> = (0..bodies.len()).collect();
    by_depth.sort_by(|&a, &b| depth(a).total_cmp(&depth(b)));
    let mut rank = vec![0; bodies.len()];
    by_depth.iter().enumerate().for_each(|(place, &k)| rank[k] = place);
    // places in `by_depth`
    let mut open: BTreeSet<usize> = (0..bodies.len()).collect();
    let mut free: BTreeSet<usize> = open.iter().copied().filter(|&place| farther[by_depth[place]] == 0).collect();
    let mut order = Vec::new();
    while let Some(place) = free.pop_first().or_else(|| open.first().copied()) {
        open.remove(&place);
        let body = by_depth[place];
        order.push(body);
        for &nearer in &before[body] {
            farther[nearer] -= 1;
            if farther[nearer] == 0 && open.contains(&rank[nearer]) {
                free.insert(rank[nearer]);
            }
        }
    }
    order
}

/// The pairs of bodies whose bounds overlap in the picture, the greater index first: by a sweep along the longer side.
fn overlapping(bodies: &[&[Solid]]) -> Vec<[usize; 2]> {
    let bounds: Vec<_> = bodies.iter().map(|body| bounds(body.iter().flat_map(|solid| &solid.outline))).collect();
    let extent = |k: usize| {
        let size = |ends: fn(f64, f64) -> f64, at: usize, start| bounds.iter().map(|b| b[k][at]).fold(start, ends);
        size(f64::max, 1, f64::NEG_INFINITY) - size(f64::min, 0, f64::INFINITY)
    };
    let along = if extent(1) > extent(0) { 1 } else { 0 };
    let mut starts: Vec<usize> = (0..bodies.len()).collect();
    starts.sort_by(|&a, &b| bounds[a][along][0].total_cmp(&bounds[b][along][0]));
    let (mut pairs, mut passed) = (Vec::new(), Vec::<usize>::new());
    for a in starts {
        passed.retain(|&b| bounds[b][along][1] >= bounds[a][along][0]);
        let across = 1 - along;
        let meets =
            |&&b: &&usize| bounds[a][across][0] <= bounds[b][across][1] && bounds[b][across][0] <= bounds[a][across][1];
        pairs.extend(passed.iter().filter(meets).map(|&b| [a.max(b), a.min(b)]));
        passed.push(a);
    }
    pairs.sort_unstable();
    pairs
}

/// The volume between the fronts of two solids where they overlap in the picture: above 0 if the first is nearer.
fn nearer(one: &Solid, other: &Solid, P: &Projection) -> f64 {
    let (a, b) = (bounds(&one.outline), bounds(&other.outline));
    if (0..2).any(|k| a[k][1] < b[k][0] || b[k][1] < a[k][0]) {
        return 0.0;
    }
    let overlap = common(&one.outline, &other.outline);
    let Some((area, center)) = area_and_center(&overlap) else { return 0.0 };
    let halfway = |corner: &Point| [0, 1].map(|k| 0.5 * (center[k] + corner[k]));
    let stride = overlap.len().div_ceil(8);
    let places = std::iter::once(center).chain(overlap.iter().step_by(stride).map(halfway));
    let differences: Vec<f64> = places.map(|at| one.front(at, P) - other.front(at, P)).collect();
    area * differences.iter().sum::<f64>() / differences.len() as f64
}

/// The least and the greatest of both coordinates.
pub(super) fn bounds<'p>(points: impl IntoIterator<Item = &'p Point>) -> [[f64; 2]; 2] {
    let none = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    points.into_iter().fold(none, |all, p| [0, 1].map(|k| [all[k][0].min(p[k]), all[k][1].max(p[k])]))
}

#[cfg(test)]
mod tests {
    use super::super::view::View;
    use super::*;
    use mozzi::{SE3, SO3, Vec3};
    use mozzi_urdf::geometry::Form;

    #[test]
    fn a_pin_through_a_plate_and_a_table_on_a_floor() {
        let P = Projection::of(View::ISO);
        let solid = |form, p| {
            let T = SE3 { R: SO3::identity(), p: Vec3(p) };
            Solid::new(form, T, Vec::new(), [0.5; 3], &P).expect("finite")
        };
        // the floor's middle is nearer than the ball that lies on its far end
        let floor = [solid(Form::Box { size: [4.0, 4.0, 0.1] }, [0.0, 0.0, 0.0])];
        let ball = [solid(Form::Sphere { radius: 0.2 }, [-1.7, 1.7, 0.25])];
        let below = [solid(Form::Sphere { radius: 0.2 }, [1.7, -1.7, -0.3])];
        let bodies = [&floor[..], &ball[..], &below[..]];
        assert!(floor[0].depth > ball[0].depth && floor[0].depth < below[0].depth);
        assert_eq!(order(&bodies, &P), [2, 0, 1]);
    }
}
