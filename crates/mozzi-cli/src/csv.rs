//! Tables of numbers in CSV files: one row for each time, columns by name.
//!
//! A column is `t` (seconds), or `theta_…`, `dtheta_…`, `ddtheta_…`, `tau_…`, `x_…` with the number of an entry, from 1,
//! or its name (a joint's, or `base.qw` … `base.z` and `base.wx` … `base.vz` of a floating base), or `m_x m_y m_z
//! f_x f_y f_z` of the tip's wrench. Of each group all columns are there or none, in any order; the six of a floating
//! base's wrench may be left out alone, and are then 0: no motor drives it.

use crate::columns;
use crate::failure::{Failure, Result};
use crate::numbers::{WRENCH, number};
use crate::progress::Progress;
use crate::tables::samples::Samples;
use mozzi::Freedom;
use mozzi::Model;
use mozzi::quantities::INPUTS;
use std::cell::Cell;
use std::io::Read;

/// Columns that `mozzi simulate` writes in addition to the groups; read and not used.
pub const ENERGIES: [&str; 5] = ["kinetic_energy", "potential_energy", "motor_work", "friction_loss", "applied_work"];

/// The groups of columns: the inputs of quantities.
pub const GROUPS: [&str; INPUTS.len()] = {
    let mut names = [""; INPUTS.len()];
    let mut k = 0;
    while k < names.len() {
        names[k] = INPUTS[k].name;
        k += 1;
    }
    names
};

/// Reads a file, or standard input for `-`.
pub fn read(file: &str, model: &Model) -> Result<Samples> {
    read_by(file, |_| model)
}

/// As of a robot or, where the header has as many positions as joints, as of the same robot on a fixed base. Was it
/// that?
pub fn read_joints(file: &str, model: &Model, fixed: &Model) -> Result<(Samples, bool)> {
    let is_of_joints = Cell::new(false);
    let choose = |header: &[String]| {
        let positions = header.iter().filter(|name| name.starts_with("theta_")).count();
        is_of_joints.set(positions == fixed.nq() && !header.iter().any(|name| name.starts_with("theta_base.")));
        if is_of_joints.get() { fixed } else { model }
    };
    Ok((read_by(file, choose)?, is_of_joints.get()))
}

/// The robot is chosen by the header.
fn read_by<'m>(file: &str, choose: impl FnOnce(&[String]) -> &'m Model) -> Result<Samples> {
    let cannot = |error: std::io::Error| Failure::wrong(format!("{file} cannot be read: {error}"));
    let input: Box<dyn Read> = match file {
        "-" => Box::new(std::io::stdin().lock()),
        path => Box::new(std::fs::File::open(path).map_err(cannot)?),
    };
    let name = if file == "-" { "standard input" } else { file };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(input);
    let header: Vec<String> = match reader.headers() {
        Ok(header) => header.iter().map(|cell| cell.trim_start_matches('\u{feff}').to_string()).collect(),
        Err(error) => return Err(csv_failure(name, &error)),
    };
    let places = Places::find(&format!("{name}:1"), &header, choose(&header))?;
    let (mut lines, mut rows): (Vec<u64>, Vec<Vec<f64>>) = Default::default();
    let kilobytes = std::fs::metadata(file).map_or(0, |found| found.len() / 1000) as usize;
    let progress = Progress::new("reading", kilobytes, "kB");
    for record in reader.records() {
        let record = record.map_err(|error| csv_failure(name, &error))?;
        let line = record.position().map_or(0, |position| position.line());
        progress.at(record.position().map_or(0, |position| position.byte() / 1000) as usize);
        let mut row = vec![0.0; header.len()];
        for column in places.all() {
            let place = format!("{name}:{line}: column {} (`{}`)", column + 1, header[column]);
            row[column] = number(place, record.get(column).unwrap_or_default())?;
        }
        rows.push(row);
        lines.push(line);
    }
    if rows.is_empty() {
        return Err(Failure::wrong(format!("{name} has no rows below its header")));
    }
    Ok(Samples { lines, ..places.samples(name, rows.len(), |row, column| rows[row][column]) })
}

/// Which column is what.
pub struct Places {
    t: Option<usize>,
    /// As [`GROUPS`]. None of an entry: its column was left out, and it is 0.
    groups: [Option<Vec<Option<usize>>>; GROUPS.len()],
    wrench: Option<[usize; 6]>,
}

