//! What kind of file a motion goes to, by its ending.

use crate::failure::{Failure, Result};
use std::path::Path;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Csv,
    /// One array, its columns as of CSV.
    Npy,
    /// Arrays by name, (N,) and (N, n).
    Npz,
    Arrow,
    Parquet,
    /// ROS 2's joint states and transforms, which Foxglove and Rerun show.
    Mcap,
}

impl Format {
    /// By the file's ending; "-" is CSV.
    pub fn of(file: &str) -> Result<Self> {
        let ending = Path::new(file).extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let format = match ending.as_deref() {
            _ if file == "-" => Format::Csv,
            Some("csv") => Format::Csv,
            Some("npy") => Format::Npy,
            Some("npz") => Format::Npz,
            Some("arrow" | "feather" | "ipc") => Format::Arrow,
            Some("parquet") => Format::Parquet,
            Some("mcap") => Format::Mcap,
            _ => {
                let expected = ".csv, .npy, .npz, .arrow, .feather, .parquet or .mcap";
                return Err(Failure::wrong(format!("{file}: expected a name that ends in {expected}")));
            }
        };
        for (needs, is_there, feature) in
            [(Format::Parquet, cfg!(feature = "parquet"), "parquet"), (Format::Mcap, cfg!(feature = "mcap"), "mcap")]
        {
            if format == needs && !is_there {
                return Err(Failure::wrong(format!(
                    "{file}: this program was built without .{feature}: cargo install --path crates/mozzi-cli --features {feature}"
                )));
            }
        }
        Ok(format)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_tells_the_format() {
        assert_eq!(Format::of("a/b.CSV").ok(), Some(Format::Csv));
        assert_eq!(Format::of("-").ok(), Some(Format::Csv));
        assert_eq!(Format::of("x.feather").ok(), Some(Format::Arrow));
        let said = |file| format!("{:?}", Format::of(file).expect_err("unknown"));
        assert!(said("motion.txt").contains("motion.txt: expected a name that ends in .csv, .npy"));
        assert_eq!(Format::of("x.mcap").is_ok(), cfg!(feature = "mcap"));
        assert_eq!(Format::of("x.parquet").is_ok(), cfg!(feature = "parquet"));
    }
}
