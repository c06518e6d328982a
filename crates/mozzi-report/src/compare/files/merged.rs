//! Bodies: the links that one joint moves. If a link is in one file only, the other may have merged it, rightly or not.

use super::RobotFile;
use super::cause::{Cause, Change};
use super::inertia::{Body, alike, difference, near, rounding, steiner, sum};
use super::matching::Matched;
use super::places::Places;
use super::solid;
use crate::compare::Result;
use crate::compare::constants::same_body;
use mozzi::{Description, SE3, SO3, SpatialInertia, Sym3, Vec3};
use std::collections::BTreeMap;

/// Compares the inertias of all bodies that move. A body whose inertia differs is a cause; a body of equal inertia
/// that its links share in another way is a note.
pub fn causes(matched: &Matched, places: &Places, files: [&RobotFile; 2]) -> Result<(Vec<Cause>, Vec<String>)> {
    let robots = places.robots;
    let home_a = &places.homes[0];
    // where the first robot would have the second one's links
    let seen = |link: &str| (link.to_string(), places.seen(link).unwrap_or_else(SE3::identity));
    let home_b: BTreeMap<String, SE3> = robots[1].links.iter().map(|link| seen(&link.name)).collect();
    let (model_a, model_b) = (robots[0].clone().build()?, robots[1].clone().build()?);
    let (bodies_a, bodies_b) = (model_a.folded_links(), model_b.folded_links());
    let axes = |file: &RobotFile, name: &str| file.inertial_axes.get(name).copied();
    let (mut causes, mut notes) = (Vec::new(), Vec::new());
    for body in &bodies_a {
        let Some(there) = bodies_b.iter().find(|there| there.joint == body.joint) else { continue };
        if body.joint.is_none() && !(model_a.is_floating() && model_b.is_floating()) {
            continue; // a fixed base's inertia enters nothing
        }
        let [names, others] = [body, there].map(|body| body.links.iter().map(|(name, _)| *name).collect::<Vec<&str>>());
        let only_a: Vec<&str> = names.iter().copied().filter(|name| !others.contains(name)).collect();
        let only_b: Vec<&str> = others.iter().copied().filter(|name| !names.contains(name)).collect();
        let is_light =
            |robot: &Description, list: &[&str]| list.iter().all(|name| inertia(robot, name) == SpatialInertia::zero());
        let whole = |robot: &Description, names: &[&str], home: &BTreeMap<String, SE3>| {
            names.iter().fold(SpatialInertia::zero(), |sum, name| sum + inertia(robot, name).transformed(home[*name]))
        };
        let (mine, theirs) = (whole(robots[0], &names, home_a), whole(robots[1], &others, &home_b));
        if same_body(&mine, &theirs) {
            notes.extend(merged_links([&names, &others], robots, files));
            continue; // merged as it should be
        }
        if is_light(robots[0], &only_a) && is_light(robots[1], &only_b) {
            for name in names.iter().filter(|name| others.contains(name)) {
                let homes = [home_a[*name], home_b[*name]];
                causes.extend(of_link(name, matched, robots, homes, files, &only_a));
            }
            continue;
        }
        let first = names[0];
        let into = home_a[first].inverse();
        let theirs = theirs.transformed(into);
        let parts: Vec<Part> =
            names.iter().map(|name| Part::of(name, robots[0], axes(files[0], name), into * home_a[*name])).collect();
        let missing: Vec<bool> = names.iter().map(|name| only_a.contains(name)).collect();
        let mut why = merged([&files[0].name, &files[1].name], first, &parts, &missing, Body::of(theirs));
        if why.is_none() && !only_b.is_empty() {
            // the first file merges
            let first = others[0];
            let into = home_b[first].inverse();
            let part =
                |name: &&str| Part::of(name, robots[1], axes(files[1], matched.link_there(name)), into * home_b[*name]);
            let parts: Vec<Part> = others.iter().map(part).collect();
            let missing: Vec<bool> = others.iter().map(|name| only_b.contains(name)).collect();
            why = merged([&files[1].name, &files[0].name], first, &parts, &missing, Body::of(mine.transformed(into)));
        }
        let has_reason = why.is_some();
        let sentence = why.unwrap_or_else(|| {
            let list = only_a.iter().chain(&only_b).map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
            format!("the body of `{first}` differs, with {list} in one file only: no known reason")
        });
        let mut change = vec![(first.to_string(), theirs)];
        change.extend(names.iter().skip(1).map(|name| (name.to_string(), SpatialInertia::zero())));
        causes.push(Cause::new("inertia", first, sentence, has_reason, Change::Inertia(change)));
    }
    exchanged(&mut causes, robots, &files[1].name);
    Ok((causes, notes))
}

