//! Which column of a table is what: the one place where columns get their meaning, for every command that reads a
//! motion, a log or a table of states.
//!
//! By name, in this order: mozzi's own names; names of joints as they are written, also within a path or with a unit
//! after them; names that differ in case or separators, or that are the unique ending of the other; numbers from 0 or
//! 1, whichever makes the set complete. Columns are never assigned by their position.

mod entries;
mod reading;
mod show;
mod time;
pub mod unit;
mod word;
mod wrench;

pub use entries::{Follower, Force, IS_CURRENT, Locked, holds_names, is_alike};
pub use show::POSITION;
pub use time::Time;

use crate::columns;
use crate::failure::{Failure, Result};
use crate::tables::samples::{Followed, Following, LockedRange, Row, Samples};
use crate::text_table::clock;
use mozzi::Model;
use mozzi::quantities::INPUTS;
use reading::{Entry, Kind, Reading};
use std::collections::BTreeMap;
use unit::Unit;

/// Columns that `mozzi simulate` writes in addition to the groups; they are read but not used.
pub const ENERGIES: [&str; 5] = ["kinetic_energy", "potential_energy", "motor_work", "friction_loss", "applied_work"];

/// Its columns of contacts, with --contact-forces: normal and tangential forces, N.
pub const FORCES: [&str; 2] = ["f_n", "f_t"];

/// True for a column that `mozzi simulate` writes for other programs.
pub fn is_own(name: &str) -> bool {
    ENERGIES.contains(&name)
        || FORCES.iter().any(|force| name.strip_prefix(force).is_some_and(|rest| rest.starts_with('_')))
}

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

/// The table of target positions.
pub const TARGET: &str = "target";

/// A column and the factor that makes it SI.
pub type Column = (usize, f64);

/// The head of a table.
#[derive(Clone, Debug, Default)]
pub struct Header {
    pub names: Vec<String>,
    /// The row of units, if there is one.
    pub units: Vec<String>,
    /// The cells of the first row of a text.
    pub first: Vec<String>,
    /// The group and the joint of each column of messages, whose names need no reading.
    pub given: Vec<Option<(usize, String)>>,
}

impl Header {
    pub fn of(names: Vec<String>) -> Self {
        Header { names, ..Header::default() }
    }

    fn unit(&self, column: usize) -> Option<Unit> {
        unit::unit(self.units.get(column)?)
    }

    /// The first row's number.
    fn number(&self, column: usize) -> Option<f64> {
        self.first.get(column)?.trim().replace(',', ".").parse().ok()
    }

    /// The first row's date and time, s since 1970.
    fn clock(&self, column: usize) -> Option<f64> {
        clock::seconds(self.first.get(column)?)
    }

    fn is_unnamed(&self, column: usize) -> bool {
        let name = self.names[column].trim();
        name.is_empty() || name.starts_with("Unnamed: ") || name == "index"
    }
}

/// The caller's knowledge about a table.
#[derive(Clone, Copy, Debug, Default)]
pub struct Request<'r> {
    /// The log's names of joints in the robot's order, which replace the robot's.
    pub order: &'r [String],
    /// Joints that the robot lacks, since they are locked.
    pub locked: &'r [String],
    /// Which columns are forces.
    pub force: Force,
    /// Only columns whose path begins with this.
    pub topic: Option<&'r str>,
    /// Whether the command has `--order` and `--lock`.
    pub has_flags: bool,
    /// Whether target positions are read beside measured ones.
    pub targets: bool,
}

impl Request<'_> {
    /// Nothing is known.
    pub const NONE: Self =
        Request { order: &[], locked: &[], force: Force::Torque, topic: None, has_flags: false, targets: false };
}

/// The use of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Role {
    Time,
    /// The group and the entry.
    Value(usize, usize),
    Wrench,
    /// The target of a measured position, by its entry.
    Target(usize),
    /// Names of joints, which give the order of others.
    Names,
    /// Why it is not used.
    Unused(&'static str),
}

/// The meaning of the columns.
#[derive(Debug)]
pub struct Recognised {
    pub time: Option<Time>,
    /// As [`GROUPS`]. An entry is None if its column is missing: it is then 0.
    groups: [Option<Vec<Option<Column>>>; GROUPS.len()],
    wrenches: Vec<wrench::Wrench>,
    targets: Option<Vec<Option<Column>>>,
    locked: Vec<Locked>,
    followers: Vec<Follower>,
    /// Notes about columns that were converted, preferred or left out.
    pub notes: Vec<String>,
    /// Each column with its meaning.
    pub rows: Vec<Row>,
}

impl Recognised {
    /// `place` is the header's: "table.csv:1".
    pub fn find(place: &str, header: &Header, model: &Model, request: &Request) -> Result<Self> {
        let wrenches = wrench::find(place, &header.names)?;
        let mut roles = vec![Role::Unused("unknown name"); header.names.len()];
        wrenches.iter().flat_map(|(_, columns)| columns).for_each(|&column| roles[column] = Role::Wrench);
        let time = time::find(place, header, &mut roles)?;
        let assignment = entries::Assignment::find(place, header, model, request, &mut roles)?;
        let mut notes = assignment.notes;
        let rows = show::rows(header, model, &roles, &assignment.groups, time);
        notes.extend(show::unused(place, header, &roles));
        let entries::Assignment { groups, targets, locked, followers, .. } = assignment;
        Ok(Recognised { time, groups, wrenches, targets, locked, followers, notes, rows })
    }

