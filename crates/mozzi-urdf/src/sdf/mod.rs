//! SDFormat 1.4 to 1.12, the files of Gazebo and Drake.
//!
//! [`load`](crate::load), [`parse`](crate::parse) and [`open`](crate::open) read them, too. The root element `<sdf>`
//! decides, not the file's name. [`write()`] makes such a text.
//!
//! # Supported elements
//! Models, also inside models and from files that are included; links and their inertias; frames; poses with
//! `relative_to`, `rotation_format` and `degrees`, `placement_frame`, `expressed_in` and the older
//! `use_parent_model_frame`; joints of the types fixed, revolute, continuous, prismatic, screw, ball, universal and
//! revolute2, with limits, damping, friction, spring, `initial_position` and `<mimic>`; a world's gravity. From Drake:
//! the planar `<drake:joint>`, rotor inertia and gear ratio, `<drake:mimic>`, `<drake:ball_constraint>`.
//!
//! - A model is free in SDFormat, unless joints fix it to the world: then the base is the link `world`. A fixed joint
//!   named `fixed_base` at the origin of the world, as [`write()`] makes it, makes the model's link itself the base.
//!   One free model without other joints to the world has a floating base ([`mozzi::Base`]).
//! - Names inside of another model begin with that model's: `arm::link_1`. Static models of a world are left out.
//! - Joints of two axes become two joints, `j.axis` and `j.axis2`; a planar joint becomes `j.x`, `j.y` and `j.theta`.
//! - `screw_thread_pitch` is the travel per turn; the older `thread_pitch` is −2π over it.
//! - Numbers that the file does not give, such as a mass, are SDFormat's, with a warning.
//! - Not read: inertias from shapes (`auto`), gearboxes; shapes, sensors. Plugins are named.
mod assemble;
mod axis;
mod base;
mod explain;
mod graph;
mod include;
mod joint;
mod link;
mod losses;
mod model;
mod names;
mod part;
mod pose;
mod version;
mod vocabulary;
mod world;
mod write;

pub(crate) use explain::CODES;
pub use explain::codes;
pub use write::write;

use crate::XacroArguments;
use crate::report::finding::Finding;
use crate::report::places::Places;
use crate::text::context::Context;
use crate::text::dialect::Dialect;
use crate::text::element::Element;
use crate::text::pages::Pages;
use crate::text::source::Source;
use crate::text::syntax;
use crate::urdf::vocabulary::shown;
use graph::{Graph, Scope};
use mozzi::Description;
use std::collections::BTreeMap;
use std::path::Path;

/// The fixed joint that fixes the base link of a robot without a link `world`.
const FIXED_BASE: &str = "fixed_base";

/// Whether the first element of this text is that of SDFormat.
pub fn is_sdf(text: &str) -> bool {
    Dialect::of(text) == Dialect::Sdf
}

/// From texts to a description. Included files are added to the sources.
pub(crate) fn read(
    sources: &mut Vec<Source>,
    folder: Option<&Path>,
    given: &XacroArguments,
    cx: &mut Context,
) -> Option<(Description, Places)> {
    let includes = include::gather(sources, (folder, given), cx)?;
    let mut pages = Vec::new();
    for source in sources.iter() {
        match syntax::parse(source, Dialect::Sdf) {
            Ok(document) => pages.push((source, document)),
            Err(finding) => {
                cx.findings.add(finding);
                return None;
            }
        }
    }
    let pages = Pages::new(pages, BTreeMap::new());
    let reader = Reader {
        pages: &pages,
        includes,
        graph: Graph::new(),
        links: Vec::new(),
        joints: Vec::new(),
        frames: Vec::new(),
        closures: Vec::new(),
        depth: 0,
        instances: 0,
    };
    let result = reader.root(&Element::root(&pages, "sdf")?, cx);
    cx.report_repeated();
    result
}

/// The elements of all models, before names are looked up.
struct Reader<'a> {
    pages: &'a Pages<'a>,
    /// The place of each `<include>`, and the page of its file.
    includes: BTreeMap<usize, usize>,
    graph: Graph<'a>,
    links: Vec<link::Link>,
    joints: Vec<joint::Joint<'a>>,
    frames: Vec<link::Frame>,
    closures: Vec<assemble::Closure<'a>>,
    /// The depth of inclusion of the file that is being read.
    depth: usize,
    /// The number of models that were included.
    instances: usize,
}

impl<'a> Reader<'a> {
    /// A plugin is named: it may act on the robot.
    fn plugins(&self, parent: &Element<'a>, cx: &mut Context) {
        for plugin in parent.elements().filter(|child| child.name() == "plugin" && !child.has_prefix()) {
            let file = plugin.attribute("filename").or_else(|| plugin.attribute("name"));
            let file = file.map_or_else(String::new, |file| format!(" `{}`", shown(file.text)));
            let message = format!("{}: plugin{file}: is a program, which may act on the robot", parent.subject);
            cx.repeat(&format!("plugin{file}"), Finding::warning("ignored_plugin", plugin.span(), message));
        }
    }
}

/// The name of something in a model.
fn full_name(scope: &Scope, name: &str) -> String {
    format!("{}{name}", scope.prefix)
}
