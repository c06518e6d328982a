//! The format of the file of a table or a motion, by its ending.

use crate::failure::{Failure, Result};
use crate::quantity::hyphenated;
use mozzi::quantities::Query;
use std::path::Path;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Csv,
    /// One array; for a motion, and if columns have names, a structured one.
    Npy,
    /// Arrays by name, (N,) and (N, n).
    Npz,
    /// Arrow's IPC file, which is Feather's second version.
    Arrow,
    Parquet,
    /// ROS 2's joint states and transforms, which Foxglove and Rerun show.
    Mcap,
}

use Format::{Arrow, Csv, Mcap, Npy, Npz, Parquet};

/// Output formats for motions.
pub const MOTION: [Format; 6] = [Csv, Npy, Npz, Arrow, Parquet, Mcap];
/// Input formats for tables.
pub const TABLE: [Format; 5] = [Csv, Npy, Npz, Arrow, Parquet];
/// Output formats for results.
const RESULT: [Format; 4] = [Csv, Npy, Npz, Arrow];

impl Format {
    fn endings(self) -> &'static [&'static str] {
        match self {
            Csv => &["csv"],
            Npy => &["npy"],
            Npz => &["npz"],
            Arrow => &["arrow", "feather", "ipc"],
            Parquet => &["parquet"],
            Mcap => &["mcap"],
        }
    }

    /// The format of the file's ending, one of these; "-" is CSV in a pipe.
    pub fn of(file: &str, expected: &[Format]) -> Result<Self> {
        match Self::known(file, expected)? {
            Some(format) => Ok(format),
            None => {
                let endings: Vec<String> =
                    expected.iter().flat_map(|format| format.endings()).map(|ending| format!(".{ending}")).collect();
                let (last, others) =
                    endings.split_last().map_or(("", &[][..]), |(last, others)| (last.as_str(), others));
                let endings = format!("{} or {last}", others.join(", "));
                Err(Failure::wrong(format!("{file}: expected a name that ends in {endings}")))
            }
        }
    }

    /// The format of an input table: a file with any other ending, such as a pipe, is CSV.
    pub fn of_input(file: &str) -> Result<Self> {
        Ok(Self::known(file, &TABLE)?.unwrap_or(Csv))
    }

    /// Checks the name of a CSV output: another ending would mislead its readers.
    pub fn check_csv(file: &str) -> Result<()> {
        let is_text =
            Path::new(file).extension().is_none_or(|ending| ["txt", "dat"].iter().any(|text| ending == *text));
        match Self::known(file, &MOTION) {
            Ok(Some(Csv)) => Ok(()),
            Ok(None) if is_text => Ok(()),
            _ => Err(Failure::wrong(format!("{file}: only CSV is written here, expected a name that ends in .csv"))),
        }
    }

    fn known(file: &str, expected: &[Format]) -> Result<Option<Self>> {
        if file == "-" {
            return Ok(Some(Csv));
        }
        let ending = Path::new(file).extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let is_of = |format: &&Format| ending.as_deref().is_some_and(|ending| format.endings().contains(&ending));
        let found = expected.iter().find(is_of).copied();
        match found.and_then(Self::missing) {
            Some(feature) => Err(Failure::wrong(format!(
                "{file}: this program was built without the feature `{feature}`; .npz and .csv work, or build it with: \
                 cargo install --path crates/mozzi-cli --features {feature}"
            ))),
            None => Ok(found),
        }
    }

    /// The feature that this format needs, if this build is without it.
    fn missing(self) -> Option<&'static str> {
        let (is_there, feature) = match self {
            Csv | Npy | Npz => return None,
            Arrow => (cfg!(feature = "arrow"), "arrow"),
            Parquet => (cfg!(feature = "parquet"), "parquet"),
            Mcap => (cfg!(feature = "mcap"), "mcap"),
        };
        (!is_there).then_some(feature)
    }

    /// The format of a file for the results of this quantity.
    pub fn of_results(file: &str, query: Query) -> Result<Self> {
        let format = Self::of(file, &RESULT)?;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_tells_the_format() {
        let of = |file| Format::of(file, &MOTION).ok();
        assert_eq!((of("a/b.CSV"), of("-"), of("x.npz")), (Some(Csv), Some(Csv), Some(Npz)));
        for (file, format, is_built, feature) in [
            ("x.feather", Arrow, cfg!(feature = "arrow"), "arrow"),
            ("x.mcap", Mcap, cfg!(feature = "mcap"), "mcap"),
            ("x.parquet", Parquet, cfg!(feature = "parquet"), "parquet"),
        ] {
            match Format::of(file, &MOTION) {
                Ok(found) => assert!(is_built && found == format),
                Err(Failure::Wrong(said)) => assert!(
                    !is_built
                        && said.contains(&format!("{file}: this program was built without the feature `{feature}`"))
                        && said.contains(".npz and .csv work")
                        && said.ends_with(&format!("--features {feature}")),
                    "{said}"
                ),
                Err(_) => panic!("{file}: another error"),
            }
        }
        let said = |file, among: &[Format]| format!("{:?}", Format::of(file, among).expect_err("unknown"));
        assert!(said("motion.txt", &MOTION).contains("motion.txt: expected a name that ends in .csv, .npy"));
        assert!(said("x.mcap", &RESULT).contains(".csv, .npy, .npz, .arrow, .feather or .ipc"));
        assert!(Format::check_csv("way.npy").is_err() && Format::check_csv("way.txt").is_ok());
        assert_eq!((Format::of_input("/dev/fd/63").ok(), Format::of_input("x.npy").ok()), (Some(Csv), Some(Npy)));
    }
}
