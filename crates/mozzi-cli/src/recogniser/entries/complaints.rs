//! Errors about the columns of a table, with remedies.

use super::{LISTS, MEANINGS, Search};
use crate::failure::{Failure, Result};
use crate::recogniser::reading::places;
use crate::recogniser::word::{DDTHETA, DTHETA, THETA, words};
use crate::recogniser::{Column, GROUPS, Role, columns, endings, own_names};
use mozzi::model::Place;
use mozzi::spelling::distance;

impl Search<'_> {
    pub(super) fn twice(&self, first: usize, second: usize, what: &str) -> Failure {
        let (a, b) = (self.name(first), self.name(second));
        let names = if a == b { String::new() } else { format!(", `{a}` and `{b}`,") };
        self.wrong(&format!("columns {} and {}{names} both give {what}", first + 1, second + 1))
    }

    /// The error of names that are not the robot's, with what to paste.
    pub(super) fn foreign(&self, group: usize, foreign: &[&str], found: &[Option<Column>]) -> Failure {
        let own = columns::entries(self.model, GROUPS[group]);
        let missing: Vec<&str> = (0..own.len()).filter(|&k| found[k].is_none()).map(|k| own[k]).collect();
        let some = |names: &[&str]| {
            let more = if names.len() > 12 { ", …" } else { "" };
            names.iter().take(12).copied().collect::<Vec<_>>().join(", ") + more
        };
        let mut text = format!(
            "no {} of `{}`; the log's joints are {}, the robot's {}",
            MEANINGS[group],
            missing.first().copied().unwrap_or_default(),
            some(foreign),
            some(&own)
        );
        if !self.request.has_flags {
            text += "; rename the columns";
        } else if foreign.len() == own.len() && missing.len() == own.len() {
            text += &format!("; if this is the robot's order: --order {}", foreign.join(","));
        } else {
            text += &format!("; --order NAME,… gives the log's {} names in the robot's order", own.len());
        }
        if self.request.has_flags && missing.len() < own.len() {
            let locks: Vec<String> = missing.iter().take(4).map(|name| format!("--lock {name}=POSITION")).collect();
            text += &format!(", {} locks what the log lacks (`*` matches any text)", locks.join(" "));
        } else if self.request.has_flags {
            text += &format!(", --lock {}=POSITION locks a joint", missing[0]);
        }
        self.wrong(&text)
    }

    pub(super) fn check_whole(&self, group: usize, found: &[Option<Column>], optional: usize) -> Result<()> {
        let base = found.iter().take(optional).flatten().count();
        if found.iter().skip(optional).all(Option::is_some) && (base == 0 || base == optional) {
            return Ok(());
        }
        let first = if base == 0 { optional } else { 0 };
        let at = (first..found.len()).find(|&k| found[k].is_none()).unwrap_or(0);
        let own = match self.request.order.is_empty() {
            true => own_names(self.model, group)[at].clone(),
            false => format!("{}_{}", GROUPS[group], self.request.order[at]),
        };
        let name = self.as_written(group, found, at).unwrap_or(own);
        let entry = columns::entries(self.model, GROUPS[group])[at];
        let (of, list) = match MEANINGS.get(group) {
            Some(meaning) if !name.contains(entry) => (format!(", the {meaning} of {entry}"), LISTS[group]),
            Some(_) => (String::new(), LISTS[group]),
            None => (String::new(), GROUPS[group]),
        };
        let remedy = match (self.request.has_flags && optional == 0, group) {
            (true, DTHETA | DDTHETA) => format!("; without any {list}, they are differentiated: remove the others"),
            (true, _) => {
                let first = |place: &Place| if group == THETA { place.q } else { place.j };
                let mut joints = self.model.joint_names().zip(self.model.places());
                let joint = joints.find(|(_, place)| first(place) == at); // none of a floating base
                joint.map_or_else(String::new, |(joint, _)| {
                    format!("; if the joint did not move, --lock {joint}=POSITION leaves it out")
                })
            }
            _ => String::new(),
        };
        Err(self.wrong(&format!(
            "column {name} is missing{of}; the file has {} of the {} columns of {list}{}{remedy}",
            found.iter().flatten().count(),
            found.len(),
            self.unread()
        )))
    }

    /// The column of an entry, as this file would call it, by the name of another entry's column.
    fn as_written(&self, group: usize, found: &[Option<Column>], at: usize) -> Option<String> {
        let names = self.names(group);
        found.iter().enumerate().find_map(|(k, column)| {
            let name = self.name((*column)?.0);
            if let Some((before, after)) = places(name, names[k]).last() {
                return Some(format!("{before}{}{after}", names[at]));
            }
            // the number of the entry, from 0 or 1
            let (range, number) = words(name).into_iter().rev().find_map(|(range, text)| {
                let number = text.parse::<usize>().ok().filter(|number| [k, k + 1].contains(number))?;
                Some((range, number))
            })?;
            Some(format!("{}{}{}", &name[..range.start], number + at - k, &name[range.end..]))
        })
    }

    /// The columns whose names are not recognised.
    fn unread(&self) -> String {
        let names: Vec<&str> = self.unread.iter().take(4).map(|&column| self.name(column)).collect();
        match names.is_empty() {
            true => String::new(),
            false => format!(", and `{}` is not recognised", names.join("`, `")),
        }
    }

    /// A name that nearly is one of mozzi's own is an error, not an unused column.
    pub(super) fn check_spelling(&self, roles: &[Role]) -> Result<()> {
        for (column, role) in roles.iter().enumerate() {
            let name = self.name(column);
            let Some((word, entry)) = name.split_once('_') else { continue };
            if *role != Role::Unused("unknown name") || word.len() < 4 {
                continue;
            }
            let names = self.model.position_names().chain(self.model.velocity_names());
            let is_entry = entry.parse::<usize>().is_ok() || names.into_iter().any(|known| known == entry);
            let near = GROUPS[..4].iter().min_by_key(|group| distance(word, group));
            let near = near.filter(|group| distance(word, group) <= 1 + usize::from(group.len() > 3));
            if let (Some(group), true) = (near, is_entry) {
                return Err(self.wrong(&format!(
                    "column {} is called `{name}`, expected a known name: did you mean `{group}_{entry}`?",
                    column + 1
                )));
            }
            if name.starts_with("theta_base.") || name.starts_with("dtheta_base.") {
                return Err(self.wrong(&format!(
                    "column {} is called `{name}`, expected {}",
                    column + 1,
                    endings(self.model)
                )));
            }
        }
        Ok(())
    }
}
