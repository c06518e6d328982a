//! Why nothing is compared.

use std::path::PathBuf;

/// Why nothing is compared.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// mozzi does not build the robot, or compute of it.
    #[error(transparent)]
    Robot(#[from] mozzi::Error),
    /// The file is not there for the libraries.
    #[error("{file} cannot be read: {error}")]
    Read {
        /// The file, as it was named.
        file: String,
        /// What the system says.
        error: std::io::Error,
    },
    /// No file that the libraries read says what this robot is.
    #[error("{robot} cannot be given to other libraries: {error}")]
    Write {
        /// The robot.
        robot: String,
        /// What URDF has no words for.
        error: mozzi_urdf::NotUrdf,
    },
    /// This Python does not start.
    #[error("Python `{}` did not start: {error}; name one that has pin or mujoco", python.display())]
    Python {
        /// The program.
        python: PathBuf,
        /// What the system says.
        error: std::io::Error,
    },
    /// No library answered.
    #[error("`{}` has no library to compare with: {reasons}; `pip install pin mujoco` gives it both", python.display())]
    NoLibrary {
        /// The program.
        python: PathBuf,
        /// Why, of each.
        reasons: String,
    },
}
