//! `mozzi convert`: the same robot in another file, or an edited one.

pub mod tree;
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
    /// A robot's file (URDF, xacro, MJCF, SDFormat, or JSON that this command wrote), or the name of an embedded robot
    #[arg(value_name = "IN")]
    input: String,
    /// Output file; its ending chooses the format: .urdf, .sdf, .xml (MJCF), .json (links, joints, the book's lists),
    /// .py (lists for NumPy). From URDF to URDF the text is kept, with its visuals, comments and unknown elements. Each
    /// part that a format cannot express is reported on its own line; --strict makes it an error
    #[arg(value_name = "OUT")]
    output: String,
    /// Allow OUT to be the file IN, which is overwritten
    #[arg(long)]
    in_place: bool,
    /// Leave out elements of a URDF that other readers ignore (armature, springs); with --strict, also those that URDF
    /// cannot express (gravity, rotors, constraints)
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
    if ["usd", "usda", "usdc", "usdz"].contains(&suffix) {
        return Err(Failure::wrong(format!(
            "OUT is `{output}`, but USD is not written: `urdf-usd-converter` (PyPI) makes it of a URDF, \
             `mujoco-usd-converter` of an MJCF file, and this command makes these"
        )));
    }
    if !["urdf", "sdf", "xml", "json", "py"].contains(&suffix) {
        let endings = ".urdf, .sdf, .xml (MJCF), .json or .py";
        return Err(Failure::wrong(format!("OUT is `{output}`, expected a name that ends in {endings}")));
    }
    let model = arguments.edits.apply(arguments.policy.model(input)?)?;
    let text = match suffix {
        "urdf" => urdf::text(input, output, model.description(), &arguments.leave_out, arguments.policy.settings())?,
        "sdf" | "xml" => tree::text(input, output, suffix, model.description(), &arguments.policy.settings())?,
        "json" => robot_json::write(&model),
        _ => screws::python(&model)?,
    };
    let to = if arguments.in_place { Output::replacing(output)? } else { Output::create(output)? };
    to.write(|to| to.write_all(text.as_bytes()))?;
    let states: Vec<&str> = model.state_names().collect();
    if ["urdf", "py"].contains(&suffix) && !states.is_empty() {
        failure::note(&format!(
            "{output} cannot express the robot's named states, which are omitted: {}",
            states.join(", ")
        ));
    }
    Ok(format!("{output}: {}\n", super::info::headline(&model)))
}
