//! `<origin>`: the configuration of one frame relative to another.

use crate::report::finding::Finding;
use crate::text::context::Context;
use crate::text::element::{Element, Value};
use crate::text::version::Version;
use crate::urdf::vocabulary::{ORIGIN, shown};
use mozzi::{SE3, SO3, Vec3};

/// Tolerance on the length of a quaternion before a warning.
const SLACK: f64 = 1e-3;

/// Zeros by default; None, with a diagnostic, if it cannot be read.
pub(crate) fn read(origin: &Element, cx: &mut Context) -> Option<SE3> {
    origin.check_attributes(&ORIGIN, cx);
    origin.check_children(&ORIGIN, cx);
    let mut vector = |name| match origin.attribute(name) {
        Some(value) => origin.vector::<3>(name, &value, cx),
        None => Some([0.0; 3]),
    };
    let (xyz, rpy) = (vector("xyz"), vector("rpy"));
    let quaternion = quaternion(origin, cx);
    let [roll, pitch, yaw] = rpy?;
    if let Some(value) = origin.attribute("rpy") {
        suspect_degrees(&format!("{}: rpy", origin.subject), [roll, pitch, yaw], &value, cx);
    }
    let R = quaternion?.unwrap_or_else(|| SO3::from_rpy(roll, pitch, yaw));
    Some(SE3 { R, p: Vec3(xyz?) })
}

/// A warning if angles in radians are whole numbers beyond two turns; the widest angle of published robots is 3π/2.
pub(crate) fn suspect_degrees(what: &str, angles: [f64; 3], value: &Value, cx: &mut Context) {
    let is_degrees = |x: &f64| x.abs() > 4.0 * core::f64::consts::PI && x.abs() <= 720.0 && x % 1.0 == 0.0;
    if let Some(angle) = angles.into_iter().find(is_degrees) {
        let message = format!("{what}: has an angle of {angle} radians: in degrees?");
        cx.findings.add(Finding::warning("degrees", value.span.clone(), message));
    }
}

/// The rotation of `quat_xyzw`, if the element has one and the version of the file defines it; None, with a diagnostic,
/// if it cannot be read.
fn quaternion(origin: &Element, cx: &mut Context) -> Option<Option<SO3>> {
    let Some(value) = origin.attribute("quat_xyzw") else { return Some(None) };
    let subject = &origin.subject;
    if cx.version < Version::WITH_QUATERNIONS {
        let message = format!(
            "{subject}: quat_xyzw: is ignored: URDF {} does not define it, version {} does",
            cx.version,
            Version::WITH_QUATERNIONS
        );
        cx.repeat("quat_xyzw", Finding::warning("ignored_quaternion", value.span, message));
        return Some(None);
    }
    if origin.attribute("rpy").is_some() {
        let message = format!("{subject}: has both rpy and quat_xyzw, expected one of them");
        cx.findings.add(Finding::error("several_orientations", value.span, message));
        return None;
    }
    let [x, y, z, w] = origin.vector::<4>("quat_xyzw", &value, cx)?;
    let Some((R, length)) = rotation([x, y, z, w]) else {
        let message = format!("{subject}: quat_xyzw: is `{}`, expected a unit quaternion", shown(value.text.trim()));
        cx.findings.add(Finding::error("zero_axis", value.span, message));
        return None;
    };
    if (length - 1.0).abs() > SLACK {
        let text = shown(value.text.trim());
        let message = format!("{subject}: quat_xyzw: `{text}` has the length {length}, expected 1");
        cx.findings.add(Finding::warning("non_unit_quaternion", value.span, message));
    }
    Some(Some(R))
}

/// The rotation of a quaternion, and the quaternion's length; None if it has no direction.
pub(crate) fn rotation([x, y, z, w]: [f64; 4]) -> Option<(SO3, f64)> {
    let length = Vec3([Vec3([x, y, z]).norm(), w, 0.0]).norm();
    let is_direction = length > 1e-100 && length < 1e100;
    is_direction.then(|| (SO3::from_quaternion(w / length, Vec3([x, y, z]) * (1.0 / length)), length))
}

#[cfg(test)]
mod tests {
    use crate::{Loaded, parse};
    use mozzi::{SO3, Vec3};

    fn read(version: &str, origin: &str) -> Loaded {
        let text = format!(
            "<robot name='r'{version}><link name='a'/><link name='b'/><joint name='j' type='fixed'><parent link='a'/>\
             <child link='b'/><origin {origin}/></joint></robot>"
        );
        parse("a.urdf", text).expect("a robot")
    }

    #[test]
    fn a_quaternion_is_the_rotation_of_its_roll_pitch_and_yaw() {
        for (rpy, [x, y, z, w]) in [
            ([0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]),
            ([1.2, 0.0, 0.0], [0.6_f64.sin(), 0.0, 0.0, 0.6_f64.cos()]),
            ([0.0, 0.0, -0.8], [0.0, 0.0, -(0.4_f64.sin()), 0.4_f64.cos()]),
            ([core::f64::consts::FRAC_PI_2, 0.0, core::f64::consts::FRAC_PI_2], [0.5, 0.5, 0.5, 0.5]),
        ] {
            for scale in [1.0, -1.0, 1.0005, 3.0] {
                let given = [x, y, z, w].map(|x: f64| (x * scale).to_string()).join(" ");
                let robot = read(" version='1.1'", &format!("xyz='1 2 3' quat_xyzw='{given}'"));
                let T = robot.description.joints[0].origin;
                let R = SO3::from_rpy(rpy[0], rpy[1], rpy[2]);
                assert!((T.R.inverse() * R).log().norm() < 1e-15, "{given}");
                assert_eq!((T.p, robot.warnings.len()), (Vec3([1.0, 2.0, 3.0]), usize::from(scale == 3.0)));
            }
        }
    }

    #[test]
    fn before_1_1_there_is_no_quaternion() {
        for version in ["", " version='1.0'"] {
            let robot = read(version, "rpy='0 0 0.5' quat_xyzw='x'");
            assert_eq!(robot.description.joints[0].origin.R, SO3::from_rpy(0.0, 0.0, 0.5));
            let said: Vec<&str> = robot.warnings.iter().map(|warning| warning.code()).collect();
            assert_eq!(said, ["mozzi::urdf::ignored_quaternion"]);
        }
    }
}
