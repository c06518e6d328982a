//! Parallel projection, and convex polygons in the picture's plane.

use mozzi::Vec3;

/// A direction of view, from far away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Angle of the viewer about z of {s}, from x, rad.
    pub azimuth: f64,
    /// Angle of the viewer above the plane xy of {s}, rad.
    pub elevation: f64,
}

impl View {
    /// From the corner between +x and −y, above: x, y and z appear equally long.
    pub const ISO: View = View { azimuth: -std::f64::consts::FRAC_PI_4, elevation: 0.615_479_708_670_387_3 };
    /// From +x: y to the right, z up.
    pub const FRONT: View = View { azimuth: 0.0, elevation: 0.0 };
    /// From −y: x to the right, z up.
    pub const SIDE: View = View { azimuth: -std::f64::consts::FRAC_PI_2, elevation: 0.0 };
    /// From above: x to the right, y up.
    pub const TOP: View = View { azimuth: -std::f64::consts::FRAC_PI_2, elevation: std::f64::consts::FRAC_PI_2 };

    /// The picture's axes in {s}: right, up, and towards the viewer.
    pub(super) fn axes(self) -> [Vec3; 3] {
        let ((sa, ca), (se, ce)) = (self.azimuth.sin_cos(), self.elevation.sin_cos());
        [Vec3([-sa, ca, 0.0]), Vec3([-se * ca, -se * sa, ce]), Vec3([ce * ca, ce * sa, se])]
    }
}

/// The projection of points of {s}, in m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Projection {
    pub right: Vec3,
    pub up: Vec3,
    /// Towards the viewer.
    pub near: Vec3,
}

pub(super) type Point = [f64; 2];

impl Projection {
    pub fn of(view: View) -> Self {
        let [right, up, near] = view.axes();
        Projection { right, up, near }
    }

    pub fn point(&self, p: Vec3) -> Point {
        [self.right.dot(p), self.up.dot(p)]
    }

    /// A point of {s} that appears here, in the plane through the origin of {s}.
    pub fn unproject(&self, [x, y]: Point) -> Vec3 {
        self.right * x + self.up * y
    }

    /// A direction given by its components along right, up and towards the viewer.
    pub fn direction(&self, [x, y, z]: [f64; 3]) -> Vec3 {
        self.right * x + self.up * y + self.near * z
    }
}

/// Twice the signed area of the triangle: above 0 if c is to the left of the line from a to b.
fn side(a: Point, b: Point, c: Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The convex hull of points, counterclockwise (Andrew 1979).
pub(super) fn hull(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let chain = |points: &mut dyn Iterator<Item = &Point>| {
        let mut chain: Vec<Point> = Vec::new();
        for &p in points {
            while chain.len() > 1 && side(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0 {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    [chain(&mut points.iter()), chain(&mut points.iter().rev())].concat()
}

/// The common part of two convex polygons, both counterclockwise (Sutherland and Hodgman 1974).
pub(super) fn common(a: &[Point], b: &[Point]) -> Vec<Point> {
    let mut found = a.to_vec();
    for (k, &from) in b.iter().enumerate() {
        let to = b[(k + 1) % b.len()];
        let mut kept = Vec::with_capacity(found.len() + 1);
        for (i, &p) in found.iter().enumerate() {
            let next = found[(i + 1) % found.len()];
            let (here, there) = (side(from, to, p), side(from, to, next));
            if here >= 0.0 {
                kept.push(p);
            }
            if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
                let part = here / (here - there);
                kept.push([p[0] + part * (next[0] - p[0]), p[1] + part * (next[1] - p[1])]);
            }
        }
        found = kept;
    }
    found
}

/// The area and the centroid of a convex polygon; `None` if it has no area.
pub(super) fn area_and_center(polygon: &[Point]) -> Option<(f64, Point)> {
    let &first = polygon.first()?;
    let (mut area, mut moment) = (0.0, [0.0; 2]);
    for pair in polygon.windows(2).skip(1) {
        let twice = side(first, pair[0], pair[1]);
        area += 0.5 * twice;
        moment = [0, 1].map(|k| moment[k] + twice / 6.0 * (first[k] + pair[0][k] + pair[1][k]));
    }
    (area > 1e-12).then(|| (area, moment.map(|m| m / area)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_are_right_handed_and_the_iso_view_is_isometric() {
        for view in [View::ISO, View::FRONT, View::SIDE, View::TOP] {
            let [right, up, near] = view.axes();
            assert!((right.cross(up) - near).norm() < 1e-15, "{view:?}");
        }
        let P = Projection::of(View::ISO);
        let lengths = [Vec3([1.0, 0.0, 0.0]), Vec3([0.0, 1.0, 0.0]), Vec3([0.0, 0.0, 1.0])].map(|e| {
            let [x, y] = P.point(e);
            x.hypot(y)
        });
        assert!(lengths.iter().all(|l| (l - (2.0_f64 / 3.0).sqrt()).abs() < 1e-12), "{lengths:?}");
        let p = Projection::of(View::SIDE).point(Vec3([1.0, 2.0, 3.0]));
        assert!((p[0] - 1.0).abs() < 1e-15 && (p[1] - 3.0).abs() < 1e-15);
    }

    #[test]
    fn polygons_are_cut() {
        let square = |x: f64, y: f64| vec![[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]];
        let (area, center) = area_and_center(&common(&square(0.0, 0.0), &square(0.5, 0.25))).expect("an overlap");
        assert!((area - 0.375).abs() < 1e-12 && (center[0] - 0.75).abs() < 1e-12 && (center[1] - 0.625).abs() < 1e-12);
        assert!(area_and_center(&common(&square(0.0, 0.0), &square(2.0, 0.0))).is_none());
        let points = (0..25).map(|k| [f64::from(k % 5), f64::from(k / 5)]).collect();
        assert_eq!(hull(points), [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]);
    }
}
