//! `mozzi completions`: what a shell needs to complete the command line.

use crate::failure::{Failure, Result};
use clap::{Args, Command};
use clap_complete::{Shell, generate};

#[derive(Args, Debug)]
pub struct CompletionsArguments {
    /// The shell
    shell: Shell,
}

pub fn run(arguments: &CompletionsArguments, mut program: Command) -> Result<String> {
    let mut script = Vec::new();
    generate(arguments.shell, &mut program, "mozzi", &mut script);
    String::from_utf8(script).map_err(|error| Failure::wrong(format!("the script is not text: {error}")))
}
