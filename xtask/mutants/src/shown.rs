//! Which tests pass a fault, and whether one of them notices it.

use crate::tree;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// A test: its program, the folder in which it runs, its name, and the seconds that it takes without a fault.
pub struct Test {
    program: PathBuf,
    folder: PathBuf,
    name: String,
    seconds: f64,
}

pub enum Shown {
    /// By this test, or by a program that did not end.
    Noticed(String),
    /// By none of this many tests; `all` if these were all that pass it.
    Missed { tests: usize, all: bool },
}

/// All tests of the packages.
fn tests(tree: &Path) -> Result<Vec<Test>, String> {
    let mut build = tree::cargo(tree, &["test", "--no-run", "--lib", "--tests", "--message-format=json"]);
    let output = build.stderr(Stdio::inherit()).output().map_err(|error| error.to_string())?;
    if !output.status.success() {
        return Err("the tests do not compile".into());
    }
    let mut tests = Vec::new();
    for line in String::from_utf8_lossy(&output.stdout).lines() {
        let message: Value = serde_json::from_str(line).unwrap_or_default();
        let (Some(program), Some(manifest)) = (message["executable"].as_str(), message["manifest_path"].as_str())
        else {
            continue;
        };
        let folder = Path::new(manifest).parent().unwrap_or(tree).to_path_buf();
        let list = Command::new(program).arg("--list").output().map_err(|error| format!("{program}: {error}"))?;
        for name in String::from_utf8_lossy(&list.stdout).lines().filter_map(|line| line.strip_suffix(": test")) {
            let (program, folder, name) = (program.into(), folder.clone(), name.into());
            tests.push(Test { program, folder, name, seconds: 0.0 });
        }
    }
    Ok(tests)
}

/// Runs tests of one program with a fault; none if they did not end in time.
fn run(tests: &[&Test], fault: &str, trace: &Path, limit: Duration) -> Result<Option<(bool, String)>, String> {
    let first = tests[0];
    let mut command = Command::new(&first.program);
    command.arg("--exact").args(tests.iter().map(|test| &test.name)).args(["--test-threads", "1"]);
    command.current_dir(&first.folder).env("FAULT", fault).env("FAULT_TRACE", trace);
    let output = trace.with_extension("output");
    let file = std::fs::File::create(&output).map_err(|error| format!("{}: {error}", output.display()))?;
    command.stdin(Stdio::null()).stdout(file).stderr(Stdio::null());
    let (mut child, start) = (command.spawn().map_err(|error| error.to_string())?, Instant::now());
    loop {
        if let Some(status) = child.try_wait().map_err(|error| error.to_string())? {
            return Ok(Some((status.success(), std::fs::read_to_string(&output).unwrap_or_default())));
        }
        if start.elapsed() > limit {
            let _ = (child.kill(), child.wait());
            return Ok(None);
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Does this for 0, 1, … `count` − 1 on all cores.
fn on_all_cores(count: usize, each: impl Fn(usize) -> Result<(), String> + Sync) -> Result<(), String> {
    let (next, cores) = (AtomicUsize::new(0), std::thread::available_parallelism().map_or(1, usize::from));
    let failed = Mutex::new(Ok(()));
    std::thread::scope(|scope| {
        for _ in 0..cores {
            scope.spawn(|| {
                loop {
                    let k = next.fetch_add(1, Ordering::Relaxed);
                    if k >= count {
                        return;
                    }
                    if let Err(why) = each(k) {
                        *failed.lock().expect("no panics") = Err(why);
                        return;
                    }
                }
            });
        }
    });
    failed.into_inner().expect("no panics")
}

/// The tests that pass each fault, the quickest first.
pub type Passed = BTreeMap<usize, Vec<usize>>;

/// All tests, and which pass a fault.
pub fn passed(tree: &Path, scratch: &Path) -> Result<(Vec<Test>, Passed), String> {
    let mut all = tests(tree)?;
    eprintln!("{} tests", all.len());
    let found: Mutex<Vec<(usize, f64, String)>> = Mutex::new(Vec::new());
    on_all_cores(all.len(), |k| {
        let (trace, start) = (scratch.join(format!("trace{k}")), Instant::now());
        match run(&[&all[k]], "trace", &trace, Duration::from_secs(600))? {
            Some((true, _)) => {
                let text = std::fs::read_to_string(&trace).unwrap_or_default();
                found.lock().expect("no panics").push((k, start.elapsed().as_secs_f64(), text));
            }
            _ => eprintln!("{} fails without a fault and is left out", all[k].name),
        }
        Ok(())
    })?;
    let mut of = Passed::new();
    for (k, seconds, text) in found.into_inner().expect("no panics") {
        all[k].seconds = seconds;
        for fault in text.lines().filter_map(|line| line.parse().ok()) {
            of.entry(fault).or_default().push(k);
        }
    }
    for tests in of.values_mut() {
        tests.sort_by(|&a, &b| all[a].seconds.total_cmp(&all[b].seconds));
    }
    Ok((all, of))
}

/// Shows a fault to its tests, a few at first, until one fails; the last of those that take longer than `patience` are
/// left out.
fn show(fault: usize, of: &[usize], all: &[Test], scratch: &Path, patience: Duration) -> Result<Shown, String> {
    let mut sum = 0.0;
    let is_quick = |k: &&usize| {
        sum += all[**k].seconds;
        sum <= patience.as_secs_f64()
    };
    let shown = of.iter().take_while(is_quick).count().max(1);
    let (mut done, mut size) = (0, 4);
    while done < shown {
        let batch = &of[done..shown.min(done + size)];
        let mut programs: BTreeMap<&Path, Vec<&Test>> = BTreeMap::new();
        for &k in batch {
            programs.entry(&all[k].program).or_default().push(&all[k]);
        }
        for tests in programs.values() {
            let usual: f64 = tests.iter().map(|test| test.seconds).sum();
            let limit = Duration::from_secs_f64(20.0 + 8.0 * usual);
            match run(tests, &fault.to_string(), &scratch.join(format!("shown{fault}")), limit)? {
                Some((true, _)) => {}
                Some((false, output)) => {
                    let test = output.lines().find_map(|line| line.strip_prefix("test ")?.strip_suffix(" ... FAILED"));
                    return Ok(Shown::Noticed(test.unwrap_or("a crash").into()));
                }
                None => return Ok(Shown::Noticed(format!("{} did not end", tests[0].name))),
            }
        }
        (done, size) = (done + batch.len(), 2 * size);
    }
    Ok(Shown::Missed { tests: shown, all: shown == of.len() })
}

/// Shows all faults to the tests that pass them; `report` is called as each is known.
pub fn show_all(
    all: &[Test],
    of: &Passed,
    scratch: &Path,
    patience: Duration,
    report: &(impl Fn(usize, Shown) + Sync),
) -> Result<(), String> {
    let faults: Vec<(&usize, &Vec<usize>)> = of.iter().collect();
    on_all_cores(faults.len(), |k| {
        let (fault, tests) = faults[k];
        report(*fault, show(*fault, tests, all, scratch, patience)?);
        Ok(())
    })
}
