//! `<origin>`: one frame seen from another.

use crate::context::Context;
use crate::element::Element;
use crate::words::ORIGIN;
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
    Some(SE3 { R: SO3::from_rpy(roll, pitch, yaw), p: Vec3(xyz?) })
}
