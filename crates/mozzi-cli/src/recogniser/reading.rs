//! The reading of one column's name: quantity, origin, unit, and entry.

use super::unit::{self, Dimension, Unit};
use super::word::{DDTHETA, DTHETA, Origin, TAU, THETA, Word, word, words};

/// The joint that a column names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Entry {
    /// One of the given names, by its index.
    Known(usize),
    /// A number.
    Index(usize),
    /// A name that is not one of the given ones as it is written.
    Name(String),
    /// None: enough for a robot of one joint.
    Missing,
}

/// Columns of one kind; smaller is preferred: torques before currents, measured before target before desired values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Kind {
    pub is_current: bool,
    pub origin: Origin,
    /// 0 for the preferred side of the gear: the motor's of a force, the joint's of a motion.
    pub side: u8,
}

impl Kind {
    pub const PLAIN: Kind = Kind { is_current: false, origin: Origin::Unnamed, side: 1 };
}

/// A column's name, read.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    pub quantity: usize,
    pub kind: Kind,
    pub unit: Option<Unit>,
    pub entry: Entry,
    /// The text before the last `/` or `.` before quantity and entry: a topic.
    pub path: String,
}

/// Reads a name; names of joints that occur in it as they are written come first, the longest before others.
pub fn read(name: &str, joints: &[&str], row_unit: Option<Unit>) -> Option<Reading> {
    exact(name, joints, row_unit).or_else(|| generic(name, row_unit))
}

/// Places at which a joint's name stands by itself.
pub(super) fn places<'n>(name: &'n str, joint: &'n str) -> impl Iterator<Item = (&'n str, &'n str)> {
    let is_apart = |c: Option<char>| c.is_none_or(|c| !c.is_alphanumeric());
    name.match_indices(joint).filter_map(move |(k, _)| {
        let (before, after) = (&name[..k], &name[k + joint.len()..]);
        (is_apart(before.chars().next_back()) && is_apart(after.chars().next())).then_some((before, after))
    })
}

fn exact(name: &str, joints: &[&str], row_unit: Option<Unit>) -> Option<Reading> {
    let mut order: Vec<usize> = (0..joints.len()).filter(|&k| !joints[k].is_empty()).collect();
    order.sort_by_key(|&k| std::cmp::Reverse(joints[k].len()));
    order.into_iter().find_map(|k| {
        places(name, joints[k]).find_map(|(before, after)| {
            // `theta_x_ma` of a joint `x_ma` has no unit
            let (rest, unit) = match unit::split(after, |_, _| true).or_else(|| Some(("", unit::unit(after)?))) {
                Some((rest, unit)) => (rest, Some(unit)),
                None => (after, None),
            };
            let cut = before.rfind(['/', '.']).map_or(0, |k| k + 1);
            let (path, glued) = before.split_at(cut);
            // `/joint_states/elbow/state/effort`: the quantity is the last part
            let (inner, last) = rest.rsplit_once('/').unwrap_or(("", rest));
            let mut meaning = Meaning::default();
            for (is_path, text) in [(true, path), (false, glued), (true, inner), (false, last)] {
                meaning.take(text, is_path)?;
            }
            meaning.reading(unit.or(row_unit), Entry::Known(k), path)
        })
    })
}

/// A name without one of the robot's joints: `q1`, `joint_states/position[3]`, `effort_elbow`.
fn generic(name: &str, row_unit: Option<Unit>) -> Option<Reading> {
    let found = at_the_end(name, row_unit);
    let has_number = found.as_ref().is_some_and(|found| matches!(found.entry, Entry::Index(_)));
    if has_number { found } else { before_the_number(name).or(found) }
}

/// With the unit before the number: `position_deg_0`, `velocity_deg_s[3]`.
fn before_the_number(name: &str) -> Option<Reading> {
    let end = name.trim_end_matches([']', ')']);
    let bare = end.trim_end_matches(|c: char| c.is_ascii_digit());
    let (number, before) = (&end[bare.len()..], bare.trim_end_matches(['_', '[', '(', '.', ' ']));
    let (rest, unit) = unit::split(before, |_, unit| unit.name.len() > 1).filter(|_| !number.is_empty())?;
    of_components(&format!("{rest}_{number}"), Some(unit))
}

