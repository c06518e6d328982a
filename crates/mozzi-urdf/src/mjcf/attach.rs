//! `<attach>`: a body or frame of another model, or the contents of its world, with a prefix before all names. The
//! other model is a file that `<model>` of `<asset>` names; its own `<compiler>` and classes hold for its parts.

use super::Files;
use super::include::{self, Include, MOST_FILES};
use super::part::{Part, Wanted};
use super::vocabulary;
use crate::report::finding::{Finding, Findings};
use crate::report::spelling::did_you_mean;
use crate::text::bytes::{self, MOST_BYTES};
use crate::text::context::Context;
use crate::text::dialect::Dialect;
use crate::text::source::Source;
use crate::text::syntax;
use crate::urdf::vocabulary::{list, shown};
use roxmltree::Node;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::Path;

/// The texts that were added for all `<attach>`.
#[derive(Default)]
pub(crate) struct Attached {
    /// The place of each `<attach>`, and the number of the source that replaces it.
    pub places: BTreeMap<usize, usize>,
    /// The sources whose sections follow those of the model: assets, defaults, equalities, tendons and actuators.
    pub sections: Vec<usize>,
    /// The sources of parts, each with the source of the whole model, whose `<compiler>` holds.
    pub wholes: BTreeMap<usize, usize>,
}

