//! Embedded robots, each with the source of its numbers in its file.

use std::path::Path;

/// Name and text.
const ROBOTS: [(&str, &str); 6] = [
    ("anymal", include_str!("../models/anymal.urdf")),
    ("double_pendulum", include_str!("../models/double_pendulum.urdf")),
    ("furuta_pendulum", include_str!("../models/furuta_pendulum.urdf")),
    ("panda", include_str!("../models/panda.urdf")),
    ("two_link_planar", include_str!("../models/two_link_planar.urdf")),
    ("ur5", include_str!("../models/ur5.urdf")),
];

/// The names, in alphabetical order.
pub fn names() -> impl ExactSizeIterator<Item = &'static str> {
    ROBOTS.iter().map(|&(name, _)| name)
}

/// The URDF text of a robot, unless there is a file of this name, which takes precedence.
pub fn unless_file(name: &str) -> Option<&'static str> {
    text(name).filter(|_| !Path::new(name).is_file())
}

/// The URDF text of a robot.
pub fn text(name: &str) -> Option<&'static str> {
    ROBOTS.iter().find(|&&(known, _)| known == name).map(|&(_, text)| text)
}
