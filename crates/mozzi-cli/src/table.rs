//! Rows of quantities, one entry for each joint.

use crate::angles;
use crate::numbers::TWIST;
use crate::robot::Units;
use crate::text::{Decimals, page_width, rows_of, table, width};
use mozzi::Model;
use mozzi::quantities::Input;
use std::borrow::Cow;

/// A vector over the joints: its symbol, name and unit.
pub struct Quantity<'a> {
    pub symbol: &'a str,
    pub name: &'a str,
    pub unit: String,
    pub values: Cow<'a, [f64]>,
}

impl<'a> Quantity<'a> {
    /// An input.
    pub fn of(model: &Model, input: &'a Input, values: &'a [f64]) -> Self {
        Self::named(model, input.name, input.symbol, input.about, input.unit, values)
    }

    /// The vector of this name, in degrees with `--deg` if it is θ or its rates.
    pub fn named(model: &Model, name: &str, symbol: &'a str, about: &'a str, unit: &str, values: &'a [f64]) -> Self {
        let units = Units::of(model);
        let are_angles = match name {
            "theta" => angles::of_positions(model),
            "dtheta" | "ddtheta" => angles::of_velocities(model),
            _ => return Quantity::new(symbol, about, units.own(unit), values),
        };
        let values = Cow::Owned(angles::shown(values, &are_angles));
        Quantity { symbol, name: about, unit: units.shown(name, unit), values }
    }

    pub fn new(symbol: &'a str, name: &'a str, unit: impl Into<String>, values: &'a [f64]) -> Self {
        Quantity { symbol, name, unit: unit.into(), values: Cow::Borrowed(values) }
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
    let all = Decimals::of(list.iter().flat_map(|quantity| quantity.values.iter()));
    let mut columns =
        vec![[["", "", ""].as_slice(), &names].concat().into_iter().map(String::from).collect::<Vec<_>>()];
    for quantity in list {
        let decimals = if common { all } else { Decimals::of(quantity.values.iter()) };
        let mut column = vec![quantity.symbol.trim().to_string(), quantity.name.to_string(), quantity.unit.clone()];
        column.extend(quantity.values.iter().map(|&x| decimals.show(x)));
        columns.push(column);
    }
    table(&rows_of(columns), "lr")
}

/// Lines of quantities below the joints' numbers; in groups if there are many joints. With `common`, the decimal points
/// of all are aligned: for terms of one sum.
fn by_number(list: &[Quantity], common: bool) -> Vec<String> {
    let all = Decimals::of(list.iter().flat_map(|quantity| quantity.values.iter()));
    let cells: Vec<Vec<String>> = list
        .iter()
        .map(|quantity| {
            let decimals = if common { all } else { Decimals::of(quantity.values.iter()) };
            quantity.values.iter().map(|&x| decimals.show(x)).collect()
        })
        .collect();
    let n = cells.iter().map(Vec::len).max().unwrap_or(0);
    let cell_width = cells.iter().flatten().map(|cell| width(cell)).max().unwrap_or(1);
    // a unit of all is in the head; names are there if all joints fit beside them
    let is_one_unit = list.iter().all(|quantity| quantity.unit == list[0].unit);
    let room = page_width().saturating_sub(4);
    let of = |pick: for<'q> fn(&'q Quantity) -> &'q str| {
        list.iter().map(|quantity| width(pick(quantity))).max().unwrap_or(0) + 2
    };
    let unit_width = of(|quantity| &quantity.unit);
    let begin = of(|quantity| quantity.symbol) + unit_width;
    let name_width = of(|quantity| quantity.name);
    let has_names = begin + name_width + n * (cell_width + 2) <= room;
    let head = |place: &str| {
        let unit = if is_one_unit { list.first().map_or("", |quantity| &quantity.unit) } else { place };
        if has_names { vec![String::new(), String::new(), unit.into()] } else { vec![String::new(), unit.into()] }
    };
    let labels = |quantity: &Quantity| {
        let unit = if is_one_unit { String::new() } else { quantity.unit.clone() };
        let symbol = quantity.symbol.to_string();
        if has_names { vec![symbol, quantity.name.to_string(), unit] } else { vec![symbol, unit] }
    };
    let label_width = begin + if has_names { name_width } else { 0 };
    let fit = (room.saturating_sub(label_width) / (cell_width + 2)).max(1);

    let mut lines = Vec::new();
    for first in (0..n).step_by(fit) {
        let last = (first + fit).min(n);
        let mut head = head("joint");
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
        lines.extend(table(&rows, if has_names { "lllr" } else { "llr" }));
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

/// A Jacobian's lines.
pub fn with_rows_named(lines: Vec<String>) -> Vec<String> {
    let mut names = TWIST.iter().cycle();
    let named = |line: String| match line.starts_with("columns") {
        true => line,
        false => format!("{} {line}", names.next().unwrap_or(&"")),
    };
    lines.into_iter().map(named).collect()
}
