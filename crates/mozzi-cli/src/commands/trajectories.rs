//! Tables in, tables out: what inverse and forward dynamics share.

use crate::columns::{Columns, save};
use crate::csv::{Samples, first_column};
use crate::failure::{self, Failure, Result};
use crate::numbers::WRENCH;
use crate::progress::Progress;
use crate::{interrupt, json};
use clap::Args;
use mozzi::{FrameId, Model, Wrench};
use serde_json::{Map, Value};

#[derive(Args, Debug, Default)]
pub struct TableArguments {
    /// States in a CSV file, one in each row, instead of by flags ("-": standard input)
    #[arg(long = "in", value_name = "FILE.csv", conflicts_with_all = ["theta", "dtheta", "tip_wrench"])]
    pub input: Option<String>,
    /// Where the table goes [default: standard output]
    #[arg(long = "out", value_name = "FILE.csv", requires = "input")]
    pub output: Option<String>,
}

/// One row of a table: a state and what is applied.
pub struct Row<'a> {
    pub theta: &'a [f64],
    pub dtheta: &'a [f64],
    /// θ̈ or τ.
    pub given: &'a [f64],
    pub applied: Vec<(FrameId, Wrench)>,
}

/// A table's states, each with a vector that is computed from it: `given` and `result` are "ddtheta" or "tau".
pub fn run(
    model: &Model,
    arguments: &TableArguments,
    as_json: bool,
    (given, result, quantity): (&str, &str, &str),
    compute: impl Fn(&Row) -> std::result::Result<Vec<f64>, mozzi::Error>,
) -> Result<String> {
    let file = arguments.input.as_deref().unwrap_or("-");
    let samples = Samples::read(file, model)?;
    let (n, count) = (model.n(), samples.lines.len());
    let theta = samples.need(&samples.theta, &first_column(model, "theta"))?;
    let zeros = || vec![vec![0.0; n]; count];
    let dtheta = samples.dtheta.clone().unwrap_or_else(zeros);
    let given_rows = match given {
        "tau" => samples.need(&samples.tau, &first_column(model, "tau"))?.clone(),
        _ => samples.ddtheta.clone().unwrap_or_else(zeros),
    };
    let tip = match &samples.tip_wrench {
        Some(_) => Some(model.end_effector()?),
        None => None,
    };
    let mut results = Vec::new();
    interrupt::listen();
    let progress = Progress::new(quantity.replace('_', " "), count, "states");
    for row in 0..count {
        if interrupt::asked() {
            break;
        }
        let applied = tip.zip(samples.tip_wrench.as_ref()).map(|(tip, list)| (tip, list[row]));
        let state = Row {
            theta: &theta[row],
            dtheta: &dtheta[row],
            given: &given_rows[row],
            applied: applied.into_iter().collect(),
        };
        let place = |error| Failure::wrong(format!("{}: {error}", samples.place(row)));
        results.push(compute(&state).map_err(place)?);
        progress.at(row + 1);
    }
    drop(progress);
    // all, but after Ctrl-C
    let done = results.len();
    let (theta, dtheta, given_rows) = (&theta[..done], &dtheta[..done], &given_rows[..done]);

    if as_json {
        let lists = |rows: &[Vec<f64>]| rows.iter().map(|row| json::vector(row)).collect::<Value>();
        let mut object = Map::new();
        if let Some(t) = &samples.t {
            object.insert("t".into(), json::vector(&t[..done]));
        }
        object.insert("theta".into(), lists(theta));
        object.insert("dtheta".into(), lists(dtheta));
        object.insert(given.into(), lists(given_rows));
        if let Some(list) = &samples.tip_wrench {
            object.insert("F_tip".into(), list[..done].iter().map(|F| json::vector(&F.to_array())).collect());
        }
        object.insert(quantity.into(), lists(&results));
        let text = json::print(&json::of_robot(model, Value::Object(object)));
        return finish(arguments.output.as_deref(), text, [done, count]);
    }
    let mut table = Columns::default();
    if let Some(t) = &samples.t {
        table.add("t", t[..done].to_vec());
    }
    table.add_group(model, "theta", theta);
    table.add_group(model, "dtheta", dtheta);
    table.add_group(model, given, given_rows);
    if let Some(list) = &samples.tip_wrench {
        for (k, name) in WRENCH.iter().enumerate() {
            table.add(*name, list[..done].iter().map(|F| F.to_array()[k]).collect());
        }
    }
    table.add_group(model, result, &results);
    finish(arguments.output.as_deref(), table.text(), [done, count])
}

/// To the file, saying so, or to standard output; so many rows of all.
fn finish(output: Option<&str>, text: String, [rows, all]: [usize; 2]) -> Result<String> {
    let said = match output {
        None | Some("-") => text,
        Some(file) => {
            save(file, &text)?;
            format!("{rows} states written to {file}\n")
        }
    };
    if rows == all {
        return Ok(said);
    }
    failure::note(&format!("stopped by Ctrl-C: these are the first {rows} of {all} states"));
    Err(Failure::Stopped(said))
}
