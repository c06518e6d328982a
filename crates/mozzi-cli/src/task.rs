//! The rows of a task and their coordinates.

use crate::failure::{Failure, Result};
use crate::numbers::TWIST;
use crate::quantity::of_end_effector;
use clap::{Args, ValueEnum};
use mozzi::quantities::{Of, Query};
use mozzi::{Model, Task, TaskFrame};

#[derive(Args, Debug, Default)]
pub struct TaskArguments {
    /// Rows of the task among wx, wy, wz, vx, vy, vz, such as vx,vz for a planar arm [default: all six]
    #[arg(long, value_name = "ROWS")]
    pub task: Option<String>,
    /// Coordinates of the task's twist and wrench [default: body]
    #[arg(long, value_name = "FRAME")]
    pub task_frame: Option<Coordinates>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Coordinates {
    /// The end effector's
    Body,
    /// The base's
    Space,
}

impl TaskArguments {
    /// Rows of (ω, v), by index.
    pub fn rows(&self) -> Result<Vec<usize>> {
        self.task.as_ref().map_or_else(|| Ok((0..6).collect()), |rows| rows.split(',').map(row).collect())
    }

    /// Checks that there is a quantity of a task if these flags are given.
    pub fn check_use<'q>(&self, mut queries: impl Iterator<Item = Query<'q>>) -> Result<()> {
        let is_given = self.task.is_some() || self.task_frame.is_some();
        match is_given && !queries.any(|query| query.declaration().of == Of::Task) {
            true => Err(Failure::wrong("--task and --task-frame have an effect on task-space-dynamics only")),
            false => Ok(()),
        }
    }

    /// The quantity: of this task, or of the end effector.
    pub fn subject<'q>(&self, query: Query<'q>, rows: &'q [usize], model: &Model) -> Result<Query<'q>> {
        match query.declaration().of {
            Of::Task => Ok(query.of_task(Task { rows, ..Task::all(model.end_effector()?, self.coordinates()) })),
            _ => of_end_effector(query, model),
        }
    }

    pub fn coordinates(&self) -> TaskFrame {
        match self.task_frame {
            Some(Coordinates::Space) => TaskFrame::Space,
            Some(Coordinates::Body) | None => TaskFrame::Body,
        }
    }
}

/// "body" or "space".
pub fn name(coordinates: TaskFrame) -> &'static str {
    match coordinates {
        TaskFrame::Body => "body",
        TaskFrame::Space => "space",
    }
}

fn row(name: &str) -> Result<usize> {
    let names = ["wx", "wy", "wz", "vx", "vy", "vz"];
    let name = name.trim();
    let found = names.iter().zip(TWIST).position(|(short, symbol)| *short == name || symbol == name);
    found.ok_or_else(|| {
        Failure::wrong(format!("--task: there is no row `{name}`, expected some of {}", names.join(", ")))
    })
}
