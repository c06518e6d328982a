//! Tips for flags that do not exist: the flag that was meant, or the command that has it. clap's own tips take any
//! similar word, or advise to pass a flag as a value.

use crate::quantity;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Command, Error};
use mozzi_urdf::did_you_mean;
use std::ffi::OsString;

/// Flags of other programs, and what is meant.
const MEANT: [(&str, &str); 33] = [
    ("friction", "--contact-friction is that of the ground; joints have the friction of their file"),
    ("robot", "the robot is a word without a flag: mozzi COMMAND ROBOT"),
    ("model", "the robot is a word without a flag: mozzi COMMAND ROBOT"),
    ("urdf", "the robot is a word without a flag: mozzi COMMAND ROBOT"),
    ("file", "the robot is a word without a flag: mozzi COMMAND ROBOT"),
    ("duration", "--time is the duration, s"),
    ("steps", "--time is the duration and --dt the step, s"),
    ("mass", "--payload [FRAME=]m adds a mass, --inertia LINK=… replaces a link's"),
    ("ext-force", "--tip-wrench mx,my,mz,fx,fy,fz is what the end effector applies"),
    ("fext", "--wrench FRAME=mx,my,mz,fx,fy,fz is what a frame applies to the environment"),
    ("force", "--tip-wrench mx,my,mz,fx,fy,fz is what the end effector applies"),
    ("base", "--floating frees the base"),
    ("free", "--floating frees the base"),
    ("fixed-base", "the base is fixed unless --floating is given or the file frees it"),
    ("plot", "`mozzi plot` draws figures of a motion, --report FILE.html a page"),
    ("csv", "--out FILE.csv writes a table"),
    ("output", "--out FILE writes the result"),
    ("o", "--out FILE writes the result"),
    ("pose", "--position X,Y,Z and --rpy R,P,Y or --quaternion W,X,Y,Z are a pose"),
    ("no-browser", "--out FILE.html writes the page"),
    ("no-open", "--out FILE.html writes the page"),
    ("acceleration", "--max-acceleration is the limit of acceleration"),
    ("amax", "--max-acceleration is the limit of acceleration"),
    ("velocity", "--max-velocity is the limit of velocity"),
    ("vmax", "--max-velocity is the limit of velocity"),
    ("time", "--duration is the length of the motion, s"),
    ("line", "--path line is a straight line of the end effector"),
    ("screw", "--path screw is a screw motion of the end effector"),
    ("kp", "--response T is the time constant of a controller's gains; a JSON file of --controller holds gains"),
    ("kd", "--response T is the time constant of a controller's gains; a JSON file of --controller holds gains"),
    ("keyframe", "--state NAME is a state of the file, such as a keyframe"),
    ("language", "--lang is the language of the code"),
    ("radians", "angles are in radians unless --deg is given"),
];

/// The error with a tip of our own.
pub fn explained(mut error: Error, program: &Command, words: &[OsString]) -> Error {
    let name = words.get(1).and_then(|word| word.to_str()).unwrap_or_default();
    let command = program.find_subcommand(name).unwrap_or(program);
    let tips = match error.kind() {
        ErrorKind::UnknownArgument => {
            let Some(ContextValue::String(given)) = error.get(ContextKind::InvalidArg) else { return error };
            vec![unknown(given, program, command)]
        }
        ErrorKind::MissingRequiredArgument => {
            let is_model = |value: &ContextValue| match value {
                ContextValue::Strings(list) => list.iter().any(|missing| missing == "<MODEL>"),
                _ => false,
            };
            let is_quantity = |value: &ContextValue| match value {
                ContextValue::Strings(list) => list.iter().any(|missing| missing.starts_with("<QUANTITY>")),
                _ => false,
            };
            let missing = error.get(ContextKind::InvalidArg);
            match (missing.is_some_and(is_model), missing.is_some_and(is_quantity)) {
                (true, _) => vec!["`mozzi robots` lists the embedded robots; a file is one, too".to_string()],
                (_, true) => {
                    vec!["such as M, C, g, h, J_b, rnea, aba, fk; `mozzi compute --list` shows all".to_string()]
                }
                _ => return error,
            }
        }
        ErrorKind::InvalidSubcommand => {
            let Some(ContextValue::String(given)) = error.get(ContextKind::InvalidSubcommand) else { return error };
            vec![unknown_command(given, program, command)]
        }
        _ => return error,
    };
    for kind in [ContextKind::Suggested, ContextKind::SuggestedArg, ContextKind::SuggestedSubcommand] {
        error.remove(kind);
    }
    error.insert(ContextKind::Suggested, ContextValue::StyledStrs(tips.into_iter().map(Into::into).collect()));
    error
}

fn unknown_command(given: &str, program: &Command, command: &Command) -> String {
    let names: Vec<&str> = command.get_subcommands().map(Command::get_name).collect();
    if command.get_name() != program.get_name() {
        return format!("expected one of {}", names.join(", "));
    }
    let elsewhere = quantity::elsewhere(given).map(str::to_string);
    let near = || did_you_mean(given, names.iter().copied());
    elsewhere.or_else(near).unwrap_or_else(|| "`mozzi --help` lists all commands".to_string())
}

fn unknown(given: &str, program: &Command, command: &Command) -> String {
    let help = match command.get_name() {
        "mozzi" => "`mozzi --help` lists all commands and flags".to_string(),
        name => format!("`mozzi {name} --help` lists its flags"),
    };
    if given.parse::<f64>().is_ok() {
        return format!("a number needs its flag before it; {help}");
    }
    let Some(flag) = given.strip_prefix('-') else {
        return format!("a value needs its flag before it, such as --theta {given}; {help}");
    };
    let flag = flag.trim_start_matches('-').split('=').next().unwrap_or_default();
    let flags = |command: &Command| {
        let names = command.get_arguments().flat_map(|argument| {
            argument.get_long_and_visible_aliases().unwrap_or_default().into_iter().map(str::to_string)
        });
        names.collect::<Vec<_>>()
    };
    let own = flags(command);
    if let Some((_, tip)) = MEANT.iter().find(|(known, tip)| *known == flag && is_of(tip, &own)) {
        return (*tip).to_string();
    }
    if own.iter().any(|known| known == flag) {
        return format!("did you mean `--{flag}`?");
    }
    let owners: Vec<String> = program
        .get_subcommands()
        .filter(|other| flags(other).iter().any(|known| known == flag))
        .map(|other| format!("`mozzi {}`", other.get_name()))
        .take(3)
        .collect();
    if !owners.is_empty() {
        return format!("--{flag} is a flag of {}", owners.join(", "));
    }
    match did_you_mean(flag, own.iter().map(String::as_str)) {
        Some(near) => near.replacen('`', "`--", 1),
        None => help,
    }
}

/// True if the command has the flag with which a tip begins.
fn is_of(tip: &str, flags: &[String]) -> bool {
    let begin = tip.strip_prefix("--").map(|rest| rest.split([' ', '[']).next().unwrap_or_default());
    begin.is_none_or(|flag| flags.iter().any(|known| known == flag))
}
