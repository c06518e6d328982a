//! What a batch gives, and the files it goes to.

use super::format::Format;
use super::quantity::{Precision, Shape};
use super::{arrow, npy, npz};
use crate::columns::{self, Columns, save};
use crate::failure::Result;
use mozzi::Model;

/// An array by rows, of every state.
pub struct Output<T> {
    pub name: &'static str,
    pub at_one: Shape,
    /// (N, …)
    pub shape: Vec<usize>,
    pub values: Vec<T>,
}

impl<T: Precision> Output<T> {
    pub fn new(model: &Model, (name, at_one): (&'static str, Shape), states: usize) -> Self {
        let shape = [vec![states], at_one.of(model.n())].concat();
        let values = vec![T::zero(); shape.iter().product()];
        Output { name, at_one, shape, values }
    }

    /// The first states alone.
    pub fn truncate(&mut self, states: usize) {
        self.values.truncate(states * self.width());
        self.shape[0] = states;
    }

    /// Numbers of one state.
    pub fn width(&self) -> usize {
        self.shape[1..].iter().product()
    }

    /// Columns by name: `tau_1` …, `M_1_1`, `M_1_2` …; where the base floats, by the names of the velocities' entries.
    fn columns(&self, model: &Model) -> Vec<(String, Vec<T>)> {
        let entries = columns::names(model, "");
        let numbers = |count: usize| (1..=count).map(|k| format!("_{k}")).collect::<Vec<_>>();
        let pairs = |rows: &[String], columns: &[String]| -> Vec<String> {
            rows.iter().flat_map(|r| columns.iter().map(move |c| format!("{}{r}{c}", self.name))).collect()
        };
        let names = match self.at_one {
            Shape::Number => vec![self.name.to_string()],
            Shape::Vector => columns::names(model, self.name),
            Shape::Matrix => pairs(&entries, &entries),
            Shape::Jacobian => pairs(&numbers(6), &entries),
            Shape::Pose => pairs(&numbers(4), &numbers(4)),
        };
        let width = self.width();
        let column = |(c, name)| (name, self.values.iter().skip(c).step_by(width).copied().collect());
        names.into_iter().enumerate().map(column).collect()
    }
}

/// States in which a result is no number.
pub fn nan<T: Precision>(outputs: &[Output<T>], states: usize) -> usize {
    let is_nan = |output: &Output<T>, state: usize| {
        let width = output.width();
        output.values[state * width..][..width].iter().any(|x| x.to_f64().is_nan())
    };
    (0..states).filter(|&state| outputs.iter().any(|output| is_nan(output, state))).count()
}

/// To the file; CSV for "-" is the text that is returned.
pub fn write<T: Precision>(file: &str, format: Format, model: &Model, outputs: &[Output<T>]) -> Result<String> {
    let columns = || outputs.iter().flat_map(|output| output.columns(model)).collect::<Vec<_>>();
    match format {
        Format::Npz => npz::write(file, outputs)?,
        Format::Arrow => arrow::write(file, columns())?,
        Format::Npy => {
            for output in outputs {
                save(file, npy::bytes(&output.shape, &output.values))?;
            }
        }
        Format::Csv => {
            let mut table = Columns::default();
            for (name, values) in columns() {
                table.add(name, values.into_iter().map(T::to_f64).collect());
            }
            if file == "-" {
                return Ok(table.text());
            }
            save(file, table.text())?;
        }
    }
    Ok(String::new())
}
