//! The tree while it is read. Joints refer to links by number, since names are assigned once all are known.

use super::spring::SpringDamper;
use crate::report::finding::Finding;
use crate::report::places::{Place, Places};
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::vocabulary::shown;
use mozzi::model::description::{self, ConstraintKind, FreeJoint, Gear, JointKind};
use mozzi::{Base, Description, SE3, SpatialInertia};
use std::collections::BTreeSet;
use std::ops::Range;

/// The name of an element, or its generated name.
pub(crate) struct Name {
    pub given: Option<String>,
    pub otherwise: String,
}

impl Name {
    /// The name in the file, and the generated name if there is none.
    pub fn of(element: &Element, otherwise: String, cx: &mut Context) -> Self {
        let is_named = element.attribute("name").is_some_and(|name| !name.text.is_empty());
        let value = if is_named { element.required_name("name", cx) } else { None };
        Name { given: value.map(|value| value.text.to_string()), otherwise }
    }

    /// With what <replicate> adds to it.
    pub fn suffixed(mut self, suffix: &str) -> Self {
        if let Some(given) = &mut self.given {
            given.push_str(suffix);
        }
        self
    }

    pub fn generated(otherwise: String) -> Self {
        Name { given: None, otherwise }
    }

    pub fn shown(&self) -> String {
        shown(self.given.as_ref().unwrap_or(&self.otherwise))
    }
}

/// A body, or a massless link between two joints of one body.
pub(crate) struct Link {
    pub name: Name,
    pub inertia: SpatialInertia,
    /// The part of its weight that is compensated.
    pub compensation: f64,
    /// True for a mocap body.
    pub is_mocap: bool,
    pub place: Place,
}

/// A joint; its name, parent and child are settled at the end.
pub(crate) struct Joint {
    pub name: Name,
    pub parent: usize,
    pub child: usize,
    pub joint: description::Joint,
    /// The position of the file's own configuration.
    pub reference: f64,
    /// The pose of a free body there.
    pub start: SE3,
    /// Replaces stiffness and damping.
    pub spring_damper: Option<SpringDamper>,
    pub place: Place,
}

/// A tendon with an inertia; its name is settled at the end.
pub(crate) struct Rotor {
    pub name: Name,
    pub armature: f64,
    pub gears: Vec<Gear>,
    /// True for a `fixed` tendon, which has constant ratios.
    pub is_fixed: bool,
    /// True if it is refused; the reason was reported.
    pub is_refused: bool,
    pub is_limited: bool,
    /// True if it has an `actuatorfrcrange`.
    pub clamps: bool,
    /// True if an equality ties it.
    pub is_tied: bool,
    pub place: Place,
}

/// A constraint; the names of its anchors' frames are settled at the end.
pub(crate) struct Constraint {
    pub name: Name,
    /// The links of its anchors; None is {s}.
    pub links: [Option<usize>; 2],
    pub kind: ConstraintKind,
    pub place: Place,
}

/// A site.
pub(crate) struct Site {
    pub name: String,
    pub link: usize,
    pub T: SE3,
    pub place: Place,
}

/// A free body that is the base: its link, and the name of its joint.
pub(crate) struct Free {
    pub link: usize,
    pub joint: Option<String>,
    /// Its pose in the file's own configuration.
    pub start: SE3,
}

/// Links, joints and sites in the order of the file; the first link is the world.
pub(crate) struct Tree {
    place: Place,
    pub links: Vec<Link>,
    pub joints: Vec<Joint>,
    pub sites: Vec<Site>,
    pub rotors: Vec<Rotor>,
    pub constraints: Vec<Constraint>,
    /// The body that is free.
    pub free: Option<Free>,
    /// MuJoCo's count of bodies and joints so far.
    pub bodies: usize,
    pub degrees: usize,
}

impl Tree {
    pub fn new(root: &Element) -> Self {
        let world = Link {
            name: Name { given: Some("world".to_string()), otherwise: String::new() },
            inertia: SpatialInertia::zero(),
            compensation: 0.0,
            is_mocap: false,
            place: Place::new(root.span()),
        };
        let place = Place::new(root.span());
        Tree {
            place,
            links: vec![world],
            joints: Vec::new(),
            sites: Vec::new(),
            rotors: Vec::new(),
            constraints: Vec::new(),
            free: None,
            bodies: 0,
            degrees: 0,
        }
    }

    /// Adds a joint between two links, at first fixed.
    pub fn joint(&mut self, name: Name, [parent, child]: [usize; 2], origin: SE3, place: Place) -> &mut Joint {
        let joint = description::Joint::new("", "", "", origin, JointKind::Fixed);
        self.joints.push(Joint {
            name,
            parent,
            child,
            joint,
            reference: 0.0,
            start: SE3::identity(),
            spring_damper: None,
            place,
        });
        let last = self.joints.len() - 1;
        &mut self.joints[last]
    }

