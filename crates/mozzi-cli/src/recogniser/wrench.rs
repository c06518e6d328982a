//! Columns of wrenches: `m_x` … `f_z` of the end effector's, `wrench_FRAME_m_x` … of a frame's.

use crate::failure::{Failure, Result};
use crate::numbers::WRENCH;

/// A wrench's table, `wrench` or `wrench_FRAME`, with its columns.
pub type Wrench = (String, [usize; 6]);

/// The name of a wrench's table, and the entry of a column: `m_x`, or `wrench_FRAME_m_x`, also with `.` before `m_x`.
pub fn of(column: &str) -> Option<(String, usize)> {
    if let Some(entry) = WRENCH.iter().position(|known| *known == column) {
        return Some(("wrench".to_string(), entry));
    }
    column.strip_prefix("wrench_")?;
    WRENCH.iter().enumerate().find_map(|(entry, known)| {
        let table = column.strip_suffix(known)?.strip_suffix(['_', '.', '/'])?;
        (table.len() > "wrench_".len()).then(|| (table.to_string(), entry))
    })
}

/// All wrenches; an incomplete one is an error, but for the three forces or moments of a sensor that has no others.
pub fn find(place: &str, names: &[String]) -> Result<Vec<Wrench>> {
    let mut found: Vec<(String, [Option<usize>; 6])> = Vec::new();
    for (column, name) in names.iter().enumerate() {
        let Some((table, entry)) = of(name.trim()) else { continue };
        let k = found.iter().position(|(known, _)| *known == table).unwrap_or_else(|| {
            found.push((table, [None; 6]));
            found.len() - 1
        });
        if let Some(first) = found[k].1[entry].replace(column) {
            let (first, second) = (first + 1, column + 1);
            return Err(Failure::wrong(format!("{place}: columns {first} and {second} both give `{}`", name.trim())));
        }
    }
    let whole = |(name, columns): (String, [Option<usize>; 6])| {
        if let Some(k) = columns.iter().position(Option::is_none) {
            let column = if name == "wrench" { WRENCH[k].to_string() } else { format!("{name}_{}", WRENCH[k]) };
            let count = columns.iter().flatten().count();
            return Err(Failure::wrong(format!(
                "{place}: column {column} is missing; the file has {count} of the 6 columns of its group"
            )));
        }
        Ok((name, columns.map(Option::unwrap_or_default)))
    };
    let is_half = |columns: &[Option<usize>; 6]| {
        let [moments, forces] = [&columns[..3], &columns[3..]].map(|half| half.iter().flatten().count());
        [moments, forces] == [3, 0] || [moments, forces] == [0, 3]
    };
    found.retain(|(name, columns)| name != "wrench" || !is_half(columns));
    found.into_iter().map(whole).collect()
}
