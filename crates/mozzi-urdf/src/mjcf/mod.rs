//! MuJoCo's models (MJCF): trees of bodies with hinges, slides and balls, with fixed or floating bases, and several
//! free bodies.
//!
//! [`load`](crate::load), [`parse`](crate::parse) and [`open`](crate::open) read them, too. The root element `<mujoco>`
//! decides, not the file's name.
//!
//! # Supported elements
//! Bodies, frames, `replicate`, `attach` and sites with every way to write an orientation; free bodies of the world;
//! hinges, slides and balls, several in a body, with `ref`, `range`, `armature`, `damping`, `frictionloss`,
//! `stiffness`, `springref` and `springdamper`; inertias, given or computed from geoms, also from meshes; default
//! classes; includes; compiler settings that affect the tree; gravity; keyframes; a linear equality of two joints, as a
//! mimic joint; other equalities of joints and of fixed tendons, `connect` and `weld`, as constraints; the armature of
//! actuators, and of fixed tendons, as rotors that several joints turn.
//!
//! - The base is the link `world`. Links are bodies with the frames of MuJoCo, sites are named frames, positions are
//!   MuJoCo's `qpos`, with `ref`. Between two joints of one body there is a massless link `body:joint`.
//! - If one free body of the world carries all moving bodies, without damping and armature, it is the robot's floating
//!   base ([`mozzi::Base`]). Its positions are MuJoCo's with the quaternion first; its velocities are in the body's
//!   axes, angular first. The world, and other bodies in it, are then not links. Any other free body is attached to the
//!   world by a free joint with the same positions and velocities.
//! - A ball has MuJoCo's quaternion, angular velocity and spring.
//! - The inertia of a mesh (STL, OBJ, MSH, or vertices in the model) is, according to its attribute `inertia`, that of
//!   its convex hull, of the solid that its triangles bound, of MuJoCo's older pyramids, or of the shell; solids are
//!   fitted to meshes, and `shellinertia` is computed, as in MuJoCo. Mesh files are relative to the model's.
//! - Unnamed elements are named by their number in MuJoCo: `body3`, `joint1`.
//! - Equalities are rigid here; MuJoCo's solver keeps them approximately: `solref`, `solimp` and `torquescale` are not
//!   used, but a weld whose `torquescale` is 0 is a point. Anchor {a} is in body 1 and {b} in body 2, at the point that
//!   coincides with it in the file's own configuration, or as given by `relpose` or the sites. An unnamed equality is
//!   named by its number: `connect0`.
//! - A key of `<keyframe>` is a named state ([`mozzi::Model::state`]): its time, `qpos` and `qvel`. An unnamed key is
//!   named by its number, `key0`. If the file's own configuration is not θ = 0, because a free body is elsewhere or a
//!   joint has a `ref`, it is the state `qpos0`, and the robot starts there ([`mozzi::Model::start`]), as in MuJoCo.
//!   Numbers of mimic joints are checked against their source joints', and not kept.
//!
//! # Unsupported elements
//! - Refused by name: equalities of spatial tendons and flexible bodies, tendons with forces, spatial tendons with an
//!   armature, flexible bodies, `composite`, meshes whose inertia is needed and unknown.
//! - Loaded with a warning that names the force: nonlinear springs and damping, gravity compensation, fluids.
//!   Simulations may add the forces of actuators and gravity compensation: [`Actuated`].
//! - Loaded with a warning, without loss for the dynamics: limits of tendons, reversed limits, an `<inertial>` without
//!   moments, which is a point mass.
//! - Counted ([`Loaded::unused`](crate::Loaded)), once per kind, with the codes `ignored_element` and
//!   `ignored_attribute`: actuators, sensors, contacts, assets, a key's numbers for actuators and mocap bodies,
//!   settings of MuJoCo's solver, appearance.
//!
//! Every element and attribute of MuJoCo's schema is in one of these classes; a test checks all of them.
mod actuated;
mod actuator;
mod attach;
mod attributes;
mod body;
mod class;
mod closure;
mod compiler;
mod contact;
mod contents;
mod coordinates;
mod depth;
mod equality;
pub(crate) mod explain;
mod free;
mod geom;
mod ignored;
mod include;
mod inertial;
mod joint;
mod keyframe;
mod law;
mod mesh;
mod option;
mod orientation;
mod part;
mod principal;
mod rotor;
#[cfg(test)]
mod schema;
mod shapes;
mod shell;
mod spring;
mod total_mass;
mod tree;
mod vocabulary;
mod write;

