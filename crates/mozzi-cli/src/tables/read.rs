//! Reads a table of any format, chosen by the file's ending.

use super::array::{Array, tuple};
use super::format::Format;
use super::npy::{self, Header};
use super::npz;
use super::samples::Samples;
use super::{How, recognised};
use crate::bag;
use crate::columns;
use crate::failure::{Failure, Result};
use crate::input::Input;
use crate::numbers::WRENCH;
use crate::recogniser::{self, ENERGIES, FORCES, GROUPS};
use crate::text_table;
use mozzi::Model;
use std::cell::Cell;

/// Chooses a robot by the names of columns.
pub type Choose<'c, 'm> = &'c dyn Fn(&[String]) -> &'m Model;

/// A robot cannot have more positions.
const MOST_POSITIONS: usize = 1_000_000;

/// Reads a file, or CSV from standard input for `-`.
pub fn read(file: &str, model: &Model) -> Result<Samples> {
    read_as(file, model, &How::default())
}

/// Reads a file in another way.
pub fn read_as(file: &str, model: &Model, how: &How) -> Result<Samples> {
    read_by(file, &|_| model, how)
}

/// Reads the columns of a robot or, if there are as many positions as joints, those of the same robot on a fixed base;
/// returns `true` for the latter.
pub fn read_joints(file: &str, model: &Model, fixed: &Model, how: &How) -> Result<(Samples, bool)> {
    let is_of_joints = Cell::new(false);
    let choose = |names: &[String]| {
        let positions = recogniser::positions(names);
        is_of_joints.set(positions == fixed.nq() && !names.iter().any(|name| name.starts_with("theta_base.")));
        if is_of_joints.get() { fixed } else { model }
    };
    Ok((read_by(file, &choose, how)?, is_of_joints.get()))
}

fn read_by<'m>(file: &str, choose: Choose<'_, 'm>, how: &How) -> Result<Samples> {
    let samples = by_format(file, choose, how)?;
    if samples.count == 0 {
        return Err(Failure::wrong(format!("{file} has no rows, expected at least one")));
    }
    Ok(samples)
}

fn by_format<'m>(file: &str, choose: Choose<'_, 'm>, how: &How) -> Result<Samples> {
    if bag::is_bag(file) {
        return bag::read(file, choose, &how.request);
    }
    match Format::of_input(file)? {
        Format::Npy => match open_npy(file)? {
            (header, from) if header.is_structured => structured(file, &header, from, choose, how),
            (header, _) => Err(Failure::wrong(format!(
                "{file} is a plain array {}, expected named columns: a structured array, such as `mozzi simulate` writes, or .npz",
                tuple(&header.shape)
            ))),
        },
        Format::Npz => arrays(file, choose),
        #[cfg(feature = "arrow")]
        Format::Arrow => super::arrow::read(file, choose, how),
        #[cfg(feature = "parquet")]
        Format::Parquet => super::parquet::read(file, choose, how),
        _ => text_table::read(file, choose, how),
    }
}

/// The header of a .npy file, and the rest of the file.
pub fn open_npy(file: &str) -> Result<(Header, Input)> {
    let mut input = Input::open(file)?;
    Ok((npy::header(&file, &mut input)?, input))
}

/// The numbers after the header.
pub fn rest(file: &str, header: &Header, mut from: Input) -> Result<Vec<f64>> {
    npy::numbers(&file, header, from.left(), &mut from)
}

/// The named columns of a structured array.
pub fn structured<'m>(file: &str, header: &Header, from: Input, choose: Choose<'_, 'm>, how: &How) -> Result<Samples> {
    let &[rows] = header.shape.as_slice() else {
        let shape = tuple(&header.shape);
        return Err(Failure::wrong(format!("{file} has named columns and shape {shape}, expected (N,)")));
    };
    let names: Vec<String> = header.fields.iter().map(|(name, _)| name.clone()).collect();
    let found = recognised(file, &names, choose(&names), how)?;
    found.used(file)?;
    let values = rest(file, header, from)?;
    let samples = found.samples(file, rows, |row, column| values[row * names.len() + column]);
    Ok(Samples { columns: found.rows, ..samples })
}

/// The shape of a table at one state.
fn shape(model: &Model, table: &str) -> Vec<usize> {
    match table {
        _ if GROUPS.contains(&table) => vec![columns::entries(model, table).len()],
        "gravity" => vec![3],
        "parameters" => vec![model.parameter_count()],
        "t" => vec![],
        _ if ENERGIES.contains(&table) => vec![],
        _ => vec![WRENCH.len()],
    }
}

/// Arrays by name, each with the same number of states.
fn arrays<'m>(file: &str, choose: Choose<'_, 'm>) -> Result<Samples> {
    let mut samples = Samples { file: file.to_string(), ..Samples::default() };
    let mut first: Option<String> = None;
    let positions = npz::positions(file)?.min(MOST_POSITIONS);
    let model = choose(&(0..positions).map(|k| format!("theta_{}", k + 1)).collect::<Vec<_>>());
    let accept = |name: &str, header: &Header| {
        let found = &header.shape;
        let further = ["t", "wrench", "gravity", "parameters"];
        if FORCES.contains(&name) {
            return Ok(());
        }
        let is_known = GROUPS.iter().chain(&further).chain(&ENERGIES).any(|known| *known == name);
        if !is_known && !name.starts_with("wrench_") {
            let all = GROUPS.iter().chain(&further).copied().collect::<Vec<_>>().join(", ");
            return Err(Failure::wrong(format!(
                "{file} has an array `{name}`, expected only {all}, or wrench_FRAME of a frame"
            )));
        }
        let expected = shape(model, name);
        let wrong = |expected: String| {
            Failure::wrong(format!("{file}: `{name}` has shape {}, expected {expected}", tuple(found)))
        };
        if found.split_first().is_none_or(|(_, rest)| rest != expected) || header.is_structured {
            let sizes: String = expected.iter().map(|size| format!(" {size}")).collect();
            return Err(wrong(format!("(N,{sizes}) of `{}`", model.description().name)));
        }
        match &first {
            None => (first, samples.count) = (Some(name.to_string()), found[0]),
            Some(of) if samples.count != found[0] => {
                let whole = [vec![samples.count], expected].concat();
                return Err(wrong(format!("{}: as many states as `{of}`", tuple(&whole))));
            }
            Some(_) => {}
        }
        Ok(())
    };
    for Array { name, values, .. } in npz::read(file, accept)? {
        match name.as_str() {
            "t" => samples.t = Some(values),
            _ => drop(samples.tables.insert(name, values)),
        }
    }
    Ok(samples)
}
