//! Constraints that one file lacks, or has with other numbers.

use super::cause::{Cause, Change};
use super::number::{Angle, reason, same, shown};
use crate::compare::Result;
use crate::compare::constants::{freed, home};
use mozzi::model::description::{Anchor, Closure, Constraint, ConstraintKind, Gear};
use mozzi::{Description, SE3, Vec3};
use std::collections::BTreeMap;

/// Lengths and directions equal to the digits that converters keep.
const DIGITS: f64 = 1e-6;

/// The causes of both robots; `names` gives the second one's name of a joint of the first.
pub fn causes<'d>(
    [a, b]: [&'d Description; 2],
    names: &dyn Fn(&str) -> String,
    [one, other]: [&str; 2],
) -> Result<Vec<Cause>> {
    if a.constraints.is_empty() && b.constraints.is_empty() {
        return Ok(Vec::new());
    }
    let (here, there) = (Side::of(a, names)?, Side::of(b, &|name| name.to_string())?);
    let (mut lone, mut lone_there) = (here.all(), there.all());
    let mut pairs: Vec<(&'d Constraint, &'d Constraint)> = Vec::new();
    type Fits<'f> = &'f dyn Fn(&Constraint, &Constraint) -> bool;
    let is_same = |x: &Constraint, y: &Constraint| are_same([&here, &there], &x.kind, &y.kind);
    let holds_same =
        |x: &Constraint, y: &Constraint| noun(&x.kind) == noun(&y.kind) && here.held(&x.kind) == there.held(&y.kind);
    let is_named = |x: &Constraint, y: &Constraint| x.name == y.name;
    let mut pair = |fits: Fits, lone: &mut Vec<&'d Constraint>, lone_there: &mut Vec<&'d Constraint>| {
        lone.retain(|x| {
            let Some(k) = lone_there.iter().position(|y| fits(x, y)) else { return true };
            pairs.push((x, lone_there.remove(k)));
            false
        });
    };
    pair(&|x, y| is_named(x, y) && is_same(x, y), &mut lone, &mut lone_there);
    pair(&is_same, &mut lone, &mut lone_there);
    // a hinge that is written as points of its axis
    let is_hinge = |side: &Side, x: &Constraint, other: &Side, list: &mut Vec<&Constraint>| {
        let on_axis = |y: &&Constraint| is_point_of_axis([side, other], &x.kind, &y.kind);
        let is_whole = list.iter().filter(|y| on_axis(y)).count() > 1;
        list.retain(|y| !(is_whole && on_axis(y)));
        is_whole
    };
    lone.retain(|x| !is_hinge(&here, x, &there, &mut lone_there));
    lone_there.retain(|y| !is_hinge(&there, y, &here, &mut lone));
    pair(&is_named, &mut lone, &mut lone_there);
    pair(&holds_same, &mut lone, &mut lone_there);
    let mut causes = Vec::new();
    let mut add = |constraint: &Constraint, sentence: String, has_reason: bool| {
        causes.push(Cause::new("constraint", &constraint.name, sentence, has_reason, Change::NoForce));
    };
    for x in lone {
        add(x, format!("constraint `{}` is dropped in {other}: {}", x.name, words(&x.kind)), true);
    }
    for y in lone_there {
        add(y, format!("constraint `{}` appears in {other}, {one} lacks it: {}", y.name, words(&y.kind)), true);
    }
    for (x, y) in pairs.into_iter().filter(|(x, y)| !is_same(x, y)) {
        let (what, has_reason) = difference(x, y, holds_same(x, y), other);
        add(x, what, has_reason);
    }
    Ok(causes)
}

/// A robot with the places of its frames.
struct Side<'d, 'n> {
    robot: &'d Description,
    home: BTreeMap<String, SE3>,
    /// The joint that moves each link or frame, under the second robot's name; the root's body is `BASE`.
    carrier: BTreeMap<String, String>,
    names: &'n dyn Fn(&str) -> String,
}

/// The body of the root, if it floats, and the world.
const BASE: &str = "base";
const WORLD: &str = "world";

impl<'d, 'n> Side<'d, 'n> {
    fn of(robot: &'d Description, names: &'n dyn Fn(&str) -> String) -> Result<Self> {
        let model = freed(robot).build()?;
        let root = if model.is_floating() { BASE } else { WORLD };
        let body = |joint: Option<&str>| joint.map_or_else(|| root.to_string(), |joint| format!("`{}`", names(joint)));
        let mut carrier: BTreeMap<String, String> = (model.folded_links().iter())
            .flat_map(|body_of| body_of.links.iter().map(|(link, _)| (link.to_string(), body(body_of.joint))))
            .collect();
        for frame in &robot.frames {
            if let Some(body) = carrier.get(&frame.link).cloned() {
                carrier.insert(frame.name.clone(), body);
            }
        }
        Ok(Side { robot, home: home(robot)?, carrier, names })
    }

