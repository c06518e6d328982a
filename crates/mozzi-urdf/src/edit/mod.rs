//! Edits a robot's texts in place for changed inertias, friction, armature and springs; those of URDF also for locked
//! joints or a floating base. Visuals, comments and unknown elements remain.

pub(crate) mod element;
pub(crate) mod inertial;
mod joint;
mod mjcf;
mod numbers;
mod transmission;
mod xacro;

use crate::text::expansion;
use crate::urdf::write::{NotUrdf, escaped, free};
use crate::{LoadError, Policy, Settings, parse_with};
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
    /// The edited robot differs from the text in other things than those that are edited, or numbers of the text are
    /// computed.
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

/// A text that changed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EditedFile {
    /// The file's name: as given, or that by which another file includes it.
    pub name: String,
    /// Its edited text.
    pub text: String,
}

/// The texts of a robot in URDF, MJCF or xacro, edited as by [`edit`]: those that change, which may be included files
/// and YAML files of xacro. Without differences there are none.
///
/// MJCF: a value that comes from a default class is written on the element itself; an `<inertial>` is added to a body
/// whose inertia MuJoCo computes from geoms. Xacro: a number is edited where it is written, as a literal, a property,
/// an argument of a macro or an entry of a YAML file; the edited files are expanded again and compared.
///
/// # Errors
/// As [`edit`]. In xacro also if a number is computed or would need two values: the error lists each such number with
/// its place.
pub fn edit_files(
    file_name: &str,
    text: &str,
    edited: &Description,
    keeps_old: bool,
    settings: &Settings,
) -> Result<Vec<EditedFile>, EditError> {
    if let Some(expansion) = expansion::of(file_name, text, settings).map_err(EditError::Load)? {
        return xacro::edit(file_name, text, &expansion, edited, keeps_old, settings);
    }
    if crate::mjcf::is_mjcf(text) {
        return mjcf::edit(file_name, text, edited, keeps_old);
    }
    if crate::sdf::is_sdf(text) {
        return Err(refused(vec!["edits of SDFormat in place: convert it to .urdf or .json first".to_string()]));
    }
    let new = edited_text(file_name, text, edited, keeps_old)?;
    Ok(if new == text { Vec::new() } else { vec![EditedFile { name: file_name.to_string(), text: new }] })
}

fn refused(reasons: Vec<String>) -> EditError {
    EditError::Unsupported(NotUrdf { reasons })
}

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
    let body = text.strip_prefix('\u{feff}').unwrap_or(text);
    let document = match Document::parse(body) {
        Ok(document) => document,
        Err(error) => {
            parse_with(file_name, text, Policy::Lenient).map_err(EditError::Load)?;
            return Err(refused(vec![format!("its XML is not valid: {error}")]));
        }
    };
    let editor = editor(file_name, &document, edited, keeps_old)?;
    Ok(format!("{}{}", &text[..text.len() - body.len()], editor.apply()))
}

/// The changes of a URDF.
fn editor<'a>(
    file_name: &str,
    document: &'a Document<'a>,
    edited: &Description,
    keeps_old: bool,
) -> Result<Editor<'a>, EditError> {
    let text = document.input_text();
    // if the text is valid only after repairs, the repaired robot is compared, and all inertias are those of `edited`
    let (original, is_repaired) = match parse_with(file_name, text, Policy::Default) {
        Ok(loaded) => (loaded.description, false),
        Err(_) => (parse_with(file_name, text, Policy::Lenient).map_err(EditError::Load)?.description, true),
    };
    let reasons = unsupported(&original, edited);
    if !reasons.is_empty() {
        return Err(refused(reasons));
    }
    let mut reasons = Vec::new();
    let mut editor = Editor::new(text);
    let root = Tag::new(document.root_element(), text);
    let differ = |(old, new): &(&Link, &Link)| is_repaired || old.inertia != new.inertia;
    for (old, new) in original.links.iter().zip(&edited.links).filter(differ) {
        match root.named("link", &old.name) {
            Some(tag) => {
                inertial::set_inertia(tag, new.inertia, |x| format!("{x:?}"), &mut editor);
                if keeps_old {
                    editor.insert_first(tag, &inertial::comment_of(old.inertia));
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
                reasons.extend(joint::set_dynamics(tag, old, new, keeps_old, &mut editor).err());
            }
            None => reasons.push(format!("joint `{}` is a part of a planar joint", old.name)),
        }
    }
    if original.base != edited.base {
        editor.insert_last(root, &free_base(edited));
    }
    if reasons.is_empty() { Ok(editor) } else { Err(refused(reasons)) }
}

/// The differences between the robot of an edited text and the wanted one, beyond rounding.
fn differences(found: &Description, wanted: &Description) -> Vec<String> {
    let mut reasons = unsupported(found, wanted);
    let mut compare = |name: String, found: &[f64], wanted: &[f64], least: f64| {
        let scale = wanted.iter().fold(least, |most, x| most.max(x.abs()));
        if let Some((found, wanted)) = found.iter().zip(wanted).find(|(a, b)| (*a - *b).abs() > READ_AGAIN * scale) {
            reasons.push(format!("{name} of the edited text would be {found:?}, expected {wanted:?}"));
        }
    };
    for (a, b) in found.links.iter().zip(&wanted.links) {
        let moments = |I: mozzi::linalg::Sym3| [I.xx, I.xy, I.xz, I.yy, I.yz, I.zz];
        compare(format!("link `{}`: the mass", a.name), &[a.inertia.mass], &[b.inertia.mass], 0.0);
        let (c, d) = (a.inertia.center_of_mass(), b.inertia.center_of_mass());
        compare(format!("link `{}`: the centre of mass", a.name), &c.0, &d.0, 1e-3);
        let (I, J) = (a.inertia.about_center_of_mass(), b.inertia.about_center_of_mass());
        compare(
            format!("link `{}`: a moment", a.name),
            &moments(I),
            &moments(J),
            b.inertia.mass * d.0.iter().map(|x| x * x).sum::<f64>(),
        );
    }
    for (one, other) in found.joints.iter().zip(&wanted.joints) {
        for (what, a, b) in [
            ("damping", one.damping, other.damping),
            ("friction", one.friction, other.friction),
            ("armature", one.armature, other.armature),
            ("stiffness", one.stiffness, other.stiffness),
        ] {
            compare(format!("joint `{}`: the {what}", one.name), &[a], &[b], 0.0);
        }
    }
    for (a, b) in found.rotors.iter().zip(&wanted.rotors) {
        compare(format!("rotor `{}`: the armature", a.name), &[a.armature], &[b.armature], 0.0);
    }
    reasons
}

/// Inertias that are read again differ by rounding.
const READ_AGAIN: f64 = 1e-9;

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
