//! Errors of a comparison.

use std::path::PathBuf;

/// Errors of a comparison.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// mozzi cannot build the robot, or cannot compute its dynamics.
    #[error(transparent)]
    Robot(#[from] mozzi::Error),
    /// The file cannot be read.
    #[error("{file} cannot be read: {error}")]
    Read {
        /// The file, as it was named.
        file: String,
        /// The system's error.
        error: std::io::Error,
    },
    /// The robot cannot be written in a format that the libraries read.
    #[error("{robot} cannot be given to other libraries: {error}")]
    Write {
        /// The robot.
        robot: String,
        /// The part that URDF cannot express.
        error: mozzi_urdf::NotUrdf,
    },
    /// Python cannot be started.
    #[error("Python `{}` did not start: {error}; name one that has pin or mujoco", python.display())]
    Python {
        /// The program.
        python: PathBuf,
        /// The system's error.
        error: std::io::Error,
    },
    /// No library returned results.
    #[error("`{}` has no library to compare with: {reasons}", python.display())]
    NoLibrary {
        /// The program.
        python: PathBuf,
        /// The reason for each library.
        reasons: String,
    },
}
