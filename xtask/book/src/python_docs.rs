//! Sentences about the compiled part of the Python package: the first paragraph of the documentation of each class,
//! method and function in `crates/mozzi-py/src`, by its name in Python.

use crate::text;
use std::collections::BTreeMap;
use std::path::Path;

/// By `Model`, `Model.simulate`, `Model.__init__` or `tracking_error`.
pub type Sentences = BTreeMap<String, String>;

pub fn sentences(folder: &Path) -> Result<Sentences, String> {
    let sources: Vec<String> = text::files(folder)?.iter().map(|file| text::read(file)).collect::<Result<_, _>>()?;
    let (mut found, mut classes) = (Sentences::new(), BTreeMap::new());
    for source in &sources {
        found.extend(exceptions(source));
        structs(source, &mut found, &mut classes);
    }
    for source in &sources {
        functions(source, &classes, &mut found);
    }
    Ok(found)
}

/// The first paragraph of comments `///`, and the attributes after it.
#[derive(Default)]
struct Before {
    doc: Vec<String>,
    has_ended: bool,
    attributes: String,
}

impl Before {
    /// Whether an attribute goes on in the next line.
    fn is_open(&self) -> bool {
        let count = |bracket| self.attributes.matches(bracket).count();
        count('[') > count(']')
    }

    /// Takes a line that precedes a declaration; false if it is none.
    fn takes(&mut self, line: &str) -> bool {
        if let Some(part) = line.strip_prefix("///") {
            self.has_ended |= part.trim().is_empty();
            if !self.has_ended {
                self.doc.push(part.trim().to_owned());
            }
        } else if line.starts_with("#[") || self.is_open() {
            self.attributes += line;
        } else {
            return false;
        }
        true
    }
}

/// The names in Python of the structs that are classes.
fn structs(source: &str, found: &mut Sentences, classes: &mut BTreeMap<String, String>) {
    let mut before = Before::default();
    for line in source.lines().map(str::trim) {
        if before.takes(line) {
            continue;
        }
        let Before { doc, attributes, .. } = std::mem::take(&mut before);
        let name = line.trim_start_matches("pub ").strip_prefix("struct ").map(word);
        if let (Some(name), Some((_, options))) = (name, attributes.split_once("#[pyclass")) {
            let given = options.split_once(" name = \"").and_then(|(_, rest)| rest.split('"').next());
            let class = given.unwrap_or(name);
            classes.insert(name.to_owned(), class.to_owned());
            if !doc.is_empty() {
                found.insert(class.to_owned(), doc.join(" "));
            }
        }
    }
}

fn functions(source: &str, classes: &BTreeMap<String, String>, found: &mut Sentences) {
    let (mut before, mut class) = (Before::default(), None);
    for line in source.lines() {
        if let Some(name) = line.strip_prefix("impl ") {
            class = classes.get(word(name));
        } else if line == "}" {
            class = None;
        }
        if before.takes(line.trim()) {
            continue;
        }
        let Before { doc, attributes, .. } = std::mem::take(&mut before);
        let name = line.trim().trim_start_matches("pub ").strip_prefix("fn ").map(word);
        if let Some(name) = name.filter(|_| !doc.is_empty()) {
            let name = if attributes.contains("#[new]") { "__init__" } else { name };
            let key = class.map_or_else(|| name.to_owned(), |class| format!("{class}.{name}"));
            found.entry(key).or_insert_with(|| doc.join(" "));
        }
    }
}

/// `create_exception!(mozzi, Name, Base, "text")`.
fn exceptions(source: &str) -> impl Iterator<Item = (String, String)> {
    source.split("create_exception!(").skip(1).filter_map(|rest| {
        let name = rest.split(',').nth(1)?.trim().to_owned();
        let message = rest.split('"').nth(1)?;
        Some((name, message.split(['\\', '\n']).map(str::trim).collect::<Vec<_>>().join(" ").replace("  ", " ")))
    })
}

/// The name with which a text begins.
fn word(text: &str) -> &str {
    text.split(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::{Sentences, exceptions, functions, structs};
    use std::collections::BTreeMap;

    #[test]
    fn classes_methods_and_exceptions_have_sentences() {
        let source = "/// A robot.\n///\n/// More.\n#[pyclass(frozen, name = \"Model\")]\npub struct PyModel {\n}\n\
            #[pymethods]\nimpl PyModel {\n    /// Made of lists.\n    #[new]\n    fn new() {}\n    /// Moves\n    /// on.\n    #[pyo3(signature = (\n        t,\n    ))]\n    fn simulate() {}\n}\n\
            /// Free.\nfn tracking_error() {}\ncreate_exception!(mozzi, LoadError, PyValueError, \"It is wrong.\");\n";
        let (mut found, mut classes) = (Sentences::from_iter(exceptions(source)), BTreeMap::new());
        structs(source, &mut found, &mut classes);
        functions(source, &classes, &mut found);
        let shown: Vec<_> = found.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
        assert_eq!(
            shown,
            [
                ("LoadError", "It is wrong."),
                ("Model", "A robot."),
                ("Model.__init__", "Made of lists."),
                ("Model.simulate", "Moves on."),
                ("tracking_error", "Free."),
            ]
        );
    }
}
