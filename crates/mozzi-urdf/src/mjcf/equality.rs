//! `<equality>`: an affine coupling of two joints is a mimic joint; `connect`, `weld` and the other couplings of joints
//! and of fixed tendons are constraints; those of flexible bodies are refused by name.

use super::Model;
use super::attributes::Item;
use super::class::{Class, MOST_SUGGESTED};
use super::orientation::quaternion;
use super::tree::{Constraint, Name, Tree};
use super::vocabulary;
use crate::report::finding::Finding;
use crate::report::places::Place;
use crate::report::spelling::did_you_mean;
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::vocabulary::shown;
use mozzi::model::description::{Anchor, Closure, ConstraintKind, Gear, Mimic};
use mozzi::{SE3, Vec3};
use std::collections::BTreeMap;

/// A link's number, and a frame in it.
type End = (usize, SE3);

/// The elements that equalities refer to.
pub(crate) struct Named<'t> {
    joints: &'t BTreeMap<String, usize>,
    bodies: BTreeMap<String, usize>,
    sites: BTreeMap<String, End>,
    /// The poses of all links in the file's own configuration.
    poses: Vec<SE3>,
}

impl<'t> Named<'t> {
    pub fn new(tree: &Tree, joints: &'t BTreeMap<String, usize>) -> Self {
        let body = |(i, link): (usize, &super::tree::Link)| Some((link.name.given.clone()?, i));
        Named {
            joints,
            bodies: tree.links.iter().enumerate().filter_map(body).collect(),
            sites: tree.sites.iter().map(|site| (site.name.clone(), (site.link, site.T))).collect(),
            poses: tree.poses(),
        }
    }

    /// The configuration of the second link relative to the first in the file's own configuration.
    fn relative(&self, [one, two]: [usize; 2]) -> SE3 {
        self.poses[one].inverse() * self.poses[two]
    }
}

impl<'a> Model<'a> {
    /// An element of `<equality>`.
    pub fn equality(&mut self, element: Element<'a>, named: &Named, cx: &mut Context) {
        if !vocabulary::EQUALITY.many.contains(&element.name()) {
            return; // already reported
        }
        let item = self.classes.item(element, "equality", Class::MAIN, cx);
        let name = item.element.name();
        if !self.options.equality || !item.flag("active", true, cx) {
            self.ignored.list("equality", item.element.span(), "mujoco", "it is not active");
            return;
        }
        match name {
            "joint" => {
                item.element.check_attributes(&vocabulary::COUPLING, cx);
                self.coupling(&item, named.joints, cx);
            }
            "connect" => {
                item.element.check_attributes(&vocabulary::CONNECT, cx);
                self.connect(&item, named, cx);
            }
            "weld" => {
                item.element.check_attributes(&vocabulary::WELD, cx);
                self.weld(&item, named, cx);
            }
            "tendon" => {
                item.element.check_attributes(&vocabulary::TENDON_COUPLING, cx);
                self.tendon_coupling(&item, named.joints, cx);
            }
            _ => {
                let message = format!("{}: ties a flexible body, which mozzi does not compute", item.element.subject);
                let help = "remove it, or set active=\"false\", if you want to compute the robot without it";
                cx.findings.add(Finding::error("unsupported_equality", item.element.span(), message).help(help));
            }
        }
    }

    /// A point of body 1 and the point of body 2 that coincides with it in the file's own configuration; or two sites.
    fn connect(&mut self, item: &Item<'a>, named: &Named, cx: &mut Context) {
        let Some(ends) = ends(item, named, cx) else { return };
        let ends = match ends {
            Ends::Sites(ends) => ends,
            Ends::Bodies([one, two]) => {
                if item.element.required("anchor", cx).is_none() {
                    return;
                }
                let Some(anchor) = item.vector::<3>("anchor", cx) else { return };
                let a = SE3::translation(anchor);
                [(one, a), (two, named.relative([two, one]) * a)]
            }
        };
        self.tie(item, ends, Closure::Point, cx);
    }

    /// A frame of body 1 and the frame of body 2 that has to coincide with it; or two sites.
    fn weld(&mut self, item: &Item<'a>, named: &Named, cx: &mut Context) {
        let Some(ends) = ends(item, named, cx) else { return };
        let ends = match ends {
            Ends::Sites(ends) => ends,
            Ends::Bodies([one, two]) => {
                let b = SE3::translation(item.vector::<3>("anchor", cx).unwrap_or([0.0; 3]));
                let given = item.vector::<7>("relpose", cx).and_then(|[x, y, z, q @ ..]| {
                    Some(SE3 { R: quaternion(q)?, p: Vec3([x, y, z]) }) // a zero quaternion: as drawn
                });
                [(one, given.unwrap_or_else(|| named.relative([one, two]) * b)), (two, b)]
            }
        };
        let scale = item.number("torquescale", 1.0, cx);
        if let Some(value) = item.value("torquescale").filter(|_| scale != 0.0 && scale != 1.0) {
            cx.leave_out(item.element.name(), "torquescale", value.span); // of a force that rigid bodies determine
        }
        // MuJoCo's rows of the rotation are 0 then
        self.tie(item, ends, if scale == 0.0 { Closure::Point } else { Closure::Weld }, cx);
    }

