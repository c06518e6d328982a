//! Errors of loading a robot.

use crate::embedded;
use crate::report::diagnostic::Diagnostic;
use crate::report::spelling::did_you_mean;
use crate::report::visible::visible;
use mozzi::model::Severity;
use std::fmt;
use std::path::PathBuf;

/// More diagnostics are counted, not printed.
pub(crate) const PRINTED: usize = 20;

/// Errors of loading a robot. Displays as one line per error; [`pretty`](Self::pretty) shows the places.
#[derive(Debug)]
#[non_exhaustive]
pub enum LoadError {
    /// The file cannot be read.
    File {
        /// The path of the file.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// Neither an embedded robot nor a file.
    NoSuchRobot {
        /// The requested name.
        name: String,
    },
    /// The file has errors.
    Refused {
        /// Its name.
        file: String,
        /// Errors in the order of the file, then warnings by consequence, then unused content; at most a thousand
        /// errors and a thousand others.
        diagnostics: Vec<Diagnostic>,
        /// Whether reading stopped after a thousand errors.
        is_cut: bool,
    },
    /// The model could not be built from an accepted description.
    Build(mozzi::Error),
}

impl LoadError {
    /// Errors in the order of the file, then warnings by consequence, then unused content; empty if no file was read.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match self {
            LoadError::Refused { diagnostics, .. } => diagnostics,
            _ => &[],
        }
    }

    /// The errors among them.
    pub fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics().iter().filter(|diagnostic| diagnostic.severity() == Severity::Error)
    }

    pub(crate) fn more(&self) -> usize {
        self.errors().count().saturating_sub(PRINTED)
    }

    /// "robot.urdf is refused: 3 errors"
    pub(crate) fn headline(&self) -> String {
        visible(&self.sentence())
    }

    fn sentence(&self) -> String {
        match self {
            LoadError::File { path, source } => format!("{} cannot be read: {source}", path.display()),
            LoadError::NoSuchRobot { name } => {
                let known: Vec<&str> = embedded::names().collect();
                let list = crate::urdf::vocabulary::list(&known);
                let near = did_you_mean(name.trim_start_matches("./").trim_end_matches(".urdf"), known.iter().copied());
                let near = near.map(|near| format!("; {near}")).unwrap_or_default();
                format!("`{name}` is neither a file nor one of the embedded robots {list}{near}")
            }
            LoadError::Refused { file, is_cut, .. } => match self.errors().count() {
                1 => format!("{file} is refused: 1 error"),
                n if *is_cut => format!("{file} is refused: more than {n} errors"),
                n => format!("{file} is refused: {n} errors"),
            },
            LoadError::Build(error) => error.to_string(),
        }
    }
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.headline())?;
        for diagnostic in self.errors().take(PRINTED) {
            write!(f, "\n{diagnostic}")?;
        }
        match self.more() {
            0 => Ok(()),
            more => write!(f, "\nand {more} more"),
        }
    }
}

impl std::error::Error for LoadError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            LoadError::File { source, .. } => Some(source),
            LoadError::Build(error) => Some(error),
            _ => None,
        }
    }
}

impl From<mozzi::Error> for LoadError {
    fn from(error: mozzi::Error) -> Self {
        LoadError::Build(error)
    }
}
