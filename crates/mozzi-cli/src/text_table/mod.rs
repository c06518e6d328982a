//! Tables of numbers in text files: separators, decimal marks, headers and dates as programs write them.

pub mod clock;
mod dialect;
mod kind;
mod lines;
mod lists;

use crate::columns;
use crate::failure::{self, Failure, Result};
use crate::input::{self, Input, cannot};
use crate::numbers;
use crate::progress::Progress;
use crate::recogniser::{GROUPS, Header, Recognised, holds_names};
use crate::tables::How;
use crate::tables::samples::Samples;
use dialect::{Dialect, Separator};
use kind::{check_json, check_kind};
use lines::{Blanks, Lines};
use lists::Lists;
use mozzi::Model;
use std::io::{Cursor, Read};

/// Complete lines that are read before the rest.
const LINES: usize = 60;

/// A table with more columns is refused.
const MOST_COLUMNS: usize = 20_000;

/// A text, open after its header.
pub struct TextTable {
    /// The file's name in messages.
    pub name: String,
    pub header: Header,
    /// "table.csv:1", the header's place.
    pub place: String,
    reader: csv::Reader<Box<dyn Read>>,
    dialect: Dialect,
    lists: Lists,
    kilobytes: usize,
}

impl TextTable {
    /// Opens a file, or standard input for `-`, and reads its header.
    pub fn open(file: &str) -> Result<Self> {
        let name = input::name(file).to_string();
        check_kind(file)?;
        let mut lines = Lines::of(Input::open(file)?);
        let (mut begin, mut found) = (Vec::new(), 0);
        let is_all = loop {
            let mut piece = vec![0; 1 << 16];
            let count = lines.read(&mut piece).map_err(|error| Failure::wrong(format!("{name}: {error}")))?;
            if begin.is_empty() {
                check_json(&name, &piece[..count])?;
            }
            begin.extend(&piece[..count]);
            found += piece[..count].iter().filter(|&&byte| byte == b'\n').count();
            if count == 0 || found >= LINES {
                break count == 0;
            }
        };
        let whole =
            if is_all { begin.len() } else { begin.iter().rposition(|&byte| byte == b'\n').map_or(0, |k| k + 1) };
        let text = std::str::from_utf8(&begin[..whole]).map_err(|error| {
            let line = begin[..error.valid_up_to()].iter().filter(|&&byte| byte == b'\n').count() + 1;
            Failure::wrong(format!(
                "{name}:{line}: not UTF-8 text; `iconv -f latin1 -t utf8` or \"CSV UTF-8\" in a spreadsheet writes it"
            ))
        })?;
        let dialect = Dialect::of(&name, text, is_all)?;
        dialect.notes.iter().for_each(|note| failure::note(note));
        let (skipped, place) = (dialect.begin.0, format!("{name}:{}", dialect.line));
        let rest = Cursor::new(begin).chain(lines);
        let mut rest: Box<dyn Read> = Box::new(rest);
        std::io::copy(&mut rest.by_ref().take(skipped as u64), &mut std::io::sink())
            .map_err(|error| cannot(file, &error))?;
        if dialect.separator == Separator::Blanks {
            rest = Box::new(Blanks::of(rest));
        }
        let mut builder = csv::ReaderBuilder::new();
        // cells are trimmed when they are read: csv would copy each row for that
        builder.has_headers(false).delimiter(dialect.separator.byte()).flexible(true);
        let reader = builder.comment(Some(b'#')).from_reader(rest);
        let lists = Lists::of(&dialect.first);
        let header = Header {
            names: lists.names(&dialect.names),
            units: lists.repeated(&dialect.units),
            first: lists.cells(dialect.first.iter().map(String::as_str)).map(str::to_string).collect(),
            given: Vec::new(),
        };
        if header.names.len() > MOST_COLUMNS {
            let found = header.names.len();
            return Err(Failure::wrong(format!("{place} has {found} columns, expected at most {MOST_COLUMNS}")));
        }
        let kilobytes = std::fs::metadata(file).map_or(0, |found| found.len() / 1000) as usize;
        Ok(TextTable { name, header, place, reader, dialect, lists, kilobytes })
    }

