//! How to treat a limit.

/// How to treat a limit that a robot would exceed. Everything but `Ignore` is reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Policy {
    /// The limit is not checked.
    Ignore,
    /// The robot may exceed the limit, and this is reported.
    Report,
    /// The robot is kept within the limit, and this is reported.
    Respect,
}
