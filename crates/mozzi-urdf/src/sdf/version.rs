//! The version of a file, which decides what its words mean.

use crate::report::finding::Finding;
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::vocabulary::shown;

/// Minor version: 9 is SDFormat 1.9.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Version(u32);

impl Version {
    /// The first and the last that are read.
    const READ: [u32; 2] = [4, 12];
    /// Axes are given in the joint's frame; before, in the model's.
    pub const WITH_AXES_IN_JOINT: Version = Version(5);
    /// `relative_to`, `expressed_in`, `attached_to`, and one space of names for links, joints and frames.
    pub const WITH_FRAMES: Version = Version(7);

    /// The version of these words, if it is read.
    pub fn of(text: &str) -> Option<Self> {
        let [first, last] = Self::READ;
        let minor = text.trim().strip_prefix("1.").and_then(|minor| minor.parse::<u32>().ok());
        minor.filter(|minor| (first..=last).contains(minor)).map(Version)
    }

    /// That of the root element; the newest, with a diagnostic, if it is not read.
    pub fn read(root: &Element, cx: &mut Context) -> Self {
        let [first, last] = Self::READ;
        let Some(value) = root.required("version", cx) else { return Version(last) };
        if let Some(version) = Version::of(value.text) {
            return version;
        }
        let message = format!("sdf: version: is `{}`, expected 1.{first} to 1.{last}", shown(value.text));
        cx.findings.add(Finding::error("unsupported_version", value.span, message));
        Version(last)
    }
}
