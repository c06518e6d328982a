//! NumPy's .npz: a zip of .npy, each named after its array.

use super::array::Array;
use super::bound::{Unpacked, caught};
use super::npy::{self, Header};
use super::precision::Precision;
use crate::failure::{Failure, Result};
use crate::input::cannot;
use crate::output::Output;
use mozzi_urdf::files;
use std::io::{BufReader, BufWriter, Write};
use std::path::Path;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

/// All arrays. The name and shape of each array are checked before its numbers are read.
pub fn read(file: &str, mut accept: impl FnMut(&str, &Header) -> Result<()>) -> Result<Vec<Array>> {
    caught(file, || {
        let cannot = |error: &dyn std::fmt::Display| cannot(file, error);
        let opened = files::open(Path::new(file)).map_err(|error| cannot(&error))?;
        let length = opened.metadata().map_err(|error| cannot(&error))?.len();
        let mut archive = ZipArchive::new(BufReader::new(opened)).map_err(|error| cannot(&error))?;
        let (mut unpacked, mut stored, mut arrays) = (Unpacked::of(length), length, Vec::<Array>::new());
        for index in 0..archive.len() {
            let mut entry = archive.by_index(index).map_err(|error| cannot(&error))?;
            let name = entry.name().map_err(|error| cannot(&error))?.trim_end_matches(".npy").to_string();
            let place = format!("{file}: `{name}`");
            if arrays.iter().any(|array| array.name == name) {
                return Err(Failure::wrong(format!("{file} has two arrays `{name}`, expected one")));
            }
            let header = npy::header(&place, &mut entry)?;
            accept(&name, &header)?;
            let bytes = header.shape.iter().fold(header.size() as u64, |all, &count| all.saturating_mul(count as u64));
            match entry.compression() {
                // entries of a valid archive do not share bytes
                CompressionMethod::Stored => {
                    stored = stored.checked_sub(bytes).ok_or_else(|| cannot(&"its arrays are larger than it"))?;
                }
                _ => unpacked.take(bytes).map_err(|why| cannot(&why))?,
            }
            let values = npy::numbers(&place, &header, None, &mut entry)?;
            arrays.push(Array { name, shape: header.shape, values });
        }
        Ok(arrays)
    })
}

/// The number of positions of a state, by the shape of `theta`; 0 without it.
pub fn positions(file: &str) -> Result<usize> {
    caught(file, || {
        let opened = files::open(Path::new(file)).map_err(|error| cannot(file, &error))?;
        let mut archive = ZipArchive::new(BufReader::new(opened)).map_err(|error| cannot(file, &error))?;
        let Ok(mut theta) = archive.by_name("theta.npy") else { return Ok(0) };
        let header = npy::header(&format!("{file}: `theta`"), &mut theta)?;
        Ok(header.shape.get(1).copied().unwrap_or(0))
    })
}

/// Not compressed, as `numpy.savez` writes arrays.
pub fn stored() -> SimpleFileOptions {
    SimpleFileOptions::default().compression_method(CompressionMethod::Stored).large_file(true)
}

/// As `numpy.savez` writes it.
pub fn write<T: Precision>(file: &str, arrays: &[Array<T>]) -> Result<()> {
    Output::create(file)?.write(|to| {
        let mut archive = ZipWriter::new(BufWriter::new(to));
        for array in arrays {
            archive.start_file(format!("{}.npy", array.name), stored())?;
            archive.write_all(&npy::bytes(array))?;
        }
        archive.finish()?.flush()
    })
}
