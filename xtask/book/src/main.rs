//! Builds the documentation book: `mozzi-book ROOT OUT MOZZI [RUSTDOC]`, called by `cargo xtask book`.
//!
//! The chapters are `book/src`, the guides of `docs/`, and reference pages that are generated here. They are put
//! together in OUT/src: links are rewritten to the book's places, formulas become MathML, kernels' lines are read from
//! their source files, pictures and robots are made by the program MOZZI. mdBook writes OUT/html from them, and every
//! link of the result is checked. No network is used.

mod assemble;
mod check;
mod commands;
mod directives;
mod item;
mod links;
mod map;
mod math;
mod python;
mod python_docs;
mod quantities;
mod reference;
mod robots;
mod text;

use mdbook_driver::MDBook;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

/// Where everything is.
pub struct Place {
    /// The repository.
    pub root: PathBuf,
    /// The folder of the book: `src` and `html` in it are rewritten.
    pub out: PathBuf,
    /// The program `mozzi`.
    pub mozzi: PathBuf,
    /// The documentation of the Rust libraries, if it is to be copied into the book.
    pub rustdoc: Option<PathBuf>,
}

fn main() -> ExitCode {
    let absolute = |path: OsString| std::path::absolute(&path).unwrap_or_else(|_| PathBuf::from(path));
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(absolute).collect();
    let place = match &arguments[..] {
        [root, out, mozzi] => Place { root: root.clone(), out: out.clone(), mozzi: mozzi.clone(), rustdoc: None },
        [root, out, mozzi, rustdoc] => {
            Place { root: root.clone(), out: out.clone(), mozzi: mozzi.clone(), rustdoc: Some(rustdoc.clone()) }
        }
        _ => {
            eprintln!("usage: mozzi-book ROOT OUT MOZZI [RUSTDOC]");
            return ExitCode::from(2);
        }
    };
    match build(&place) {
        Ok(summary) => {
            println!("{summary}");
            ExitCode::SUCCESS
        }
        Err(problems) => {
            for problem in &problems {
                eprintln!("{problem}");
            }
            eprintln!("the book has {} problems", problems.len());
            ExitCode::FAILURE
        }
    }
}

fn build(place: &Place) -> Result<String, Vec<String>> {
    let one = |error: String| vec![error];
    let made = assemble::assemble(place)?;
    let book = MDBook::load(&place.out).map_err(|error| one(format!("mdBook: {error:#}")))?;
    book.build().map_err(|error| one(format!("mdBook: {error:#}")))?;
    let html = place.out.join("html");
    robots::make(place, &html, &made.robots)?;
    made.sources.write(place, &html).map_err(one)?;
    if let Some(rustdoc) = &place.rustdoc {
        text::copy_folder(rustdoc, &html.join("rustdoc")).map_err(one)?;
    }
    let checked = check::check(&html, place.rustdoc.is_some())?;
    Ok(format!(
        "{} chapters, {} formulas, {} kernels' items, {} robots, {} pictures; {checked}; {}",
        made.chapters,
        made.formulas,
        made.items,
        made.robots.len(),
        made.pictures,
        html.join("index.html").display()
    ))
}
