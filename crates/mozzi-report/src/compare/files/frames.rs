//! Named frames, such as MuJoCo's sites, that are elsewhere or in one file only. A frame of one file may be a link on a
//! fixed joint of the other; those of both are joints that are elsewhere.

use super::cause::{Cause, Change};
use super::matching::Matched;
use super::place::{away, of_origin, rounded};
use super::places::{Places, distance, same_place};
use crate::compare::constants::home;
use crate::compare::{Result, vocabulary};
use mozzi::model::description::{Anchor, Constraint, ConstraintKind, JointKind};
use mozzi::{Description, SE3, SpatialInertia};
use std::collections::{BTreeMap, BTreeSet};

/// A cause for each frame of both robots that is elsewhere on its body.
pub fn causes(places: &Places, other: &str) -> Vec<Cause> {
    let robots = places.robots;
    let frame = |name: &str| -> Option<Cause> {
        let [on, there] = [link_of(robots[0], name)?, link_of(robots[1], name)?];
        let [p, q] = [*places.homes[0].get(name)?, places.seen(name)?];
        let new = |size: f64, words: String, has_reason: bool| {
            let sentence = format!("frame `{name}` {words}");
            Some(Cause { size, ..Cause::new("place", name, sentence, has_reason, Change::NoForce) })
        };
        if places.carrier(0, on) != places.carrier(1, there) {
            return new(1.0, format!("is on `{there}` in {other}, on `{on}` here"), true);
        }
        if same_place(p, q) {
            return None;
        }
        let local =
            places.seen(on).map(|T| [places.homes[0].get(on).copied().unwrap_or(p).inverse() * p, T.inverse() * q]);
        let (size, why) = (distance(p, q), local.and_then(|[x, y]| of_origin(x, y)));
        match (rounded(size), why) {
            (true, _) => new(size, format!("is rounded in {other}: its place differs by {size:.0e}"), true),
            (false, Some(why)) => new(size, format!("{why} in {other}"), true),
            (false, None) => new(size, format!("is elsewhere in {other}, {}", away(p, q)), false),
        }
    };
    let named: BTreeSet<&str> =
        robots.iter().flat_map(|robot| &robot.frames).map(|frame| frame.name.as_str()).collect();
    named.into_iter().filter_map(frame).collect()
}

/// The link of a frame, or the link of this name.
fn link_of<'d>(robot: &'d Description, name: &str) -> Option<&'d str> {
    let frame = robot.frames.iter().find(|frame| frame.name == name).map(|frame| frame.link.as_str());
    frame.or_else(|| robot.links.iter().find(|link| link.name == name).map(|link| link.name.as_str()))
}

/// A note for each file on the frames that it has alone; `robots` have their constraints.
pub fn notes(matched: &Matched, robots: [&Description; 2], names: [&str; 2]) -> Result<Vec<String>> {
    let sides = [(&matched.a, &matched.b, &matched.only_a), (&matched.b, &matched.a, &matched.only_b)];
    let mut notes = Vec::new();
    for (k, (robot, other, held)) in sides.into_iter().enumerate() {
        let anchors = Anchors::of(robots[k])?;
        let mut alone = frames(robot, held);
        alone.retain(|name| link_of(other, name).is_none() && !anchors.has(name));
        let noun = if alone.len() == 1 { "frame" } else { "frames" };
        let list = vocabulary::some(&alone, |name| format!("`{name}`"));
        notes.extend((!alone.is_empty()).then(|| format!("{noun} of {} only: {list}", names[k])));
    }
    Ok(notes)
}

/// The named frames, and links without mass on joints that are fixed in the file, too.
fn frames<'d>(robot: &'d Description, held: &[String]) -> Vec<&'d str> {
    let is_massless =
        |name: &str| robot.links.iter().any(|link| link.name == name && link.inertia == SpatialInertia::zero());
    let fixed = robot.joints.iter().filter(|joint| joint.kind == JointKind::Fixed && !held.contains(&joint.name));
    let links = fixed.map(|joint| joint.child.as_str()).filter(|name| is_massless(name));
    robot.frames.iter().map(|frame| frame.name.as_str()).chain(links).collect()
}

/// The places of constraints' anchors, which are compared with these: a file may need frames there.
struct Anchors {
    places: Vec<SE3>,
    home: BTreeMap<String, SE3>,
}

impl Anchors {
    fn of(robot: &Description) -> Result<Self> {
        let home = home(robot)?;
        let place = |anchor: &Anchor| match &anchor.frame {
            Some(name) => home.get(name).map(|T| *T * anchor.T),
            None => Some(anchor.T),
        };
        let of = |constraint: &Constraint| match &constraint.kind {
            ConstraintKind::Frames { a, b, .. } => [place(a), place(b)],
            ConstraintKind::Joint { .. } => [None, None],
        };
        let places = robot.constraints.iter().flat_map(of).flatten().collect();
        Ok(Anchors { places, home })
    }

    fn has(&self, frame: &str) -> bool {
        self.home.get(frame).is_some_and(|T| self.places.iter().any(|place| same_place(*place, *T)))
    }
}