    /// Whether numbers are written as 0,5.
    pub fn has_decimal_commas(&self) -> bool {
        self.dialect.has_decimal_commas
    }

    /// Calls `each` with every row and its line. With `may_end_early`, a last row that is cut off is left out.
    pub fn rows(
        &mut self,
        may_end_early: bool,
        mut each: impl FnMut(u64, &csv::StringRecord) -> Result<()>,
    ) -> Result<()> {
        let (name, skipped) = (self.name.clone(), self.dialect.begin.1);
        let names = &self.dialect.names;
        let (expected, mut headers) = (names.len(), 0);
        let progress = Progress::new("reading", self.kilobytes, "kB");
        let mut record = csv::StringRecord::new();
        let mut short: Option<(u64, usize)> = None;
        loop {
            let is_there = self.reader.read_record(&mut record).map_err(|error| csv_failure(&name, skipped, &error))?;
            if let Some((line, found)) = short {
                if !is_there && may_end_early {
                    let what = format!(
                        "{name}:{line}: the last row is cut off ({found} of {expected} columns); it is left out"
                    );
                    failure::note(&what);
                    return Ok(());
                }
                return Err(unequal(&name, line, found, expected, self.dialect.separator));
            }
            if !is_there {
                if headers > 0 {
                    failure::note(&format!(
                        "{name}: the header is repeated {headers} times below; these lines are left out"
                    ));
                }
                return Ok(());
            }
            let line = record.position().map_or(0, csv::Position::line) + skipped;
            progress.at(record.position().map_or(0, |position| position.byte() / 1000) as usize);
            let found = record.len();
            let has_end = found == expected + 1 && record.get(expected).is_some_and(|cell| cell.trim().is_empty());
            let lacks_end = found + 1 == expected && names.last().is_some_and(String::is_empty);
            if expected > 0 && record.iter().map(str::trim).eq(names.iter().map(String::as_str)) {
                headers += 1;
            } else if found == expected || has_end || lacks_end {
                match self.lists.are_there() {
                    true => each(line, &self.lists.cells(record.iter()).collect())?,
                    false => each(line, &record)?,
                }
            } else {
                short = Some((line, found));
            }
        }
    }
}

/// True for the texts that programs write for a missing number.
fn is_missing(cell: &str) -> bool {
    const TEXTS: [&str; 16] = [
        "",
        "nan",
        "null",
        "none",
        "na",
        "n/a",
        "-",
        "--",
        "#n/a",
        "-nan",
        "nan(ind)",
        "-nan(ind)",
        "1.#qnan",
        "-1.#ind",
        "#value!",
        "?",
    ];
    TEXTS.contains(&cell.trim().to_lowercase().as_str())
}

/// Reads a file, or standard input for `-`. The robot is chosen by the header.
pub fn read<'m>(file: &str, choose: &dyn Fn(&[String]) -> &'m Model, how: &How) -> Result<Samples> {
    let mut text = TextTable::open(file)?;
    let (name, header) = (text.name.clone(), text.header.clone());
    let model = choose(&header.names);
    if header.names.is_empty() {
        return Err(Failure::wrong(format!(
            "{name}:1: the first line holds numbers, expected the columns' names; put a line such as `{}` before it",
            guess(model, header.first.len())
        )));
    }
    check_lists(&text)?;
    let found = Recognised::find(&text.place, &header, model, &how.request)?;
    let used = found.used(&name)?;
    let (mut lines, mut rows): (Vec<u64>, Vec<f64>) = Default::default();
    let cells = Cells { has_decimal_commas: text.dialect.has_decimal_commas, may_miss: how.may_miss };
    let is_time: Vec<bool> = used.iter().map(|&column| found.is_time(column)).collect();
    let names: Vec<usize> = (0..header.names.len()).filter(|&column| holds_names(&header.names[column])).collect();
    text.rows(how.may_miss, |line, record| {
        for &column in &names {
            let (first, now) = (header.first.get(column).map(String::as_str), record.get(column).map(str::trim));
            if first != now {
                return Err(Failure::wrong(format!(
                    "{name}:{line}: column {} (`{}`) is `{}`, `{}` before: the order of the joints changes, expected the \
                     same names in all rows",
                    column + 1,
                    header.names[column],
                    now.unwrap_or_default(),
                    first.unwrap_or_default()
                )));
            }
        }
        for (&column, &is_time) in used.iter().zip(&is_time) {
            let place = format_args!("{name}:{line}: column {} (`{}`)", column + 1, header.names[column]);
            rows.push(cells.number(place, record.get(column).unwrap_or_default(), is_time)?);
        }
        lines.push(line);
        Ok(())
    })?;
    if lines.is_empty() {
        return Err(Failure::wrong(format!("{name} has no rows below its header")));
    }
    found.notes.iter().for_each(|note| failure::note(note));
    rows.shrink_to_fit(); // up to half of it is empty, and the samples are a copy
    let mut place = vec![0; header.names.len()];
    used.iter().enumerate().for_each(|(k, &column)| place[column] = k);
    let samples = found.samples(&name, lines.len(), |row, column| rows[row * used.len() + place[column]]);
    Ok(Samples { lines, columns: found.rows, ..samples })
}

