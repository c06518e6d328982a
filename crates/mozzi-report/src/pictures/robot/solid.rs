//! A convex solid: its outline, its lit parts, and how near it is to the viewer.

use super::view::{Point, Projection, hull};
use mozzi::{SE3, Vec3};
use mozzi_urdf::geometry::Form;
use std::f64::consts::{PI, TAU};

/// Corners of a closed curve.
const CORNERS: usize = 48;
/// Directions in which the front is sampled.
const DIRECTIONS: usize = 96;
/// Direction of the light: components along right, up and towards the viewer. It is 30° from the last.
const LIGHT: [f64; 3] = [-0.3, 0.4, 0.866_025_403_784_438_6];
/// Brightness of a round surface: its own, and where the cosine of the angle to the light is above a bound. Where it is
/// above 0.5, the surface is visible.
const ROUND: f64 = 0.76;
const LIT: [(f64, f64); 2] = [(0.52, 0.88), (0.86, 0.97)];

/// A convex solid in {s}.
pub(super) struct Solid {
    form: Form,
    T: SE3,
    /// A mesh's vertices, in its own coordinates.
    vertices: Vec<Vec3>,
    pub color: [f64; 3],
    /// In the picture's plane, counterclockwise.
    pub outline: Vec<Point>,
    /// Unit directions towards the viewer and the solid's extent along each.
    planes: Vec<(Vec3, f64)>,
    /// The depth of its middle.
    pub depth: f64,
}

/// A part of one brightness; 1 is the solid's own colour.
pub(super) struct Part {
    pub brightness: f64,
    pub outline: Vec<Point>,
}

impl Solid {
    /// `None` if a number of it is infinite or NaN. The vertices are those of a mesh.
    pub fn new(form: Form, T: SE3, vertices: Vec<Vec3>, color: [f64; 3], P: &Projection) -> Option<Self> {
        let mut solid =
            Solid { form, T, vertices, color, outline: Vec::new(), planes: Vec::new(), depth: P.near.dot(T.p) };
        let turn = |k: usize| {
            let (sine, cosine) = (TAU * k as f64 / CORNERS as f64).sin_cos();
            P.direction([cosine, sine, 0.0])
        };
        let points = match &solid.form {
            Form::Box { .. } | Form::Mesh { .. } => solid.corners(),
            Form::Cylinder { length, .. } | Form::Capsule { length, .. } => {
                // the same point of both ends: across the axis both are extreme
                let along = solid.axes()[2] * *length;
                let ends =
                    |d: Vec3| [0.0, if d.dot(along) < 0.0 { 1.0 } else { -1.0 }].map(|k| solid.extreme(d) + along * k);
                (0..CORNERS).map(turn).flat_map(ends).collect()
            }
            _ => (0..CORNERS).map(|k| solid.extreme(turn(k))).collect(),
        };
        if !points.iter().all(|p| p.0.iter().all(|x| x.is_finite())) {
            return None;
        }
        if let Form::Mesh { .. } = solid.form {
            let mean = points.iter().fold(Vec3::zero(), |sum, &p| sum + p) * (1.0 / points.len().max(1) as f64);
            solid.depth = P.near.dot(mean);
        }
        solid.outline = hull(points.iter().map(|&p| P.point(p)).collect());
        // Fibonacci's half sphere, and the solid's own faces
        let spiral = (0..DIRECTIONS).map(|k| {
            let z = (k as f64 + 0.5) / DIRECTIONS as f64;
            let (r, (sine, cosine)) = ((1.0 - z * z).sqrt(), (PI * (3.0 - 5.0_f64.sqrt()) * k as f64).sin_cos());
            P.direction([r * cosine, r * sine, z])
        });
        let own = solid.axes().into_iter().flat_map(|axis| [axis, -axis]);
        let facing = |d: &Vec3| d.dot(P.near) > 0.02;
        solid.planes = spiral.chain(own).filter(facing).map(|d| (d, d.dot(solid.extreme(d)))).collect();
        Some(solid)
    }

    /// The depth of its front at a point within the outline.
    pub fn front(&self, at: Point, P: &Projection) -> f64 {
        let p = P.unproject(at);
        let depth = |&(d, extent): &(Vec3, f64)| (extent - d.dot(p)) / d.dot(P.near);
        self.planes.iter().map(depth).fold(f64::INFINITY, f64::min)
    }

    fn axes(&self) -> [Vec3; 3] {
        [Vec3([1.0, 0.0, 0.0]), Vec3([0.0, 1.0, 0.0]), Vec3([0.0, 0.0, 1.0])].map(|e| self.T.R * e)
    }

