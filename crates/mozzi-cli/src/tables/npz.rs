//! NumPy's .npz: a zip of .npy, each called after its array.

use super::array::Array;
use super::npy;
use super::precision::Precision;
use crate::failure::{Failure, Result};
use crate::interrupt::Writing;
use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

/// All arrays.
pub fn read(file: &str) -> Result<Vec<Array>> {
    let cannot = |error: &dyn std::fmt::Display| Failure::wrong(format!("{file} cannot be read: {error}"));
    let reader = BufReader::new(File::open(file).map_err(|error| cannot(&error))?);
    let mut archive = ZipArchive::new(reader).map_err(|error| cannot(&error))?;
    let mut arrays = Vec::new();
    for index in 0..archive.len() {
        let mut entry = archive.by_index(index).map_err(|error| cannot(&error))?;
        let name = entry.name().map_err(|error| cannot(&error))?.to_string();
        let mut bytes = Vec::new();
        entry.read_to_end(&mut bytes).map_err(|error| cannot(&error))?;
        let name = name.trim_end_matches(".npy");
        arrays.push(npy::parse(&format_args!("{file}: `{name}`"), name, &bytes)?);
    }
    Ok(arrays)
}

/// Not compressed, as `numpy.savez` writes arrays.
pub fn stored() -> SimpleFileOptions {
    SimpleFileOptions::default().compression_method(CompressionMethod::Stored).large_file(true)
}

/// As `numpy.savez` writes it.
pub fn write<T: Precision>(file: &str, arrays: &[Array<T>]) -> Result<()> {
    let cannot = |error: &dyn std::fmt::Display| Failure::wrong(format!("{file} cannot be written: {error}"));
    let _writing = Writing::to(file);
    let writer = BufWriter::new(File::create(file).map_err(|error| cannot(&error))?);
    let mut archive = ZipWriter::new(writer);
    for array in arrays {
        archive.start_file(format!("{}.npy", array.name), stored()).map_err(|error| cannot(&error))?;
        let bytes = npy::bytes(&array.shape, &array.values);
        archive.write_all(&bytes).map_err(|error| cannot(&error))?;
    }
    let mut writer = archive.finish().map_err(|error| cannot(&error))?;
    writer.flush().map_err(|error| cannot(&error))
}