/// How cells become numbers.
struct Cells {
    has_decimal_commas: bool,
    /// Whether a cell without a number is NaN instead of an error.
    may_miss: bool,
}

impl Cells {
    /// The number of a cell; a date if it is the time. `place` names the cell in messages.
    fn number(&self, place: impl std::fmt::Display, cell: &str, is_time: bool) -> Result<f64> {
        let number = |cell: &str| cell.parse::<f64>().ok().filter(|x| x.is_finite() || self.may_miss);
        if let Some(x) = number(cell) {
            return Ok(x);
        }
        let cell = cell.trim();
        if let Some(x) = number(cell) {
            return Ok(x);
        }
        if self.may_miss && is_missing(cell) {
            return Ok(f64::NAN);
        }
        if is_time && let Some(t) = clock::seconds(cell) {
            return Ok(t);
        }
        if is_time && clock::is_ambiguous(cell) {
            return Err(Failure::wrong(format!(
                "{place} is `{cell}`, a date whose first number may be the month or the day; write it as \
                 2024-03-01T12:59:50.002, in pandas: df[\"t\"] = pandas.to_datetime(df[\"t\"])"
            )));
        }
        match self.has_decimal_commas {
            true => numbers::number(place, &cell.replacen(',', ".", 1)),
            false => numbers::number(place, cell),
        }
    }
}

/// A cell that holds lists of another kind is no number.
fn check_lists(text: &TextTable) -> Result<()> {
    for (column, cell) in text.header.first.iter().enumerate() {
        let cell = cell.trim();
        let name = text.header.names.get(column).map_or("", String::as_str);
        if cell.len() > 2 && cell.starts_with("[[") && cell.ends_with(']') {
            return Err(Failure::wrong(format!(
                "{}: column {} (`{name}`) holds nested lists, such as `{}`, expected one number or one list of numbers in \
                 each cell",
                text.place,
                column + 1,
                crate::terminal::excerpt(cell)
            )));
        }
    }
    Ok(())
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

fn unequal(file: &str, line: u64, found: usize, expected: usize, separator: Separator) -> Failure {
    let columns = if found == 1 { "column" } else { "columns" };
    let remedy = match separator {
        Separator::Byte(b',') if found > expected => {
            "; numbers with decimal commas need another separator, such as `;`"
        }
        _ => "",
    };
    Failure::wrong(format!("{file}:{line}: {found} {columns}, expected {expected} as in the header{remedy}"))
}

fn csv_failure(file: &str, skipped: u64, error: &csv::Error) -> Failure {
    match error.kind() {
        csv::ErrorKind::Utf8 { pos, err } => {
            let line = pos.as_ref().map_or(0, csv::Position::line) + skipped;
            Failure::wrong(format!("{file}:{line}: column {} is not UTF-8 text", err.field() + 1))
        }
        _ => Failure::wrong(format!("{file}: {error}")),
    }
}
