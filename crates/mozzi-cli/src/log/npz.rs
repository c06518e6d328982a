//! NumPy's .npz, row by row: arrays by name, (N,) and (N, n). Each array is written to a temporary file next to the
//! archive until all rows are known.

use super::row::Group;
use super::{Row, Rows};
use crate::tables::npy::plain_header;
use crate::tables::npz::stored;
use mozzi_sim::Sample;
use std::fs::File;
use std::io::{BufReader, BufWriter, Result, Seek, SeekFrom, Write, copy};
use std::path::{Path, PathBuf};
use zip::ZipWriter;

pub struct Npz<'m> {
    columns: Row<'m>,
    to: File,
    parts: Vec<Part>,
    rows: usize,
}

/// One array.
struct Part {
    name: &'static str,
    columns: usize,
    is_vector: bool,
    path: PathBuf,
    numbers: BufWriter<File>,
}

impl Drop for Part {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.path); // it may be gone
    }
}

impl<'m> Npz<'m> {
    /// Writes to this file, which has this name.
    pub fn new(to: File, name: &str, columns: Row<'m>) -> Result<Self> {
        let part = |group: Group| {
            let path = Path::new(name).with_extension(format!("npz.{}.{}", std::process::id(), group.name));
            let file = File::options().read(true).write(true).create_new(true).open(&path)?;
            // if the system allows it, the file is unlinked now, and disappears however the program ends
            let _ = std::fs::remove_file(&path);
            let (columns, is_vector) = (group.columns.len(), group.is_vector);
            Ok(Part { name: group.name, columns, is_vector, path, numbers: BufWriter::new(file) })
        };
        let parts = columns.groups().into_iter().map(part).collect::<Result<_>>()?;
        Ok(Npz { columns, to, parts, rows: 0 })
    }
}

impl Rows for Npz<'_> {
    fn row(&mut self, row: &Sample) -> Result<()> {
        self.rows += 1;
        let mut numbers = self.columns.values(row);
        for part in &mut self.parts {
            for x in numbers.by_ref().take(part.columns) {
                part.numbers.write_all(&x.to_le_bytes())?;
            }
        }
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<()> {
        let Npz { to, parts, rows, .. } = *self;
        let mut archive = ZipWriter::new(BufWriter::new(to));
        for mut part in parts {
            archive.start_file(format!("{}.npy", part.name), stored())?;
            let shape = if part.is_vector { vec![rows, part.columns] } else { vec![rows] };
            archive.write_all(&plain_header::<f64>(&shape))?;
            part.numbers.flush()?;
            let numbers = part.numbers.get_mut();
            numbers.seek(SeekFrom::Start(0))?;
            let written = copy(&mut BufReader::new(numbers), &mut archive)?;
            let expected = (8 * rows * part.columns) as u64;
            if written != expected {
                let what = format!("{} has {written} bytes, expected {expected}", part.path.display());
                return Err(std::io::Error::other(what));
            }
        }
        archive.finish()?.flush()
    }
}
