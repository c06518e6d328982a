//! The words of which columns' names are made.

/// A quantity of each joint, as an index of the groups of columns.
pub const THETA: usize = 0;
pub const DTHETA: usize = 1;
pub const DDTHETA: usize = 2;
pub const TAU: usize = 3;

/// How a value came about; smaller is preferred.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Origin {
    Measured,
    Unnamed,
    Target,
    Desired,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Word {
    Quantity(usize),
    /// A motor's current, which is a force once its gain is known.
    Current,
    Origin(Origin),
    Motor,
    Link,
    /// A word without information: `joint_position`, `joint_states`.
    Filler,
    Number(usize),
    /// The name of something else, such as a tool's force or an error.
    Other,
    Unknown,
}

const QUANTITIES: [(&[&str], usize); 4] = [
    (&["theta", "q", "qpos", "pos", "position", "angle", "ang", "θ"], THETA),
    (
        &[
            "dtheta",
            "qd",
            "dq",
            "qdot",
            "qvel",
            "dqdt",
            "vel",
            "velocity",
            "velocitie",
            "speed",
            "omega",
            "thetadot",
            "θdot",
        ],
        DTHETA,
    ),
    (&["ddtheta", "qdd", "ddq", "qddot", "qacc", "acc", "accel", "acceleration", "thetaddot", "θddot"], DDTHETA),
    (&["tau", "torque", "effort", "moment", "force", "qfrc", "trq", "trque", "tq", "eff", "τ"], TAU),
];

const WORDS: [(Word, &[&str]); 8] = [
    (Word::Current, &["current", "cur", "curr", "amp", "iq", "i", "amperage"]),
    (
        Word::Origin(Origin::Measured),
        &[
            "actual",
            "act",
            "measured",
            "meas",
            "msr",
            "real",
            "feedback",
            "fb",
            "fbk",
            "sensed",
            "present",
            "ist",
            "est",
            "estimated",
            "estimate",
            "applied",
        ],
    ),
    (Word::Origin(Origin::Target), &["target", "tgt"]),
    (
        Word::Origin(Origin::Desired),
        &[
            "desired",
            "des",
            "d",
            "command",
            "commanded",
            "cmd",
            "ref",
            "reference",
            "setpoint",
            "sp",
            "goal",
            "planned",
            "soll",
        ],
    ),
    (Word::Motor, &["motor", "mot", "rotor", "drive"]),
    (Word::Link, &["link", "linkside", "sensor"]),
    (
        Word::Filler,
        &[
            "joint",
            "jnt",
            "j",
            "axis",
            "ax",
            "state",
            "robot",
            "field",
            "data",
            "value",
            "msg",
            "angular",
            "a",
            "arm",
            "robotstate",
            "jointstate",
            "jointstates",
            "output",
            "no",
            "dof",
            "actuator",
        ],
    ),
    (
        Word::Other,
        &[
            "tcp",
            "tool",
            "cartesian",
            "cart",
            "ee",
            "eef",
            "flange",
            "wrench",
            "pose",
            "imu",
            "temperature",
            "temp",
            "voltage",
            "volt",
            "error",
            "err",
            "ext",
            "external",
            "hat",
            "residual",
            "derivative",
            "dtau",
            "mode",
            "status",
            "limit",
            "max",
            "min",
            "stiffness",
            "damping",
            "gain",
            "raw",
            "scaling",
            "fraction",
            "momentum",
            "variance",
            "std",
            "covariance",
            "bits",
            "gripper",
            "gravity",
            "grav",
            "friction",
            "coriolis",
            "inertial",
            "model",
            "predicted",
        ],
    ),
];

/// Combining dots above a letter: `q̇` is `qdot`, `q̈` is `qddot`.
const DOTS: [(char, &str); 2] = [('\u{307}', "dot"), ('\u{308}', "ddot")];

/// The words of a text in lower case, with their places: runs of letters or of digits; `jointPosition` has two words.
pub fn words(text: &str) -> Vec<(std::ops::Range<usize>, String)> {
    let mut found: Vec<(std::ops::Range<usize>, String)> = Vec::new();
    let mut before: Option<char> = None;
    for (k, written) in text.char_indices() {
        let c = digit(written);
        if c.is_alphanumeric() {
            let continues = before.is_some_and(|last| {
                last.is_alphanumeric()
                    && last.is_ascii_digit() == c.is_ascii_digit()
                    && !(last.is_lowercase() && c.is_uppercase())
            });
            if !continues {
                found.push((k..k, String::new()));
            }
            if let Some((range, word)) = found.last_mut() {
                word.extend(c.to_lowercase());
                range.end = k + written.len_utf8();
            }
        } else if let (Some((_, dots)), Some((range, word))) =
            (DOTS.iter().find(|(dots, _)| *dots == c), found.last_mut())
            && range.end == k
        {
            word.push_str(dots);
            range.end = k + written.len_utf8();
        }
        before = Some(c);
    }
    found
}

/// q₁ is q1.
fn digit(c: char) -> char {
    match c {
        '₀'..='₉' => char::from_digit(u32::from(c) - u32::from('₀'), 10).unwrap_or(c),
        _ => c,
    }
}

/// The meaning of a word in lower case.
pub fn word(text: &str) -> Word {
    if text.bytes().all(|byte| byte.is_ascii_digit()) {
        return text.parse().map_or(Word::Unknown, Word::Number);
    }
    let singular = text.strip_suffix('s').filter(|one| one.len() > 2).unwrap_or(text);
    let is_of = |all: &[&str]| all.contains(&text) || all.contains(&singular);
    if let Some((_, quantity)) = QUANTITIES.iter().find(|(all, _)| is_of(all)) {
        return Word::Quantity(*quantity);
    }
    WORDS.iter().find(|(_, all)| is_of(all)).map_or(Word::Unknown, |(word, _)| *word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_split_into_words() {
        let of = |text: &str| words(text).into_iter().map(|(_, word)| word).collect::<Vec<_>>();
        assert_eq!(of("actual_qd_0"), ["actual", "qd", "0"]);
        assert_eq!(of("tau_J[3]"), ["tau", "j", "3"]);
        assert_eq!(of("jointPosition12"), ["joint", "position", "12"]);
        assert_eq!(of("q₁₂"), ["q", "12"]);
        assert_eq!(of("θ\u{307}_1 q\u{308}2"), ["θdot", "1", "qddot", "2"]);
        assert_eq!([word("θdot"), word("qddot")], [Word::Quantity(DTHETA), Word::Quantity(DDTHETA)]);
        assert_eq!(word("efforts"), Word::Quantity(TAU));
        assert_eq!(word("velocities"), Word::Quantity(DTHETA));
        assert_eq!(word("temperatures"), Word::Other);
        assert_eq!(word("elbow"), Word::Unknown);
    }
}
