//! Assigns the columns of a table by their names.
//!
//! A column is `t` (seconds), or `theta_…`, `dtheta_…`, `ddtheta_…`, `tau_…`, `x_…`, `w_…` with the number of an entry,
//! from 1, or its name (a joint's, or `base.qw` … `base.z` and `base.wx` … `base.vz` of a floating base), or `m_x m_y
//! m_z f_x f_y f_z` of the tip's wrench. Each group must be complete or absent; the order is free. Only the six columns
//! of a floating base's wrench may be missing on their own, and are then 0: no motor drives it.

use crate::columns;
use crate::failure::{Failure, Result};
use crate::numbers::WRENCH;
use crate::tables::samples::Samples;
use mozzi::Freedom;
use mozzi::Model;
use mozzi::quantities::INPUTS;

/// Columns that `mozzi simulate` writes in addition to the groups; they are read but not used.
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

/// The meaning of the columns.
pub struct Places {
    t: Option<usize>,
    /// As [`GROUPS`]. An entry is None if its column is missing: it is then 0.
    groups: [Option<Vec<Option<usize>>>; GROUPS.len()],
    wrench: Option<[usize; 6]>,
}

impl Places {
    /// `place` is the header's: "table.csv:1".
    pub fn find(place: &str, header: &[String], model: &Model) -> Result<Self> {
        let names = GROUPS.map(|group| columns::entries(model, group));
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

    /// The contents of the columns; `number` takes a row and a column.
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

    /// The columns that are used, in order; a file without any is an error.
    pub fn used(&self, file: &str) -> Result<Vec<usize>> {
        let mut used: Vec<usize> = self.all().collect();
        used.sort_unstable();
        match used.is_empty() {
            true => Err(Failure::wrong(format!("{file} has no column of a state, expected t, theta_1 or the like"))),
            false => Ok(used),
        }
    }

    fn all(&self) -> impl Iterator<Item = usize> {
        let groups = self.groups.iter().flatten().flatten().flatten();
        self.t.into_iter().chain(groups.copied()).chain(self.wrench.into_iter().flatten())
    }
}

/// The possible endings of a group's column names.
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
