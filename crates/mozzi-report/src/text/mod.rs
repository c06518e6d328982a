//! Numbers and tables as text for a terminal: aligned at the decimal point, and not wider than the page if possible.

mod columns;
mod sections;
mod wrap;

pub use columns::{rows_of, table};
pub use sections::{Sections, cut};
pub use wrap::wrapped;

use mozzi::Twist;
use nalgebra::DMatrix;

/// Columns of the page: the terminal's, at most 120, or 80 without a terminal.
pub fn page_width() -> usize {
    let terminal = terminal_size::terminal_size_of(std::io::stdout());
    terminal.map_or(80, |(terminal_size::Width(columns), _)| usize::from(columns).clamp(40, 120))
}

/// Columns that a text occupies: combining dots, as in θ̇, take none.
pub fn width(text: &str) -> usize {
    text.chars().filter(|c| !('\u{300}'..='\u{36f}').contains(c)).count()
}

/// Pads with spaces on the right, or on the left.
pub fn pad(text: &str, to: usize, align: char) -> String {
    let space = " ".repeat(to.saturating_sub(width(text)));
    if align == 'r' { space + text } else { text.to_string() + &space }
}

/// The format of the numbers of a table: the same number of decimals for all, so that their points are aligned. Numbers
/// below 10⁻¹² of the largest are rounding errors and shown as 0.
#[derive(Clone, Copy)]
pub struct Decimals {
    places: usize,
    scientific: bool,
    /// Constants keep their digits: a number that would lose digits is written with an exponent.
    is_constant: bool,
    rounding: f64,
}

/// A number shown with a larger relative error counts as truncated.
const LOST: f64 = 0.01;

impl Decimals {
    /// About five digits for the largest number, fewer if all are short.
    pub fn of<'a>(values: impl IntoIterator<Item = &'a f64>) -> Self {
        Self::with_digits(values, 4)
    }

    /// About eight digits: for constants.
    pub fn long<'a>(values: impl IntoIterator<Item = &'a f64>) -> Self {
        Decimals { is_constant: true, ..Self::with_digits(values, 7) }
    }

    /// As [`of`](Self::of), where a number that would lose its digits is written with an exponent.
    pub fn kept<'a>(values: impl IntoIterator<Item = &'a f64>) -> Self {
        Decimals { is_constant: true, ..Self::of(values) }
    }

    /// As [`of`](Self::of), where numbers up to `noise` are rounding errors and shown as 0.
    pub fn above<'a>(noise: f64, values: impl IntoIterator<Item = &'a f64>) -> Self {
        let decimals = Self::of(values.into_iter().filter(|x| x.abs() > noise));
        Decimals { rounding: decimals.rounding.max(noise), ..decimals }
    }

    fn with_digits<'a>(values: impl IntoIterator<Item = &'a f64>, digits: i32) -> Self {
        let values: Vec<f64> = values.into_iter().copied().filter(|x| x.is_finite()).collect();
        let largest = values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let exponent = if largest > 0.0 { largest.log10().floor() as i32 } else { 0 };
        if !(-4..=7).contains(&exponent) {
            return Decimals {
                places: digits as usize,
                scientific: true,
                is_constant: false,
                rounding: 1e-12 * largest,
            };
        }
        let most = if exponent >= 0 { (digits - exponent).max(1) } else { digits - 1 - exponent } as usize;
        let rounding = 1e-12 * largest;
        let exact = |places: usize| {
            values.iter().all(|x| {
                let shown: f64 = format!("{x:.places$}").parse().unwrap_or(f64::NAN);
                (shown - x).abs() <= rounding
            })
        };
        let places = (0..most).find(|&places| exact(places)).unwrap_or(most);
        Decimals { places, scientific: false, is_constant: false, rounding }
    }

    /// For a computed matrix: with exponents if an entry of its diagonal would lose its digits, such as a small joint's
    /// in M.
    fn of_matrix(M: &DMatrix<f64>) -> Self {
        let decimals = Self::of(M.iter());
        let is_lost = M.is_square() && M.diagonal().iter().any(|&x| decimals.loses(x));
        if is_lost { Decimals { places: 4, scientific: true, ..decimals } } else { decimals }
    }

    /// True if too few digits would be shown.
    fn loses(self, x: f64) -> bool {
        let shown: f64 = format!("{x:.*}", self.places).parse().unwrap_or(f64::NAN);
        x.is_finite() && x.abs() > self.rounding && !self.scientific && (shown - x).abs() > LOST * x.abs()
    }

    /// A number of the table.
    pub fn show(self, x: f64) -> String {
        let places = self.places;
        if !x.is_finite() {
            x.to_string()
        } else if x.abs() <= self.rounding {
            let tail = if self.scientific { places + 3 } else { places };
            "0".to_string() + &" ".repeat(if places > 0 { tail + 1 } else { 0 })
        } else if self.scientific {
            format!("{x:.places$e}")
        } else if self.is_constant && self.loses(x) {
            let short = format!("{x:e}");
            if short.len() <= 10 { short } else { format!("{x:.4e}") }
        } else {
            let text = format!("{x:.places$}");
            let zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
            if zero { text.trim_start_matches('-').to_string() } else { text }
        }
    }
}

