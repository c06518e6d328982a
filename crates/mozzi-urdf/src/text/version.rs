//! The version of URDF that a file declares, as `urdfdom` 6 reads it: 1.0, 1.1 or 1.2.
//!
//! 1.1 has quaternions in `<origin>` and capsules; 1.2 has limits of acceleration, deceleration and jerk, and makes
//! `effort` and `velocity` optional.

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
    pub const LATEST: Version = Version { minor: 2 };

    /// The version of a text such as `1.1`.
    pub fn parse(text: &str) -> Option<Self> {
        let (major, minor) = text.split_once('.')?;
        let number = |part: &str| part.trim_start().parse::<u32>().ok();
        let version = Version { minor: number(minor)? };
        (number(major)? == 1 && version <= Version::LATEST).then_some(version)
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
