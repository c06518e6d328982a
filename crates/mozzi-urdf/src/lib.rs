//! Reads robot descriptions in URDF, MuJoCo's MJCF (see [`mjcf`]) and SDFormat (see [`sdf`]): text in, [`Description`]
//! out, and diagnostics that point at the place.
//!
//! No silent guesses: whatever is wrong is an error, and all errors are reported together; suspicious content is a
//! warning.
//!
//! # Errors and warnings
//! Of the 69 robots of `example-robot-data` 6.0.0, 66 load, 38 of them without warnings; three are refused: for a mimic
//! joint of a joint that does not exist, for negative moments of inertia, and for having no links.
//!
//! - A `floating` joint at the root is a floating base ([`mozzi::Base`]); the empty link that carries it is the space
//!   frame, not a link of the robot. Any other `floating` joint is a free joint of the tree. A `planar` joint `j`
//!   becomes the prismatic joints `j.x` and `j.y` and the revolute joint `j.theta` about its axis, with massless links
//!   between: x is along the joint frame's x-axis projected onto the plane (its y-axis if |axis_x| > 0.9), y along axis
//!   × x.
//! - Versions 1.0, 1.1 and 1.2 of URDF are read as by urdfdom 6: `quat_xyzw` of an origin from 1.1 on, and with a
//!   warning that it is ignored before.
//! - Drake's extensions: `<drake:joint>` is a ball joint, a planar joint with three dampings, a helical joint
//!   (`screw`), or, if `universal`, the revolute joints `j.rx` and `j.ry`; `drake:rotor_inertia` and `drake:gear_ratio`
//!   of an actuator are the armature ratio² × inertia; `<drake:ball_constraint>` is a constraint. Drake's forces give
//!   warnings that name them.
//! - Constraints, which close loops, may also come from a file of their own: see [`constraints`]. urdfdom's proposal
//!   `<constraint>` is refused by name.
//! - Probable misspellings of URDF elements and attributes are errors, unless the right word is there as well. Known
//!   extensions (gazebo, transmission, ros2_control) are skipped, except for elements that change the motion, such as a
//!   link without gravity. Other unknown words, of any namespace, give one warning per kind.
//! - A file of xacro is expanded ([`mozzi_xacro`]), by its name or if its root declares xacro's namespace; places are
//!   those of the xacro files, with the calls of macros. Meshes do not affect the dynamics; only [`geometry`] locates
//!   them.
//! - Only the direction of an axis is used, with a warning if its length differs from 1 by more than 10⁻³; positions
//!   stay radians or metres.
//! - A missing limit is a warning and means unlimited, and so are reversed limits; limits do not enter the dynamics.
//! - Warnings are in the order of their [`Consequence`]: those that change the motion come first. Elements and
//!   attributes of appearance and contact are counted ([`Loaded::unused`]), without a warning.
//! - An inertia that breaks the triangle inequality is used as given, with a warning. A negative principal moment is an
//!   error if the rigid body of all links fixed to each other has one, a warning otherwise.
//! - [`Policy::Strict`] turns warnings into errors; [`Policy::Lenient`] repairs inertias and reports each repair.
//!
//! Time and memory are bounded for any input: 64 MiB, two million elements and texts, 256 levels, 256 attributes per
//! element, 64 namespaces in scope, names of 256 bytes, a thousand errors; no document type, no entities.
//!
//! ```
//! let robot = mozzi_urdf::open("ur5")?; // or a path
//! assert!(robot.warnings.is_empty());
//! let model = robot.build()?;
//! assert_eq!(model.n(), 6);
//!
//! let error = mozzi_urdf::parse("arm.urdf", b"<robot name='arm'><link name='a'><intertial/></link></robot>");
//! assert_eq!(
//!     error.expect_err("a misspelled word").to_string(),
//!     "arm.urdf is refused: 1 error\n\
//!      arm.urdf:1:35: error: link `a`: has an element <intertial>, which URDF does not define here"
//! );
//! # Ok::<(), mozzi_urdf::LoadError>(())
//! ```
pub mod constraints;
mod edit;
pub mod embedded;
pub mod fix;
pub mod geometry;
pub mod json;
pub mod mjcf;
mod report;
pub mod sdf;
mod settings;
mod text;
mod urdf;
mod written;

