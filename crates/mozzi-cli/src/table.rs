//! Rows of quantities, one entry for each joint.

use crate::robot::Units;
use crate::text::{Decimals, page_width, rows_of, table, width};
use mozzi::Model;
use mozzi::quantities::Input;

/// A vector over the joints: its symbol, name and unit.
pub struct Quantity<'a> {
    pub symbol: &'a str,
    pub name: &'a str,
    pub unit: String,
    pub values: &'a [f64],
}

impl<'a> Quantity<'a> {
    /// An input.
    pub fn of(input: &'a Input, units: &Units, values: &'a [f64]) -> Self {
        Quantity::new(input.symbol, input.about, units.own(input.unit), values)
    }

    pub fn new(symbol: &'a str, name: &'a str, unit: impl Into<String>, values: &'a [f64]) -> Self {
        Quantity { symbol, name, unit: unit.into(), values }
    }
}

/// Lines of quantities below the joints' numbers. With a floating base, columns next to the names of their entries,
/// since there are more positions than velocities.
pub fn quantities(model: &Model, list: &[Quantity], common: bool) -> Vec<String> {
    if model.configuration_space().is_flat() {
        return by_number(list, common);
    }
    let (positions, others): (Vec<&Quantity>, Vec<&Quantity>) =
        list.iter().partition(|quantity| quantity.values.len() == model.nq());
    let mut lines = Vec::new();
    for (names, list) in [(model.position_names().collect(), positions), (model.velocity_names().collect(), others)] {
        if !list.is_empty() {
            lines.extend(by_name(names, &list, common));
        }
    }
    lines
}

/// Columns of quantities next to the names of their entries.
fn by_name(names: Vec<&str>, list: &[&Quantity], common: bool) -> Vec<String> {
    let all = Decimals::of(list.iter().flat_map(|quantity| quantity.values));
    let mut columns =
        vec![[["", "", ""].as_slice(), &names].concat().into_iter().map(String::from).collect::<Vec<_>>()];
    for quantity in list {
        let decimals = if common { all } else { Decimals::of(quantity.values) };
        let mut column = vec![quantity.symbol.trim().to_string(), quantity.name.to_string(), quantity.unit.clone()];
        column.extend(quantity.values.iter().map(|&x| decimals.show(x)));
        columns.push(column);
    }
    table(&rows_of(columns), "lr")
}

/// Lines of quantities below the joints' numbers; in groups if there are many joints. With `common`, the decimal points
/// of all are aligned: for terms of one sum.
fn by_number(list: &[Quantity], common: bool) -> Vec<String> {
    let all = Decimals::of(list.iter().flat_map(|quantity| quantity.values));
    let cells: Vec<Vec<String>> = list
        .iter()
        .map(|quantity| {
            let decimals = if common { all } else { Decimals::of(quantity.values) };
            quantity.values.iter().map(|&x| decimals.show(x)).collect()
        })
        .collect();
    let n = cells.iter().map(Vec::len).max().unwrap_or(0);
    let labels =
        |quantity: &Quantity| vec![quantity.symbol.to_string(), quantity.name.to_string(), quantity.unit.clone()];
    let label_width: usize =
        (0..3).map(|c| list.iter().map(|quantity| width(&labels(quantity)[c])).max().unwrap_or(0) + 2).sum();
    let cell_width = cells.iter().flatten().map(|cell| width(cell)).max().unwrap_or(1);
    let fit = (page_width().saturating_sub(label_width + 2) / (cell_width + 2)).max(1);

    let mut lines = Vec::new();
    for first in (0..n).step_by(fit) {
        let last = (first + fit).min(n);
        let mut head = vec![String::new(), String::new(), "joint".to_string()];
        // the number of a joint above the digits before the point
        let place = |j: usize| {
            let tail = cells.iter().map(|row| row.get(j).map_or(0, |cell| tail(cell))).max().unwrap_or(0);
            format!("{}{}", j + 1, " ".repeat(tail))
        };
        head.extend((first..last).map(place));
        let mut rows = vec![head];
        for (quantity, row) in list.iter().zip(&cells) {
            let mut line = labels(quantity);
            let tails: Vec<usize> = (first..last)
                .map(|j| cells.iter().map(|row| row.get(j).map_or(0, |cell| tail(cell))).max().unwrap_or(0))
                .collect();
            line.extend(
                row[first..last]
                    .iter()
                    .zip(tails)
                    .map(|(cell, most)| format!("{cell}{}", " ".repeat(most - tail(cell)))),
            );
            rows.push(line);
        }
        lines.extend(table(&rows, "lllr"));
    }
    lines
}

/// The width to the right of the last digit before the decimal point.
fn tail(cell: &str) -> usize {
    match cell.find('.') {
        Some(point) => cell.len() - point,
        None => cell.len() - cell.trim_end().len(),
    }
}

/// A tuple with few digits, for computed numbers.
pub fn short(values: &[f64]) -> String {
    let decimals = Decimals::of(values);
    let entries: Vec<String> = values.iter().map(|&x| decimals.show(x).trim().to_string()).collect();
    format!("({})", entries.join(", "))
}
