//! A quantity at one state, as text and as JSON.

use super::subject;
use crate::json;
use crate::robot::Units;
use crate::table::{Quantity, quantities};
use crate::text::{Page, beside, flow, matrix, scalar, tuple};
use mozzi::quantities::{Dim, INPUTS, Output, Query, Uses};
use mozzi::{Environment, Model};
use nalgebra::DMatrix;
use serde_json::{Map, Value};

/// Inputs and outputs by their names.
pub fn object(
    query: Query,
    model: &Model,
    inputs: &[&[f64]],
    environment: &Environment,
    outputs: &[Vec<f64>],
) -> Value {
    let declaration = query.declaration();
    let mut object = subject::object(query, model);
    for (input, values) in declaration.inputs.iter().zip(inputs) {
        object.insert(input.name.into(), json::vector(values));
    }
    if declaration.uses.has(Uses::GRAVITY) {
        object.insert("gravity".into(), json::vector(&environment.gravity.0));
    }
    if declaration.uses.has(Uses::WRENCHES) {
        let wrench = |(frame, F): &(_, mozzi::Wrench)| (model.frame_name(*frame).into(), json::vector(&F.to_array()));
        object.insert("wrenches".into(), environment.applied.iter().map(wrench).collect::<Map<_, _>>().into());
    }
    for ((output, shape), values) in declaration.outputs.iter().zip(query.shapes(model)).zip(outputs) {
        object.insert(output.name.into(), json::nested(&shape, values));
    }
    json::of_robot(model, object.into())
}

pub fn page(query: Query, model: &Model, inputs: &[&[f64]], environment: &Environment, outputs: &[Vec<f64>]) -> String {
    let (declaration, units) = (query.declaration(), Units::of(model));
    let mut page = Page::default();
    page.line(format!("{}{}: {}", query.name(), subject::words(query, model), declaration.formula));
    let given = declaration.inputs.iter().zip(inputs);
    let given = given.map(|(input, values)| Quantity::of(input, &units, values));
    let (vectors, others): (Vec<_>, Vec<_>) =
        declaration.outputs.iter().zip(outputs).partition(|(output, _)| output.dims == [Dim::N]);
    let found = vectors.into_iter().map(|(output, values)| {
        let symbol = INPUTS.iter().find(|input| input.name == output.name).map_or(output.name, |input| input.symbol);
        Quantity::new(symbol, query.name(), units.own(output.unit), values)
    });
    page.lines(&quantities(model, &given.chain(found).collect::<Vec<_>>(), false));
    if declaration.uses.has(Uses::GRAVITY) {
        page.line(format!("gravity = {} m/s²", tuple(&environment.gravity.0)));
    }
    for (frame, F) in environment.applied {
        let (frame, m, f) = (model.frame_name(*frame), tuple(&F.m.0), tuple(&F.f.0));
        page.line(format!("`{frame}` applies to the environment, in its own frame: m = {m} N m, f = {f} N"));
    }
    if others.iter().any(|(output, _)| output.dims.contains(&Dim::N)) {
        let names: Vec<String> = model.velocity_names().zip(1..).map(|(name, j)| format!("{j} {name}")).collect();
        page.line("a row or a column for each velocity:").lines(&flow(&names));
    }
    let blocks = others.into_iter().flat_map(|(output, values)| blocks(output, &units, query, model, values));
    page.lines(&beside(&blocks.collect::<Vec<_>>()));
    page.end()
}

/// Matrices with their titles: one, or a stack of them.
fn blocks(output: &Output, units: &Units, query: Query, model: &Model, values: &[f64]) -> Vec<(String, Vec<String>)> {
    let shape: Vec<usize> = output.shape(model, &query.subject).collect();
    let is_of_joints = output.dims.first() == Some(&Dim::N) && shape.len() < 3;
    let unit = if is_of_joints { units.own(output.unit) } else { output.unit.to_string() };
    let title = |entry: &str| format!("{}{entry} [{unit}]", output.name);
    let dense = |rows, columns, values: &[f64]| matrix(&DMatrix::from_row_slice(rows, columns, values));
    match shape[..] {
        [] => vec![(title(""), vec![scalar(values[0])])],
        [columns] => vec![(title(""), dense(1, columns, values))],
        [rows, columns] => vec![(title(""), dense(rows, columns, values))],
        [_, rows, columns, ..] => {
            let names: Vec<&str> = match output.dims[0] {
                Dim::Frames => model.frames().map(|(_, name)| name).collect(),
                _ => model.velocity_names().collect(),
            };
            let pages = names.iter().zip(values.chunks_exact((rows * columns).max(1)));
            pages.map(|(name, values)| (title(&format!(", {name}")), dense(rows, columns, values))).collect()
        }
    }
}