    /// Adds a constraint between two frames. Frames in the world itself are in {s}.
    fn tie(&mut self, item: &Item<'a>, ends: [End; 2], closure: Closure, cx: &mut Context) {
        let links = ends.map(|(link, _)| Some(link).filter(|link| *link != 0));
        let [a, b] = ends.map(|(_, T)| Anchor { frame: None, T });
        self.add(item, links, ConstraintKind::Frames { a, b, closure }, cx);
    }

    fn add(&mut self, item: &Item<'a>, links: [Option<usize>; 2], kind: ConstraintKind, cx: &mut Context) {
        let mut place = Place::new(item.element.span());
        let written = [
            ("name", "name"),
            ("joint", "joint1"),
            ("joint", "tendon1"),
            ("source", "joint2"),
            ("source", "tendon2"),
            ("polynomial", "polycoef"),
        ];
        for (name, written) in written {
            if let Some(value) = item.value(written) {
                place.set(name, value.span);
            }
        }
        let number = self.tree.constraints.len();
        let name = Name::of(&item.element, format!("{}{number}", item.element.name()), cx);
        self.tree.constraints.push(Constraint { name, links, kind, place });
    }

    /// y − y₀ = Σ a_k (x − x₀)ᵏ: if linear, y is a mimic joint of x, unless it is one already; else a constraint.
    fn coupling(&mut self, item: &Item<'a>, names: &BTreeMap<String, usize>, cx: &mut Context) {
        let polynomial = polynomial(item, cx);
        let Some((y, source)) = pair(&item.element, ["joint1", "joint2"], "joint", names, cx) else { return };
        let name = |joint: usize| self.tree.joints[joint].name.given.clone().unwrap_or_default();
        let y0 = self.tree.joints[y].reference;
        if let (Some(x), [a0, a1, 0.0, 0.0, 0.0], None) = (source, polynomial, &self.tree.joints[y].joint.mimic) {
            let offset = y0 + a0 - a1 * self.tree.joints[x].reference;
            let source = name(x);
            let joint = &mut self.tree.joints[y];
            if let Some(value) = item.element.attribute("joint2") {
                joint.place.set("mimic", value.span);
            }
            joint.joint.mimic = Some(Mimic { joint: source, ratio: a1, offset });
            return;
        }
        let one = |joint| Gear { joint: name(joint), ratio: 1.0 };
        self.couple(item, [vec![one(y)], source.map(one).into_iter().collect()], polynomial, names, cx);
    }

    /// l₁ − l₁₀ = Σ a_k (l₂ − l₂₀)ᵏ of fixed tendons, with l = Σ coef θ.
    fn tendon_coupling(&mut self, item: &Item<'a>, joints: &BTreeMap<String, usize>, cx: &mut Context) {
        let tendons = self.tree.rotors.iter().enumerate();
        let tendons = tendons.filter_map(|(i, tendon)| Some((tendon.name.given.clone()?, i))).collect();
        let attributes = ["tendon1", "tendon2"];
        let Some((one, two)) = pair(&item.element, attributes, "tendon", &tendons, cx) else { return };
        let mut sum = |(attribute, tendon): (&str, usize)| {
            let tendon = &mut self.tree.rotors[tendon];
            tendon.is_tied = true;
            let gears: Vec<Gear> = tendon.gears.iter().filter(|gear| gear.ratio != 0.0).cloned().collect();
            let what = match () {
                () if !tendon.is_fixed => Some("is a spatial tendon, which mozzi does not compute"),
                () if gears.is_empty() && !tendon.gears.is_empty() => {
                    Some("is a tendon of length 0, expected a `coef` other than 0")
                }
                () => None,
            };
            if let Some(what) = what {
                let message = format!("{attribute}: {what}");
                let help = "remove the equality, or set active=\"false\", if you want to compute the robot without it";
                cx.findings.add(item.error("unsupported_equality", attribute, &message).help(help));
            }
            (!gears.is_empty()).then_some(gears) // else reported
        };
        let (one, two) = (sum(("tendon1", one)), two.map(|two| sum(("tendon2", two))));
        if let (Some(one), Some(two)) = (one, two.map_or(Some(Vec::new()), |two| two)) {
            let polynomial = polynomial(item, cx);
            self.couple(item, [one, two], polynomial, joints, cx);
        }
    }

