//! What kind of file a table is, by its ending.

use crate::failure::{Failure, Result};
use crate::quantity::hyphenated;
use mozzi::quantities::Query;
use std::path::Path;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Npy,
    Npz,
    /// Arrow's IPC file, which is Feather's second version.
    Arrow,
    Csv,
}

impl Format {
    /// "-" is a pipe, of CSV.
    pub fn of(file: &str) -> Result<Self> {
        let ending = Path::new(file).extension().map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            _ if file == "-" => Ok(Format::Csv),
            Some("npy") => Ok(Format::Npy),
            Some("npz") => Ok(Format::Npz),
            Some("arrow" | "feather" | "ipc") => Ok(Format::Arrow),
            Some("csv") => Ok(Format::Csv),
            _ => Err(Failure::wrong(format!(
                "{file}: expected a name that ends in .npy, .npz, .arrow, .feather or .csv"
            ))),
        }
    }

    /// Of a file that is to hold this.
    pub fn of_results(file: &str, query: Query) -> Result<Self> {
        let format = Self::of(file)?;
        let names: Vec<&str> = query.declaration().outputs.iter().map(|output| output.name).collect();
        if format == Format::Npy && names.len() > 1 {
            return Err(Failure::wrong(format!(
                "{file} holds one array, and {} gives {}: {}; expected a name that ends in .npz, .arrow or .csv",
                hyphenated(query.name()),
                names.len(),
                names.join(", ")
            )));
        }
        Ok(format)
    }
}