fn at_the_end(name: &str, row_unit: Option<Unit>) -> Option<Reading> {
    let whole = |text: &str, unit: Option<Unit>| of_components(text, unit.or(row_unit));
    let split = unit::split(name, |rest, unit| {
        let found = of_components(rest, Some(unit));
        found.is_some_and(|found| found.entry != Entry::Missing || unit.name.len() > 1)
    });
    match split {
        Some((rest, unit)) => whole(rest, Some(unit)),
        None => whole(name, None),
    }
}

fn of_components(name: &str, unit: Option<Unit>) -> Option<Reading> {
    let separator = if name.contains('/') { '/' } else { '.' };
    let parts: Vec<&str> = name.split(separator).filter(|part| !part.is_empty()).collect();
    let holds_quantity = |part: &&str| {
        let known = |(_, text): (_, String)| matches!(word(&text), Word::Quantity(_) | Word::Current);
        words(part).into_iter().any(known)
    };
    let at = parts.iter().rposition(holds_quantity).unwrap_or(parts.len().checked_sub(1)?);
    let mut meaning = Meaning::default();
    for part in parts.iter().take(at) {
        meaning.take(part, true)?;
    }
    let (mut entry, after) = meaning.own(parts[at])?;
    let rest = parts[at + 1..].join(&separator.to_string());
    let mut path_end = at;
    if after && entry == Entry::Missing && !rest.is_empty() {
        entry = entry_of(&rest);
    } else if !rest.is_empty() {
        return None;
    } else if entry == Entry::Missing && at > 0 {
        // `/joint_states/elbow/position`
        let before = entry_of(parts[at - 1]);
        if before != Entry::Missing {
            (entry, path_end) = (before, at - 1);
        }
    }
    meaning.reading(unit, entry, &parts[..path_end].join(&separator.to_string()))
}

/// A number among fillers, or a name.
fn entry_of(text: &str) -> Entry {
    // an entry of an array: `motor_state[3]`
    let number = text.strip_suffix(']').and_then(|rest| rest.rsplit_once('[')?.1.parse().ok());
    if let Some(k) = number {
        return Entry::Index(k);
    }
    let found = words(text);
    let mut numbers = found.iter().filter_map(|(_, text)| match word(text) {
        Word::Number(k) => Some(k),
        _ => None,
    });
    let is_plain = |text: &str| matches!(word(text), Word::Filler | Word::Number(_));
    if found.iter().all(|(_, text)| is_plain(text)) {
        return match (numbers.next(), numbers.next()) {
            (Some(k), None) => Entry::Index(k),
            // a joint may be called `a` or `j`
            (None, _) if matches!(found.as_slice(), [(_, one)] if one.len() == 1) => Entry::Name(text.to_string()),
            (None, _) => Entry::Missing,
            _ => Entry::Name(text.to_string()),
        };
    }
    Entry::Name(text.trim_matches(|c: char| !c.is_alphanumeric()).to_string())
}

/// The words found so far.
#[derive(Default)]
struct Meaning {
    quantity: Option<usize>,
    has_current: bool,
    origin: Option<Origin>,
    side: Option<Word>,
}

impl Meaning {
    /// Takes the words of a text without an entry; None if one belongs to something else.
    fn take(&mut self, text: &str, is_path: bool) -> Option<()> {
        for (_, text) in words(text) {
            match word(&text) {
                _ if is_path && text == "d" => {}
                Word::Other => return None,
                Word::Unknown | Word::Number(_) | Word::Quantity(_) | Word::Current if is_path => {}
                Word::Unknown if self.derivative(&text) => {}
                Word::Unknown | Word::Number(_) => return None,
                word => self.add(word),
            }
        }
        Some(())
    }

    /// `q_dot` is a velocity.
    fn derivative(&mut self, text: &str) -> bool {
        match (self.quantity, text) {
            (Some(THETA), "dot") => self.quantity = Some(DTHETA),
            (Some(THETA), "ddot" | "dd") => self.quantity = Some(DDTHETA),
            _ => return false,
        }
        true
    }

    fn add(&mut self, word: Word) {
        match word {
            Word::Quantity(found) => self.quantity = Some(found),
            Word::Current => self.has_current = true,
            Word::Origin(origin) => self.origin = Some(self.origin.map_or(origin, |known| known.max(origin))),
            Word::Motor | Word::Link => self.side = Some(word),
            _ => {}
        }
    }

