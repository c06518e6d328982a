//! The table of all published robots: what `check` finds in each, and what `check --fix` proposes.

use super::short;
use crate::oracles::models::name_of;
use mozzi_urdf::{Consequence, Diagnostic, Loaded, Settings, Severity, fix, load};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// A file of a published robot: its name in its package, and its path.
pub type File = (String, PathBuf);

/// The models of gymnasium and dm_control in which something moves, by the list that `oracles/make_mjcf.py` wrote.
pub fn models(oracles: &Path) -> Vec<File> {
    let list = std::fs::read_to_string(oracles.join("list.txt")).expect("a list of models");
    let moving = list.lines().filter_map(|line| line.strip_suffix("\tcompared"));
    moving.map(|path| (name_of(path), PathBuf::from(path))).collect()
}

/// The table. Proposals are computed for every so many files, and those of the others taken from the existing page:
/// all of them take minutes.
pub fn table(files: &[File], written: &str, step: usize) -> String {
    let mut table = String::from(
        "| robot | file | joints | mass | errors | warnings | proposals |\n|---|---|---|---|---|---|---|\n",
    );
    for (k, file) in files.iter().enumerate() {
        let known = Some(file).filter(|_| k % step > 0).and_then(|(name, _)| proposals_in(written, name));
        row(&mut table, file, &known.unwrap_or_else(|| proposals(&file.1)));
    }
    table
}

/// The last cell of a file's row in a page.
fn proposals_in(page: &str, name: &str) -> Option<String> {
    let row = page.lines().find(|line| line.split(" | ").nth(1) == Some(name) && line.split(" | ").count() == 7)?;
    Some(row.trim_end_matches('|').rsplit(" | ").next()?.trim().to_string())
}

fn row(table: &mut String, (name, path): &File, proposals: &str) {
    let (robot, joints, mass, found) = match load(path) {
        Ok(Loaded { description, warnings, .. }) => {
            let mass: f64 = description.links.iter().map(|link| link.inertia.mass).sum();
            let joints = description.joints.iter().filter(|joint| joint.kind.name() != "fixed").count();
            (description.name.clone(), joints.to_string(), format!("{} kg", rounded(mass)), warnings)
        }
        Err(error) => ("–".into(), "refused".into(), "–".into(), error.diagnostics().to_vec()),
    };
    let is_told = |found: &&Diagnostic| found.consequence() != Consequence::Unused;
    let told = || found.iter().filter(is_told);
    let of = |severity: Severity| counted(told().filter(|one| one.severity() == severity).map(linked));
    let (errors, warnings) = (of(Severity::Error), of(Severity::Warning));
    let _ = writeln!(table, "| {robot} | {name} | {joints} | {mass} | {errors} | {warnings} | {proposals} |");
}

/// A number with four digits.
fn rounded(x: f64) -> String {
    let digits = 3 - x.max(1e-3).log10().floor().clamp(-3.0, 3.0) as i32;
    let text = format!("{x:.*}", usize::try_from(digits).unwrap_or(0));
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

/// A code with a link to its page.
fn linked(found: &Diagnostic) -> String {
    let code = short(found);
    format!("[`{code}`](diagnostics/{code}.md)")
}

/// Each word once, with its number: "2 a, 1 b".
fn counted(words: impl Iterator<Item = String>) -> String {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    words.for_each(|word| *counts.entry(word).or_default() += 1);
    counts.iter().map(|(word, count)| format!("{count} {word}")).collect::<Vec<_>>().join(", ")
}

/// The proposals of `check --fix` by their codes, for a URDF.
fn proposals(path: &Path) -> String {
    if path.extension().is_none_or(|ending| ending != "urdf") {
        return "–".into();
    }
    let text = std::fs::read_to_string(path).expect("a text");
    match fix::proposals(&path.to_string_lossy(), &text, None, &Settings::default()) {
        Ok(all) => counted(all.proposals.iter().map(|one| format!("`{}`", one.code))),
        Err(_) => "–".into(),
    }
}