pub use actuated::Actuated;
pub use actuator::{Actuation, Actuator, actuation, actuation_of};
pub use explain::codes;
pub(crate) use orientation::quaternion;
pub use write::write;

use crate::XacroArguments;
use crate::geometry::Geometry;
use crate::report::finding::{Finding, Findings};
use crate::report::places::Places;
use crate::text::context::Context;
use crate::text::dialect::Dialect;
use crate::text::element::Element;
use crate::text::pages::Pages;
use crate::text::source::Source;
use crate::text::{bytes, syntax};
use class::Classes;
use compiler::{Compiler, Compilers};
use ignored::Ignored;
use keyframe::Key;
use mesh::Meshes;
use mozzi::Description;
use option::Options;
use shapes::Shapes;
use std::collections::BTreeMap;
use std::path::Path;
use tree::Tree;

/// Whether the first element of this text is that of an MJCF model.
pub fn is_mjcf(text: &str) -> bool {
    Dialect::of(text) == Dialect::Mjcf
}

/// State shared by the readers of a model.
pub(crate) struct Model<'a> {
    pub compiler: Compilers,
    pub options: Options,
    pub classes: Classes<'a>,
    pub meshes: Meshes<'a>,
    pub ignored: Ignored,
    pub tree: Tree,
    /// `None` if shapes are not read.
    pub shapes: Option<Shapes>,
    /// `None` if it is not read.
    pub actuation: Option<Actuation>,
    /// The compensated part of each link's weight, when the tree is complete.
    pub compensations: Vec<f64>,
}

/// The result that a caller needs from a model.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Wanted {
    Dynamics,
    Shapes,
    Actuation,
}

/// From texts to a description. Included files are added to the sources.
pub(crate) fn read(
    sources: &mut Vec<Source>,
    folder: Option<&Path>,
    given: &XacroArguments,
    cx: &mut Context,
) -> Option<(Description, Places)> {
    let read = read_pages(sources, (folder, given), Wanted::Dynamics, cx)?;
    Some((read.description, read.places))
}

/// From texts to shapes, with the findings about them alone; none if the model is refused.
pub(crate) fn shapes(sources: &mut Vec<Source>, folder: Option<&Path>, given: &XacroArguments) -> (Geometry, Context) {
    let mut cx = Context::new(Findings::default(), Dialect::Mjcf);
    match read_pages(sources, (folder, given), Wanted::Shapes, &mut cx) {
        Some(Read { description, shapes: Some(shapes), .. }) => shapes.named(&description.links),
        _ => <_>::default(),
    }
}

/// The files that an MJCF file includes, by their paths from its folder, with their texts; none of another file, or if
/// one cannot be read.
pub fn included(file: &Path) -> Vec<(String, String)> {
    let (Some(folder), Ok(content)) = (file.parent(), crate::file_bytes(file)) else { return Vec::new() };
    let text = bytes::read(&content, &mut Findings::default());
    if !is_mjcf(text) {
        return Vec::new();
    }
    let mut sources =
        vec![syntax::mended(Source::new(&file.to_string_lossy(), text), Dialect::Mjcf, &mut Findings::default())];
    let mut cx = Context::new(Findings::default(), Dialect::Mjcf);
    let files = (Some(folder), &XacroArguments::default());
    if include::gather(&mut sources, files, &mut cx).is_none() || attach::expand(&mut sources, files, &mut cx).is_none()
    {
        return Vec::new();
    }
    let relative = |source: &Source| {
        let path = Path::new(&*source.name).strip_prefix(folder).ok()?;
        Some((path.to_string_lossy().replace('\\', "/"), source.text.to_string()))
    };
    sources.iter().skip(1).filter(|source| !source.is_attached).filter_map(relative).collect()
}

/// Where included files are searched, and texts that are read instead of files.
type Files<'f> = (Option<&'f Path>, &'f XacroArguments);

struct Read {
    description: Description,
    places: Places,
    shapes: Option<Shapes>,
    actuation: Option<Actuation>,
}

