//! THIRD-PARTY.txt: the packages that mozzi's wheel, its C and C++ library and its command line contain, with the text
//! of their licences, read from the sources that cargo fetched.

use crate::command;
use crate::page;
use crate::report::Outcome;
use crate::sbom;
use crate::workspace::{FEATURES, Workspace};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;

/// The file, which wheels, archives and the Debian package contain.
pub const FILE: &str = "THIRD-PARTY.txt";

/// Packages that are published as binaries, with their names in the file.
const ARTEFACTS: [(&str, &str); 3] = [("mozzi-py", "wheel"), ("mozzi-c", "library"), ("mozzi-cli", "command line")];

/// How names of licence files begin.
const NAMES: [&str; 6] = ["LICENSE", "LICENCE", "COPYING", "COPYRIGHT", "NOTICE", "UNLICENSE"];

/// The licence texts of packages that have no licence file: of Apache-2.0 as it is, of MIT with their authors.
const APACHE: &str = "LICENSE-APACHE";
const MIT: &str = "LICENSE-MIT";
const HOLDERS: &str = "Copyright (c) The mozzi contributors";

/// The page of the reports, whose first comment has the licence of the JavaScript in it.
const PAGE: &str = "crates/mozzi-report/bundle/page.html.gz";

const HEAD: &str = "\
Software of others in mozzi's binaries: the Python wheel, the C and C++ library, and the command line. Written by
`cargo xtask licences`, for all platforms. The standard library of Rust is in each of them, too: MIT OR Apache-2.0,
copyright The Rust Project Developers.

Each line is a package, its licence, the binaries that contain it, and the numbers of its licence texts below.

";

/// A licence text, and the packages that contain it.
type Texts = BTreeMap<String, Vec<String>>;

/// A package with its version, its licence, and the artefacts that contain it.
type Line = (String, String, String);

/// Writes the file, and the bill of materials with the same packages.
pub fn write(workspace: &Workspace) -> Outcome {
    let written = texts(workspace).and_then(|files| {
        for (name, text) in &files {
            std::fs::write(workspace.path(name), text).map_err(|error| format!("{name}: {error}"))?;
        }
        Ok(files.map(|(name, text)| format!("{name}: {} kB", text.len() / 1000)).join(", "))
    });
    written.map_or_else(Outcome::Failed, Outcome::Passed)
}

/// Fails if a file does not agree with Cargo.lock.
pub fn check(workspace: &Workspace) -> Outcome {
    let current = texts(workspace).and_then(|files| {
        for (name, text) in &files {
            let file = std::fs::read_to_string(workspace.path(name)).map_err(|error| format!("{name}: {error}"))?;
            if file.replace("\r\n", "\n") != *text {
                return Err(format!("{name} does not agree with Cargo.lock: `cargo xtask licences` rewrites it"));
            }
        }
        Ok(files.map(|(name, _)| name).join(", "))
    });
    current.map_or_else(Outcome::Failed, Outcome::Passed)
}

