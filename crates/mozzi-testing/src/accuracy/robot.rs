//! A robot in three number types.

use crate::accuracy::mixed;
use crate::accuracy::states::Kind;
use crate::{Double, Octuple, Wide, read_urdf};
use mozzi::quantities::{LIST, Of, Query, Uses};
use mozzi::{Description, FrameId, Model, Task, TaskFrame, Vec3};
use std::path::Path;

/// A robot to be measured.
#[derive(Debug)]
pub struct Robot {
    /// Its name in the tables.
    pub name: String,
    /// The file's text, which other libraries read too.
    pub text: String,
    /// The ordinary model in `f64`.
    pub model: Model,
    /// Read from the file's decimals.
    pub double: Model<Double>,
    /// Likewise, with its description.
    pub octuple: (Description<Octuple>, Model<Octuple>),
    /// The frame of the quantities that have one.
    pub frame: FrameId,
    /// The rows of the task.
    rows: Vec<usize>,
    /// The kind of states.
    pub kind: Kind,
}

impl Robot {
    /// A robot by the name of an embedded one, by that of the [mixed tree](crate::accuracy::mixed), or by the path of a
    /// URDF file; the suffix `:floating` frees its base.
    ///
    /// # Errors
    /// A message for a robot that cannot be read.
    pub fn open(given: &str) -> Result<Self, String> {
        let (source, floats) = given.strip_suffix(":floating").map_or((given, false), |source| (source, true));
        if source == mixed::NAME {
            return mixed::robot(floats);
        }
        let text = match mozzi_urdf::embedded::text(source) {
            Some(text) => text.to_string(),
            None => std::fs::read_to_string(source).map_err(|error| format!("{source}: {error}"))?,
        };
        let stem = Path::new(source).file_stem().map_or(source.into(), |stem| stem.to_string_lossy());
        let name = if floats { format!("{stem}, floating") } else { stem.into_owned() };
        Robot::parse(&name, &text, floats, Kind::Ordinary)
    }

    /// A robot of this URDF text.
    ///
    /// # Errors
    /// See [`open`](Self::open).
    pub fn parse(name: &str, text: &str, floats: bool, kind: Kind) -> Result<Self, String> {
        Robot::parse_with(name, text, floats, kind, |_| {})
    }

    /// Likewise, after an edit that URDF cannot express: balls and rotor inertias.
    ///
    /// # Errors
    /// See [`open`](Self::open).
    pub fn parse_with(
        name: &str,
        text: &str,
        floats: bool,
        kind: Kind,
        edit: impl FnOnce(&mut Description),
    ) -> Result<Self, String> {
        let said = |error: &dyn std::fmt::Display| format!("{name}: {error}");
        let read = mozzi_urdf::parse(&format!("{name}.urdf"), text).map_err(|error| said(&error))?;
        let mut description = if floats { read.description.floating() } else { read.description };
        edit(&mut description);
        Robot::of(name, text, description, kind)
    }

    fn of(name: &str, text: &str, description: Description, kind: Kind) -> Result<Self, String> {
        fn wide<W: Wide>(text: &str, robot: &Description) -> Result<(Description<W>, Model<W>), String> {
            let robot = read_urdf::<W>(text, robot).map_err(|error| error.to_string())?;
            let model = robot.clone().build().map_err(|error| error.to_string())?;
            Ok((robot, model))
        }
        let said = |error: String| format!("{name}: {error}");
        let (double, octuple) = (wide(text, &description).map_err(said)?.1, wide(text, &description).map_err(said)?);
        let model = description.build().map_err(|error| said(error.to_string()))?;
        let last = model.frames().last().map(|(frame, _)| frame);
        let frame = model.end_effector().ok().or(last).ok_or_else(|| said("it has no frame".into()))?;
        let rows = task_rows(&model, frame);
        Ok(Robot { name: name.into(), text: text.into(), model, double, octuple, frame, rows, kind })
    }

    /// The task of the quantities that have one.
    pub fn task(&self) -> Task<'_> {
        Task { frame: self.frame, coordinates: TaskFrame::Body, rows: &self.rows }
    }

    /// The quantity at this index of the list, with this robot's frame and task.
    pub fn query(&self, index: usize) -> Query<'_> {
        let query = Query::at(index);
        match LIST[index].of {
            Of::Robot => query,
            Of::Frame => query.of(self.frame),
            Of::Task => query.of_task(self.task()),
            Of::Point => query.about(Vec3([0.25, -0.5, 0.125])),
        }
    }
}

/// True if the quantity depends on wrenches only, so that it is zero in the robot's own environment.
pub fn is_of_wrenches(query: &Query) -> bool {
    query.declaration().uses == Uses::WRENCHES
}

/// The frame's velocity if the robot has six degrees of freedom; else the one row of its twist that moves most.
fn task_rows(model: &Model, frame: FrameId) -> Vec<usize> {
    if model.n() >= 6 {
        return vec![3, 4, 5];
    }
    let states = crate::accuracy::states::States::new(model, Kind::Ordinary, 1, 1);
    let J = model.body_jacobian(states.theta(0), frame).map(|J| J.matrix());
    let size = |row: usize| J.as_ref().map_or(0.0, |J| J.row(row).norm());
    (0..6).max_by(|&a, &b| size(a).total_cmp(&size(b))).into_iter().collect()
}
