//! `sensor_msgs/msg/JointState` messages of an MCAP file, as a table.

use crate::failure::{Failure, Result};
use crate::input::cannot;
use std::collections::BTreeMap;

/// The names of columns, and rows of numbers; joints that a message lacks are NaN. Of several topics, the one with most
/// messages is read.
pub fn read(file: &str) -> Result<(Vec<String>, Vec<f64>)> {
    let bytes = std::fs::read(file).map_err(|error| cannot(file, &error))?;
    let messages = mcap::MessageStream::new(&bytes).map_err(|error| cannot(file, &error))?;
    let mut topics: BTreeMap<String, Vec<State>> = BTreeMap::new();
    for message in messages {
        let message = message.map_err(|error| cannot(file, &error))?;
        let is_state = message.channel.schema.as_ref().is_some_and(|schema| {
            ["sensor_msgs/msg/JointState", "sensor_msgs/JointState"].contains(&schema.name.as_str())
        });
        if is_state {
            let state = state(&message.data).ok_or_else(|| {
                Failure::wrong(format!(
                    "{file}: a message of {} is damaged, expected a JointState in CDR",
                    message.channel.topic
                ))
            })?;
            topics.entry(message.channel.topic.clone()).or_default().push(state);
        }
    }
    let Some((_, states)) = topics.into_iter().max_by_key(|(_, states)| states.len()) else {
        return Err(Failure::wrong(format!("{file} has no messages of sensor_msgs/msg/JointState")));
    };
    let mut joints: Vec<String> = Vec::new();
    for name in states.iter().flat_map(|state| &state.names) {
        if !joints.contains(name) {
            joints.push(name.clone());
        }
    }
    let groups = ["theta", "dtheta", "tau"];
    let is_there: [bool; 3] = core::array::from_fn(|k| states.iter().any(|state| !state.values[k].is_empty()));
    let mut header = vec!["t".to_string()];
    for (group, _) in groups.iter().zip(is_there).filter(|(_, there)| *there) {
        header.extend(joints.iter().map(|joint| format!("{group}_{joint}")));
    }
    let start = states[0].t;
    let mut rows = Vec::new();
    for state in &states {
        rows.push((state.t - start) as f64 * 1e-9);
        for k in (0..3).filter(|&k| is_there[k]) {
            rows.extend(joints.iter().map(|joint| {
                let at = state.names.iter().position(|name| name == joint);
                at.and_then(|at| state.values[k].get(at).copied()).unwrap_or(f64::NAN)
            }));
        }
    }
    Ok((header, rows))
}

struct State {
    /// Nanoseconds.
    t: i64,
    names: Vec<String>,
    /// Positions, velocities, efforts.
    values: [Vec<f64>; 3],
}

/// A JointState in CDR, little-endian: header, names, positions, velocities, efforts.
fn state(bytes: &[u8]) -> Option<State> {
    if bytes.get(1) != Some(&1) {
        return None; // big-endian, or something else
    }
    let mut from = Cdr { bytes: bytes.get(4..)?, at: 0 };
    let (seconds, nanoseconds) = (from.uint32()? as i32, from.uint32()?);
    from.string()?;
    let count = from.uint32()?;
    let names = (0..count).map(|_| from.string()).collect::<Option<Vec<_>>>()?;
    let mut values: [Vec<f64>; 3] = Default::default();
    for list in &mut values {
        let count = from.uint32()? as usize;
        if count > 0 {
            from.align(8);
            *list = (0..count).map(|_| from.float64()).collect::<Option<Vec<_>>>()?;
        }
    }
    Some(State { t: i64::from(seconds) * 1_000_000_000 + i64::from(nanoseconds), names, values })
}

struct Cdr<'b> {
    bytes: &'b [u8],
    at: usize,
}

impl Cdr<'_> {
    fn align(&mut self, to: usize) {
        self.at = self.at.next_multiple_of(to);
    }

    fn take<const K: usize>(&mut self) -> Option<[u8; K]> {
        let found = self.bytes.get(self.at..self.at.checked_add(K)?)?.try_into().ok();
        self.at += K;
        found
    }

    fn uint32(&mut self) -> Option<u32> {
        self.align(4);
        self.take().map(u32::from_le_bytes)
    }

    fn float64(&mut self) -> Option<f64> {
        self.take().map(f64::from_le_bytes)
    }

    fn string(&mut self) -> Option<String> {
        let length = self.uint32()? as usize;
        let text = self.bytes.get(self.at..self.at.checked_add(length)?)?;
        self.at += length;
        Some(String::from_utf8_lossy(text.strip_suffix(b"\0").unwrap_or(text)).into_owned())
    }
}
