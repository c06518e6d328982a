//! Tables of cells: as wide as the page, else in groups of columns, or with a wrapped last column.

use crate::text::{pad, page_width, width, wrapped};

/// Columns that indentation may take.
const INDENTATION: usize = 4;
/// A column of text is not wrapped into less.
const NARROWEST: usize = 16;

/// Cells in columns, two spaces between them. `align` has one 'l' or 'r' for each column; the last one applies to all
/// further columns. What is wider than the page is shown in groups of columns, each with the columns up to the first of
/// text; a last column of text is wrapped.
pub fn table(rows: &[Vec<String>], align: &str) -> Vec<String> {
    within(rows, align, page_width().saturating_sub(INDENTATION))
}

fn within(rows: &[Vec<String>], align: &str, room: usize) -> Vec<String> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let aligns: Vec<char> = align.chars().collect();
    let align = |c: usize| aligns.get(c).or(aligns.last()).copied().unwrap_or('l');
    let widths: Vec<usize> = (0..columns)
        .map(|c| rows.iter().filter_map(|row| row.get(c)).map(|cell| width(cell)).max().unwrap_or(0))
        .collect();
    let total =
        |picked: &[usize]| picked.iter().map(|&c| widths[c]).sum::<usize>() + 2 * picked.len().saturating_sub(1);
    let lines = |picked: &[usize]| -> Vec<String> {
        let line = |row: &Vec<String>| {
            let cells: Vec<String> =
                picked.iter().filter_map(|&c| Some(pad(row.get(c)?, widths[c], align(c)))).collect();
            cells.join("  ").trim_end().to_string()
        };
        rows.iter().map(line).collect()
    };
    let all: Vec<usize> = (0..columns).collect();
    if total(&all) <= room {
        return lines(&all);
    }
    let before = total(&all[..columns - 1]) + 2;
    if columns > 1 && align(columns - 1) == 'l' && before + NARROWEST <= room {
        return with_wrapped_end(rows, &lines(&all[..columns - 1]), before, room);
    }
    let labels = (0..columns).find(|&c| align(c) == 'l').map_or(1, |c| c + 1).min(columns - 1);
    let mut found = Vec::new();
    let mut group: Vec<usize> = (0..labels).collect();
    for c in labels..columns {
        let wider = [&group[..], &[c]].concat();
        if group.len() > labels && total(&wider) > room {
            found.extend(lines(&group));
            group = (0..labels).collect();
        }
        group.push(c);
    }
    found.extend(lines(&group));
    found
}

/// The last column's text in several lines.
fn with_wrapped_end(rows: &[Vec<String>], begins: &[String], before: usize, room: usize) -> Vec<String> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let mut found = Vec::new();
    for (row, begin) in rows.iter().zip(begins) {
        let text = row.get(columns - 1).map_or("", String::as_str);
        for (k, part) in wrapped(text, room - before, 2).iter().enumerate() {
            let line = if k == 0 { pad(begin, before, 'l') } else { " ".repeat(before) } + part;
            found.push(line.trim_end().to_string());
        }
    }
    found
}

/// Converts columns to rows.
pub fn rows_of(columns: Vec<Vec<String>>) -> Vec<Vec<String>> {
    let count = columns.iter().map(Vec::len).max().unwrap_or(0);
    (0..count).map(|r| columns.iter().map(|column| column.get(r).cloned().unwrap_or_default()).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::within;

    fn rows(text: &str) -> Vec<Vec<String>> {
        text.lines().map(|line| line.split('|').map(str::to_string).collect()).collect()
    }

    #[test]
    fn wide_tables_are_groups_of_columns() {
        let rows = rows("name|x|y|z\nelbow|1.5|22.5|3");
        assert_eq!(within(&rows, "lr", 40), ["name     x     y  z", "elbow  1.5  22.5  3"]);
        assert_eq!(
            within(&rows, "lr", 12),
            ["name     x", "elbow  1.5", "name      y", "elbow  22.5", "name   z", "elbow  3"]
        );
    }

    #[test]
    fn a_last_column_of_text_is_wrapped() {
        let rows = rows("a|one two three four five six\nb|seven");
        assert_eq!(within(&rows, "l", 20), ["a  one two three", "     four five six", "b  seven"]);
    }
}
