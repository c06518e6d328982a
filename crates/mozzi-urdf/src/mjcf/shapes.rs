//! The shapes of geoms, which are drawn and do not affect the dynamics.

use super::Model;
use super::attributes::Item;
use super::class::{Class, Classes};
use super::contact::{self, Contact, Plane};
use super::contents::Inside;
use super::geom::TYPES;
use super::mesh::Mesh;
use super::orientation::pose;
use crate::geometry::{Form, Geometry, Purpose, Shape};
use crate::report::finding::Finding;
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::vocabulary::shown;
use mozzi::{SE3, Solid, Vec3};
use std::collections::BTreeMap;

/// MuJoCo does not draw groups from this one on; by convention they contain the shapes for contacts.
const FIRST_HIDDEN_GROUP: f64 = 3.0;

/// The assets that geoms refer to, and the shapes found so far.
#[derive(Default)]
pub(crate) struct Shapes {
    colors: BTreeMap<String, [f64; 4]>,
    /// With the index of their link, and whether they are drawn.
    found: Vec<(usize, bool, (Shape, Contact))>,
    /// Planes that do not move.
    planes: Vec<Plane>,
    /// Elements about contacts that are not read.
    not_read: Vec<String>,
    /// Findings about shapes: warnings, since shapes do not affect the dynamics.
    pub cx: Context,
}

impl Shapes {
    /// The colours of the assets.
    pub fn new<'a>(sections: &[Element<'a>], classes: &Classes<'a>) -> Self {
        let mut shapes = Shapes { not_read: contact::not_read(sections), ..Shapes::default() };
        let of = |name: &'static str| sections.iter().filter(move |section| section.name() == name);
        for asset in of("asset").flat_map(Element::elements) {
            if asset.name() == "material" {
                let Some(name) = asset.attribute("name") else { continue };
                let item = classes.item(asset, "material", Class::MAIN, &mut shapes.cx);
                let color = item.vector::<4>("rgba", &mut shapes.cx).unwrap_or([1.0; 4]);
                shapes.colors.insert(name.text.to_string(), color);
            }
        }
        shapes
    }

    /// The shapes, by the names of their links.
    pub fn named(self, links: &[mozzi::model::description::Link]) -> (Geometry, Context) {
        let (mut drawn, mut found) = (Vec::new(), Vec::new());
        for (link, is_drawn, (shape, contact)) in self.found {
            let Some(link) = links.get(link) else { continue };
            drawn.push(is_drawn);
            found.push((Shape { link: link.name.clone(), ..shape }, contact));
        }
        let (planes, mut unused) = contact::decide(&mut found, self.planes);
        unused.extend(self.not_read);
        let is_kept = |((shape, _), is_drawn): ((Shape, Contact), bool)| (is_drawn || shape.touches).then_some(shape);
        let shapes = found.into_iter().zip(drawn).filter_map(is_kept).collect();
        (Geometry { shapes, planes, unused, left_out: Vec::new() }, self.cx)
    }

    /// Keeps the shapes of some links and renumbers them.
    pub fn renumber(&mut self, stays: &[bool], numbers: &[usize]) {
        self.found.retain(|(link, ..)| stays[*link]);
        self.found.iter_mut().for_each(|(link, ..)| *link = numbers[*link]);
    }
}

impl<'a> Model<'a> {
    /// Adds the shapes of a body's geoms, if shapes are read. `still` is the pose of a body that no joint moves.
    pub fn draw(&mut self, geoms: &[Inside<'a>], link: usize, still: Option<SE3>) {
        let Some(mut shapes) = self.shapes.take() else { return };
        for geom in geoms {
            let subject = geom.item.element.attribute("name").map(|name| format!("geom `{}`", shown(name.text)));
            let element = geom.item.element.called(subject.unwrap_or_else(|| "geom".to_string()));
            let item = Item { element, ..geom.item.clone() };
            let contact = Contact::of(&item, &mut shapes.cx);
            let is_plane = item.word("type", &TYPES, &mut shapes.cx) == Some("plane");
            if let Some(body) = still.filter(|_| is_plane) {
                let name = item.element.attribute("name").map_or("ground", |name| name.text).to_string();
                let T = body * geom.T * pose(&item, &self.compiler, &mut shapes.cx);
                shapes.planes.push(Plane { name, T, contact });
            } else if let Some((shape, is_drawn)) = self.shape(&item, geom.T, &contact, &mut shapes) {
                shapes.found.push((link, is_drawn, (shape, contact)));
            }
        }
        self.shapes = Some(shapes);
    }

    /// The shape, and whether it is drawn; nothing for planes and height fields.
    fn shape(&self, item: &Item<'a>, T: SE3, contact: &Contact, shapes: &mut Shapes) -> Option<(Shape, bool)> {
        let kind = item.word("type", &TYPES, &mut shapes.cx).unwrap_or("sphere");
        let material = || item.value("material").and_then(|value| shapes.colors.get(value.text).copied());
        let color = if item.has("rgba") { item.vector::<4>("rgba", &mut shapes.cx) } else { material() };
        if matches!(kind, "plane" | "hfield") {
            return None;
        }
        let is_clear = color.is_some_and(|[.., opacity]| opacity <= 0.0);
        let is_hidden = item.number("group", 0.0, &mut shapes.cx) >= FIRST_HIDDEN_GROUP || is_clear;
        if is_clear && !contact.is_any() {
            return None; // neither drawn nor touched
        }
        let (form, frame) = match item.value("mesh") {
            Some(mesh) => {
                let found = self.meshes.named(mesh.text, &mut shapes.cx);
                let Some((file, found)) = found.and_then(|found| Some((found.file.clone()?, found))) else {
                    let message = format!("{}: mesh: `{}` has no file", item.element.subject, shown(mesh.text));
                    let help = "it is not drawn: meshes of <asset> are drawn from their files";
                    shapes.cx.findings.add(Finding::warning("ignored_mesh", mesh.span, message).help(help));
                    return None;
                };
                let (form, shift) = mesh_form(file, &found);
                (form, pose(item, &self.compiler, &mut shapes.cx) * shift)
            }
            None => {
                let (solid, frame) = self.solid(item, kind, &mut shapes.cx)?;
                (solid_form(solid), frame)
            }
        };
        let purpose = if is_hidden { Purpose::Collision } else { Purpose::Visual };
        let friction = Some(contact.friction);
        let shape = Shape { link: String::new(), purpose, T: T * frame, form, color, touches: false, friction };
        Some((shape, !is_clear))
    }
}

/// v' = S Rᵀ(v − p) of a vertex v: a scale of the file's coordinates, then a rigid motion. If S is not the same in all
/// directions, R has to be the identity, as it is in published models.
fn mesh_form(file: String, &Mesh { scale, reference, .. }: &Mesh) -> (Form, SE3) {
    let inverse = reference.R.inverse();
    let [x, y, z] = (inverse.matrix() * reference.p).0;
    let p = Vec3([-scale[0] * x, -scale[1] * y, -scale[2] * z]);
    (Form::Mesh { file, scale }, SE3 { R: inverse, p })
}

fn solid_form(solid: Solid) -> Form {
    match solid {
        Solid::Sphere { radius } => Form::Sphere { radius },
        Solid::Capsule { radius, length } => Form::Capsule { radius, length },
        Solid::Cylinder { radius, length } => Form::Cylinder { radius, length },
        Solid::Ellipsoid(radii) => Form::Ellipsoid { radii },
        Solid::Box(size) => Form::Box { size },
    }
}
