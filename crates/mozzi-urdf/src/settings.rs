//! How a file is read.

/// How strictly a file is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Policy {
    /// Warnings are errors.
    Strict,
    /// Errors refuse the file; warnings are reported.
    #[default]
    Default,
    /// Unphysical inertias are replaced by the nearest physical ones, with a warning.
    Lenient,
}

/// How a file is read: a [`Policy`], and the inputs of xacro.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Settings {
    /// How strictly.
    pub policy: Policy,
    /// Arguments and packages for a file of xacro, and texts instead of files that it or an MJCF file includes.
    pub xacro: mozzi_xacro::Arguments,
}

impl From<Policy> for Settings {
    fn from(policy: Policy) -> Self {
        Settings { policy, ..Settings::default() }
    }
}
