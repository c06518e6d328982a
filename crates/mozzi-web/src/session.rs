//! The robots of a page, by number.

use crate::robot::Robot;
use mozzi::{Description, Model};
use mozzi_urdf::json;
use serde_json::Value;

/// The robots that are open. Numbers of closed robots are not used again.
#[derive(Debug, Default)]
pub struct Session {
    robots: Vec<Option<Robot>>,
}

impl Session {
    /// Opens the robot of a text: JSON of [`mozzi_urdf::json`] if the file's name ends in `.json`, otherwise URDF,
    /// xacro, MJCF or SDFormat. Returns its number.
    ///
    /// # Errors
    /// All errors of the file, each with its place.
    pub fn load(&mut self, file_name: &str, text: &str) -> Result<usize, String> {
        let is_json = file_name.to_ascii_lowercase().ends_with(".json");
        let description = if is_json { from_json(file_name, text)? } else { from_file(file_name, text)? };
        let model: Model = description.build().map_err(|error| error.to_string())?;
        self.robots.push(Some(Robot::new(model)));
        Ok(self.robots.len() - 1)
    }

    /// Opens the robot of dropped files, and returns its number and what the page needs: see `play::open`.
    ///
    /// # Errors
    /// All errors of the file, each with its place and its line.
    #[cfg(feature = "play")]
    pub fn open(&mut self, text: &str) -> Result<(usize, Value), String> {
        let (robot, mut said) = crate::play::open(text)?;
        said["about"] = robot.about()?;
        self.robots.push(Some(robot));
        Ok((self.robots.len() - 1, said))
    }

    /// Closes a robot. Does nothing if it is not open.
    pub fn close(&mut self, robot: usize) {
        if let Some(robot) = self.robots.get_mut(robot) {
            *robot = None;
        }
    }

    /// An open robot.
    ///
    /// # Errors
    /// No robot with this number is open.
    pub fn robot(&mut self, robot: usize) -> Result<&mut Robot, String> {
        let found = self.robots.get_mut(robot).and_then(Option::as_mut);
        found.ok_or_else(|| format!("robot {robot} is not open"))
    }

    /// Everything about a robot that does not depend on its state: see [`Robot::about`].
    ///
    /// # Errors
    /// As [`Session::robot`].
    pub fn about(&mut self, robot: usize) -> Result<Value, String> {
        self.robot(robot)?.about()
    }
}

fn from_json(file_name: &str, text: &str) -> Result<Description, String> {
    let lines = |errors: Vec<json::Misplaced>| errors.iter().map(ToString::to_string).collect::<Vec<_>>();
    let file = json::File::parse(file_name, text).map_err(|error| error.to_string())?;
    json::read(&file).map_err(|errors| lines(errors).join("\n"))
}

#[cfg(feature = "files")]
fn from_file(file_name: &str, text: &str) -> Result<Description, String> {
    Ok(mozzi_urdf::parse(file_name, text).map_err(|error| error.to_string())?.description)
}

#[cfg(not(feature = "files"))]
fn from_file(file_name: &str, _: &str) -> Result<Description, String> {
    Err(format!("{file_name}: this build of mozzi-web reads JSON only, expected a name that ends in .json"))
}
