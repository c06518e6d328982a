//! The output that a page shows, compared with what a program printed.

/// True if the text is as expected. An expected line `…` is any number of lines, `…` within a line any characters;
/// spaces at the ends of lines and empty lines at the end do not matter.
pub fn agrees(found: &str, expected: &str) -> bool {
    let lines = |text: &str| text.trim_end().lines().map(|line| line.trim_end().to_owned()).collect::<Vec<_>>();
    lines_agree(&lines(found), &lines(expected))
}

fn lines_agree(found: &[String], expected: &[String]) -> bool {
    match (found, expected) {
        (_, [any, rest @ ..]) if any == "…" => (0..=found.len()).any(|skipped| lines_agree(&found[skipped..], rest)),
        ([], []) => true,
        ([line, found @ ..], [pattern, rest @ ..]) => line_agrees(line, pattern) && lines_agree(found, rest),
        _ => false,
    }
}

fn line_agrees(line: &str, pattern: &str) -> bool {
    let Some((start, rest)) = pattern.split_once('…') else { return line == pattern };
    let Some(line) = line.strip_prefix(start) else { return false };
    let places = line.char_indices().map(|(at, _)| at).chain([line.len()]);
    places.into_iter().any(|at| line_agrees(&line[at..], rest))
}

/// The commands of a block `console`, each with the output below it.
pub fn sessions(console: &str) -> Vec<(String, String)> {
    let mut sessions: Vec<(String, String)> = Vec::new();
    for line in console.lines() {
        match (line.strip_prefix("$ "), sessions.last_mut()) {
            (Some(command), _) => sessions.push((command.to_owned(), String::new())),
            (None, Some((command, output))) if command.ends_with('\\') && output.is_empty() => {
                command.push('\n');
                command.push_str(line);
            }
            (None, Some((_, output))) => *output += &format!("{line}\n"),
            (None, None) => sessions.push((String::new(), line.to_owned())),
        }
    }
    sessions
}

#[cfg(test)]
mod tests {
    use super::{agrees, sessions};

    #[test]
    fn ellipses_stand_for_what_differs() {
        assert!(agrees("a 1\nb\nc 0.5 s\n", "a 1\n…\nc … s"));
        assert!(agrees("a\nz\n\n", "a\n…\nz\n"));
        assert!(!agrees("a 1\nb\n", "a 2\nb\n"));
        assert!(!agrees("a\nb\n", "a\n"));
    }

    #[test]
    fn a_session_is_commands_with_outputs() {
        let expected = [("mozzi \\\n  a", "1\n2\n"), ("ls", "")].map(|(a, b)| (a.to_owned(), b.to_owned()));
        assert_eq!(sessions("$ mozzi \\\n  a\n1\n2\n$ ls\n"), expected);
    }
}
