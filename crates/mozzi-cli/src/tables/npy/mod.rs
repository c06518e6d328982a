//! NumPy's .npy: a header, then numbers. A structured array has named columns.

mod header;
mod kind;

pub use header::Header;

use header::NO_MAGIC;

use super::array::{Array, tuple};
use super::precision::Precision;
use crate::failure::{Failure, Result};
use std::fmt::Display;
use std::io::Read;

/// Bytes that are read at a time.
const CHUNK: usize = 1 << 16;

/// The header of a file, or of an archive's array; `place` is its name in messages.
pub fn header(place: &dyn Display, from: &mut dyn Read) -> Result<Header> {
    Header::read(from).map_err(|what| match what.as_str() {
        NO_MAGIC => Failure::wrong(format!("{place} is not a .npy file: {what}")),
        _ => unreadable(place, &what),
    })
}

/// A .npy file that is cut off, or of another kind than those that are read.
fn unreadable(place: &dyn Display, what: &str) -> Failure {
    Failure::wrong(format!("{place} cannot be read as .npy: {what}"))
}

/// The numbers after a header, by rows; nothing may follow them. `length` is the number of bytes there, if known.
pub fn numbers(place: &dyn Display, header: &Header, length: Option<u64>, from: &mut dyn Read) -> Result<Vec<f64>> {
    let wrong = |what: &str| unreadable(place, what);
    let other = |found: &dyn Display| {
        let shape = tuple(&header.shape);
        wrong(&format!("there are {found} bytes of numbers, expected those of shape {shape}"))
    };
    let size = header.size();
    let all = header.shape.iter().try_fold(size, |product, &count| product.checked_mul(count));
    let Some(all) = all.filter(|&all| length.is_none_or(|length| length == all as u64)) else {
        return Err(length.map_or_else(|| other(&"fewer"), |length| other(&length)));
    };
    let mut values = Vec::new();
    if length.is_some() {
        values.reserve_exact(all / size * header.fields.len());
    }
    let (mut chunk, mut read) = (Vec::new(), 0);
    while read < all {
        chunk.clear();
        let these = (CHUNK.max(size) / size * size).min(all - read);
        from.take(these as u64).read_to_end(&mut chunk).map_err(|error| wrong(&error.to_string()))?;
        if chunk.len() < these {
            return Err(other(&(read + chunk.len())));
        }
        for entry in chunk.chunks_exact(size) {
            let mut rest = entry;
            for (name, kind) in &header.fields {
                let (bytes, after) = rest.split_at(kind.size);
                let at = values.len() / header.fields.len();
                let number = kind.number(bytes).map_err(|what| {
                    let column = if name.is_empty() { String::new() } else { format!(" of `{name}`") };
                    Failure::wrong(format!("{place}: entry {at}{column} (counted from 0): {what}"))
                })?;
                values.push(number);
                rest = after;
            }
        }
        read += these;
    }
    if from.take(1).read_to_end(&mut chunk).map_err(|error| wrong(&error.to_string()))? > 0 {
        return Err(other(&"more"));
    }
    let is_turned = header.by_columns && header.shape.len() > 1;
    Ok(if is_turned { by_rows(&header.shape, &values) } else { values })
}

/// Reorders numbers whose first index varies fastest, so that the last index varies fastest.
fn by_rows(shape: &[usize], values: &[f64]) -> Vec<f64> {
    let at = |mut place: usize| {
        let (mut source, mut stride) = (0, values.len());
        for &count in shape.iter().rev() {
            stride /= count;
            source += place % count * stride;
            place /= count;
        }
        values[source]
    };
    (0..values.len()).map(at).collect()
}

/// The bytes before the numbers of a plain array.
pub fn plain_header<T: Precision>(shape: &[usize]) -> Vec<u8> {
    header::write(&format!("'<f{}'", size_of::<T>()), shape.first().copied(), &tuple(shape))
}

/// The bytes before rows of float64 in named columns.
pub fn structured_header(names: &[String], rows: usize) -> Vec<u8> {
    let fields: Vec<String> = names.iter().map(|name| format!("({}, '<f8')", header::quoted(name))).collect();
    header::write(&format!("[{}]", fields.join(", ")), Some(rows), &tuple(&[rows]))
}

/// The whole file.
pub fn bytes<T: Precision>(array: &Array<T>) -> Vec<u8> {
    let mut bytes = plain_header::<T>(&array.shape);
    bytes.reserve(size_of_val(&*array.values));
    array.values.iter().for_each(|x| x.write(&mut bytes));
    bytes
}

#[cfg(test)]
mod tests;