    /// The contents of the columns; `number` takes a row and a column.
    pub fn samples(&self, file: &str, count: usize, number: impl Fn(usize, usize) -> f64) -> Samples {
        let table = |columns: &[Option<Column>]| -> Vec<f64> {
            let mut all = Vec::with_capacity(count * columns.len());
            for row in 0..count {
                all.extend(
                    columns.iter().map(|column| column.map_or(0.0, |(column, factor)| number(row, column) * factor)),
                );
            }
            all
        };
        let groups = GROUPS.into_iter().zip(&self.groups);
        let groups = groups.filter_map(|(name, columns)| Some((name.to_string(), table(columns.as_ref()?))));
        let of_wrench = |columns: &[usize; 6]| table(&columns.map(|column| Some((column, 1.0))));
        let wrenches = self.wrenches.iter().map(|(name, columns)| (name.clone(), of_wrench(columns)));
        let targets = self.targets.iter().map(|columns| (TARGET.to_string(), table(columns)));
        let mut tables: BTreeMap<String, Vec<f64>> = groups.chain(wrenches).chain(targets).collect();
        let mut followers = Vec::new();
        for follower in &self.followers {
            let number = |row: usize| number(row, follower.column.0);
            let width = self.groups[follower.group].as_ref().map_or(0, Vec::len);
            let Some(table) = tables.get_mut(GROUPS[follower.group]) else { continue };
            let found = match follower.group {
                word::TAU => Followed::Lacks(follower.add(table, width, number)),
                _ => follower.differing(table, width, number).map_or(Followed::Lacks(0), Followed::Differs),
            };
            let Follower { joint, source, ratio, offset, column: (column, _), .. } = follower;
            let (joint, column) = (joint.clone(), self.rows[*column].column.clone());
            let law = format!("{ratio} · {source} + {offset}");
            followers.push(Following { joint, source: source.clone(), law, column, found });
        }
        let mut begin = 0.0;
        let t = self.time.map(|time| {
            let first = |column: usize| if count > 0 { number(0, column) } else { 0.0 };
            match time {
                // from the first row: nanoseconds since 1970 would lose digits
                Time::Pair { seconds, rest, factor } => {
                    let (s, r) = (first(seconds), first(rest));
                    begin = s + r * factor;
                    (0..count).map(|row| number(row, seconds) - s + (number(row, rest) - r) * factor).collect()
                }
                Time::Column { column, factor } => {
                    let factor = factor.unwrap_or(1.0);
                    let is_same = (1..count).all(|row| number(row, column) == first(column));
                    let is_kept = is_same || factor == 1.0 && first(column).abs() < 1e8;
                    let start = if is_kept { 0.0 } else { first(column) };
                    begin = start * factor;
                    (0..count).map(|row| (number(row, column) - start) * factor).collect()
                }
            }
        });
        let is_time_certain = self.time.is_none_or(|time| !matches!(time, Time::Column { factor: None, .. }));
        let locked = self.locked.iter().map(|locked| {
            let (column, factor) = locked.column;
            let range = (0..count).map(|row| number(row, column) * factor);
            let [low, high] = range.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [x.min(a), x.max(b)]);
            let name = self.rows[column].column.clone();
            LockedRange { joint: locked.joint.clone(), meaning: locked.meaning, column: name, low, high }
        });
        let locked = locked.collect();
        let (file, start) = (file.to_string(), begin);
        Samples { file, count, t, start, tables, is_time_certain, locked, followers, ..Samples::default() }
    }

    /// The columns that are used, in order; a file without any is an error.
    pub fn used(&self, file: &str) -> Result<Vec<usize>> {
        let mut used: Vec<usize> = self.all().collect();
        used.sort_unstable();
        used.dedup();
        if used.is_empty() {
            let names: Vec<&str> = self.rows.iter().map(|row| row.column.as_str()).take(12).collect();
            return Err(Failure::wrong(format!(
                "{file} has no column of a state, expected t, theta_1 or the like; its columns are `{}`",
                names.join("`, `")
            )));
        }
        Ok(used)
    }

    fn all(&self) -> impl Iterator<Item = usize> {
        let groups = self.groups.iter().flatten().flatten().flatten().map(|(column, _)| *column);
        let time = self.time.into_iter().flat_map(|time| match time {
            Time::Column { column, .. } => [Some(column), None],
            Time::Pair { seconds, rest, .. } => [Some(seconds), Some(rest)],
        });
        let targets = self.targets.iter().flatten().flatten().map(|(column, _)| *column);
        let locked = self.locked.iter().map(|locked| locked.column.0);
        time.flatten()
            .chain(groups)
            .chain(targets)
            .chain(locked)
            .chain(self.followers.iter().map(|follower| follower.column.0))
            .chain(self.wrenches.iter().flat_map(|(_, columns)| columns).copied())
    }

    /// Whether a column holds the time, which may be a date.
    pub fn is_time(&self, column: usize) -> bool {
        matches!(self.time, Some(Time::Column { column: time, .. }) if time == column)
    }
}

/// Whether a name could be a column of this robot's motion: a number of positions, for the choice between a robot on a
/// floating base and its joints alone.
pub fn positions(names: &[String]) -> usize {
    names.iter().filter(|name| is_position(name)).count()
}

fn is_position(name: &str) -> bool {
    name.starts_with("theta_")
        || reading::read(name, &[], None).is_some_and(|found| {
            let Reading { quantity, kind, entry, .. } = found;
            quantity == word::THETA && kind == Kind::PLAIN && entry != Entry::Missing
        })
}

/// The possible endings of a group's column names.
pub fn endings(model: &Model) -> String {
    use mozzi::Freedom;
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

/// The names of a group's columns, as mozzi writes them.
fn own_names(model: &Model, group: usize) -> Vec<String> {
    columns::names(model, GROUPS[group])
}
