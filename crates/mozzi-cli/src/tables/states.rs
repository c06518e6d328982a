//! The states of a file, as tables by rows.

use super::array::tuple;
use super::degrees;
use super::format::Format;
use super::join::join;
use super::npy::Header;
use super::precision::Precision;
use super::samples::{Samples, columns_of};
use super::{How, read};
use crate::bag::is_bag;
use crate::failure::{Failure, Result};
use crate::input::Input;
use crate::numbers::WRENCH;
use crate::quantity::hyphenated;
use crate::state::check_frames;
use mozzi::quantities::{Query, Uses};
use mozzi::{FrameId, Model, Wrench};

/// The tables that a quantity needs from a file.
pub struct States<T> {
    /// Names and places of the tables.
    pub samples: Samples,
    /// In the order of the quantity's inputs.
    pub inputs: Vec<Vec<T>>,
    pub wrenches: Vec<(FrameId, Vec<T>)>,
    pub gravity: Option<Vec<T>>,
    pub parameters: Option<Vec<T>>,
}

impl<T: Precision> States<T> {
    /// `applied` is the same in all states; then the file must not contain a frame's wrench.
    pub fn read(file: &str, query: Query, model: &Model, applied: &[(FrameId, Wrench)]) -> Result<Self> {
        let format = Format::of_input(file)?;
        // a quantity that depends on wrenches alone is 0 without them
        let needs_wrench = query.declaration().uses == Uses::WRENCHES && applied.is_empty();
        let mut samples = match format {
            Format::Npy => match read::open_npy(file)? {
                (header, from) if header.is_structured => {
                    read::structured(file, &header, from, &|_| model, &How::default())?
                }
                (header, from) => one_array(file, header, from, query, model, needs_wrench)?,
            },
            _ => read::read(file, model)?,
        };
        samples.t.iter_mut().flatten().for_each(|t| *t += samples.start); // as the table has them
        degrees::question(&samples, model);
        if is_bag(file) {
            join(&mut samples, model, "")?; // an arm's joints may come in several messages
        }
        let missing = |samples: &Samples, name: &str| {
            let what = match format {
                Format::Npz => format!("array `{name}`"),
                _ => format!("columns {}", columns_of(model, name)),
            };
            samples.missing(&what, &format!("{} needs", hyphenated(query.name())))
        };
        let to_T = |table: Vec<f64>| table.into_iter().map(T::from_f64).collect();
        let declaration = query.declaration();
        let mut inputs = Vec::new();
        for input in declaration.inputs {
            let may_be_zero = matches!(input.name, "dtheta" | "ddtheta");
            inputs.push(match samples.tables.remove(input.name) {
                Some(table) => to_T(table),
                None if may_be_zero => vec![T::zero(); samples.count * model.n()],
                None => return Err(missing(&samples, input.name)),
            });
        }
        let mut wrenches = Vec::new();
        let tables = std::mem::take(&mut samples.tables);
        let (mut gravity, mut parameters) = (None, None);
        let of = |name: &str, frame: Result<FrameId, mozzi::Error>| {
            frame.map_err(|error| Failure::wrong(format!("{file}: `{name}`: {error}")))
        };
        for (name, table) in tables {
            match (name.as_str(), name.strip_prefix("wrench_")) {
                ("gravity", _) => gravity = Some(to_T(table)),
                ("parameters", _) => parameters = Some(to_T(table)),
                _ if !declaration.uses.has(Uses::WRENCHES) => {}
                ("wrench", _) => wrenches.push((of(&name, model.end_effector())?, to_T(table))),
                (_, Some(frame)) => wrenches.push((of(&name, model.frame(frame))?, to_T(table))),
                _ => {}
            }
        }
        if needs_wrench && wrenches.is_empty() {
            return Err(missing(&samples, "wrench"));
        }
        check_frames(model, wrenches.iter().map(|(frame, _)| *frame).chain(applied.iter().map(|(frame, _)| *frame)))?;
        Ok(States { samples, inputs, wrenches, gravity, parameters })
    }
}

/// One array: the inputs of the quantity in order, then optionally the tip's wrench.
fn one_array(
    file: &str,
    header: Header,
    from: Input,
    query: Query,
    model: &Model,
    needs_wrench: bool,
) -> Result<Samples> {
    let shape = &header.shape;
    let declaration = query.declaration();
    let mut columns: Vec<(&str, usize)> =
        declaration.inputs.iter().map(|input| input.name).zip(query.input_lengths(model)).collect();
    let own: usize = columns.iter().map(|(_, width)| width).sum();
    let with_wrench = own + WRENCH.len();
    let takes_wrench = declaration.uses.has(Uses::WRENCHES);
    let found = shape.get(1).copied().filter(|_| shape.len() == 2);
    if takes_wrench && found == Some(with_wrench) {
        columns.push(("wrench", WRENCH.len()));
    } else if found != Some(own) || needs_wrench {
        let list = columns.iter().map(|(name, width)| format!("{name} {width}")).collect::<Vec<_>>().join(", ");
        let robot = &model.description().name;
        let expected = match takes_wrench {
            true if needs_wrench => format!("(N, {with_wrench}): {list}, wrench 6 of `{robot}`"),
            true => format!("(N, {own}): {list} of `{robot}`; or (N, {with_wrench}) with the tip's wrench"),
            false => format!("(N, {own}): {list} of `{robot}`"),
        };
        return Err(Failure::wrong(format!("{file} has shape {}, expected {expected}", tuple(shape))));
    }
    let values = read::rest(file, &header, from)?;
    let mut samples = Samples { file: file.to_string(), count: shape[0], ..Samples::default() };
    let (all, mut first) = (found.unwrap_or(1).max(1), 0);
    for (name, width) in columns {
        let table = values.chunks_exact(all).flat_map(|row| &row[first..first + width]).copied().collect();
        samples.tables.insert(name.to_string(), table);
        first += width;
    }
    Ok(samples)
}
