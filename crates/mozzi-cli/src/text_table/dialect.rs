//! How a text is written: its separator, its decimal mark, and where its header is.

use super::clock;
use crate::failure::{Failure, Result};
use crate::recogniser::unit;

/// Lines that are looked at.
const MOST: usize = 60;

/// Lines of one cell.
const MOST_OF_CELL: usize = 20;

/// The separator of columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Separator {
    Byte(u8),
    /// Any number of spaces and tabs.
    Blanks,
}

impl Separator {
    pub fn byte(self) -> u8 {
        match self {
            Separator::Byte(byte) => byte,
            Separator::Blanks => b' ',
        }
    }

    fn name(self) -> &'static str {
        match self {
            Separator::Byte(b';') => "`;`",
            Separator::Byte(b'\t') => "tabs",
            Separator::Byte(_) => "commas",
            Separator::Blanks => "blanks",
        }
    }
}

#[derive(Clone, Debug)]
pub struct Dialect {
    pub separator: Separator,
    pub has_decimal_commas: bool,
    /// Empty if the first line holds numbers.
    pub names: Vec<String>,
    /// The line of the names.
    pub line: u64,
    pub units: Vec<String>,
    /// The cells of the first row.
    pub first: Vec<String>,
    /// The number of bytes before the first row, and of lines.
    pub begin: (usize, u64),
    pub notes: Vec<String>,
}

/// A line with its place.
struct Line<'t> {
    text: &'t str,
    end: usize,
    number: u64,
}

/// The cells of one line.
pub fn cells(line: &str, separator: Separator) -> Vec<String> {
    if separator == Separator::Blanks && !line.contains('"') {
        return line.split_whitespace().map(str::to_string).collect();
    }
    let mut reader = csv::ReaderBuilder::new();
    reader.has_headers(false).delimiter(separator.byte()).trim(csv::Trim::All).flexible(true);
    let text = if separator == Separator::Blanks {
        line.split_whitespace().collect::<Vec<_>>().join(" ")
    } else {
        line.to_string()
    };
    let record = reader.from_reader(text.as_bytes()).into_records().next();
    record.and_then(std::result::Result::ok).map_or_else(Vec::new, |record| record.iter().map(str::to_string).collect())
}

fn is_number(cell: &str) -> bool {
    let cell = cell.trim();
    cell.starts_with(|c: char| c.is_ascii_digit() || "+-.,−".contains(c))
        && (cell.parse::<f64>().is_ok() || cell.replacen(',', ".", 1).replace('−', "-").parse::<f64>().is_ok())
}

fn is_row(cells: &[String]) -> bool {
    cells.iter().any(|cell| is_number(cell) || clock::seconds(cell).is_some())
}

/// A guess with one separator.
struct Guess<'t> {
    separator: Separator,
    names: Vec<String>,
    header: Option<&'t Line<'t>>,
    units: Vec<String>,
    row: usize,
    /// Whether header and rows have as many cells.
    is_whole: bool,
}

impl Dialect {
    /// From the beginning of a file; `is_all` if there is no more.
    pub fn of(name: &str, text: &str, is_all: bool) -> Result<Self> {
        let all = logical_lines(text, is_all);
        let is_comment =
            |line: &Line| line.text.trim_start().starts_with(['#', '%']) && !line.text.starts_with("%time");
        let comments: Vec<&Line> = all.iter().filter(|line| is_comment(line)).collect();
        let lines: Vec<&Line> =
            all.iter().filter(|line| !is_comment(line) && !line.text.trim().is_empty()).take(MOST).collect();
        if lines.is_empty() {
            return Err(Failure::wrong(match comments.is_empty() {
                true => format!("{name} is empty, expected a header and rows of numbers"),
                false => format!("{name} has no rows below its header"),
            }));
        }
        let separators = [Separator::Byte(b';'), Separator::Byte(b'\t'), Separator::Byte(b','), Separator::Blanks];
        let guesses: Vec<Guess> =
            separators.iter().filter_map(|separator| guess(*separator, &lines, &comments)).collect();
        let guess = match guesses.iter().position(|guess| guess.is_whole) {
            Some(k) => &guesses[k],
            // one column, or rows of other lengths than the header
            None => {
                let most = |guess: &&Guess| (guess.names.len(), guess.separator == Separator::Byte(b','));
                match guesses.iter().max_by_key(most) {
                    Some(guess) => guess,
                    None => return without_rows(name, &lines),
                }
            }
        };
        Dialect::with(name, guess, &lines, &all)
    }