    /// The corners of a box or a mesh.
    fn corners(&self) -> Vec<Vec3> {
        let Form::Box { size } = self.form else { return self.vertices.iter().map(|&v| self.T * v).collect() };
        let corner = |k: usize| Vec3([0, 1, 2].map(|axis| size[axis] * if k >> axis & 1 == 0 { -0.5 } else { 0.5 }));
        (0..8).map(|k| self.T * corner(k)).collect()
    }

    /// Its farthest point in a direction.
    fn extreme(&self, d: Vec3) -> Vec3 {
        let along = |axis: Vec3, half: f64| axis * if d.dot(axis) < 0.0 { -half } else { half };
        let [_, _, z] = self.axes();
        match &self.form {
            Form::Sphere { radius } => self.T.p + d * *radius,
            Form::Capsule { radius, length } => self.T.p + along(z, 0.5 * length) + d * *radius,
            Form::Cylinder { radius, length } => {
                let across = d - z * d.dot(z);
                let size = across.norm();
                let rim = if size > 1e-9 { across * (radius / size) } else { Vec3::zero() };
                self.T.p + along(z, 0.5 * length) + rim
            }
            Form::Ellipsoid { radii } => {
                let local = self.T.R.inverse() * d;
                let scaled = Vec3([0, 1, 2].map(|k| radii[k] * local.0[k]));
                let size = scaled.norm();
                self.T * Vec3([0, 1, 2].map(|k| radii[k] * scaled.0[k] / size))
            }
            Form::Box { .. } | Form::Mesh { .. } => {
                let far = |a: &Vec3, b: &Vec3| d.dot(*a).total_cmp(&d.dot(*b));
                self.corners().into_iter().max_by(far).unwrap_or(self.T.p)
            }
        }
    }

    /// The outline, and on it the lit parts, in their order.
    pub fn parts(&self, P: &Projection) -> Vec<Part> {
        let light = P.direction(LIGHT);
        let face = |normal: Vec3| 0.62 + 0.38 * normal.dot(light).max(0.0);
        let whole = |brightness| Part { brightness, outline: self.outline.clone() };
        match &self.form {
            Form::Box { size } => {
                let mut parts = vec![whole(ROUND)];
                for (k, axis) in self.axes().into_iter().enumerate() {
                    let normal = axis * if axis.dot(P.near) < 0.0 { -1.0 } else { 1.0 };
                    if normal.dot(P.near) > 1e-6 {
                        let middle = self.T.p + normal * (0.5 * size[k]);
                        let [a, b] = [(k + 1) % 3, (k + 2) % 3].map(|i| self.axes()[i] * (0.5 * size[i]));
                        let corners = [middle + a + b, middle - a + b, middle - a - b, middle + a - b];
                        let outline = hull(corners.map(|p| P.point(p)).to_vec());
                        parts.push(Part { brightness: face(normal), outline });
                    }
                }
                parts
            }
            Form::Mesh { .. } => vec![whole(0.5 * (ROUND + LIT[0].1))],
            Form::Cylinder { radius, length } => {
                let z = self.axes()[2];
                let mut parts = vec![whole(ROUND)];
                let lit = LIT.into_iter().filter_map(|(bound, brightness)| {
                    Some(Part { brightness, outline: self.strip(*radius, *length, light, bound, P)? })
                });
                parts.extend(lit);
                let normal = if z.dot(P.near) < 0.0 { -z } else { z };
                if normal.dot(P.near) > 1e-6 {
                    let middle = self.T.p + normal * (0.5 * length);
                    parts.push(Part { brightness: face(normal), outline: self.circle(middle, z, *radius, P) });
                }
                parts
            }
            Form::Sphere { .. } | Form::Capsule { .. } | Form::Ellipsoid { .. } => {
                let lit =
                    LIT.into_iter().map(|(bound, brightness)| Part { brightness, outline: self.caps(light, bound, P) });
                std::iter::once(whole(ROUND)).chain(lit).collect()
            }
        }
    }

    /// The circle about an axis.
    fn circle(&self, middle: Vec3, axis: Vec3, radius: f64, P: &Projection) -> Vec<Point> {
        let [a, b] = across(axis);
        let corner = |k: usize| {
            let (sine, cosine) = (TAU * k as f64 / CORNERS as f64).sin_cos();
            P.point(middle + (a * cosine + b * sine) * radius)
        };
        hull((0..CORNERS).map(corner).collect())
    }

