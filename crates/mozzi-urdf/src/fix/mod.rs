//! Repairs of a URDF's numbers, as proposals: none is made unless it is applied. Each has its reason and its effect on
//! M.
//!
//! An inertia is doubted only if no body can have it, or if it is far from what the link's shape would have. A proposed
//! inertia must be possible and must fit the shape. See [`proposals`].

mod candidates;
mod duplicate;
mod effect;
mod estimate;
mod fit;
mod inertial;
mod joints;
mod repairs;
mod twin;

pub use estimate::estimates;
pub use repairs::Repairs;

use crate::edit::element::{Editor, Replacement, Tag, replaced};
use crate::geometry::MeshFolders;
use crate::text::expansion;
use crate::urdf::write::NotUrdf;
use crate::{EditError, Policy, Settings, parse_with};
use fit::{Detail, Solid, Solids};
use inertial::Inertial;
use mozzi::SpatialInertia;
use roxmltree::Document;
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

/// A change of a robot's text that would repair it.
#[derive(Clone, Debug)]
pub struct Proposal {
    /// The kind of error, such as `power_of_ten`.
    pub code: &'static str,
    /// The element: "link `wrist`".
    pub subject: String,
    /// The element's line in the text, from 1.
    pub line: usize,
    /// The change: "ixx 0.12 → 0.012".
    pub change: String,
    /// Why.
    pub reason: String,
    /// The effect on the mass matrix.
    pub effect: String,
    /// The link whose inertia changes, before and after.
    pub inertia: Option<(String, SpatialInertia, SpatialInertia)>,
    replacements: Vec<Replacement>,
}

impl fmt::Display for Proposal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Proposal { subject, change, reason, effect, code, .. } = self;
        write!(f, "{subject}: {change} [{code}]\n  because {reason}\n  {effect}")
    }
}

/// The input of the repairs: the robot's XML, the description as far as it can be read, and the solids of its links.
struct Robot<'a> {
    root: Tag<'a>,
    document: &'a Document<'a>,
    description: mozzi::Description,
    solids: Solids,
    inertials: BTreeMap<String, Inertial<'a>>,
}

impl Robot<'_> {
    fn line(&self, tag: Tag<'_>) -> usize {
        self.document.text_pos_at(tag.node.range().start).row as usize
    }

    fn solid(&self, link: &str) -> Option<&Solid> {
        self.solids.all.get(link)
    }

    /// A proposal that makes these changes of the text.
    fn proposal(&self, code: &'static str, tag: Tag<'_>, editor: &Editor<'_>) -> Proposal {
        let name = tag.attribute("name").unwrap_or_default();
        Proposal {
            code,
            subject: format!("{} `{}`", tag.name(), crate::urdf::vocabulary::shown(name)),
            line: self.line(tag),
            change: String::new(),
            reason: String::new(),
            effect: String::new(),
            inertia: None,
            replacements: editor.replacements(),
        }
    }
}

/// The proposals for a URDF, in the order of the text: an inertia with a power of ten too much, of a wrong sign, with
/// its numbers in wrong places, about the file's origin, in mm or g, or else the nearest possible one; a mass counted
/// twice below a fixed joint; reversed limits; a limit of effort of 0. Shapes are searched for next to the file, and
/// below `mesh_root`.
///
/// # Errors
/// [`EditError::Load`] if the text cannot be read; [`EditError::Unsupported`] if it is not URDF.
pub fn proposals(
    file_name: &str,
    text: &str,
    mesh_root: Option<&Path>,
    settings: &Settings,
) -> Result<Repairs, EditError> {
    let mut repairs = with_robot(file_name, text, mesh_root, settings, Detail::Rough, |robot| {
        let twice = duplicate::proposals(robot);
        let is_twice = |name: &str| twice.iter().any(|one| one.inertia.as_ref().is_some_and(|(link, ..)| link == name));
        let mut all: Vec<Proposal> = Vec::new();
        for (name, inertial) in &robot.inertials {
            if !is_twice(name) {
                all.extend(candidates::proposal(robot, name, inertial));
            }
        }
        all.extend(twice);
        all.extend(joints::proposals(robot));
        all
    })?;
    repairs.count_left(file_name, text, settings);
    Ok(repairs)
}