/// Two digits of a small number: an error, a drift.
pub fn about(x: f64) -> String {
    match x.abs() {
        0.0 => "0".to_string(),
        size if (0.01..1000.0).contains(&size) => format!("{x:.2}"),
        _ => format!("{x:.1e}"),
    }
}

/// So many significant digits; an exponent if there would be many zeros.
pub fn digits(x: f64, count: usize) -> String {
    if x == 0.0 || !x.is_finite() {
        return (x + 0.0).to_string();
    }
    let text = format!("{x:.*e}", count - 1);
    let exponent = text.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0);
    match exponent {
        -4..=6 => format!("{x:.*}", (count as i32 - 1 - exponent).max(0) as usize),
        _ => text,
    }
}

/// One number alone.
pub fn scalar(x: f64) -> String {
    Decimals::long([&x]).show(x).trim().to_string()
}

/// "(0, 0, -9.81)"
pub fn tuple(values: &[f64]) -> String {
    let entries: Vec<String> = values.iter().map(|&x| scalar(x)).collect();
    format!("({})", entries.join(", "))
}

/// Numbers in a column.
pub fn column(values: &[f64]) -> Vec<String> {
    column_within(values, 0.0)
}

/// Numbers in a column of a table whose largest number is `largest`: rounding is relative to that.
pub fn column_within(values: &[f64], largest: f64) -> Vec<String> {
    let mut decimals = Decimals::long(values.iter().filter(|x| x.abs() > 1e-12 * largest));
    decimals.rounding = decimals.rounding.max(1e-12 * largest);
    values.iter().map(|&x| decimals.show(x)).collect()
}

/// Constant twists, in rows of six cells.
pub fn twists(list: &[Twist]) -> Vec<Vec<String>> {
    let rows: Vec<[f64; 6]> = list.iter().map(|V| V.to_array()).collect();
    let largest = largest(rows.as_flattened());
    rows_of((0..6).map(|c| column_within(&rows.iter().map(|row| row[c]).collect::<Vec<_>>(), largest)).collect())
}

/// Rows of six computed numbers, with about five digits.
pub fn sixes(rows: &[[f64; 6]]) -> Vec<Vec<String>> {
    let decimals = Decimals::of(rows.as_flattened());
    rows.iter().map(|row| row.iter().map(|&x| decimals.show(x)).collect()).collect()
}

/// The largest magnitude; 0 for an empty list.
pub fn largest<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    values.into_iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// Entries one after the other, in lines that fit.
pub fn flow(entries: &[String]) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for entry in entries {
        match lines.last_mut() {
            Some(line) if width(line) + width(entry) + 4 <= page_width() => line.push_str(&format!("  {entry}")),
            _ => lines.push(entry.clone()),
        }
    }
    lines
}

/// A computed matrix, in brackets; if it is too wide, in groups of numbered columns.
pub fn matrix(M: &DMatrix<f64>) -> Vec<String> {
    matrix_with(M, Decimals::of_matrix(M))
}

/// A matrix of constants, with their digits.
pub fn constants<const R: usize, const C: usize>(rows: [[f64; C]; R]) -> Vec<String> {
    matrix_with(&DMatrix::from_fn(R, C, |r, c| rows[r][c]), Decimals::long(rows.as_flattened()))
}

fn matrix_with(M: &DMatrix<f64>, decimals: Decimals) -> Vec<String> {
    let cells: Vec<Vec<String>> = M.row_iter().map(|row| row.iter().map(|&x| decimals.show(x)).collect()).collect();
    let cell = cells.iter().flatten().map(|cell| width(cell)).max().unwrap_or(1);
    let (rows, columns) = M.shape();
    let fit = ((page_width() - 12) / (cell + 1)).max(1);
    let mut lines = Vec::new();
    for first in (0..columns).step_by(fit) {
        let last = (first + fit).min(columns);
        if columns > fit {
            lines.push(format!("columns {} to {last} of {columns}", first + 1));
        }
        for (r, row) in cells.iter().enumerate() {
            let (open, close) = match r {
                _ if rows == 1 => ('[', ']'),
                0 => ('⎡', '⎤'),
                r if r + 1 == rows => ('⎣', '⎦'),
                _ => ('⎢', '⎥'),
            };
            let entries: Vec<String> = row[first..last].iter().map(|entry| pad(entry, cell, 'r')).collect();
            lines.push(format!("{open} {} {close}", entries.join(" ")));
        }
    }
    lines
}

