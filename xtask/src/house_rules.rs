//! The project's own rules for `crates/*/src`, tests left out: no unwrap, nothing unfinished, unsafe in known places,
//! no circle of more than two files.

use crate::circles::circles;
use crate::module_order::above;
use crate::report::Outcome;
use crate::source_text::{code_only, without_tests};
use crate::workspace::{self, Workspace};
use std::collections::BTreeMap;

/// Files that may contain `unsafe`: instruction sets and their dispatch, machine code, CUDA's libraries, NumPy's
/// arrays, Python's methods, XLA's calls, C's pointers, and exports to JavaScript. Each entry is a path prefix.
const UNSAFE_ALLOWED: [&str; 12] = [
    "crates/mozzi/src/fast",
    "crates/mozzi/src/scalar/fused_lanes",
    "crates/mozzi/src/scalar/pass",
    "crates/mozzi-engine/src/jit/executable",
    "crates/mozzi-gpu/src/nvrtc",
    "crates/mozzi-gpu/src/driver/",
    "crates/mozzi-py/src/gpu",
    "crates/mozzi-py/src/numpy",
    "crates/mozzi-py/src/methods/attach",
    "crates/mozzi-py/src/jax/interface",
    "crates/mozzi-c/src/",
    "crates/mozzi-web/src/abi",
];

/// The most characters in a line.
const WIDE: usize = 120;
/// Files longer than this should be split.
const LONG: usize = 400;

pub fn check(workspace: &Workspace) -> Outcome {
    let mut files = Vec::new();
    for folder in ["crates", "xtask/src", "xtask/book/src", "xtask/mutants/src"] {
        workspace::files(&workspace.path(folder), &["rs"], &mut files);
    }
    files.sort();
    let (mut broken, mut long) = (0, 0);
    let mut crates: BTreeMap<String, BTreeMap<String, String>> = BTreeMap::new();
    for file in &files {
        let name = workspace.name_of(file);
        let Ok(source) = std::fs::read_to_string(file) else {
            return Outcome::Failed(format!("{name} cannot be read"));
        };
        if source.lines().count() > LONG {
            println!("warning: {name}: {} lines, more than {LONG}", source.lines().count());
            long += 1;
        }
        for line in long_comments(&source) {
            println!("{name}:{line}: a comment of more than {WIDE} characters in a line: wrap it");
            broken += 1;
        }
        if !is_library_code(&name) {
            continue;
        }
        let code = without_tests(&code_only(&source));
        for (line, rule) in broken_rules(&name, &code) {
            println!("{name}:{line}: {rule}");
            broken += 1;
        }
        let folder: String = name.split_inclusive('/').take(3).collect();
        crates.entry(folder.trim_end_matches('/').to_string()).or_default().insert(name, code);
    }
    for (source, files) in &crates {
        for circle in circles(source, files) {
            println!("{source}: a circle of {} files: {}", circle.len(), circle.join(", "));
            broken += 1;
        }
    }
    let note = format!("{} files, {long} longer than {LONG} lines", files.len());
    match broken {
        0 => Outcome::Passed(note),
        _ => Outcome::Failed(format!("{broken} places break a rule; {note}")),
    }
}

/// Comment lines that are too long, except tables; rustfmt formats code lines.
fn long_comments(source: &str) -> impl Iterator<Item = usize> {
    let is_table = |line: &str| line.trim_start().trim_start_matches(['/', '!']).trim_start().starts_with('|');
    let is_long =
        move |line: &str| line.trim_start().starts_with("//") && line.chars().count() > WIDE && !is_table(line);
    source.lines().enumerate().filter(move |(_, line)| is_long(line)).map(|(index, _)| index + 1)
}

/// `crates/*/src`, without files that are tests as a whole.
fn is_library_code(name: &str) -> bool {
    let parts: Vec<_> = name.split('/').collect();
    parts[0] == "crates"
        && parts.get(2) == Some(&"src")
        && !parts.iter().any(|part| ["tests", "tests.rs"].contains(part))
}

/// The line and the rule of each violation.
fn broken_rules(name: &str, code: &str) -> Vec<(usize, String)> {
    let unsafe_allowed = UNSAFE_ALLOWED.iter().any(|start| name.starts_with(start));
    let mut broken = Vec::new();
    for (index, line) in code.lines().enumerate() {
        let rules = [
            (line.contains(".unwrap()"), "unwrap: name the error, or use expect with the reason it cannot happen"),
            (has_word(line, "todo!"), "todo!: finish it"),
            (has_word(line, "unimplemented!"), "unimplemented!: finish it"),
            (!unsafe_allowed && has_word(line, "unsafe"), "unsafe: only in dispatch, JIT and bindings"),
        ];
        broken.extend(
            rules.into_iter().filter(|(is_broken, _)| *is_broken).map(|(_, rule)| (index + 1, rule.to_owned())),
        );
        broken.extend(
            above(name, line).map(|module| (index + 1, format!("uses `{module}`, which is above its own module"))),
        );
    }
    broken
}

/// True if the text contains `word`, and not only as a part of a longer name.
pub fn has_word(line: &str, word: &str) -> bool {
    let in_name = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
    line.match_indices(word).any(|(at, _)| {
        let after = line[at + word.len()..].chars().next();
        !in_name(line[..at].chars().next_back()) && (word.ends_with('!') || !in_name(after))
    })
}

#[cfg(test)]
mod tests {
    use super::{broken_rules, code_only, is_library_code, long_comments, without_tests};

    fn of(name: &str, source: &str) -> Vec<(usize, String)> {
        broken_rules(name, &without_tests(&code_only(source)))
    }

    #[test]
    fn long_comments_are_found_and_long_texts_are_not() {
        let long = "x".repeat(120);
        let source = format!("// {}\n    /// {long}\nlet a = \"{long}\";\n", "x".repeat(117));
        assert_eq!(long_comments(&source).collect::<Vec<_>>(), [2]);
    }

    #[test]
    fn each_rule_finds_its_line() {
        let source = "let a = b.unwrap();\ntodo!();\nunimplemented!(\"x\");\nunsafe { c() }\n";
        let lines: Vec<_> = of("crates/mozzi/src/a.rs", source).iter().map(|(line, _)| *line).collect();
        assert_eq!(lines, [1, 2, 3, 4]);
    }

    #[test]
    fn comments_tests_and_longer_names_break_nothing() {
        let source = "//! b.unwrap()\n#![deny(unsafe_op_in_unsafe_fn)]\na.unwrap_or(1);\n#[cfg(test)]\nmod tests { fn f() { b.unwrap(); } }";
        assert_eq!(of("crates/mozzi/src/a.rs", source), []);
    }

    #[test]
    fn unsafe_has_its_places() {
        let source = "unsafe { c() }";
        assert_eq!(of("crates/mozzi/src/fast.rs", source), []);
        assert_eq!(of("crates/mozzi/src/fast/x86.rs", source), []);
        assert_eq!(of("crates/mozzi-urdf/src/lib.rs", source).len(), 1);
    }

    #[test]
    fn only_the_crates_sources_are_judged() {
        assert!(is_library_code("crates/mozzi/src/lie/so3.rs"));
        assert!(!is_library_code("crates/mozzi/tests/oracle.rs"));
        assert!(!is_library_code("crates/mozzi/src/lie/tests.rs"));
        assert!(!is_library_code("xtask/src/main.rs"));
    }
}
