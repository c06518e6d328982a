//! Checks the package's text about the quantities against the list: their methods in `_mozzi.pyi`, and the named tuples
//! of several results in `_quantities.py`. `cargo xtask docs`, or `MOZZI_BLESS=1 cargo test -p mozzi-py --test all
//! stubs`, regenerates both.

#[allow(dead_code)] // used by the library
#[path = "../src/signature.rs"]
mod signature;

use mozzi::quantities::{Declaration, LIST, Output};
use signature::{CLASSES, Signature, shape};
use std::fmt::Write;
use std::path::{Path, PathBuf};

const BEGIN: &str = "    # The quantities: from here on written by `cargo xtask docs`.\n";
/// The most characters in a line.
const WIDE: usize = 120;
const INDENT: &str = "    ";
const END: &str = "    # End of the quantities.\n";

const HEAD: &str = "\"\"\"Several results of a quantity, as named tuples. Written by `cargo xtask docs` from the list of quantities.\"\"\"

from typing import Any, NamedTuple

from numpy.typing import NDArray

Array = NDArray[Any]

__all__ = [
";

fn quantities() -> impl Iterator<Item = (&'static Declaration, &'static str)> {
    LIST.iter().zip(CLASSES.iter().copied())
}

fn methods() -> String {
    let mut text = String::from(BEGIN);
    for (declaration, class) in quantities() {
        let arguments = Signature::new(declaration).text("self", true);
        let result = match declaration.outputs {
            [Output { dims: [], .. }] => "Any",
            [_] => "Array",
            _ => class,
        };
        text += &method(&format!("def {}({arguments}) -> {result}:", declaration.name), declaration.formula);
    }
    text + END
}

/// A method with its summary, in lines of at most 120 characters.
fn method(definition: &str, summary: &str) -> String {
    let mut text = [INDENT, definition].concat();
    if text.chars().count() > WIDE {
        let (name, rest) = definition.split_once('(').expect("a method");
        let (arguments, result) = rest.rsplit_once(')').expect("a method");
        let mut depth = 0;
        let ends = |c: char| {
            depth += i32::from(c == '[') - i32::from(c == ']');
            c == ',' && depth == 0
        };
        text = format!("{INDENT}{name}({}\n{INDENT}){result}", filled(arguments.split_inclusive(ends).map(str::trim)));
    }
    let summary = format!("\"\"\"{summary}.\"\"\"");
    text + &filled(summary.split(' ')) + "\n"
}

/// Words in lines with the indentation of a method's body; each line begins with a line break.
fn filled<'a>(words: impl Iterator<Item = &'a str>) -> String {
    let (mut text, mut width) = (String::new(), WIDE);
    for word in words {
        let length = word.chars().count() + 1;
        if width + length > WIDE {
            text += &format!("\n{INDENT}{INDENT}");
            width = 2 * INDENT.len() - 1;
        } else {
            text.push(' ');
        }
        text += word;
        width += length;
    }
    text
}

fn tuples() -> String {
    let mut text = String::from(HEAD);
    let several = || quantities().filter(|(declaration, _)| declaration.outputs.len() > 1);
    several().for_each(|(_, class)| writeln!(text, "    \"{class}\",").expect("a String"));
    text += "]\n";
    for (declaration, class) in several() {
        let formula = declaration.formula;
        let heading = format!(
            "\n\nclass {class}(NamedTuple):\n    \"\"\"{formula}.\n\n    See ``Model.{}``.\n    \"\"\"\n\n",
            declaration.name
        );
        text += &heading;
        for Output { name, dims, unit, .. } in declaration.outputs {
            writeln!(text, "    {name}: Array\n    \"\"\"Shape {}: {unit}.\"\"\"", shape(dims)).expect("a String");
        }
    }
    text
}

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("python/mozzi").join(name)
}

fn check(name: &str, text: &str) {
    let file = file(name);
    if std::env::var_os("MOZZI_BLESS").is_some() {
        std::fs::write(&file, text).expect("a file of the repository");
    }
    let found = std::fs::read_to_string(&file).unwrap_or_default().replace("\r\n", "\n");
    assert!(found == text, "{name} is not that of the list of quantities: `cargo xtask docs` writes it anew");
}

#[test]
fn the_page_of_methods_is_current() {
    let name = "_mozzi.pyi";
    let text = std::fs::read_to_string(file(name)).expect("a file of the repository").replace("\r\n", "\n");
    let (before, rest) = text.split_once(BEGIN).expect("the first line of the quantities");
    let (_, after) = rest.split_once(END).expect("the last line of the quantities");
    check(name, &[before, &methods(), after].concat());
}

#[test]
fn the_page_of_named_tuples_is_current() {
    check("_quantities.py", &tuples());
}