/// An `<attach>` as written.
struct Attach {
    place: usize,
    span: Range<usize>,
    model: String,
    /// `body` or `frame`, and its name.
    root: Option<(&'static str, String)>,
    prefix: String,
}

/// Reads the models of which parts are attached, and adds the parts to the sources; None, with a diagnostic, if that
/// fails.
pub(crate) fn expand(sources: &mut Vec<Source>, files: Files, cx: &mut Context) -> Option<Attached> {
    let mut attached = Attached::default();
    if !sources.iter().any(|source| source.text.contains("<attach")) {
        return Some(attached);
    }
    let (mut models, mut places) = (Vec::new(), Vec::new());
    for source in &*sources {
        match syntax::parse(source, Dialect::Mjcf) {
            Ok(document) => document.descendants().for_each(|node| note(node, source, (&mut models, &mut places), cx)),
            Err(finding) => {
                cx.findings.add(finding);
                return None;
            }
        }
    }
    let mut read: BTreeMap<String, usize> = BTreeMap::new();
    for (name, model) in models {
        let opened = open(&model, files, sources, cx).and_then(|source| Ok((name_of(name, &source)?, source)));
        match opened {
            Ok((name, source)) => {
                read.entry(name).or_insert(sources.len()); // the first of several, as in MuJoCo
                sources.push(source);
            }
            Err(finding) => cx.findings.add(finding),
        }
    }
    for attach in places {
        let added = match read.get(&attach.model) {
            Some(&whole) => add(&attach, whole, sources, files, &mut attached),
            None => Err(unknown(&attach, &read)),
        };
        if let Err(finding) = added {
            cx.findings.add(finding);
        }
    }
    (!cx.findings.has_errors()).then_some(attached)
}

/// The place of the next source.
fn after(sources: &[Source]) -> usize {
    sources.last().map_or(0, |last| last.base + last.text.len() + 1)
}

/// Notes an element if it is a model of `<asset>` or an `<attach>`.
fn note(
    node: Node,
    source: &Source,
    (models, places): (&mut Vec<(Option<String>, Include)>, &mut Vec<Attach>),
    cx: &mut Context,
) {
    let is_in = |name| node.parent_element().is_some_and(|parent| parent.has_tag_name(name));
    let text = |name: &str| node.attribute(name).unwrap_or_default().to_string();
    if node.has_tag_name("model") && is_in("asset") {
        let name = node.attribute("name").map(str::to_string);
        models.push((name, Include::of(node, source, "model")));
    } else if node.has_tag_name("attach") {
        let start = node.range().start;
        for attribute in node.attributes().filter(|one| !vocabulary::ATTACH.attributes.contains(&one.name())) {
            let known = list(vocabulary::ATTACH.attributes);
            let message = format!("attach: has an attribute `{}`, expected one of {known}", shown(attribute.name()));
            cx.findings.error("misspelled_attribute", source.place(attribute.range_qname()), message);
        }
        let named = ["body", "frame"].map(|tag| node.attribute(tag).map(|name| (tag, name.to_string())));
        if let [Some(_), Some(_)] = named {
            let span = source.place(node.range());
            let message = "attach: has a `body` and a `frame`, expected at most one of them";
            let help = "keep the one that you mean: a frame is attached with its pose and all that is in it";
            cx.findings.add(Finding::error("contradictory_attribute", span, message).help(help));
        }
        let is_world = |(tag, name): &(&str, String)| *tag == "body" && (name.is_empty() || name == "world");
        places.push(Attach {
            place: source.base + start,
            span: source.place(start + 1..start + 1 + "attach".len()),
            model: text("model"),
            root: named.into_iter().flatten().find(|named| !is_world(named)),
            prefix: text("prefix"),
        });
    }
}

/// A model's own name, or the one in its file.
fn name_of(given: Option<String>, source: &Source) -> Result<String, Finding> {
    match given {
        Some(name) => Ok(name),
        None => {
            let document = syntax::parse(source, Dialect::Mjcf)?;
            Ok(document.root_element().attribute("model").unwrap_or("MuJoCo Model").to_string())
        }
    }
}

fn unknown(attach: &Attach, read: &BTreeMap<String, usize>) -> Finding {
    let message = format!("attach: model: there is no model `{}` in <asset>", shown(&attach.model));
    let known: Vec<&str> = read.keys().map(String::as_str).collect();
    let names = || format!("a <model> without `name` has the name in its file; the models are {}", list(&known));
    let help = did_you_mean(&attach.model, known.iter().copied()).or_else(|| Some(names()));
    Finding::error("unknown_word", attach.span.clone(), message).maybe_help(help)
}

/// The text of a model.
fn open(model: &Include, files: Files, sources: &[Source], cx: &mut Context) -> Result<Source, Finding> {
    let (name, content) = include::open(model, files, None, &mut BTreeSet::new())?;
    has_room(sources, content.len(), "model", &model.span)?;
    let (base, mut findings) = (after(sources), Findings::default());
    let text = Source::new(&name, bytes::read(&content, &mut findings)).at(base);
    let text = if Dialect::of(&text.text) == Dialect::Mjcf { text } else { text.hidden() };
    let text = syntax::mended(text, Dialect::Mjcf, &mut cx.findings);
    match findings.moved(base).next() {
        Some(finding) => Err(finding),
        None => Ok(text),
    }
}

/// An error if a text of this length is too much beside the others.
fn has_room(sources: &[Source], length: usize, what: &str, span: &Range<usize>) -> Result<(), Finding> {
    let total: usize = sources.iter().map(|source| source.text.len()).sum();
    if sources.len() < MOST_FILES && total + length <= MOST_BYTES {
        return Ok(());
    }
    let message =
        format!("{what}: more than {MOST_FILES} files or {MOST_BYTES} bytes in total, expected at most these");
    Err(Finding::error("too_large", span.clone(), message))
}

/// Adds what replaces the `<attach>`, and the sections that belong to it.
fn add(
    attach: &Attach,
    whole: usize,
    sources: &mut Vec<Source>,
    (folder, _): Files,
    attached: &mut Attached,
) -> Result<(), Finding> {
    let source = sources[whole].clone();
    let document = syntax::parse(&source, Dialect::Mjcf)?;
    let fails = |code, message: String| Finding::error(code, attach.span.clone(), message);
    let root = document.root_element();
    if !root.has_tag_name("mujoco") {
        let found = shown(root.tag_name().name());
        return Err(fails(
            "wrong_root",
            format!("attach: the root element of its model is <{found}>, expected <mujoco>"),
        ));
    }
    for name in ["include", "attach"] {
        if root.descendants().any(|node| node.has_tag_name(name)) {
            let message = format!("attach: its model has <{name}>, which mozzi does not expand there");
            let help = "let MuJoCo expand it: load the model there and save it as XML";
            return Err(fails("unsupported_element", message).help(help));
        }
    }
    let file = Path::new(&*source.name);
    let beside = folder.and_then(|folder| file.parent()?.strip_prefix(folder).ok());
    let folder = beside.or_else(|| file.parent()).unwrap_or(Path::new("")).to_path_buf();
    let wanted =
        Wanted { root: attach.root.as_ref().map(|(tag, name)| (*tag, &**name)), prefix: &attach.prefix, folder };
    let part =
        Part::of(&document, &source.text, &wanted).map_err(|why| fails("unknown_word", format!("attach: {why}")))?;
    for (text, is_section) in [(part.bodies, false), (part.sections, true)] {
        has_room(sources, text.len(), "attach", &attach.span)?;
        let k = sources.len();
        let mut text = Source::new(&source.name, &text).at(after(sources)).attached();
        text.is_shown = source.is_shown;
        sources.push(text);
        attached.wholes.insert(k, whole);
        if is_section {
            attached.sections.push(k);
        } else {
            attached.places.insert(attach.place, k);
        }
    }
    Ok(())
}
