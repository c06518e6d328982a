//! The page of the Python package: every public class, method and function with its signature and types, from the
//! stubs and modules of `crates/mozzi-py/python/mozzi`; formulas from the list of quantities, sentences from the
//! sources of the compiled methods.

use crate::python_docs::sentences;
use crate::text;
use std::collections::BTreeMap;
use std::path::Path;

const PACKAGE: &str = "crates/mozzi-py/python/mozzi";
/// Files of the package, with the module under which their names are imported.
const MODULES: [(&str, &str); 10] = [
    ("_mozzi.pyi", "mozzi"),
    ("_identify.py", "mozzi"),
    ("_compare.py", "mozzi"),
    ("_results.py", "mozzi"),
    ("_quantities.py", "mozzi"),
    ("models.py", "mozzi.models"),
    ("conventions.py", "mozzi.conventions"),
    ("modern_robotics.py", "mozzi.modern_robotics"),
    ("jax.py", "mozzi.jax"),
    ("torch.py", "mozzi.torch"),
];

const HEAD: &str = "\
# Python

Every public name of the package with its signature. `help(mozzi.Model.mass_matrix)` prints shapes, units and an example.
`Array` is a NumPy array; `ArrayLike` is what NumPy makes an array of; `...` is a default. [The guide](../manual/python.md)
shows them in use. Names of controllers and trajectories are imported from `mozzi.controllers` and `mozzi.trajectories`.
";

/// A class or a function.
#[derive(Debug, PartialEq)]
struct Entry {
    /// `Model`, `Model.mass_matrix` or `identify`.
    name: String,
    /// On one line, without `def` and the colon; of a class its bases, of a field its type.
    signature: String,
    /// The first paragraph of its documentation.
    doc: String,
}

pub fn page(root: &Path) -> Result<String, String> {
    let formulas = formulas(&text::read(&root.join("docs/quantities.md"))?);
    let sentences = sentences(&root.join("crates/mozzi-py/src"))?;
    let mut page = HEAD.to_owned();
    let mut section = "";
    for (file, module) in MODULES {
        if section != module {
            page += &format!("\n## `{module}`\n");
            section = module;
        }
        for entry in entries(&text::read(&root.join(PACKAGE).join(file))?) {
            let quantity = entry.name.strip_prefix("Model.").and_then(|name| formulas.get(name));
            let known = sentences.get(&entry.name).or(quantity);
            let doc = if entry.doc.is_empty() { known.cloned().unwrap_or_default() } else { entry.doc.clone() };
            let doc = text::escaped(&doc).replace("&quot;", "\"");
            if !entry.signature.is_empty() && !entry.signature.contains('(') {
                // a property or a field
                let doc = if doc.is_empty() { doc } else { format!(": {doc}") };
                page += &format!("\n- `{}`{doc}\n", entry.signature.replacen(": : ", ": ", 1));
                continue;
            }
            let level = if entry.name.contains('.') { "####" } else { "###" };
            page += &format!("\n{level} `{}`\n", entry.name);
            if !entry.signature.is_empty() {
                page += &format!("\n```python\n{}\n```\n", wrapped(&entry.signature));
            }
            if !doc.is_empty() {
                page += &format!("\n{doc}\n");
            }
        }
    }
    Ok(page)
}

/// The public entries of a module, in its order; of overloaded functions the last.
fn entries(source: &str) -> Vec<Entry> {
    let lines: Vec<&str> = source.lines().collect();
    let (mut found, mut class): (Vec<Entry>, Option<String>) = (Vec::new(), None);
    let (mut at, mut is_property) = (0, false);
    while at < lines.len() {
        let line = lines[at];
        let indent = line.len() - line.trim_start().len();
        let bare = line.trim_start();
        let is_method = indent == 4 && class.is_some();
        if bare.starts_with("class ") && indent == 0 {
            let head = bare.trim_start_matches("class ");
            let name: String = head.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            class = (!name.starts_with('_')).then(|| name.clone());
            if class.is_some() {
                let bases = head[name.len()..].split(')').next().unwrap_or_default().trim_start_matches('(');
                let bases = bases.trim_end_matches([':', '.', ' ']);
                let signature = if bases.is_empty() { String::new() } else { format!("class {name}({bases})") };
                found.push(Entry { name, signature, doc: docstring(&lines, at + 1) });
            }
        } else if bare.starts_with("def ") && (indent == 0 || is_method) {
            let (signature, end) = signature(&lines, at);
            let name: String = signature.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            let owner = class.clone().filter(|_| indent == 4);
            let is_public = !name.starts_with('_') || (owner.is_some() && ["__init__", "__call__"].contains(&&*name));
            if indent == 0 {
                class = None;
            }
            if is_public {
                let full = owner.as_ref().map_or_else(|| name.clone(), |owner| format!("{owner}.{name}"));
                let signature = match is_property {
                    true => signature.replacen("(self) -> ", ": ", 1),
                    false => as_call(&signature, owner.as_ref()),
                };
                found.retain(|entry| entry.name != full);
                found.push(Entry { name: full, signature, doc: docstring(&lines, end + 1) });
            }
            at = end;
        } else if let (true, Some(owner)) = (is_method, &class)
            && let Some((name, kind)) = bare.split_once(": ")
            && name.chars().all(|c| c.is_alphanumeric() || c == '_')
            && !name.starts_with('_')
        {
            let doc = docstring(&lines, at + 1);
            found.push(Entry { name: format!("{owner}.{name}"), signature: format!("{name}: {kind}"), doc });
        } else if indent == 0 && !bare.is_empty() && !bare.starts_with(['#', '@', ')']) {
            class = None;
        }
        is_property = bare.starts_with("@property");
        at += 1;
    }
    found
}

