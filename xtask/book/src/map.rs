//! Which files of the repository are which pages of the book.

use crate::text;
use std::collections::BTreeMap;
use std::path::Path;

/// Files of the repository that are chapters as they are.
const IMPORTED: [(&str, &str); 36] = [
    ("docs/quantities.md", "reference/quantities.md"),
    ("docs/diagnostics.md", "reference/diagnostics.md"),
    ("CONVENTIONS.md", "reference/conventions.md"),
    ("docs/features.md", "reference/features.md"),
    ("docs/command-line.md", "manual/command-line.md"),
    ("docs/playground.md", "manual/playground.md"),
    ("docs/rust.md", "manual/rust.md"),
    ("crates/mozzi-py/README.md", "manual/python.md"),
    ("docs/cpp.md", "manual/cpp.md"),
    ("docs/derive.md", "manual/derive.md"),
    ("docs/identify.md", "manual/identify.md"),
    ("docs/sim-to-real.md", "manual/sim-to-real.md"),
    ("docs/gradients.md", "manual/gradients.md"),
    ("docs/jax.md", "manual/jax.md"),
    ("docs/pytorch.md", "manual/pytorch.md"),
    ("docs/gpu-guide.md", "manual/gpu.md"),
    ("docs/contacts.md", "manual/contacts.md"),
    ("docs/xacro.md", "manual/xacro.md"),
    ("docs/format-urdf.md", "manual/format-urdf.md"),
    ("docs/format-mjcf.md", "manual/format-mjcf.md"),
    ("docs/format-sdformat.md", "manual/format-sdformat.md"),
    ("docs/format-json.md", "manual/format-json.md"),
    ("docs/agreement.md", "about/agreement.md"),
    ("docs/accuracy.md", "about/accuracy.md"),
    ("docs/campaign.md", "about/campaign.md"),
    ("docs/published-robots.md", "about/published-robots.md"),
    ("docs/published-models.md", "about/published-models.md"),
    ("benches/RESULTS.md", "about/times.md"),
    ("benches/GPU.md", "about/times-gpu.md"),
    ("docs/gpu.md", "about/gpu.md"),
    ("docs/arm.md", "about/arm.md"),
    ("docs/performance-log.md", "about/performance-log.md"),
    ("DESIGN.md", "about/design.md"),
    ("docs/design-notes.md", "about/design-notes.md"),
    ("docs/dependencies.md", "about/dependencies.md"),
    ("benches/jax/RESULTS.md", "about/times-jax.md"),
];

/// The folder of the pages of single diagnostics, and the page of all of them.
const DIAGNOSTICS: (&str, &str) = ("docs/diagnostics", "reference/diagnostics.md");

/// Files whose place in the book is another page.
const ALIASES: [(&str, &str); 1] = [("README.md", "index.md")];

/// Pages of the book by their path in the repository.
pub struct Map {
    pages: BTreeMap<String, String>,
}

impl Map {
    /// With the chapters of `book/src`, named as seen from there, and the imported files.
    pub fn new(chapters: &[String], imported: &[(String, String)]) -> Self {
        let aliases = ALIASES.map(|(from, to)| (from.to_owned(), to.to_owned()));
        let own = chapters.iter().map(|page| (format!("book/src/{page}"), page.clone()));
        Map { pages: imported.iter().cloned().chain(aliases).chain(own).collect() }
    }

    /// The page that a file of the repository is.
    pub fn page(&self, file: &str) -> Option<&str> {
        self.pages.get(file).map(String::as_str)
    }

    /// The files of the repository that are chapters, with their pages.
    pub fn imported(root: &Path) -> Result<Vec<(String, String)>, String> {
        let mut all: Vec<(String, String)> = IMPORTED.map(|(from, to)| (from.to_owned(), to.to_owned())).into();
        for code in diagnostics(root)? {
            all.push((format!("{}/{code}.md", DIAGNOSTICS.0), format!("reference/diagnostics/{code}.md")));
        }
        Ok(all)
    }
}

/// The codes of diagnostics, by their pages.
fn diagnostics(root: &Path) -> Result<Vec<String>, String> {
    let files = text::files(&root.join(DIAGNOSTICS.0))?;
    let mut codes: Vec<String> =
        files.iter().filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned())).collect();
    codes.sort();
    Ok(codes)
}

/// The summary with the pages of single diagnostics below the page of all of them.
pub fn with_diagnostics(root: &Path, summary: &str) -> Result<String, String> {
    let line = summary.lines().find(|line| line.ends_with(&format!("]({})", DIAGNOSTICS.1)));
    let line = line.ok_or_else(|| format!("SUMMARY.md has no line for {}", DIAGNOSTICS.1))?;
    let pages = diagnostics(root)?.into_iter().map(|code| format!("\n  - [{code}](reference/diagnostics/{code}.md)"));
    Ok(summary.replace(line, &format!("{line}{}", pages.collect::<String>())))
}
