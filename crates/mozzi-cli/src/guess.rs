//! First guesses: command lines that people type before they know the commands.

use clap::Command;
use mozzi::quantities::Query;
use std::ffi::OsString;
use std::path::Path;

/// The command line that was meant: `mozzi fk ur5` is `mozzi compute ur5 fk`, `mozzi ur5` is `mozzi info ur5`, and a
/// command may follow its robot.
///
/// # Errors
/// A sentence if a quantity has no robot.
pub fn meant(words: Vec<OsString>, program: &Command) -> Result<Vec<OsString>, String> {
    let text = |k: usize| words.get(k).and_then(|word| word.to_str()).filter(|word| !word.starts_with('-'));
    let is_command = |word: &str| program.find_subcommand(word).is_some() || word == "help";
    let with = |command: &str, order: &[usize]| {
        let begin = [words[0].clone(), command.into()];
        let moved = order.iter().map(|&k| words[k].clone());
        let rest = words.iter().enumerate().skip(1).filter(|(k, _)| !order.contains(k) && words[*k] != *command);
        begin.into_iter().chain(moved).chain(rest.map(|(_, word)| word.clone())).collect()
    };
    Ok(match (text(1), text(2)) {
        (Some("plot"), Some(robot)) if is_robot(robot) && text(3).is_some_and(|word| !is_command(word)) => {
            let figure = [OsString::from("trajectory")];
            words[..2].iter().cloned().chain(figure).chain(words[2..].iter().cloned()).collect()
        }
        (Some("version"), None) => vec![words[0].clone(), "--version".into()],
        (Some("compute"), Some(first)) if is_quantity(first) && text(3).is_some_and(is_robot) => {
            with("compute", &[3, 2])
        }
        (Some(first), _) if is_command(first) => words,
        (Some(first), Some(second)) if is_robot(first) && is_command(second) => {
            let command = second.to_string();
            with(&command, &[1])
        }
        (Some(first), Some(second)) if is_robot(first) && is_quantity(second) => with("compute", &[1, 2]),
        (Some(first), _) if is_robot(first) => with("info", &[1]),
        (Some(first), Some(_)) if is_quantity(first) => with("compute", &[2, 1]),
        (Some(first), None) if is_quantity(first) && words.len() == 2 => {
            return Err(format!(
                "`{first}` needs a robot: mozzi compute ROBOT {first}; `mozzi robots` lists the embedded ones"
            ));
        }
        _ => words,
    })
}

/// True for a quantity's name, or a list of names.
fn is_quantity(word: &str) -> bool {
    word.split(',').all(|name| Query::named(name).is_ok())
}

/// True for an embedded robot, or a file that may contain a robot.
fn is_robot(word: &str) -> bool {
    let has_ending = [".urdf", ".xacro", ".xml", ".mjcf"].iter().any(|ending| word.ends_with(ending));
    mozzi_urdf::embedded::text(word).is_some() || has_ending && Path::new(word).is_file()
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn guesses_become_commands() {
        let program = crate::Arguments::command();
        let of = |line: &str| {
            let words = line.split(' ').map(OsString::from).collect();
            let found = meant(words, &program).unwrap_or_else(|said| vec![said.into()]);
            found.join(std::ffi::OsStr::new(" ")).into_string().expect("text")
        };
        for (line, expected) in [
            ("mozzi fk ur5 --q 1", "mozzi compute ur5 fk --q 1"),
            ("mozzi M,h,g ur5", "mozzi compute ur5 M,h,g"),
            ("mozzi ur5", "mozzi info ur5"),
            ("mozzi ur5 --json", "mozzi info ur5 --json"),
            ("mozzi ur5 rnea --json", "mozzi compute ur5 rnea --json"),
            ("mozzi ur5 simulate --time 1", "mozzi simulate ur5 --time 1"),
            ("mozzi compute M ur5 --json", "mozzi compute ur5 M --json"),
            ("mozzi compute ur5 M", "mozzi compute ur5 M"),
            ("mozzi --help", "mozzi --help"),
            ("mozzi nonsense ur5", "mozzi nonsense ur5"),
            ("mozzi version", "mozzi --version"),
            ("mozzi plot ur5 fall.csv --out a.svg", "mozzi plot trajectory ur5 fall.csv --out a.svg"),
        ] {
            assert_eq!(of(line), expected);
        }
        assert!(of("mozzi rnea").contains("`rnea` needs a robot"));
    }
}
