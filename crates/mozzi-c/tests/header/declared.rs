//! Every function that Rust exports is declared in mozzi.h, and the other way round.

use crate::{file, read};
use std::collections::BTreeSet;

/// The names `mozzi_…` that follow these words.
fn names_after<'t>(text: &'t str, before: &str) -> BTreeSet<&'t str> {
    let starts = text.match_indices(before).map(|(at, _)| &text[at + before.len()..]);
    let name = |rest: &'t str| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default();
    starts.map(name).filter(|name| name.starts_with("mozzi_")).collect()
}

#[test]
fn rust_and_c_have_the_same_functions() {
    let mut exported = BTreeSet::new();
    let mut sources = String::new();
    for entry in std::fs::read_dir(file("src")).expect("the sources") {
        let path = entry.expect("a file").path();
        if path.is_file() {
            sources += &std::fs::read_to_string(path).expect("a file of the repository");
        }
    }
    let list = read("src/typed/list.rs");
    exported.extend(names_after(&sources, "extern \"C\" fn "));
    exported.extend(names_after(&list, "export! {\n    "));
    exported.extend(names_in_macros(&sources));
    let header = read("include/mozzi/mozzi.h");
    let is_function = |name: &&str| header.contains(&format!("{name}("));
    let declared: BTreeSet<&str> = header
        .split(|c: char| !c.is_alphanumeric() && c != '_')
        .filter(|name| name.starts_with("mozzi_"))
        .filter(is_function)
        .filter(|name| !["mozzi_by_rows", "mozzi_by_columns", "mozzi_list_by_rows"].contains(name))
        .collect();
    assert_eq!(exported, declared);
    assert!(declared.len() > 100);
}

/// Names at the start of the lines of `sizes!` and `names!`.
fn names_in_macros(sources: &str) -> BTreeSet<&str> {
    let lines = sources.lines().filter_map(|line| line.strip_prefix("    mozzi_"));
    let names = lines.filter(|line| line.ends_with(';')).filter_map(|line| line.split_once(": "));
    let starts: BTreeSet<&str> = names.map(|(name, _)| name).collect();
    let all = sources.split(|c: char| !c.is_alphanumeric() && c != '_');
    all.filter(|word| word.strip_prefix("mozzi_").is_some_and(|rest| starts.contains(rest))).collect()
}
