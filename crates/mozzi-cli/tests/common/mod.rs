//! Runs the program.
#![allow(dead_code)] // each test file uses a part

use serde_json::Value;
use std::path::PathBuf;
use std::process::{Command, Output};

pub fn mozzi(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mozzi")).args(arguments).output().expect("the program runs")
}

/// The output of a successful run.
pub fn text(arguments: &[&str]) -> String {
    let output = mozzi(arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

/// The words of a page, however its lines are broken.
pub fn words(page: &str) -> String {
    page.split_whitespace().collect::<Vec<_>>().join(" ")
}

pub fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&text(&[arguments, &["--json"]].concat())).expect("JSON")
}

/// The exit code and the message of a failed run; standard output is then empty.
pub fn complaint(arguments: &[&str]) -> (i32, String) {
    let output = mozzi(arguments);
    assert!(output.stdout.is_empty(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stdout));
    (output.status.code().expect("an exit code"), String::from_utf8(output.stderr).expect("text"))
}

pub fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

pub fn rows(value: &Value) -> Vec<Vec<f64>> {
    value.as_array().expect("a list").iter().map(numbers).collect()
}

pub fn times(M: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
    M.iter().map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum()).collect()
}

pub fn assert_close(a: &[f64], b: &[f64], tolerance: f64) {
    assert_eq!(a.len(), b.len());
    let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart <= tolerance, "{a:?} and {b:?} differ by {apart:e}");
}

/// An empty folder of this test.
pub fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// A file in a folder, by its path.
pub fn file(folder: &std::path::Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    std::fs::write(&path, text).expect("a file");
    path.to_str().expect("a path of text").to_string()
}

/// A shell script that replaces Python, by its path. Another process writes it: what this one writes may be open
/// still in a program that another test starts just then, and a file open for writing does not run.
#[cfg(unix)]
pub fn script(name: &str, text: &str) -> String {
    let path = folder(name).join("python").to_str().expect("a path of text").to_string();
    let write = r##"printf '#!/bin/sh\n%s\n' "$1" > "$0"; chmod 755 "$0""##;
    assert!(Command::new("sh").args(["-c", write, &path, text]).status().expect("sh runs").success());
    path
}

/// Columns that a line takes: combining marks take none.
fn width(line: &str) -> usize {
    line.chars().filter(|c| !('\u{300}'..='\u{36f}').contains(c)).count()
}

/// The text of a command, which has at most so many lines of at most 80 columns.
pub fn screen(arguments: &[&str], most: usize) -> String {
    let page = text(arguments);
    let lines = page.lines().count();
    assert!(lines <= most, "{arguments:?}: {lines} lines, expected at most {most}");
    if let Some(wide) = page.lines().find(|line| width(line) > 80) {
        panic!("{arguments:?}: {} columns: {wide}", width(wide));
    }
    page
}
