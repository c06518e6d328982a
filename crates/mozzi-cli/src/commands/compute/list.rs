//! `mozzi compute --list`: the list of quantities.

use super::flags;
use crate::quantity::hyphenated;
use crate::text::Page;
use mozzi::quantities::{LIST, Output};

pub fn page() -> String {
    let mut page = Page::default();
    for declaration in LIST {
        let outputs: Vec<String> = declaration.outputs.iter().map(output).collect();
        page.line(format!("{}: {}", hyphenated(declaration.name), declaration.formula)).lines(&[
            format!("takes {}", flags::text(&flags::of(declaration))),
            format!("gives {}", outputs.join(", ")),
        ]);
    }
    page.end()
}

/// "M (n, n)"
fn output(output: &Output) -> String {
    let dims: Vec<String> = output.dims.iter().map(ToString::to_string).collect();
    if dims.is_empty() { output.name.to_string() } else { format!("{} ({})", output.name, dims.join(", ")) }
}
