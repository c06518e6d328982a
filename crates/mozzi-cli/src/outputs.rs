//! The files that a command writes, checked before its work: none is one that it reads, no two are one, and a page is
//! named as a page. [`Output`](crate::output::Output) refuses the files that other files name.

use crate::failure::{Failure, Result};
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Command};
use mozzi_urdf::files;
use std::path::{Path, PathBuf};

/// Arguments that name a file to write.
const OUTPUTS: [&str; 3] = ["out", "report", "output"];

/// # Errors
/// The first output that would overwrite an input or another output, or that is no name of a page.
pub fn check(program: &Command, matches: &ArgMatches) -> Result<()> {
    let Some((name, given)) = matches.subcommand() else { return Ok(()) };
    let Some(command) = program.find_subcommand(name) else { return Ok(()) };
    fault(command, given).map_or(Ok(()), |said| Err(Failure::Wrong(said)))
}

fn fault(command: &Command, given: &ArgMatches) -> Option<String> {
    let is_given = |argument: &&Arg| {
        let id = argument.get_id().as_str();
        given.try_contains_id(id).is_ok() && given.value_source(id) == Some(ValueSource::CommandLine)
    };
    let values = |argument: &Arg| -> Vec<String> {
        let raw = given.get_raw(argument.get_id().as_str()).into_iter().flatten();
        raw.map(|value| value.to_string_lossy().into_owned()).collect()
    };
    let is_output = |argument: &&Arg| OUTPUTS.contains(&argument.get_id().as_str());
    let all: Vec<&Arg> = command.get_arguments().filter(is_given).collect();
    let outputs: Vec<(&Arg, String)> =
        all.iter().filter(|a| is_output(a)).flat_map(|a| values(a).into_iter().map(|value| (*a, value))).collect();
    let in_place = given.try_get_one::<bool>("in_place").ok().flatten().copied().unwrap_or(false);
    for (k, (argument, file)) in outputs.iter().enumerate() {
        let flag = shown(argument);
        let is_page = argument.get_value_names().is_some_and(|names| names.iter().any(|name| name == "FILE.html"));
        if is_page && file != "-" && !is_html(file) {
            return Some(format!("{flag} is `{file}`, but it is a page, expected a name that ends in .html"));
        }
        if let Some((other, _)) = outputs[..k].iter().find(|(_, other)| will_be_same(other, file)) {
            return Some(format!("{} and {flag} are both `{file}`, expected two files", shown(other)));
        }
        if in_place {
            continue;
        }
        for input in all.iter().filter(|argument| !is_output(argument)) {
            // FRAME=FILE, too
            let read = values(input).into_iter().find(|value| {
                let parts = [Some(value.as_str()), value.rsplit_once('=').map(|(_, rest)| rest)];
                parts.into_iter().flatten().any(|part| is_same_file(part, file))
            });
            if read.is_some() {
                let other = shown(input);
                let remedy = if command.get_name() == "convert" { "; --in-place overwrites it" } else { "" };
                return Some(format!("{flag} is the file {other}, `{file}`, expected another name{remedy}"));
            }
        }
    }
    None
}

/// "--out", or "OUT".
fn shown(argument: &Arg) -> String {
    match argument.get_long() {
        Some(long) => format!("--{long}"),
        None => {
            argument.get_value_names().and_then(|names| names.first()).map_or_else(String::new, ToString::to_string)
        }
    }
}

fn is_html(file: &str) -> bool {
    Path::new(file)
        .extension()
        .is_some_and(|ending| ["html", "htm"].iter().any(|known| ending.eq_ignore_ascii_case(known)))
}

/// Both are one regular file; a pipe or a device may be written several times.
fn is_same_file(a: &str, b: &str) -> bool {
    Path::new(b).is_file() && files::are_same(Path::new(a), Path::new(b))
}

/// Both will be one file: standard output, one that exists, or one name in one folder.
fn will_be_same(a: &str, b: &str) -> bool {
    let place = |file: &str| {
        let path = Path::new(file);
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Some(folder.canonicalize().ok()?.join(path.file_name()?))
    };
    let is_new = |file: &str| !Path::new(file).exists();
    let (one, other): (Option<PathBuf>, Option<PathBuf>) = (place(a), place(b));
    a == "-" && b == "-" || is_same_file(a, b) || is_new(a) && is_new(b) && one.is_some() && one == other
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Arguments;
    use clap::CommandFactory;

    /// The message for this command line in a folder with arm.urdf, log.csv and link.csv, a link to it.
    fn said(line: &str) -> Option<String> {
        let folder = std::env::temp_dir().join(format!("mozzi-outputs-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        ["arm.urdf", "log.csv"].iter().for_each(|name| std::fs::write(folder.join(name), "").expect("a file"));
        #[cfg(unix)]
        let _ = std::os::unix::fs::symlink(folder.join("log.csv"), folder.join("link.csv"));
        let words = line.split(' ').map(|word| word.replace('@', &format!("{}/", folder.display())));
        let mut program = Arguments::command();
        let matches = program.try_get_matches_from_mut(words).expect(line);
        let Err(Failure::Wrong(said)) = check(&program, &matches) else { return None };
        Some(said.replace(&format!("{}/", folder.display()), "@"))
    }

    #[test]
    fn no_input_and_no_output_is_overwritten() {
        for (line, expected) in [
            ("mozzi simulate ur5 --follow @log.csv --controller c.json --out @log.csv", "--out is the file --follow"),
            ("mozzi simulate ur5 --torque @log.csv --out @../mozzi-outputs-PID/log.csv", "--out is the file --torque"),
            ("mozzi simulate @arm.urdf --out @arm.urdf", "--out is the file MODEL"),
            ("mozzi identify ur5 @log.csv --report @log.csv", "--report is `@log.csv`, but it is a page"),
            ("mozzi simulate ur5 --report @x.png", "--report is `@x.png`, but it is a page, expected a name that ends"),
            ("mozzi identify ur5 a.csv --validate @log.csv --out @link.csv", "--out is the file --validate"),
            ("mozzi trajectory ur5 --via @log.csv --out @log.csv", "--out is the file --via"),
            ("mozzi simulate ur5 --out @new.html --report @new.html", "--out and --report are both `@new.html`"),
            ("mozzi convert @arm.urdf @arm.urdf", "OUT is the file IN, `@arm.urdf`, expected another name; --in-place"),
            ("mozzi xacro @arm.urdf -o @arm.urdf", "--out is the file FILE"),
        ] {
            let line = line.replace("PID", &std::process::id().to_string());
            let found = said(&line).unwrap_or_default();
            assert!(found.starts_with(expected), "{line}: {found}");
        }
        for line in [
            "mozzi convert @arm.urdf @arm.urdf --in-place",
            "mozzi simulate ur5 --follow @log.csv --controller c.json --out @other.csv --report @other.html",
            "mozzi simulate ur5 --out /dev/null --report /dev/null.html",
            "mozzi view ur5 @log.csv --out @log.html",
        ] {
            assert_eq!(said(line), None, "{line}");
        }
    }
}
