//! Names in documents must exist: paths of Rust items, files of the repository, commands of xtask, packages and test
//! programs of `cargo`, and the targets of links in the pages that the book does not contain.

use crate::documents::HISTORY;
use crate::house_rules::has_word;
use crate::report::Outcome;
use crate::workspace::{self, Workspace};
use std::collections::BTreeMap;
use std::path::Path;

/// Files and folders with documents. Records of decisions may name what is gone.
const DOCUMENTS: [&str; 12] = [
    "README.md",
    "llms.txt",
    "ARCHITECTURE.md",
    "CONVENTIONS.md",
    "CONTRIBUTING.md",
    "DESIGN.md",
    "SECURITY.md",
    "crates/mozzi-py/README.md",
    "examples/README.md",
    "ros2/mozzi_ros2/README.md",
    "docs",
    "book/src",
];
/// Folders of the repository by which a path is known.
const FOLDERS: [&str; 9] =
    ["crates/", "docs/", "examples/", "benches/", "xtask/", "book/", "oracles/", "page/", "ros2/"];
/// The second segments of diagnostics' codes, and of an operator of PyTorch.
const FORMATS: [&str; 7] = ["urdf", "mjcf", "sdf", "json", "xacro", "constraints", "rollout"];
/// Documents whose links the book's builder does not check.
const LINKS: [&str; 9] = [
    "README.md",
    "llms.txt",
    "ARCHITECTURE.md",
    "CONTRIBUTING.md",
    "SECURITY.md",
    "CHANGELOG.md",
    "crates/mozzi-py/README.md",
    "examples/README.md",
    "ros2/mozzi_ros2/README.md",
];

pub fn check(workspace: &Workspace) -> Outcome {
    match try_check(workspace) {
        Ok(outcome) => outcome,
        Err(why) => Outcome::Failed(why),
    }
}

fn try_check(workspace: &Workspace) -> Result<Outcome, String> {
    let usage = workspace.read("xtask/src/main.rs")?;
    let mut crates = BTreeMap::new();
    let (mut files, mut names, mut wrong) = (Vec::new(), 0, 0);
    for document in DOCUMENTS {
        workspace::files(&workspace.path(document), &["md", "txt"], &mut files);
    }
    files.sort();
    for file in files {
        let name = workspace.name_of(&file);
        if HISTORY.contains(&name.as_str()) {
            continue;
        }
        for (line, code) in codes(&workspace.read(&name)?) {
            names += 1;
            if let Some(problem) = problem(workspace, &usage, &mut crates, &code) {
                println!("{name}:{line}: `{code}`: {problem}");
                wrong += 1;
            }
        }
    }
    let mut links = 0;
    for name in LINKS {
        for (line, link) in targets(&workspace.read(name)?) {
            links += 1;
            let folder = workspace.path(name).parent().map(Path::to_path_buf).unwrap_or_default();
            if !folder.join(&link).exists() {
                println!("{name}:{line}: the link {link} leads nowhere");
                wrong += 1;
            }
        }
    }
    let note = format!("{names} pieces of code, {links} links");
    Ok(if wrong == 0 { Outcome::Passed(note) } else { Outcome::Failed(format!("{wrong} lead nowhere; {note}")) })
}

/// The pieces of code in a document's prose, each with its line.
fn codes(text: &str) -> Vec<(usize, String)> {
    let (mut found, mut is_block) = (Vec::new(), false);
    for (at, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            is_block = !is_block;
        } else if !is_block {
            found.extend(line.split('`').skip(1).step_by(2).map(|code| (at + 1, code.to_owned())));
        }
    }
    found
}

/// The relative links of a document, without their fragments.
fn targets(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for (at, line) in text.lines().enumerate() {
        for rest in line.split("](").skip(1) {
            let link = rest.split([')', '#']).next().unwrap_or_default();
            if !link.is_empty() && !link.contains("://") && !link.starts_with("mailto:") {
                found.push((at + 1, link.to_owned()));
            }
        }
    }
    found
}