fn read_pages(sources: &mut Vec<Source>, files: Files, wanted: Wanted, cx: &mut Context) -> Option<Read> {
    let mut includes = include::gather(sources, files, cx)?;
    let attached = attach::expand(sources, files, cx)?;
    let mut pages = Vec::new();
    for source in sources.iter() {
        match syntax::parse(source, Dialect::Mjcf) {
            Ok(document) => pages.push((source, document)),
            Err(finding) => {
                cx.findings.add(finding);
                return None;
            }
        }
    }
    includes.extend(attached.places);
    let pages = Pages::new(pages, includes).followed_by(attached.sections);
    let (mut compilers, mut keys) = (BTreeMap::new(), BTreeMap::new());
    for (part, whole) in attached.wholes {
        let root = Element::root_of(&pages, whole, "mujoco")?;
        let sections: Vec<Element> = root.elements().filter(|child| child.name() == "compiler").collect();
        compilers.insert(part, Compiler::read(sections.iter(), cx));
        keys.extend(root.elements().find(|child| child.name() == "keyframe").map(|keys| (whole, keys)));
    }
    read_model(&Element::root(&pages, "mujoco")?, (compilers, keys.into_values().collect()), files, wanted, cx)
}

fn read_model<'a>(
    root: &Element<'a>,
    (attached, left): (BTreeMap<usize, Compiler>, Vec<Element<'a>>),
    files: Files<'a>,
    wanted: Wanted,
    cx: &mut Context,
) -> Option<Read> {
    if root.name() != "mujoco" {
        let message =
            format!("the root element is <{}>, expected <mujoco>", crate::urdf::vocabulary::shown(root.written_name()));
        let help = "<mujocoinclude> is a part of a model: open the file that includes it";
        cx.findings.add(Finding::error("wrong_root", root.span(), message).help(help));
        return None;
    }
    root.check_attributes(&vocabulary::MUJOCO, cx);
    root.check_children(&vocabulary::MUJOCO, cx);
    let sections: Vec<Element<'a>> = root.elements().filter(|child| !child.has_prefix()).collect();
    let of = |name: &'static str| sections.iter().filter(move |section| section.name() == name);

    // the order of the sections does not matter
    let (compiler, classes) = (Compiler::read(of("compiler"), cx), Classes::read(of("default"), cx));
    let mut model = Model {
        meshes: Meshes::new(&sections, &classes, compiler.strips, files, cx),
        compiler: Compilers { main: compiler, attached },
        options: Options::default(),
        classes,
        ignored: Ignored::default(),
        tree: Tree::new(root),
        shapes: None,
        actuation: (wanted == Wanted::Actuation).then(Actuation::default),
        compensations: Vec::new(),
    };
    model.shapes = (wanted == Wanted::Shapes).then(|| Shapes::new(&sections, &model.classes));
    model.options = Options::read(of("option"), &mut model.ignored, cx);
    for worldbody in of("worldbody") {
        model.world(worldbody, cx);
    }
    model.scale_to_total_mass(root, cx);
    model.closures(&sections, cx);
    model.leave_the_world();
    let keys = Key::read(of("keyframe"), cx);
    model.ignored.sections(&sections);
    for section in left {
        model.ignored.list("keyframe", section.span(), "mujoco", "keys of an attached model are not read");
    }
    model.ignored.tell(cx);
    cx.report_repeated();
    if cx.findings.is_full() {
        return None;
    }
    let name = root.attribute("model").map_or("mujoco", |value| value.text);
    let tunings = spring::tunings(&model.tree.joints);
    let slots = model.tree.slots();
    model.compensations = model.tree.links.iter().map(|link| link.compensation).collect();
    let tree = std::mem::replace(&mut model.tree, Tree::new(root));
    let (mut description, mut places) = tree.describe(name, model.options.gravity, cx);
    spring::tune(&mut description, &tunings, cx);
    if let Some(actuation) = &mut model.actuation {
        spring::damp(&mut actuation.actuators, &description, &tunings);
    }
    let keys = keyframe::add(keys, &slots, &mut description, &mut places, cx);
    let actuation = model.settled(&description.links, &keys);
    Some(Read { description, places, shapes: model.shapes, actuation })
}
