//! The inputs of a quantity at one state, by flags: --theta, --dtheta, …

use crate::failure::Result;
use crate::state::{positions, velocities};
use clap::{Arg, ArgMatches, Args, Command, Error, FromArgMatches};
use mozzi::Model;
use mozzi::quantities::{Declaration, Dim, INPUTS, Input};
use std::collections::BTreeMap;

/// What was given, by the input's name. There is a flag for each input that quantities have.
#[derive(Debug)]
pub struct InputArguments(BTreeMap<&'static str, String>);

impl Args for InputArguments {
    fn augment_args(command: Command) -> Command {
        INPUTS.into_iter().fold(command, |command, input| command.arg(flag(input)))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

fn flag(Input { name, symbol, unit, about, dim }: Input) -> Arg {
    let of_base = match name {
        "theta" => "; of a floating base its pose first",
        "dtheta" => "; of a floating base its twist first, in its own coordinates",
        _ => "",
    };
    let default = if dim == Dim::Nq { "joints at 0, a floating base at {s}" } else { "all 0" };
    let unit = if unit == "any" { "of any unit" } else { unit };
    let help = format!("{symbol}, {about}, {unit}{of_base} [default: {default}]");
    let entries = format!("{symbol}1,{symbol}2,…");
    Arg::new(name).long(name).value_name(entries).help(help).allow_hyphen_values(true).conflicts_with("input")
}

impl FromArgMatches for InputArguments {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let given = |name| Some((name, matches.get_one::<String>(name)?.clone()));
        Ok(InputArguments(INPUTS.into_iter().filter_map(|input| given(input.name)).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        self.0.extend(Self::from_arg_matches(matches)?.0);
        Ok(())
    }
}

impl InputArguments {
    /// Was it given?
    pub fn has(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }

    /// A quantity's inputs, in their order.
    pub fn read(&self, declaration: &Declaration, model: &Model) -> Result<Vec<Vec<f64>>> {
        let read = |&Input { name, dim, .. }: &Input| {
            let (flag, text) = (format!("--{name}"), self.0.get(name).map(String::as_str));
            if dim == Dim::Nq { positions(&flag, text, model) } else { velocities(&flag, text, model) }
        };
        declaration.inputs.iter().map(read).collect()
    }
}