    /// Takes the component with the quantity; the entry in it, and whether one may follow.
    fn own(&mut self, text: &str) -> Option<(Entry, bool)> {
        let found = words(text);
        if found.iter().any(|(_, text)| word(text) == Word::Other) {
            return None;
        }
        let is_quantity = |k: &usize| matches!(word(&found[*k].1), Word::Quantity(_) | Word::Current);
        let is_entry = |text: &str| matches!(word(text), Word::Unknown | Word::Number(_));
        let quantities: Vec<usize> = (0..found.len()).filter(is_quantity).collect();
        let (Some(&first), Some(&last)) = (quantities.first(), quantities.last()) else {
            // the unit alone says the quantity: `J1 (deg)`
            return Some((entry_of(text), false));
        };
        found[first..=last].iter().for_each(|(_, text)| self.add(word(text)));
        let (mut begin, mut end) = (last + 1, found.len());
        let before_is_entry = found[..first].iter().any(|(_, text)| is_entry(text));
        while begin < end && self.derivative(&found[begin].1) {
            begin += 1;
        }
        let is_origin = |text: &str| matches!(word(text), Word::Origin(_) | Word::Motor | Word::Link);
        while begin < end && (is_origin(&found[begin].1) || found[begin].1 == "j") {
            self.add(word(&found[begin].1));
            begin += 1;
        }
        while begin < end && is_origin(&found[end - 1].1) {
            self.add(word(&found[end - 1].1));
            end -= 1;
        }
        let piece = |range: std::ops::Range<usize>| match range.is_empty() {
            true => "",
            false => &text[found[range.start].0.start..found[range.end - 1].0.end],
        };
        let mut start = 0;
        while start < first && is_origin(&found[start].1) {
            self.add(word(&found[start].1));
            start += 1;
        }
        let mut stop = first;
        while stop > start && is_origin(&found[stop - 1].1) {
            self.add(word(&found[stop - 1].1));
            stop -= 1;
        }
        if before_is_entry {
            return (begin == end).then(|| (entry_of(piece(start..stop)), false));
        }
        found[start..stop].iter().for_each(|(_, text)| self.add(word(text)));
        Some((entry_of(piece(begin..end)), true))
    }

    fn reading(self, unit: Option<Unit>, entry: Entry, path: &str) -> Option<Reading> {
        let mut origin = self.origin.unwrap_or(Origin::Unnamed);
        let (quantity, is_current) = match (self.quantity, self.has_current) {
            // the torque-producing current
            (Some(TAU), true) | (None, true) => (TAU, true),
            // the position now
            (Some(quantity), true) => {
                origin = origin.min(Origin::Measured);
                (quantity, false)
            }
            (Some(quantity), false) => (quantity, false),
            (None, false) => match unit?.dimension {
                Dimension::Position if unit?.name != "m" => (THETA, false),
                Dimension::Velocity => (DTHETA, false),
                Dimension::Acceleration => (DDTHETA, false),
                Dimension::Force if unit?.name.contains('m') => (TAU, false),
                Dimension::Current => (TAU, true),
                _ => return None,
            },
        };
        let is_current = is_current || unit.is_some_and(|unit| unit.dimension == Dimension::Current);
        let side = match (quantity == TAU, self.side) {
            (true, Some(Word::Motor)) | (false, Some(Word::Link)) => 0,
            (true, Some(_)) | (false, Some(_)) => 2,
            (_, None) => 1,
        };
        let kind = Kind { is_current, origin, side };
        let path = path.trim_end_matches(['/', '.']).to_string();
        Some(Reading { quantity, kind, unit, entry, path })
    }
}