/// The misfit of the inertia of each link with a mass to its shape, uniformly filled, in powers of ten; links whose
/// shapes cannot be read are left out. A possible inertia below 1 is left alone.
pub fn misfits(file_name: &str, text: &str) -> BTreeMap<String, f64> {
    let mut found = BTreeMap::new();
    let body = text.strip_prefix('\u{feff}').unwrap_or(text);
    let Ok(document) = Document::parse(body) else { return found };
    let solids = fit::solids(Path::new(file_name), text, Detail::Rough, MeshFolders::default()).all;
    for link in Tag::new(document.root_element(), body).children().filter(|tag| tag.name() == "link") {
        let (Some(name), Some(inertial)) = (link.attribute("name"), Inertial::read(link)) else { continue };
        if let Some(solid) =
            solids.get(name).filter(|solid| inertial.numbers.mass > 0.0 && solid.can_have(inertial.numbers.mass))
        {
            found.insert(name.to_string(), solid.misfit(inertial.inertia(&inertial.numbers)));
        }
    }
    found
}

/// The text with these proposals applied.
pub fn apply(text: &str, proposals: &[Proposal]) -> String {
    let body = text.strip_prefix('\u{feff}').unwrap_or(text);
    let all = proposals.iter().flat_map(|proposal| proposal.replacements.iter().cloned()).collect();
    format!("{}{}", &text[..text.len() - body.len()], replaced(body, all))
}

/// Reads a URDF for the repairs, and completes their proposals with what becomes of M.
fn with_robot(
    file_name: &str,
    text: &str,
    mesh_root: Option<&Path>,
    settings: &Settings,
    detail: Detail,
    make: impl FnOnce(&Robot<'_>) -> Vec<Proposal>,
) -> Result<Repairs, EditError> {
    let unsupported = |why: &str| EditError::Unsupported(NotUrdf { reasons: vec![why.to_string()] });
    if expansion::of(file_name, text, settings).map_err(EditError::Load)?.is_some() {
        return Err(unsupported("only URDF is repaired: expand it first, by `mozzi xacro`"));
    }
    for (format, is_other) in [("MJCF", crate::mjcf::is_mjcf(text)), ("SDFormat", crate::sdf::is_sdf(text))] {
        if is_other {
            let why = format!("only URDF is repaired, and this is {format}");
            return Err(unsupported(&why));
        }
    }
    // an impossible inertia is what is repaired, and no reason to refuse
    let lenient = Settings { policy: Policy::Lenient, ..settings.clone() };
    let description = match parse_with(file_name, text, lenient) {
        Ok(loaded) => loaded.description,
        Err(error) => return Err(EditError::Load(error)),
    };
    let body = text.strip_prefix('\u{feff}').unwrap_or(text);
    let document = Document::parse(body).map_err(|why| unsupported(&format!("its XML is not valid: {why}")))?;
    let root = Tag::new(document.root_element(), body);
    let links = root.children().filter(|tag| tag.name() == "link");
    let mut inertials = BTreeMap::new();
    for link in links {
        if let (Some(name), Some(inertial)) = (link.attribute("name"), Inertial::read(link)) {
            inertials.insert(name.to_string(), inertial);
        }
    }
    let folders = MeshFolders { root: mesh_root, packages: &settings.xacro.packages };
    let solids = fit::solids(Path::new(file_name), text, detail, folders);
    let robot = Robot { root, document: &document, description, solids, inertials };
    let mut all = make(&robot);
    all.sort_by_key(|proposal| proposal.line);
    effect::tell(file_name, &apply(text, &all), settings, &mut all);
    Ok(Repairs { proposals: all, unread: robot.solids.unread, left: [0; 2] })
}
