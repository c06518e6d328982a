//! Units at the end of columns' names: `_deg`, `[deg/s]`, `(N m)`; and those of a row of units.

use std::f64::consts::{PI, TAU};

/// The dimension of a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    Time,
    Position,
    Velocity,
    Acceleration,
    Force,
    Current,
    /// Parts of a rated value, which the file does not hold.
    Share,
}

/// A unit: how it is written in notes, and its size in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    pub name: &'static str,
    pub dimension: Dimension,
    pub factor: f64,
}

impl Unit {
    /// Whether it is that of a joint that turns, or of one that slides; None for currents, times and parts.
    pub fn turns(self) -> Option<bool> {
        match self.dimension {
            Position | Velocity | Acceleration => {
                Some(["rad", "deg", "rev", "rpm"].iter().any(|of| self.name.contains(of)))
            }
            Force => Some(self.name.contains(' ')), // a force times a length
            Time | Current | Share => None,
        }
    }
}

const DEGREE: f64 = PI / 180.0;

use Dimension::{Acceleration, Current, Force, Position, Share, Time, Velocity};

/// Spellings without spaces, underscores, `*`, `·` and `^`, in lower case.
const UNITS: [(&[&str], &str, Dimension, f64); 46] = [
    (&["s", "sec", "secs", "second", "seconds"], "s", Time, 1.0),
    (&["ms", "msec", "msecs", "millis", "milliseconds"], "ms", Time, 1e-3),
    (&["us", "µs", "μs", "usec", "micros", "microseconds"], "µs", Time, 1e-6),
    (&["ns", "nsec", "nanos", "nanoseconds"], "ns", Time, 1e-9),
    (&["min", "minute", "minutes"], "min", Time, 60.0),
    (&["h", "hr", "hour", "hours"], "h", Time, 3600.0),
    (&["rad", "rads", "radian", "radians"], "rad", Position, 1.0),
    (&["mrad", "mrads"], "mrad", Position, 1e-3),
    (&["deg", "degs", "degree", "degrees", "°", "grad"], "deg", Position, DEGREE),
    (&["rev", "revs", "turn", "turns"], "rev", Position, TAU),
    (&["m", "meter", "meters", "metre", "metres"], "m", Position, 1.0),
    (&["cm"], "cm", Position, 1e-2),
    (&["mm", "millimeter", "millimeters"], "mm", Position, 1e-3),
    (&["rad/s", "rads-1", "rad/sec", "radps", "radpersec", "rad.s-1"], "rad/s", Velocity, 1.0),
    (&["mrad/s"], "mrad/s", Velocity, 1e-3),
    (&["deg/s", "degs-1", "deg/sec", "degps", "degpersec", "dps", "°/s"], "deg/s", Velocity, DEGREE),
    (&["rpm", "1/min", "rev/min"], "rpm", Velocity, TAU / 60.0),
    (&["rev/s", "rps"], "rev/s", Velocity, TAU),
    (&["m/s", "ms-1", "mps"], "m/s", Velocity, 1.0),
    (&["cm/s"], "cm/s", Velocity, 1e-2),
    (&["mm/s"], "mm/s", Velocity, 1e-3),
    (&["rad/s2", "rad/s²", "rads-2", "rad/s/s", "rad/sec2"], "rad/s²", Acceleration, 1.0),
    (&["deg/s2", "deg/s²", "degs-2", "°/s²", "°/s2", "deg/sec2"], "deg/s²", Acceleration, DEGREE),
    (&["m/s2", "m/s²"], "m/s²", Acceleration, 1.0),
    (&["mm/s2", "mm/s²"], "mm/s²", Acceleration, 1e-3),
    (&["nm", "n.m", "n-m", "newtonmeter", "newtonmeters"], "N m", Force, 1.0),
    (&["mnm", "mn.m"], "mN m", Force, 1e-3),
    (&["nmm", "n.mm"], "N mm", Force, 1e-3),
    (&["cnm"], "cN m", Force, 1e-2),
    (&["ncm", "n.cm"], "N cm", Force, 1e-2),
    (&["knm", "kn.m"], "kN m", Force, 1e3),
    (&["lbfin", "lbin", "inlb", "in-lb", "inlbf", "in-lbf", "lbf-in"], "lbf in", Force, 0.112_984_829),
    (&["lbfft", "lbft", "ftlb", "ft-lb", "ftlbf", "ft-lbf", "lbf-ft"], "lbf ft", Force, 1.355_817_948),
    (&["kgfcm", "kgcm", "kgf-cm", "kg-cm", "kgf.cm", "kg.cm"], "kgf cm", Force, 0.098_066_5),
    (&["kgfm", "kgm", "kgf-m", "kg-m"], "kgf m", Force, 9.806_65),
    (&["n", "newton", "newtons"], "N", Force, 1.0),
    (&["mn"], "mN", Force, 1e-3),
    (&["kn"], "kN", Force, 1e3),
    (&["a", "amp", "amps", "ampere", "amperes"], "A", Current, 1.0),
    (&["ma", "milliamp", "milliamps"], "mA", Current, 1e-3),
    (&["‰", "permille", "promille", "permil", "0/00"], "per mille", Share, 1e-3),
    (&["%", "percent", "pct"], "%", Share, 1e-2),
    (&["radian/s", "radians/s"], "rad/s", Velocity, 1.0),
    (&["degree/s", "degrees/s"], "deg/s", Velocity, DEGREE),
    (&["rad/ms"], "rad/ms", Velocity, 1e3),
    (&["deg/ms"], "deg/ms", Velocity, 1e3 * DEGREE),
];

