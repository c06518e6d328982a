//! The last column of `benches/GPU.md`: what share was reached of the bound that `docs/gpu.md` counts for the same
//! kernel.

use std::collections::BTreeMap;

/// A kernel: robot, quantity, and precision with layout.
type Key = (String, String, String);
/// The column's heading, and the card of the bounds.
const HEADING: &str = "of the bound";
const CARD: &str = "NVIDIA H200";
/// Columns before it.
const WIDTH: usize = 7;

/// The cells of a table's row.
fn cells(line: &str) -> Option<Vec<&str>> {
    Some(line.strip_prefix('|')?.strip_suffix('|')?.split('|').map(str::trim).collect())
}

/// The number at the beginning of a cell.
fn number(cell: &str) -> Option<f64> {
    cell.split_whitespace().next()?.parse().ok()
}

/// Each row of the tables with its key.
fn rows(page: &str) -> impl Iterator<Item = (Key, Vec<&str>)> {
    let mut robot = String::new();
    page.lines().filter_map(move |line| {
        if let Some(heading) = line.strip_prefix("## ") {
            robot = heading.split(", n = ").next().unwrap_or_default().to_string();
        }
        let cells = cells(line)?;
        Some(((robot.clone(), (*cells.first()?).to_string(), (*cells.get(1)?).to_string()), cells))
    })
}

/// The measured page with the column, new or again. A page of another card has none.
pub fn add(measured: &str, counted: &str) -> String {
    let bounds: BTreeMap<Key, f64> =
        rows(counted).filter_map(|(key, cells)| Some((key, number(cells.last()?)?))).collect();
    let is_of_card = measured.lines().any(|line| line.starts_with("Written by") && line.contains(CARD));
    let mut keys = rows(measured).map(|(key, _)| key);
    let mut page = String::new();
    for line in measured.lines() {
        let row = cells(line).map(|found| (found, keys.next()));
        match row {
            // those of the kernels, without the column or with it
            Some((mut row, Some(key))) if is_of_card && (WIDTH..=WIDTH + 1).contains(&row.len()) => {
                let reached = number(row[3]).zip(bounds.get(&key));
                let share = reached.map(|(reached, bound)| format!("{:.0} %", 100.0 * reached / bound));
                let is_rule = row[0].starts_with("---");
                row.truncate(WIDTH);
                row.push(match row[0] {
                    "quantity" => HEADING,
                    _ if is_rule => "---",
                    _ => share.as_deref().unwrap_or_default(),
                });
                page += &if is_rule { format!("|{}|\n", row.join("|")) } else { format!("| {} |\n", row.join(" | ")) };
            }
            _ => {
                page += line;
                page.push('\n');
            }
        }
    }
    page
}

#[cfg(test)]
mod tests {
    use super::add;

    const COUNTED: &str = "# GPU kernels, counted\n\n## Panda, n = 7\n\n| quantity | | bytes | bound on an H200 |\n\
        |---|---|---|---|\n| mass matrix | f32 SoA | 112 | 21.4 memory |\n";
    const MEASURED: &str = "# GPU kernels, measured\n\nWritten by `cargo xtask gpu-bench`. NVIDIA H200. Bounds are for an H200.\n\n## Panda\n\n\
        | quantity | | registers | on the device | from the host | memory | error, ε |\n|---|---|---|---|---|---|---|\n\
        | mass matrix | f32 SoA | 40 | 14.728 (14.719) | 0.0074 | 81 % | 3.6 |\n\
        | mass matrix | f64 SoA | 72 | 8.4 (8.3) | 0.0034 | 92 % | 6.1 |\n\n## Rollouts\n\n| robot | robots |\n|---|---|\n\
        | UR5 | 10 |\n";

    #[test]
    fn the_column_is_added_once() {
        let page = add(MEASURED, COUNTED);
        assert!(page.contains("| memory | error, ε | of the bound |\n|---|---|---|---|---|---|---|---|\n"), "{page}");
        assert!(
            page.contains("| mass matrix | f32 SoA | 40 | 14.728 (14.719) | 0.0074 | 81 % | 3.6 | 69 % |"),
            "{page}"
        );
        assert!(page.contains("| 92 % | 6.1 |  |\n") && page.contains("| UR5 | 10 |\n"), "{page}");
        assert_eq!(add(&page, COUNTED), page);
        assert_eq!(
            add(&page.replace("NVIDIA H200", "NVIDIA A100"), COUNTED),
            page.replace("NVIDIA H200", "NVIDIA A100")
        );
    }
}
