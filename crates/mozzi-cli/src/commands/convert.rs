//! `mozzi convert`: the same robot in another file.

use super::screws;
use crate::columns::save;
use crate::failure::{self, Failure, Result};
use crate::robot::PolicyArguments;
use crate::robot_json;
use clap::Args;
use std::path::Path;

#[derive(Args, Debug)]
pub struct ConvertArguments {
    /// A robot's file (URDF, MJCF, or JSON that this command wrote), or the name of an embedded robot
    #[arg(value_name = "IN")]
    input: String,
    /// Output file; its ending chooses the format: .urdf, .json (links, joints, the book's lists), .py (lists for
    /// NumPy)
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
            .map_err(|why| Failure::wrong(format!("{output} is not written: {why}; .json can express all of it")))?,
        "json" => robot_json::write(&model),
        _ => screws::python(&model)?,
    };
    save(output, &text)?;
    let states: Vec<&str> = model.state_names().collect();
    if suffix != "json" && !states.is_empty() {
        failure::note(&format!(
            "{output} cannot express the robot's named states, which are omitted: {}",
            states.join(", ")
        ));
    }
    Ok(format!("{output}: {}\n", super::info::headline(&model)))
}