impl Places {
    /// The place is the header's: "table.csv:1".
    pub fn find(place: &str, header: &[String], model: &Model) -> Result<Self> {
        let names = |group: &str| -> Vec<&str> {
            if group == "theta" { model.position_names().collect() } else { model.velocity_names().collect() }
        };
        let names = GROUPS.map(names);
        let mut groups: [Vec<Option<usize>>; GROUPS.len()] = names.each_ref().map(|names| vec![None; names.len()]);
        let (mut t, mut wrench) = ([None], [None; 6]);
        for (column, name) in header.iter().enumerate() {
            let entry: Option<&mut Option<usize>> = if name == "t" {
                t.first_mut()
            } else if let Some(k) = WRENCH.iter().position(|known| known == name) {
                wrench.get_mut(k)
            } else if ENERGIES.contains(&name.as_str()) || name == "method" {
                continue;
            } else {
                GROUPS.iter().zip(&names).zip(&mut groups).find_map(|((group, names), places)| {
                    let joint = name.strip_prefix(group)?.strip_prefix('_')?;
                    let by_number = joint.parse::<usize>().ok().and_then(|j| j.checked_sub(1));
                    places.get_mut(names.iter().position(|known| *known == joint).or(by_number)?)
                })
            };
            let Some(entry) = entry else {
                return Err(Failure::wrong(format!(
                    "{place}: column {} is called `{name}`, expected t, {}, or {}, with {}",
                    column + 1,
                    GROUPS.map(|group| format!("{group}_1 …")).join(", "),
                    WRENCH.join(" "),
                    entries(model)
                )));
            };
            if let Some(first) = entry.replace(column) {
                let (first, second) = (first + 1, column + 1);
                return Err(Failure::wrong(format!("{place}: columns {first} and {second} both give `{name}`")));
            }
        }
        let missing = |name: &str, of: usize, found: usize| {
            Failure::wrong(format!(
                "{place}: column {name} is missing; the file has {found} of the {of} columns of its group"
            ))
        };
        let mut found = [const { None }; GROUPS.len()];
        for ((found, group), places) in found.iter_mut().zip(GROUPS).zip(groups) {
            let optional = if group == "tau" { model.base().velocities() } else { 0 };
            let count = places.iter().flatten().count();
            let is_whole = places.iter().skip(optional).all(Option::is_some);
            let base = places.iter().take(optional).flatten().count();
            if count > 0 && is_whole && (base == 0 || base == optional) {
                *found = Some(places);
            } else if count > 0 {
                let first = if base == 0 { optional } else { 0 };
                let at = (first..places.len()).find(|&k| places[k].is_none()).unwrap_or(0);
                return Err(missing(&columns::names(model, group)[at], places.len(), count));
            }
        }
        let columns: Vec<usize> = wrench.iter().flatten().copied().collect();
        let wrench = match wrench.iter().position(Option::is_none) {
            Some(k) if !columns.is_empty() => return Err(missing(WRENCH[k], WRENCH.len(), columns.len())),
            Some(_) => None,
            None => columns.try_into().ok(),
        };
        Ok(Places { t: t[0], groups: found, wrench })
    }

    /// What the columns hold, by the number in a row and a column.
    pub fn samples(&self, file: &str, count: usize, number: impl Fn(usize, usize) -> f64) -> Samples {
        let table = |columns: &[Option<usize>]| -> Vec<f64> {
            let entry = |row: usize, column: &Option<usize>| column.map_or(0.0, |column| number(row, column));
            (0..count)
                .flat_map(|row| columns.iter().map(move |column| (row, column)))
                .map(|(r, c)| entry(r, c))
                .collect()
        };
        let groups = GROUPS.into_iter().zip(&self.groups);
        let groups = groups.filter_map(|(name, columns)| Some((name, table(columns.as_ref()?))));
        let wrench = self.wrench.map(|columns| ("wrench", table(&columns.map(Some))));
        let tables = groups.chain(wrench).map(|(name, table)| (name.to_string(), table)).collect();
        let t = self.t.map(|column| table(&[Some(column)]));
        Samples { file: file.to_string(), count, t, tables, ..Samples::default() }
    }

    pub fn all(&self) -> impl Iterator<Item = usize> {
        let groups = self.groups.iter().flatten().flatten().flatten();
        self.t.into_iter().chain(groups.copied()).chain(self.wrench.into_iter().flatten())
    }
}

/// How the columns of a group go on.
fn entries(model: &Model) -> String {
    let joints: Vec<&str> = model.joint_names().collect();
    if model.configuration_space().is_flat() {
        return format!("joints from 1 to {} or by name ({})", joints.len(), joints.join(", "));
    }
    let one: Vec<&str> = joints
        .iter()
        .zip(model.places())
        .filter(|(_, place)| place.freedom == Freedom::One)
        .map(|(name, _)| *name)
        .collect();
    let several = |names: &mut dyn Iterator<Item = &'_ str>| {
        names.filter(|name| !one.contains(name)).map(str::to_string).collect::<Vec<_>>().join(", ")
    };
    format!(
        "entries by number (theta from 1 to {}, the others from 1 to {}) or by name (theta: {}; the others: {}; joints: {})",
        model.nq(),
        model.n(),
        several(&mut model.position_names()),
        several(&mut model.velocity_names()),
        one.join(", ")
    )
}

pub fn csv_failure(file: &str, error: &csv::Error) -> Failure {
    match error.kind() {
        csv::ErrorKind::UnequalLengths { pos, expected_len, len } => {
            let line = pos.as_ref().map_or(0, csv::Position::line);
            let columns = if *len == 1 { "column" } else { "columns" };
            Failure::wrong(format!("{file}:{line}: {len} {columns}, expected {expected_len} as in the header"))
        }
        csv::ErrorKind::Utf8 { pos, err } => {
            let line = pos.as_ref().map_or(0, csv::Position::line);
            Failure::wrong(format!("{file}:{line}: column {} is not UTF-8 text", err.field() + 1))
        }
        _ => Failure::wrong(format!("{file}: {error}")),
    }
}
