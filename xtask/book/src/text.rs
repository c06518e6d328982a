//! Text of Markdown: which parts are code; and files.

use std::path::Path;

/// A part of a Markdown text.
#[derive(Debug, PartialEq)]
pub enum Part<'a> {
    /// Prose, in which links, formulas and directives are looked for.
    Prose(&'a str),
    /// A fenced block or inline code, with its fences.
    Code(&'a str),
}

/// Splits a text into prose and code.
pub fn parts(text: &str) -> Vec<Part<'_>> {
    let (mut parts, mut start, mut at) = (Vec::new(), 0, 0);
    let bytes = text.as_bytes();
    while at < bytes.len() {
        if bytes[at] != b'`' {
            at += 1;
            continue;
        }
        let ticks = bytes[at..].iter().take_while(|&&byte| byte == b'`').count();
        let begins_line = text[..at].rsplit('\n').next().is_some_and(|line| line.trim().is_empty());
        let end = match ticks >= 3 && begins_line {
            true => closing_fence(text, at + ticks, ticks),
            false => closing_ticks(text, at + ticks, ticks),
        };
        let Some(end) = end else {
            at += ticks;
            continue;
        };
        if start < at {
            parts.push(Part::Prose(&text[start..at]));
        }
        parts.push(Part::Code(&text[at..end]));
        (start, at) = (end, end);
    }
    if start < text.len() {
        parts.push(Part::Prose(&text[start..]));
    }
    parts
}

/// Maps the prose and leaves the code.
pub fn map_prose(text: &str, mut map: impl FnMut(&str) -> String) -> String {
    let mapped = parts(text).into_iter().map(|part| match part {
        Part::Prose(prose) => map(prose),
        Part::Code(code) => code.to_owned(),
    });
    mapped.collect()
}

/// The end of the line that closes a fence.
fn closing_fence(text: &str, from: usize, ticks: usize) -> Option<usize> {
    let mut at = from + text[from..].find('\n')? + 1;
    for line in text[at..].split_inclusive('\n') {
        let bare = line.trim();
        if bare.len() >= ticks && bare.bytes().all(|byte| byte == b'`') {
            return Some(at + line.trim_end_matches('\n').len());
        }
        at += line.len();
    }
    None
}

/// The end of inline code, which ends with as many backticks as it began with.
fn closing_ticks(text: &str, from: usize, ticks: usize) -> Option<usize> {
    let mut at = from;
    while let Some(found) = text[at..].find('`') {
        let start = at + found;
        let run = text[start..].bytes().take_while(|&byte| byte == b'`').count();
        if run == ticks {
            return Some(start + run);
        }
        at = start + run;
    }
    None
}

/// Text as HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

pub fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// Writes a file, and the folders above it.
pub fn write(path: &Path, text: impl AsRef<[u8]>) -> Result<(), String> {
    let made = path.parent().map_or(Ok(()), std::fs::create_dir_all);
    made.and_then(|()| std::fs::write(path, text)).map_err(|error| format!("{}: {error}", path.display()))
}

/// Files and folders, sorted by name.
pub fn entries(folder: &Path) -> Result<Vec<std::path::PathBuf>, String> {
    let read = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut paths: Vec<_> = read.filter_map(Result::ok).map(|entry| entry.path()).collect();
    paths.sort();
    Ok(paths)
}

/// All files of a folder, with those of the folders in it.
pub fn files(folder: &Path) -> Result<Vec<std::path::PathBuf>, String> {
    let mut files = Vec::new();
    for path in entries(folder)? {
        match path.is_dir() {
            true => files.extend(self::files(&path)?),
            false => files.push(path),
        }
    }
    Ok(files)
}

pub fn copy_folder(from: &Path, to: &Path) -> Result<(), String> {
    for file in files(from)? {
        let inside = file.strip_prefix(from).map_err(|error| error.to_string())?;
        let bytes = std::fs::read(&file).map_err(|error| format!("{}: {error}", file.display()))?;
        write(&to.join(inside), bytes)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Part, parts};

    #[test]
    fn code_is_separated_from_prose() {
        let text = "a `b $c$` d\n```sh\n$ x `y`\n```\ne `` f ` g `` h ` i";
        let found = parts(text);
        let code: Vec<_> = found.iter().filter(|part| matches!(part, Part::Code(_))).collect();
        assert_eq!(code, [&Part::Code("`b $c$`"), &Part::Code("```sh\n$ x `y`\n```"), &Part::Code("`` f ` g ``")]);
        assert_eq!(found.last(), Some(&Part::Prose(" h ` i")));
    }
}
