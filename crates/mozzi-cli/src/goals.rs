//! Goals of the end effector: by flags, or tables in CSV files with columns x y z of the origin, and qw qx qy qz or
//! roll pitch yaw of the orientation, in {s}.

use crate::angles::{self, question};
use crate::failure::{Failure, Result};
use crate::numbers::{self, array, number, wrong_number};
use crate::text_table::TextTable;
use clap::Args;
use mozzi::{SE3, SO3, Vec3};
use mozzi_motion::Goal;

const POSITION: [&str; 3] = ["x", "y", "z"];
const QUATERNION: [&str; 4] = ["qw", "qx", "qy", "qz"];
const RPY: [&str; 3] = ["roll", "pitch", "yaw"];

#[derive(Args, Debug, Default)]
pub struct GoalArguments {
    /// Desired position of the frame's origin in {s}, m
    #[arg(long, aliases = ["xyz", "pos"], value_name = "X,Y,Z")]
    pub position: Option<String>,
    /// Desired orientation: roll, pitch, yaw about the axes of {s}, as in URDF, rad
    #[arg(long, value_name = "R,P,Y")]
    pub rpy: Option<String>,
    /// Desired orientation as a unit quaternion
    #[arg(long, alias = "quat", value_name = "W,X,Y,Z", conflicts_with = "rpy")]
    pub quaternion: Option<String>,
}

impl GoalArguments {
    /// A pose, a position or an orientation; nothing if no flag is given.
    pub fn read(&self) -> Result<Option<Goal>> {
        let position = self.position.as_deref().map(|text| array("--position", text, ["x", "y", "z"])).transpose()?;
        let R = match (&self.rpy, &self.quaternion) {
            (Some(text), _) => {
                let found = numbers::angles("--rpy", text, &[true; 3])?;
                let [roll, pitch, yaw] = found[..] else {
                    return Err(wrong_number("--rpy", found.len(), &["roll", "pitch", "yaw"]));
                };
                question("--rpy", text, &found, &[true; 3]);
                Some(SO3::from_rpy(roll, pitch, yaw))
            }
            (None, Some(text)) => {
                let [w, x, y, z] = array("--quaternion", text, ["w", "x", "y", "z"])?;
                Some(from_pose("--quaternion", [w, x, y, z, 0.0, 0.0, 0.0])?.R)
            }
            (None, None) => None,
        };
        Ok(goal(R, position.map(Vec3)))
    }
}

/// The goal of each row, and its line in the file.
pub fn read(file: &str) -> Result<Vec<(u64, Goal)>> {
    let mut text = TextTable::open(file)?;
    let header = text.header.names.clone();
    let expected = "x y z, and qw qx qy qz or roll pitch yaw (rad) or neither; or an orientation alone";
    let known = [&POSITION[..], &QUATERNION, &RPY].concat();
    if let Some(unknown) = header.iter().position(|cell| !known.contains(&cell.as_str())) {
        let found = &header[unknown];
        return Err(Failure::wrong(format!(
            "{file}:1: column {} is called `{found}`, expected the columns {expected}",
            unknown + 1
        )));
    }
    let twin = |k: usize| Some((header[..k].iter().position(|cell| *cell == header[k])? + 1, k + 1));
    if let Some((first, second)) = (1..header.len()).find_map(twin) {
        let name = &header[first - 1];
        return Err(Failure::wrong(format!(
            "{file}:1: columns {first} and {second} are both called `{name}`, expected one"
        )));
    }
    let position = group(file, &header, POSITION, expected)?;
    let (quaternion, rpy) = (group(file, &header, QUATERNION, expected)?, group(file, &header, RPY, expected)?);
    if quaternion.is_some() && rpy.is_some() {
        return Err(Failure::wrong(format!("{file}:1: two orientations, expected qw qx qy qz or roll pitch yaw")));
    }
    if rpy.is_some() {
        angles::of_file(file);
    }
    let (mut goals, commas) = (Vec::new(), text.has_decimal_commas());
    text.rows(false, |line, record| {
        let entry = |place: usize, name: &str| {
            let cell = if commas { record[place].replace(',', ".") } else { record[place].to_string() };
            number(format!("{file}:{line}: column {} (`{name}`)", place + 1), &cell)
        };
        let p = position.map(|places| numbers(places, POSITION, &entry)).transpose()?.map(Vec3);
        let R = match (quaternion, rpy) {
            (Some(places), _) => {
                let [w, x, y, z] = numbers(places, QUATERNION, &entry)?;
                Some(from_pose(&format!("{file}:{line}: qw qx qy qz"), [w, x, y, z, 0.0, 0.0, 0.0])?.R)
            }
            (_, Some(places)) => {
                let [roll, pitch, yaw] = numbers(places, RPY, &entry)?;
                Some(SO3::from_rpy(roll, pitch, yaw))
            }
            _ => None,
        };
        let goal = goal(R, p).ok_or_else(|| Failure::wrong(format!("{file}:1: expected the columns {expected}")))?;
        goals.push((line, goal));
        Ok(())
    })?;
    if goals.is_empty() {
        return Err(Failure::wrong(format!("{file} has no rows below its header")));
    }
    Ok(goals)
}

/// The places of columns that belong together; none if none is there.
fn group<const K: usize>(
    file: &str,
    header: &[String],
    names: [&str; K],
    expected: &str,
) -> Result<Option<[usize; K]>> {
    let places = names.map(|name| header.iter().position(|cell| cell == name));
    match places.iter().position(Option::is_none) {
        None => Ok(Some(places.map(Option::unwrap_or_default))),
        Some(_) if places.iter().all(Option::is_none) => Ok(None),
        Some(k) => {
            let name = names[k];
            Err(Failure::wrong(format!("{file}:1: column `{name}` is missing, expected the columns {expected}")))
        }
    }
}

fn numbers<const K: usize>(
    places: [usize; K],
    names: [&str; K],
    entry: &dyn Fn(usize, &str) -> Result<f64>,
) -> Result<[f64; K]> {
    let mut found = [0.0; K];
    for ((x, place), name) in found.iter_mut().zip(places).zip(names) {
        *x = entry(place, name)?;
    }
    Ok(found)
}

fn goal(R: Option<SO3>, p: Option<Vec3>) -> Option<Goal> {
    match (R, p) {
        (Some(R), Some(p)) => Some(Goal::Pose(SE3::new(R, p))),
        (None, Some(p)) => Some(Goal::Position(p)),
        (Some(R), None) => Some(Goal::Orientation(R)),
        (None, None) => None,
    }
}

/// The pose of a quaternion whose length differs from 1 by at most 10⁻³, as for a floating base.
fn from_pose(place: &str, pose: [f64; 7]) -> Result<SE3> {
    let length = pose[..4].iter().map(|x| x * x).sum::<f64>().sqrt();
    if (length - 1.0).abs() > 1e-3 {
        return Err(Failure::wrong(format!("{place}: the quaternion's length is {length}, expected 1")));
    }
    Ok(SE3::from_pose(pose))
}
