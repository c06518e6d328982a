//! `mozzi convert`: the same robot in another file, or an edited one.

mod losses;
pub mod tree;
pub mod urdf;

use crate::edits::EditArguments;
use crate::failure::{self, Failure, Result};
use crate::input;
use crate::output::{self, Output};
use crate::robot::PolicyArguments;
use crate::robot_json;
use clap::Args;
use mozzi_urdf::{Policy, Settings, mjcf};
use std::io::Write;
use std::path::Path;
use urdf::LeftOut;

#[derive(Args, Debug)]
pub struct ConvertArguments {
    /// A robot's file (URDF, xacro, MJCF, SDFormat, or JSON that this command wrote), or the name of an embedded robot
    #[arg(value_name = "IN")]
    input: String,
    /// Output file, or - for standard output with --as; its ending chooses the format: .urdf, .sdf, .xml (MJCF), .json
    /// (links, joints, the book's lists), .py (lists for NumPy). From URDF to URDF the text is kept, with its visuals,
    /// comments and unknown elements. Each part that a format cannot express is reported on its own line; --strict
    /// makes it an error
    #[arg(value_name = "OUT")]
    output: String,
    /// The format, whatever the ending of OUT is
    #[arg(long = "as", value_name = "FORMAT", value_parser = FORMATS)]
    format: Option<String>,
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

/// The formats, by the endings of their files.
const FORMATS: [&str; 5] = ["urdf", "sdf", "xml", "json", "py"];

pub fn run(arguments: &ConvertArguments) -> Result<String> {
    let (input, file) = (&arguments.input, &arguments.output);
    let ending = Path::new(file).extension().and_then(|suffix| suffix.to_str()).unwrap_or_default();
    let suffix = arguments.format.as_deref().unwrap_or(ending);
    let output = if file == "-" { "standard output" } else { file };
    if file == "-" && arguments.format.is_none() {
        let formats = FORMATS.join(", ");
        return Err(Failure::wrong(format!("OUT is `-`, expected --as FORMAT for standard output, one of {formats}")));
    }
    if ["usd", "usda", "usdc", "usdz"].contains(&suffix) {
        return Err(Failure::wrong(format!(
            "OUT is `{output}`, but USD is not written: `urdf-usd-converter` (PyPI) makes it of a URDF, \
             `mujoco-usd-converter` of an MJCF file, and this command makes these"
        )));
    }
    if !FORMATS.contains(&suffix) {
        let endings = ".urdf, .sdf, .xml (MJCF), .json or .py";
        return Err(Failure::wrong(format!("OUT is `{output}`, expected a name that ends in {endings}")));
    }
    let model = arguments.edits.apply(arguments.policy.model(input)?)?;
    actuators(input, output, &arguments.policy.settings())?;
    let text = match suffix {
        "urdf" => urdf::text(input, output, model.description(), &arguments.leave_out, arguments.policy.settings())?,
        "sdf" | "xml" | "py" => tree::text(input, output, suffix, &model, &arguments.policy.settings())?,
        _ => {
            urdf::shapes(input, output, &arguments.policy.settings())?;
            robot_json::write(&model)
        }
    };
    if file == "-" {
        output::to_stdout(&text)?;
    } else {
        let to = if arguments.in_place { Output::replacing(file)? } else { Output::create(file)? };
        to.write(|to| to.write_all(text.as_bytes()))?;
    }
    let written = format!("{output}: {}\n", super::info::headline(&model));
    if file == "-" {
        failure::write(&written);
        return Ok(String::new());
    }
    Ok(written)
}

/// A note about the actuators of an MJCF file, which no format keeps; with `--strict` an error.
fn actuators(input: &str, output: &str, settings: &Settings) -> Result<()> {
    let actuation = match input {
        "-" => {
            let text = input::robot_text().map_err(|error| input::cannot(input, &error))?;
            mjcf::actuation_of(None, input::name(input), text, &settings.xacro)
        }
        _ => mjcf::actuation(input, &settings.xacro)?,
    };
    if actuation.actuators.is_empty() {
        return Ok(());
    }
    let count = format!("the {} of {}", losses::of_these(actuation.actuators.len(), "actuator"), input::name(input));
    if settings.policy == Policy::Strict {
        return Err(Failure::wrong(format!("{output} is not written: --strict, and it cannot express {count}")));
    }
    failure::note(&format!("{output} omits {count}; the torques of joints are arguments"));
    Ok(())
}