/// Each file with its text.
fn texts(workspace: &Workspace) -> Result<[(&'static str, String); 2], String> {
    let (licences, lines) = text(workspace)?;
    Ok([(FILE, licences), (sbom::FILE, sbom::text(&workspace.version()?, &lines))])
}

/// The file's text, and the packages in it.
fn text(workspace: &Workspace) -> Result<(String, Vec<Line>), String> {
    let mut cargo = workspace.cargo(&["metadata", "--locked", "--format-version", "1"]);
    let (true, text) = command::output(cargo.args(FEATURES))? else {
        return Err("`cargo metadata` failed".into());
    };
    let metadata: Value = serde_json::from_str(&text).map_err(|error| format!("`cargo metadata`: {error}"))?;
    let read = |file| workspace.read(file);
    let (apache, mit, page) = (read(APACHE)?, read(MIT)?, page::unpack(&workspace.path(PAGE))?);
    let (mut lines, mut texts) = (Vec::new(), Texts::new());

    let (name, licence) = of_page(&page)?;
    texts.entry(licence).or_default().push(name.clone());
    lines.push((name, "MIT".to_owned(), "wheel, library, command line".to_owned()));
    for (id, artefacts) in linked(&metadata)? {
        let packages = metadata["packages"].as_array().into_iter().flatten();
        let package = packages.into_iter().find(|package| package["id"] == id.as_str());
        let package = package.ok_or_else(|| format!("`cargo metadata` does not list {id}"))?;
        if package["source"].is_null() {
            continue;
        }
        let text = |key: &str| package[key].as_str().unwrap_or_default().to_owned();
        let name = format!("{} {}", text("name"), text("version"));
        let folder = text("manifest_path");
        let mut found = of_folder(Path::new(&folder).parent().unwrap_or(Path::new("/")))?;
        if found.is_empty() {
            found.insert(plain(&match text("license") {
                licence if licence.contains("Apache-2.0") => apache.clone(),
                licence if licence.contains("MIT") => {
                    mit.replace(HOLDERS, &format!("Copyright (c) {}", authors(package)))
                }
                licence => return Err(format!("{name} ({licence}) has no licence file, expected one")),
            }));
        }
        for licence in found {
            texts.entry(licence).or_default().push(name.clone());
        }
        lines.push((name, text("license"), artefacts.into_iter().collect::<Vec<_>>().join(", ")));
    }
    Ok((put_together(&lines, texts), lines))
}

/// The list of packages, and the texts in the order of the first package that contains each.
fn put_together(lines: &[Line], texts: Texts) -> String {
    let place = |name: &str| lines.iter().position(|(known, ..)| known == name).unwrap_or(lines.len());
    let mut texts: Vec<_> = texts.into_iter().collect();
    texts.sort_by_cached_key(|(text, users)| (users.iter().map(|user| place(user)).min(), text.clone()));
    let mut file = HEAD.to_owned();
    for (name, licence, artefacts) in lines {
        let numbers = texts.iter().enumerate().filter(|(_, (_, users))| users.contains(name));
        let numbers = numbers.map(|(index, _)| (index + 1).to_string()).collect::<Vec<_>>().join(", ");
        // writing to a String cannot fail
        let _ = writeln!(file, "{name}; {licence}; {artefacts}; {numbers}");
    }
    for (index, (text, _)) in texts.iter().enumerate() {
        let _ = write!(file, "\n======== {} ========\n\n{text}", index + 1);
    }
    file
}

/// The ids of the packages that each artefact links, in alphabetical order.
fn linked(metadata: &Value) -> Result<BTreeMap<String, BTreeSet<&'static str>>, String> {
    let nodes = metadata["resolve"]["nodes"].as_array().ok_or("`cargo metadata` lists no dependencies")?;
    let nodes: BTreeMap<&str, &Value> =
        nodes.iter().filter_map(|node| Some((node["id"].as_str()?, &node["deps"]))).collect();
    let mut linked = BTreeMap::<String, BTreeSet<&'static str>>::new();
    for (package, artefact) in ARTEFACTS {
        let packages = metadata["packages"].as_array().into_iter().flatten();
        let root = packages.into_iter().find(|known| known["name"] == package).and_then(|known| known["id"].as_str());
        let mut waiting = vec![root.ok_or_else(|| format!("`cargo metadata` does not list {package}"))?];
        while let Some(id) = waiting.pop() {
            if !linked.entry(id.to_owned()).or_default().insert(artefact) {
                continue;
            }
            let dependencies = nodes.get(id).and_then(|dependencies| dependencies.as_array()).into_iter().flatten();
            let is_linked = |dependency: &&Value| {
                let kinds = dependency["dep_kinds"].as_array();
                kinds.is_some_and(|kinds| kinds.iter().any(|kind| kind["kind"].is_null()))
            };
            waiting.extend(dependencies.filter(is_linked).filter_map(|dependency| dependency["pkg"].as_str()));
        }
    }
    Ok(linked)
}

