//! Expands many files in one process, for comparisons with other tools. Reads a path on each line of standard input,
//! `path<TAB>name:=value<TAB>package=folder…`, and writes `ok LENGTH` and the text, or `error LENGTH` and the message.

use mozzi_xacro::{Arguments, expand};
use std::io::{BufRead, Write};

fn main() -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    for line in std::io::stdin().lock().lines() {
        let line = line?;
        let mut words = line.split('\t');
        let path = words.next().unwrap_or_default();
        let values =
            words.filter_map(|word| word.split_once(":=")).map(|(name, value)| (name.to_string(), value.to_string()));
        let values = values.collect();
        let packages =
            line.split('\t').skip(1).filter(|word| !word.contains(":=")).filter_map(|word| word.split_once('='));
        let packages = packages.map(|(name, folder)| (name.to_string(), folder.into())).collect();
        let arguments = Arguments { values, packages, ..Arguments::default() };
        let (verdict, text) = match expand(path, &arguments) {
            Ok(expansion) => ("ok", expansion.text),
            Err(error) => ("error", error.to_string()),
        };
        writeln!(out, "{verdict} {}", text.len())?;
        out.write_all(text.as_bytes())?;
        out.flush()?;
    }
    Ok(())
}
