//! A robot and its motion as a page.

use crate::columns::save;
use crate::csv;
use crate::failure::{self, Failure, Result};
use clap::{Args, ValueEnum};
use mozzi::simulation::Input;
use mozzi::{Model, Trajectory, Wrench};
use mozzi_report::{Drawing, Meshes, Motion};

/// More are counted: the page lists them.
const NOTES: usize = 3;

#[derive(Args, Debug)]
pub struct MeshArguments {
    /// Which meshes of the robot's file go into the page, where they are at hand
    #[arg(long, value_name = "WHICH", default_value = "visual")]
    meshes: Which,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Which {
    /// Those that are meant to be seen; of a link without any, those that collide
    Visual,
    /// Those that collide: mostly smaller
    Collision,
    /// None
    None,
}

impl MeshArguments {
    /// The page of a robot, by its name or its file.
    pub fn page(&self, name_or_path: &str, model: &Model, motion: Option<&Motion>) -> Result<String> {
        let meshes = match self.meshes {
            Which::Visual => Meshes::Visual,
            Which::Collision => Meshes::Collision,
            Which::None => Meshes::None,
        };
        let drawing = Drawing::of_file(name_or_path, meshes)?;
        drawing.notes.iter().take(NOTES).for_each(|note| failure::note(note));
        if drawing.notes.len() > NOTES {
            failure::note(&format!(
                "{} shapes are left out in all; the page lists them under `?`",
                drawing.notes.len()
            ));
        }
        mozzi_report::html(model, &drawing, motion).map_err(|error| Failure::wrong(error.to_string()))
    }

    /// The same into a file.
    pub fn write(&self, file: &str, name_or_path: &str, model: &Model, motion: Option<&Motion>) -> Result<String> {
        let page = self.page(name_or_path, model, motion)?;
        save(file, &page)?;
        Ok(format!("a page of {} kB written to {file}", page.len().div_ceil(1000)))
    }
}

/// A simulated motion, with what the end effector applied in each of its rows.
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

/// A table's motion; energies follow from it.
pub fn read(file: &str, model: &Model) -> Result<Motion> {
    let mut samples = csv::read(file, model)?;
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