    /// The configurations of all links in the file's own configuration.
    pub fn poses(&self) -> Vec<SE3> {
        let mut poses = vec![SE3::identity(); self.links.len()];
        // parents precede their children
        for joint in &self.joints {
            let moved = match joint.joint.kind {
                JointKind::Screw(A) => joint.joint.origin * SE3::exp(A.twist() * joint.reference),
                JointKind::Free => joint.start,
                JointKind::Fixed | JointKind::Ball(_) => joint.joint.origin,
            };
            poses[joint.child] = poses[joint.parent] * moved;
        }
        poses
    }

    /// The description, with generated names for unnamed elements.
    pub fn describe(self, name: &str, gravity: [f64; 3], cx: &mut Context) -> (Description, Places) {
        let mut places = Places { robot: self.place, ..Places::default() };
        let (mut description, mut carriers) = (Description::new(name).with_gravity(gravity), Vec::new());

        if let Some(free) = &self.free {
            description.base = Base::Floating;
            description.free_joint.name.clone_from(free.joint.as_ref().unwrap_or(&FreeJoint::default().name));
        }
        let mut taken: BTreeSet<String> = self.links.iter().filter_map(|link| link.name.given.clone()).collect();
        let mut renamed: Option<(Range<usize>, String, usize)> = None;
        for site in self.sites {
            let mut name = site.name;
            if taken.contains(&name) {
                let other = free(&format!("{name}:site"), &taken);
                renamed
                    .get_or_insert_with(|| {
                        let (site_name, other) = (shown(&name), shown(&other));
                        (
                            site.place.span("name"),
                            format!("site `{site_name}`: a body has this name, too; the site is called `{other}` here"),
                            0,
                        )
                    })
                    .2 += 1;
                name = other;
            }
            places.frames.push(site.place);
            carriers.push(site.link);
            description.frames.push(description::NamedFrame { name, link: String::new(), T: site.T });
        }
        if let Some((span, message, count)) = renamed {
            let message = if count == 1 { message } else { format!("{message} (and {} more)", count - 1) };
            let help = "bodies and sites are both frames in mozzi; the site's new name combines both names";
            cx.findings.add(Finding::warning("renamed_site", span, message).help(help));
        }
        taken.extend(description.frames.iter().map(|frame| frame.name.clone()));
        let mut names = Names::new("body", taken);
        for link in self.links {
            let name = names.settle(link.name, &link.place, cx);
            description.links.push(description::Link { name, inertia: link.inertia });
            places.links.push(link.place);
        }
        let links = &description.links;
        let link = |i: usize| links[i].name.clone();
        for (frame, carrier) in description.frames.iter_mut().zip(carriers) {
            frame.link = link(carrier);
        }
        let mut names = Names::new("joint", self.joints.iter().filter_map(|joint| joint.name.given.clone()).collect());
        for joint in self.joints {
            let name = names.settle(joint.name, &joint.place, cx);
            let (parent, child) = (link(joint.parent), link(joint.child));
            places.joints.push(joint.place);
            description.joints.push(description::Joint { name, parent, child, ..joint.joint });
        }
        let mut names = Names::new("tendon", self.rotors.iter().filter_map(|rotor| rotor.name.given.clone()).collect());
        for rotor in self.rotors {
            let name = names.settle(rotor.name, &rotor.place, cx);
            places.rotors.push(rotor.place);
            description.rotors.push(description::Rotor { name, armature: rotor.armature, gears: rotor.gears });
        }
        let mut names =
            Names::new("equality", self.constraints.iter().filter_map(|one| one.name.given.clone()).collect());
        for one in self.constraints {
            let name = names.settle(one.name, &one.place, cx);
            let mut kind = one.kind;
            if let ConstraintKind::Frames { a, b, .. } = &mut kind {
                [a.frame, b.frame] = one.links.map(|link| link.map(|i| description.links[i].name.clone()));
            }
            places.constraints.push(one.place);
            description.constraints.push(description::Constraint { name, kind });
        }
        (description, places)
    }
}

/// The names of bodies, joints or keys, as they are assigned.
pub(crate) struct Names {
    what: &'static str,
    /// Names from the file, and generated names.
    taken: BTreeSet<String>,
    given: BTreeSet<String>,
}

impl Names {
    pub fn new(what: &'static str, taken: BTreeSet<String>) -> Self {
        Names { what, taken, given: BTreeSet::new() }
    }

    /// The given name; a generated one if it is missing or, with an error, already used.
    pub fn settle(&mut self, name: Name, place: &Place, cx: &mut Context) -> String {
        if let Some(given) = name.given {
            if self.given.insert(given.clone()) {
                return given;
            }
            let message = format!("{} `{}`: the name is used twice, expected a unique name", self.what, shown(&given));
            cx.findings.add(Finding::error("duplicate_name", place.span("name"), message).help("rename one of them"));
        }
        let name = free(&name.otherwise, &self.taken);
        self.taken.insert(name.clone());
        name
    }
}

/// An unused name.
fn free(name: &str, taken: &BTreeSet<String>) -> String {
    let mut name = name.to_string();
    while taken.contains(&name) {
        name.push('\'');
    }
    name
}
