//! `<geom>`: a homogeneous solid of a body.

use super::Model;
use super::attributes::Item;
use super::orientation::{pose, to_z, unit};
use crate::text::context::Context;
use mozzi::{SE3, Solid, SpatialInertia, Vec3};

/// MuJoCo's default density, that of water: kg/m³.
const DENSITY: f64 = 1000.0;

pub(crate) const TYPES: [&str; 9] =
    ["plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "sdf"];

/// The contribution of a geom to its body.
pub(crate) enum Mass {
    /// In the body's frame.
    Known(SpatialInertia),
    /// It needs a mesh, which is not read.
    Mesh,
    /// It is invalid, already reported.
    Wrong,
}

impl Model<'_> {
    /// The inertia of a geom that is given in a frame T of its body.
    pub fn mass_of(&self, item: &Item, T: SE3, cx: &mut Context) -> Mass {
        let nothing = Mass::Known(SpatialInertia::zero());
        let [low, high] = self.compiler.groups;
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
        let kind = item.word("type", &TYPES, cx).unwrap_or("sphere");
        if mass.map_or(density, |[mass]| mass) == 0.0 || kind == "plane" || kind == "hfield" {
            return nothing;
        }
        if item.has("mesh") || kind == "mesh" || kind == "sdf" {
            return Mass::Mesh;
        }
        if item.flag("shellinertia", false, cx) {
            let message = "shellinertia: is the inertia of a hollow body, which mozzi does not compute";
            let help = "give the body an <inertial>";
            cx.findings.add(item.error("unsupported_attribute", "shellinertia", message).help(help));
            return Mass::Wrong;
        }
        let Some((solid, frame)) = self.solid(item, kind, cx) else { return Mass::Wrong };
        let inertia = match mass {
            Some([mass]) => solid.inertia(mass),
            None => solid.of_density(density),
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
        let [x, y, _] = size;
        let solid = match kind {
            "sphere" => Solid::Sphere { radius: x },
            "capsule" => Solid::Capsule { radius: x, length: 2.0 * y },
            "cylinder" => Solid::Cylinder { radius: x, length: 2.0 * y },
            "ellipsoid" => Solid::Ellipsoid(size),
            _ => Solid::Box(size.map(|x| 2.0 * x)),
        };
        Some((solid, frame))
    }
}
