//! `mozzi man`: the manual's pages, as `man` reads them.

use crate::columns::save;
use crate::failure::{self, Failure, Result};
use clap::{Args, Command};
use clap_mangen::Man;
use std::path::Path;

#[derive(Args, Debug)]
pub struct ManArguments {
    /// Write mozzi.1 and a page for each command into a folder, instead of mozzi.1 to standard output
    #[arg(short, long, value_name = "FOLDER")]
    out: Option<String>,
}

pub fn run(arguments: &ManArguments, program: Command) -> Result<String> {
    let mut program = program.disable_help_subcommand(true);
    program.build();
    let Some(folder) = &arguments.out else { return page(&program) };
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::wrong(format!("the folder {folder} cannot be made: {error}")))?;
    let commands: Vec<Command> = program.get_subcommands().map(named).collect();
    for command in std::iter::once(&program).chain(&commands) {
        let file = Path::new(folder).join(format!("{}.1", command.get_name()));
        save(&file.to_string_lossy(), &page(command)?)?;
    }
    failure::note(&format!("{} pages are written to {folder}", commands.len() + 1));
    Ok(String::new())
}

/// A command of the program as a page of its own: mozzi-info for `mozzi info`.
fn named(command: &Command) -> Command {
    let name = format!("mozzi-{}", command.get_name());
    command.clone().bin_name(format!("mozzi {}", command.get_name())).name(name)
}

fn page(command: &Command) -> Result<String> {
    let mut text = Vec::new();
    let written = Man::new(command.clone()).render(&mut text);
    let text = written.map(|()| String::from_utf8_lossy(&text).into_owned());
    text.map_err(|error| Failure::wrong(format!("the page of {} cannot be made: {error}", command.get_name())))
}
