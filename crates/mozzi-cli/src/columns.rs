//! CSV output with all digits, so that round trips are exact.

use crate::failure::Result;
use crate::output::Output;
use crate::progress::Progress;
use mozzi::Model;
use std::fmt::Write as _;
use std::io::Write;

/// The columns of a group: by number, `tau_1` … `tau_n`; with a floating base by name, since the joints' numbers in θ
/// then differ from those in θ̇.
pub fn names(model: &Model, group: &str) -> Vec<String> {
    let name = |(j, name): (usize, &&str)| {
        if !model.configuration_space().is_flat() { format!("{group}_{name}") } else { format!("{group}_{}", j + 1) }
    };
    entries(model, group).iter().enumerate().map(name).collect()
}

/// The names of a group's entries.
pub fn entries<'m>(model: &'m Model, group: &str) -> Vec<&'m str> {
    match group {
        "theta" => model.position_names().collect(),
        "w" => vec!["1", "2", "3", "4", "5", "6"],
        _ => model.velocity_names().collect(),
    }
}

/// A table by columns.
#[derive(Default)]
pub struct Columns {
    names: Vec<String>,
    values: Vec<Vec<f64>>,
}

impl Columns {
    pub fn add(&mut self, name: impl Into<String>, values: Vec<f64>) {
        self.names.push(name.into());
        self.values.push(values);
    }

    /// Adds the columns of `theta`, `dtheta`, `ddtheta` or `tau`, from rows.
    pub fn add_group(&mut self, model: &Model, group: &str, rows: &[Vec<f64>]) {
        for (j, name) in names(model, group).into_iter().enumerate() {
            self.add(name, rows.iter().map(|row| row[j]).collect());
        }
    }

    pub fn rows(&self) -> usize {
        self.values.first().map_or(0, Vec::len)
    }

    pub fn text(&self) -> String {
        let mut text = self.names.join(",") + "\n";
        let progress = Progress::new("CSV", self.rows(), "rows");
        for row in 0..self.rows() {
            for (c, column) in self.values.iter().enumerate() {
                // writing to a String cannot fail; {:?} is the shortest text that reads back as the same number
                let _ = write!(text, "{}{:?}", if c == 0 { "" } else { "," }, column[row]);
            }
            text.push('\n');
            progress.at(row + 1);
        }
        text
    }
}

/// Writes a text, or bytes, to a file.
pub fn save(file: &str, content: impl AsRef<[u8]>) -> Result<()> {
    Output::create(file)?.write(|to| to.write_all(content.as_ref()))
}
