//! Which joint of one robot is which of the other.

use super::cause::rename_joints;
use super::rotors;
use crate::compare::Result;
use crate::compare::constants::{Constants, JointConstants, freed};
use mozzi::Description;
use mozzi::model::description::{Joint, JointKind};
use std::collections::BTreeMap;

/// Both robots with the same independent moving joints, under the first one's names.
pub struct Matched {
    pub a: Description,
    pub b: Description,
    /// Joints known by their place: names in both.
    pub renamed: Vec<(String, String)>,
    /// Those of them that are elsewhere: known by their names behind a prefix.
    pub named: Vec<String>,
    /// Links known by their joints: names in both.
    pub links: Vec<(String, String)>,
    /// Joints that move in one robot only; fixed at 0 here.
    pub only_a: Vec<String>,
    pub only_b: Vec<String>,
}

/// The ends of names that one robot has and the other lacks.
struct Affixes {
    /// Before and after a name of the first robot, then of the second.
    ends: [[String; 2]; 2],
}

impl Affixes {
    /// The ends that make the most names equal; none if it is only one of several.
    fn of(a: &[String], b: &[String]) -> Self {
        let mut votes: BTreeMap<[[&str; 2]; 2], usize> = BTreeMap::new();
        for (x, y) in a.iter().flat_map(|x| b.iter().map(move |y| (x, y))) {
            let in_second = y.split_once(x.as_str()).map(|(before, after)| [["", ""], [before, after]]);
            let in_first = y.as_str() != x && x.contains(y.as_str());
            let in_first = in_first.then(|| x.split_once(y.as_str())).flatten();
            let ends = in_second.or_else(|| in_first.map(|(before, after)| [[before, after], ["", ""]]));
            ends.into_iter().for_each(|ends| *votes.entry(ends).or_default() += 1);
        }
        let best = votes.into_iter().max_by_key(|(_, count)| *count);
        let ends = best.filter(|(_, count)| *count > 1 || a.len() == 1).map(|(ends, _)| ends).unwrap_or_default();
        Affixes { ends: ends.map(|pair| pair.map(str::to_string)) }
    }

    fn fit(&self, x: &str, y: &str) -> bool {
        let [[a, b], [c, d]] = &self.ends;
        self.is_any()
            && y.strip_prefix(c.as_str()).and_then(|y| y.strip_suffix(d.as_str()))
                == x.strip_prefix(a.as_str()).and_then(|x| x.strip_suffix(b.as_str()))
    }

    fn is_any(&self) -> bool {
        self.ends.iter().flatten().any(|end| !end.is_empty())
    }
}

/// By name, then by its name without what all names have before or after it, then by axis at home, then by the link
/// that it moves.
pub fn matched(a: &Description, b: &Description) -> Result<Matched> {
    let (mut a, mut b) = (tree(a), tree(b));
    let (of_a, of_b) = (Constants::of(&a)?, Constants::of(&b)?);
    let is_twin = |name: &str, nv: usize, there: &Constants| there.joint(name).is_some_and(|joint| joint.nv == nv);
    let lone_a: Vec<_> = of_a.joints.iter().filter(|joint| !is_twin(&joint.name, joint.nv, &of_b)).collect();
    let lone_b: Vec<_> = of_b.joints.iter().filter(|joint| !is_twin(&joint.name, joint.nv, &of_a)).collect();
    let names = |lone: &[&JointConstants]| lone.iter().map(|joint| joint.name.clone()).collect::<Vec<_>>();
    let affixes = Affixes::of(&names(&lone_a), &names(&lone_b));
    let (mut renamed, mut named): (Vec<(String, String)>, Vec<String>) = (Vec::new(), Vec::new());
    let child = |robot: &Description, name: &str| {
        robot.joints.iter().find(|joint| joint.name == name).map(|joint| joint.child.clone())
    };
    for joint in &lone_a {
        let is_place =
            |x: &[f64; 6], y: &[f64; 6]| x.iter().zip(y).all(|(x, y)| (x - y).abs() <= 1e-6 * (1.0 + x.abs()));
        let fits = |other: &&&JointConstants| {
            let is_free = !renamed.iter().any(|(_, taken)| *taken == other.name);
            is_free && other.nv == joint.nv && joint.axes.iter().zip(&other.axes).all(|(x, y)| is_place(x, y))
        };
        let is_same = |other: &&&JointConstants| other.nv == joint.nv && affixes.fit(&joint.name, &other.name);
        let called: Vec<_> = lone_b.iter().filter(is_same).collect();
        let fitting: Vec<_> = if called.is_empty() { lone_b.iter().filter(fits).collect() } else { called };
        // several have the same place in legs that are alike: then the link decides
        let own = child(&a, &joint.name);
        let found = match fitting.as_slice() {
            [one] => Some(one),
            several => several.iter().find(|other| child(&b, &other.name) == own),
        };
        if let Some(other) = found {
            let is_there = joint.axes.iter().zip(&other.axes).all(|(x, y)| is_place(x, y));
            named.extend((!is_there).then(|| joint.name.clone()));
            renamed.push((joint.name.clone(), other.name.clone()));
        }
    }
    let only = |lone: &[&JointConstants], of: fn(&(String, String)) -> &String| -> Vec<String> {
        let names = lone.iter().map(|joint| joint.name.clone());
        names.filter(|name| !renamed.iter().any(|pair| of(pair) == name)).collect()
    };
    let (only_a, only_b) = (only(&lone_a, |pair| &pair.0), only(&lone_b, |pair| &pair.1));
    for (robot, only) in [(&mut a, &only_a), (&mut b, &only_b)] {
        robot
            .joints
            .iter_mut()
            .filter(|joint| only.contains(&joint.name))
            .for_each(|joint| joint.kind = JointKind::Fixed);
    }
    // a name of b that a has for another joint must not be taken for it
    rename_joints(&mut b, |joint| match renamed.iter().find(|(_, there)| there == joint) {
        Some((name, _)) => Some(name.clone()),
        None => renamed.iter().any(|(name, _)| name == joint).then(|| format!("{joint}'")),
    });
    [&mut a, &mut b].into_iter().for_each(rotors::to_armature);
    let links = links_of_joints(&a, &b, &affixes);
    links.iter().for_each(|(here, there)| rename_link(&mut b, there, here));
    Ok(Matched { a, b, renamed, named, links, only_a, only_b })
}

