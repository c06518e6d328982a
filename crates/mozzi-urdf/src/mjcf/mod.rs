//! MuJoCo's models (MJCF): the tree of bodies with hinges, slides and balls, on the ground or free, and several trees beside each other.
//!
//! [`load`](crate::load), [`parse`](crate::parse) and [`open`](crate::open) read them too: the root element `<mujoco>`
//! tells, whatever the file is called.
//!
//! # What is read
//! Bodies, frames and sites with every way to write an orientation; free bodies of the world; hinges, slides and balls, several in a body, with `ref`,
//! `range`, `armature`, `damping`, `frictionloss`, `stiffness`, `springref` and `springdamper`; inertias, given or computed from geoms; default classes;
//! includes; the compiler's settings that matter; gravity; an equality of two joints that is affine, as a mimic joint.
//!
//! - The base is the link `world`. Links are bodies with the frames of MuJoCo, sites are named frames, positions are
//!   MuJoCo's `qpos`, with `ref`. Between two joints of one body stands a massless link `body:joint`.
//! - Where one body of the world is free, undamped, and with what it carries all that moves, it is the robot's base instead ([`mozzi::Base`]), and its
//!   positions are MuJoCo's with the quaternion first; its velocities are in the body's axes, angular first. The world, and what else stands in
//!   it, is no link then. Any other free body hangs on the world by a free joint with the same positions and velocities.
//! - A ball has MuJoCo's quaternion and angular velocity; its spring is not computed.
//! - What has no name is called by its number in MuJoCo: `body3`, `joint1`.
//! - A coupling of joints is rigid here; in MuJoCo its solver keeps it approximately.
//!
//! # What is not
//! - Refused by name: closures (`connect`, `weld`, curved couplings, tendons with forces or limits),
//!   flexible bodies, `replicate`, `attach` and `composite`, meshes where the inertia would be needed, shells.
//! - Loaded with a warning that names the force: springs and damping that are not linear, gravity compensation, fluids.
//! - Listed in warnings of the codes `ignored_element` and `ignored_attribute`, once per kind, which the strict policy lets
//!   pass: actuators, sensors, contacts, assets, keyframes, settings of MuJoCo's solver and what is for the eye only.
//!
//! Each word of MuJoCo's schema is in one of these classes: a test goes through all of them.
mod attributes;
mod body;
mod class;
mod closure;
mod compiler;
mod contents;
mod explain;
mod free;
mod geom;
mod ignored;
mod include;
mod inertial;
mod joint;
mod option;
mod orientation;
#[cfg(test)]
mod schema;
mod spring;
mod tree;
mod vocabulary;

pub(crate) use explain::CODES;
pub use explain::codes;

use crate::context::Context;
use crate::dialect::Dialect;
use crate::element::Element;
use crate::finding::Finding;
use crate::pages::Pages;
use crate::places::Places;
use crate::source::Source;
use crate::syntax;
use class::Classes;
use compiler::Compiler;
use ignored::Ignored;
use mozzi::Description;
use option::Options;
use std::path::Path;
use tree::Tree;

/// Is this text a model of MuJoCo's, as far as its first element tells?
pub fn is_mjcf(text: &str) -> bool {
    Dialect::of(text) == Dialect::Mjcf
}

/// Is this the code of a warning about what is right in MJCF, and has no place here? The strict policy lets it pass.
pub(crate) fn is_list(code: &str) -> bool {
    matches!(code, "mozzi::mjcf::ignored_attribute" | "mozzi::mjcf::ignored_element" | "mozzi::mjcf::renamed_site")
}

/// What the readers of a model share.
pub(crate) struct Model<'a> {
    pub compiler: Compiler,
    pub options: Options,
    pub classes: Classes<'a>,
    pub ignored: Ignored,
    pub tree: Tree,
}

/// From texts to a description. Included files are added to the sources.
pub(crate) fn read(
    sources: &mut Vec<Source>,
    folder: Option<&Path>,
    cx: &mut Context,
) -> Option<(Description, Places)> {
    let includes = include::gather(sources, folder, cx)?;
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
    let pages = Pages::new(pages, includes);
    read_model(&pages.root("mujoco")?, cx)
}

fn read_model(root: &Element, cx: &mut Context) -> Option<(Description, Places)> {
    if root.name() != "mujoco" {
        let message =
            format!("the root element is <{}>, expected <mujoco>", crate::vocabulary::shown(root.written_name()));
        let help = "a <mujocoinclude> is a part of a model: open the file that includes it";
        cx.findings.add(Finding::error("wrong_root", root.span(), message).help(help));
        return None;
    }
    root.check_attributes(&vocabulary::MUJOCO, cx);
    root.check_children(&vocabulary::MUJOCO, cx);
    let sections: Vec<Element> = root.elements().filter(|child| !child.has_prefix()).collect();
    let of = |name: &'static str| sections.iter().filter(move |section| section.name() == name);

    // the order of the sections means nothing
    let mut model = Model {
        compiler: Compiler::read(of("compiler"), cx),
        options: Options::default(),
        classes: Classes::read(of("default"), cx),
        ignored: Ignored::default(),
        tree: Tree::new(root),
    };
    model.options = Options::read(of("option"), &mut model.ignored, cx);
    for worldbody in of("worldbody") {
        model.world(worldbody, cx);
    }
    model.scale_to_total_mass(cx);
    model.closures(&sections, cx);
    model.leave_the_world();
    model.ignored.sections(&sections);
    model.ignored.tell(cx);
    if cx.findings.is_full() {
        return None;
    }
    let name = root.attribute("model").map_or("mujoco", |value| value.text);
    let tunings = spring::tunings(&model.tree.joints);
    let (mut description, places) = model.tree.describe(name, model.options.gravity, cx);
    spring::tune(&mut description, &tunings, cx);
    Some((description, places))
}
