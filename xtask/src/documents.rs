//! Limits on the length of README and DESIGN, in words as `wc -w` counts them; the places that ARCHITECTURE.md names.

use crate::report::Outcome;
use crate::workspace::Workspace;

/// A document and its largest number of words.
const LIMITS: [(&str, usize); 2] = [("README.md", 900), ("DESIGN.md", 2000)];

/// Records of decisions: their numbers are of the day, and they may name what is gone.
pub const HISTORY: [&str; 3] = ["docs/dependencies.md", "docs/design-notes.md", "docs/performance-log.md"];

/// The page with the map of the house.
const MAP: &str = "ARCHITECTURE.md";

/// Fails if a document is too long: longer text belongs on a page of docs/.
pub fn check(workspace: &Workspace) -> Outcome {
    let mut counts = Vec::new();
    let mut too_long = Vec::new();
    for (name, limit) in LIMITS {
        match std::fs::read_to_string(workspace.path(name)) {
            Ok(text) if words(&text) > limit => {
                too_long.push(format!("{name} has {} words, at most {limit} are allowed", words(&text)));
            }
            Ok(text) => counts.push(format!("{name} {} of {limit} words", words(&text))),
            Err(error) => return Outcome::Failed(format!("{name} cannot be read: {error}")),
        }
    }
    if too_long.is_empty() {
        Outcome::Passed(counts.join(", "))
    } else {
        Outcome::Failed(format!("{}: move parts to docs/", too_long.join("; ")))
    }
}

/// Fails if a function that ARCHITECTURE.md names is not in its file: `` `FILE.rs`, `function` ``.
pub fn check_places(workspace: &Workspace) -> Outcome {
    let map = match std::fs::read_to_string(workspace.path(MAP)) {
        Ok(text) => text,
        Err(error) => return Outcome::Failed(format!("{MAP}: {error}")),
    };
    let places = places(&map);
    let is_lost = |(file, function): &&(&str, &str)| {
        let text = std::fs::read_to_string(workspace.path(file)).unwrap_or_default();
        !text.contains(&format!("fn {function}"))
    };
    match places.iter().find(is_lost) {
        Some((file, function)) => Outcome::Failed(format!("{MAP}: {file} has no function {function}")),
        None => Outcome::Passed(format!("{} places of {MAP}", places.len())),
    }
}

/// Each file with the function after it.
fn places(text: &str) -> Vec<(&str, &str)> {
    let quoted: Vec<&str> = text.split('`').collect();
    let pairs = quoted.windows(3).filter(|three| three[0].ends_with(".rs") && three[1].trim() == ",");
    pairs.map(|three| (three[0], three[2])).collect()
}

fn words(text: &str) -> usize {
    text.split_whitespace().count()
}

#[cfg(test)]
mod tests {
    use super::{places, words};

    #[test]
    fn places_are_found() {
        assert_eq!(places("in `a/b.rs`, `f`: x, `c.rs` and\n`d.rs`,\n`g`"), [("a/b.rs", "f"), ("d.rs", "g")]);
    }

    #[test]
    fn words_are_counted_as_wc_does() {
        assert_eq!(words("# Title\n\n| a | b |\nτ = M(θ)θ̈\n"), 10);
        assert_eq!(words(""), 0);
    }
}
