//! Which column is the time, and in which unit.

use super::unit::{self, Dimension};
use super::word::words;
use super::{Header, Role};
use crate::failure::{Failure, Result};

/// The time of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Time {
    /// One column; without a factor its unit is not named, and seconds are assumed.
    Column { column: usize, factor: Option<f64> },
    /// Whole seconds, and the rest with its factor.
    Pair { seconds: usize, rest: usize, factor: f64 },
}

/// The part of time in a column's name.
#[derive(Clone, Debug, PartialEq)]
enum Part {
    Whole(Option<f64>),
    /// Whole seconds; the text before it.
    Seconds(String),
    Rest(String, f64),
}

const WORDS: [&str; 13] = [
    "t",
    "time",
    "timestamp",
    "stamp",
    "duration",
    "elapsed",
    "seconds",
    "uptime",
    "clock",
    "utc",
    "zeit",
    "zeitstempel",
    "datetime",
];
const QUALIFIERS: [&str; 29] = [
    "rosbag",
    "bag",
    "date",
    "header",
    "field",
    "ros",
    "robot",
    "controller",
    "system",
    "unix",
    "epoch",
    "clock",
    "since",
    "start",
    "from",
    "msg",
    "rel",
    "relative",
    "log",
    "tv",
    "stamp",
    "time",
    "timestamp",
    "elapsed",
    "sample",
    "sim",
    "host",
    "monotonic",
    "utc",
];

/// The part and the rank; smaller ranks are preferred: mozzi's own `t`, the message's stamp, the time of recording.
fn part(name: &str) -> Option<(Part, usize)> {
    let name = name.trim();
    if name == "t" {
        return Some((Part::Whole(None), 0));
    }
    let (rest, factor) = match unit::split(name, |_, unit| unit.dimension == Dimension::Time) {
        Some((rest, unit)) => (rest, Some(unit.factor)),
        None => (name, None),
    };
    let all = words(name);
    let text = |k: usize| all[k].1.as_str();
    let last = all.len().checked_sub(1)?;
    let before = || name[..all[last].0.start].to_string();
    let is_qualified = |count: usize| (0..count).all(|k| text(k) == "nano" || QUALIFIERS.contains(&text(k)));
    let is_in_path = name.contains("stamp");
    if is_qualified(last) || is_in_path {
        let rank = if is_in_path { 1 } else { 2 };
        match text(last) {
            "sec" if last > 0 && text(last - 1) == "nano" => {
                return Some((Part::Rest(name[..all[last - 1].0.start].to_string(), 1e-9), rank));
            }
            "sec" | "secs" => return Some((Part::Seconds(before()), rank)),
            "nsec" | "nsecs" | "nanosec" | "nanosecs" | "nanoseconds" => {
                return Some((Part::Rest(before(), 1e-9), rank));
            }
            "usec" | "usecs" | "microsec" | "microseconds" => return Some((Part::Rest(before(), 1e-6), rank)),
            _ => {}
        }
    }
    let found = words(rest);
    let known = |word: &str| WORDS.contains(&word) || QUALIFIERS.contains(&word);
    let is_time = found.iter().any(|(_, word)| WORDS.contains(&word.as_str()));
    let from = rest.rfind('/').map_or(0, |k| k + 1);
    let is_plain = found.iter().filter(|(range, _)| range.start >= from).all(|(_, word)| known(word));
    let stamp = rest.ends_with("stamp") && !rest.ends_with("timestamp");
    if !is_time || !(is_plain || rest.ends_with("header.stamp") || rest.ends_with("header/stamp")) {
        return None;
    }
    let is_rostopic = name == "%time" || rest.starts_with("field.") && stamp;
    let rank = match rest {
        "%time" | "rosbagTimestamp" => 3,
        _ if stamp => 1,
        "duration" | "elapsed" => 4,
        _ => 2,
    };
    Some((Part::Whole(factor.or(is_rostopic.then_some(1e-9))), rank))
}