    fn all(&self) -> Vec<&'d Constraint> {
        self.robot.constraints.iter().collect()
    }

    /// The body of an anchor, and its place at home.
    fn place(&self, anchor: &Anchor) -> (String, SE3) {
        let Some(frame) = &anchor.frame else { return (WORLD.to_string(), anchor.T) };
        let body = self.carrier.get(frame).cloned().unwrap_or_default();
        (body, self.home.get(frame).copied().unwrap_or_else(SE3::identity) * anchor.T)
    }

    /// The joints of a coupling, or the bodies of the anchors, sorted.
    fn held(&self, kind: &ConstraintKind) -> Vec<String> {
        let mut held: Vec<String> = match kind {
            ConstraintKind::Frames { a, b, .. } => [a, b].map(|anchor| self.place(anchor).0).into(),
            ConstraintKind::Joint { joints, source, .. } => {
                joints.iter().chain(source).map(|gear| (self.names)(&gear.joint)).collect()
            }
        };
        held.sort_unstable();
        held
    }

    /// Factors of the positions in a sum.
    fn sum(&self, gears: &[Gear]) -> BTreeMap<String, f64> {
        gears.iter().map(|gear| ((self.names)(&gear.joint), gear.ratio)).collect()
    }
}

fn noun(kind: &ConstraintKind) -> &'static str {
    match kind {
        ConstraintKind::Joint { .. } => "coupling",
        ConstraintKind::Frames { closure, .. } => match closure {
            Closure::Point => "point",
            Closure::Weld => "weld",
            Closure::Hinge => "hinge",
            Closure::Distance(_) => "distance",
            Closure::Rolling(_) => "rolling wheel",
        },
    }
}

/// "a weld of `hand` and the world".
fn words(kind: &ConstraintKind) -> String {
    let frame = |anchor: &Anchor| anchor.frame.as_ref().map_or_else(|| "the world".into(), |name| format!("`{name}`"));
    let mut list: Vec<String> = match kind {
        ConstraintKind::Frames { a, b, .. } => vec![frame(a), frame(b)],
        ConstraintKind::Joint { joints, source, .. } => {
            joints.iter().chain(source).map(|gear| format!("`{}`", gear.joint)).collect()
        }
    };
    let last = list.pop().unwrap_or_default();
    let list = if list.is_empty() { last } else { format!("{} and {last}", list.join(", ")) };
    format!("a {} of {list}", noun(kind))
}

/// Whether two constraints restrict the same motion.
fn are_same(sides: [&Side; 2], x: &ConstraintKind, y: &ConstraintKind) -> bool {
    match (x, y) {
        (
            ConstraintKind::Joint { joints, source, polynomial },
            ConstraintKind::Joint { joints: others, source: other_source, polynomial: other_polynomial },
        ) => {
            let sums = [(joints, source), (others, other_source)];
            let [[x, u], [y, v]] = [0, 1].map(|k| [sides[k].sum(sums[k].0), sides[k].sum(sums[k].1)]);
            match (linear(&x, &u, polynomial), linear(&y, &v, other_polynomial)) {
                (Some(p), Some(q)) => equal(&p, &q),
                (None, None) => {
                    equal(&x, &y) && equal(&u, &v) && polynomial.iter().zip(other_polynomial).all(|(p, q)| same(*p, *q))
                }
                _ => false,
            }
        }
        (
            ConstraintKind::Frames { a, b, closure },
            ConstraintKind::Frames { a: other_a, b: other_b, closure: other_closure },
        ) => {
            let is_literal = |x: &Anchor, y: &Anchor| x.frame == y.frame && near_place(x.T, y.T);
            let place = |k: usize, anchor: &Anchor| sides[k].place(anchor);
            let [p, q] = [place(0, a), place(0, b)];
            let [r, s] = [place(1, other_a), place(1, other_b)];
            let same_bodies = |p: &(String, SE3), q: &(String, SE3)| p.0 == q.0;
            let is_direct = same_bodies(&p, &r) && same_bodies(&q, &s);
            let is_swapped = same_bodies(&p, &s) && same_bodies(&q, &r) && !matches!(closure, Closure::Rolling(_));
            same_closure(closure, other_closure)
                && (is_direct && is_literal(a, other_a) && is_literal(b, other_b)
                    || is_direct && same_places(closure, [p.1, q.1], [r.1, s.1])
                    || is_swapped && same_places(closure, [p.1, q.1], [s.1, r.1]))
        }
        _ => false,
    }
}

/// A linear coupling as Σ k θ, of joints by their names, and its constant by no name; the first factor is 1.
fn linear(
    joints: &BTreeMap<String, f64>,
    source: &BTreeMap<String, f64>,
    [constant, slope, higher @ ..]: &[f64; 5],
) -> Option<BTreeMap<String, f64>> {
    if higher.iter().any(|c| *c != 0.0) {
        return None;
    }
    let mut sum = joints.clone();
    source.iter().for_each(|(joint, ratio)| *sum.entry(joint.clone()).or_insert(0.0) -= slope * ratio);
    sum.retain(|_, factor| *factor != 0.0);
    let first = *sum.values().next()?;
    sum.insert(String::new(), -constant);
    sum.values_mut().for_each(|factor| *factor /= first);
    Some(sum)
}

