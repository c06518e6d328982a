//! `cargo xtask weigh`: the CPU seconds of each package in a cold build of the main job, and the sizes of what users
//! download, into docs/weight.md.

mod crates;
mod sizes;

pub use crates::{LOG, wrapped};

use crate::report::Outcome;
use crate::workspace::Workspace;

const PAGE: &str = "docs/weight.md";

const HEAD: &str = "\
# Weight

What a newcomer waits for and downloads. `cargo xtask weigh` writes this page: it builds the main job (`cargo run
--release`) in an empty folder and counts the CPU seconds of each package; a machine with two cores waits about half of
them. A change that raises a row says so.
";

/// A row of a table.
struct Row {
    what: &'static str,
    found: f64,
    unit: &'static str,
    most: Option<f64>,
}

impl Row {
    fn text(&self) -> String {
        let budget = self.most.map_or("–".into(), |most| format!("{most} {}", self.unit));
        let digits = if self.unit == "MB" { 2 } else { 0 };
        format!("| {} | {:.digits$} {} | {budget} |", self.what, self.found, self.unit)
    }
}

/// Writes the page; with `main_job_only` prints the first table alone.
pub fn run(workspace: &Workspace, main_job_only: bool) -> Outcome {
    match text(workspace, main_job_only) {
        Err(why) => Outcome::Failed(why),
        Ok((text, over)) => {
            print!("{text}");
            let note = if over.is_empty() { "all within budget".into() } else { format!("over budget: {over}") };
            let written = if main_job_only { Ok(()) } else { std::fs::write(workspace.path(PAGE), text) };
            written.map_or_else(|error| Outcome::Failed(format!("{PAGE}: {error}")), |()| Outcome::Passed(note))
        }
    }
}

fn text(workspace: &Workspace, main_job_only: bool) -> Result<(String, String), String> {
    let build = crates::build(workspace)?;
    let mut rows = vec![
        Row { what: "main job, cold", found: build.total, unit: "CPU s", most: Some(380.0) },
        Row { what: "its program", found: build.bytes as f64 / 1e6, unit: "MB", most: Some(16.0) },
    ];
    if !main_job_only {
        rows.extend(sizes::all(workspace)?);
    }
    let is_over = |row: &&Row| row.most.is_some_and(|most| row.found > most);
    let over = rows.iter().filter(is_over).map(|row| row.what).collect::<Vec<_>>().join(", ");
    let table = rows.iter().map(Row::text).collect::<Vec<_>>().join("\n");
    let (machine, (name, there)) = (build.machine, crates::YARDSTICK);
    let speed = format!(
        "Measured on {machine}, where `{name}` takes {:.1} CPU s; seconds are those of a machine on which it takes {there}.",
        build.yardstick
    );
    let page = format!(
        "{HEAD}\n{speed}\n\n| what | now | at most |\n|---|---|---|\n{table}\n\n## The main job's packages\n\n\
         | package | CPU s |\n|---|---|\n{}\n",
        build.packages.join("\n")
    );
    Ok((page, over))
}