/// Finds the time; the other columns of time are marked as unused.
pub fn find(place: &str, header: &Header, roles: &mut [Role]) -> Result<Option<Time>> {
    let mut parts: Vec<(usize, Part, usize)> = Vec::new();
    for (column, name) in header.names.iter().enumerate() {
        let unit = header.unit(column).filter(|unit| unit.dimension == Dimension::Time);
        if let Some((found, rank)) = part(name) {
            let found = match (found, unit) {
                (Part::Whole(_), Some(unit)) => Part::Whole(Some(unit.factor)),
                (found, _) => found,
            };
            parts.push((column, found, rank));
        }
    }
    let mut found: Vec<(usize, Time)> = Vec::new();
    for (column, part, rank) in &parts {
        match part {
            Part::Whole(factor) => {
                let factor =
                    factor.or_else(|| header.clock(*column).map(|_| 1.0)).or_else(|| of_epoch(header.number(*column)?));
                found.push((*rank, Time::Column { column: *column, factor }));
            }
            Part::Seconds(prefix) => {
                let rest = parts.iter().find_map(|(column, part, _)| match part {
                    Part::Rest(other, factor) if other == prefix => Some((*column, *factor)),
                    _ => None,
                });
                found.push(match rest {
                    Some((rest, factor)) => (*rank, Time::Pair { seconds: *column, rest, factor }),
                    None => (*rank, Time::Column { column: *column, factor: Some(1.0) }),
                });
            }
            // `time_usec` alone
            Part::Rest(prefix, factor) => {
                let is_whole = !parts.iter().any(|(_, part, _)| matches!(part, Part::Seconds(_)))
                    && words(prefix).iter().any(|(_, word)| ["t", "time", "timestamp"].contains(&word.as_str()));
                if is_whole {
                    found.push((*rank, Time::Column { column: *column, factor: Some(*factor) }));
                }
            }
        }
    }
    // whole seconds of a stamp without the rest are no time of rows, if there is another
    let is_cut = |time: &Time| {
        let column = time.first();
        let is_pair = matches!(time, Time::Pair { .. });
        !is_pair && parts.iter().any(|(of, part, _)| *of == column && matches!(part, Part::Seconds(_)))
    };
    if found.iter().any(|(_, time)| !is_cut(time)) {
        found.retain(|(_, time)| !is_cut(time));
    }
    if found.is_empty() {
        // an index of pandas that holds dates
        let unnamed = (0..header.names.len()).find(|&k| header.is_unnamed(k) && header.clock(k).is_some());
        found.extend(unnamed.map(|column| (5, Time::Column { column, factor: Some(1.0) })));
    }
    // a stamp that nobody set
    if found.len() > 1 {
        let is_set = |time: &Time| match time {
            Time::Column { column, .. } => header.number(*column) != Some(0.0) || header.names[*column] == "t",
            Time::Pair { seconds, rest, .. } => {
                header.number(*seconds) != Some(0.0) || header.number(*rest) != Some(0.0)
            }
        };
        if found.iter().any(|(_, time)| is_set(time)) {
            found.retain(|(rank, time)| *rank != 1 || is_set(time));
        }
    }
    let Some(best) = found.iter().map(|(rank, _)| *rank).min() else { return Ok(None) };
    let mut of_best = found.iter().filter(|(rank, _)| *rank == best).map(|(_, time)| *time);
    let Some(time) = of_best.next() else { return Ok(None) };
    if let Some(other) = of_best.next() {
        let name = |time: Time| {
            let column = time.first();
            format!("{} (`{}`)", column + 1, header.names[column])
        };
        return Err(Failure::wrong(format!(
            "{place}: columns {} and {} both give the time, expected one; delete or rename the other",
            name(time),
            name(other)
        )));
    }
    for (column, ..) in &parts {
        roles[*column] = Role::Unused("another time is used");
    }
    match time {
        Time::Column { column, .. } => roles[column] = Role::Time,
        Time::Pair { seconds, rest, .. } => (roles[seconds], roles[rest]) = (Role::Time, Role::Time),
    }
    Ok(Some(time))
}

/// The unit of a time since 1970, if its size leaves no doubt: from 1973 on, in seconds until the year 5138.
fn of_epoch(first: f64) -> Option<f64> {
    let units = [(1e17, 1e-9), (1e14, 1e-6), (1e11, 1e-3)];
    units.into_iter().find(|(least, _)| first > *least).map(|(_, unit)| unit)
}

impl Time {
    /// Its first column.
    pub fn first(self) -> usize {
        match self {
            Time::Column { column, .. } => column,
            Time::Pair { seconds, .. } => seconds,
        }
    }

    /// The unit, if the name contains it.
    pub fn unit(self) -> &'static str {
        match self {
            Time::Pair { .. } => "s",
            Time::Column { factor, .. } => match factor {
                None => "s, assumed",
                Some(1e-3) => "ms",
                Some(1e-6) => "µs",
                Some(1e-9) => "ns",
                Some(_) => "s",
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_since_1970_have_their_unit() {
        let now = 1.7e9;
        for (unit, expected) in [(1.0, None), (1e-3, Some(1e-3)), (1e-6, Some(1e-6)), (1e-9, Some(1e-9))] {
            assert_eq!(of_epoch(now / unit), expected);
        }
    }

    #[test]
    fn times_have_many_names() {
        let of = |name| part(name);
        assert_eq!(of("time_ms"), Some((Part::Whole(Some(1e-3)), 2)));
        assert_eq!(of("Time [s]"), Some((Part::Whole(Some(1.0)), 2)));
        assert_eq!(of("__time"), Some((Part::Whole(None), 2)));
        assert_eq!(of("%time"), Some((Part::Whole(Some(1e-9)), 3)));
        assert_eq!(of("field.header.stamp"), Some((Part::Whole(Some(1e-9)), 1)));
        assert_eq!(of("/joint_states/header/stamp"), Some((Part::Whole(None), 1)));
        assert_eq!(of("header.stamp.secs"), Some((Part::Seconds("header.stamp.".into()), 1)));
        assert_eq!(of("header.stamp.nsecs"), Some((Part::Rest("header.stamp.".into(), 1e-9), 1)));
        assert_eq!(of("time_stamp_sec"), Some((Part::Seconds("time_stamp_".into()), 1)));
        assert_eq!(of("time_stamp_nano_sec"), Some((Part::Rest("time_stamp_".into(), 1e-9), 1)));
        assert_eq!(of("timeStampNanoSec"), Some((Part::Rest("timeStamp".into(), 1e-9), 2)));
        assert_eq!(of("Zeit [min]"), Some((Part::Whole(Some(60.0)), 2)));
        assert_eq!(of("rosbagTimestamp"), Some((Part::Whole(None), 3)));
        assert_eq!(of("nanosec"), Some((Part::Rest(String::new(), 1e-9), 2)));
        assert_eq!(of("timestamp_ns"), Some((Part::Whole(Some(1e-9)), 2)));
        assert_eq!(of("duration"), Some((Part::Whole(None), 4)));
        for name in ["actual_execution_time", "tau_1", "cycle_time", "temperature", "seq"] {
            assert_eq!(of(name), None, "{name}");
        }
    }
}