pub use edit::{EditError, EditedFile, drives_of_fixed_joints, edit, edit_files, edit_with_old_values};
pub use mozzi::model::Severity;
pub use mozzi_xacro::{Arguments as XacroArguments, files};
pub use report::consequence::{Consequence, consequence, unused};
pub use report::diagnostic::Diagnostic;
pub use report::error::LoadError;
pub use report::explain::{codes, explain, nearest_code, remedy};
#[cfg(feature = "pretty")]
pub use report::pretty::{Style, pretty};
pub use report::spelling::{counted, did_you_mean};
pub use report::visible::visible;
pub use report::why::why;
pub use settings::{Policy, Settings};
pub use text::expansion::{expanded, expanded_with_warnings, taken_from_host};
pub use urdf::expressible::expressible;
pub use urdf::write::{NotUrdf, only_ball_constraints, write};
pub use written::{NotWritten, Written, chosen_end_effector, named_states};

use mozzi::{Description, Model, SO3};
use report::finding::Findings;
use report::placed::Placed;
use report::places::Places;
use report::{problem, repair};
use std::collections::BTreeMap;
use std::path::Path;
use text::context::Context;
use text::dialect::Dialect;
use text::element::Element;
use text::pages::Pages;
use text::source::Source;
use text::{bytes, expansion, syntax};
use urdf::robot;

/// A robot that was read, with the warnings.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The content of the file.
    pub description: Description,
    /// Sorted by consequence, with those that change the motion first; then in the order of the file.
    pub warnings: Vec<Diagnostic>,
    /// Valid content that mozzi does not use, such as appearance and contact: once per kind. See [`unused`].
    pub unused: Vec<Diagnostic>,
    /// The arguments that a file of xacro declares or reads, with their values, by name.
    pub xacro_arguments: Vec<(String, String)>,
    /// The axes in which the file gives each link's inertia, in the link's axes, by link: the rotation of a URDF's
    /// `<inertial><origin>`. None for links without an inertia of their own.
    pub inertial_axes: BTreeMap<String, SO3>,
}

impl Loaded {
    /// The model of this robot; the warnings are dropped.
    ///
    /// # Errors
    /// [`LoadError::Build`]; does not occur for a description that was read.
    pub fn build(self) -> Result<Model, LoadError> {
        Ok(self.description.build()?)
    }
}

/// Reads a file.
///
/// # Errors
/// [`LoadError::File`] if it cannot be read, [`LoadError::Refused`] with all its errors.
pub fn load(path: impl AsRef<Path>) -> Result<Loaded, LoadError> {
    load_with(path, Policy::Default)
}

/// Reads a file under a policy, or with other settings, such as arguments of xacro.
///
/// # Errors
/// As [`load`].
pub fn load_with(path: impl AsRef<Path>, settings: impl Into<Settings>) -> Result<Loaded, LoadError> {
    let path = path.as_ref();
    parse_in(path.parent(), &path.to_string_lossy(), &file_bytes(path)?, &settings.into())
}

fn file_bytes(path: &Path) -> Result<Vec<u8>, LoadError> {
    // one byte more than the limit, so that a file which is too large is detected without reading all of it
    files::read_start(path, bytes::MOST_BYTES as u64 + 1)
        .map_err(|source| LoadError::File { path: path.to_path_buf(), source })
}

/// Reads a text. Diagnostics use the name as its file name.
///
/// # Errors
/// [`LoadError::Refused`] with all its errors.
pub fn parse(file_name: &str, text: impl AsRef<[u8]>) -> Result<Loaded, LoadError> {
    parse_with(file_name, text, Policy::Default)
}

/// Reads a text under a policy, or with other settings.
///
/// # Errors
/// As [`parse`].
pub fn parse_with(file_name: &str, text: impl AsRef<[u8]>, settings: impl Into<Settings>) -> Result<Loaded, LoadError> {
    parse_in(None, file_name, text.as_ref(), &settings.into())
}

/// Where files are searched that the text of a file includes: by default next to it if their texts are given.
fn folder_of<'p>(folder: Option<&'p Path>, file_name: &'p str, given: &XacroArguments) -> Option<&'p Path> {
    folder.or_else(|| Path::new(file_name).parent().filter(|_| !given.texts.is_empty()))
}

