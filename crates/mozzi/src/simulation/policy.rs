//! What is made of a limit.

/// What happens where a robot would go beyond a limit; nothing of it is silent but what is to be ignored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Policy {
    /// The limit is not looked at.
    Ignore,
    /// The robot goes beyond it, and that is noted.
    Report,
    /// The robot is kept from it, and that is noted.
    Respect,
}
