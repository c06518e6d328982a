//! The state of a campaign in a file, so that it can be stopped and continued.

use crate::campaign::log::Counts;
use serde_json::{Value, json};
use std::path::Path;

/// How far a campaign has come.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Progress {
    /// The first seed.
    pub first: u64,
    /// Robots so far; the next seed is `first + robots`.
    pub robots: u64,
    /// Comparisons and what was skipped.
    pub counts: Counts,
    /// Findings, each with the smallest robot.
    pub findings: Vec<Value>,
    /// Seconds so far.
    pub seconds: f64,
}

impl Progress {
    /// A campaign from this seed.
    pub fn from_seed(first: u64) -> Self {
        Progress { first, ..Progress::default() }
    }

    /// From a file.
    ///
    /// # Errors
    /// A message if the file cannot be read or is not one of this program's.
    pub fn read(path: &Path) -> Result<Self, String> {
        let said = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let text = std::fs::read_to_string(path).map_err(|error| said(&error))?;
        let value: Value = serde_json::from_str(&text).map_err(|error| said(&error))?;
        let read = || {
            Some(Progress {
                first: value["first"].as_u64()?,
                robots: value["robots"].as_u64()?,
                counts: Counts::from_json(&value["counts"])?,
                findings: value["findings"].as_array()?.clone(),
                seconds: value["seconds"].as_f64()?,
            })
        };
        read().ok_or_else(|| said(&"is not a campaign's state, expected first, robots, counts, findings, seconds"))
    }

    /// To a file, which is replaced as a whole.
    ///
    /// # Errors
    /// A message if it cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), String> {
        let said = |error: std::io::Error| format!("{}: {error}", path.display());
        let value = json!({
            "first": self.first, "robots": self.robots, "counts": self.counts.to_json(),
            "findings": self.findings, "seconds": self.seconds,
        });
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(said)?;
        }
        let new = path.with_extension("new");
        std::fs::write(&new, format!("{value:#}\n")).map_err(said)?;
        std::fs::rename(&new, path).map_err(said)
    }
}

#[cfg(test)]
mod tests {
    use super::Progress;
    use crate::campaign::Way;

    #[test]
    fn a_campaign_continues_where_it_stopped() {
        let mut progress = Progress::from_seed(7);
        progress.counts.add("mass_matrix", Way::Second, 3.25, 9);
        progress.counts.add("mass_matrix", Way::Program, f64::INFINITY, 9);
        progress.counts.skip("singular");
        (progress.robots, progress.seconds) = (40, 1.5);
        let path = std::env::temp_dir().join(format!("mozzi-campaign-{}.json", std::process::id()));
        progress.write(&path).expect("written");
        assert_eq!(Progress::read(&path), Ok(progress));
        std::fs::write(&path, "{}").expect("written");
        assert!(Progress::read(&path).expect_err("empty").contains("is not a campaign's state"));
        std::fs::remove_file(&path).expect("there");
    }
}