/// Blocks side by side, each below its title; below each other if they do not fit.
pub fn beside(blocks: &[(String, Vec<String>)]) -> Vec<String> {
    let titled = |(title, lines): &(String, Vec<String>)| {
        let mut all = vec![title.clone()];
        all.extend(lines.iter().map(|line| format!("  {line}")));
        all
    };
    let mut result: Vec<String> = Vec::new();
    let mut current: Vec<String> = Vec::new();
    for block in blocks.iter().map(titled) {
        let (left, right) = (widest(&current), widest(&block));
        if current.is_empty() || left + 3 + right + 2 > page_width() {
            result.append(&mut current);
            current = block;
            continue;
        }
        current.resize(current.len().max(block.len()), String::new());
        for (k, line) in block.iter().enumerate() {
            current[k] = format!("{}   {line}", pad(&current[k], left, 'l')).trim_end().to_string();
        }
    }
    result.append(&mut current);
    result
}

fn widest(lines: &[String]) -> usize {
    lines.iter().map(|line| width(line)).max().unwrap_or(0)
}

/// Text that grows by lines.
#[derive(Default)]
pub struct Page(String);

impl Page {
    /// One more line; one that is wider than the page is wrapped.
    pub fn line(&mut self, line: impl AsRef<str>) -> &mut Self {
        for part in wrapped(line.as_ref().trim_end(), page_width(), 2) {
            self.0.push_str(&part);
            self.0.push('\n');
        }
        self
    }

    /// A line as it is, however wide: a command to paste.
    pub fn verbatim(&mut self, line: &str) -> &mut Self {
        self.0.push_str(line);
        self.0.push('\n');
        self
    }

    /// An empty line.
    pub fn blank(&mut self) -> &mut Self {
        self.line("")
    }

    /// "── title ──────" after an empty line.
    pub fn title(&mut self, title: &str) -> &mut Self {
        let rule = "─".repeat(page_width().saturating_sub(width(title) + 4));
        self.blank().line(format!("── {title} {rule}"))
    }

    /// Lines, indented by two spaces.
    pub fn lines(&mut self, lines: &[String]) -> &mut Self {
        lines.iter().for_each(|line| {
            self.line(format!("  {line}"));
        });
        self
    }

    /// The number of lines so far.
    pub fn count(&self) -> usize {
        self.0.lines().count()
    }

    /// The text.
    pub fn end(&mut self) -> String {
        std::mem::take(&mut self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_significant() {
        let of = |x| digits(x, 3);
        assert_eq!(
            [0.0, 12345.0, -1.26e-6, 0.00012345, 0.99999].map(of),
            ["0", "12345", "-1.26e-6", "0.000123", "1.00"]
        );
        assert_eq!([1e7, 2.0, f64::INFINITY].map(of), ["1.00e7", "2.00", "inf"]);
    }

    #[test]
    fn small_numbers_keep_their_digits() {
        assert_eq!(column(&[1.0, 1e-9, 2.5e-4]), ["1.0000000", "1e-9", "0.0002500"]);
        assert_eq!(column(&[2.0, 1.23456789e-8, 0.0]).map_trimmed(), ["2.0000000", "1.2346e-8", "0"]);
        // rounding of a larger number is 0
        assert_eq!(column(&[1.0, 1e-17]).map_trimmed(), ["1", "0"]);
        let small = DMatrix::from_row_slice(2, 2, &[0.5, 2e-7, 2e-7, 3.1e-7]);
        assert!(matrix(&small).concat().contains("3.1000e-7"), "{:?}", matrix(&small));
        let usual = DMatrix::from_row_slice(2, 2, &[0.5123, 1e-9, 1e-9, 0.0312]);
        assert!(!matrix(&usual).concat().contains('e'), "{:?}", matrix(&usual));
    }

    trait Trimmed {
        fn map_trimmed(&self) -> Vec<&str>;
    }

    impl Trimmed for Vec<String> {
        fn map_trimmed(&self) -> Vec<&str> {
            self.iter().map(|text| text.trim()).collect()
        }
    }
}
