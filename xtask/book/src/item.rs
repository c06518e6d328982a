//! The lines of one item of a source file: a function, a type or a block between two marks, found by its name.

/// The item's lines, without documentation, attributes and the indentation of the first line.
pub fn item(source: &str, name: &str) -> Result<String, String> {
    let lines: Vec<&str> = source.lines().collect();
    let indent = |at: usize| lines[at].len() - lines[at].trim_start().len();
    let mut starts: Vec<usize> = (0..lines.len()).filter(|&at| declares(lines[at], name)).collect();
    // a kernel before the method of its name
    let least = starts.iter().map(|&at| indent(at)).min();
    starts.retain(|&at| Some(indent(at)) == least);
    let &[start] = &starts[..] else {
        return Err(format!("`{name}` is declared {} times, expected once", starts.len()));
    };
    let indent = indent(start);
    let closes =
        |line: &str| line.len() > indent && line[..indent].trim().is_empty() && line[indent..].starts_with('}');
    let end =
        (start..lines.len()).find(|&at| closes(lines[at]) || (at == start && lines[at].trim_end().ends_with(';')));
    let end = end.ok_or_else(|| format!("`{name}` has no end"))?;
    let cut = |line: &&str| line.get(indent..).unwrap_or_default().to_owned();
    Ok(lines[start..=end].iter().map(cut).collect::<Vec<_>>().join("\n"))
}

/// Lines from the one that contains `first` to the one that contains `last`.
pub fn between(source: &str, first: &str, last: &str) -> Result<String, String> {
    let lines: Vec<&str> = source.lines().collect();
    let starts: Vec<usize> = (0..lines.len()).filter(|&at| lines[at].contains(first)).collect();
    let &[start] = &starts[..] else {
        return Err(format!("`{first}` is in {} lines, expected one", starts.len()));
    };
    let end = (start..lines.len()).find(|&at| lines[at].contains(last));
    let end = end.ok_or_else(|| format!("after `{first}` there is no `{last}`"))?;
    let shown = &lines[start..=end];
    let indent = |line: &&&str| line.len() - line.trim_start().len();
    let least = shown.iter().filter(|line| !line.trim().is_empty()).map(|line| indent(&line)).min().unwrap_or(0);
    Ok(shown.iter().map(|line| line.get(least..).unwrap_or_default()).collect::<Vec<_>>().join("\n"))
}

fn declares(line: &str, name: &str) -> bool {
    let line = line.trim_start();
    let bare = ["pub(crate) ", "pub(super) ", "pub "].iter().find_map(|word| line.strip_prefix(word)).unwrap_or(line);
    ["fn ", "struct ", "enum ", "const ", "trait "].iter().any(|kind| {
        let rest = bare.strip_prefix(kind).and_then(|rest| rest.strip_prefix(name));
        rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
    })
}

#[cfg(test)]
mod tests {
    use super::{between, item};

    const SOURCE: &str = "/// doc\npub fn a<S>() {\n    if x {\n        y;\n    }\n}\n\nfn ab() {\n    z;\n}\n";

    #[test]
    fn an_item_ends_with_its_brace() {
        assert_eq!(item(SOURCE, "a").as_deref(), Ok("pub fn a<S>() {\n    if x {\n        y;\n    }\n}"));
        assert_eq!(item(SOURCE, "ab").as_deref(), Ok("fn ab() {\n    z;\n}"));
        assert!(item(SOURCE, "renamed").is_err());
        let method = format!("impl X {{\n    pub fn a() {{}}\n}}\n{SOURCE}");
        assert_eq!(item(&method, "a").as_deref(), Ok("pub fn a<S>() {\n    if x {\n        y;\n    }\n}"));
    }

    #[test]
    fn lines_between_two_texts() {
        assert_eq!(between(SOURCE, "if x", "y;").as_deref(), Ok("if x {\n    y;"));
        assert!(between(SOURCE, "gone", "y;").is_err());
    }
}
