//! The bundles of `page/`, which are committed: npm builds them, and a stamp that needs no Node compares them with
//! their sources. Next to each is the WebAssembly that the page contains: see [`wasm`].

use crate::command;
use crate::report::Outcome;
use crate::stamp::fnv;
use crate::wasm;
use crate::workspace::Workspace;
use flate2::read::GzDecoder;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The pages: the name of each, as `page/build.mjs` knows it, and its bundle.
const PAGES: [(&str, &str); 2] =
    [("report", "crates/mozzi-report/bundle/page.html.gz"), ("play", "crates/mozzi-report/bundle/play.html.gz")];
/// Sources of the pages next to the scripts, as seen from `page/`; the notes are those of the wasm.
const SOURCES: [&str; 10] = [
    "../crates/mozzi-report/bundle/mozzi.wasm.txt",
    "../crates/mozzi-report/bundle/play.wasm.txt",
    "build.mjs",
    "index.html",
    "pack.mjs",
    "package-lock.json",
    "package.json",
    "play.css",
    "play.html",
    "style.css",
];
const NPM: &str = if cfg!(windows) { "npm.cmd" } else { "npm" };

/// Names of the browsers that can run the tests.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// Rebuilds the bundles, and before them the wasm if there is a compiler for it.
pub fn write(workspace: &Workspace) -> Outcome {
    let wasm = || wasm::write(workspace).and_then(|made| wasm::are_current(workspace).map(|()| made));
    let built = install(workspace).and_then(|()| wasm()).and_then(|made| {
        PAGES.iter().try_for_each(|(name, bundle)| build(workspace, name, &workspace.path(bundle)))?;
        Ok(made)
    });
    match built {
        Ok(made) => Outcome::Passed(format!("{} pages, with {made}", PAGES.len())),
        Err(why) => Outcome::Failed(why),
    }
}

/// Builds the bundles elsewhere and compares. The wasm is not rebuilt: another compiler gives other bytes.
pub fn compare(workspace: &Workspace) -> Outcome {
    let all = wasm::are_current(workspace)
        .and_then(|()| install(workspace))
        .and_then(|()| PAGES.iter().try_for_each(|(name, bundle)| is_built(workspace, name, bundle)));
    match all {
        Ok(()) => Outcome::Passed("as npm builds them".into()),
        Err(why) => Outcome::Failed(why),
    }
}

fn is_built(workspace: &Workspace, name: &str, bundle: &str) -> Result<(), String> {
    let new = workspace.target().join(format!("{name}.html.gz"));
    build(workspace, name, &new)?;
    // unpacked: another version of zlib packs to other bytes
    match unpack(&new)? == unpack(&workspace.path(bundle))? {
        true => Ok(()),
        false => Err(format!("{bundle} is not what npm builds from page/: run cargo xtask page")),
    }
}

/// The text of a bundle.
pub fn unpack(bundle: &Path) -> Result<String, String> {
    let wrong = |error: std::io::Error| format!("{}: {error}", bundle.display());
    let mut text = String::new();
    GzDecoder::new(File::open(bundle).map_err(wrong)?).read_to_string(&mut text).map_err(wrong)?;
    Ok(text)
}

fn install(workspace: &Workspace) -> Result<(), String> {
    let page = workspace.path("page");
    command::run(Command::new(NPM).current_dir(page).args(["ci", "--no-audit", "--no-fund", "--ignore-scripts"]))
}

fn build(workspace: &Workspace, name: &str, file: &Path) -> Result<(), String> {
    command::run(Command::new("node").current_dir(workspace.path("page")).args(["build.mjs", name]).arg(file))
}

/// True if the bundles have the stamp of the current sources.
pub fn is_current(workspace: &Workspace) -> Outcome {
    let stamp = match wasm::are_current(workspace).and_then(|()| stamp(workspace)) {
        Ok(stamp) => stamp,
        Err(why) => return Outcome::Failed(why),
    };
    for (_, bundle) in PAGES {
        match unpack(&workspace.path(bundle)) {
            Ok(text) if text.contains(&format!("stamp {stamp}.")) => {}
            Ok(_) => {
                return Outcome::Failed(format!("{bundle} is older than page/: run cargo xtask page (needs npm)"));
            }
            Err(why) => return Outcome::Failed(why),
        }
    }
    Outcome::Passed(format!("stamp {stamp}"))
}

/// The hash of `page/build.mjs`: 64-bit FNV-1a of names and texts.
fn stamp(workspace: &Workspace) -> Result<String, String> {
    let mut files: Vec<String> = SOURCES.map(String::from).to_vec();
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