/// Why a piece of code names what does not exist.
fn problem(workspace: &Workspace, usage: &str, crates: &mut BTreeMap<String, String>, code: &str) -> Option<String> {
    if let Some(rest) = code.strip_prefix("cargo xtask ") {
        let command = rest.split([' ', ',']).next().unwrap_or_default();
        let is_known = usage.contains(&format!("[\"{command}\""));
        return (!is_known && command != "…").then(|| format!("xtask has no command `{command}`"));
    }
    if code.starts_with("cargo ") {
        let mut words = code.split(' ');
        while let Some(word) = words.next() {
            if let ("-p" | "--package", Some(package)) = (word, words.clone().next()) {
                let is_there = workspace.path(&format!("crates/{package}")).is_dir()
                    || ["mozzi-examples", "mozzi-benches", "xtask"].contains(&package);
                return (!is_there).then(|| format!("there is no package `{package}`"));
            }
        }
        return None;
    }
    if code.contains("::") && code.starts_with("mozzi") && code.chars().all(|c| c.is_alphanumeric() || "_:".contains(c))
    {
        return item(workspace, crates, code);
    }
    let is_path = FOLDERS.iter().any(|folder| code.starts_with(folder))
        && code.chars().all(|c| c.is_alphanumeric() || "_-./".contains(c));
    let is_there = || {
        workspace.path(code.trim_end_matches('/')).exists()
            || ["…", "NN", "your_"].iter().any(|any| code.contains(any))
            || has_stem(workspace, code)
    };
    (is_path && !is_there()).then(|| "there is no such file".into())
}

/// True for `examples/01_two_link`, which stands for the program of any language.
fn has_stem(workspace: &Workspace, code: &str) -> bool {
    ["rs", "py"].iter().any(|ending| workspace.path(&format!("{code}.{ending}")).is_file())
}

/// Whether each segment of a path is a word of the crate's sources.
fn item(workspace: &Workspace, crates: &mut BTreeMap<String, String>, path: &str) -> Option<String> {
    let mut segments = path.split("::").filter(|segment| !segment.is_empty());
    let name = segments.next()?.replace('_', "-");
    if name == "mozzi" && segments.clone().next().is_some_and(|second| FORMATS.contains(&second)) {
        return None; // a diagnostic's code, which the tests of mozzi-urdf compare with the page of diagnostics
    }
    let folder = workspace.path(&format!("crates/{name}/src"));
    if !folder.is_dir() {
        return (name != "mozzi-oracle").then(|| format!("there is no crate `{name}`"));
    }
    let text = crates.entry(name.clone()).or_insert_with(|| {
        let mut files = Vec::new();
        workspace::files(&folder, &["rs"], &mut files);
        if name == "mozzi" {
            workspace::files(&workspace.path("crates/mozzi-c/include"), &["h", "hpp"], &mut files); // C++ has the same namespace
        }
        files.iter().filter_map(|file| std::fs::read_to_string(file).ok()).collect()
    });
    segments.find(|segment| !has_word(text, segment)).map(|segment| format!("{name} has no `{segment}`"))
}

#[cfg(test)]
mod tests {
    use super::{codes, problem, targets};
    use crate::workspace::Workspace;
    use std::collections::BTreeMap;

    #[test]
    fn code_is_found_in_prose_alone() {
        assert_eq!(codes("a `b` c `d`\n```\n`e`\n```\n"), [(1, "b".to_owned()), (1, "d".to_owned())]);
        assert_eq!(targets("[a](b.md#c) [d](https://e) [f](#g)"), [(1, "b.md".to_owned())]);
    }

    #[test]
    fn what_does_not_exist_is_found() {
        let workspace = Workspace::find();
        let of = |code: &str| problem(&workspace, "[\"docs\"]", &mut BTreeMap::new(), code);
        assert!(of("mozzi_motion::controllers::Standing").is_none() && of("mozzi_motion::integrators").is_some());
        assert!(of("crates/mozzi/src/lib.rs").is_none() && of("crates/mozzi/src/none.rs").is_some());
        assert!(of("cargo xtask docs").is_none() && of("cargo xtask nothing").is_some());
        assert!(of("cargo test -p mozzi").is_none() && of("cargo test -p mozzi-batch").is_some());
    }
}
