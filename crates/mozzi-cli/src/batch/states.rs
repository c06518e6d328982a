//! The states of a file, as tables by rows.

use super::format::Format;
use super::npy::{self, Array, tuple};
use super::quantity::Quantity;
use super::{arrow, npz};
use crate::csv::{GROUPS, Samples, first_column};
use crate::failure::{Failure, Result};
use crate::numbers::WRENCH;
use mozzi::Model;
use std::collections::BTreeMap;

/// Tables that a file has, by name: theta, dtheta, ddtheta, tau, wrench.
pub struct Groups {
    pub count: usize,
    tables: BTreeMap<&'static str, Vec<f64>>,
}

impl Groups {
    pub fn new(count: usize) -> Self {
        Groups { count, tables: BTreeMap::new() }
    }

    pub fn add(&mut self, name: &'static str, table: Vec<f64>) {
        self.tables.insert(name, table);
    }
}

/// The tables that a quantity needs, and wrenches where the file has them.
pub struct States {
    pub file: String,
    pub count: usize,
    pub tables: BTreeMap<&'static str, Vec<f64>>,
}

/// Numbers of a table at one state.
pub fn width(model: &Model, table: &str) -> usize {
    match table {
        "theta" => model.nq(),
        "wrench" => WRENCH.len(),
        _ => model.n(),
    }
}

impl States {
    pub fn read(file: &str, model: &Model, quantity: Quantity) -> Result<Self> {
        let mut groups = match Format::of(file)? {
            Format::Npy => columns_of(file, model, quantity)?,
            Format::Npz => arrays_of(file, model)?,
            Format::Arrow => arrow::read(file, model)?,
            Format::Csv => rows_of(file, model)?,
        };
        let file = if file == "-" { "standard input" } else { file };
        let mut tables = BTreeMap::new();
        for &name in quantity.inputs() {
            let table = groups.tables.remove(name);
            let may_be_zero = matches!(name, "dtheta" | "ddtheta");
            let zeros = || may_be_zero.then(|| vec![0.0; groups.count * model.n()]);
            tables.insert(name, table.or_else(zeros).ok_or_else(|| missing(file, model, quantity, name))?);
        }
        if let Some(wrenches) = groups.tables.remove("wrench").filter(|_| quantity.takes_a_wrench()) {
            tables.insert("wrench", wrenches);
        } else if quantity == Quantity::TipForces {
            return Err(missing(file, model, quantity, "wrench"));
        }
        Ok(States { file: file.to_string(), count: groups.count, tables })
    }
}

fn missing(file: &str, model: &Model, quantity: Quantity, name: &str) -> Failure {
    let what = match (Format::of(file), name) {
        (Ok(Format::Npz), _) => format!("array `{name}`"),
        (_, "wrench") => format!("columns {}", WRENCH.join(" ")),
        _ => format!("columns {}", first_column(model, name)),
    };
    Failure::wrong(format!("{file} has no {what}, which {} needs", quantity.name()))
}

/// One array: θ, and beside it what the quantity needs.
fn columns_of(file: &str, model: &Model, quantity: Quantity) -> Result<Groups> {
    let bytes = std::fs::read(file).map_err(|error| Failure::wrong(format!("{file} cannot be read: {error}")))?;
    let Array { shape, values } = npy::parse(&file, &bytes)?;
    drop(bytes);
    let mut names = quantity.inputs().to_vec();
    let own: usize = names.iter().map(|name| width(model, name)).sum();
    let with_wrench = own + width(model, "wrench");
    let must = quantity == Quantity::TipForces;
    let found = shape.get(1).copied().filter(|_| shape.len() == 2);
    if quantity.takes_a_wrench() && found == Some(with_wrench) {
        names.push("wrench");
    } else if found != Some(own) || must {
        let list = |names: &[&str]| {
            names.iter().map(|name| format!("{name} {}", width(model, name))).collect::<Vec<_>>().join(", ")
        };
        let robot = &model.description().name;
        let expected = match quantity.takes_a_wrench() {
            true if must => format!("(N, {with_wrench}): {}, wrench 6 of `{robot}`", list(&names)),
            true => format!("(N, {own}): {} of `{robot}`; or (N, {with_wrench}) with the tip's wrench", list(&names)),
            false => format!("(N, {own}): {} of `{robot}`", list(&names)),
        };
        return Err(Failure::wrong(format!("{file} has shape {}, expected {expected}", tuple(&shape))));
    }
    let mut groups = Groups::new(shape[0]);
    let (all, mut first) = (found.unwrap_or(1), 0);
    for name in names {
        let end = first + width(model, name);
        groups.add(name, values.chunks_exact(all.max(1)).flat_map(|row| &row[first..end]).copied().collect());
        first = end;
    }
    Ok(groups)
}

/// Arrays by name; as many states in each.
fn arrays_of(file: &str, model: &Model) -> Result<Groups> {
    let mut first: Option<(&str, usize)> = None;
    let mut tables = BTreeMap::new();
    for (name, Array { shape, values }) in npz::read(file)? {
        let names = GROUPS.into_iter().chain(["wrench"]);
        let Some(known) = names.clone().find(|known| *known == name) else {
            let names: Vec<&str> = names.collect();
            let all = names.join(", ");
            return Err(Failure::wrong(format!("{file} has an array `{name}`, expected only {all}")));
        };
        let (width, robot) = (width(model, known), &model.description().name);
        let wrong = |expected: String| {
            Failure::wrong(format!("{file}: `{name}` has shape {}, expected {expected}", tuple(&shape)))
        };
        if shape.len() != 2 || shape[1] != width {
            return Err(wrong(format!("(N, {width}) of `{robot}`")));
        }
        match first {
            None => first = Some((known, shape[0])),
            Some((of, count)) if count != shape[0] => {
                return Err(wrong(format!("({count}, {width}): as many states as `{of}`")));
            }
            Some(_) => {}
        }
        tables.insert(known, values);
    }
    Ok(Groups { count: first.map_or(0, |(_, count)| count), tables })
}

/// A CSV table, as other subcommands read it.
fn rows_of(file: &str, model: &Model) -> Result<Groups> {
    let samples = Samples::read(file, model)?;
    let mut groups = Groups::new(samples.lines.len());
    let tables = [samples.theta, samples.dtheta, samples.ddtheta, samples.tau];
    for (name, table) in GROUPS.into_iter().zip(tables) {
        if let Some(rows) = table {
            groups.add(name, rows.concat());
        }
    }
    if let Some(list) = samples.tip_wrench {
        groups.add("wrench", list.iter().flat_map(|F| F.to_array()).collect());
    }
    Ok(groups)
}
