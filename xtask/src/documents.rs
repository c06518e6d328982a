//! Limits on the length of README and DESIGN, in words as `wc -w` counts them.

use crate::report::Outcome;
use crate::workspace::Workspace;

/// A document and its largest number of words.
const LIMITS: [(&str, usize); 2] = [("README.md", 1200), ("DESIGN.md", 2500)];

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

fn words(text: &str) -> usize {
    text.split_whitespace().count()
}

#[cfg(test)]
mod tests {
    use super::words;

    #[test]
    fn words_are_counted_as_wc_does() {
        assert_eq!(words("# Title\n\n| a | b |\nτ = M(θ)θ̈\n"), 10);
        assert_eq!(words(""), 0);
    }
}