fn equal(x: &BTreeMap<String, f64>, y: &BTreeMap<String, f64>) -> bool {
    x.len() == y.len() && x.iter().zip(y).all(|((name, p), (other, q))| name == other && same(*p, *q))
}

fn same_closure(x: &Closure, y: &Closure) -> bool {
    match (x, y) {
        (Closure::Distance(p), Closure::Distance(q)) | (Closure::Rolling(p), Closure::Rolling(q)) => same(*p, *q),
        _ => x == y,
    }
}

fn near(x: Vec3, y: Vec3) -> bool {
    (x - y).norm() <= DIGITS * (1.0 + x.norm())
}

fn near_place(x: SE3, y: SE3) -> bool {
    near(x.p, y.p) && (x.R.inverse() * y.R).log().norm() <= DIGITS
}

fn z_axis(T: SE3) -> Vec3 {
    T.R * Vec3([0.0, 0.0, 1.0])
}

/// Anchors {a} and {b} at home in one robot and in the other.
fn same_places(closure: &Closure, [a, b]: [SE3; 2], [c, d]: [SE3; 2]) -> bool {
    let sign = if z_axis(b).dot(z_axis(d)) < 0.0 { -1.0 } else { 1.0 };
    match closure {
        Closure::Point | Closure::Distance(_) => near(a.p, c.p) && near(b.p, d.p),
        Closure::Weld => near_place(b * a.inverse(), d * c.inverse()),
        Closure::Hinge => {
            let along = z_axis(a).dot(c.p - a.p);
            near(z_axis(a), z_axis(c) * sign)
                && near(z_axis(b), z_axis(d) * sign)
                && near(a.p + z_axis(a) * along, c.p)
                && near(b.p + z_axis(b) * along, d.p)
        }
        Closure::Rolling(_) => {
            near(z_axis(a), z_axis(c))
                && z_axis(a).dot(c.p - a.p).abs() <= DIGITS * (1.0 + a.p.norm())
                && near(b.p, d.p)
                && near(z_axis(b), z_axis(d) * sign)
        }
    }
}

/// True if the second one is a point on the first one's axis.
fn is_point_of_axis(sides: [&Side; 2], hinge: &ConstraintKind, point: &ConstraintKind) -> bool {
    let (
        ConstraintKind::Frames { a, b, closure: Closure::Hinge },
        ConstraintKind::Frames { a: c, b: d, closure: Closure::Point },
    ) = (hinge, point)
    else {
        return false;
    };
    let [a, b] = [a, b].map(|anchor| sides[0].place(anchor));
    [[c, d], [d, c]].iter().any(|points| {
        let [c, d] = points.map(|anchor| sides[1].place(anchor));
        let along = z_axis(a.1).dot(c.1.p - a.1.p);
        let is_on = |T: SE3, point: SE3| near(T.p + z_axis(T) * along, point.p);
        a.0 == c.0 && b.0 == d.0 && is_on(a.1, c.1) && is_on(b.1, d.1)
    })
}

/// The sentence of two constraints that are not the same, and whether it has a reason.
fn difference(x: &Constraint, y: &Constraint, holds_same: bool, other: &str) -> (String, bool) {
    let name = &x.name;
    if !holds_same {
        return (format!("constraint `{name}` is {} in {other}, {} here", words(&y.kind), words(&x.kind)), true);
    }
    let number = |what: &str, p: f64, q: f64| {
        let why = reason(p, q, Angle::None);
        let has_reason = why.is_some();
        let why = why.unwrap_or_else(|| "differs".to_string());
        (format!("{what} of constraint `{name}` {why} in {other}: {} instead of {}", shown(q), shown(p)), has_reason)
    };
    match (&x.kind, &y.kind) {
        (ConstraintKind::Frames { closure: p, .. }, ConstraintKind::Frames { closure: q, .. }) => match (p, q) {
            (Closure::Distance(p), Closure::Distance(q)) if !same(*p, *q) => number("distance", *p, *q),
            (Closure::Rolling(p), Closure::Rolling(q)) if !same(*p, *q) => number("radius", *p, *q),
            _ => (format!("anchors of constraint `{name}` are elsewhere in {other}"), false),
        },
        (ConstraintKind::Joint { polynomial: p, .. }, ConstraintKind::Joint { polynomial: q, .. }) => {
            let differing: Vec<usize> = (0..p.len()).filter(|&k| !same(p[k], q[k])).collect();
            match differing.as_slice() {
                [] => (format!("ratios of constraint `{name}` differ in {other}"), false),
                &[k] => number(&format!("coefficient {k}"), p[k], q[k]),
                _ => {
                    let list = |c: &[f64; 5]| c.map(shown).join(" ");
                    let sentence = format!("polynomial of constraint `{name}` differs in {other}");
                    (format!("{sentence}: {} instead of {}", list(q), list(p)), false)
                }
            }
        }
        _ => (format!("constraint `{name}` differs in {other}"), false),
    }
}
