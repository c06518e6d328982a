//! Reference pages that are generated here: the command line from its help, the Python package from its stubs, the
//! libraries of Rust and C.

use crate::links::Sources;
use crate::{Place, commands, python, text};

/// Each page, with its place in the book.
pub fn pages(place: &Place, sources: &mut Sources) -> Result<Vec<(&'static str, String)>, Vec<String>> {
    let one = |error: String| vec![error];
    Ok(vec![
        ("reference/cli.md", command_line(place).map_err(one)?),
        ("reference/python.md", python::page(&place.root).map_err(one)?),
        ("reference/c.md", c(place, sources).map_err(one)?),
    ])
}

const COMMAND_LINE: &str = "\
# Command line

The help of every command, as `mozzi --help` and `mozzi COMMAND --help` print it. [The guide](../manual/command-line.md)
has examples.

";

fn command_line(place: &Place) -> Result<String, String> {
    let help = commands::output(place, &["--help"])?;
    let mut page = format!("{COMMAND_LINE}## `mozzi`\n\n```text\n{}\n```\n", help.trim_end());
    let names = names(&help);
    if names.is_empty() {
        return Err("`mozzi --help` lists no commands".into());
    }
    for name in names {
        let help = commands::output(place, &[name, "--help"])?;
        page += &format!("\n## `mozzi {name}`\n\n```text\n{}\n```\n", help.trim_end());
    }
    Ok(page)
}

/// The commands that a help text lists.
fn names(help: &str) -> Vec<&str> {
    let list = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let first = list.filter_map(|line| line.strip_prefix("  ").filter(|line| !line.starts_with(' ')));
    first.filter_map(|line| line.split_whitespace().next()).filter(|name| *name != "help").collect()
}

const C: &str = "\
# C and C++

[The manual](../manual/cpp.md) has the guarantees, errors and examples. The declarations, with their documentation:

";

/// Links to the headers, and a list of the functions of C.
fn c(place: &Place, sources: &mut Sources) -> Result<String, String> {
    let folder = "crates/mozzi-c/include/mozzi";
    let mut page = C.to_owned();
    let header = text::read(&place.root.join(folder).join("mozzi.h"))?;
    for (name, what) in [("mozzi.h", "the interface in C99"), ("mozzi.hpp", "the header of C++17, on it")] {
        let file = sources.show(&format!("{folder}/{name}"));
        page += &format!("- <a href=\"../{file}\"><code>{name}</code></a>: {what}\n");
    }
    page += "\n## Functions of `mozzi.h`\n\n| function | arguments |\n|---|---|\n";
    let mut functions = 0;
    for statement in declarations(&header) {
        let Some((head, arguments)) = statement.split_once('(') else { continue };
        let Some(name) = head.rsplit([' ', '*']).next().filter(|name| name.starts_with("mozzi_")) else { continue };
        page += &format!("| `{name}` | `{}` |\n", arguments.trim_end_matches([')', ';']).replace('|', "\\|"));
        functions += 1;
    }
    match functions {
        0 => Err("mozzi.h declares no functions".into()),
        _ => Ok(page),
    }
}

/// The declarations of a header, one line each, without comments.
fn declarations(header: &str) -> Vec<String> {
    let mut bare = String::new();
    let mut rest = header;
    while let Some(at) = rest.find("/*") {
        bare += &rest[..at];
        rest = rest[at..].find("*/").map_or("", |end| &rest[at + end + 2..]);
    }
    bare += rest;
    let lines = bare.lines().filter(|line| !line.trim_start().starts_with('#') && !line.trim_start().starts_with("//"));
    let bare = lines.collect::<Vec<_>>().join(" ");
    let statements = bare.split(';').map(|part| part.split_whitespace().collect::<Vec<_>>().join(" "));
    statements.filter(|part| !part.contains('{') && part.ends_with(')')).collect()
}

#[cfg(test)]
mod tests {
    use super::{declarations, names};

    #[test]
    fn commands_of_a_help_text() {
        let help = "Usage: mozzi\n\nCommands:\n  info   Show\n         more\n  help   Print\n\nOptions:\n  -h\n";
        assert_eq!(names(help), ["info"]);
    }

    #[test]
    fn functions_of_a_header() {
        let header = "/* a; b */\n#define X 1\ntypedef struct A A;\nint mozzi_f(const A *a,\n          int n);\n";
        assert_eq!(declarations(header), ["int mozzi_f(const A *a, int n)"]);
    }
}
