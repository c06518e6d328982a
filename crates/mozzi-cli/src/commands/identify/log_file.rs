//! A log of any format.

use super::joint_states::is_bag;
use super::names::{Column, assign, frame_of};
use crate::csv;
use crate::failure::{self, Failure, Result};
use crate::input;
use crate::tables::format::Format;
use crate::tables::read;
use mozzi::Model;
use mozzi_identify::Log;

/// Reads a log: CSV with names in the usual ways, other formats with mozzi's names, MCAP and rosbag2 with `JointState`
/// messages.
pub fn read_log(file: &str, model: &Model, order: &[String]) -> Result<Log> {
    if is_bag(file) {
        return of_messages(file, model, order);
    }
    match Format::of_input(file)? {
        Format::Npy | Format::Npz | Format::Arrow => of_samples(file, model),
        #[cfg(feature = "parquet")]
        Format::Parquet => of_samples(file, model),
        _ => of_csv(file, model, order),
    }
}

/// Columns with mozzi's names.
fn of_samples(file: &str, model: &Model) -> Result<Log> {
    let mut samples = read::read(file, model)?;
    let (t, theta, tau) =
        (samples.times()?.to_vec(), samples.need("theta", model)?.to_vec(), samples.need("tau", model)?.to_vec());
    let (dtheta, ddtheta) = (samples.tables.remove("dtheta"), samples.tables.remove("ddtheta"));
    let wrenches = samples.tables.into_iter().filter(|(name, _)| name == "wrench" || name.starts_with("wrench_"));
    let wrenches = wrenches.map(|(name, table)| Ok((frame_of(file, &name, model)?, table))).collect::<Result<_>>()?;
    Ok(Log { name: file.to_string(), t, theta, dtheta, ddtheta, tau, wrenches, ..Log::default() })
}

/// Rows of numbers with names; empty cells are NaN.
fn of_csv(file: &str, model: &Model, order: &[String]) -> Result<Log> {
    let name = input::name(file);
    let (mut reader, header) = csv::open(file)?;
    let mut rows: Vec<f64> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| csv::csv_failure(name, &error))?;
        let line = record.position().map_or(0, |position| position.line());
        for (k, cell) in record.iter().enumerate() {
            let value = match cell.trim() {
                "" => f64::NAN,
                text => text.parse().or_else(|_| {
                    // text in a column that is not used is no error
                    match used(&header[k]) {
                        true => Err(Failure::wrong(format!(
                            "{name}:{line}: column {} (`{}`) is `{text}`, expected a number",
                            k + 1,
                            header[k]
                        ))),
                        false => Ok(f64::NAN),
                    }
                })?,
            };
            rows.push(value);
        }
    }
    table(name, &header, &rows, model, order)
}

/// Whether a column may matter.
fn used(name: &str) -> bool {
    !["mode", "state", "method", "frame", "status", "label"].iter().any(|word| name.to_lowercase().contains(word))
}

/// A log from rows and the names of their columns.
fn table(name: &str, header: &[String], rows: &[f64], model: &Model, order: &[String]) -> Result<Log> {
    let found = assign(name, header, model, order)?;
    found.notes.iter().for_each(|note| failure::note(note));
    let rows = rows.chunks_exact(header.len().max(1));
    let gather = |columns: &[Column]| -> Vec<f64> {
        rows.clone().flat_map(|row| columns.iter().map(move |(column, factor)| row[*column] * factor)).collect()
    };
    let tau = rows.clone().flat_map(|row| {
        found.tau.iter().map(move |column| column.map_or(0.0, |(column, factor)| row[column] * factor))
    });
    let first = rows.clone().next().map_or(0.0, |row| row[found.t.0]);
    Ok(Log {
        name: name.to_string(),
        // from the first row: nanoseconds since 1970 lose digits otherwise
        t: rows.clone().map(|row| (row[found.t.0] - first) * found.t.1).collect(),
        theta: gather(&found.theta),
        dtheta: found.dtheta.as_deref().map(gather),
        ddtheta: found.ddtheta.as_deref().map(gather),
        tau: tau.collect(),
        wrenches: found
            .wrenches
            .iter()
            .map(|(frame, columns)| (*frame, gather(&columns.map(|column| (column, 1.0)))))
            .collect(),
        ..Log::default()
    })
}

fn of_messages(file: &str, model: &Model, order: &[String]) -> Result<Log> {
    let (header, rows) = super::joint_states::read(file)?;
    table(file, &header, &rows, model, order)
}