/// The robot with independent mimic joints, and without constraints and motors, which enter none of its forces.
fn tree(robot: &Description) -> Description {
    Description { constraints: Vec::new(), motors: None, ..freed(robot) }
}

impl Matched {
    /// Two joints of which each moves, in the second file, the link that the other moves in the first.
    pub fn exchanged(&self) -> Option<[String; 2]> {
        let moves = |joint: &&Joint| joint.kind != JointKind::Fixed;
        let child = |name: &str| self.b.joints.iter().find(|joint| joint.name == name).map(|joint| &joint.child);
        let off: Vec<&Joint> = (self.a.joints.iter().filter(moves))
            .filter(|joint| child(&joint.name).is_some_and(|there| *there != joint.child))
            .collect();
        off.iter().enumerate().find_map(|(k, one)| {
            let is_twin = |two: &&&Joint| child(&one.name) == Some(&two.child) && child(&two.name) == Some(&one.child);
            off[k + 1..].iter().find(is_twin).map(|two| [one.name.clone(), two.name.clone()])
        })
    }

    /// The second file's name of a joint.
    pub fn joint_there<'n>(&'n self, name: &'n str) -> &'n str {
        self.renamed.iter().find(|(here, _)| here == name).map_or(name, |(_, there)| there)
    }

    /// The second file's name of a link.
    pub fn link_there<'n>(&'n self, name: &'n str) -> &'n str {
        self.links.iter().find(|(here, _)| here == name).map_or(name, |(_, there)| there)
    }
}

/// The corresponding joint of the other robot: by name if it moves, by its child if it is fixed.
pub fn twin<'b>(joint: &Joint, b: &'b Description) -> Option<&'b Joint> {
    match joint.kind {
        JointKind::Fixed => b.joints.iter().find(|there| there.kind == JointKind::Fixed && there.child == joint.child),
        _ => b.joints.iter().find(|there| there.name == joint.name && there.kind != JointKind::Fixed),
    }
}

/// The links that a joint of the same name moves, then the bases, too, where their names are in one robot only.
fn links_of_joints(a: &Description, b: &Description, affixes: &Affixes) -> Vec<(String, String)> {
    let has = |robot: &Description, name: &str| {
        robot.links.iter().any(|link| link.name == name) || robot.frames.iter().any(|frame| frame.name == name)
    };
    let is_renamed = |(x, y): &(String, String)| !has(a, y) && !has(b, x);
    let base = |robot: &Description| {
        let is_base = |name: &str| robot.joints.iter().all(|joint| joint.child != name);
        robot.links.iter().find(|link| is_base(&link.name)).map(|link| link.name.clone())
    };
    let moved = a.joints.iter().filter_map(|joint| {
        let there = b.joints.iter().find(|there| there.name == joint.name)?;
        Some((joint.child.clone(), there.child.clone()))
    });
    let mut links: Vec<(String, String)> = moved.filter(is_renamed).collect();
    if !links.is_empty() {
        links.extend(base(a).zip(base(b)).filter(is_renamed));
    }
    // what is fixed has no joint that matches
    let names = |robot: &Description| -> Vec<String> { robot.links.iter().map(|link| link.name.clone()).collect() };
    let pairs = names(a).into_iter().flat_map(|x| names(b).into_iter().map(move |y| (x.clone(), y)));
    let is_new =
        |pair: &(String, String), known: &[(String, String)]| known.iter().all(|(x, y)| *x != pair.0 && *y != pair.1);
    let called: Vec<_> = pairs.filter(|(x, y)| affixes.fit(x, y)).filter(is_renamed).collect();
    called.into_iter().for_each(|pair| {
        if is_new(&pair, &links) {
            links.push(pair)
        }
    });
    links
}

fn rename_link(robot: &mut Description, from: &str, to: &str) {
    let links = robot.links.iter_mut().map(|link| &mut link.name);
    let of_joints = robot.joints.iter_mut().flat_map(|joint| [&mut joint.parent, &mut joint.child]);
    let of_frames = robot.frames.iter_mut().map(|frame| &mut frame.link);
    let all = links.chain(of_joints).chain(of_frames).chain(&mut robot.end_effector);
    all.filter(|name| *name == from).for_each(|name| *name = to.to_string());
}