/// Whether a unit suits a quantity.
pub fn suits(unit: Unit, quantity: usize) -> bool {
    match unit.dimension {
        Dimension::Position => quantity == THETA,
        Dimension::Velocity => quantity == DTHETA,
        Dimension::Acceleration => quantity == DDTHETA,
        Dimension::Force | Dimension::Current | Dimension::Share => quantity == TAU,
        Dimension::Time => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn generic_of(name: &str) -> Option<(usize, Entry)> {
        read(name, &[], None).map(|found| (found.quantity, found.entry))
    }

    #[test]
    fn names_are_read_in_many_ways() {
        let name = |text: &str| Entry::Name(text.to_string());
        for (text, quantity, entry) in [
            ("q1", THETA, Entry::Index(1)),
            ("qd_3", DTHETA, Entry::Index(3)),
            ("q_dot_3", DTHETA, Entry::Index(3)),
            ("actual_q_0", THETA, Entry::Index(0)),
            ("target_moment_0", TAU, Entry::Index(0)),
            ("tau_J[0]", TAU, Entry::Index(0)),
            ("state.q[6]", THETA, Entry::Index(6)),
            ("field.position0", THETA, Entry::Index(0)),
            ("/joint_states/position[2]", THETA, Entry::Index(2)),
            ("/joint_states/velocity.2", DTHETA, Entry::Index(2)),
            ("/joint_states/elbow/position", THETA, name("elbow")),
            ("/joint_states/position/elbow", THETA, name("elbow")),
            ("elbow.velocity", DTHETA, name("elbow")),
            ("pos_a", THETA, name("a")),
            ("A2_pos", THETA, Entry::Index(2)),
            ("effort_wrist_1_joint", TAU, name("wrist_1_joint")),
            ("wrist_1_joint_effort", TAU, name("wrist_1_joint")),
            ("Joint 2 Position (deg)", THETA, Entry::Index(2)),
            ("J1 [deg]", THETA, Entry::Index(1)),
            ("J2_pos_rad", THETA, Entry::Index(2)),
            ("joint_position_1", THETA, Entry::Index(1)),
            ("jointVelocity1", DTHETA, Entry::Index(1)),
            ("current_position_1", THETA, Entry::Index(1)),
            ("position_deg_0", THETA, Entry::Index(0)),
            ("velocity_deg_s[3]", DTHETA, Entry::Index(3)),
            ("velocity_deg_s_2", DTHETA, Entry::Index(2)),
            ("motor_state[3].q", THETA, Entry::Index(3)),
            ("/lowstate/motor_state[3]/tau_est", TAU, Entry::Index(3)),
            ("actuators[2].position", THETA, Entry::Index(2)),
            ("qpos_1", THETA, Entry::Index(1)),
            ("qfrc_actuator_1", TAU, Entry::Index(1)),
            ("dof_pos_0", THETA, Entry::Index(0)),
            ("q₂", THETA, Entry::Index(2)),
            ("tau", TAU, Entry::Missing),
        ] {
            assert_eq!(generic_of(text), Some((quantity, entry)), "{text}");
        }
        for text in [
            "actual_TCP_force_0",
            "joint_temperatures_0",
            "tau_ext_hat_filtered[0]",
            "tau_gravity_0",
            "dtau_J[0]",
            "speed_scaling",
            "position_error_1",
            "label",
        ] {
            assert_eq!(generic_of(text), None, "{text}");
        }
        let desired = read("q_d[0]", &[], None).map(|found| (found.quantity, found.kind.origin));
        assert_eq!(desired, Some((THETA, Origin::Desired)));
        assert!(read("actual_current_0", &[], None).is_some_and(|found| found.kind.is_current));
        assert!(read("tau_1_mA", &[], None).is_some_and(|found| found.kind.is_current));
    }

    #[test]
    fn names_of_joints_come_first() {
        let joints = ["elbow_joint", "x_ma", "arm_deg", "arm", "J", "j", "a.b", "a_b"];
        let of = |text: &str| {
            let found = read(text, &joints, None)?;
            Some((found.quantity, found.entry, found.unit.map(|unit| unit.name)))
        };
        assert_eq!(of("/joint_states/elbow_joint/effort"), Some((TAU, Entry::Known(0), None)));
        assert_eq!(of("tau_x_ma"), Some((TAU, Entry::Known(1), None)));
        assert_eq!(of("theta_arm_deg"), Some((THETA, Entry::Known(2), None)));
        assert_eq!(of("theta_arm_deg_deg"), Some((THETA, Entry::Known(2), Some("deg"))));
        assert_eq!(of("theta_J"), Some((THETA, Entry::Known(4), None)));
        assert_eq!(of("theta_j"), Some((THETA, Entry::Known(5), None)));
        assert_eq!(of("theta_a.b"), Some((THETA, Entry::Known(6), None)));
        assert_eq!(of("theta_a_b"), Some((THETA, Entry::Known(7), None)));
        assert_eq!(of("elbow_joint_temperature"), None);
        assert_eq!(of("left_elbow_joint_position"), Some((THETA, Entry::Name("left_elbow_joint".into()), None)));
    }
}
