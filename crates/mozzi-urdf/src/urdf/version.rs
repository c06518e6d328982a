//! The version of URDF that a file declares, as `urdfdom` 6 reads it: 1.0, 1.1 or 1.2.
//!
//! 1.1 has quaternions in `<origin>` and capsules; 1.2 has limits of acceleration, deceleration and jerk, and makes
//! `effort` and `velocity` optional.

use crate::report::finding::Finding;
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::vocabulary::shown;

/// A version; the major number is 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Version {
    minor: u32,
}

impl Version {
    /// The first version with `quat_xyzw`.
    pub const WITH_QUATERNIONS: Version = Version { minor: 1 };
    /// The first version with limits of acceleration.
    pub const WITH_ACCELERATION: Version = Version { minor: 2 };
    /// The latest known version.
    const LATEST: Version = Version { minor: 2 };

    /// The version of a text such as `1.1`.
    fn parse(text: &str) -> Option<Self> {
        let (major, minor) = text.split_once('.')?;
        let number = |part: &str| part.trim_start().parse::<u32>().ok();
        let version = Version { minor: number(minor)? };
        (number(major)? == 1 && version <= Version::LATEST).then_some(version)
    }

    /// The version of a robot: 1.0 if it has none or, with a diagnostic, an unknown one.
    pub fn read(root: &Element, cx: &mut Context) -> Self {
        let Some(value) = root.attribute("version") else { return Version::default() };
        Version::parse(value.text).unwrap_or_else(|| {
            let message = format!("{}: version: is `{}`, expected 1.0, 1.1 or 1.2", root.subject, shown(value.text));
            cx.findings.add(Finding::error("unsupported_version", value.span, message));
            Version::default()
        })
    }
}

impl core::fmt::Display for Version {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "1.{}", self.minor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_those_of_urdfdom() {
        for (text, minor) in [("1.0", 0), ("1.1", 1), ("1.2", 2), ("01.1", 1), (" 1.01", 1), ("+1.1", 1)] {
            assert_eq!(Version::parse(text), Some(Version { minor }), "{text}");
        }
        for text in ["", "1", "2", "2.0", "1.3", "1.10", "0.9", "-1.0", "1.0.0", "1.1 ", "1.", ".1", "1.1~a", "foo"] {
            assert_eq!(Version::parse(text), None, "{text}");
        }
        assert_eq!(Version::WITH_QUATERNIONS.to_string(), "1.1");
    }
}
