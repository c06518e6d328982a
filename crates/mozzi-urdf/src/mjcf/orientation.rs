//! Position and orientation, in the five ways to write one.

use super::attributes::Item;
use super::compiler::{Compiler, Compilers};
use crate::report::finding::Finding;
use crate::text::context::Context;
use crate::urdf::vocabulary::list;
use mozzi::linalg::Mat3;
use mozzi::{SE3, SO3, Vec3};

pub(crate) const ORIENTATIONS: [&str; 5] = ["quat", "axisangle", "euler", "xyaxes", "zaxis"];

/// Configuration of an element's frame relative to its parent's; invalid parts are reported and omitted.
pub(crate) fn pose(item: &Item, compilers: &Compilers, cx: &mut Context) -> SE3 {
    let p = item.vector::<3>("pos", cx).unwrap_or([0.0; 3]);
    SE3 { R: orientation(item, compilers.of(&item.element), cx), p: Vec3(p) }
}

/// The orientation only. The element's own attributes take precedence over its class.
fn orientation(item: &Item, compiler: &Compiler, cx: &mut Context) -> SO3 {
    let own: Vec<&str> = ORIENTATIONS.into_iter().filter(|name| item.element.attribute(name).is_some()).collect();
    if own.len() > 1 {
        let message = format!("{}: has {}, expected one of them", item.element.subject, list(&own));
        cx.findings.add(Finding::error("several_orientations", item.element.span(), message));
        return SO3::identity();
    }
    let inherited = || ORIENTATIONS.into_iter().rev().find(|name| item.has(name));
    let Some(name) = own.first().copied().or_else(inherited) else { return SO3::identity() };
    let found = match name {
        "quat" => item.vector(name, cx).map(quaternion),
        "axisangle" => item.vector(name, cx).map(|[x, y, z, angle]| {
            let axis = unit(Vec3([x, y, z]))?;
            Some(SO3::exp(axis * compiler.angle(angle)))
        }),
        "euler" => item.vector(name, cx).map(|angles| Some(compiler.euler(angles))),
        "xyaxes" => item.vector(name, cx).map(|[a, b, c, d, e, f]| {
            let x = unit(Vec3([a, b, c]))?;
            let y = Vec3([d, e, f]);
            let y = unit(y - x * x.dot(y))?;
            columns(x, y, x.cross(y))
        }),
        _ => item.vector(name, cx).map(|z| Some(to_z(unit(Vec3(z))?))),
    };
    match found {
        None => SO3::identity(),
        Some(Some(R)) => R,
        Some(None) => {
            let text = item.value(name).map_or("", |value| value.text.trim());
            let message = format!("{name}: is `{}`, a vector of length 0", crate::urdf::vocabulary::shown(text));
            cx.findings.add(item.error("zero_axis", name, &message));
            SO3::identity()
        }
    }
}

/// A vector of length 1.
pub(crate) fn unit(v: Vec3) -> Option<Vec3> {
    let length = v.norm();
    (length > 1e-100 && length < 1e100).then(|| v * (1.0 / length))
}

/// None if the axes are too nearly parallel for a rotation.
fn columns(x: Vec3, y: Vec3, z: Vec3) -> Option<SO3> {
    SO3::from_matrix(Mat3::from_rows([x.0, y.0, z.0]).transpose()).ok()
}

/// The rotation of a quaternion (w, x, y, z) of any length.
pub(crate) fn quaternion(q: [f64; 4]) -> Option<SO3> {
    let largest = q.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if largest == 0.0 {
        return None;
    }
    let q = q.map(|x| x / largest);
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    let [w, x, y, z] = q.map(|x| x / length);
    let rows = [
        [w * w + x * x - y * y - z * z, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ];
    SO3::from_matrix(Mat3::from_rows(rows)).ok()
}

/// The least rotation that takes z to a unit vector.
pub(crate) fn to_z(z: Vec3) -> SO3 {
    let Vec3([x, y, cos]) = z;
    let sin = x.hypot(y);
    if sin > 0.0 {
        // about ẑ × z
        SO3::exp(Vec3([-y / sin, x / sin, 0.0]) * sin.atan2(cos))
    } else if cos < 0.0 {
        SO3::exp(Vec3([core::f64::consts::PI, 0.0, 0.0]))
    } else {
        SO3::identity()
    }
}
