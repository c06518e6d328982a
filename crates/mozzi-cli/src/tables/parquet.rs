//! Parquet: columns by name, as in CSV tables.

use super::arrow;
use super::bound::{Unpacked, caught};
use super::samples::Samples;
use super::{How, recognised};
use crate::failure::Result;
use crate::input::cannot;
use mozzi::Model;
use mozzi_urdf::files;
use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use std::path::Path;

/// The robot is chosen by the columns' names.
pub fn read<'m>(file: &str, choose: &dyn Fn(&[String]) -> &'m Model, how: &How) -> Result<Samples> {
    caught(file, || {
        let opened = files::open(Path::new(file)).map_err(|error| cannot(file, &error))?;
        let length = opened.metadata().map_err(|error| cannot(file, &error))?.len();
        let builder = ParquetRecordBatchReaderBuilder::try_new(opened).map_err(|error| cannot(file, &error))?;
        let names: Vec<String> = builder.schema().fields().iter().map(|field| field.name().clone()).collect();
        let found = recognised(file, &names, choose(&names), how)?;
        let used = found.used(file)?;
        let groups = builder.metadata().row_groups().iter();
        let rows = groups.map(|group| u64::try_from(group.num_rows()).unwrap_or(u64::MAX)).fold(0, u64::saturating_add);
        let bytes = rows.saturating_mul(size_of::<f64>() as u64).saturating_mul(used.len() as u64);
        Unpacked::of(length).take(bytes).map_err(|why| cannot(file, &why))?;
        let mask = ProjectionMask::roots(builder.parquet_schema(), used.iter().copied());
        let reader = builder.with_projection(mask).build().map_err(|error| cannot(file, &error))?;
        arrow::columns(file, &names, &found, &used, how.may_miss, reader)
    })
}
