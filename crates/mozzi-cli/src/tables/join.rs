//! Joins columns that were logged at different times.

use crate::failure::{self, Failure, Result};
use crate::tables::samples::Samples;
use mozzi::Model;
use mozzi_urdf::counted;

/// A column with more cells empty than this share was logged at other times than the rest.
const SPARSE: f64 = 0.05;

/// Values are interpolated over at most this many steps of their own column.
const REACH: f64 = 3.0;

/// Removes tables and rows without numbers. If some columns were logged at other times, they are interpolated at the
/// times of the first position. `remedy` ends the error for a table without positions.
pub fn join(samples: &mut Samples, model: &Model, remedy: &str) -> Result<()> {
    let file = samples.file.clone();
    let is_empty = |table: &Vec<f64>| table.iter().all(|x| x.is_nan());
    for (name, what) in [("dtheta", "velocities"), ("ddtheta", "accelerations"), ("tau", "forces")] {
        if samples.tables.get(name).is_some_and(is_empty) {
            samples.tables.remove(name);
            failure::note(&format!("{file}: all {what} are empty or NaN, as if there were none"));
        }
    }
    let Some(t) = samples.t.clone() else { return Ok(()) };
    let N = samples.count;
    let width = |table: &[f64]| table.len() / N.max(1);
    let is_row = |row: usize| {
        t[row].is_finite()
            && samples.tables.values().any(|table| {
                let width = width(table);
                table[row * width..][..width].iter().any(|x| x.is_finite())
            })
    };
    let mut rows: Vec<usize> = (0..N).filter(|&row| is_row(row)).collect();
    if rows.is_empty() {
        let why = match samples.tables.contains_key("theta") {
            true => format!("{file} has no row with numbers of the robot's joints"),
            false => format!("{file}: no column is a position of the robot's joints, such as q1{remedy}"),
        };
        return Err(Failure::wrong(why));
    }
    let share = |table: &[f64], k: usize, rows: &[usize]| {
        let width = width(table);
        rows.iter().filter(|&&row| table[row * width + k].is_nan()).count() as f64 / rows.len() as f64
    };
    let mut is_sparse = samples.tables.values().any(|table| (0..width(table)).any(|k| share(table, k, &rows) > SPARSE));
    let is_other = N as f64 - rows.len() as f64 > SPARSE * N as f64;
    if is_other {
        failure::note(&format!(
            "{file}: {} of {N} rows have no number of the robot's joints and are left out",
            N - rows.len()
        ));
    }
    if is_sparse && samples.tables.contains_key("theta") {
        let (all, count) = (rows.clone(), rows.len());
        let theta = &samples.tables["theta"];
        let width_of_theta = model.nq().max(1);
        rows.retain(|&row| theta[row * width_of_theta].is_finite());
        let mut joined = 0;
        for table in samples.tables.values_mut() {
            let width = table.len() / N.max(1);
            for k in 0..width {
                joined += usize::from(interpolate(&t, table, (k, width), &all, &rows));
            }
        }
        if joined > 0 {
            failure::note(&format!(
                "{file}: numbers of {} at other times than the first position are interpolated at its {} of {count} rows",
                counted(joined, "column"),
                rows.len()
            ));
        } else {
            (rows, is_sparse) = (all, false);
        }
    }
    if rows.len() < N && (is_other || is_sparse) {
        samples.keep(&rows);
    }
    Ok(())
}

/// Fills a column's empty cells in `rows` from its neighbours among all rows; whether there were any to fill.
fn interpolate(t: &[f64], table: &mut [f64], (k, width): (usize, usize), all: &[usize], rows: &[usize]) -> bool {
    let known: Vec<(f64, f64)> =
        all.iter().map(|&row| (t[row], table[row * width + k])).filter(|(_, x)| x.is_finite()).collect();
    let mut steps: Vec<f64> = known.windows(2).map(|pair| pair[1].0 - pair[0].0).filter(|step| *step > 0.0).collect();
    steps.sort_unstable_by(f64::total_cmp);
    let Some(&step) = steps.get(steps.len() / 2) else { return false };
    let mut has_any = false;
    for &row in rows.iter().filter(|&&row| table[row * width + k].is_nan()).collect::<Vec<_>>() {
        has_any = true;
        let after = known.partition_point(|(time, _)| *time < t[row]);
        let Some(&(t1, x1)) = known.get(after) else { continue };
        if t1 == t[row] {
            table[row * width + k] = x1;
            continue;
        }
        let Some(&(t0, x0)) = after.checked_sub(1).and_then(|before| known.get(before)) else { continue };
        if t1 - t0 <= REACH * step && t1 > t0 {
            table[row * width + k] = x0 + (x1 - x0) * (t[row] - t0) / (t1 - t0);
        }
    }
    has_any
}
