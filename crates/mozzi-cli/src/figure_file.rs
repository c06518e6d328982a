//! A figure's file: SVG as it is; PNG and PDF are made of it.

use crate::columns;
use crate::failure::{Failure, Result};
use clap::Args;
use std::path::Path;

#[cfg(feature = "pdf")]
mod pdf;
#[cfg(feature = "png")]
mod png;

#[derive(Args, Debug)]
pub struct OutArguments {
    /// Output file: .svg; .png or .pdf if built with the feature of this name
    #[arg(long, value_name = "FILE.svg")]
    pub out: String,
    /// Title [default: a description of the figure]
    #[arg(long, value_name = "TEXT")]
    pub title: Option<String>,
}

/// Writes a figure in the format of the file's ending.
pub fn save(file: &str, title: &str, svg: String) -> Result<()> {
    let bytes = match Path::new(file).extension().and_then(|ending| ending.to_str()) {
        Some("svg") => svg.into_bytes(),
        Some(ending @ ("png" | "pdf")) => converted(ending, &svg, title)?,
        _ => return Err(Failure::wrong(format!("--out is {file}, expected a file that ends in .svg, .png or .pdf"))),
    };
    columns::save(file, bytes)
}

/// The figure as "png" or "pdf"; each needs the feature of its name.
fn converted(format: &str, svg: &str, title: &str) -> Result<Vec<u8>> {
    let _ = (svg, title); // unused without the features
    match format {
        #[cfg(feature = "png")]
        "png" => png::of(&parsed(svg, "PNG")?),
        #[cfg(feature = "pdf")]
        "pdf" => pdf::of(&parsed(svg, "PDF")?, title),
        _ => Err(Failure::wrong(format!(
            "--out ends in .{format}, but this program was built without the feature `{format}`; .svg works, or build \
             it with: cargo install --path crates/mozzi-cli --features {format}"
        ))),
    }
}

/// The figure with its text as outlines, in the fonts of this machine.
#[cfg(any(feature = "png", feature = "pdf"))]
fn parsed(svg: &str, format: &str) -> Result<resvg::usvg::Tree> {
    use resvg::usvg;
    let mut options = usvg::Options::default();
    options.fontdb_mut().load_system_fonts();
    if options.fontdb.is_empty() {
        return Err(cannot(format, "this machine has no fonts; .svg needs none"));
    }
    usvg::Tree::from_str(svg, &options).map_err(|error| cannot(format, &error.to_string()))
}

#[cfg(any(feature = "png", feature = "pdf"))]
fn cannot(format: &str, why: &str) -> Failure {
    Failure::wrong(format!("the figure cannot be drawn as {format}: {why}"))
}
