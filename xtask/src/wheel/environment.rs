//! An environment that contains only the wheel: the README's Python runs there, and the notebooks.

use super::PACKAGE;
use crate::command;
use crate::venv;
use crate::workspace::Workspace;
use std::path::{Path, PathBuf};
use std::process::Command;

const NOTEBOOKS: &str = "examples/notebooks";

/// Installs a wheel into an empty environment and runs the README's Python there; then, with matplotlib, the notebooks.
pub fn install(workspace: &Workspace, wheel: &Path, notebooks: bool) -> Result<String, String> {
    let home = workspace.fresh_folder("target/wheel-venv")?;
    let mut create = Command::new(venv::python(workspace));
    command::run(create.args(["-m", "venv"]).arg(&home))?;
    let python = home.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let pip = |what: &str| {
        let mut pip = Command::new(&python);
        command::run(pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", what]))
    };
    pip(&wheel.to_string_lossy())?;
    let readme = format!("{PACKAGE}/README.md");
    let text = std::fs::read_to_string(workspace.path(&readme)).map_err(|error| format!("{readme}: {error}"))?;
    let program = python_of(&text);
    if program.is_empty() {
        return Err(format!("{readme} has no Python to run"));
    }
    run(workspace, &python, "readme.py", &program)?;
    let mut note = format!("{readme} runs where nothing else is installed");
    if notebooks {
        pip(&format!("{}[plot]", wheel.display()))?;
        let files = notebooks_in(workspace)?;
        for file in &files {
            let text = std::fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))?;
            let program = code_of_notebook(&text).ok_or_else(|| format!("{} is no notebook", file.display()))?;
            run(workspace, &python, &format!("{}.py", super::name(file)), &program)?;
        }
        note += &format!("; {} notebooks run with the extra `plot`", files.len());
    }
    Ok(note)
}

/// Runs a program in an empty folder.
fn run(workspace: &Workspace, python: &Path, name: &str, program: &str) -> Result<(), String> {
    let scratch = workspace.scratch("wheel")?;
    std::fs::write(scratch.join(name), program).map_err(|error| format!("{name}: {error}"))?;
    let mut python = Command::new(python);
    python.arg(name).current_dir(&scratch).env_remove("PYTHONPATH");
    // no window; 20,000 states where a notebook computes a million
    command::run(python.env("MPLBACKEND", "agg").env("STATES", "20000"))
}

fn notebooks_in(workspace: &Workspace) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(workspace.path(NOTEBOOKS)).map_err(|error| format!("{NOTEBOOKS}: {error}"))?;
    let paths = entries.flatten().map(|entry| entry.path());
    let mut paths: Vec<_> = paths.filter(|path| path.extension().is_some_and(|end| end == "ipynb")).collect();
    paths.sort();
    match paths.is_empty() {
        true => Err(format!("{NOTEBOOKS} has no notebook")),
        false => Ok(paths),
    }
}

/// The code cells of a notebook, in order.
fn code_of_notebook(text: &str) -> Option<String> {
    let notebook: serde_json::Value = serde_json::from_str(text).ok()?;
    let cells = notebook["cells"].as_array()?.iter().filter(|cell| cell["cell_type"] == "code");
    let code = |cell: &serde_json::Value| match &cell["source"] {
        serde_json::Value::String(source) => Some(source.clone()),
        lines => lines.as_array()?.iter().map(|line| line.as_str()).collect(),
    };
    Some(cells.map(code).collect::<Option<Vec<String>>>()?.join("\n"))
}

/// The code blocks between ```python and ```, in order.
fn python_of(text: &str) -> String {
    let blocks = text.split("```python\n").skip(1).filter_map(|rest| rest.split("```").next());
    blocks.collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::{code_of_notebook, python_of};

    #[test]
    fn python_is_taken_out_of_a_text() {
        let text = "a\n```python\nx = 1\n```\nb\n```console\n$ c\n```\n```python\nprint(x)\n```\n";
        assert_eq!(python_of(text), "x = 1\n\nprint(x)\n");
        assert_eq!(python_of("none"), "");
    }

    #[test]
    fn code_is_taken_out_of_a_notebook() {
        let text = r#"{"cells": [{"cell_type": "code", "source": ["x = 1\n", "y = 2"]},
            {"cell_type": "markdown", "source": "text"}, {"cell_type": "code", "source": "x"}]}"#;
        assert_eq!(code_of_notebook(text), Some("x = 1\ny = 2\nx".into()));
        assert_eq!(code_of_notebook("{}"), None);
    }
}
