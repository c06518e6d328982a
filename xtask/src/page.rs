//! The bundle of `page/`, which is committed: npm builds it, and a stamp that needs no Node compares it with its
//! sources. Next to it is the WebAssembly that the page contains: see [`wasm`].

use crate::command;
use crate::report::Outcome;
use crate::stamp::fnv;
use crate::wasm;
use crate::workspace::Workspace;
use std::path::PathBuf;
use std::process::Command;

const BUNDLE: &str = "crates/mozzi-report/bundle/page.html";
/// The note of the wasm, as seen from `page/`.
const WASM: &str = "../crates/mozzi-report/bundle/mozzi.wasm.txt";
const NPM: &str = if cfg!(windows) { "npm.cmd" } else { "npm" };

/// Names of the browsers that can run the tests.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// Rebuilds the bundle, and before it the wasm if there is a compiler for it.
pub fn write(workspace: &Workspace) -> Outcome {
    let wasm = wasm::write(workspace).and_then(|made| wasm::is_current(workspace).map(|()| made));
    match wasm.and_then(|made| build(workspace, &workspace.path(BUNDLE)).map(|()| made)) {
        Ok(made) => Outcome::Passed(format!("{BUNDLE}, with {made}")),
        Err(why) => Outcome::Failed(why),
    }
}

/// Builds the bundle elsewhere and compares. The wasm is not rebuilt: another compiler gives other bytes.
pub fn compare(workspace: &Workspace) -> Outcome {
    if let Err(why) = wasm::is_current(workspace) {
        return Outcome::Failed(why);
    }
    let new = workspace.target().join("page.html");
    let read = |path: &PathBuf| std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()));
    let both = build(workspace, &new).and_then(|()| Ok((read(&new)?, read(&workspace.path(BUNDLE))?)));
    match both {
        Ok((new, committed)) if new == committed => Outcome::Passed("as npm builds it".into()),
        Ok(_) => Outcome::Failed(format!("{BUNDLE} is not what npm builds from page/: run cargo xtask page")),
        Err(why) => Outcome::Failed(why),
    }
}

fn build(workspace: &Workspace, file: &std::path::Path) -> Result<(), String> {
    let page = workspace.path("page");
    command::run(Command::new(NPM).current_dir(&page).args(["ci", "--no-audit", "--no-fund", "--ignore-scripts"]))?;
    command::run(Command::new("node").current_dir(&page).arg("build.mjs").arg(file))
}

/// True if the bundle has the stamp of the current sources.
pub fn is_current(workspace: &Workspace) -> Outcome {
    let bundle = match std::fs::read_to_string(workspace.path(BUNDLE)) {
        Ok(bundle) => bundle,
        Err(error) => return Outcome::Failed(format!("{BUNDLE}: {error}")),
    };
    match wasm::is_current(workspace).and_then(|()| stamp(workspace)) {
        Ok(stamp) if bundle.contains(&format!("stamp {stamp}.")) => Outcome::Passed(format!("stamp {stamp}")),
        Ok(_) => Outcome::Failed(format!("{BUNDLE} is older than page/: run cargo xtask page (needs npm)")),
        Err(why) => Outcome::Failed(why),
    }
}

/// The hash of `page/build.mjs`: 64-bit FNV-1a of names and texts.
fn stamp(workspace: &Workspace) -> Result<String, String> {
    let mut files: Vec<String> =
        [WASM, "build.mjs", "index.html", "pack.mjs", "package-lock.json", "package.json", "style.css"]
            .map(String::from)
            .to_vec();
    let entries = std::fs::read_dir(workspace.path("page/src")).map_err(|error| format!("page/src: {error}"))?;
    let names = entries.filter_map(Result::ok).map(|entry| entry.file_name().to_string_lossy().into_owned());
    files.extend(names.filter(|name| name.ends_with(".js")).map(|name| format!("src/{name}")));
    files.sort();
    let mut all = Vec::new();
    for file in files {
        let path = workspace.path("page").join(&file);
        let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        all.extend(format!("{file}\n{}", text.replace("\r\n", "\n")).into_bytes());
    }
    Ok(fnv(all))
}

/// A browser for the tests of the page.
pub fn browser() -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    let paths = std::env::split_paths(&folders).flat_map(|folder| BROWSERS.map(|name| folder.join(name)));
    paths.into_iter().find(|path| path.is_file())
}