    /// y − y₀ = Σ a_k (x − x₀)ᵏ for sums of joints' positions, which are y₀ and x₀ in the file's own configuration.
    fn couple(
        &mut self,
        item: &Item<'a>,
        [joints, source]: [Vec<Gear>; 2],
        a: [f64; 5],
        names: &BTreeMap<String, usize>,
        cx: &mut Context,
    ) {
        let of = |gear: &Gear| names.get(&gear.joint).map_or(0.0, |&i| gear.ratio * self.tree.joints[i].reference);
        let [y0, x0] = [&joints, &source].map(|sum| sum.iter().map(of).sum::<f64>());
        let mut polynomial = if source.is_empty() { [a[0], 0.0, 0.0, 0.0, 0.0] } else { about_zero(a, x0) };
        polynomial[0] += y0;
        self.add(item, [None, None], ConstraintKind::Joint { joints, source, polynomial }, cx);
    }
}

fn polynomial(item: &Item, cx: &mut Context) -> [f64; 5] {
    if item.has("polycoef") { item.overlaid("polycoef", cx) } else { [0.0, 1.0, 0.0, 0.0, 0.0] }
}

/// The two ends of a tie.
enum Ends {
    Sites([End; 2]),
    Bodies([usize; 2]),
}

/// The sites, or the bodies, of a tie.
fn ends(item: &Item, named: &Named, cx: &mut Context) -> Option<Ends> {
    let element = &item.element;
    let has = |names: [&str; 2]| names.iter().any(|name| element.attribute(name).is_some());
    let (of_sites, of_bodies) = (has(["site1", "site2"]), has(["body1", "body2"]));
    if of_sites == of_bodies {
        let found = if of_sites { "both sites and bodies" } else { "neither sites nor bodies" };
        let message = format!("{}: has {found}, expected `body1`, or `site1` and `site2`", element.subject);
        cx.findings.add(Finding::error("missing_attribute", element.span(), message));
        return None;
    }
    if of_sites {
        let mut site = |attribute| find(element, attribute, "site", "unknown_frame", &named.sites, cx);
        let (one, two) = (site("site1"), site("site2"));
        return Some(Ends::Sites([one?, two?]));
    }
    let mut body = |attribute| find(element, attribute, "body", "unknown_link", &named.bodies, cx);
    let one = body("body1");
    let two = if element.attribute("body2").is_some() { body("body2") } else { Some(0) };
    Some(Ends::Bodies([one?, two?]))
}

/// The joints or tendons named by two attributes, of which the second may be absent.
fn pair(
    element: &Element,
    [one, two]: [&str; 2],
    what: &str,
    named: &BTreeMap<String, usize>,
    cx: &mut Context,
) -> Option<(usize, Option<usize>)> {
    let mut get = |attribute| find(element, attribute, what, "unknown_joint", named, cx);
    let first = get(one);
    let second = if element.attribute(two).is_some() { Some(get(two)?) } else { None };
    Some((first?, second))
}

/// The element named by an attribute; None, with a diagnostic, if there is none.
fn find<T: Copy>(
    element: &Element,
    attribute: &str,
    what: &str,
    code: &'static str,
    named: &BTreeMap<String, T>,
    cx: &mut Context,
) -> Option<T> {
    let value = element.required(attribute, cx)?;
    let found = named.get(value.text).copied();
    if found.is_none() {
        let message = format!("{}: {attribute}: there is no {what} `{}`", element.subject, shown(value.text));
        let help = did_you_mean(value.text, named.keys().map(String::as_str).take(MOST_SUGGESTED));
        cx.findings.add(Finding::error(code, value.span, message).maybe_help(help));
    }
    found
}

/// The coefficients c of Σ c_k xᵏ = Σ a_k (x − x₀)ᵏ, by Horner's method.
fn about_zero(a: [f64; 5], x0: f64) -> [f64; 5] {
    let mut c = [0.0; 5];
    for a in a.into_iter().rev() {
        // c ← c · (x − x₀) + a
        for k in (0..5).rev() {
            let below = if k == 0 { a } else { c[k - 1] };
            c[k] = below - x0 * c[k];
        }
    }
    c
}

#[cfg(test)]
mod tests {
    use super::about_zero;

    #[test]
    fn a_polynomial_about_another_point_has_the_same_values() {
        let (a, x0) = ([0.3, -1.2, 0.7, 2.0, -0.4], 0.8);
        let c = about_zero(a, x0);
        let at = |c: [f64; 5], x: f64| c.iter().rev().fold(0.0, |sum, c| sum * x + c);
        for x in [-1.5, 0.0, 0.4, 2.0] {
            assert!((at(c, x) - at(a, x - x0)).abs() < 1e-13, "{x}");
        }
        assert_eq!(about_zero(a, 0.0), a);
    }
}