    fn with(name: &str, guess: &Guess, lines: &[&Line], all: &[Line]) -> Result<Self> {
        let separator = guess.separator;
        let rows: Vec<Vec<String>> = lines[guess.row..].iter().map(|line| cells(line.text, separator)).collect();
        let number = lines[guess.row].number;
        let before = all.iter().take_while(|line| line.number < number).last();
        let begin = (before.map_or(0, |line| line.end), number - 1);
        let mut notes = Vec::new();
        let numbers = || rows.iter().flatten().filter(|cell| is_number(cell));
        let has_commas = numbers().any(|cell| cell.contains(','));
        let has_points = numbers().any(|cell| cell.contains('.') && !cell.contains(','));
        let mixed = rows.iter().flatten().find(|cell| {
            cell.contains(',') && cell.contains('.') && cell.chars().all(|c| c.is_ascii_digit() || "+-.,".contains(c))
        });
        if let Some(cell) = mixed {
            return Err(Failure::wrong(format!(
                "{name}: `{cell}` has a comma and a point, expected numbers without separators of thousands"
            )));
        }
        if has_commas && has_points {
            return Err(Failure::wrong(format!(
                "{name} has numbers with decimal commas and others with points, expected one kind"
            )));
        }
        if has_commas {
            notes.push(format!("{name}: numbers have decimal commas, and {} between columns", separator.name()));
        }
        Ok(Dialect {
            separator,
            has_decimal_commas: has_commas,
            names: guess.names.clone(),
            line: guess.header.map_or(1, |line| line.number),
            units: guess.units.clone(),
            first: rows.into_iter().next().unwrap_or_default(),
            begin,
            notes,
        })
    }
}

/// The lines; a cell in quotes may continue on the next ones.
fn logical_lines(text: &str, is_all: bool) -> Vec<Line<'_>> {
    let mut ends: Vec<usize> = text.match_indices('\n').map(|(k, _)| k + 1).collect();
    if ends.last().copied().unwrap_or(0) < text.len() {
        ends.push(text.len());
    }
    let (mut all, mut begin, mut k) = (Vec::new(), 0, 0);
    while k < ends.len() {
        let is_balanced = |end: &usize| text[begin..*end].bytes().filter(|&byte| byte == b'"').count() % 2 == 0;
        let more = ends[k..].iter().take(MOST_OF_CELL).position(is_balanced).unwrap_or(0);
        let end = ends[k + more];
        if text[..end].ends_with('\n') || is_all {
            let bare = text[begin..end].trim_end_matches(['\n', '\r']).trim_start_matches('\u{feff}');
            all.push(Line { text: bare, end, number: k as u64 + 1 });
        }
        (begin, k) = (end, k + more + 1);
    }
    all
}

/// A header without rows.
fn without_rows(name: &str, lines: &[&Line]) -> Result<Dialect> {
    let separator = match lines[0].text {
        text if text.contains(';') => Separator::Byte(b';'),
        text if text.contains('\t') => Separator::Byte(b'\t'),
        text if text.contains(',') || !text.trim().contains(' ') => Separator::Byte(b','),
        _ => Separator::Blanks,
    };
    let last = lines.last().map_or((0, 0), |line| (line.end, line.number));
    let rows: Vec<String> = lines.get(1).map_or_else(Vec::new, |line| cells(line.text, separator));
    let begin = if rows.is_empty() { last } else { (lines[0].end, lines[0].number) };
    let names = cells(lines[0].text, separator);
    if names.is_empty() {
        return Err(Failure::wrong(format!("{name} is empty, expected a header and rows of numbers")));
    }
    Ok(Dialect {
        separator,
        has_decimal_commas: false,
        names,
        line: lines[0].number,
        units: Vec::new(),
        first: rows,
        begin,
        notes: Vec::new(),
    })
}

