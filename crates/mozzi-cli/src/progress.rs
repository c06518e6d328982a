//! Progress of a long computation on standard error, after the first second and if it is a terminal.

use indicatif::{HumanCount, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::cell::Cell;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Shorter computations show no progress.
const QUIET: Duration = Duration::from_secs(1);

/// A bar with rate and remaining time; removed when dropped.
pub struct Progress {
    bar: ProgressBar,
    begin: Instant,
    is_quiet: Cell<bool>,
}

impl Progress {
    /// `message` is the task, such as "Runge-Kutta 4"; `total` counts the units, such as "steps".
    pub fn new(message: impl Into<String>, total: usize, unit: &str) -> Self {
        let bar = ProgressBar::with_draw_target(Some(total as u64), ProgressDrawTarget::hidden());
        let template = format!("{{msg:22}} {{bar:30}} {{human_pos}}/{{human_len}} {unit}, {{rate}}/s, {{eta}} left");
        if let Ok(style) = ProgressStyle::with_template(&template) {
            // a useful number of digits
            bar.set_style(style.with_key("rate", |state: &ProgressState, to: &mut dyn std::fmt::Write| {
                let rate = state.per_sec();
                let _ = if rate < 10.0 { write!(to, "{rate:.1}") } else { write!(to, "{}", HumanCount(rate as u64)) };
            }));
        }
        bar.set_message(message.into());
        Progress { bar, begin: Instant::now(), is_quiet: Cell::new(true) }
    }

    /// Sets the number of units done.
    pub fn at(&self, done: usize) {
        if self.is_quiet.get() && self.begin.elapsed() >= QUIET {
            self.is_quiet.set(false);
            self.bar.set_draw_target(ProgressDrawTarget::stderr()); // stays hidden without a terminal
        }
        self.bar.set_position(done as u64);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// A spinner with the time so far, for work whose end is not known; removed when dropped.
pub struct Waiting(ProgressBar);

impl Waiting {
    pub fn on(message: &'static str) -> Self {
        let bar = ProgressBar::new_spinner();
        if !std::io::stderr().is_terminal() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}, {elapsed}") {
            bar.set_style(style);
        }
        bar.set_message(message);
        bar.enable_steady_tick(2 * QUIET);
        Waiting(bar)
    }
}

impl Drop for Waiting {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
