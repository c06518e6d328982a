//! Live pages of robots, which chapters embed.

use crate::Place;
use crate::commands;
use std::collections::BTreeMap;
use std::path::Path;

/// Arguments of `mozzi` by the name of the page.
pub type Robots = BTreeMap<String, Vec<String>>;

/// The arguments that make a live page, before `FILE`: the only place to change if another command makes them.
fn command(model: &str, options: &[&str]) -> Vec<String> {
    let words = match options {
        [] => vec!["play", model, "--out"],
        motion => [&["simulate", model], motion, &["--report"]].concat(),
    };
    words.into_iter().map(str::to_owned).collect()
}

/// Adds a page to those to be made; the command as one would type it, and an error if the name has another robot.
pub fn add(robots: &mut Robots, name: &str, model: &str, options: &[&str]) -> Result<String, String> {
    let command = command(model, options);
    let shown = format!("mozzi {} {name}.html", command.join(" "));
    match robots.insert(name.to_owned(), command.clone()) {
        Some(other) if other != command => Err(format!("the robot page `{name}` is made by two commands")),
        _ => Ok(shown),
    }
}

/// Makes each page once, into `robots/` of the book.
pub fn make(place: &Place, html: &Path, robots: &Robots) -> Result<(), Vec<String>> {
    let folder = html.join("robots");
    std::fs::create_dir_all(&folder).map_err(|error| vec![format!("{}: {error}", folder.display())])?;
    let mut problems = Vec::new();
    for (name, arguments) in robots {
        let file = folder.join(format!("{name}.html"));
        let file = file.to_string_lossy().into_owned();
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).chain([file.as_str()]).collect();
        problems.extend(commands::output(place, &arguments).err());
    }
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}
