//! The topic of a bag that holds the robot's joints, and its messages as a table.

use super::message::State;
use crate::failure::{self, Failure, Result};
use crate::recogniser::{Header, Recognised, Request, is_alike};
use crate::tables::samples::Samples;
use mozzi::Model;
use std::collections::{BTreeMap, BTreeSet};

/// More joints are refused.
const MOST_JOINTS: usize = 1000;

/// Words of topics that hold no measurement.
const COMMANDS: [&str; 5] = ["command", "cmd", "desired", "target", "reference"];

struct Candidate {
    topic: String,
    states: Vec<State>,
    /// The robot's joints that it has.
    joints: BTreeSet<usize>,
    rank: (usize, bool, bool),
}

/// The messages of the topic that holds most of the robot's joints, with those of topics that hold the others.
pub fn choose(
    file: &str,
    topics: BTreeMap<String, Vec<State>>,
    model: &Model,
    request: &Request,
) -> Result<Vec<State>> {
    let own: Vec<&str> = match request.order.is_empty() {
        true => model.joint_names().collect(),
        false => request.order.iter().map(String::as_str).collect(),
    };
    let list = topics.keys().cloned().collect::<Vec<_>>().join(", ");
    let mut all = Vec::new();
    for (topic, states) in topics {
        let names: BTreeSet<&String> = states.iter().flat_map(|state| &state.names).collect();
        if names.len() > MOST_JOINTS {
            let found = names.len();
            return Err(Failure::wrong(format!("{file} names {found} joints, expected at most {MOST_JOINTS}")));
        }
        let joints: BTreeSet<usize> =
            (0..own.len()).filter(|&k| names.iter().any(|name| is_alike(own[k], name))).collect();
        let has_force = states.iter().any(|state| state.values[2].iter().any(|x| x.is_finite()));
        let is_measured = !COMMANDS.iter().any(|word| topic.to_lowercase().contains(word));
        let rank = (joints.len(), has_force, is_measured);
        all.push(Candidate { topic, states, joints, rank });
    }
    if let Some(wanted) = request.topic {
        let is_it = |found: &Candidate| found.topic.trim_start_matches('/') == wanted.trim_start_matches('/');
        let found = all.into_iter().find(is_it).ok_or_else(|| {
            Failure::wrong(format!(
                "{file}: no topic `{wanted}` with JointState messages, as --topic asks; there are {list}"
            ))
        })?;
        return Ok(found.states);
    }
    all.sort_by_key(|candidate| std::cmp::Reverse(candidate.rank));
    if let [first, second, ..] = all.as_slice() {
        let is_rival = first.rank == second.rank && (first.joints == second.joints || first.joints.is_empty());
        if is_rival {
            let rivals: Vec<&str> =
                all.iter().filter(|other| other.rank == first.rank).map(|other| other.topic.as_str()).collect();
            return Err(Failure::wrong(format!(
                "{file}: the topics {} hold the same joints, expected one; --topic {} chooses one",
                rivals.join(", "),
                rivals[0]
            )));
        }
    }
    let is_one = all.len() == 1;
    let (mut states, mut joints, mut chosen) = (Vec::new(), BTreeSet::new(), Vec::new());
    for candidate in all {
        if chosen.is_empty() || !candidate.joints.is_empty() && candidate.joints.is_disjoint(&joints) {
            joints.extend(candidate.joints);
            states.extend(candidate.states);
            chosen.push(candidate.topic);
        }
    }
    if !is_one || !chosen[0].ends_with("/joint_states") {
        failure::note(&format!("{file}: the topic {} is read, of {list}", chosen.join(" with ")));
    }
    Ok(states)
}

/// A row for each message with joints of the robot.
pub fn table(file: &str, states: Vec<State>, model: &Model, request: &Request) -> Result<Samples> {
    let mut joints: Vec<String> = Vec::new();
    for name in states.iter().flat_map(|state| &state.names) {
        if !joints.contains(name) {
            joints.push(name.clone());
        }
    }
    let groups = [0, 1, 3];
    let is_there: [bool; 3] = core::array::from_fn(|k| states.iter().any(|state| !state.values[k].is_empty()));
    let mut header = Header::of(vec!["t".to_string()]);
    header.given.push(None);
    for (k, group) in groups.into_iter().enumerate().filter(|(k, _)| is_there[*k]) {
        let word = ["position", "velocity", "effort"][k];
        header.names.extend(joints.iter().map(|joint| format!("{word} of {joint}")));
        header.given.extend(joints.iter().map(|joint| Some((group, joint.clone()))));
    }
    // the topic is chosen already
    let found = Recognised::find(file, &header, model, &Request { topic: None, ..*request })?;
    // publishers that leave the stamp empty have the time at which the message was received
    let is_stamped = states.iter().any(|state| state.stamp != 0);
    let time = |state: &State| if is_stamped { state.stamp } else { state.received };
    check_order(file, &states, &time)?;
    let mut states: Vec<&State> = states.iter().collect();
    states.sort_by_key(|state| (time(state), state.received));
    let start = states.first().map_or(0, |state| time(state));
    let used = found.used(file)?;
    let place: BTreeMap<usize, usize> = used.iter().enumerate().map(|(k, &column)| (column, k)).collect();
    let width = used.len();
    let mut rows: Vec<f64> = Vec::new();
    for state in states {
        let row = rows.len();
        rows.resize(row + width, f64::NAN);
        rows[row + place[&0]] = (time(state).saturating_sub(start)) as f64 * 1e-9;
        for (at, name) in state.names.iter().enumerate() {
            let Some(joint) = joints.iter().position(|known| known == name) else { continue };
            let mut first = 1;
            for k in (0..3).filter(|&k| is_there[k]) {
                if let (Some(&slot), Some(&x)) = (place.get(&(first + joint)), state.values[k].get(at)) {
                    rows[row + slot] = x;
                }
                first += joints.len();
            }
        }
    }
    let count = rows.len() / width.max(1);
    let samples = found.samples(file, count, |row, column| rows[row * width + place[&column]]);
    found.notes.iter().for_each(|note| failure::note(note));
    Ok(Samples { columns: found.rows, is_time_certain: true, ..samples })
}

/// The stamps of messages with the same joints must not decrease in the order of recording.
fn check_order(file: &str, states: &[State], time: &dyn Fn(&State) -> i64) -> Result<()> {
    let mut in_order: Vec<&State> = states.iter().collect();
    in_order.sort_by_key(|state| state.received);
    let mut last: BTreeMap<BTreeSet<&String>, i64> = BTreeMap::new();
    for state in in_order {
        let t = time(state);
        let before = last.insert(state.names.iter().collect(), t).unwrap_or(t);
        if t < before {
            return Err(Failure::wrong(format!(
                "{file}: a message's time goes back by {:.3} s, from {:.3} s to {:.3} s, expected increasing times: the \
                 clock was set, or two publishers send the same joints",
                (before - t) as f64 * 1e-9,
                before as f64 * 1e-9,
                t as f64 * 1e-9
            )));
        }
    }
    Ok(())
}
