//! The columns of one group and kind: which entry each is.

use super::{Family, MEANINGS, Search};
use crate::angles;
use crate::failure::Result;
use crate::recogniser::reading::{Entry, Reading};
use crate::recogniser::word::{DDTHETA, DTHETA, TAU, THETA};
use crate::recogniser::{Column, GROUPS, columns, endings};
use std::collections::BTreeSet;

impl Search<'_> {
    /// The columns of a family by entry; None if it has none of the robot's joints.
    pub(super) fn entries_of(&self, group: usize, family: &Family) -> Result<Option<Vec<Option<Column>>>> {
        let names = self.names(group);
        let order = self.numbers_of_order();
        let base = if order.is_some() { 0 } else { self.base(group, family, names.len())? };
        let mut found: Vec<Option<Column>> = vec![None; names.len()];
        let mut foreign: Vec<&str> = Vec::new();
        for (column, reading) in family {
            let k = match &reading.entry {
                Entry::Known(k) => *k,
                Entry::Index(k) => match &order {
                    None => *k - base,
                    Some(order) => match order.iter().position(|number| number == k) {
                        Some(k) => k,
                        None => continue,
                    },
                },
                Entry::Name(name) => {
                    foreign.push(name);
                    continue;
                }
                Entry::Missing => continue,
            };
            self.check_unit(group, k, *column, reading)?;
            let factor = reading.unit.map_or(1.0, |unit| unit.factor);
            if let Some((first, _)) = found[k].replace((*column, factor)) {
                let what = format!("the {} of `{}`", MEANINGS[group], columns::entries(self.model, GROUPS[group])[k]);
                let other =
                    family.iter().find(|(column, _)| *column == first).map(|(_, reading)| reading.path.as_str());
                let remedy = match other {
                    Some(path) if path != reading.path && self.request.has_flags => {
                        format!("{what}; --topic {path} or --topic {} chooses one", reading.path)
                    }
                    _ => format!("{what}; delete or rename one"),
                };
                return Err(self.twice(first, *column, &remedy));
            }
        }
        // those of a sensor or a base: `acc_x`
        let may_be_others = group == DDTHETA || group == DTHETA && foreign.len() != names.len();
        if found.iter().all(Option::is_none) && (foreign.is_empty() || may_be_others) {
            return Ok(None);
        }
        if found.iter().any(Option::is_none) && !foreign.is_empty() {
            return Err(self.foreign(group, &foreign, &found));
        }
        let optional = if group == TAU { self.model.base().velocities() } else { 0 };
        self.check_whole(group, &found, optional)?;
        Ok(Some(found))
    }

    /// A joint that turns has no positions in mm, and one that slides none in degrees.
    fn check_unit(&self, group: usize, entry: usize, column: usize, reading: &Reading) -> Result<()> {
        let are_angles = match group {
            THETA => angles::of_positions(self.model),
            _ => angles::of_velocities(self.model),
        };
        let turns = are_angles[entry];
        let Some(unit) = reading.unit.filter(|unit| unit.turns().is_some_and(|of| of != turns)) else { return Ok(()) };
        let expected = [["m", "rad"], ["m/s", "rad/s"], ["m/s²", "rad/s²"], ["N", "N m"]][group][usize::from(turns)];
        Err(self.wrong(&format!(
            "column {} (`{}`) is a {} in {}, and `{}` {}: expected a unit such as {expected}",
            column + 1,
            self.name(column),
            MEANINGS[group],
            unit.name,
            columns::entries(self.model, GROUPS[group])[entry],
            if turns { "turns" } else { "slides" },
        )))
    }

    /// The numbers of `--order 2,0,1`.
    fn numbers_of_order(&self) -> Option<Vec<usize>> {
        let order = self.request.order;
        (!order.is_empty()).then(|| order.iter().map(|name| name.parse().ok()).collect())?
    }

    /// 0 or 1, from which the numbers are complete.
    fn base(&self, group: usize, family: &Family, count: usize) -> Result<usize> {
        let mut numbers: Vec<(usize, usize)> = Vec::new();
        for (column, reading) in family {
            if let Entry::Index(k) = reading.entry {
                numbers.push((k, *column));
            }
        }
        let Some(&(lowest, first)) = numbers.iter().min() else { return Ok(1) };
        let &(highest, last) = numbers.iter().max().unwrap_or(&(lowest, first));
        let holds = |k: usize| numbers.iter().any(|(number, _)| *number == k);
        let is_from = |base: usize| lowest >= base && highest < base + count && (base..base + count).all(holds);
        if is_from(0) {
            return Ok(0);
        }
        if is_from(1) || lowest >= 1 && highest <= count {
            return Ok(1); // what is missing is named below
        }
        if lowest == 0 && highest < count && (0..=highest).all(holds) {
            return Ok(0); // likewise
        }
        if highest >= count && !(0..=count).all(holds) && lowest >= 1 {
            // mozzi's own form of the error
            return Err(self.wrong(&format!(
                "column {} is called `{}`, expected t, {}, m_x m_y m_z f_x f_y f_z, or wrench_FRAME_m_x …, with {}",
                last + 1,
                self.name(last),
                GROUPS.map(|group| format!("{group}_1 …")).join(", "),
                endings(self.model)
            )));
        }
        let missing: Vec<String> = (0..=count).filter(|&k| !holds(k)).map(|k| k.to_string()).collect();
        let different: BTreeSet<usize> = numbers.iter().map(|(number, _)| *number).collect();
        let flag = match self.request.has_flags && different.len() >= count {
            true => {
                let first: Vec<String> = different.iter().take(count).map(usize::to_string).collect();
                format!("; --order {} takes these, in the robot's order", first.join(","))
            }
            false => String::new(),
        };
        let why = match missing.is_empty() {
            true => format!("{lowest} to {highest} are there, more than the robot has joints"),
            false => format!("without {}", missing.join(", ")),
        };
        Err(self.wrong(&format!(
            "columns {} (`{}`) to {} (`{}`): the numbers of the {} are complete neither from 0 nor from 1 ({why}), \
             expected {count}{flag}",
            first + 1,
            self.name(first),
            last + 1,
            self.name(last),
            MEANINGS[group],
        )))
    }

    /// A note about each unit that is converted.
    pub(super) fn note_units(&mut self, group: usize, family: &Family) {
        let mut seen: Vec<&str> = Vec::new();
        for (column, reading) in family {
            let Some(unit) = reading.unit.filter(|unit| unit.factor != 1.0 && !seen.contains(&unit.name)) else {
                continue;
            };
            seen.push(unit.name);
            self.notes.push(format!(
                "{}: column {} (`{}`) and its like are converted from {}: a {} times {:.6}",
                self.place,
                column + 1,
                self.name(*column),
                unit.name,
                MEANINGS[group],
                unit.factor
            ));
        }
    }
}
