//! A motion as a file, in the format that its name asks for.

#[cfg(feature = "mcap")]
mod cdr;
#[cfg(feature = "mcap")]
mod mcap;
#[cfg(feature = "mcap")]
mod ros;

use crate::columns::{Columns, save};
use crate::commands::simulate_page::{columns, energies};
use crate::csv::ENERGIES;
use crate::failure::{Failure, Result};
#[cfg(feature = "parquet")]
use crate::interrupt::Writing;
use crate::tables::array::Array;
use crate::tables::{arrow, npy, npz};
use mozzi::{Model, Trajectory};
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

pub fn write(file: &str, model: &Model, motion: &Trajectory) -> Result<()> {
    let table = || columns(model, motion);
    match Format::of(file)? {
        Format::Csv => save(file, table().text()),
        Format::Npy => save(file, matrix(table())),
        Format::Npz => npz::write(file, &arrays(motion)),
        Format::Arrow => arrow::write(file, table().into_pairs()),
        Format::Parquet => parquet(file, table()),
        Format::Mcap => mcap(file, model, motion),
    }
}

fn matrix(table: Columns) -> Vec<u8> {
    let (rows, columns) = (table.rows(), table.into_pairs());
    let values: Vec<f64> = (0..rows).flat_map(|row| columns.iter().map(move |(_, column)| column[row])).collect();
    npy::bytes(&[rows, columns.len()], &values)
}

fn arrays(motion: &Trajectory) -> Vec<Array> {
    let rows = motion.len();
    let list = |name, values| Array::new(name, vec![rows], values);
    let table = |name, width, values: &[f64]| Array::new(name, vec![rows, width], values.to_vec());
    let mut arrays = vec![
        list("t", motion.t.clone()),
        table("theta", motion.nq, &motion.theta),
        table("dtheta", motion.n, &motion.dtheta),
        table("ddtheta", motion.n, &motion.ddtheta),
        table("tau", motion.n, &motion.tau),
    ];
    arrays.extend(ENERGIES.into_iter().zip(energies(motion)).map(|(name, values)| list(name, values)));
    arrays
}

#[cfg(feature = "parquet")]
fn parquet(file: &str, table: Columns) -> Result<()> {
    let cannot = |error: &dyn std::fmt::Display| Failure::wrong(format!("{file} cannot be written: {error}"));
    let rows = arrow::batch(table.into_pairs()).map_err(|error| cannot(&error))?;
    let _writing = Writing::to(file);
    let to = std::fs::File::create(file).map_err(|error| cannot(&error))?;
    let mut writer = ::parquet::arrow::ArrowWriter::try_new(to, rows.schema(), None).map_err(|error| cannot(&error))?;
    writer.write(&rows).map_err(|error| cannot(&error))?;
    writer.close().map(|_| ()).map_err(|error| cannot(&error))
}

#[cfg(not(feature = "parquet"))]
fn parquet(file: &str, _: Columns) -> Result<()> {
    Format::of(file).map(|_| ())
}

#[cfg(feature = "mcap")]
use mcap::write as mcap;

#[cfg(not(feature = "mcap"))]
fn mcap(file: &str, _: &Model, _: &Trajectory) -> Result<()> {
    Format::of(file).map(|_| ())
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
