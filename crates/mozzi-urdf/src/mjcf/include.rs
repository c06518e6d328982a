//! `<include>`: files whose content replaces the `<include>` that names them.

use super::Files;
use crate::files;
use crate::report::finding::{Finding, Findings};
use crate::text::bytes::{self, MOST_BYTES};
use crate::text::context::Context;
use crate::text::dialect::Dialect;
use crate::text::source::Source;
use crate::text::syntax;
use crate::urdf::vocabulary::shown;
use roxmltree::Node;
use std::collections::{BTreeMap, BTreeSet};
use std::io::ErrorKind;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// More files are refused.
pub(crate) const MOST_FILES: usize = 256;

/// An `<include>` or `<model>`: its place, its name's and its attribute's, and the file.
pub(crate) struct Include {
    what: &'static str,
    place: usize,
    pub span: Range<usize>,
    file: Option<String>,
}

impl Include {
    pub fn of(node: Node, source: &Source, what: &'static str) -> Self {
        let (start, file) = (node.range().start, node.attribute_node("file"));
        let name = start + 1..start + 1 + what.len();
        Include {
            what,
            place: source.base + start,
            span: source.place(file.map_or(name, |file| file.range_value())),
            file: file.map(|file| file.value().to_string()),
        }
    }
}

/// Reads the files that the first source includes, recursively. Returns the place of each `<include>` and the number of
/// its source; None, with a diagnostic, if something cannot be read.
pub(crate) fn gather(
    sources: &mut Vec<Source>,
    (folder, given): Files,
    cx: &mut Context,
) -> Option<BTreeMap<usize, usize>> {
    let (mut pages, mut known, mut next) = (BTreeMap::new(), BTreeSet::new(), 0);
    if let (Some(folder), Some(first)) = (folder, sources.first()) {
        let main = Path::new(&*first.name);
        known.extend(folder.join(main.file_name().unwrap_or_default()).canonicalize().ok());
    }
    let mut bytes = sources.first().map_or(0, |source| source.text.len());
    while let Some(source) = sources.get(next).cloned() {
        let includes = match includes_of(&source) {
            Ok(includes) => includes,
            Err(finding) => {
                cx.findings.add(finding);
                return None;
            }
        };
        // an included file's own includes may also be next to it
        let beside = Path::new(&*source.name).parent().filter(|_| next > 0).map(Path::to_path_buf);
        for include in includes {
            let base = sources.last().map_or(0, |last| last.base + last.text.len() + 1);
            match open(&include, (folder, given), beside.as_deref(), &mut known) {
                Ok((name, content)) if sources.len() < MOST_FILES && bytes + content.len() <= MOST_BYTES => {
                    bytes += content.len();
                    let mut findings = Findings::default();
                    let text = Source::new(&name, bytes::read(&content, &mut findings)).at(base);
                    let text = if Dialect::of(&text.text) == Dialect::Mjcf { text } else { text.hidden() };
                    let text = syntax::mended(text, Dialect::Mjcf, &mut cx.findings);
                    pages.insert(include.place, sources.len());
                    sources.push(text);
                    if findings.has_errors() {
                        findings.moved(base).for_each(|finding| cx.findings.add(finding));
                        return None;
                    }
                }
                Ok(_) => {
                    let message = format!(
                        "include: more than {MOST_FILES} files or {MOST_BYTES} bytes in total, expected at most these"
                    );
                    cx.findings.error("too_large", include.span, message);
                    return None;
                }
                Err(finding) => cx.findings.add(finding),
            }
        }
        next += 1;
    }
    (!cx.findings.has_errors()).then_some(pages)
}

/// The includes of one text.
fn includes_of(source: &Source) -> Result<Vec<Include>, Finding> {
    if !source.text.contains("<include") {
        return Ok(Vec::new());
    }
    let document = syntax::parse(source, Dialect::Mjcf)?;
    let is_include = |node: &Node| node.is_element() && node.has_tag_name("include");
    Ok(document.descendants().filter(is_include).map(|node| Include::of(node, source, "include")).collect())
}

/// The name and the content of a file.
pub(crate) fn open(
    include: &Include,
    (folder, given): Files,
    beside: Option<&Path>,
    known: &mut BTreeSet<PathBuf>,
) -> Result<(String, Vec<u8>), Finding> {
    let what = include.what;
    let error = |code, message: String| Finding::error(code, include.span.clone(), message);
    let Some(file) = include.file.as_deref().filter(|file| !file.is_empty()) else {
        return Err(error("missing_attribute", format!("{what}: has no attribute `file`")));
    };
    let shown = shown(file);
    let Some(folder) = folder else {
        return Err(error(
            "include",
            format!("{what}: `{shown}` is relative to the model, which was not read from a file"),
        )
        .help("read the model from its file"));
    };
    if file.contains("://") || file.starts_with(r"\\") || file.starts_with("//") {
        return Err(error("include", format!("{what}: `{shown}` is not on this machine, expected a file")));
    }
    let is_there = |path: &PathBuf| given.text_of(path).is_some() || path.is_file();
    let path = folder.join(file);
    let other = beside.map(|beside| beside.join(file)).filter(|other| !is_there(&path) && is_there(other));
    let path = other.unwrap_or(path);
    let text = given.text_of(&path);
    let fails = |why: String| {
        error("include", format!("{what}: `{shown}` cannot be read: {why}"))
            .help("files are searched in the folder of the main file, then next to the file that includes them")
    };
    let real = match (path.canonicalize(), text) {
        (Ok(real), _) if text.is_some() || real.is_file() => real,
        (Ok(_), _) => return Err(fails("it is not a file".to_string())),
        (Err(_), Some(_)) => path.clone(),
        // WebAssembly has no files but the given ones
        (Err(why), None) if why.kind() == ErrorKind::Unsupported => {
            return Err(fails("it is not among the files".to_string()));
        }
        (Err(why), None) => return Err(fails(why.to_string())),
    };
    if !known.insert(real.clone()) {
        return Err(error(
            "repeated_include",
            format!("include: `{shown}` is already included, expected at most once"),
        )
        .help("include each file once"));
    }
    let name = path.to_string_lossy().into_owned();
    if let Some(text) = text {
        return Ok((name, text.into()));
    }
    let content = files::read(&real, MOST_BYTES as u64).map_err(|why| fails(why.to_string()))?;
    Ok((name, content))
}