fn guess<'t>(separator: Separator, lines: &[&'t Line<'t>], comments: &[&'t Line<'t>]) -> Option<Guess<'t>> {
    let split: Vec<Vec<String>> = lines.iter().map(|line| cells(line.text, separator)).collect();
    let fits = |k: usize| is_row(&split[k]) && split.get(k + 1).is_some_and(|next| next.len() == split[k].len());
    let row = (0..split.len()).find(|&k| fits(k)).or_else(|| (0..split.len()).find(|&k| is_row(&split[k])))?;
    let count = split[row].len();
    let is_even = split[row..].iter().rev().skip(1).all(|cells| cells.len() == count);
    let is_unit = |cell: &String| cell.is_empty() || cell == "-" || unit::unit(cell).is_some();
    let mut header = row.checked_sub(1);
    let mut units = Vec::new();
    if let Some(k) =
        header.filter(|&k| k > 0 && split[k].iter().all(is_unit) && split[k].iter().any(|cell| !cell.is_empty()))
    {
        units = split[k].clone();
        header = k.checked_sub(1);
    }
    let matches = |cells: &[String]| {
        cells.len() == count
            || cells.len() + 1 == count && split[row].last().is_some_and(String::is_empty)
            || cells.len() == count + 1 && cells.last().is_some_and(String::is_empty)
    };
    let (line, names) = match header {
        Some(k) => (Some(lines[k]), split[k].clone()),
        // numpy's `# t,q1`, MATLAB's `% t,q1`
        None => {
            let bare = |line: &'t Line<'t>| line.text.trim_start().trim_start_matches(['#', '%']).trim();
            let all =
                [separator, Separator::Byte(b','), Separator::Byte(b';'), Separator::Byte(b'\t'), Separator::Blanks];
            let before = comments.iter().rev().filter(|line| line.number < lines[row].number);
            let found = before.into_iter().find_map(|line| {
                let of = |separator: &Separator| {
                    Some(cells(bare(line), *separator)).filter(|cells| matches(cells) && !is_row(cells))
                };
                Some((Some(*line), all.iter().find_map(of)?))
            });
            found.unwrap_or((None, Vec::new()))
        }
    };
    let is_whole = is_even && count >= 2 && (names.is_empty() || matches(&names));
    Some(Guess { separator, names, header: line, units, row, is_whole })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Dialect {
        Dialect::of("log", text, true).expect(text)
    }

    #[test]
    fn texts_are_written_in_many_ways() {
        for (text, separator, names) in [
            ("t,q1\n0,1\n1,2\n", Separator::Byte(b','), 2),
            ("t;q1\n0,5;1\n1,5;2\n", Separator::Byte(b';'), 2),
            ("t\tq1\tq2\n0.5\t1\t2\n1\t2\t3\n", Separator::Byte(b'\t'), 3),
            ("t q1 q2\n0,5 1,5 2,0\n1,5 2,0 3,5\n", Separator::Blanks, 3),
            ("  t   q1\n 0.5  1\n 1.5  2\n", Separator::Blanks, 2),
            ("# t,q1\n0,1\n1,2\n", Separator::Byte(b','), 2),
            ("# t q1\n0.0 1.0\n1 2\n", Separator::Blanks, 2),
            ("# written today\n# t q1\n0.0,1.0\n1,2\n", Separator::Byte(b','), 2),
            ("%time,field.position0\n17,1\n18,2\n", Separator::Byte(b','), 2),
            ("A log\nt;q1\ns;rad\n0;1\n1;2\n", Separator::Byte(b';'), 2),
            ("t\n0.5\n1\n", Separator::Byte(b','), 1),
            ("0.5,1\n0.6,1\n", Separator::Byte(b','), 0),
        ] {
            let found = of(text);
            assert_eq!((found.separator, found.names.len()), (separator, names), "{text}: {found:?}");
        }
        let found = of("A log\nt;q1\ns;deg\n0,5;1\n1;2\n");
        assert_eq!(
            (found.units, found.begin, found.has_decimal_commas),
            (vec!["s".into(), "deg".into()], (17, 3), true)
        );
        let why = format!("{:?}", Dialect::of("log", "t;q1\n1.000,5;2\n", true).expect_err("thousands"));
        assert!(why.contains("thousands"), "{why}");
    }
}
