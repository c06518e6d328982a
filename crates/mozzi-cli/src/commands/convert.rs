//! `mozzi convert`: the same robot in another file.

use super::screws;
use crate::columns::save;
use crate::failure::{Failure, Result};
use crate::robot::PolicyArguments;
use crate::robot_json;
use clap::Args;
use std::path::Path;

#[derive(Args, Debug)]
pub struct ConvertArguments {
    /// A robot's file (URDF, MJCF, or JSON that this command wrote), or the name of an embedded robot
    #[arg(value_name = "IN")]
    input: String,
    /// Where it goes, its kind by its suffix: .urdf, .json (links, joints, the book's lists), .py (lists for NumPy)
    #[arg(value_name = "OUT")]
    output: String,
    #[command(flatten)]
    policy: PolicyArguments,
}

pub fn run(arguments: &ConvertArguments) -> Result<String> {
    let (input, output) = (&arguments.input, &arguments.output);
    let suffix = Path::new(output).extension().and_then(|suffix| suffix.to_str()).unwrap_or_default();
    if !["urdf", "json", "py"].contains(&suffix) {
        return Err(Failure::wrong(format!("OUT is `{output}`, expected a name that ends in .urdf, .json or .py")));
    }
    let model = arguments.policy.model(input)?;
    let text = match suffix {
        "urdf" => mozzi_urdf::write(model.description())
            .map_err(|why| Failure::wrong(format!("{output} is not written: {why}; .json has words for all")))?,
        "json" => robot_json::write(&model),
        _ => screws::python(&model)?,
    };
    save(output, &text)?;
    Ok(format!("{output}: {}\n", super::info::headline(&model)))
}
