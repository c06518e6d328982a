//! Actuators and gravity compensation, which MJCF has.

use super::RobotFile;
use super::cause::{Cause, Change};
use super::number::shown;
use crate::compare::vocabulary;
use mozzi_urdf::mjcf::{Actuation, Actuator};
use std::collections::BTreeMap;

/// A cause for each link whose weight is compensated otherwise, if both formats have that, and notes on the rest.
pub fn compared(files: [&RobotFile; 2]) -> (Vec<Cause>, Vec<String>) {
    let none = Actuation::default();
    let [a, b] = files.map(|file| file.actuation.as_ref().unwrap_or(&none));
    let held = files.iter().all(|file| file.actuation.is_some());
    let other = &files[1].name;
    let (mut causes, mut notes) = (Vec::new(), Vec::new());
    let parts = |of: &Actuation| -> BTreeMap<String, f64> { of.compensated.iter().cloned().collect() };
    let [x, y] = [parts(a), parts(b)];
    let links: Vec<&String> = x.keys().chain(y.keys().filter(|link| !x.contains_key(*link))).collect();
    for link in links {
        let [p, q] = [&x, &y].map(|parts| parts.get(link).copied().unwrap_or(0.0));
        if p != q {
            let what = format!("gravity compensation of `{link}` is {} in {other}, {} here", shown(q), shown(p));
            match held {
                true => {
                    let cause = Cause::new("gravity compensation", link, what, true, Change::NoForce);
                    causes.push(Cause { size: (p - q).abs(), ..cause });
                }
                false => notes.push(what),
            }
        }
    }
    let find = |of: &Actuation, one: &Actuator| of.actuators.iter().flatten().any(|other| other == one);
    for (k, own, there) in [(0, a, b), (1, b, a)] {
        let lone = own.actuators.iter().flatten().filter(|one| !find(there, one));
        let lone: Vec<&str> = lone.map(|one| one.name.as_str()).collect();
        let noun = if lone.len() == 1 { "actuator" } else { "actuators" };
        let names = || vocabulary::some(&lone, |name| format!("`{name}`"));
        notes.extend((!lone.is_empty()).then(|| format!("{noun} of {} only: {}", files[k].name, names())));
    }
    (causes, notes)
}
