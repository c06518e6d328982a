//! How far a long computation is, on standard error: from the first second on, where that is a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::{Duration, Instant};

/// What takes less is not announced.
const QUIET: Duration = Duration::from_secs(1);

/// Rate and remaining time with it; gone when dropped.
pub struct Progress {
    bar: ProgressBar,
    begin: Instant,
}

impl Progress {
    /// "Runge-Kutta 4", of so many "steps".
    pub fn new(message: impl Into<String>, total: usize, unit: &str) -> Self {
        let bar = ProgressBar::with_draw_target(Some(total as u64), ProgressDrawTarget::hidden());
        let template = format!("{{msg:22}} {{bar:30}} {{pos}}/{{len}} {unit}, {{per_sec}}, {{eta}} left");
        if let Ok(style) = ProgressStyle::with_template(&template) {
            bar.set_style(style);
        }
        bar.set_message(message.into());
        Progress { bar, begin: Instant::now() }
    }

    /// So many are done.
    pub fn at(&self, done: usize) {
        if self.bar.is_hidden() && self.begin.elapsed() >= QUIET {
            self.bar.set_draw_target(ProgressDrawTarget::stderr()); // stays hidden where that is no terminal
        }
        self.bar.set_position(done as u64);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
