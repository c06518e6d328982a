//! `<geom>`: a homogeneous solid of a body.

use super::Model;
use super::attributes::Item;
use super::mesh::Body;
use super::orientation::{pose, to_z, unit};
use super::shell;
use crate::geometry::moments::Moments;
use crate::text::context::Context;
use mozzi::linalg::Mat3;
use mozzi::{SE3, SO3, Solid, SpatialInertia, Vec3};
use nalgebra::{Matrix3, SymmetricEigen};

/// MuJoCo's default density, that of water: kg/m³.
const DENSITY: f64 = 1000.0;

pub(crate) const TYPES: [&str; 9] =
    ["plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "sdf"];

/// The contribution of a geom to its body.
pub(crate) enum Mass {
    /// In the body's frame.
    Known(SpatialInertia),
    /// The reason why its mesh cannot be read.
    Mesh(String),
    /// It is invalid, already reported.
    Wrong,
}

impl Model<'_> {
    /// The inertia of a geom that is given in a frame T of its body.
    pub fn mass_of(&self, item: &Item, T: SE3, cx: &mut Context) -> Mass {
        let nothing = Mass::Known(SpatialInertia::zero());
        let [low, high] = self.compiler.of(&item.element).groups;
        if !(low..=high).contains(&item.number("group", 0.0, cx)) {
            return nothing;
        }
        let (mass, density) = (item.vector::<1>("mass", cx), item.number("density", DENSITY, cx));
        for (name, x) in [("mass", mass.map_or(0.0, |[mass]| mass)), ("density", density)] {
            if x < 0.0 {
                let message = format!("{name}: is {x}, expected at least 0");
                cx.findings.add(item.error("negative_mass", name, &message));
                return Mass::Wrong;
            }
        }
        let (kind, scale) = (item.word("type", &TYPES, cx).unwrap_or("sphere"), item.number("fitscale", 1.0, cx));
        if mass.map_or(density, |[mass]| mass) == 0.0 || kind == "plane" {
            return nothing;
        }
        let mass = mass.map(|[mass]| mass);
        let is_shell = item.flag("shellinertia", false, cx);
        let (solid, frame) = if item.has("mesh") || kind == "mesh" || kind == "sdf" {
            let name = item.value("mesh").map_or("", |value| value.text);
            let frame = pose(item, &self.compiler, cx);
            let body = self.meshes.body(name, cx);
            match body.as_ref() {
                Err(why) => return Mass::Mesh(why.clone()),
                Ok(body) if kind == "mesh" || kind == "sdf" => {
                    if is_shell {
                        let message =
                            "shellinertia: is not for a mesh, expected inertia=\"shell\" of the mesh in <asset>";
                        cx.findings.add(item.error("unsupported_attribute", "shellinertia", message));
                        return Mass::Wrong;
                    }
                    let Moments { size, center, I } = body.moments;
                    let mass = mass.unwrap_or(density * size);
                    return Mass::Known(SpatialInertia::new(mass, center, I * (mass / size)).transformed(T * frame));
                }
                Ok(body) => {
                    let (solid, shift) = fitted(body, kind, scale, self.compiler.of(&item.element).fit_aabb);
                    (solid, frame * shift)
                }
            }
        } else if kind == "hfield" {
            let name = item.value("hfield").map_or("", |value| value.text);
            let Some(half) = self.meshes.height_field(name) else {
                return Mass::Mesh("there is no such height field in <asset>".into());
            };
            (of_size("box", half), pose(item, &self.compiler, cx))
        } else {
            let Some(found) = self.solid(item, kind, cx) else { return Mass::Wrong };
            found
        };
        let inertia = match is_shell {
            true => shell::inertia(solid, mass.unwrap_or_else(|| density * shell::area(solid))),
            false => solid.inertia(mass.unwrap_or_else(|| density * solid.volume())),
        };
        Mass::Known(inertia.transformed(T * frame))
    }

    /// The solid, centred in its frame; None, with a diagnostic, if a size is missing.
    pub fn solid(&self, item: &Item, kind: &str, cx: &mut Context) -> Option<(Solid, SE3)> {
        let mut size = item.overlaid::<3>("size", cx);
        let mut frame = pose(item, &self.compiler, cx);
        if kind != "sphere"
            && let Some([a, b, c, d, e, f]) = item.vector::<6>("fromto", cx)
        {
            let (from, to) = (Vec3([a, b, c]), Vec3([d, e, f]));
            let Some(z) = unit(to - from) else {
                cx.findings.add(item.error(
                    "zero_axis",
                    "fromto",
                    "fromto: its points are the same, expected two points",
                ));
                return None;
            };
            frame = SE3 { R: to_z(z), p: (from + to) * 0.5 };
            let half = (to - from).norm() / 2.0;
            size = if matches!(kind, "box" | "ellipsoid") { [size[0], size[0], half] } else { [size[0], half, 0.0] };
        }
        let needed = match kind {
            "sphere" => 1,
            "capsule" | "cylinder" => 2,
            _ => 3,
        };
        if !size[..needed].iter().all(|&x| x > 0.0) {
            if cx.findings.has_errors() && item.has("size") && size == [0.0; 3] {
                return None; // invalid numbers, already reported
            }
            let sizes: Vec<String> = size[..needed].iter().map(f64::to_string).collect();
            let message = format!("size: is {}, expected numbers above 0 for a {kind}", sizes.join(" "));
            cx.findings.add(item.error("missing_size", "size", &message));
            return None;
        }
        Some((of_size(kind, size), frame))
    }
}

