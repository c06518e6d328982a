//! The files that `<include>`s name: a file or folder next to the file, or `model://NAME` in a folder above it.

use super::version::Version;
use crate::XacroArguments;
use crate::files;
use crate::report::finding::{Finding, Findings};
use crate::text::bytes::{self, MOST_BYTES};
use crate::text::context::Context;
use crate::text::dialect::Dialect;
use crate::text::source::Source;
use crate::text::syntax;
use crate::urdf::vocabulary::shown;
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// More files are refused.
const MOST_FILES: usize = 256;

/// Gazebo's own light and floor, which are no robots.
const OF_GAZEBO: [&str; 2] = ["model://sun", "model://ground_plane"];

/// Where files are searched, and texts that are read instead of files.
type Files<'f> = (Option<&'f Path>, &'f XacroArguments);

/// Reads the files that the first source includes, recursively. Returns the place of each `<include>` and the number of
/// its source; None, with a diagnostic, if something cannot be read.
pub(crate) fn gather(sources: &mut Vec<Source>, files: Files, cx: &mut Context) -> Option<BTreeMap<usize, usize>> {
    let (mut pages, mut known, mut next) = (BTreeMap::new(), HashMap::new(), 0);
    let mut folders: Vec<Option<PathBuf>> = vec![files.0.map(Path::to_path_buf)];
    let mut bytes = sources.first().map_or(0, |source| source.text.len());
    while let Some(source) = sources.get(next).cloned() {
        let includes = match includes_of(&source) {
            Ok(includes) => includes,
            Err(finding) => {
                cx.findings.add(finding);
                return None;
            }
        };
        for (place, span, uri) in includes.into_iter().filter(|(_, _, uri)| !OF_GAZEBO.contains(&uri.as_str())) {
            let error = |message: String| Finding::error("include", span.clone(), message).help(HELP);
            let path = match path(&uri, folders[next].as_deref(), files.1) {
                Ok(path) => path,
                Err(why) => {
                    cx.findings.add(error(format!("include: `{}` {why}", shown(&uri))));
                    continue;
                }
            };
            let real = path.canonicalize().unwrap_or_else(|_| path.clone());
            if let Some(&page) = known.get(&real) {
                pages.insert(place, page);
                continue;
            }
            let content = match files.1.text_of(&path) {
                Some(text) => Ok(text.into()),
                None => files::read(&real, MOST_BYTES as u64),
            };
            let content: Vec<u8> = match content {
                Ok(content) => content,
                Err(why) => {
                    cx.findings.add(error(format!("include: `{}` cannot be read: {why}", shown(&uri))));
                    continue;
                }
            };
            bytes += content.len();
            if sources.len() >= MOST_FILES || bytes > MOST_BYTES {
                let message = format!("include: more than {MOST_FILES} files or {MOST_BYTES} bytes, expected fewer");
                cx.findings.error("too_large", span, message);
                return None;
            }
            let base = sources.last().map_or(0, |last| last.base + last.text.len() + 1);
            let mut findings = Findings::default();
            let text = Source::new(&path.to_string_lossy(), bytes::read(&content, &mut findings)).at(base);
            if findings.has_errors() || Dialect::of(&text.text) != Dialect::Sdf {
                cx.findings
                    .add(error(format!("include: `{}` is not SDFormat, expected a file with <sdf>", shown(&uri))));
                continue;
            }
            let text = syntax::mended(text, Dialect::Sdf, &mut cx.findings);
            known.insert(real, sources.len());
            pages.insert(place, sources.len());
            folders.push(path.parent().map(Path::to_path_buf));
            sources.push(text);
        }
        next += 1;
    }
    (!cx.findings.has_errors()).then_some(pages)
}

const HELP: &str = "write the name of a file or folder next to this file, or model://NAME with the folder NAME beside or \
                    above it";

/// The place of each `<include>`'s name, that of its uri, and the uri.
fn includes_of(source: &Source) -> Result<Vec<(usize, Range<usize>, String)>, Finding> {
    if !source.text.contains("<include") {
        return Ok(Vec::new());
    }
    let document = syntax::parse(source, Dialect::Sdf)?;
    let is_include = |node: &roxmltree::Node| {
        node.has_tag_name("include")
            && node.parent().is_some_and(|up| up.has_tag_name("model") || up.has_tag_name("world"))
    };
    let includes = document.descendants().filter(is_include).map(|node| {
        let start = node.range().start + 1;
        let uri = node.children().find(|child| child.has_tag_name("uri"));
        let span = uri.map_or(start..start + "include".len(), |uri| uri.range());
        let text = uri.and_then(|uri| uri.text()).unwrap_or_default().trim().to_string();
        (source.place(start..start).start, source.place(span), text)
    });
    Ok(includes.collect())
}

/// The file of a uri, or why there is none.
fn path(uri: &str, folder: Option<&Path>, given: &XacroArguments) -> Result<PathBuf, String> {
    if uri.is_empty() {
        return Err("is empty, expected the <uri> of a file".to_string());
    }
    let folder = folder.ok_or("is relative to the model, which was not read from a file")?;
    let candidates: Vec<PathBuf> = match uri.split_once("://") {
        Some(("model" | "package", name)) => folder.ancestors().map(|above| above.join(name)).collect(),
        Some(("file", path)) => vec![folder.join(path)],
        Some(_) => return Err("is not on this machine, expected a file".to_string()),
        None if uri.starts_with(r"\\") || uri.starts_with("//") => {
            return Err("is not on this machine, expected a file".to_string());
        }
        None => vec![folder.join(uri)],
    };
    for path in &candidates {
        if given.text_of(path).is_some() || path.is_file() {
            return Ok(path.clone());
        }
        let model = path.join(configured(path).unwrap_or_else(|| "model.sdf".to_string()));
        if given.text_of(&model).is_some() || model.is_file() {
            return Ok(model);
        }
    }
    Err("cannot be read: there is no such file".to_string())
}

/// The file of the newest version that a folder's `model.config` names; of equal ones the last.
fn configured(folder: &Path) -> Option<String> {
    let text = files::read(&folder.join("model.config"), 1 << 16).ok()?;
    let text = String::from_utf8(text).ok()?;
    let document = roxmltree::Document::parse(&text).ok()?;
    let version = |node: &roxmltree::Node| node.attribute("version").and_then(Version::of);
    let files = document.descendants().filter(|node| node.has_tag_name("sdf"));
    let name = files.max_by_key(version)?.text()?.trim();
    // only a file of this folder
    (!name.contains(['/', '\\'])).then(|| name.to_string())
}
