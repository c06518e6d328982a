//! Which geoms touch the world's planes, and what of MuJoCo's contacts is not used.

use super::attributes::Item;
use crate::geometry::Shape;
use crate::text::context::Context;
use crate::text::element::Element;
use mozzi::SE3;

/// Attributes of geoms in contact that rigid contacts do not use, each but for a value that changes nothing.
const UNUSED: [(&str, Option<f64>); 7] = [
    ("margin", None),
    ("gap", None),
    ("solref", None),
    ("solimp", None),
    ("solmix", None),
    ("condim", Some(3.0)),
    ("priority", Some(0.0)),
];

/// The layers in which a geom touches others.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bits {
    contype: i64,
    conaffinity: i64,
}

impl Bits {
    /// Those of a geom without these attributes.
    const USUAL: Bits = Bits { contype: 1, conaffinity: 1 };

    fn touch(self, other: Bits) -> bool {
        self.contype & other.conaffinity != 0 || other.contype & self.conaffinity != 0
    }
}

/// A geom's part in contacts.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Contact {
    bits: Bits,
    /// The first of up to three coefficients; MuJoCo's is 1.
    pub friction: f64,
    unused: Vec<&'static str>,
}

impl Contact {
    pub fn of(item: &Item, cx: &mut Context) -> Self {
        let mut bit = |name| item.number(name, 1.0, cx) as i64;
        let bits = Bits { contype: bit("contype"), conaffinity: bit("conaffinity") };
        let friction = if item.has("friction") { item.overlaid::<3>("friction", cx)[0] } else { 1.0 };
        let mut is_used = |(name, idle): (&'static str, Option<f64>)| {
            let acts = item.has(name) && idle.is_none_or(|idle| item.number(name, idle, cx) != idle);
            acts.then_some(name)
        };
        let unused = UNUSED.into_iter().filter_map(&mut is_used).collect();
        Contact { bits, friction, unused }
    }

    /// Whether it can touch anything.
    pub fn is_any(&self) -> bool {
        self.bits != Bits { contype: 0, conaffinity: 0 }
    }
}

/// A plane that does not move.
pub(super) struct Plane {
    pub name: String,
    /// Its pose in {s}.
    pub T: SE3,
    pub contact: Contact,
}

/// Elements about contacts that are not read.
pub(super) fn not_read(sections: &[Element]) -> Vec<String> {
    let of = |name: &'static str| sections.iter().filter(move |section| section.name() == name);
    let mut found = Vec::new();
    for name in ["pair", "exclude"] {
        let count = of("contact").flat_map(Element::elements).filter(|element| element.name() == name).count();
        if count > 0 {
            found.push(format!("{count} <{name}>"));
        }
    }
    let mut flags = of("option").flat_map(Element::elements).filter(|element| element.name() == "flag");
    if flags.any(|flag| flag.attribute("contact").is_some_and(|value| value.text == "disable")) {
        found.push("contact=\"disable\"".to_string());
    }
    found
}

/// Decides which shapes touch: the file's planes as in MuJoCo; a plane with the usual bits if none of them touches.
/// Returns these planes, and what is not used of the contacts.
pub(super) fn decide(shapes: &mut [(Shape, Contact)], planes: Vec<Plane>) -> (Vec<(String, SE3)>, Vec<String>) {
    let is_of_robot = |plane: &Plane| shapes.iter().any(|(_, contact)| contact.bits.touch(plane.contact.bits));
    let (planes, idle): (Vec<_>, Vec<_>) = planes.into_iter().partition(is_of_robot);
    let mut unused: Vec<String> =
        idle.iter().map(|plane| format!("the plane `{}`, which touches no geom of the robot", plane.name)).collect();
    let usual = [Bits::USUAL];
    let bits: Vec<Bits> = planes.iter().map(|plane| plane.contact.bits).collect();
    let all = if bits.is_empty() { &usual[..] } else { &bits };
    for (shape, contact) in &mut *shapes {
        shape.touches = all.iter().any(|bits| contact.bits.touch(*bits));
    }
    let touching = || shapes.iter().filter(|(shape, _)| shape.touches).map(|(_, contact)| contact);
    let each = || touching().chain(planes.iter().map(|plane| &plane.contact));
    for (name, _) in UNUSED {
        let count = each().filter(|contact| contact.unused.contains(&name)).count();
        if count > 0 {
            unused.push(format!("{name} ({count} geom{})", if count == 1 { "" } else { "s" }));
        }
    }
    let least = touching().map(|contact| contact.friction).fold(f64::INFINITY, f64::min);
    if let Some(plane) = planes.iter().find(|plane| plane.contact.friction > least) {
        let (name, friction) = (&plane.name, plane.contact.friction);
        unused.push(format!("the friction {friction} of the plane `{name}` (MuJoCo takes the larger of two)"));
    }
    (planes.into_iter().map(|plane| (plane.name, plane.T)).collect(), unused)
}
