//! A cold build of the main job, in which this program stands between cargo and rustc and takes the time.

use crate::command;
use crate::cpu::Seconds;
use crate::workspace::Workspace;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::io::Write;
use std::path::Path;
use std::process::{Command, ExitCode};

/// The file to which each rustc's time is appended: `package seconds`.
pub const LOG: &str = "MOZZI_WEIGH";
const FOLDER: &str = "target/weigh";
/// A package of another project, and its CPU seconds on the machine whose seconds the page has: machines that others
/// use, too, take up to three times as many.
pub const YARDSTICK: (&str, f64) = ("syn", 6.2);
/// Packages with less are one row.
const LEAST: f64 = 1.0;

pub struct Build {
    /// CPU seconds, as all, of the machine of [`YARDSTICK`].
    pub total: f64,
    /// Those of the yardstick here.
    pub yardstick: f64,
    pub packages: Vec<String>,
    /// The size of the program.
    pub bytes: u64,
    pub machine: String,
}

/// Runs the compiler that cargo names.
pub fn wrapped(log: &Path) -> ExitCode {
    let mut arguments = std::env::args_os().skip(1);
    let mut rustc = Command::new(arguments.next().unwrap_or_else(|| OsString::from("rustc")));
    let succeeded = rustc.args(arguments).status().is_ok_and(|status| status.success());
    let package = std::env::var("CARGO_PKG_NAME").unwrap_or_else(|_| "(cargo's questions)".into());
    if let (Some(seconds), Ok(mut log)) =
        (Seconds::of_children().known(), std::fs::OpenOptions::new().append(true).create(true).open(log))
    {
        // a line that is lost is missing in the sum, which `build` takes from cargo itself
        let _ = log.write_all(format!("{package} {seconds}\n").as_bytes());
    }
    if succeeded { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Builds it in an empty folder, which is removed again.
pub fn build(workspace: &Workspace) -> Result<Build, String> {
    let folder = workspace.fresh_folder(FOLDER)?;
    let log = folder.join("log");
    let this = std::env::current_exe().map_err(|error| error.to_string())?;
    command::run(workspace.cargo(&["fetch", "--locked"]))?;
    let start = Seconds::of_children();
    let mut cargo = workspace.cargo(&["build", "--release", "--locked", "--quiet"]);
    cargo.env("RUSTC_WRAPPER", this).env(LOG, &log).env("CARGO_TARGET_DIR", &folder);
    command::run(cargo)?;
    let total = Seconds::of_children().since(start).known().ok_or("CPU seconds are counted on Linux only")?;
    let program = folder.join(format!("release/mozzi{}", std::env::consts::EXE_SUFFIX));
    let bytes = std::fs::metadata(&program).map_err(|error| format!("{}: {error}", program.display()))?.len();
    let log = std::fs::read_to_string(&log).map_err(|error| format!("{}: {error}", log.display()))?;
    let _ = std::fs::remove_dir_all(&folder);
    let packages = sums(&log);
    let (name, there) = YARDSTICK;
    let yardstick = packages.get(name).copied().ok_or(format!("{name} was not compiled"))?;
    let scale = there / yardstick;
    Ok(Build { total: total * scale, yardstick, packages: rows(packages, total, scale), bytes, machine: machine() })
}

/// The seconds of each package.
fn sums(log: &str) -> BTreeMap<&str, f64> {
    let mut packages: BTreeMap<&str, f64> = BTreeMap::new();
    for (name, seconds) in log.lines().filter_map(|line| line.rsplit_once(' ')) {
        *packages.entry(name).or_default() += seconds.parse().unwrap_or(0.0);
    }
    packages
}

/// The largest packages first, then the sum of the others, then what cargo and build scripts took, each times `scale`.
fn rows(packages: BTreeMap<&str, f64>, total: f64, scale: f64) -> Vec<String> {
    let rest = total - packages.values().sum::<f64>();
    let (mut large, small): (Vec<_>, Vec<_>) = packages.into_iter().partition(|(_, seconds)| *seconds * scale >= LEAST);
    large.sort_by(|a, b| b.1.total_cmp(&a.1));
    let of_small: f64 = small.iter().map(|(_, seconds)| seconds).sum();
    let row = |name: &str, seconds: f64| format!("| {name} | {:.1} |", seconds * scale);
    let mut rows: Vec<String> = large.iter().map(|(name, seconds)| row(name, *seconds)).collect();
    rows.push(row(&format!("{} others", small.len()), of_small));
    rows.push(row("cargo, build scripts", rest));
    rows
}

fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    format!("{cores} cores, {}", name.map_or("of unknown kind", |(_, name)| name.trim()))
}

#[cfg(test)]
mod tests {
    use super::{rows, sums};

    #[test]
    fn builds_of_a_package_are_summed_and_small_ones_are_one_row() {
        let found = rows(sums("mozzi 20\na 0.4\nb 0.6\nmozzi-cli 40\nmozzi 10\n"), 80.0, 0.5);
        let expected =
            ["| mozzi-cli | 20.0 |", "| mozzi | 15.0 |", "| 2 others | 0.5 |", "| cargo, build scripts | 4.5 |"];
        assert_eq!(found, expected);
    }
}
