//! Flags that do nothing without another flag: given alone they are an error. clap's `requires` is not enough, since it
//! does not require a flag that another given flag excludes.

use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Command, Error};

/// Flags of a subcommand, and what they need: one of these flags, or of these values of a flag.
struct Need {
    command: &'static str,
    flags: &'static [&'static str],
    one_of: &'static [&'static str],
}

const NEEDS: [Need; 11] = [
    need("check", &["apply"], &["fix", "estimate-inertia"]),
    need("compute", &["out", "precision", "threads", "kernels-only", "gpu"], &["in"]),
    need("ik", &["out"], &["in"]),
    need("identify", &["payload"], &["only payload"]),
    need("trajectory", &["position", "rpy", "quaternion", "deviation"], &["path screw", "path line"]),
    need("trajectory", &["ramp-fraction"], &["profile trapezoidal"]),
    need("simulate", &["contact", "contact-friction", "restitution", "contact-forces"], &["ground", "contacts"]),
    need("simulate", &["contact-forces"], &["out"]),
    need("simulate", &["tolerance"], &["method dopri"]),
    need("simulate", &["extrapolate"], &["torque", "tip-wrench"]),
    need("simulate", &["meshes", "mesh-root", "page-rows", "allow-host"], &["report"]),
];

const fn need(command: &'static str, flags: &'static [&'static str], one_of: &'static [&'static str]) -> Need {
    Need { command, flags, one_of }
}

/// The error of the first flag that has no effect.
pub fn check(program: &mut Command, matches: &ArgMatches) -> Result<(), Error> {
    let Some((name, given)) = matches.subcommand() else { return Ok(()) };
    let Some(command) = program.find_subcommand_mut(name) else { return Ok(()) };
    for need in NEEDS.iter().filter(|need| need.command == name) {
        let is_met = need.one_of.iter().any(|text| {
            let (flag, value) = text.split_once(' ').map_or((*text, None), |(flag, value)| (flag, Some(value)));
            is_given(command, given, flag, value)
        });
        let without = need.flags.iter().find(|flag| !is_met && is_given(command, given, flag, None));
        if let Some(flag) = without {
            let one_of = need.one_of.iter().map(|text| format!("--{text}")).collect::<Vec<_>>().join(" or ");
            let said = format!("--{flag} has no effect without {one_of}");
            return Err(command.error(ErrorKind::MissingRequiredArgument, said));
        }
    }
    Ok(())
}

/// Whether the command line has this flag. With a value: whether it gives the flag this value.
fn is_given(command: &Command, given: &ArgMatches, flag: &str, value: Option<&str>) -> bool {
    let Some(id) = argument(command, flag).map(|argument| argument.get_id().as_str()) else { return false };
    let has = |value: &str| given.get_raw(id).into_iter().flatten().any(|found| found == value);
    given.value_source(id) == Some(ValueSource::CommandLine) && value.is_none_or(has)
}

fn argument<'c>(command: &'c Command, flag: &str) -> Option<&'c Arg> {
    command.get_arguments().find(|argument| argument.get_long() == Some(flag))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Arguments;
    use clap::CommandFactory;

    #[test]
    fn every_flag_and_value_exists() {
        let program = Arguments::command();
        for need in NEEDS {
            let command = program.find_subcommand(need.command).expect(need.command);
            for flag in need.flags {
                assert!(argument(command, flag).is_some(), "{} --{flag}", need.command);
            }
            for text in need.one_of {
                let (flag, value) = text.split_once(' ').unwrap_or((text, ""));
                let values = argument(command, flag).expect(text).get_possible_values();
                assert!(value.is_empty() || values.iter().any(|known| known.matches(value, false)), "{text}");
            }
        }
    }
}
