//! `mozzi xacro`: the expansion of a xacro file.

use crate::columns::save;
use crate::failure::{self, Failure, Result};
use crate::input;
use crate::xacro_arguments::{XacroArguments, assignment};
use clap::Args;
use mozzi_urdf::{Settings, expanded_with_warnings};

/// A larger file is refused.
const MOST: usize = 64 << 20;

#[derive(Args, Debug)]
pub struct XacroCommand {
    /// A xacro file, or - for standard input
    file: String,
    /// Values of its arguments
    #[arg(value_name = "NAME:=VALUE", value_parser = assignment)]
    given: Vec<(String, String)>,
    /// Write to a file instead of standard output
    #[arg(short, long, value_name = "FILE")]
    out: Option<String>,
    #[command(flatten)]
    xacro: XacroArguments,
}

pub fn run(command: &XacroCommand) -> Result<String> {
    let file = command.file.as_str();
    let text = match file {
        "-" => input::robot_text().map_err(|error| input::cannot(file, &error))?.to_vec(),
        _ => input::bytes(file, MOST)?,
    };
    let settings = Settings { xacro: command.xacro.with(&command.given).arguments(), ..Settings::default() };
    let (text, warnings) = expanded_with_warnings(input::name(file), text, settings)?;
    warnings.iter().for_each(|warning| failure::write(&format!("{warning}\n")));
    let Some(text) = text else {
        return Err(Failure::wrong(format!(
            "{} is not a xacro file: its name does not end in .xacro, or its root declares no namespace of xacro with \
             anything to expand",
            input::name(file)
        )));
    };
    match &command.out {
        None => Ok(text),
        Some(out) => {
            save(out, &text)?;
            failure::note(&format!("{file} is expanded to {out}"));
            Ok(String::new())
        }
    }
}
