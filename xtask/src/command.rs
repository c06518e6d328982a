//! Runs programs: the command is printed, and nothing is read from the terminal.

use crate::report::Outcome;
use std::borrow::BorrowMut;
use std::process::{Command, Stdio};

/// Run it and show its output; `Err` gives the reason of a failure.
pub fn run(mut command: impl BorrowMut<Command>) -> Result<(), String> {
    let command = command.borrow_mut();
    println!("$ {}", shown(command));
    match command.stdin(Stdio::null()).status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("`{}` ended with {status}", shown(command))),
        Err(error) => Err(format!("`{}` did not start: {error}", shown(command))),
    }
}

/// Run it and keep its standard output, whatever its exit status; `Err` if it failed to start or the output is not
/// text.
pub fn output(mut command: impl BorrowMut<Command>) -> Result<(bool, String), String> {
    let command = command.borrow_mut();
    let output = command.stdin(Stdio::null()).stderr(Stdio::inherit()).output();
    let output = output.map_err(|error| format!("`{}` did not start: {error}", shown(command)))?;
    let text = String::from_utf8(output.stdout).map_err(|_| format!("`{}` printed no text", shown(command)))?;
    Ok((output.status.success(), text))
}

/// Run it as a whole step.
pub fn outcome(command: impl BorrowMut<Command>) -> Outcome {
    match run(command) {
        Ok(()) => Outcome::Passed(String::new()),
        Err(why) => Outcome::Failed(why),
    }
}

/// True if the program starts and succeeds with `--version`.
pub fn exists(command: &mut Command) -> bool {
    let quiet = command.arg("--version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    quiet.status().is_ok_and(|status| status.success())
}

/// The command as one would type it.
pub fn shown(command: &Command) -> String {
    let program = std::path::Path::new(command.get_program()).file_name().unwrap_or(command.get_program());
    let words = std::iter::once(program).chain(command.get_args());
    words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ")
}
