//! First guesses: command lines that people type before they know the commands.

use crate::numbers::is_number;
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

/// The numbers after a flag as one value: `--q 0 -90 45deg` is `--q=0,-90,45deg`, also `--q 0, -90, 45deg`.
pub fn joined(words: Vec<OsString>) -> Vec<OsString> {
    let is_flag = |word: &str| word.starts_with("--") && word.len() > 2;
    let is_list = |word: &str| !word.is_empty() && word.split(',').all(|entry| entry.is_empty() || is_number(entry));
    let mut found: Vec<OsString> = Vec::new();
    let mut words = words.into_iter().peekable();
    while let Some(word) = words.next() {
        let mut numbers: Vec<String> = Vec::new();
        let flag = word.to_str().filter(|word| is_flag(word)).and_then(|word| match word.split_once('=') {
            Some((flag, value)) if is_list(value) => {
                numbers.push(value.to_string());
                Some(flag.to_string())
            }
            Some(_) => None,
            None => Some(word.to_string()),
        });
        if flag.is_some() {
            while let Some(more) = words.next_if(|word| word.to_str().is_some_and(is_list)) {
                numbers.extend(more.into_string());
            }
        }
        match flag {
            Some(flag) if numbers.len() > 1 || numbers.iter().any(|list| list.starts_with('-')) => {
                let lists: Vec<&str> = numbers.iter().map(|list| list.trim_matches(',')).collect();
                found.push(format!("{flag}={}", lists.join(",")).into());
            }
            _ => {
                found.push(word.clone());
                let is_within = word.to_str().is_some_and(|word| word.contains('='));
                found.extend(numbers.into_iter().skip(usize::from(is_within)).map(OsString::from));
            }
        }
    }
    found
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

    #[test]
    fn numbers_after_a_flag_are_one_value() {
        for (line, expected) in [
            ("mozzi fk ur5 --q 0 -90 90 --deg", "mozzi fk ur5 --q=0,-90,90 --deg"),
            ("mozzi fk ur5 --q 0, -pi/2, 45deg", "mozzi fk ur5 --q=0,-pi/2,45deg"),
            ("mozzi ik ur5 --position 0.4 0.1 0.3 --rpy pi 0 0", "mozzi ik ur5 --position=0.4,0.1,0.3 --rpy=pi,0,0"),
            ("mozzi fk ur5 --q=0,1 2 -3", "mozzi fk ur5 --q=0,1,2,-3"),
            ("mozzi fk ur5 --q -1,2", "mozzi fk ur5 --q=-1,2"),
            ("mozzi simulate ur5 --time 1 --out 2.csv", "mozzi simulate ur5 --time 1 --out 2.csv"),
            ("mozzi fk ur5 --q=0,1 --deg", "mozzi fk ur5 --q=0,1 --deg"),
            ("mozzi convert - --as urdf", "mozzi convert - --as urdf"),
            ("mozzi identify ur5 --theta-unit=deg 1 2", "mozzi identify ur5 --theta-unit=deg 1 2"),
        ] {
            let found = joined(line.split(' ').map(OsString::from).collect());
            assert_eq!(found.join(std::ffi::OsStr::new(" ")).into_string().expect("text"), expected);
        }
    }
}
