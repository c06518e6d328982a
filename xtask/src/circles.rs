//! Circles of files within a crate: a uses b, and b, by way of others, uses a. None has more than two files.

use std::collections::{BTreeMap, BTreeSet};

/// The list of all quantities names kernels: see `module_order`.
const EXEMPT: &str = "crates/mozzi/src/quantities/mod.rs";

type Path = Vec<String>;

/// The circles of more than two files; `files` has the code of a crate's files by their names from the root of the
/// workspace.
pub fn circles(source: &str, files: &BTreeMap<String, String>) -> Vec<Vec<String>> {
    let modules: BTreeMap<Path, &String> =
        files.keys().filter(|name| **name != EXEMPT).filter_map(|name| Some((module(source, name)?, name))).collect();
    let used = |name: &String| -> BTreeSet<&String> {
        let own = module(source, name).unwrap_or_default();
        let found = paths(&files[name]).into_iter().filter_map(|path| target(&modules, files, &absolute(&own, path)));
        found.filter(|other| *other != name).collect()
    };
    let uses: BTreeMap<&String, BTreeSet<&String>> = modules.values().map(|name| (*name, used(name))).collect();
    let reached: BTreeMap<&String, BTreeSet<&String>> = uses.keys().map(|name| (*name, reached(name, &uses))).collect();
    let circle = |name: &&String| -> BTreeSet<&String> {
        reached[*name].iter().copied().filter(|other| reached[*other].contains(*name)).collect()
    };
    let circles: BTreeSet<BTreeSet<&String>> = reached.keys().map(circle).filter(|circle| circle.len() > 2).collect();
    circles.into_iter().map(|circle| circle.into_iter().cloned().collect()).collect()
}

/// The files that a file uses, directly or through others.
fn reached<'n>(from: &'n String, uses: &BTreeMap<&'n String, BTreeSet<&'n String>>) -> BTreeSet<&'n String> {
    let (mut reached, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(name) = open.pop() {
        open.extend(uses[name].iter().filter(|next| reached.insert(**next)));
    }
    reached
}

/// `crates/x/src/a/b.rs` is the module a::b, `a/mod.rs` is a.
fn module(source: &str, name: &str) -> Option<Path> {
    let name = name.strip_prefix(source)?.strip_prefix('/')?.strip_suffix(".rs")?;
    let mut path: Path = name.split('/').map(String::from).collect();
    if matches!(path.last().map(String::as_str), Some("mod" | "lib" | "main")) {
        path.pop();
    }
    Some(path)
}

/// A path that begins with `crate` or `super`, from the root of the crate.
fn absolute(own: &Path, path: Path) -> Path {
    let ups = path.iter().take_while(|part| *part == "super").count();
    let base =
        if path.first().is_some_and(|part| part == "crate") { &[] } else { &own[..own.len().saturating_sub(ups)] };
    base.iter().cloned().chain(path.into_iter().skip_while(|part| part == "crate" || part == "super")).collect()
}

/// The file that a path names; what a folder's `mod.rs` takes from a file of its own and passes on is that file's.
fn target<'m>(
    modules: &BTreeMap<Path, &'m String>,
    files: &BTreeMap<String, String>,
    path: &Path,
) -> Option<&'m String> {
    let length = (0..=path.len()).rev().find(|&length| modules.contains_key(&path[..length]))?;
    let (folder, file) = (&path[..length], modules[&path[..length]]);
    let Some(name) = path.get(length) else { return Some(file) };
    let passed_on = uses(&files[file]).into_iter().find(|known| known.len() > 1 && known.last() == Some(name));
    match passed_on {
        Some(known) if modules.contains_key(&[folder, &known[..1]].concat()) => {
            target(modules, files, &[folder, &known[..]].concat())
        }
        _ => Some(file),
    }
}

/// All paths of a code that begin with `crate` or `super`.
fn paths(code: &str) -> Vec<Path> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let starts = ["crate::", "super::"].into_iter().flat_map(|start| code.match_indices(start));
    let starts = starts.filter(|(at, _)| !code[..*at].ends_with(is_word));
    starts.flat_map(|(at, _)| tree(&code[at..])).collect()
}

/// The paths of `pub use` that begin with a file of the folder.
fn uses(code: &str) -> Vec<Path> {
    let is_public = |at: usize| {
        let before = code[..at].trim_end();
        before.ends_with("pub") || before.ends_with(')')
    };
    code.match_indices("use ")
        .filter(|(at, _)| is_public(*at))
        .flat_map(|(at, word)| tree(&code[at + word.len()..]))
        .collect()
}

/// `a::{b, c::d}` is a::b and a::c::d.
fn tree(code: &str) -> Vec<Path> {
    let (mut found, mut rest) = (Vec::new(), code);
    branch(&mut rest, &[], &mut found);
    found
}

fn branch(rest: &mut &str, begin: &[String], found: &mut Vec<Path>) {
    let mut path = begin.to_vec();
    loop {
        *rest = rest.trim_start();
        if let Some(inner) = rest.strip_prefix('{') {
            *rest = inner;
            loop {
                let before = rest.len();
                branch(rest, &path, found);
                *rest = rest.trim_start().trim_start_matches(',').trim_start();
                if let Some(after) = rest.strip_prefix('}') {
                    *rest = after;
                    return;
                }
                if rest.len() == before {
                    return; // no list of paths
                }
            }
        }
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        if end > 0 {
            path.push(rest[..end].to_string());
        }
        *rest = &rest[end..];
        match rest.strip_prefix("::") {
            Some(after) if end > 0 => *rest = after,
            _ => break,
        }
    }
    if let Some(renamed) = rest.strip_prefix(" as ") {
        let end = renamed.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(renamed.len());
        *rest = &renamed[end..];
    }
    if path.len() > begin.len() {
        found.push(path);
    }
}

#[cfg(test)]
mod tests {
    use super::circles;
    use std::collections::BTreeMap;

    fn of(files: &[(&str, &str)]) -> Vec<Vec<String>> {
        let files: BTreeMap<String, String> =
            files.iter().map(|(name, code)| (format!("crates/x/src/{name}.rs"), code.to_string())).collect();
        circles("crates/x/src", &files)
    }

    #[test]
    fn three_files_in_a_circle_are_found() {
        let [a, b] = [("a", "use crate::{b::B, d};"), ("b", "fn f() { crate::folder::c() }")];
        let folder = ("folder/mod", "mod c;\npub(crate) use c::{C as D, c};");
        let found = of(&[a, b, folder, ("folder/c", "use super::super::a;"), ("d", "")]);
        assert_eq!(found, [["crates/x/src/a.rs", "crates/x/src/b.rs", "crates/x/src/folder/c.rs"]]);
        assert!(of(&[a, b, folder, ("folder/c", "use crate::b;"), ("d", "")]).is_empty(), "two");
        assert!(of(&[a, b, ("d", "")]).is_empty());
    }
}
