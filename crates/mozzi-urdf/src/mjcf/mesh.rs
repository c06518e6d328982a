//! Meshes of `<asset>`: their files, how their coordinates become those of a geom, and their moments.

use super::Files;
use super::attributes::Item;
use super::class::{Class, Classes};
use super::orientation::quaternion;
use super::principal::settled;
use crate::files;
use crate::geometry::moments::{Filling, Moments, moments};
use crate::geometry::surface::Surface;
use crate::text::context::Context;
use crate::text::element::Element;
use mozzi::{SE3, SO3, Vec3};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// A larger file is refused.
const MOST_BYTES: u64 = 64 << 20;
const FILLINGS: [&str; 4] = ["convex", "exact", "legacy", "shell"];

/// A mesh of `<asset>`.
pub(crate) struct Mesh {
    /// Relative to the model's file; None if the vertices are written in the model.
    pub file: Option<String>,
    pub scale: [f64; 3],
    /// The frame in the file's coordinates that becomes the geom's frame.
    pub reference: SE3,
}

/// The vertices in the geom's frame, and the moments of what they bound.
pub(crate) struct Body {
    pub vertices: Vec<Vec3>,
    pub moments: Moments,
}

type Known = BTreeMap<String, Rc<Result<Body, String>>>;

/// All meshes by name, and those whose moments were needed.
pub(crate) struct Meshes<'a> {
    assets: BTreeMap<String, Item<'a>>,
    /// Half sizes of the boxes whose mass height fields have in MuJoCo, whatever their elevations.
    height_fields: BTreeMap<String, [f64; 3]>,
    /// The folder of meshes, relative to the model's file, and whether their own folders are dropped.
    folder: String,
    strips: bool,
    files: Files<'a>,
    known: RefCell<Known>,
}

