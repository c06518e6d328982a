//! A robot and its motion as a page.

use crate::columns::save;
use crate::failure::{self, Failure, Result};
use crate::input;
use crate::robot::RobotArguments;
use crate::robot_json;
use crate::tables::{motion, read as table_file};
use clap::{Args, ValueEnum};
use mozzi::{Model, Wrench};
use mozzi_report::{Drawing, Meshes, Motion, Touches};
use mozzi_sim::Trajectory;
use mozzi_sim::{ContactEvent, Contacts, Input};
use mozzi_urdf::{embedded, expanded, taken_from_host};
use std::fmt::{self, Display, Formatter};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Further notes are only counted: the page lists them.
const NOTES: usize = 3;

/// A larger page is announced; in bytes.
const LARGE: usize = 20_000_000;

/// Which meshes go into a page.
#[derive(Args, Debug)]
pub struct MeshArguments {
    /// Which meshes of the robot's file are shown, if they are found
    #[arg(long, value_name = "WHICH", default_value = "visual")]
    meshes: Which,
    /// A folder above the meshes of the robot's file that lie outside of its own folder and package; those that are
    /// not found elsewhere are searched there
    #[arg(long, value_name = "FOLDER")]
    mesh_root: Option<PathBuf>,
    /// Allow an output of a xacro file that reads variables of the environment, or files outside of its folder and of
    /// packages: their contents may be in the output
    #[arg(long)]
    allow_host: bool,
}

/// The folder of `--mesh-root`.
pub fn mesh_root(folder: Option<&Path>) -> Result<Option<&Path>> {
    match folder.filter(|folder| !folder.is_dir()) {
        Some(folder) => Err(Failure::wrong(format!("--mesh-root is `{}`, expected a folder", folder.display()))),
        None => Ok(folder),
    }
}

#[derive(Args, Debug)]
pub struct PageArguments {
    #[command(flatten)]
    meshes: MeshArguments,
    /// Maximum number of rows of the motion in the page, at equal times; or "all"
    #[arg(long, value_name = "N", default_value_t = Rows(mozzi_report::ROWS))]
    page_rows: Rows,
}

/// A number of rows, at least two.
#[derive(Clone, Copy, Debug)]
struct Rows(usize);

impl FromStr for Rows {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        match text.parse() {
            _ if text == "all" => Ok(Rows(usize::MAX)),
            Ok(rows) if rows >= 2 => Ok(Rows(rows)),
            _ => Err("expected a whole number of at least 2, or all".into()),
        }
    }
}

impl Display for Rows {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        if self.0 == usize::MAX { f.write_str("all") } else { self.0.fmt(f) }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Which {
    /// Visual meshes; for a link without any, its collision meshes
    Visual,
    /// Collision meshes, mostly smaller; for a link without any, its visual boxes, cylinders and balls
    Collision,
    /// None
    None,
}

impl MeshArguments {
    /// A page may be passed on: it must not contain what the robot's file takes from this machine.
    fn check_host(&self, robot: &RobotArguments) -> Result<()> {
        let name = robot.model.as_str();
        if self.allow_host || robot_json::is_json(name) || embedded::unless_file(name).is_some() {
            return Ok(());
        }
        let taken = taken_from_host(input::name(name), input::robot_file(name)?, robot.settings())?;
        let Some(first) = taken.first() else { return Ok(()) };
        let more = if taken.len() > 1 { format!(" and {} more", taken.len() - 1) } else { String::new() };
        Err(Failure::wrong(format!(
            "{} reads {first}{more}, which may then be in the output; --allow-host allows it",
            input::name(name)
        )))
    }

    /// The shapes of a robot with these meshes; prints what is omitted.
    pub fn drawing(&self, robot: &RobotArguments) -> Result<Drawing> {
        let drawing = self.read(robot)?;
        note(&drawing.notes, "; the page lists them under `?`");
        Ok(drawing)
    }

