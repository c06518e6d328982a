//! The report of the steps: a heading when a step starts, a line in the list at the end.

use crate::cpu::Seconds;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// The result of a step, with a remark (may be empty).
#[derive(Debug, PartialEq)]
pub enum Outcome {
    Passed(String),
    Skipped(String),
    Failed(String),
}

/// The steps of one command, in the order in which they ran.
pub struct Report {
    start: Instant,
    lines: Vec<String>,
    failed: Vec<String>,
    /// The file to which each line is written as soon as it is known.
    log: Option<PathBuf>,
}

impl Default for Report {
    fn default() -> Self {
        Report { start: Instant::now(), lines: Vec::new(), failed: Vec::new(), log: None }
    }
}

impl Report {
    /// Also writes to a file that begins with `head`; a line is added when a step ends.
    pub fn with_log(file: PathBuf, head: &str) -> Self {
        let folder = file.parent().map_or(Ok(()), std::fs::create_dir_all);
        if let Err(error) = folder.and_then(|()| std::fs::write(&file, head)) {
            println!("{}: {error}", file.display());
        }
        Report { log: Some(file), ..Report::default() }
    }

    pub fn step(&mut self, name: &str, run: impl FnOnce() -> Outcome) {
        println!("\n=== {name} ===");
        let (start, before) = (Instant::now(), Seconds::of_children());
        let (word, note) = match run() {
            Outcome::Passed(note) => ("passed", note),
            Outcome::Skipped(why) => ("skipped", why),
            Outcome::Failed(why) => {
                self.failed.push(name.to_owned());
                ("FAILED", why)
            }
        };
        let cpu = Seconds::of_children().since(before);
        let mut line = format!("{word:8} {name} [{:.1} s{cpu}]", start.elapsed().as_secs_f64());
        if !note.is_empty() {
            line += &format!(": {note}");
        }
        println!("{line}");
        if let Some(file) = &self.log {
            let written = std::fs::OpenOptions::new().append(true).open(file);
            if let Err(error) = written.and_then(|mut file| writeln!(file, "- {line}")) {
                println!("{}: {error}", file.display());
            }
        }
        self.lines.push(line);
    }

    pub fn finish(self) -> ExitCode {
        println!("\n=== summary ===");
        for line in &self.lines {
            println!("{line}");
        }
        println!("together {:.0} s{}", self.start.elapsed().as_secs_f64(), Seconds::of_children());
        if self.failed.is_empty() {
            return ExitCode::SUCCESS;
        }
        println!("failed: {}", self.failed.join(", "));
        ExitCode::FAILURE
    }
}
