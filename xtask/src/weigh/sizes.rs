//! The sizes of what is published: the command line, the wheel, the C library, the pages.

use super::Row;
use crate::command;
use crate::package;
use crate::report::Outcome;
use crate::venv;
use crate::wheel;
use crate::workspace::Workspace;
use std::path::Path;

/// Pages, which every program contains.
const PAGES: [(&str, &[&str]); 2] =
    [("page of reports", &["page.html.gz", "mozzi.wasm.gz"]), ("playground", &["play.html.gz", "play.wasm.gz"])];

pub fn all(workspace: &Workspace) -> Result<Vec<Row>, String> {
    let bundle = workspace.path("crates/mozzi-report/bundle");
    let mut rows = vec![
        row("published program", program(workspace)?, Some(13.0)),
        row("wheel", wheel(workspace)?, Some(7.5)),
        row("C library", c_library(workspace)?, Some(7.0)),
    ];
    for (what, files) in PAGES {
        let bytes = files.iter().map(|file| size(&bundle.join(file))).sum::<Result<u64, String>>()?;
        rows.push(row(what, bytes, None));
    }
    Ok(rows)
}

fn row(what: &'static str, bytes: u64, most: Option<f64>) -> Row {
    Row { what, found: bytes as f64 / 1e6, unit: "MB", most }
}

fn size(file: &Path) -> Result<u64, String> {
    Ok(std::fs::metadata(file).map_err(|error| format!("{}: {error}", file.display()))?.len())
}

/// As the Debian package has it.
fn program(workspace: &Workspace) -> Result<u64, String> {
    command::run(workspace.cargo(&["build", "--profile", "dist", "--package", "mozzi-cli", "--features", "arrow"]))?;
    size(&workspace.target().join(format!("dist/mozzi{}", std::env::consts::EXE_SUFFIX)))
}

/// As `cargo xtask wheel` makes it, but for this machine's glibc.
fn wheel(workspace: &Workspace) -> Result<u64, String> {
    if !venv::python(workspace).is_file() {
        return Err("there is no Python environment to pack a wheel in: cargo xtask test makes it".into());
    }
    if let Outcome::Failed(why) = venv::add(workspace, wheel::TOOLS) {
        return Err(why);
    }
    let files = workspace.scratch("weigh-wheel")?;
    let cargo = ["build", "--profile", "library", "--package", "mozzi-py"];
    package::put_together(workspace, &files, &cargo, "library")?;
    let file = wheel::pack(workspace, &files)?;
    wheel::recompress(workspace, &file)?;
    size(&file)
}

fn c_library(workspace: &Workspace) -> Result<u64, String> {
    command::run(workspace.cargo(&["build", "--profile", "library", "--package", "mozzi-c"]))?;
    let name = format!("{}mozzi_c{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    size(&workspace.target().join("library").join(name))
}