/// The authors that a package states, or its name.
fn authors(package: &Value) -> String {
    let authors = package["authors"].as_array().into_iter().flatten().filter_map(Value::as_str);
    let authors = authors.collect::<Vec<_>>().join(", ");
    if authors.is_empty() {
        return format!("the authors of {}", package["name"].as_str().unwrap_or_default());
    }
    authors
}

/// The licence texts of a package's folder.
fn of_folder(folder: &Path) -> Result<BTreeSet<String>, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    let mut texts = BTreeSet::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_ascii_uppercase();
        if path.is_file() && NAMES.iter().any(|begin| name.starts_with(begin)) {
            texts.insert(plain(&String::from_utf8_lossy(&std::fs::read(&path).map_err(failed)?)));
        }
    }
    Ok(texts)
}

/// A text that differs from its copies in no white space at the ends of lines.
fn plain(text: &str) -> String {
    let lines: Vec<_> = text.lines().map(str::trim_end).collect();
    lines.join("\n").trim_matches('\n').to_owned() + "\n"
}

/// The name of the JavaScript library in the page, and its licence: `It contains three.js VERSION, ADDRESS:` and the
/// text up to the comment's end.
fn of_page(page: &str) -> Result<(String, String), String> {
    let comment = page.split_once("It contains ").and_then(|(_, rest)| rest.split_once("-->"));
    let parts = comment.and_then(|(comment, _)| comment.split_once(":\n"));
    let (name, text) = parts.ok_or_else(|| format!("{PAGE} states no licence of the JavaScript in it"))?;
    Ok((name.split(',').next().unwrap_or(name).to_owned(), plain(text)))
}

#[cfg(test)]
mod tests {
    use super::{Texts, linked, of_page, plain, put_together};

    #[test]
    fn the_page_names_its_library() {
        let page = "<!--\nMade by x. It contains three.js 1.2, https://a.org:\n\nMIT\nmore \n-->\n<html>";
        assert_eq!(of_page(page), Ok(("three.js 1.2".into(), "MIT\nmore\n".into())));
        assert!(of_page("<html>").is_err());
    }

    #[test]
    fn equal_texts_are_written_once() {
        assert_eq!(plain("\r\na \r\nb\n\n"), "a\nb\n");
        let lines = ["a 1", "b 2"].map(|name| (name.to_owned(), "MIT".to_owned(), "wheel".to_owned()));
        let texts = Texts::from([("x\n".into(), vec!["b 2".into()]), ("y\n".into(), vec!["a 1".into(), "b 2".into()])]);
        let file = put_together(&lines, texts);
        assert!(file.contains("a 1; MIT; wheel; 1\nb 2; MIT; wheel; 1, 2\n"), "{file}");
        assert!(file.ends_with("\n======== 1 ========\n\ny\n\n======== 2 ========\n\nx\n"), "{file}");
    }

    #[test]
    fn only_linked_packages_are_listed() -> Result<(), String> {
        let node = |id: &str, deps: &str| format!(r#"{{"id": "{id}", "deps": [{deps}]}}"#);
        let on = |id: &str, kind: &str| format!(r#"{{"pkg": "{id}", "dep_kinds": [{{"kind": {kind}}}]}}"#);
        let names = ["mozzi-py", "mozzi-c", "mozzi-cli"];
        let packages = names.map(|name| format!(r#"{{"name": "{name}", "id": "{name}"}}"#)).join(",");
        let wheel = [on("a", "null"), on("b", "\"dev\""), on("c", "\"build\"")].join(",");
        let nodes = [node("mozzi-py", &wheel), node("a", &on("d", "null"))].join(",");
        let text = format!(r#"{{"packages": [{packages}], "resolve": {{"nodes": [{nodes}]}}}}"#);
        let metadata = serde_json::from_str(&text).map_err(|error| error.to_string())?;
        let linked = linked(&metadata)?;
        assert_eq!(linked.keys().collect::<Vec<_>>(), ["a", "d", "mozzi-c", "mozzi-cli", "mozzi-py"]);
        assert!(linked["d"].contains("wheel") && !linked["d"].contains("library"));
        Ok(())
    }
}
