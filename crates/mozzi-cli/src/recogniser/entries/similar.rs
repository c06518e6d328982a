//! Names of joints that differ from the robot's, but belong to one alone; and names in columns of text.

use super::Search;
use crate::recogniser::reading::{Entry, Reading};
use crate::recogniser::word::{DDTHETA, DTHETA, TAU, THETA};
use std::collections::BTreeMap;

/// Lower case without separators.
fn plain(name: &str) -> String {
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// Whether one name is the ending of the other, after a separator.
fn ends(long: &str, short: &str) -> bool {
    let spelled =
        |text: &str| text.to_lowercase().chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect::<String>();
    let (long, short) = (spelled(long), spelled(short));
    !short.is_empty() && long.strip_suffix(&short).is_some_and(|rest| rest.ends_with('_'))
}

/// Whether a log's name may be that of a joint: the same, but for case and separators, or one the ending of the other.
pub fn is_alike(joint: &str, name: &str) -> bool {
    plain(joint) == plain(name) || ends(joint, name) || ends(name, joint)
}

/// Whether a column holds joints' names as text: `field.name0`, `name`.
pub fn holds_names(column: &str) -> bool {
    let last = column.rsplit(['/', '.']).next().unwrap_or_default();
    let letters: String = last.chars().filter(|c| c.is_alphabetic()).collect();
    matches!(letters.to_lowercase().as_str(), "name" | "names")
}

impl Search<'_> {
    /// Columns `name0` … hold the names of `position0` …, a column `name` with a list those of all.
    /// Returns these columns.
    pub(super) fn name_indices(&self, readings: &mut [(usize, Reading)]) -> Vec<usize> {
        let mut names: BTreeMap<(String, usize), String> = BTreeMap::new();
        let mut columns = Vec::new();
        for (column, name) in self.header.names.iter().enumerate().filter(|(_, name)| holds_names(name)) {
            let Some(cell) = self.header.first.get(column).map(|cell| cell.trim()) else { continue };
            let separator = if name.contains('/') { '/' } else { '.' };
            let parts: Vec<&str> = name.split(separator).filter(|part| !part.is_empty()).collect();
            let path = parts[..parts.len() - 1].join(&separator.to_string());
            let digits: String = parts[parts.len() - 1].chars().filter(char::is_ascii_digit).collect();
            let bare = |text: &str| text.trim().trim_matches(['"', '\'']).to_string();
            let mut add = |k: usize, text: &str| {
                if !bare(text).is_empty() && text.trim().parse::<f64>().is_err() {
                    columns.push(column);
                    names.insert((path.clone(), k), bare(text));
                }
            };
            match digits.parse() {
                Ok(index) => add(index, cell),
                Err(_) => {
                    let inside = cell.trim_matches(['"', '[', ']', '(', ')']);
                    let inside: Vec<&str> = inside.split([',', ' ']).filter(|text| !text.is_empty()).collect();
                    inside.into_iter().enumerate().for_each(|(k, text)| add(k, text));
                }
            }
        }
        for (_, reading) in readings {
            let Entry::Index(index) = reading.entry else { continue };
            if let Some(name) = names.get(&(reading.path.trim_start_matches('/').to_string(), index)) {
                let known = self.names(reading.quantity).iter().position(|known| known == name);
                reading.entry = known.map_or(Entry::Name(name.clone()), Entry::Known);
            }
        }
        columns
    }

    /// Names that differ in case or separators, and unique endings.
    pub(super) fn resolve(&mut self, readings: &mut [(usize, Reading)]) {
        let foreign: Vec<String> = {
            let mut all: Vec<String> = Vec::new();
            for (_, reading) in readings.iter() {
                match &reading.entry {
                    Entry::Name(name) if !all.contains(name) => all.push(name.clone()),
                    _ => {}
                }
            }
            all
        };
        let is_taken = |group: usize, k: usize| {
            readings.iter().any(|(_, reading)| reading.quantity == group && reading.entry == Entry::Known(k))
        };
        let mut found: BTreeMap<(usize, String), usize> = BTreeMap::new();
        let mut notes = Vec::new();
        for group in [THETA, DTHETA, DDTHETA, TAU] {
            let names = self.names(group);
            let same = |a: &str, b: &str| plain(a) == plain(b);
            let ending = |a: &str, b: &str| ends(a, b) || ends(b, a);
            for is_alike in [&same as &dyn Fn(&str, &str) -> bool, &ending] {
                for name in &foreign {
                    let alike: Vec<usize> = (0..names.len()).filter(|&k| is_alike(names[k], name)).collect();
                    let [k] = alike[..] else { continue };
                    let rivals = foreign.iter().filter(|other| is_alike(names[k], other)).count();
                    let is_new = !found.contains_key(&(group, name.clone()))
                        && !found.iter().any(|((g, _), at)| *g == group && *at == k);
                    if rivals == 1 && is_new && !is_taken(group, k) {
                        found.insert((group, name.clone()), k);
                        notes.push(format!("`{name}` is `{}`", names[k]));
                    }
                }
            }
        }
        for (_, reading) in readings.iter_mut() {
            if let Entry::Name(name) = &reading.entry
                && let Some(&k) = found.get(&(reading.quantity, name.clone()))
            {
                reading.entry = Entry::Known(k);
            }
        }
        notes.sort_unstable();
        notes.dedup();
        if !notes.is_empty() {
            self.notes.push(format!("{}: joints of similar names: {}", self.place, notes.join(", ")));
        }
    }
}
