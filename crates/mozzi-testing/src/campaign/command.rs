//! `cargo xtask campaign`.

use crate::campaign::case::Case;
use crate::campaign::log::{Finding, Way};
use crate::campaign::progress::Progress;
use crate::campaign::run::{differs, one};
use crate::campaign::{emitted, generate, page, shrink};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Compares every quantity of random robots in two ways.
#[derive(clap::Args)]
pub struct Options {
    /// Robots in all.
    #[arg(long, default_value_t = 100_000)]
    robots: u64,
    /// The first robot's seed; the others follow.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Continues the campaign in the file of progress.
    #[arg(long)]
    resume: bool,
    /// Stops after this time, s.
    #[arg(long)]
    seconds: Option<f64>,
    /// The file of progress.
    #[arg(long, default_value = "target/campaign/state.json")]
    state: PathBuf,
    /// The page to which a row is added when all robots are done, or the time is over.
    #[arg(long)]
    page: Option<PathBuf>,
    /// The date in the page.
    #[arg(long, default_value = "")]
    date: String,
    /// The commit in the page.
    #[arg(long, default_value = "")]
    commit: String,
}

/// Robots between two writes of the file of progress.
const BLOCK: u64 = 500;

/// Runs the campaign; true if nothing differs.
///
/// # Errors
/// A message if a file cannot be read or written, or C cannot be compiled.
pub fn run(options: &Options) -> Result<bool, String> {
    let mut progress = match options.resume && options.state.exists() {
        true => Progress::read(&options.state)?,
        false => Progress::from_seed(options.seed),
    };
    let folder = options.state.parent().unwrap_or(Path::new(".")).join("c");
    let has_compiler = emitted::has_compiler();
    let (start, before) = (Instant::now(), progress.seconds);
    std::panic::set_hook(Box::new(|_| {})); // a panic is printed as a finding
    while progress.robots < options.robots && options.seconds.is_none_or(|most| start.elapsed().as_secs_f64() < most) {
        let seed = progress.first + progress.robots;
        let mut findings = one(seed, &mut progress.counts);
        if seed.is_multiple_of(emitted::ONE_IN) && has_compiler {
            findings.extend(emitted::one(seed, &folder, &mut progress.counts)?);
        }
        for finding in findings {
            progress.findings.push(told(&finding));
        }
        progress.robots += 1;
        progress.seconds = before + start.elapsed().as_secs_f64();
        if progress.robots.is_multiple_of(BLOCK) {
            progress.write(&options.state)?;
        }
        if progress.robots.is_multiple_of(20 * BLOCK) {
            eprintln!("{} robots, {:.0} s, {} findings", progress.robots, progress.seconds, progress.findings.len());
        }
    }
    progress.write(&options.state)?;
    let all = progress.counts.sum(|_, _| true);
    let (robots, comparisons, findings) = (progress.robots, all.comparisons, progress.findings.len());
    println!("{robots} robots, {comparisons} comparisons, {} numbers, {findings} findings", all.numbers);
    if let Some(path) = &options.page {
        let old = std::fs::read_to_string(path).unwrap_or_default();
        let text = page::write(&old, &progress, &options.date, &options.commit);
        std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    Ok(progress.findings.is_empty())
}

/// Prints a finding with the smallest robot, and returns both.
fn told(finding: &Finding) -> Value {
    eprintln!("{finding}");
    let case = generate::case(finding.seed);
    let still = |case: &Case| differs(case, finding.quantity, finding.way);
    let smallest = match finding.way {
        Way::C => case, // each trial would call the compiler
        _ => shrink::shrink(&case, |case| still(case).is_some()),
    };
    let small = still(&smallest).map(|finding| finding.what);
    let value = json!({ "finding": finding.to_string(), "smallest": small, "case": smallest.to_json() });
    println!("{}", mozzi_urdf::json::print(&value));
    value
}
