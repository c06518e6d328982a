//! Checks the text about the quantities against their list: their functions in `mozzi.h`, the functions' Rust in
//! `src/typed/list.rs`, and the methods in `mozzi.hpp`. `cargo xtask docs`, or
//! `MOZZI_BLESS=1 cargo test -p mozzi-c --test header`, regenerates them.

mod declared;
mod functions;
mod list;
mod methods;

use list::{Further, further, quantities, shapes};
use std::path::{Path, PathBuf};

/// The words in lines of at most this width.
fn wrapped(text: &str, width: usize, first: &str, next: &str) -> String {
    let (mut lines, mut line) = (Vec::new(), String::from(first));
    let mut is_empty = true;
    for word in text.split([' ', '\n']).filter(|word| !word.is_empty()) {
        if !is_empty && line.chars().count() + 1 + word.chars().count() > width {
            lines.push(std::mem::replace(&mut line, next.to_string()));
            is_empty = true;
        }
        if !is_empty {
            line.push(' ');
        }
        line += word;
        is_empty = false;
    }
    lines.push(line);
    lines.join("\n").replace(GLUE, " ")
}

/// A space at which no line ends.
const GLUE: &str = "\u{a0}";

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn read(name: &str) -> String {
    std::fs::read_to_string(file(name)).unwrap_or_default().replace("\r\n", "\n")
}

fn check(name: &str, text: &str) {
    if std::env::var_os("MOZZI_BLESS").is_some() {
        std::fs::write(file(name), text).expect("a file of the repository");
    }
    assert!(read(name) == text, "{name} is not that of the list of quantities: `cargo xtask docs` writes it anew");
}

/// Replaces the lines between these two.
fn check_between(name: &str, begin: &str, end: &str, written: &str) {
    let text = read(name);
    let (before, rest) = text.split_once(begin).expect("the first line of the quantities");
    let (_, after) = rest.split_once(end).expect("the last line of the quantities");
    check(name, &[before, begin, written, end, after].concat());
}

#[test]
fn the_page_of_functions_is_current() {
    check_between(
        "include/mozzi/mozzi.h",
        "/* The quantities: from here on written by `cargo xtask docs`. */\n",
        "/* End of the quantities. */\n",
        &functions::text(),
    );
}

#[test]
fn the_page_of_exports_is_current() {
    check("src/typed/list.rs", &functions::exports());
}

#[test]
fn the_page_of_methods_is_current() {
    check_between(
        "include/mozzi/mozzi.hpp",
        "  // The quantities: from here on written by `cargo xtask docs`.\n",
        "  // End of the quantities.\n",
        &methods::text(),
    );
}
