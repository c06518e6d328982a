//! Assigns columns to the robot's entries.

mod complaints;
mod family;
mod mimic;
mod similar;

pub use mimic::Follower;
pub use similar::{holds_names, is_alike};

use super::reading::{self, Entry, Kind, Reading, suits};
use super::unit::{Dimension, per_second};
use super::word::{DDTHETA, DTHETA, Origin, TAU, THETA};
use super::{Column, GROUPS, Header, Request, Role, columns, is_own};
use crate::failure::{Failure, Result};
use mozzi::Model;
use std::collections::BTreeMap;

/// Which columns are forces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Force {
    #[default]
    Torque,
    /// Motor currents, whose gains are estimated.
    Current,
}

/// Why a motor's current is not used; `identify` looks for it.
pub const IS_CURRENT: &str = "a motor current, no torque";

/// Names of the first four groups in messages.
const MEANINGS: [&str; 4] = ["position", "velocity", "acceleration", "force"];
const LISTS: [&str; 4] = ["positions", "velocities", "accelerations", "forces"];

/// The groups with their columns.
pub struct Assignment {
    pub groups: [Option<Vec<Option<Column>>>; GROUPS.len()],
    pub targets: Option<Vec<Option<Column>>>,
    pub locked: Vec<Locked>,
    pub followers: Vec<Follower>,
    pub notes: Vec<String>,
}

/// A position or velocity of a locked joint.
#[derive(Clone, Debug)]
pub struct Locked {
    pub joint: String,
    pub meaning: &'static str,
    pub column: Column,
}

/// Columns of one group and kind, by entry.
type Family = Vec<(usize, Reading)>;

struct Search<'a> {
    place: &'a str,
    header: &'a Header,
    model: &'a Model,
    request: &'a Request<'a>,
    notes: Vec<String>,
    /// Columns whose names are not recognised.
    unread: Vec<usize>,
}

impl Assignment {
    pub fn find(place: &str, header: &Header, model: &Model, request: &Request, roles: &mut [Role]) -> Result<Self> {
        let mut search = Search { place, header, model, request, notes: Vec::new(), unread: Vec::new() };
        search.check_order()?;
        let mut groups: [Option<Vec<Option<Column>>>; GROUPS.len()] = Default::default();
        search.own_vectors(&mut groups, roles)?;
        let mut readings = search.readings(roles)?;
        for column in search.name_indices(&mut readings) {
            roles[column] = Role::Names;
        }
        let locked = search.take_locked(&mut readings, roles);
        let followers = search.take_followers(&mut readings, roles);
        let mut chosen: [Option<Kind>; GROUPS.len()] = [None; GROUPS.len()];
        search.resolve(&mut readings);
        let (mut origin, mut targets): (Option<usize>, _) = (None, None);
        for group in [THETA, DTHETA, DDTHETA, TAU] {
            let mut families: BTreeMap<Kind, Family> = BTreeMap::new();
            for (column, reading) in readings.iter().filter(|(_, reading)| reading.quantity == group) {
                families.entry(reading.kind).or_default().push((*column, reading.clone()));
            }
            if group == TAU {
                search.leave_currents(&mut families, roles);
            } else if let Some(origin) = origin {
                search.leave_others(&mut families, roles, origin, group);
            }
            let is_measured = |kind: &Kind| class(kind.origin) == 0;
            if request.targets && group == THETA && families.keys().any(is_measured) {
                let mut wanted = families.clone();
                wanted.retain(|kind, _| !is_measured(kind));
                families.retain(|kind, _| is_measured(kind));
                targets = search.choose_targets(wanted, roles);
            }
            if let Some((kind, columns)) = search.choose(group, families, roles)? {
                origin = origin.or(Some(class(kind.origin)));
                chosen[group] = Some(kind);
                columns.iter().enumerate().for_each(|(entry, column)| {
                    if let Some((column, _)) = column {
                        roles[*column] = Role::Value(group, entry);
                    }
                });
                groups[group] = Some(columns);
            }
        }
        let followers = search.keep_followers(followers, &chosen, roles);
        search.check_spelling(roles)?;
        Ok(Assignment { groups, targets, locked, followers, notes: search.notes })
    }
}

/// Measured or unnamed, target, desired.
fn class(origin: Origin) -> usize {
    match origin {
        Origin::Measured | Origin::Unnamed => 0,
        Origin::Target => 1,
        Origin::Desired => 2,
    }
}

