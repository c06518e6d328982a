//! A clone of the sources in which many faults are dormant: `__fault(k)` is true of the one that is shown to the tests.

use crate::candidates::Fault;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;
use std::path::Path;
use std::process::{Command, Stdio};

pub const PACKAGES: [&str; 6] = ["-p", "mozzi", "-p", "mozzi-sim", "-p", "mozzi-engine"];

/// The environment's `FAULT`, looked up once, chooses. `FAULT=trace` writes which faults were passed to `FAULT_TRACE`.
const SWITCH: &str = r#"
extern crate std as std_for_faults;
static FAULT: core::sync::atomic::AtomicUsize = core::sync::atomic::AtomicUsize::new(usize::MAX);
static PASSED: [core::sync::atomic::AtomicBool; 20_000] = [const { core::sync::atomic::AtomicBool::new(false) }; 20_000];
/// True of the fault that is shown to the tests.
#[doc(hidden)]
#[inline]
pub fn __fault(k: usize) -> bool {
    let fault = FAULT.load(core::sync::atomic::Ordering::Relaxed);
    fault == k || (fault > 20_000 && chosen(k))
}
#[cold]
#[inline(never)]
fn chosen(k: usize) -> bool {
    use core::sync::atomic::Ordering::Relaxed;
    use std_for_faults::io::Write as _;
    if FAULT.load(Relaxed) == usize::MAX {
        let text = std_for_faults::env::var("FAULT").unwrap_or_default();
        FAULT.store(if text == "trace" { usize::MAX - 1 } else { text.parse().unwrap_or(0) }, Relaxed);
    }
    if FAULT.load(Relaxed) == usize::MAX - 1 && !PASSED[k].swap(true, Relaxed) {
        let file = std_for_faults::env::var("FAULT_TRACE").unwrap_or_default();
        if let Ok(mut file) = std_for_faults::fs::OpenOptions::new().append(true).create(true).open(file) {
            let _ = file.write_all(std_for_faults::format!("{k}\n").as_bytes());
        }
    }
    FAULT.load(Relaxed) == k
}
"#;

/// The sources as they were, by file.
pub type Sources = BTreeMap<String, String>;

/// Writes all files with these faults, numbered from 1; returns the lines that each takes.
fn write(tree: &Path, sources: &Sources, faults: &[Fault]) -> Result<Vec<RangeInclusive<u64>>, String> {
    let mut lines = vec![0..=0; faults.len()];
    for (file, text) in sources {
        let mut own: Vec<usize> = (0..faults.len()).filter(|&k| faults[k].file == *file).collect();
        own.sort_by_key(|&k| faults[k].at.start);
        let path = if file.starts_with("crates/mozzi/") { "crate" } else { "mozzi" };
        let (mut new, mut from) = (String::new(), 0);
        for k in own {
            let Fault { at, instead, .. } = &faults[k];
            let old = &text[at.clone()];
            new += &text[from..at.start];
            let first = 1 + new.matches('\n').count() as u64;
            new += &match instead {
                None => format!("if !{path}::__fault({}) {{ {old}; }}", k + 1),
                Some(other) => format!("(if {path}::__fault({}) {{ {other} }} else {{ {old} }})", k + 1),
            };
            lines[k] = first..=1 + new.matches('\n').count() as u64;
            from = at.end;
        }
        new += &text[from..];
        if file == "crates/mozzi/src/lib.rs" {
            new += SWITCH;
        }
        std::fs::write(tree.join(file), new).map_err(|error| format!("{file}: {error}"))?;
    }
    Ok(lines)
}

/// Puts the faults into the tree, without those that do not compile, and at most `count`.
pub fn put(tree: &Path, sources: &Sources, mut faults: Vec<Fault>, count: usize) -> Result<Vec<Fault>, String> {
    // the libraries first, which is quick; then the tests, which compile what is only for them
    let mut of: &[&str] = &["--lib"];
    for _ in 0..20 {
        let lines = write(tree, sources, &faults)?;
        let mut check = cargo(tree, &["check", "--keep-going", "--message-format=json"]);
        check.args(of);
        let output = check.stderr(Stdio::null()).output().map_err(|error| error.to_string())?;
        if output.status.success() && of.len() == 1 {
            of = &["--lib", "--tests"];
            continue;
        }
        if output.status.success() {
            faults.truncate(count);
            write(tree, sources, &faults)?;
            return Ok(faults);
        }
        let (mut wrong, mut other) = (BTreeSet::new(), String::new());
        for line in String::from_utf8_lossy(&output.stdout).lines() {
            let message = &serde_json::from_str::<Value>(line).unwrap_or_default()["message"];
            if message["level"] == "error" {
                let before = wrong.len();
                spans(message, &mut |span| {
                    let at = (span["file_name"].as_str(), span["line_start"].as_u64(), span["line_end"].as_u64());
                    let (Some(file), Some(first), Some(last)) = at else { return };
                    let here =
                        |k: &usize| faults[*k].file == file && *lines[*k].start() <= last && first <= *lines[*k].end();
                    wrong.extend((0..faults.len()).filter(here));
                });
                if wrong.len() == before {
                    other += message["rendered"].as_str().unwrap_or_default();
                }
            }
        }
        if wrong.is_empty() {
            return Err(format!("an error that is no fault's: {other}"));
        }
        eprintln!("{} of {} do not compile", wrong.len(), faults.len());
        let mut k = 0;
        faults.retain(|_| {
            k += 1;
            !wrong.contains(&(k - 1))
        });
    }
    Err("faults that do not compile remain".into())
}

/// All spans of a message of the compiler, of its children and of expanded macros.
fn spans(message: &Value, visit: &mut impl FnMut(&Value)) {
    for span in message["spans"].as_array().into_iter().flatten() {
        visit(span);
        let mut expansion = &span["expansion"];
        while expansion.is_object() {
            visit(&expansion["span"]);
            expansion = &expansion["span"]["expansion"];
        }
    }
    for child in message["children"].as_array().into_iter().flatten() {
        spans(child, visit);
    }
}

/// Cargo in the tree, for the packages with faults.
pub fn cargo(tree: &Path, arguments: &[&str]) -> Command {
    let mut cargo = Command::new("cargo");
    cargo.args(arguments).args(PACKAGES).current_dir(tree);
    cargo.env("RUSTFLAGS", "--cap-lints warn -Aunused").env("CARGO_INCREMENTAL", "0").env_remove("CARGO_TARGET_DIR");
    cargo
}
