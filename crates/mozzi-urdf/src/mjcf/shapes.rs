//! The shapes of geoms, which are drawn and do not affect the dynamics.

use super::Model;
use super::attributes::Item;
use super::class::{Class, Classes};
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

/// Attributes of MuJoCo's soft contacts, which rigid contacts do not have.
const SOFT: [&str; 5] = ["margin", "gap", "solref", "solimp", "solmix"];

/// The assets that geoms refer to, and the shapes found so far.
#[derive(Default)]
pub(crate) struct Shapes {
    colors: BTreeMap<String, [f64; 4]>,
    /// With the index of their link.
    found: Vec<(usize, Shape)>,
    /// Planes of the world that geoms with the usual bits touch.
    planes: Vec<(String, SE3)>,
    /// Attributes of soft contacts, with the number of geoms that touch and have them.
    soft: BTreeMap<&'static str, usize>,
    /// Findings about shapes: warnings, since shapes do not affect the dynamics.
    pub cx: Context,
}

impl Shapes {
    /// The colours of the assets.
    pub fn new<'a>(sections: &[Element<'a>], classes: &Classes<'a>) -> Self {
        let mut shapes = Shapes::default();
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
        let name = |(link, shape): (usize, Shape)| Some(Shape { link: links.get(link)?.name.clone(), ..shape });
        let shapes = self.found.into_iter().filter_map(name).collect();
        let soft = self.soft.into_iter().collect();
        (Geometry { shapes, planes: self.planes, soft, left_out: Vec::new() }, self.cx)
    }

    /// Keeps the shapes of some links and renumbers them.
    pub fn renumber(&mut self, stays: &[bool], numbers: &[usize]) {
        self.found.retain(|(link, _)| stays[*link]);
        self.found.iter_mut().for_each(|(link, _)| *link = numbers[*link]);
    }
}

impl<'a> Model<'a> {
    /// Adds the shapes of a body's geoms, if shapes are read.
    pub fn draw(&mut self, geoms: &[Inside<'a>], link: usize) {
        let Some(mut shapes) = self.shapes.take() else { return };
        for geom in geoms {
            let subject = geom.item.element.attribute("name").map(|name| format!("geom `{}`", shown(name.text)));
            let element = geom.item.element.called(subject.unwrap_or_else(|| "geom".to_string()));
            let item = Item { element, ..geom.item.clone() };
            if link == 0 && item.word("type", &TYPES, &mut shapes.cx) == Some("plane") && touches(&item, &mut shapes.cx)
            {
                let name = item.element.attribute("name").map_or("ground", |name| name.text).to_string();
                let T = geom.T * pose(&item, &self.compiler, &mut shapes.cx);
                shapes.planes.push((name, T));
            }
            if let Some(shape) = self.shape(&item, geom.T, &mut shapes) {
                shapes.found.push((link, shape));
            }
        }
        self.shapes = Some(shapes);
    }

    /// Nothing for planes and height fields.
    fn shape(&self, item: &Item<'a>, T: SE3, shapes: &mut Shapes) -> Option<Shape> {
        let kind = item.word("type", &TYPES, &mut shapes.cx).unwrap_or("sphere");
        let material = || item.value("material").and_then(|value| shapes.colors.get(value.text).copied());
        let color = if item.has("rgba") { item.vector::<4>("rgba", &mut shapes.cx) } else { material() };
        if matches!(kind, "plane" | "hfield") {
            return None;
        }
        let is_clear = color.is_some_and(|[.., opacity]| opacity <= 0.0);
        let is_hidden = item.number("group", 0.0, &mut shapes.cx) >= FIRST_HIDDEN_GROUP || is_clear;
        let touches = touches(item, &mut shapes.cx);
        if is_clear && !touches {
            return None; // neither drawn nor touched
        }
        for attribute in SOFT.into_iter().filter(|attribute| touches && item.has(attribute)) {
            *shapes.soft.entry(attribute).or_default() += 1;
        }
        let has_own = item.has("friction"); // the first of up to three; MuJoCo's is 1
        let friction = Some(if has_own { item.overlaid::<3>("friction", &mut shapes.cx)[0] } else { 1.0 });
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
        Some(Shape { link: String::new(), purpose, T: T * frame, form, color, touches, friction })
    }
}

/// Whether the geom collides in MuJoCo with a plane whose contype and conaffinity are 1, the defaults.
fn touches(item: &Item, cx: &mut Context) -> bool {
    let has_bit = |name, cx: &mut Context| (item.number(name, 1.0, cx) as i64) & 1 == 1;
    has_bit("contype", cx) | has_bit("conaffinity", cx)
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