impl Search<'_> {
    fn wrong(&self, what: &str) -> Failure {
        Failure::wrong(format!("{}: {what}", self.place))
    }

    fn name(&self, column: usize) -> &str {
        &self.header.names[column]
    }

    /// The names of a group's entries: those of `--order`, or the robot's.
    fn names(&self, group: usize) -> Vec<&str> {
        match self.request.order.is_empty() {
            true => columns::entries(self.model, GROUPS[group]),
            false => self.request.order.iter().map(String::as_str).collect(),
        }
    }

    fn check_order(&self) -> Result<()> {
        let order = self.request.order;
        let n = self.model.nq();
        if order.is_empty() {
            return Ok(());
        }
        if order.len() != n || !self.model.configuration_space().is_flat() {
            return Err(Failure::wrong(format!("--order has {} names, expected {n}", order.len())));
        }
        match order.iter().enumerate().find(|(k, name)| order[..*k].contains(name)) {
            Some((_, name)) => {
                Err(Failure::wrong(format!("--order names `{name}` twice, expected {n} different names")))
            }
            None => Ok(()),
        }
    }

    /// Vectors that only mozzi knows: `x_1`, `w_1`.
    fn own_vectors(&self, groups: &mut [Option<Vec<Option<Column>>>], roles: &mut [Role]) -> Result<()> {
        for group in TAU + 1..GROUPS.len() {
            let names = columns::entries(self.model, GROUPS[group]);
            let mut found: Vec<Option<Column>> = vec![None; names.len()];
            for (column, name) in self.header.names.iter().enumerate() {
                let Some(entry) = name.strip_prefix(GROUPS[group]).and_then(|rest| rest.strip_prefix('_')) else {
                    continue;
                };
                let by_number = entry.parse::<usize>().ok().and_then(|k| k.checked_sub(1)).filter(|&k| k < names.len());
                let Some(k) = names.iter().position(|known| *known == entry).or(by_number) else { continue };
                if let Some((first, _)) = found[k].replace((column, 1.0)) {
                    return Err(self.twice(first, column, &format!("`{name}`")));
                }
                roles[column] = Role::Value(group, k);
            }
            if found.iter().any(Option::is_some) {
                self.check_whole(group, &found, 0)?;
                groups[group] = Some(found);
            }
        }
        Ok(())
    }

    /// Takes the columns of locked joints, which have no entry.
    fn take_locked(&self, readings: &mut Vec<(usize, Reading)>, roles: &mut [Role]) -> Vec<Locked> {
        let mut found = Vec::new();
        readings.retain(|(column, reading)| {
            let Entry::Name(name) = &reading.entry else { return true };
            if !self.request.locked.contains(name) {
                return true;
            }
            roles[*column] = Role::Unused("its joint is locked");
            if [THETA, DTHETA].contains(&reading.quantity) && class(reading.kind.origin) == 0 {
                let column = (*column, reading.unit.map_or(1.0, |unit| unit.factor));
                found.push(Locked { joint: name.clone(), meaning: MEANINGS[reading.quantity], column });
            }
            false
        });
        found
    }

    /// Reads the name of each column.
    fn readings(&mut self, roles: &mut [Role]) -> Result<Vec<(usize, Reading)>> {
        let mut names: Vec<String> = match self.request.order.is_empty() {
            true => self.model.position_names().chain(self.model.velocity_names()).map(String::from).collect(),
            false => self.request.order.to_vec(),
        };
        names.extend_from_slice(self.request.locked);
        names.extend(self.mimic_joints().map(String::from));
        let joints: Vec<&str> = names.iter().map(String::as_str).collect();
        let is_franka = self.header.names.iter().any(|name| name.contains("tau_J"));
        let mut found = Vec::new();
        for (column, name) in self.header.names.iter().enumerate() {
            if roles[column] != Role::Unused("unknown name") {
                continue;
            }
            if is_own(name) || name == "method" {
                roles[column] = Role::Unused("mozzi's own");
                continue;
            }
            let unit = self.header.unit(column).filter(|unit| unit.dimension != Dimension::Time);
            let mut read = match self.header.given.get(column).and_then(Option::as_ref) {
                Some((quantity, joint)) => {
                    let known = joints.iter().position(|known| known == joint);
                    let entry = known.map_or(Entry::Name(joint.clone()), Entry::Known);
                    Reading { quantity: *quantity, kind: Kind::PLAIN, unit: None, entry, path: String::new() }
                }
                None => match reading::read(name, &joints, unit) {
                    Some(read) => read,
                    None => {
                        self.unread.push(column);
                        continue;
                    }
                },
            };
            if let Entry::Name(text) = &read.entry
                && let Some((_, inner)) = text.split_once(['[', '('])
                && inner.chars().any(char::is_alphabetic)
            {
                return Err(self.wrong(&format!(
                    "column {} (`{name}`): the unit `{inner}` is not known, expected such as rad, deg, deg/s, N m",
                    column + 1
                )));
            }
            let motors = |part: &str| part.starts_with("theta[") || part.starts_with("dtheta[");
            if is_franka && name.trim().rsplit('.').next().is_some_and(motors) {
                read.kind.side = 2;
            }
            // names of joints are texts here: positions and velocities of a floating base have other numbers
            read.entry = match read.entry {
                Entry::Known(k) => {
                    let of_group = self.names(read.quantity);
                    of_group
                        .iter()
                        .position(|known| *known == joints[k])
                        .map_or(Entry::Name(joints[k].into()), Entry::Known)
                }
                Entry::Missing if self.model.n() == 1 && self.model.nq() == 1 => Entry::Known(0),
                Entry::Missing => {
                    self.unread.push(column);
                    continue;
                }
                entry => entry,
            };
            if let Some(topic) = self.request.topic {
                let inside = read.path.trim_start_matches('/').starts_with(topic.trim_start_matches('/'));
                if !inside {
                    roles[column] = Role::Unused("another topic");
                    continue;
                }
            }
            let rate = [(DTHETA, Dimension::Velocity), (DDTHETA, Dimension::Acceleration)];
            if let (Some(unit), Some((_, dimension))) = (read.unit, rate.iter().find(|(of, _)| *of == read.quantity)) {
                read.unit = per_second(unit, *dimension).or(read.unit);
            }
            if let Some(unit) = read.unit {
                let meaning = MEANINGS[read.quantity];
                if unit.dimension == Dimension::Share {
                    return Err(self.wrong(&format!(
                        "column {} (`{name}`) is in {} of a rated value that the file does not hold; multiply it by the \
                         motor's rated torque",
                        column + 1,
                        unit.name
                    )));
                }
                if !suits(unit, read.quantity) {
                    let what = format!("column {} (`{name}`) is a {meaning} in {}", column + 1, unit.name);
                    return Err(self.wrong(&format!("{what}, expected a unit of {meaning}")));
                }
            }
            found.push((column, read));
        }
        if let (Some(topic), true) = (self.request.topic, found.is_empty()) {
            return Err(self.wrong(&format!("no column's path begins with `{topic}`, as --topic asks")));
        }
        Ok(found)
    }

    /// Torques before currents; without `--torque current` a current is never a force.
    fn leave_currents(&mut self, families: &mut BTreeMap<Kind, Family>, roles: &mut [Role]) {
        let has_currents = families.keys().any(|kind| kind.is_current);
        let wanted = self.request.force == Force::Current && has_currents;
        families.retain(|kind, family| {
            let is_kept = kind.is_current == wanted;
            if !is_kept {
                let why = if kind.is_current { IS_CURRENT } else { "a torque, and --torque current asks for currents" };
                family.iter().for_each(|(column, _)| roles[*column] = Role::Unused(why));
            }
            is_kept
        });
    }

    /// Velocities are those of the positions, not of another motion.
    fn leave_others(&mut self, families: &mut BTreeMap<Kind, Family>, roles: &mut [Role], origin: usize, group: usize) {
        let mut left: Option<usize> = None;
        families.retain(|kind, family| {
            let is_kept = class(kind.origin) == origin;
            if !is_kept {
                left = left.or(family.first().map(|(column, _)| *column));
                family
                    .iter()
                    .for_each(|(column, _)| roles[*column] = Role::Unused("of another motion than the positions"));
            }
            is_kept
        });
        if let (Some(column), true) = (left, families.is_empty()) {
            self.notes.push(format!(
                "{}: `{}` … are not used: they are no {} of the motion that the positions describe",
                self.place,
                self.name(column),
                if group == DTHETA { "velocities" } else { "accelerations" }
            ));
        }
    }

    /// Targets beside measured positions; a set that is not complete is not used, with a note.
    fn choose_targets(&mut self, families: BTreeMap<Kind, Family>, roles: &mut [Role]) -> Option<Vec<Option<Column>>> {
        match self.choose(THETA, families, roles) {
            Ok(found) => {
                let columns = found?.1;
                columns.iter().enumerate().for_each(|(entry, column)| {
                    if let Some((column, _)) = column {
                        roles[*column] = Role::Target(entry);
                    }
                });
                Some(columns)
            }
            Err(why) => {
                let why = if let Failure::Wrong(why) = why { why } else { String::new() };
                self.notes.push(format!("target positions are not used: {why}"));
                None
            }
        }
    }

    /// The best complete family of a group.
    fn choose(
        &mut self,
        group: usize,
        families: BTreeMap<Kind, Family>,
        roles: &mut [Role],
    ) -> Result<Option<(Kind, Vec<Option<Column>>)>> {
        let mut chosen: Option<(Kind, Vec<Option<Column>>, usize)> = None;
        let mut first_error: Option<Failure> = None;
        for (kind, family) in families {
            if let Some((.., first)) = &chosen {
                let (kept, left) = (self.name(*first).to_string(), self.name(family[0].0).to_string());
                self.notes.push(format!("{}: `{kept}` … are used, `{left}` … are not", self.place));
                family.iter().for_each(|(column, _)| roles[*column] = Role::Unused("a preferred column has it"));
                continue;
            }
            match self.entries_of(group, &family) {
                Ok(Some(columns)) => {
                    self.note_units(group, &family);
                    chosen = Some((kind, columns, family[0].0));
                }
                Ok(None) => {}
                Err(error) => {
                    family.iter().for_each(|(column, _)| roles[*column] = Role::Unused("not complete"));
                    first_error.get_or_insert(error);
                }
            }
        }
        match (chosen, first_error) {
            (Some((kind, columns, _)), _) => Ok(Some((kind, columns))),
            (None, Some(error)) => Err(error),
            (None, None) => Ok(None),
        }
    }
}

#[cfg(test)]
mod tests;
