//! A quantity at one state, as text and as JSON.

use super::noise::cleaned;
use super::subject;
use crate::json;
use crate::robot::Units;
use crate::table::{Quantity, quantities, with_rows_named};
use crate::text::{Page, beside, flow, matrix, scalar, tuple};
use mozzi::quantities::{Dim, INPUTS, Of, Output, Query, Uses};
use mozzi::{Environment, Model};
use nalgebra::DMatrix;
use serde_json::{Map, Value};

/// Rows and columns are named up to so many velocities, more with -v.
const NAMED: usize = 8;

/// A quantity's inputs and outputs.
pub struct OneState<'a> {
    pub query: Query<'a>,
    pub model: &'a Model,
    pub inputs: Vec<Vec<f64>>,
    pub environment: Environment<'a>,
    pub outputs: Vec<Vec<f64>>,
}

impl OneState<'_> {
    /// True if the quantity depends on the state.
    pub fn is_of_state(&self) -> bool {
        !self.inputs.is_empty()
    }

    /// Inputs and outputs by their names.
    pub fn object(&self) -> Value {
        let &OneState { query, model, .. } = self;
        let declaration = query.declaration();
        let mut object = subject::object(query, model);
        for (input, values) in declaration.inputs.iter().zip(&self.inputs) {
            object.insert(input.name.into(), json::vector(values));
        }
        if declaration.uses.has(Uses::GRAVITY) {
            object.insert("gravity".into(), json::vector(&self.environment.gravity.0));
        }
        if declaration.uses.has(Uses::WRENCHES) {
            let wrench =
                |(frame, F): &(_, mozzi::Wrench)| (model.frame_name(*frame).into(), json::vector(&F.to_array()));
            let wrenches = self.environment.applied.iter().map(wrench).collect::<Map<_, _>>();
            object.insert("wrenches".into(), wrenches.into());
        }
        for ((output, shape), values) in declaration.outputs.iter().zip(query.shapes(model)).zip(&self.outputs) {
            object.insert(output.name.into(), json::nested(&shape, values));
        }
        json::of_robot(model, object.into())
    }

    /// The result, and then what it is of.
    pub fn write(&self, page: &mut Page, is_verbose: bool) {
        let &OneState { query, model, .. } = self;
        let (declaration, units) = (query.declaration(), Units::of(model));
        let outputs = cleaned(query, model, &self.inputs, &self.environment, &self.outputs);
        page.line(format!("{}{}: {}", query.name(), subject::words(query, model), declaration.formula));
        let (vectors, others): (Vec<_>, Vec<_>) =
            declaration.outputs.iter().zip(&outputs).partition(|(output, _)| output.dims == [Dim::N]);
        let found = vectors.into_iter().map(|(output, values)| {
            let input = INPUTS.iter().find(|input| input.name == output.name);
            let symbol = input.map_or(output.name, |input| input.symbol);
            Quantity::named(model, output.name, symbol, query.name(), output.unit, values)
        });
        page.lines(&quantities(model, &found.collect::<Vec<_>>(), false));
        let is_of_parameters = others.iter().any(|(output, _)| output.dims.contains(&Dim::Parameters));
        let is_named = others.iter().any(|(output, _)| output.dims.contains(&Dim::N));
        let blocks = others.into_iter().flat_map(|(output, values)| blocks(output, &units, query, model, values));
        page.lines(&beside(&blocks.collect::<Vec<_>>()));
        if is_named && (is_verbose || model.n() <= NAMED) {
            let names: Vec<String> = model.velocity_names().zip(1..).map(|(name, j)| format!("{j} {name}")).collect();
            page.line("a row or a column for each velocity:").lines(&flow(&names));
        }
        if is_of_parameters {
            page.line("a column for each parameter, in this order:").lines(&flow(&model.parameter_names()));
        }
        for (frame, F) in self.environment.applied.iter().filter(|_| declaration.uses.has(Uses::WRENCHES)) {
            let (frame, m, f) = (model.frame_name(*frame), tuple(&F.m.0), tuple(&F.f.0));
            page.line(format!("`{frame}` applies to the environment, in its own frame: m = {m} N m, f = {f} N"));
        }
        if is_verbose {
            let given = declaration.inputs.iter().zip(&self.inputs);
            let given: Vec<Quantity> = given.map(|(input, values)| Quantity::of(model, input, values)).collect();
            page.lines(&quantities(model, &given, false));
            if declaration.uses.has(Uses::GRAVITY) {
                page.line(format!("gravity = {} m/s²", tuple(&self.environment.gravity.0)));
            }
        }
    }
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
        [6, columns] if columns == model.n() && query.declaration().of == Of::Frame => {
            vec![(title(""), with_rows_named(dense(6, columns, values)))]
        }
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