/// Two links, each with the inertia of the other, are one cause.
fn exchanged(causes: &mut Vec<Cause>, robots: [&Description; 2], other: &str) {
    let is_as = |here: &str, there: &str| same_body(&inertia(robots[0], here), &inertia(robots[1], there));
    let links: Vec<String> = causes.iter().map(|cause| cause.name.clone()).collect();
    for (k, one) in links.iter().enumerate() {
        for two in links[k + 1..].iter().filter(|two| is_as(one, two) && is_as(two, one)) {
            let of = |change: &Change| match change {
                Change::Inertia(list) => list.clone(),
                _ => Vec::new(),
            };
            let is_one = |cause: &&Cause| [one, two].contains(&&cause.name);
            let change = causes.iter().filter(is_one).flat_map(|cause| of(&cause.change)).collect();
            let sentence = format!("{other} has the inertias of `{one}` and `{two}` exchanged");
            causes.retain(|cause| !is_one(&cause));
            causes.push(Cause::new("inertia", one, sentence, true, Change::Inertia(change)));
        }
    }
}

fn inertia(robot: &Description, link: &str) -> SpatialInertia {
    robot.links.iter().find(|each| each.name == link).map_or_else(SpatialInertia::zero, |each| each.inertia)
}

/// Links of whose inertia one robot, which may lack them, has made a part of another link's. `bodies` has the links of
/// both bodies.
fn merged_links(bodies: [&[&str]; 2], robots: [&Description; 2], files: [&RobotFile; 2]) -> Option<String> {
    let has_mass = |k: usize, name: &str| inertia(robots[k], name) != SpatialInertia::zero();
    [(0, 1), (1, 0)].into_iter().find_map(|(here, there)| {
        let merges = |name: &&&str| has_mass(here, name) && !has_mass(there, name);
        let list: Vec<String> = bodies[here].iter().filter(merges).map(|name| format!("`{name}`")).collect();
        let into = bodies[there].iter().find(|name| has_mass(there, name))?;
        let sentence = || format!("{} merges {} into `{into}`: the same body", files[there].name, list.join(", "));
        (!list.is_empty()).then(sentence)
    })
}

/// A link that both have.
fn of_link(
    name: &str,
    matched: &Matched,
    robots: [&Description; 2],
    homes: [SE3; 2],
    files: [&RobotFile; 2],
    alone: &[&str],
) -> Option<Cause> {
    let called = [name, matched.link_there(name)];
    let (a, b) = (inertia(robots[0], name), inertia(robots[1], name));
    // in the first robot's link frame
    let into = homes[0].inverse() * homes[1];
    let is_there = into.p.norm() <= 1e-9 * (1.0 + homes[0].p.norm()) && into.R.log().norm() <= 1e-9;
    let other = if is_there { b } else { b.transformed(into) };
    if same_body(&a, &b) || same_body(&a, &other) {
        return None;
    }
    let axes = [0, 1].map(|k| files[k].inertial_axes.get(called[k]).copied());
    let solids = [0, 1].map(|k| solid::of_link(files[k], called[k])).concat();
    let names = [files[0].name.as_str(), files[1].name.as_str()];
    let twice = alone.is_empty().then(|| counted_twice(name, robots[0], a, other)).flatten();
    let why = twice.map(|child| format!("{} counts the mass of `{child}` twice, also in `{name}`", names[1]));
    let (sentence, has_reason) = match why {
        Some(why) => (why, true),
        None => difference(names, name, [Body::of(a), Body::of(other)], axes, &solids),
    };
    Some(Cause::new("inertia", name, sentence, has_reason, Change::Inertia(vec![(name.to_string(), other)])))
}

/// The link on a fixed joint whose inertia the other file has added to this one's, too.
fn counted_twice(name: &str, robot: &Description, a: SpatialInertia, b: SpatialInertia) -> Option<String> {
    let fixed = robot.joints.iter().filter(|joint| joint.parent == name && joint.kind.name() == "fixed");
    fixed
        .filter(|joint| inertia(robot, &joint.child).mass > 0.0)
        .find(|joint| same_body(&(a + inertia(robot, &joint.child).transformed(joint.origin)), &b))
        .map(|joint| joint.child.clone())
}

