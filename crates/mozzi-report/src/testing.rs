//! A robot with balls and free joints.

use mozzi::Description;

/// An arm with two balls, and two free bodies.
pub fn balls() -> Description {
    let text = include_str!("../tests/balls.xml");
    mozzi_urdf::parse("balls.xml", text).expect("sound").description
}
