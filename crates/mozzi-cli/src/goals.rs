//! Goals of the end effector: by flags, or tables of poses in CSV files with columns x y z of the origin and qw qx qy
//! qz of the orientation, in {s}.

use crate::angles::question;
use crate::failure::{Failure, Result};
use crate::numbers::{angles, array, number, wrong_number};
use crate::text_table::TextTable;
use clap::Args;
use mozzi::{SE3, SO3, Vec3};
use mozzi_motion::Goal;

const COLUMNS: [&str; 7] = ["qw", "qx", "qy", "qz", "x", "y", "z"];

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
                let found = angles("--rpy", text, &[true; 3])?;
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
        Ok(match (R, position.map(Vec3)) {
            (Some(R), Some(p)) => Some(Goal::Pose(SE3::new(R, p))),
            (None, Some(p)) => Some(Goal::Position(p)),
            (Some(R), None) => Some(Goal::Orientation(R)),
            (None, None) => None,
        })
    }
}

/// Poses and the line of each in the file.
pub fn read(file: &str) -> Result<Vec<(u64, SE3)>> {
    let mut text = TextTable::open(file)?;
    let header = text.header.names.clone();
    let mut places = [0; 7];
    for (place, name) in places.iter_mut().zip(COLUMNS) {
        *place = header.iter().position(|cell| cell == name).ok_or_else(|| {
            Failure::wrong(format!("{file}:1: column `{name}` is missing, expected the columns {}", COLUMNS.join(" ")))
        })?;
    }
    if let Some(unknown) = header.iter().position(|cell| !COLUMNS.contains(&cell.as_str())) {
        let (expected, found) = (COLUMNS.join(" "), &header[unknown]);
        return Err(Failure::wrong(format!(
            "{file}:1: column {} is called `{found}`, expected {expected}",
            unknown + 1
        )));
    }
    let (mut poses, commas) = (Vec::new(), text.has_decimal_commas());
    text.rows(false, |line, record| {
        let mut pose = [0.0; 7];
        for ((entry, name), place) in pose.iter_mut().zip(COLUMNS).zip(places) {
            let cell = if commas { record[place].replace(',', ".") } else { record[place].to_string() };
            *entry = number(format!("{file}:{line}: column {} (`{name}`)", place + 1), &cell)?;
        }
        poses.push((line, from_pose(&format!("{file}:{line}: qw qx qy qz"), pose)?));
        Ok(())
    })?;
    if poses.is_empty() {
        return Err(Failure::wrong(format!("{file} has no rows below its header")));
    }
    Ok(poses)
}

/// The pose of a quaternion whose length differs from 1 by at most 10⁻³, as for a floating base.
fn from_pose(place: &str, pose: [f64; 7]) -> Result<SE3> {
    let length = pose[..4].iter().map(|x| x * x).sum::<f64>().sqrt();
    if (length - 1.0).abs() > 1e-3 {
        return Err(Failure::wrong(format!("{place}: the quaternion's length is {length}, expected 1")));
    }
    Ok(SE3::from_pose(pose))
}
