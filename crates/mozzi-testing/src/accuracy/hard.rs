//! Robots and states that are hard by design, as URDF texts with numbers of few digits.

use crate::accuracy::robot::Robot;
use crate::accuracy::states::Kind;
use std::fmt::Write;

/// A URDF text, built link by link.
struct Text(String);

impl Text {
    fn new(name: &str) -> Self {
        Text(format!("<robot name=\"{name}\"><link name=\"base\"/>"))
    }

    /// Adds a link on a joint about `axis`, at `xyz` in its parent's frame, rotated by `rpy`: a body with this mass and
    /// the size `length`.
    #[rustfmt::skip]
    #[allow(clippy::too_many_arguments)] // the data of a link and its joint
    fn link(&mut self, name: &str, parent: &str, axis: &str, xyz: &str, rpy: &str, mass: f64, length: f64) {
        let I = |share: f64| format!("{:e}", (share * mass * length * length * 1e6).round() / 1e6);
        let I = |share: f64| if mass * length * length < 1e-3 { format!("{:e}", share * mass * length * length) } else { I(share) };
        write!(self.0,
            "<link name=\"{name}\"><inertial><origin xyz=\"{:.6} {:.6} {:.6}\" rpy=\"0.1 -0.2 0.3\"/><mass value=\"{mass:e}\"/>\
             <inertia ixx=\"{}\" ixy=\"{}\" ixz=\"0\" iyy=\"{}\" iyz=\"0\" izz=\"{}\"/></inertial></link>\
             <joint name=\"{name}_joint\" type=\"continuous\"><parent link=\"{parent}\"/><child link=\"{name}\"/>\
             <origin xyz=\"{xyz}\" rpy=\"{rpy}\"/><axis xyz=\"{axis}\"/></joint>",
            0.1 * length, 0.05 * length, 0.45 * length, I(0.08), I(0.01), I(0.09), I(0.03),
        ).expect("a text grows");
    }

    fn end(mut self) -> String {
        self.0.push_str("</robot>");
        self.0
    }
}

/// A chain of links with given masses.
fn chain(name: &str, masses: &[f64], length: f64) -> String {
    let (mut text, mut parent) = (Text::new(name), "base".to_string());
    for (i, &mass) in masses.iter().enumerate() {
        let (link, axis) = (format!("link{}", i + 1), ["0 0 1", "0 1 0", "1 0 0", "0 0.6 0.8"][i % 4]);
        let xyz = if i == 0 { "0 0 0.3".into() } else { format!("0 0 {length}") };
        text.link(&link, &parent, axis, &xyz, "0.1 0 -0.2", mass, length);
        parent = link;
    }
    text.end()
}

/// An arm of 1.5 m with a hand of fifteen finger links of 10 g.
fn hand() -> String {
    let (mut text, mut parent) = (Text::new("hand"), "base".to_string());
    for (i, mass) in [4.0, 4.0, 3.0, 3.0, 2.0, 1.5, 0.8].into_iter().enumerate() {
        let (link, axis) = (format!("link{}", i + 1), ["0 0 1", "0 1 0"][i % 2]);
        text.link(&link, &parent, axis, "0 0.01 0.2", "0 0 0", mass, 0.2);
        parent = link;
    }
    for finger in 1..=5 {
        let mut parent = parent.clone();
        for part in 1..=3 {
            let (link, xyz) = (format!("finger{finger}_{part}"), if part == 1 { "0.02 0.03 0.1" } else { "0 0 0.04" });
            text.link(&link, &parent, "0.8 0 0.6", xyz, "0 0 0.3", 0.01, 0.04);
            parent = link;
        }
    }
    text.end()
}

/// Their names, and the largest number of states at which each is measured.
pub const NAMES: [(&str, usize); 10] = [
    ("masses from 1e-6 to 1e6 kg", usize::MAX),
    ("a hand on an arm", usize::MAX),
    ("a chain of 100", 20),
    ("a chain of 1000", 1),
    ("a nearly singular mass matrix", usize::MAX),
    ("angles near multiples of π/2", usize::MAX),
    ("angles up to 10⁶", usize::MAX),
    ("rates up to 10⁴", usize::MAX),
    ("rates up to 10⁴, free base", usize::MAX),
    ("a free base 1 km from {s}", usize::MAX),
];

/// One of them.
///
/// # Errors
/// See [`Robot::parse`].
pub fn robot(name: &str) -> Result<Robot, String> {
    let embedded = |robot: &str| mozzi_urdf::embedded::text(robot).unwrap_or_default().to_string();
    let (text, floats, kind) = match name {
        "masses from 1e-6 to 1e6 kg" => {
            (chain(name, &[1e6, 1e-6, 1e3, 1e-3, 1.0, 1e-6, 1e6, 1e-2], 0.3), false, Kind::Ordinary)
        }
        "a hand on an arm" => (hand(), false, Kind::Ordinary),
        "a chain of 100" => (chain(name, &[0.5; 100], 0.1), false, Kind::Ordinary),
        "a chain of 1000" => (chain(name, &[0.5; 1000], 0.1), false, Kind::Ordinary),
        "a nearly singular mass matrix" => (chain(name, &[2.0, 1.0, 1e-9, 1e-10], 0.01), false, Kind::Ordinary),
        "angles near multiples of π/2" => (embedded("ur5"), false, Kind::RightAngles),
        "angles up to 10⁶" => (embedded("panda"), false, Kind::LargeAngles),
        "rates up to 10⁴" => (embedded("panda"), false, Kind::Fast),
        "rates up to 10⁴, free base" => (embedded("anymal"), true, Kind::Fast),
        "a free base 1 km from {s}" => (embedded("anymal"), true, Kind::Far),
        other => return Err(format!("there is no hard case `{other}`")),
    };
    Robot::parse(name, &text, floats, kind)
}
