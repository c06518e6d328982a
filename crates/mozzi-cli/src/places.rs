//! Assigns the columns of a table by their names.
//!
//! A column is `t` (seconds), or `theta_…`, `dtheta_…`, `ddtheta_…`, `tau_…`, `x_…`, `w_…` with the number of an entry,
//! from 1, or its name (a joint's, or `base.qw` … `base.z` and `base.wx` … `base.vz` of a floating base), or `m_x m_y
//! m_z f_x f_y f_z` of the tip's wrench, or `wrench_FRAME_m_x` … `wrench_FRAME_f_z` of a frame's. Each group must be
//! complete or absent; the order is free. Only the six columns of a floating base's wrench may be missing on their own,
//! and are then 0: no motor drives it.

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
    /// By the table's name: `wrench` of the tip, `wrench_FRAME`.
    wrenches: Vec<(String, [usize; 6])>,
}

/// The name of a wrench's table, and the entry of a column: `m_x`, or `wrench_FRAME_m_x`, also with `.` before `m_x`.
pub fn wrench_of(column: &str) -> Option<(String, usize)> {
    if let Some(entry) = WRENCH.iter().position(|known| *known == column) {
        return Some(("wrench".to_string(), entry));
    }
    column.strip_prefix("wrench_")?;
    WRENCH.iter().enumerate().find_map(|(entry, known)| {
        let table = column.strip_suffix(known)?.strip_suffix(['_', '.', '/'])?;
        (table.len() > "wrench_".len()).then(|| (table.to_string(), entry))
    })
}

/// Collects the columns of wrenches; `missing` makes the error of an incomplete one, by its column and count.
pub fn whole_wrenches(
    found: Vec<(String, [Option<usize>; 6])>,
    missing: impl Fn(&str, usize) -> Failure,
) -> Result<Vec<(String, [usize; 6])>> {
    let whole = |(name, columns): (String, [Option<usize>; 6])| {
        if let Some(k) = columns.iter().position(Option::is_none) {
            let column = if name == "wrench" { WRENCH[k].to_string() } else { format!("{name}_{}", WRENCH[k]) };
            return Err(missing(&column, columns.iter().flatten().count()));
        }
        Ok((name, columns.map(Option::unwrap_or_default)))
    };
    found.into_iter().map(whole).collect()
}

/// The place of a wrench's entry, in the list of those found so far.
pub fn wrench_place(
    found: &mut Vec<(String, [Option<usize>; 6])>,
    (table, entry): (String, usize),
) -> Option<&mut Option<usize>> {
    let k = found.iter().position(|(known, _)| *known == table).unwrap_or_else(|| {
        found.push((table, [None; 6]));
        found.len() - 1
    });
    found.get_mut(k)?.1.get_mut(entry)
}

impl Places {
    /// `place` is the header's: "table.csv:1".
    pub fn find(place: &str, header: &[String], model: &Model) -> Result<Self> {
        let names = GROUPS.map(|group| columns::entries(model, group));
        let mut groups: [Vec<Option<usize>>; GROUPS.len()] = names.each_ref().map(|names| vec![None; names.len()]);
        let (mut t, mut wrenches) = ([None], Vec::new());
        for (column, name) in header.iter().enumerate() {
            let entry: Option<&mut Option<usize>> = if name == "t" {
                t.first_mut()
            } else if let Some(found) = wrench_of(name) {
                wrench_place(&mut wrenches, found)
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
                    "{place}: column {} is called `{name}`, expected t, {}, {}, or wrench_FRAME_m_x …, with {}",
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
        let wrenches = whole_wrenches(wrenches, |column, found| missing(column, WRENCH.len(), found))?;
        Ok(Places { t: t[0], groups: found, wrenches })
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
        let groups = groups.map(|(name, table)| (name.to_string(), table));
        let wrenches = self.wrenches.iter().map(|(name, columns)| (name.clone(), table(&columns.map(Some))));
        let tables = groups.chain(wrenches).collect();
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
        self.t.into_iter().chain(groups.copied()).chain(self.wrenches.iter().flat_map(|(_, columns)| columns).copied())
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
