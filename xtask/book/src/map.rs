//! Which files of the repository are which pages of the book.

use std::collections::BTreeMap;

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

/// Files whose place in the book is another page.
const ALIASES: [(&str, &str); 1] = [("README.md", "index.md")];

/// Pages of the book by their path in the repository.
pub struct Map {
    pages: BTreeMap<String, String>,
}

impl Map {
    /// With the chapters of `book/src`, named as seen from there, and generated pages.
    pub fn new(chapters: &[String]) -> Self {
        let imported = IMPORTED.iter().chain(&ALIASES).map(|&(from, to)| (from.to_owned(), to.to_owned()));
        let own = chapters.iter().map(|page| (format!("book/src/{page}"), page.clone()));
        Map { pages: imported.chain(own).collect() }
    }

    /// The page that a file of the repository is.
    pub fn page(&self, file: &str) -> Option<&str> {
        self.pages.get(file).map(String::as_str)
    }

    pub fn imported() -> impl Iterator<Item = (&'static str, &'static str)> {
        IMPORTED.into_iter()
    }
}