/// A link in the frame of the body's first link.
struct Part {
    name: String,
    body: Body,
    /// In its own frame, and the axes in which the file gives it.
    own: Body,
    T: SE3,
    axes: Option<SO3>,
}

impl Part {
    fn of(name: &str, robot: &Description, axes: Option<SO3>, T: SE3) -> Self {
        let G = inertia(robot, name);
        Part { name: name.to_string(), body: Body::of(G.transformed(T)), own: Body::of(G), T, axes }
    }

    fn without(&self, inertial: bool, joint: bool) -> Sym3 {
        let axes = self.axes.unwrap_or_else(SO3::identity);
        let I = if inertial { self.own.I.congruence(axes.inverse().matrix()) } else { self.own.I };
        if joint { I } else { I.congruence(self.T.R.matrix()) }
    }
}

/// Why a merged body is not the sum of its links.
fn merged([one, other]: [&str; 2], first: &str, parts: &[Part], missing: &[bool], b: Body) -> Option<String> {
    let list = parts.iter().zip(missing).filter(|(_, gone)| **gone).map(|(part, _)| format!("`{}`", part.name));
    let list = list.collect::<Vec<_>>().join(", ");
    // the sum of all links, with another inertia of the missing ones
    type Make<'m, T> = &'m dyn Fn(&Part) -> T;
    let about = |center: Make<Vec3>, moment: Make<Sym3>, shift: &dyn Fn(bool) -> bool, counts: &dyn Fn(bool) -> f64| {
        let place = |part: &Part, gone: bool| if gone { center(part) } else { part.body.c };
        let m: f64 = parts.iter().zip(missing).map(|(part, gone)| counts(*gone) * part.body.m).sum();
        let mc = parts
            .iter()
            .zip(missing)
            .fold(Vec3::zero(), |mc, (p, gone)| mc + place(p, *gone) * (counts(*gone) * p.body.m));
        let c = if m > 0.0 { mc * (1.0 / m) } else { Vec3::zero() };
        let I = parts.iter().zip(missing).fold(Sym3::zero(), |I, (part, gone)| {
            let own = if *gone { moment(part) } else { part.body.I };
            let away = if shift(*gone) { steiner(part.body.m, place(part, *gone) - c) } else { Sym3::zero() };
            sum(I, sum(own, away, 1.0), counts(*gone))
        });
        Body { m, c, I }
    };
    let total = |moment: Make<Sym3>, shift: &dyn Fn(bool) -> bool, counts: &dyn Fn(bool) -> f64| {
        about(&|part| part.body.c, moment, shift, counts)
    };
    let is_b = |body: Body| (body.m - b.m).abs() <= 2e-6 * b.m.abs() && near(body.c, b.c) && alike(body.I, b.I);
    let (all, one_each) = (|_: bool| true, |_: bool| 1.0);
    let true_moment = |part: &Part| part.body.I;
    let says = |what: &str| Some(format!("{other} merges {list} into `{first}` {what}; {one} has it as a link"));
    let whole = total(&true_moment, &all, &one_each);
    if let Some(worst) = rounding(whole, b) {
        let all = format!("{other} merges {list} into `{first}`, rounded");
        return Some(format!("{all}: its numbers differ by up to {worst:.0e} of the largest"));
    }
    if is_b(total(&|part| part.without(true, false), &all, &one_each)) {
        return says("without the rotation of its inertial");
    }
    if is_b(total(&|part| part.without(false, true), &all, &one_each)) {
        return says("without the rotation of its fixed joint");
    }
    if is_b(total(&|part| part.without(true, true), &all, &one_each)) {
        return says("without the rotations of its inertial and its fixed joint");
    }
    let unturned = |part: &Part| part.T.p + part.own.c;
    if is_b(about(&unturned, &true_moment, &all, &one_each)) {
        return says("without rotating its centre of mass by its fixed joint");
    }
    if is_b(total(&true_moment, &|_| false, &one_each)) || is_b(total(&true_moment, &|gone| !gone, &one_each)) {
        return says("without the parallel-axis term");
    }
    if is_b(total(&|_| Sym3::zero(), &all, &one_each)) {
        return says("as a point mass, without its moments");
    }
    if is_b(total(&true_moment, &all, &|gone| if gone { 0.0 } else { 1.0 })) {
        return Some(format!("{other} drops {list}, with its mass, from the body of `{first}`"));
    }
    if is_b(total(&true_moment, &all, &|gone| if gone { 2.0 } else { 1.0 })) {
        return Some(format!("{other} counts the mass of {list} twice in `{first}`"));
    }
    None
}