/// A solid of MuJoCo's half sizes.
fn of_size(kind: &str, size: [f64; 3]) -> Solid {
    let [x, y, _] = size;
    match kind {
        "sphere" => Solid::Sphere { radius: x },
        "capsule" => Solid::Capsule { radius: x, length: 2.0 * y },
        "cylinder" => Solid::Cylinder { radius: x, length: 2.0 * y },
        "ellipsoid" => Solid::Ellipsoid(size),
        _ => Solid::Box(size.map(|x| 2.0 * x)),
    }
}

/// The solid that MuJoCo fits to a mesh, in the mesh's principal axes, the longest along z: to the box with the mesh's
/// moments, or to its bounding box.
fn fitted(body: &Body, kind: &str, scale: f64, is_aabb: bool) -> (Solid, SE3) {
    let Moments { size, center, I } = body.moments;
    let rows = I.to_mat3().rows();
    let eigen = SymmetricEigen::new(Matrix3::from_fn(|i, j| rows[i][j]));
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let column = |k: usize| Vec3([0, 1, 2].map(|i| eigen.eigenvectors[(i, order[k])]));
    let (x, y) = (column(0), column(1));
    let z = x.cross(y);
    let R = SO3::from_matrix(Mat3::from_rows([x.0, y.0, z.0]).transpose()).unwrap_or(SO3::identity());
    let (half, middle) = if is_aabb {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &vertex in &body.vertices {
            let v = (R.inverse().matrix() * (vertex - center)).0;
            low = [0, 1, 2].map(|k| low[k].min(v[k]));
            high = [0, 1, 2].map(|k| high[k].max(v[k]));
        }
        ([0, 1, 2].map(|k| 0.5 * (high[k] - low[k])), Vec3([0, 1, 2].map(|k| 0.5 * (high[k] + low[k]))))
    } else {
        let moments = [0, 1, 2].map(|k| eigen.eigenvalues[order[k]] / size);
        let whole: f64 = moments.iter().sum();
        (moments.map(|moment| 0.5 * (6.0 * (whole - 2.0 * moment)).max(0.0).sqrt()), Vec3::zero())
    };
    let [a, b, c] = half;
    let size = match (kind, is_aabb) {
        ("sphere", true) => [a.max(b).max(c), 0.0, 0.0],
        ("sphere", false) => [(a + b + c) / 3.0, 0.0, 0.0],
        ("capsule", true) => [a.max(b), c - a.max(b), 0.0],
        ("capsule", false) => [(a + b) / 2.0, (c - (a + b) / 4.0).max(0.0), 0.0],
        ("cylinder", true) => [a.max(b), c, 0.0],
        ("cylinder", false) => [(a + b) / 2.0, c, 0.0],
        _ => half,
    };
    (of_size(kind, size.map(|x| scale * x)), SE3 { R, p: center + R.matrix() * middle })
}
