//! Where the robots begin, and their named states, which enter no force.

use super::RobotFile;
use super::cause::{Cause, Change};
use super::matching::Matched;
use super::number::{instead, shown};
use super::place::away;
use super::places::distance;
use crate::compare::{Result, vocabulary};
use mozzi::model::State;
use mozzi::{Freedom, Model, Place, SE3, SO3, Vec3};
use std::collections::BTreeMap;

/// A cause for the starts, if both formats have them, and for each state that both have, where they differ; a note on
/// the states of one file only.
pub fn compared(matched: &Matched, files: [&RobotFile; 2], has_base: bool) -> Result<(Vec<Cause>, Vec<String>)> {
    let pair = Pair::of(matched, files, has_base);
    let (mut causes, other) = (Vec::new(), &files[1].name);
    let mut add = |kind: &'static str, name: &str, states: [&State; 2], what: String| {
        let found = pair.differences(states);
        if let Some(most) = found.iter().map(|(size, _)| *size).reduce(f64::max) {
            let sentence = format!("{what} in {other}: {}", vocabulary::some(&found, |(_, words)| words.clone()));
            causes.push(Cause { size: most, ..Cause::new(kind, name, sentence, false, Change::NoForce) });
        }
    };
    let [a, b] = files.map(|file| &file.model);
    let [start, start_there] = files.map(|file| file.model.description().start.as_deref());
    let has_starts = files.iter().all(|file| file.has_start);
    if has_starts {
        add("start", "", [&a.start(), &b.start()], "the robot starts elsewhere".to_string());
    }
    let is_compared = |name: &str, start: Option<&str>| has_starts && start == Some(name);
    for name in a.state_names().filter(|name| b.state_names().any(|there| there == *name)) {
        if !(is_compared(name, start) && is_compared(name, start_there)) {
            add("state", name, [&a.state(name)?, &b.state(name)?], format!("state `{name}` differs"));
        }
    }
    let alone = |k: usize, start: Option<&str>| -> Option<String> {
        let [own, other] = [&files[k].model, &files[1 - k].model];
        let is_alone = |name: &&str| other.state_names().all(|there| there != *name) && !is_compared(name, start);
        let list: Vec<&str> = own.state_names().filter(is_alone).collect();
        let noun = if list.len() == 1 { "state" } else { "states" };
        let names = || vocabulary::some(&list, |name| format!("`{name}`"));
        (!list.is_empty()).then(|| format!("{noun} of {} only: {}", files[k].name, names()))
    };
    let notes = [alone(0, start), alone(1, start_there)].into_iter().flatten().collect();
    Ok((causes, notes))
}

/// Where both robots have the numbers of a base or of a joint.
struct Pair {
    places: Vec<(String, [Place; 2])>,
}

impl Pair {
    fn of(matched: &Matched, files: [&RobotFile; 2], has_base: bool) -> Self {
        let [a, b] = files.map(|file| &file.model);
        let there: BTreeMap<&str, Place> = b.joint_names().zip(b.places().iter().copied()).collect();
        let twin = |(name, place): (&str, &Place)| {
            let twin = *there.get(matched.joint_there(name))?;
            (twin.freedom == place.freedom).then(|| (format!("`{name}`"), [*place, twin]))
        };
        let root = |model: &Model| model.folded_links()[0].links[0].0.to_string();
        let has_base = has_base && [a, b].iter().all(|model| model.is_floating());
        let base = Place { freedom: Freedom::Free, q: 0, j: 0 };
        // poses of other links cannot be compared
        let base = (has_base && matched.link_there(&root(a)) == root(b)).then(|| ("the base".to_string(), [base; 2]));
        Pair { places: base.into_iter().chain(a.joint_names().zip(a.places()).filter_map(twin)).collect() }
    }

    /// The differences between two states in words, each with its size.
    fn differences(&self, [x, y]: [&State; 2]) -> Vec<(f64, String)> {
        let time = number("time", x.time, y.time);
        let places = self.places.iter().flat_map(|(name, [here, there])| {
            let position = position(name, &x.theta[here.positions()], &y.theta[there.positions()]);
            let [u, v] = [&x.dtheta[here.velocities()], &y.dtheta[there.velocities()]];
            position.into_iter().chain(velocity(name, u, v))
        });
        time.into_iter().chain(places).collect()
    }
}

/// Numbers of more digits than this are equal.
const DIGITS: f64 = 1e-9;

fn size(x: f64, y: f64) -> f64 {
    (x - y).abs() / (1.0 + x.abs())
}

fn number(name: &str, x: f64, y: f64) -> Option<(f64, String)> {
    (size(x, y) > DIGITS).then(|| (size(x, y), format!("{name} {}", instead(x, y))))
}

fn position(name: &str, x: &[f64], y: &[f64]) -> Option<(f64, String)> {
    let pose = |x: &[f64]| match *x {
        [w, x, y, z] => SE3::new(SO3::from_quaternion(w, Vec3([x, y, z])), Vec3::zero()),
        [w, x, y, z, a, b, c] => SE3::from_pose([w, x, y, z, a, b, c]),
        _ => SE3::identity(),
    };
    if let (&[x], &[y]) = (x, y) {
        return number(name, x, y);
    }
    let [x, y] = [pose(x), pose(y)];
    let size = distance(x, y);
    (size > DIGITS).then(|| (size, format!("{name} {}", away(x, y))))
}

fn velocity(name: &str, x: &[f64], y: &[f64]) -> Option<(f64, String)> {
    let most = x.iter().zip(y).map(|(x, y)| size(*x, *y)).fold(0.0, f64::max);
    let list = |x: &[f64]| x.iter().map(|x| shown(*x)).collect::<Vec<_>>().join(" ");
    (most > DIGITS).then(|| (most, format!("the velocity of {name} {} instead of {}", list(y), list(x))))
}
