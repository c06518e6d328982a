//! `<origin>`: one frame seen from another.

use crate::context::Context;
use crate::element::Element;
use crate::finding::Finding;
use crate::vocabulary::ORIGIN;
use mozzi::{SE3, SO3, Vec3};

/// Zeros where nothing is said; None, and reported, when it cannot be read.
pub(crate) fn read(origin: &Element, cx: &mut Context) -> Option<SE3> {
    origin.check_attributes(&ORIGIN, cx);
    origin.check_children(&ORIGIN, cx);
    let mut vector = |name| match origin.attribute(name) {
        Some(value) => origin.vector::<3>(name, &value, cx),
        None => Some([0.0; 3]),
    };
    let (xyz, rpy) = (vector("xyz"), vector("rpy"));
    let [roll, pitch, yaw] = rpy?;
    // whole numbers beyond two turns; the widest angle of published robots is 3π/2
    let is_degrees = |x: &f64| x.abs() > 4.0 * core::f64::consts::PI && x.abs() <= 720.0 && x % 1.0 == 0.0;
    if let (Some(angle), Some(value)) = ([roll, pitch, yaw].into_iter().find(is_degrees), origin.attribute("rpy")) {
        let message = format!("{}: rpy: has an angle of {angle} radians: in degrees?", origin.subject);
        cx.findings.add(Finding::warning("degrees", value.span, message));
    }
    Some(SE3 { R: SO3::from_rpy(roll, pitch, yaw), p: Vec3(xyz?) })
}
