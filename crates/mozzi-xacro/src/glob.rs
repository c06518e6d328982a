//! Files by a pattern: `*`, `?`, `[a-z]`, `[!a-z]` within one name.

use crate::fault::{Fault, Result};
use std::path::PathBuf;

/// The most files and folders that are checked.
const MOST_ENTRIES: usize = 20_000;

pub(crate) fn is_pattern(text: &str) -> bool {
    text.contains(['*', '[', '?'])
}

/// All files and folders of the pattern, by name.
pub(crate) fn files(pattern: &str) -> Result<Vec<PathBuf>> {
    let root = if pattern.starts_with('/') { "/" } else { "" };
    let mut found = vec![root.to_string()];
    let mut seen = 0;
    for part in pattern.split('/').filter(|part| !part.is_empty()) {
        let mut next = Vec::new();
        for folder in &found {
            let join = |name: &str| match folder.as_str() {
                "" => name.to_string(),
                folder if folder.ends_with('/') => format!("{folder}{name}"),
                folder => format!("{folder}/{name}"),
            };
            if !is_pattern(part) {
                let path = join(part);
                if std::fs::symlink_metadata(&path).is_ok() {
                    next.push(path);
                }
                continue;
            }
            let Ok(entries) = std::fs::read_dir(if folder.is_empty() { "." } else { folder }) else { continue };
            for entry in entries.flatten() {
                seen += 1;
                if seen > MOST_ENTRIES {
                    return Err(Fault::new(format!("`{pattern}` leads to more than {MOST_ENTRIES} files and folders")));
                }
                let name = entry.file_name().to_string_lossy().into_owned();
                let is_hidden = name.starts_with('.') && !part.starts_with('.');
                if !is_hidden && matches(part, &name) {
                    next.push(join(&name));
                }
            }
        }
        found = next;
    }
    found.sort_unstable();
    Ok(found.into_iter().map(PathBuf::from).collect())
}

/// True if a name matches a pattern. Cost: the product of their lengths.
fn matches(pattern: &str, name: &str) -> bool {
    let (pattern, name): (Vec<char>, Vec<char>) = (pattern.chars().collect(), name.chars().collect());
    // the lengths of the name at which the pattern so far may end
    let mut ends = vec![false; name.len() + 1];
    ends[0] = true;
    let mut at = 0;
    while let Some(&c) = pattern.get(at) {
        let mut next = vec![false; name.len() + 1];
        if c == '*' {
            let first = ends.iter().position(|end| *end).unwrap_or(name.len() + 1);
            next.iter_mut().skip(first).for_each(|end| *end = true);
            at += 1;
        } else {
            let (length, accepts) = one(&pattern[at..]);
            for (k, letter) in name.iter().enumerate() {
                next[k + 1] = ends[k] && accepts(*letter);
            }
            at += length;
        }
        ends = next;
    }
    ends[name.len()]
}

/// The part of a pattern that matches one character: its length, and the characters it accepts.
fn one(pattern: &[char]) -> (usize, Box<dyn Fn(char) -> bool + '_>) {
    match pattern[0] {
        '?' => (1, Box::new(|_| true)),
        '[' => {
            let negated = pattern.get(1) == Some(&'!');
            let start = 1 + usize::from(negated);
            // a bracket that comes first is an ordinary character
            let close = pattern.iter().skip(start + 1).position(|c| *c == ']').map(|k| start + 1 + k);
            let Some(close) = close else { return (1, Box::new(|c| c == '[')) };
            let set = &pattern[start..close];
            let accepts = move |letter: char| {
                let (mut k, mut found) = (0, false);
                while k < set.len() {
                    if k + 2 < set.len() && set[k + 1] == '-' {
                        found |= (set[k]..=set[k + 2]).contains(&letter);
                        k += 3;
                    } else {
                        found |= set[k] == letter;
                        k += 1;
                    }
                }
                found != negated
            };
            (close + 1, Box::new(accepts))
        }
        c => (1, Box::new(move |letter| letter == c)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns() {
        for (pattern, name, expected) in [
            ("*.xacro", "a.xacro", true),
            ("*.xacro", "a.urdf", false),
            ("a?c", "abc", true),
            ("a?c", "ac", false),
            ("[a-c]1", "b1", true),
            ("[!a-c]1", "b1", false),
            ("[!a-c]1", "d1", true),
            ("a[", "a[", true),
            ("**", "anything", true),
            ("*a*b*", "xxaxxbxx", true),
            ("*a*b*", "xxbxxaxx", false),
        ] {
            assert_eq!(matches(pattern, name), expected, "{pattern} {name}");
        }
    }
}
