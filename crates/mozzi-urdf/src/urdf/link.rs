//! `<link>` and its `<inertial>`.

use crate::geometry;
use crate::report::finding::Finding;
use crate::report::places::Place;
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::inertial::MOMENTS;
use crate::urdf::origin;
use crate::urdf::vocabulary::{INERTIA, INERTIAL, LINK, MASS, shown};
use mozzi::linalg::Sym3;
use mozzi::model::description::Link;
use mozzi::{SE3, SpatialInertia, Vec3};

/// A link; massless if it has no `<inertial>`.
pub(crate) fn read(element: &Element, cx: &mut Context) -> (Link, Place) {
    let mut place = Place::new(element.span());
    let mut element = element.called("link");
    let value = element.required_name("name", cx);
    let name = place.note("name", value);
    element.subject = format!("link `{}`", shown(&name));
    let before = cx.findings.errors();
    element.check_attributes(&LINK, cx);
    let children = element.check_children(&LINK, cx);
    if cx.findings.errors() > before {
        ["mass", "inertia"].into_iter().for_each(|attribute| place.report(attribute)); // a misspelled <inertial> is not a missing one
    }
    let inertia = children.get("inertial").and_then(|inertial| read_inertial(inertial, &mut place, cx));
    if let Some(G) = inertia {
        geometry::inertia::check(&element, G, cx);
    }
    (Link { name, inertia: inertia.unwrap_or_else(SpatialInertia::zero) }, place)
}

/// The inertia in the link's frame; None, with a diagnostic, if it cannot be read.
fn read_inertial(inertial: &Element, place: &mut Place, cx: &mut Context) -> Option<SpatialInertia> {
    inertial.check_attributes(&INERTIAL, cx);
    let children = inertial.check_children(&INERTIAL, cx);
    let T = children.get("origin").map_or(Some(SE3::identity()), |origin| origin::read(origin, cx));
    let (mass, inertia) = (children.get("mass"), children.get("inertia"));
    for (name, example, found) in [
        ("mass", "<mass value=\"1\"/>", mass),
        ("inertia", "<inertia ixx=\"0\" ixy=\"0\" ixz=\"0\" iyy=\"0\" iyz=\"0\" izz=\"0\"/> is a point mass", inertia),
    ] {
        if found.is_none() {
            let message = format!("{}: has no <{name}>", inertial.subject);
            let help = format!("a body has a mass and an inertia about its centre of mass: {example}");
            cx.findings.add(Finding::error("missing_element", inertial.span(), message).help(help));
        }
    }
    let mass = mass.and_then(|mass| read_mass(mass, place, cx));
    let inertia = inertia.and_then(|inertia| read_inertia(inertia, place, cx));
    match (T, mass, inertia) {
        (Some(T), Some(mass), Some(I)) => {
            place.turned = Some(T.R);
            Some(SpatialInertia::new(mass, T.p, I.congruence(T.R.matrix())))
        }
        // a negative mass is an error whatever else is invalid: the checks report it for a point mass
        (_, Some(mass), _) if mass < 0.0 => {
            place.report("inertia");
            Some(SpatialInertia::point_mass(mass, Vec3::zero()))
        }
        _ => {
            place.report("mass");
            place.report("inertia");
            None
        }
    }
}

fn read_mass(mass: &Element, place: &mut Place, cx: &mut Context) -> Option<f64> {
    mass.check_attributes(&MASS, cx);
    mass.check_children(&MASS, cx);
    let value = mass.required("value", cx)?;
    place.set("mass", value.span.clone());
    mass.vector::<1>("value", &value, cx).map(|[kilograms]| kilograms)
}

/// The six numbers, all of them required.
fn read_inertia(inertia: &Element, place: &mut Place, cx: &mut Context) -> Option<Sym3> {
    inertia.check_attributes(&INERTIA, cx);
    inertia.check_children(&INERTIA, cx);
    let mut entry = |name| {
        let value = inertia.required(name, cx)?;
        inertia.vector::<1>(name, &value, cx).map(|[x]| x)
    };
    let [xx, xy, xz, yy, yz, zz] = MOMENTS.map(&mut entry);
    place.set("inertia", inertia.span());
    Some(Sym3 { xx: xx?, xy: xy?, xz: xz?, yy: yy?, yz: yz?, zz: zz? })
}
