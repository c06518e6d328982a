//! The inputs of a quantity at one state, by flags: --theta, --dtheta, …

use crate::failure::Result;
use crate::numbers::array;
use crate::state::{start, velocities};
use clap::{Arg, ArgMatches, Args, Command, Error, FromArgMatches};
use mozzi::Model;
use mozzi::quantities::{Declaration, Dim, INPUTS, Input};
use std::collections::BTreeMap;

/// The flag of a named state.
pub const STATE: &str = "state";

/// The given texts, by the input's name. There is a flag for each input of any quantity.
#[derive(Debug)]
pub struct InputArguments(BTreeMap<&'static str, String>);

impl Args for InputArguments {
    fn augment_args(command: Command) -> Command {
        INPUTS.into_iter().fold(command, |command, input| command.arg(flag(input))).arg(state())
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

/// θ and θ̇ by a name.
fn state() -> Arg {
    let help = "Take θ and θ̇ from a named state of the robot's file, such as a keyframe; `mozzi info` lists them";
    Arg::new(STATE).long(STATE).value_name("NAME").help(help).conflicts_with_all(["theta", "dtheta", "input"])
}

fn flag(Input { name, symbol, unit, about, dim }: Input) -> Arg {
    let of_base = match name {
        "theta" => "; a floating base's pose first; or the name of a state",
        "dtheta" => "; a floating base's twist first, in its own coordinates",
        _ => "",
    };
    let default = match dim {
        Dim::Nq => "the robot's start, else joints at 0 and a floating base at {s}",
        _ => "all 0",
    };
    let unit = if unit == "any" { "of any unit" } else { unit };
    let help = format!("{symbol}, {about}, {unit}{of_base} [default: {default}]");
    let entries = format!("{symbol}1,{symbol}2,…");
    let argument = Arg::new(name).long(name).value_name(entries).help(help).conflicts_with("input");
    match name {
        "theta" => argument.visible_alias("q").aliases(["qpos", "positions"]),
        "dtheta" => argument.visible_alias("qd"),
        "ddtheta" => argument.visible_alias("qdd"),
        _ => argument,
    }
}

impl FromArgMatches for InputArguments {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let given = |name| Some((name, matches.get_one::<String>(name)?.clone()));
        Ok(InputArguments(INPUTS.into_iter().map(|input| input.name).chain([STATE]).filter_map(given).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        self.0.extend(Self::from_arg_matches(matches)?.0);
        Ok(())
    }
}

impl InputArguments {
    /// True if the input is given.
    pub fn has(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }

    /// True if a state is given, by numbers or by name.
    pub fn has_state(&self) -> bool {
        [STATE, "theta", "dtheta"].iter().any(|name| self.has(name))
    }

    /// (θ, θ̇).
    pub fn start(&self, model: &Model) -> Result<(Vec<f64>, Vec<f64>)> {
        let text = |name: &str| self.0.get(name).map(String::as_str);
        start(model, text(STATE), text("theta"), text("dtheta"))
    }

    /// A quantity's inputs, in their order.
    pub fn read(&self, declaration: &Declaration, model: &Model) -> Result<Vec<Vec<f64>>> {
        let text = |name: &str| self.0.get(name).map(String::as_str);
        let (theta, dtheta) = self.start(model)?;
        let read = |&Input { name, .. }: &Input| match name {
            "theta" => Ok(theta.clone()),
            "dtheta" => Ok(dtheta.clone()),
            "w" => match text(name) {
                None => Ok(vec![0.0; 6]),
                Some(text) => Ok(array("--w", text, ["w1", "w2", "w3", "w4", "w5", "w6"])?.to_vec()),
            },
            _ => velocities(&format!("--{name}"), text(name), model),
        };
        declaration.inputs.iter().map(read).collect()
    }
}
