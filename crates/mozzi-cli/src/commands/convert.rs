//! `mozzi convert`: the same robot in another file, or an edited one.

pub mod urdf;

use super::screws;
use crate::edits::EditArguments;
use crate::failure::{self, Failure, Result};
use crate::output::Output;
use crate::robot::PolicyArguments;
use crate::robot_json;
use clap::Args;
use std::io::Write;
use std::path::Path;
use urdf::LeftOut;

#[derive(Args, Debug)]
pub struct ConvertArguments {
    /// A robot's file (URDF, xacro, MJCF, or JSON that this command wrote), or the name of an embedded robot
    #[arg(value_name = "IN")]
    input: String,
    /// Output file; its ending chooses the format: .urdf, .json (links, joints, the book's lists), .py (lists for
    /// NumPy). From URDF to URDF the text is kept, with its visuals, comments and unknown elements
    #[arg(value_name = "OUT")]
    output: String,
    /// Allow OUT to be the file IN, which is overwritten
    #[arg(long)]
    in_place: bool,
    /// Leave out of a URDF what it cannot express (gravity, rotors, constraints), or what other readers ignore
    /// (armature, springs)
    #[arg(long, value_enum, value_delimiter = ',', value_name = "WHAT")]
    leave_out: Vec<LeftOut>,
    #[command(flatten)]
    edits: EditArguments,
    #[command(flatten)]
    policy: PolicyArguments,
}

pub fn run(arguments: &ConvertArguments) -> Result<String> {
    let (input, output) = (&arguments.input, &arguments.output);
    let suffix = Path::new(output).extension().and_then(|suffix| suffix.to_str()).unwrap_or_default();
    if !["urdf", "json", "py"].contains(&suffix) {
        return Err(Failure::wrong(format!("OUT is `{output}`, expected a name that ends in .urdf, .json or .py")));
    }
    let model = arguments.edits.apply(arguments.policy.model(input)?)?;
    let text = match suffix {
        "urdf" => urdf::text(input, output, model.description(), &arguments.leave_out, arguments.policy.settings())?,
        "json" => robot_json::write(&model),
        _ => screws::python(&model)?,
    };
    let to = if arguments.in_place { Output::replacing(output)? } else { Output::create(output)? };
    to.write(|to| to.write_all(text.as_bytes()))?;
    let states: Vec<&str> = model.state_names().collect();
    if suffix != "json" && !states.is_empty() {
        failure::note(&format!(
            "{output} cannot express the robot's named states, which are omitted: {}",
            states.join(", ")
        ));
    }
    Ok(format!("{output}: {}\n", super::info::headline(&model)))
}