impl<'a> Meshes<'a> {
    pub fn new(
        sections: &[Element<'a>],
        classes: &Classes<'a>,
        strips: bool,
        files: Files<'a>,
        cx: &mut Context,
    ) -> Self {
        let of = |name: &'static str| sections.iter().filter(move |section| section.name() == name);
        let mut folder = String::new();
        for compiler in of("compiler") {
            let text = |name| compiler.attribute(name).map(|value| value.text);
            folder = text("meshdir").or(text("assetdir")).map_or(folder, str::to_string);
        }
        let (mut assets, mut height_fields) = (BTreeMap::new(), BTreeMap::new());
        for asset in of("asset").flat_map(Element::elements).filter(|asset| ["mesh", "hfield"].contains(&asset.name()))
        {
            // without a name it is named after its file
            let stem = |file: &str| Path::new(file).file_stem().map(|stem| stem.to_string_lossy().into_owned());
            let file = || asset.attribute("file").and_then(|file| stem(file.text));
            let Some(name) = asset.attribute("name").map(|name| name.text.to_string()).or_else(file) else { continue };
            let called = asset.called(format!("asset: {} `{}`", asset.name(), crate::urdf::vocabulary::shown(&name)));
            if asset.name() == "mesh" {
                assets.insert(name, classes.item(called, "mesh", Class::MAIN, cx));
            } else if let Some([x, y, top, base]) = Item::plain(&called).vector::<4>("size", cx) {
                height_fields.insert(name, [x, y, top / 4.0 + base / 2.0]);
            }
        }
        Meshes { assets, height_fields, folder, strips, files, known: RefCell::default() }
    }

    /// Half sizes of the box that has the mass of a height field.
    pub fn height_field(&self, name: &str) -> Option<[f64; 3]> {
        self.height_fields.get(name).copied()
    }

    /// The mesh of this name.
    pub fn named(&self, name: &str, cx: &mut Context) -> Option<Mesh> {
        let item = self.assets.get(name)?;
        let p = Vec3(item.vector::<3>("refpos", cx).unwrap_or_default());
        let R = item.vector::<4>("refquat", cx).and_then(quaternion).unwrap_or(SO3::identity());
        let file = item.element.attribute("file").map(|value| {
            let path = Path::new(value.text);
            if item.element.is_attached() {
                return value.text.to_string(); // with its model's folder
            }
            let path = if self.strips { path.file_name().map_or(path, Path::new) } else { path };
            Path::new(&self.folder).join(path).to_string_lossy().into_owned()
        });
        let scale = item.vector::<3>("scale", cx).unwrap_or([1.0; 3]);
        Some(Mesh { file, scale, reference: SE3 { R, p } })
    }

    /// Its vertices and moments, or the reason why they are unknown.
    pub fn body(&self, name: &str, cx: &mut Context) -> Rc<Result<Body, String>> {
        if let Some(known) = self.known.borrow().get(name) {
            return Rc::clone(known);
        }
        let found = Rc::new(self.read(name, cx));
        self.known.borrow_mut().insert(name.to_string(), Rc::clone(&found));
        found
    }

    /// v' = S Rᵀ(v − p) of each vertex v, which is a number of 32 bits, as in MuJoCo.
    fn read(&self, name: &str, cx: &mut Context) -> Result<Body, String> {
        let (Some(item), Some(mesh)) = (self.assets.get(name), self.named(name, cx)) else {
            return Err("there is no such mesh in <asset>".into());
        };
        let filling = match item.word("inertia", &FILLINGS, cx) {
            Some("convex") => Filling::Convex,
            Some("exact") => Filling::Exact,
            Some("shell") => Filling::Shell,
            _ => Filling::Legacy,
        };
        let is_hull = filling == Filling::Convex || !item.has("file") && !item.has("face");
        for (name, matters) in
            [("builtin", true), ("maxhullvert", is_hull && item.number("maxhullvert", -1.0, cx) > 0.0)]
        {
            if matters && item.has(name) {
                return Err(format!("{name}: changes its vertices in a way that mozzi does not follow"));
            }
        }
        if item.element.elements().any(|child| child.name() == "plugin") {
            return Err("a plugin makes its vertices".into());
        }
        let surface = match &mesh.file {
            Some(file) => self.surface(file)?,
            None => Surface::default(),
        };
        let numbers = |name: &str| item.value(name).map(|value| value.text.split_ascii_whitespace());
        let mut vertices = surface.vertices;
        if let Some(words) = numbers("vertex") {
            let found: Option<Vec<f64>> = words.map(|word| word.parse().ok().filter(|x: &f64| x.is_finite())).collect();
            let found = found.filter(|found| found.len() % 3 == 0).ok_or("vertex: expected three numbers for each")?;
            vertices = found.chunks_exact(3).map(|v| Vec3([v[0], v[1], v[2]])).collect();
        }
        let mut triangles = surface.triangles;
        triangles.truncate(surface.first_group); // MuJoCo reads no other group of an OBJ
        if let Some(words) = numbers("face") {
            let count = vertices.len();
            let found: Option<Vec<usize>> = words.map(|word| word.parse().ok().filter(|&i| i < count)).collect();
            let found = found.filter(|found| found.len() % 3 == 0).ok_or("face: expected three vertices for each")?;
            triangles = found.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
        }
        if vertices.len() < 4 {
            let found = if vertices.len() == 1 { "1 vertex" } else { &format!("{} vertices", vertices.len()) };
            return Err(format!("it has {found}, expected at least 4"));
        }
        for vertex in &mut vertices {
            let v = Vec3(vertex.0.map(|x| f64::from(x as f32))) - mesh.reference.p;
            let v = mesh.reference.R.inverse().matrix() * v;
            *vertex = Vec3([0, 1, 2].map(|k| mesh.scale[k] * v.0[k]));
        }
        if mesh.scale.iter().product::<f64>() < 0.0 {
            triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        if triangles.is_empty() {
            let why = "its vertices are in one plane, so it has no convex hull";
            triangles = crate::geometry::hull::convex_hull(&vertices).ok_or(why)?;
        }
        let moments = moments(&vertices, &triangles, filling)?;
        let moments = Moments { I: settled(moments.I), ..moments };
        Ok(Body { vertices, moments })
    }

    /// The surface in a file, which is relative to the model's.
    fn surface(&self, file: &str) -> Result<Surface, String> {
        let shown = crate::urdf::vocabulary::shown(file);
        let (folder, given) = self.files;
        let Some(folder) = folder else {
            return Err(format!("`{shown}` is relative to the model, which was not read from a file"));
        };
        let path: PathBuf = folder.join(file);
        let content = match given.text_of(&path) {
            Some(text) => text.as_bytes().to_vec(),
            None => files::read(&path, MOST_BYTES).map_err(|why| format!("`{shown}` cannot be read: {why}"))?,
        };
        let format = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_ascii_lowercase();
        Surface::read(&format, &content).map_err(|why| format!("`{shown}`: {why}"))
    }
}
