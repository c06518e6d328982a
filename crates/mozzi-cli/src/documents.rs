//! Every command line that the documentation shows is one that the program understands: in blocks of code and in the
//! text, whether or not other tests run it.

use crate::parsed;
use clap::error::ErrorKind;
use std::path::{Path, PathBuf};

/// Files and folders with documents, from the repository's root.
const DOCUMENTS: [&str; 6] =
    ["README.md", "CONTRIBUTING.md", "crates/mozzi-py/README.md", "docs", "book/src", "examples/README.md"];
/// Records, and a page whose examples are wrong on purpose.
const SKIPPED: [&str; 2] = ["performance-log.md", "diagnostics"];
/// Placeholders: command lines with one of these are skipped.
const OPEN: [&str; 5] = ["…", "COMMAND", "QUANTITY", "...", "mozzi = "];

fn collect(path: &Path, files: &mut Vec<PathBuf>) {
    if SKIPPED.iter().any(|name| path.to_string_lossy().contains(name)) {
        return;
    }
    if path.is_file() {
        files.extend(path.extension().is_some_and(|ending| ending == "md").then(|| path.to_path_buf()));
        return;
    }
    for entry in std::fs::read_dir(path).into_iter().flatten().filter_map(Result::ok) {
        collect(&entry.path(), files);
    }
}

/// The command lines of a document that begin with `mozzi`, without those that it shows to fail.
fn command_lines(text: &str) -> Vec<(usize, String)> {
    let (mut found, mut is_block) = (Vec::new(), false);
    let lines: Vec<&str> = text.lines().collect();
    let mut at = 0;
    while at < lines.len() {
        let (start, mut line) = (at, lines[at].to_owned());
        at += 1;
        if line.trim_start().starts_with("```") {
            is_block = !is_block;
        } else if !is_block {
            let codes = line.split('`').skip(1).step_by(2).filter(|code| code.starts_with("mozzi "));
            found.extend(codes.map(|code| (start + 1, code.to_owned())));
        } else if line.starts_with("mozzi ") || line.starts_with("$ mozzi ") {
            while line.ends_with('\\') && at < lines.len() {
                line.pop();
                line += lines[at];
                at += 1;
            }
            if !lines.get(at).is_some_and(|next| next.starts_with("error")) {
                found.push((start + 1, line.trim_start_matches("$ ").to_owned()));
            }
        }
    }
    found
}

/// The words of a command as a shell splits them, up to a comment, a pipe or a redirection.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut quote) = (Vec::new(), None::<String>, None);
    for letter in line.chars() {
        match (quote, letter) {
            (Some(open), _) if open == letter => quote = None,
            (None, '\'' | '"') => {
                quote = Some(letter);
                word.get_or_insert_default();
            }
            (None, ' ') => words.extend(word.take()),
            (None, '#') if word.is_none() => break,
            (None, '|' | '>' | '<' | ';' | '&') => {
                word = word.filter(|word| word != "2"); // `2>file`
                break;
            }
            _ => word.get_or_insert_default().push(letter),
        }
    }
    words.extend(word);
    words
}

#[test]
fn every_command_line_of_the_documents_is_understood() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let (mut files, mut count, mut wrong) = (Vec::new(), 0, Vec::new());
    for document in DOCUMENTS {
        collect(&root.join(document), &mut files);
    }
    for file in files {
        let text = std::fs::read_to_string(&file).expect("a document");
        for (line, command) in command_lines(&text) {
            if OPEN.iter().any(|open| command.contains(open)) {
                continue;
            }
            count += 1;
            let words = words(&command).into_iter().map(Into::into).collect();
            // a flag or a value that does not exist; `mozzi check` or `mozzi ik --out` in a sentence lack what follows
            if let Err(error) = parsed(words)
                && !error.to_string().contains("none was supplied")
                && !matches!(
                    error.kind(),
                    ErrorKind::MissingRequiredArgument
                        | ErrorKind::DisplayHelp
                        | ErrorKind::DisplayVersion
                        | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand
                        | ErrorKind::MissingSubcommand
                )
            {
                let first = error.to_string().lines().next().unwrap_or_default().to_owned();
                wrong.push(format!("{}:{line}: `{command}`: {first}", file.display()));
            }
        }
    }
    assert!(count > 200, "{count}");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn words_are_a_shells() {
    assert_eq!(words("mozzi a --b 'c d' # e"), ["mozzi", "a", "--b", "c d"]);
    assert_eq!(words("mozzi a 2>/dev/null | head"), ["mozzi", "a"]);
    assert_eq!(command_lines("`mozzi a`\n```sh\nmozzi b \\\n  c\nmozzi d\nerror: x\n```\n").len(), 2);
}
