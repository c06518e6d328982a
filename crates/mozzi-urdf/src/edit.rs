//! Edits a URDF's text in place for changed inertias, friction, armature and springs, locked joints or a floating base,
//! so that visuals, comments and unknown elements remain.

mod element;
mod joint;
mod link;
mod transmission;

use crate::write::{NotUrdf, escaped, free};
use crate::{LoadError, Policy, parse_with};
use element::{Editor, Tag};
use mozzi::model::description::{Joint, JointKind, Link};
use mozzi::{Base, Description};
use roxmltree::Document;
use std::fmt;

pub use transmission::drives_of_fixed_joints;

/// Why a text was not edited.
#[derive(Debug)]
pub enum EditError {
    /// The text cannot be read.
    Load(LoadError),
    /// The edited robot differs from the text in more than inertias, friction, armature, springs, locked joints and a
    /// floating base.
    Unsupported(NotUrdf),
}

impl fmt::Display for EditError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            EditError::Load(error) => error.fmt(f),
            EditError::Unsupported(why) => write!(f, "the text cannot be edited in place: {}", why.reasons.join("; ")),
        }
    }
}

impl std::error::Error for EditError {}

/// The text of a URDF, edited so that it describes another robot: one that differs in inertias, in friction, armature
/// and springs of joints, in joints that became fixed, and in a base that became floating. Only the attributes and
/// elements that differ are rewritten; without differences the text is returned unchanged.
///
/// # Errors
/// [`EditError`]: the text cannot be read, or the robots differ in other things.
pub fn edit(file_name: &str, text: &str, edited: &Description) -> Result<String, EditError> {
    edited_text(file_name, text, edited, false)
}

/// As [`edit`], with a comment in each edited element that holds the old numbers.
///
/// # Errors
/// As [`edit`].
pub fn edit_with_old_values(file_name: &str, text: &str, edited: &Description) -> Result<String, EditError> {
    edited_text(file_name, text, edited, true)
}

fn edited_text(file_name: &str, text: &str, edited: &Description, keeps_old: bool) -> Result<String, EditError> {
    // if the text is valid only after repairs, the repaired robot is compared, and all inertias are those of `edited`
    let (original, is_repaired) = match parse_with(file_name, text, Policy::Default) {
        Ok(loaded) => (loaded.description, false),
        Err(_) => (parse_with(file_name, text, Policy::Lenient).map_err(EditError::Load)?.description, true),
    };
    let reasons = unsupported(&original, edited);
    if !reasons.is_empty() {
        return Err(EditError::Unsupported(NotUrdf { reasons }));
    }
    let body = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut reasons = Vec::new();
    let mut editor = Editor::new(body);
    let document = Document::parse(body)
        .map_err(|error| EditError::Unsupported(NotUrdf { reasons: vec![format!("its XML is not valid: {error}")] }))?;
    let root = Tag::new(document.root_element(), body);
    let differ = |(old, new): &(&Link, &Link)| is_repaired || old.inertia != new.inertia;
    for (old, new) in original.links.iter().zip(&edited.links).filter(differ) {
        match root.named("link", &old.name) {
            Some(tag) => {
                link::set_inertia(tag, new.inertia, &mut editor);
                if keeps_old {
                    link::comment(tag, old.inertia, &mut editor);
                }
            }
            None => reasons.push(format!("link `{}` has no element of its own", old.name)),
        }
    }
    for (old, new) in original.joints.iter().zip(&edited.joints).filter(|(old, new)| old != new) {
        match root.named("joint", &old.name) {
            Some(tag) => {
                if new.kind != old.kind || new.origin != old.origin {
                    joint::lock(tag, new.origin, &mut editor);
                }
                joint::set_dynamics(tag, old, new, keeps_old, &mut editor);
            }
            None => reasons.push(format!("joint `{}` is a part of a planar joint", old.name)),
        }
    }
    if original.base != edited.base {
        editor.insert_last(root, &free_base(edited));
    }
    if !reasons.is_empty() {
        return Err(EditError::Unsupported(NotUrdf { reasons }));
    }
    Ok(format!("{}{}", &text[..text.len() - body.len()], editor.apply()))
}

fn unsupported(a: &Description, b: &Description) -> Vec<String> {
    let mut reasons = Vec::new();
    let mut differ = |differs: bool, what: String| {
        if differs {
            reasons.push(what);
        }
    };
    differ(!a.links.iter().map(|l| &l.name).eq(b.links.iter().map(|l| &l.name)), "its links are others".into());
    differ(!a.joints.iter().map(|j| &j.name).eq(b.joints.iter().map(|j| &j.name)), "its joints are others".into());
    differ(a.base == Base::Floating && b.base == Base::Fixed, "its base is fixed".into());
    differ(a.name != b.name, format!("its name is `{}`", b.name));
    differ(a.gravity != b.gravity, format!("gravity is {:?}", b.gravity));
    differ(a.constraints != b.constraints, "its constraints are others".into());
    differ(a.motors != b.motors, "its motors are others".into());
    for (old, new) in a.joints.iter().zip(&b.joints).filter(|(old, new)| old != new) {
        let locked = Joint { kind: JointKind::Fixed, origin: new.origin, mimic: None, ..old.clone() };
        let moving = Joint {
            damping: new.damping,
            friction: new.friction,
            armature: new.armature,
            stiffness: new.stiffness,
            spring_reference: new.spring_reference,
            ..old.clone()
        };
        let is_known = locked == *new || moving == *new;
        differ(
            !is_known,
            format!("joint `{}` differs in other things than being locked, friction and springs", old.name),
        );
    }
    reasons
}

/// An empty link, and a floating joint from it to the base.
fn free_base(robot: &Description) -> [String; 2] {
    let space = free(&robot.free_joint.parent, |name| robot.links.iter().any(|link| link.name == name));
    let joint = free(&robot.free_joint.name, |name| robot.joints.iter().any(|joint| joint.name == name));
    let is_base = |name: &str| !robot.joints.iter().any(|joint| joint.child == name);
    let base = robot.links.iter().map(|link| link.name.as_str()).find(|name| is_base(name)).unwrap_or_default();
    let (space, joint, base) = (escaped(&space), escaped(&joint), escaped(base));
    [
        format!("<link name=\"{space}\"/>"),
        format!("<joint name=\"{joint}\" type=\"floating\"><parent link=\"{space}\"/><child link=\"{base}\"/></joint>"),
    ]
}