/// Longer texts are no units.
const LONGEST: usize = 32;

/// A unit by one of its spellings.
pub fn unit(text: &str) -> Option<Unit> {
    if text.len() > LONGEST {
        return None; // every ending of a long name is tried
    }
    let spelled: String = text.trim().to_lowercase().chars().filter(|c| !" *·⋅^".contains(*c)).collect();
    let spelled = spelled.trim_matches(['[', ']', '(', ')']).replace("_per_", "/").replace("_s", "/s").replace('_', "");
    let (_, name, dimension, factor) = UNITS.iter().find(|(all, ..)| all.contains(&spelled.as_str()))?;
    Some(Unit { name, dimension: *dimension, factor: *factor })
}

/// A velocity or acceleration that is written in a unit of positions: `qd_deg` is in deg/s.
pub fn per_second(unit: Unit, dimension: Dimension) -> Option<Unit> {
    let time = match dimension {
        Velocity => "/s",
        Acceleration => "/s²",
        _ => return None,
    };
    let found = UNITS.iter().find(|(_, name, of, _)| *of == dimension && name.strip_suffix(time) == Some(unit.name));
    found.map(|(_, name, _, factor)| Unit { name, dimension, factor: *factor })
}

/// The name without its unit. `may_be` decides whether the rest can do without the ending: a joint may be called `a`.
pub fn split(name: &str, may_be: impl Fn(&str, Unit) -> bool) -> Option<(&str, Unit)> {
    let name = name.trim_end();
    if let Some(inner) = name.strip_suffix([']', ')', '}']) {
        let (rest, text) = inner.rsplit_once(['[', '(', '{'])?;
        return unit(text).filter(|found| may_be(rest, *found)).map(|found| (rest.trim_end_matches(['_', ' ']), found));
    }
    // the longest ending first: `deg_s` before `s`
    name.char_indices().filter(|(_, c)| "_ .:-".contains(*c)).find_map(|(k, c)| {
        let (rest, text) = (&name[..k], &name[k + c.len_utf8()..]);
        unit(text).filter(|found| !rest.is_empty() && may_be(rest, *found)).map(|found| (rest, found))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_split_off_where_the_rest_can_do_without() {
        let of = |name| split(name, |_, _| true).map(|(rest, unit)| (rest, unit.name));
        assert_eq!(of("q1_deg"), Some(("q1", "deg")));
        assert_eq!(of("q1 [deg/s]"), Some(("q1", "deg/s")));
        assert_eq!(of("vel_elbow_deg_s"), Some(("vel_elbow", "deg/s")));
        assert_eq!(of("Torque 1 (N m)"), Some(("Torque 1", "N m")));
        assert_eq!(of("tau_1_mNm"), Some(("tau_1", "mN m")));
        assert_eq!(of("q[0]"), None);
        assert_eq!(of("tau_elbow"), None);
        assert!(split("effort_a", |rest, _| rest != "effort").is_none());
        assert_eq!(unit("[rad/s^2]").map(|unit| unit.name), Some("rad/s²"));
    }
}