/// `def f(…) -> T:` from its line on, joined; and the line on which it ends.
fn signature(lines: &[&str], start: usize) -> (String, usize) {
    let (mut depth, mut joined) = (0i32, String::new());
    for (at, line) in lines.iter().enumerate().skip(start) {
        let bare = line.trim();
        depth += bare.chars().map(|c| i32::from("([{".contains(c)) - i32::from(")]}".contains(c))).sum::<i32>();
        if bare.starts_with(')') {
            joined.truncate(joined.trim_end_matches(',').len());
        } else if !joined.is_empty() && !joined.ends_with('(') {
            joined.push(' ');
        }
        joined += bare;
        if depth == 0 {
            let ends = [": ...", ":"].iter().find_map(|end| joined.strip_suffix(end)).unwrap_or(&joined);
            return (ends.trim_start_matches("def ").to_owned(), at);
        }
    }
    (joined, start)
}

/// A signature as a call: without `self`, and under the class's name if it is the constructor.
fn as_call(signature: &str, owner: Option<&String>) -> String {
    let bare = signature.replacen("(self, ", "(", 1).replacen("(self)", "()", 1);
    match (bare.strip_prefix("__init__"), owner) {
        (Some(rest), Some(owner)) => format!("{owner}{}", rest.trim_end_matches(" -> None")),
        _ => bare,
    }
}

/// The first paragraph of the docstring that begins on this line, if one does.
fn docstring(lines: &[&str], start: usize) -> String {
    let Some(first) = lines.get(start).map(|line| line.trim()).filter(|line| line.starts_with("\"\"\"")) else {
        return String::new();
    };
    let rest =
        std::iter::once(first.trim_start_matches("\"\"\"")).chain(lines[start + 1..].iter().map(|line| line.trim()));
    let mut doc = Vec::new();
    for line in rest {
        let end = line.find("\"\"\"");
        doc.push(&line[..end.unwrap_or(line.len())]);
        if end.is_some() || line.is_empty() {
            break;
        }
    }
    doc.join(" ").trim().replace("``", "`")
}

/// A long signature over several lines, as one argument a line.
fn wrapped(signature: &str) -> String {
    let Some(open) = signature.find('(').filter(|_| signature.chars().count() > 90) else {
        return signature.to_owned();
    };
    let (mut depth, mut out) = (0, signature[..open].to_owned());
    for c in signature[open..].chars() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            _ => {}
        }
        match (c, depth) {
            ('(', 1) if out.len() == open => out += "(\n    ",
            (')', 0) => out += ",\n)",
            (',', 1) => out += ",\n    ",
            (' ', 1) if out.ends_with("    ") => {}
            _ => out.push(c),
        }
    }
    out
}

/// The formula of each quantity, from the table of docs/quantities.md.
fn formulas(page: &str) -> BTreeMap<String, String> {
    let rows = page.lines().filter_map(|line| line.strip_prefix("| `"));
    let row = |line: &str| {
        let (name, rest) = line.split_once("` | ")?;
        let formula = rest.split(" | ").next()?;
        Some((name.to_owned(), format!("{formula}.")))
    };
    rows.filter_map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::{entries, wrapped};

    #[test]
    fn classes_methods_and_functions() {
        let source = "class A(B):\n    \"\"\"A thing.\n\n    More.\n    \"\"\"\n    @property\n    def x(self) -> int: ...\n    def _hidden(self): ...\n    y: float\n    \"\"\"In m.\"\"\"\n\ndef f(\n    a: int,\n    b: str = \"c\",\n) -> None:\n    \"\"\"Does.\"\"\"\n    pass\n";
        let found = entries(source);
        let shown: Vec<_> = found.iter().map(|e| (e.name.as_str(), e.signature.as_str(), e.doc.as_str())).collect();
        assert_eq!(
            shown,
            [
                ("A", "class A(B)", "A thing."),
                ("A.x", "x: int", ""),
                ("A.y", "y: float", "In m."),
                ("f", "f(a: int, b: str = \"c\") -> None", "Does."),
            ]
        );
    }

    #[test]
    fn long_signatures_are_wrapped() {
        let long = format!("f(a: dict[str, int], b: int = {}) -> None", "9".repeat(80));
        assert!(wrapped(&long).starts_with("f(\n    a: dict[str, int],\n    b: int = 9"));
        assert!(wrapped(&long).ends_with(",\n) -> None"));
    }
}
