//! Tables of numbers in CSV files: one row for each time, columns by name (see [`Places`]).

use crate::columns;
use crate::failure::{Failure, Result};
use crate::input::{self, Input};
use crate::numbers::number;
use crate::places::{GROUPS, Places};
use crate::progress::Progress;
use crate::tables::samples::Samples;
use csv::Reader;
use mozzi::Model;
use std::io::{self, Read};

/// A longer line is an error; so is a zero byte, which devices may send endlessly.
const LONGEST_LINE: u64 = 64 << 20;

/// Reads a file, or standard input for `-`. The robot is chosen by the header.
pub fn read<'m>(file: &str, choose: &dyn Fn(&[String]) -> &'m Model) -> Result<Samples> {
    let name = input::name(file);
    let (mut reader, header) = open(file)?;
    let model = choose(&header);
    if header.iter().all(|cell| number("", cell).is_ok()) {
        return Err(Failure::wrong(format!(
            "{name}:1: the first line holds numbers, expected the columns' names; put a line such as `{}` before it",
            guess(model, header.len())
        )));
    }
    let places = Places::find(&format!("{name}:1"), &header, model)?;
    let used = places.used(name)?;
    let (mut lines, mut rows): (Vec<u64>, Vec<f64>) = Default::default();
    let kilobytes = std::fs::metadata(file).map_or(0, |found| found.len() / 1000) as usize;
    let progress = Progress::new("reading", kilobytes, "kB");
    for record in reader.records() {
        let record = record.map_err(|error| csv_failure(name, &error))?;
        let line = record.position().map_or(0, |position| position.line());
        progress.at(record.position().map_or(0, |position| position.byte() / 1000) as usize);
        for &column in &used {
            let place = format_args!("{name}:{line}: column {} (`{}`)", column + 1, header[column]);
            rows.push(number(place, record.get(column).unwrap_or_default())?);
        }
        lines.push(line);
    }
    if lines.is_empty() {
        return Err(Failure::wrong(format!("{name} has no rows below its header")));
    }
    let mut place = vec![0; header.len()];
    used.iter().enumerate().for_each(|(k, &column)| place[column] = k);
    let samples = places.samples(name, lines.len(), |row, column| rows[row * used.len() + place[column]]);
    Ok(Samples { lines, ..samples })
}

/// The records of a file after its header.
pub fn open(file: &str) -> Result<(Reader<Lines>, Vec<String>)> {
    let name = input::name(file);
    let lines = Lines { input: Input::open(file)?, line: 1, length: 0 };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(lines);
    let header: Vec<String> = match reader.headers() {
        Ok(header) => header.iter().map(|cell| cell.trim_start_matches('\u{feff}').to_string()).collect(),
        Err(error) => return Err(csv_failure(name, &error)),
    };
    match header.as_slice() {
        [] => Err(Failure::wrong(format!("{name} is empty, expected a header and rows of numbers"))),
        [one] if one.contains([';', '\t']) => {
            let (found, pattern) = if one.contains(';') { ("`;`", ";") } else { ("tabs", "\\t") };
            Err(Failure::wrong(format!(
                "{name}:1: columns are separated by {found}, expected commas, and points in numbers; \
                 `sed 's/,/./g; s/{pattern}/,/g'` converts such a file"
            )))
        }
        _ => Ok((reader, header)),
    }
}

/// A plausible header with this many columns, if there is one; else its beginning.
fn guess(model: &Model, count: usize) -> String {
    let with = |has_time: bool, groups: usize| -> Vec<String> {
        let time = has_time.then(|| "t".to_string());
        time.into_iter().chain(GROUPS.iter().take(groups).flat_map(|group| columns::names(model, group))).collect()
    };
    let all = (1..=4).flat_map(|groups| [with(true, groups), with(false, groups)]);
    let fitting = all.into_iter().find(|names| names.len() == count);
    let mut names = fitting.unwrap_or_else(|| with(true, 1));
    if names.len() > 12 || names.len() != count {
        names.truncate(12);
        names.push("…".into());
    }
    names.join(",")
}

/// The bytes of a text with lines of limited length.
pub struct Lines {
    input: Input,
    line: u64,
    length: u64,
}

impl Read for Lines {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let count = self.input.read(to)?;
        for &byte in &to[..count] {
            self.length += 1;
            match byte {
                b'\n' => (self.line, self.length) = (self.line + 1, 0),
                0 => return Err(self.wrong("holds a zero byte, expected text")),
                _ if self.length > LONGEST_LINE => return Err(self.wrong("is longer than 64 MiB, expected a row")),
                _ => {}
            }
        }
        Ok(count)
    }
}

impl Lines {
    fn wrong(&self, what: &str) -> io::Error {
        io::Error::other(format!("line {} {what}", self.line))
    }
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
