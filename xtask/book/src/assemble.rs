//! The folder that mdBook reads: every chapter with its links, formulas, listings and pictures.

use crate::directives::{self, Asked};
use crate::links::{Page, Sources};
use crate::map::{Map, with_diagnostics};
use crate::robots::Robots;
use crate::text::{self, Part};
use crate::{Place, commands, math, quantities, reference};
use std::path::Path;

/// What was put together.
pub struct Assembled {
    pub chapters: usize,
    pub formulas: usize,
    pub items: usize,
    pub pictures: usize,
    pub robots: Robots,
    pub sources: Sources,
}

/// A chapter before its links are rewritten.
struct Chapter {
    /// From the repository's root.
    file: String,
    /// From the book's root.
    page: String,
    text: String,
}

/// Writes `src` and the configuration of mdBook into the book's folder.
pub fn assemble(place: &Place) -> Result<Assembled, Vec<String>> {
    let one = |error: String| vec![error];
    let (book, src) = (place.root.join("book"), place.out.join("src"));
    for folder in ["src", "pictures"].map(|name| place.out.join(name)) {
        if folder.exists() {
            std::fs::remove_dir_all(&folder).map_err(|error| one(format!("{}: {error}", folder.display())))?;
        }
    }
    for file in ["book.toml", "theme/book.css"] {
        text::write(&place.out.join(file), text::read(&book.join(file)).map_err(one)?).map_err(one)?;
    }
    let mut made = Assembled {
        chapters: 0,
        formulas: 0,
        items: 0,
        pictures: 0,
        robots: Robots::new(),
        sources: Sources::default(),
    };
    let mut problems = Vec::new();
    let mut chapters = own_chapters(place, &src, &mut made, &mut problems).map_err(one)?;
    let names: Vec<String> = chapters.iter().map(|chapter| chapter.page.clone()).collect();
    let imported = Map::imported(&place.root).map_err(one)?;
    let map = Map::new(&names, &imported);
    for (file, page) in imported {
        let mut text = text::read(&place.root.join(&file)).map_err(one)?;
        if page == "reference/quantities.md" {
            text = quantities::with_each(&place.root, &text).map_err(one)?;
        }
        chapters.push(Chapter { file, page, text });
    }
    for (page, text) in reference::pages(place, &mut made.sources)? {
        text::write(&src.join(page), text).map_err(one)?;
        made.chapters += 1;
    }
    for chapter in chapters.iter().filter(|chapter| chapter.page != "SUMMARY.md") {
        text::write(&src.join(&chapter.page), "").map_err(one)?; // links to it are found
    }
    for Chapter { file, page, text } in &chapters {
        let here = Page { root: &place.root, src: &src, file, page, map: &map };
        let rewritten = text::map_prose(text, |prose| match here.rewrite(prose, &mut made.sources) {
            Ok(prose) => prose,
            Err(problem) => {
                problems.push(problem);
                String::new()
            }
        });
        let rewritten = match page.as_str() {
            "SUMMARY.md" => with_diagnostics(&place.root, &rewritten).map_err(one)?,
            _ => rewritten,
        };
        text::write(&src.join(page), rewritten).map_err(one)?;
        made.chapters += usize::from(page != "SUMMARY.md");
    }
    problems.extend(missing_in_summary(&src).map_err(one)?);
    if problems.is_empty() { Ok(made) } else { Err(problems) }
}

/// The chapters of `book/src`, with directives and formulas replaced and pictures drawn.
fn own_chapters(
    place: &Place,
    src: &Path,
    made: &mut Assembled,
    problems: &mut Vec<String>,
) -> Result<Vec<Chapter>, String> {
    let (folder, mut asked, mut chapters) = (place.root.join("book/src"), Asked::default(), Vec::new());
    for path in text::files(&folder)? {
        let inside = path.strip_prefix(&folder).map_err(|error| error.to_string())?;
        let page = inside.to_string_lossy().replace('\\', "/");
        if !page.ends_with(".md") {
            return Err(format!("{}: only Markdown is expected in book/src", path.display()));
        }
        let file = format!("book/src/{page}");
        let mut complain = |error: String| {
            problems.push(format!("{file}: {error}"));
            String::new()
        };
        let source = text::read(&path)?;
        let up = "../".repeat(page.matches('/').count());
        let listed = text::map_prose(&source, |prose| {
            directives::replace(&place.root, prose, &up, &mut asked).unwrap_or_else(&mut complain)
        });
        let text =
            text::map_prose(&listed, |prose| math::replace(prose, &mut made.formulas).unwrap_or_else(&mut complain));
        for (number, script) in scripts(&text).enumerate() {
            let scratch = place.out.join("pictures").join(format!("{}-{number}", page.replace('/', "-")));
            for picture in commands::draw(place, &scratch, script)? {
                let name = picture.file_name().unwrap_or_default();
                let to = src.join(inside).with_file_name(name);
                let bytes = std::fs::read(&picture).map_err(|error| format!("{}: {error}", picture.display()))?;
                text::write(&to, bytes)?;
                made.pictures += 1;
            }
        }
        chapters.push(Chapter { file, page, text });
    }
    (made.robots, made.items) = (asked.robots, asked.items);
    Ok(chapters)
}

/// The blocks `sh,picture`.
fn scripts(text: &str) -> impl Iterator<Item = &str> {
    text::parts(text).into_iter().filter_map(|part| match part {
        Part::Code(code) => code.strip_prefix("```sh,picture\n")?.strip_suffix("```"),
        Part::Prose(_) => None,
    })
}

/// Chapters that nobody finds.
fn missing_in_summary(src: &Path) -> Result<Vec<String>, String> {
    let summary = text::read(&src.join("SUMMARY.md"))?;
    let mut missing = Vec::new();
    for path in text::files(src)? {
        let page = path.strip_prefix(src).map_err(|error| error.to_string())?.to_string_lossy().replace('\\', "/");
        if page.ends_with(".md") && page != "SUMMARY.md" && !summary.contains(&format!("]({page})")) {
            missing.push(format!("{page} is not in SUMMARY.md"));
        }
    }
    Ok(missing)
}
