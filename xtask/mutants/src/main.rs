//! `mozzi-mutants FOLDER SAMPLE SEED`: puts a sample of faults into a clone of the sources in FOLDER/tree, each dormant
//! until the environment names it, compiles the tests once, and shows each fault to the tests that pass it.
//!
//! FOLDER/missed.md lists the faults that no test notices; the last line of the output counts them. A fault takes a few
//! seconds, because the crates are not compiled again for each.

mod candidates;
mod shown;
mod tree;

use candidates::Fault;
use shown::Shown;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::Mutex;
use std::time::Duration;

/// Where faults are put; tests' own tools, texts and the instructions of other processors are left alone.
const SOURCES: [&str; 3] = ["crates/mozzi/src", "crates/mozzi-sim/src", "crates/mozzi-engine/src"];
const LEFT_ALONE: [&str; 6] =
    ["tests.rs", "/tests/", "mozzi/src/testing", "mozzi/src/accuracy.rs", "mozzi/src/random.rs", "/aarch64/"];
/// A fault is shown to tests that take about so long without it.
const PATIENCE: Duration = Duration::from_secs(120);

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let result = match &arguments[..] {
        [folder, sample, seed] => match (sample.parse(), seed.parse()) {
            (Ok(sample), Ok(seed)) => run(Path::new(folder), sample, seed),
            _ => Err("SAMPLE and SEED are whole numbers".into()),
        },
        _ => Err("usage: mozzi-mutants FOLDER SAMPLE SEED".into()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

fn run(folder: &Path, sample: usize, seed: u64) -> Result<(), String> {
    let (tree, scratch) = (folder.join("tree"), folder.join("scratch"));
    clone(&tree)?;
    let _ = std::fs::remove_dir_all(&scratch);
    std::fs::create_dir_all(&scratch).map_err(|error| format!("{}: {error}", scratch.display()))?;
    let mut sources = BTreeMap::new();
    for of in SOURCES {
        read(&tree, &tree.join(of), &mut sources)?;
    }
    let mut all = Vec::new();
    for (file, text) in sources.iter().filter(|(file, _)| LEFT_ALONE.iter().all(|part| !file.contains(part))) {
        all.extend(candidates::candidates(file, text).map_err(|error| format!("{file}: {error}"))?);
    }
    let known = all.len();
    let faults = tree::put(&tree, &sources, chosen(all, 2 * sample, seed), sample)?;
    eprintln!("{} of {known} known faults", faults.len());

    let (tests, of) = shown::passed(&tree, &scratch)?;
    let missed = Mutex::new(Vec::new());
    let noticed = Mutex::new(0);
    shown::show_all(&tests, &of, &scratch, PATIENCE, &|k, shown| match shown {
        Shown::Noticed(test) => {
            eprintln!("{k}: {test}");
            *noticed.lock().expect("no panics") += 1;
        }
        Shown::Missed { tests, all } => {
            let line = line(&faults[k - 1], &sources, &format!("{}{tests} tests", if all { "" } else { "the first " }));
            eprint!("{line}");
            missed.lock().expect("no panics").push(line);
        }
    })?;
    let mut missed = missed.into_inner().expect("no panics");
    let unreached = (1..=faults.len()).filter(|k| !of.contains_key(k));
    missed.extend(unreached.map(|k| line(&faults[k - 1], &sources, "no test passes it")));
    missed.sort();
    std::fs::write(folder.join("missed.md"), missed.concat()).map_err(|error| format!("missed.md: {error}"))?;
    println!("{} noticed, {} not", noticed.into_inner().expect("no panics"), missed.len());
    Ok(())
}

/// "file:line kind: old → new (seen by …)"
fn line(fault: &Fault, sources: &tree::Sources, by: &str) -> String {
    let text = &sources[&fault.file];
    let number = 1 + text[..fault.at.start].matches('\n').count();
    let short = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let (old, new) = (short(&text[fault.at.clone()]), fault.instead.as_deref().map_or("nothing".into(), short));
    format!("- {}:{number} {}: `{old}` → `{new}` ({by})\n", fault.file, fault.kind)
}

/// The sources of HEAD in a folder of their own, whose `target` stays from run to run.
fn clone(tree: &Path) -> Result<(), String> {
    let git = |arguments: &[&str], within: &Path| {
        let status = Command::new("git").args(arguments).current_dir(within).status();
        status.is_ok_and(|status| status.success()).then_some(()).ok_or(format!("git {} failed", arguments.join(" ")))
    };
    let here = std::env::current_dir().map_err(|error| error.to_string())?;
    if !tree.join(".git").exists() {
        git(&["clone", "--quiet", "--shared", ".", &tree.display().to_string()], &here)?;
    }
    git(&["fetch", "--quiet", &here.display().to_string(), "HEAD"], tree)?;
    git(&["checkout", "--quiet", "--force", "--detach", "FETCH_HEAD"], tree)
}

fn read(tree: &Path, folder: &Path, sources: &mut tree::Sources) -> Result<(), String> {
    let list = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut paths: Vec<PathBuf> = list.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            read(tree, &path, sources)?;
        } else if path.extension().is_some_and(|end| end == "rs") {
            let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
            let name = path.strip_prefix(tree).expect("a file in it").display().to_string();
            sources.insert(name, text);
        }
    }
    Ok(())
}

/// `count` faults by a seed, none within another.
fn chosen(mut all: Vec<Fault>, count: usize, seed: u64) -> Vec<Fault> {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut random = move |below: usize| {
        state ^= state << 13; // Marsaglia's xorshift
        state ^= state >> 7;
        state ^= state << 17;
        (state % below as u64) as usize
    };
    for k in (1..all.len()).rev() {
        all.swap(k, random(k + 1));
    }
    let mut taken: Vec<Fault> = Vec::new();
    for fault in all {
        let apart = |other: &Fault| {
            other.file != fault.file || other.at.end <= fault.at.start || fault.at.end <= other.at.start
        };
        if taken.len() < count && taken.iter().all(apart) {
            taken.push(fault);
        }
    }
    taken
}