    /// The shapes of a robot with these meshes.
    pub fn read(&self, robot: &RobotArguments) -> Result<Drawing> {
        let name_or_path = robot.model.as_str();
        let meshes = match self.meshes {
            Which::Visual => Meshes::Visual,
            Which::Collision => Meshes::Collision,
            Which::None => Meshes::None,
        };
        let mesh_root = mesh_root(self.mesh_root.as_deref())?;
        self.check_host(robot)?;
        if name_or_path == "-" {
            let text = input::robot_text().map_err(|error| input::cannot(name_or_path, &error))?;
            let expansion = expanded(input::name(name_or_path), text, robot.settings())?;
            let text = expansion.as_ref().map_or(text, |expansion| expansion.as_bytes());
            return Ok(Drawing::of_text(input::name(name_or_path), text, meshes));
        }
        Ok(Drawing::of_file_below(name_or_path, &robot.settings().xacro, meshes, mesh_root)?)
    }
}

/// Prints some of the sentences about omitted shapes, and the number of all; `end` is the place where all are.
pub fn note(notes: &[String], end: &str) {
    notes.iter().take(NOTES).for_each(|note| failure::note(note));
    if notes.len() > NOTES {
        failure::note(&format!("{} shapes are omitted in total{end}", notes.len()));
    }
}

impl PageArguments {
    /// The number of rows of a motion to keep, if a page is requested.
    pub fn rows(&self, is_wanted: bool) -> usize {
        if is_wanted { self.page_rows.0 } else { 0 }
    }

    /// The page of a robot, by its name or its file, with a motion and the motion's full number of rows.
    pub fn page(
        &self,
        robot: &RobotArguments,
        model: &Model,
        motion: Option<(Motion, usize)>,
    ) -> Result<(String, String)> {
        let motion = motion.map(|(motion, all)| (motion.thinned(self.page_rows.0), all));
        let rows = motion.as_ref().map(|(motion, all)| format!("{} of {all} rows, ", motion.t.len()));
        let motion = motion.as_ref().map(|(motion, _)| motion);
        let drawing = self.meshes.drawing(robot)?;
        let page = mozzi_report::html(model, &drawing, motion).map_err(|error| Failure::wrong(error.to_string()))?;
        let size = format!("page: {}{:.1} MB", rows.unwrap_or_default(), page.len() as f64 / 1e6);
        if page.len() > LARGE {
            failure::note(&format!(
                "{size}: browsers need seconds to open it; --meshes and --page-rows make it smaller"
            ));
        }
        Ok((page, size))
    }

    /// Writes the page to a file; returns a message with its size.
    pub fn write(
        &self,
        file: &str,
        robot: &RobotArguments,
        model: &Model,
        motion: Option<(Motion, usize)>,
    ) -> Result<String> {
        let (page, size) = self.page(robot, model, motion)?;
        save(file, &page)?;
        Ok(format!("{size}, written to {file}"))
    }
}

/// A simulated motion, with the end effector's wrench at each of its rows.
pub fn simulated(title: String, motion: &Trajectory, mut wrench: impl Input) -> Result<Motion> {
    let mut applied = Vec::new();
    for row in motion.samples() {
        let mut now = Vec::new();
        wrench.applied(row.t, row.theta, row.dtheta, &mut now)?;
        applied.push(now.first().map_or(Wrench::zero(), |(_, F)| *F));
    }
    let is_any = applied.iter().any(|F| *F != Wrench::zero());
    Ok(Motion { tip_wrench: is_any.then_some(applied), ..Motion::simulated(title, motion) })
}

/// The contacts of a simulated motion, if it has any.
pub fn touches(
    model: &Model,
    contacts: &Contacts,
    motion: &Trajectory,
    events: &[ContactEvent],
) -> Result<Option<Touches>> {
    let touches = || Touches::new(model, contacts, motion, events).map_err(|error| Failure::wrong(error.to_string()));
    (!contacts.is_empty()).then(touches).transpose()
}

/// A table's motion; the energies are computed from it.
pub fn read(file: &str, model: &Model) -> Result<Motion> {
    let mut samples = motion::mended(table_file::read_as(file, model, &motion::HOW)?, model)?;
    let (t, theta) = (samples.times()?.to_vec(), samples.need("theta", model)?.to_vec());
    let mut take = |name| samples.tables.remove(name);
    let motion = Motion {
        title: samples.file.clone(),
        t,
        theta,
        dtheta: take("dtheta"),
        ddtheta: take("ddtheta"),
        tau: take("tau"),
        tip_wrench: take("wrench").map(|table| table.as_chunks().0.iter().copied().map(Wrench::from_array).collect()),
        ..Motion::default()
    };
    motion.with_energies(model).map_err(|error| Failure::wrong(format!("{file}: {error}")))
}