    /// The part of a cylinder's side whose normal has at least this cosine to the light.
    fn strip(&self, radius: f64, length: f64, light: Vec3, bound: f64, P: &Projection) -> Option<Vec<Point>> {
        let z = self.axes()[2];
        let [a, b] = across(z);
        let (along, size) = (light.dot(b).atan2(light.dot(a)), light.dot(a).hypot(light.dot(b)));
        let half = if bound < size { (bound / size).acos() } else { return None };
        let normal = |k: usize| {
            let (sine, cosine) = (along + half * (k as f64 / 12.0 - 1.0)).sin_cos();
            a * cosine + b * sine
        };
        let ends = |n: Vec3| [-0.5, 0.5].map(|s| P.point(self.T.p + n * radius + z * (s * length)));
        let seen: Vec<[Point; 2]> = (0..=24).map(normal).filter(|n| n.dot(P.near) >= 0.0).map(ends).collect();
        let (lower, upper) = (seen.iter().map(|ends| ends[0]), seen.iter().map(|ends| ends[1]));
        (seen.len() > 1).then(|| lower.chain(upper.rev()).collect())
    }

    /// Where a sphere, the ends of a capsule or an ellipsoid have normals of at least this cosine to the light.
    fn caps(&self, light: Vec3, bound: f64, P: &Projection) -> Vec<Point> {
        let [a, b] = across(light);
        let rim = (1.0 - bound * bound).sqrt();
        let normal = |k: usize| {
            let (sine, cosine) = (TAU * k as f64 / CORNERS as f64).sin_cos();
            light * bound + (a * cosine + b * sine) * rim
        };
        let points = (0..CORNERS).map(normal).flat_map(|n| match &self.form {
            Form::Capsule { radius, length } => {
                let half = self.axes()[2] * (0.5 * length);
                [self.T.p + half + n * *radius, self.T.p - half + n * *radius]
            }
            _ => [self.extreme(n); 2],
        });
        hull(points.map(|p| P.point(p)).collect())
    }
}

/// Two unit vectors across a unit vector.
fn across(axis: Vec3) -> [Vec3; 2] {
    let k = (0..3).min_by(|&i, &j| axis.0[i].abs().total_cmp(&axis.0[j].abs())).unwrap_or(0);
    let mut e = Vec3::zero();
    e.0[k] = 1.0;
    let a = axis.cross(e);
    let a = a * (1.0 / a.norm());
    [a, axis.cross(a)]
}

#[cfg(test)]
mod tests {
    use super::super::view::{View, area_and_center};
    use super::*;
    use mozzi::SO3;

    fn solid(form: Form, P: &Projection) -> Solid {
        let T = SE3 { R: SO3::identity(), p: Vec3([0.1, 0.2, 0.3]) };
        Solid::new(form, T, Vec::new(), [1.0; 3], P).expect("finite")
    }

    #[test]
    fn outlines_have_the_areas_of_their_shadows() {
        let (r, l) = (0.2, 0.5);
        let disc = PI * r * r;
        let forms = [
            (Form::Sphere { radius: r }, disc, disc),
            (Form::Cylinder { radius: r, length: l }, 2.0 * r * l, disc),
            (Form::Capsule { radius: r, length: l }, disc + 2.0 * r * l, disc),
            (Form::Ellipsoid { radii: [0.1, 0.2, 0.3] }, PI * 0.1 * 0.3, PI * 0.1 * 0.2),
            (Form::Box { size: [0.1, 0.2, 0.3] }, 0.1 * 0.3, 0.1 * 0.2),
        ];
        for (form, side, top) in forms {
            for (view, expected) in [(View::SIDE, side), (View::TOP, top)] {
                let P = Projection::of(view);
                let solid = solid(form.clone(), &P);
                let (area, center) = area_and_center(&solid.outline).expect("an area");
                assert!((area / expected - 1.0).abs() < 1.2e-2, "{form:?} {view:?}: {area} {expected}");
                let expected = P.point(Vec3([0.1, 0.2, 0.3]));
                assert!((0..2).all(|k| (center[k] - expected[k]).abs() < 1e-9), "{form:?} {view:?}");
                for part in solid.parts(&P) {
                    let (part, _) = area_and_center(&hull(part.outline)).expect("an area");
                    assert!(part <= area * 1.0001, "lit parts lie within: {form:?} {view:?}");
                }
            }
        }
    }

    #[test]
    fn the_front_is_where_it_is() {
        let P = Projection::of(View::TOP);
        let at = P.point(Vec3([0.1, 0.2, 0.3]));
        for form in [
            Form::Sphere { radius: 0.25 },
            Form::Cylinder { radius: 0.1, length: 0.5 },
            Form::Capsule { radius: 0.05, length: 0.4 },
            Form::Ellipsoid { radii: [0.1, 0.2, 0.25] },
            Form::Box { size: [0.1, 0.2, 0.5] },
        ] {
            assert!((solid(form.clone(), &P).front(at, &P) - 0.55).abs() < 1e-3, "{form:?}");
        }
    }
}