/// Reads a text; included files are searched in a folder.
fn parse_in(folder: Option<&Path>, file_name: &str, text: &[u8], settings: &Settings) -> Result<Loaded, LoadError> {
    let policy = settings.policy;
    let mut findings = Findings::default();
    let source = Source::new(file_name, bytes::read(text, &mut findings));
    let (source, notes) = expansion::prepare(source, &settings.xacro)?;
    let dialect = Dialect::of(&source.text);
    let source = syntax::mended(source, dialect, &mut findings);
    let (mut sources, mut description) = (vec![source], None);
    let mut inertial_axes = BTreeMap::new();
    if !findings.has_errors() {
        let mut cx = Context::new(findings, dialect);
        let folder = folder_of(folder, file_name, &settings.xacro);
        let result = match dialect {
            Dialect::Urdf => read_urdf(&sources[0], &mut cx),
            Dialect::Mjcf => mjcf::read(&mut sources, folder, &settings.xacro, &mut cx),
            Dialect::Sdf => sdf::read(&mut sources, folder, &settings.xacro, &mut cx),
        };
        findings = cx.findings;
        description = result.map(|(description, places)| {
            let each = description.links.iter().zip(&places.links);
            inertial_axes = each.filter_map(|(link, place)| Some((link.name.clone(), place.turned?))).collect();
            finish(description, &places, policy, &mut findings)
        });
    }
    let Placed { mut diagnostics, errors, is_cut } = Placed::of(findings, &sources, dialect);
    diagnostics.extend(notes);
    let is_unused = |found: &Diagnostic| found.consequence() == Consequence::Unused;
    let is_refused = |found: &Diagnostic| policy == Policy::Strict && !is_unused(found);
    // errors stay in the order of the file
    diagnostics.sort_by_key(|found| (found.severity() == Severity::Warning).then(|| found.consequence()));
    let refused = errors > 0 || diagnostics.iter().any(is_refused);
    match description {
        Some(description) if !refused => {
            let (unused, warnings) = diagnostics.into_iter().partition(is_unused);
            let expansion = sources[0].expansion.as_ref();
            let xacro_arguments = expansion.map_or_else(Vec::new, |expansion| expansion.arguments.clone());
            Ok(Loaded { description, warnings, unused, xacro_arguments, inertial_axes })
        }
        _ => {
            let strictly = |found| if is_refused(&found) { found.into_error() } else { found };
            let diagnostics = diagnostics.into_iter().map(strictly).collect();
            Err(LoadError::Refused { file: file_name.to_string(), diagnostics, is_cut })
        }
    }
}

/// The model of a file; the warnings are dropped.
///
/// # Errors
/// As [`load`].
pub fn model(path: impl AsRef<Path>) -> Result<Model, LoadError> {
    load(path)?.build()
}

/// A robot by its file's path, or else by the name of an embedded robot (see [`embedded`]).
///
/// # Errors
/// As [`load`]; [`LoadError::NoSuchRobot`] when there is neither.
pub fn open(name_or_path: &str) -> Result<Loaded, LoadError> {
    open_with(name_or_path, Policy::Default)
}

/// As [`open`].
///
/// # Errors
/// As there; under [`Policy::Strict`] warnings too.
pub fn open_with(name_or_path: &str, settings: impl Into<Settings>) -> Result<Loaded, LoadError> {
    match embedded::unless_file(name_or_path) {
        Some(text) => parse_with(&format!("{name_or_path}.urdf"), text, settings),
        None if Path::new(name_or_path).exists() => load_with(name_or_path, settings),
        None => Err(LoadError::NoSuchRobot { name: name_or_path.to_string() }),
    }
}

/// From a text of URDF to a description; all findings are collected.
fn read_urdf(source: &Source, cx: &mut Context) -> Option<(Description, Places)> {
    match syntax::parse(source, Dialect::Urdf) {
        Ok(document) => robot::read(&Element::root(&Pages::single(source, document), "robot")?, cx),
        Err(finding) => {
            cx.findings.add(finding);
            None
        }
    }
}

/// The repairs of the policy, and the findings of the library's own checks.
fn finish(mut description: Description, places: &Places, policy: Policy, findings: &mut Findings) -> Description {
    if policy == Policy::Lenient {
        repair::inertias(&mut description, places, findings);
    }
    problem::findings(&description, places).into_iter().for_each(|finding| findings.add(finding));
    description
}
