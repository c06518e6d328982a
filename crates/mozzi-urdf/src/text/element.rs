//! An element of the text: its attributes as words and numbers, its children by name, each error reported at its place.

use crate::report::finding::Finding;
use crate::report::spelling::{counted, meant};
use crate::text::context::{Context, Unknown};
use crate::text::number::{NotNumbers, numbers};
use crate::text::pages::Pages;
use crate::urdf::extension;
use crate::urdf::vocabulary::{Vocabulary, shown};
use roxmltree::{Attribute, Node};
use std::collections::BTreeMap;
use std::ops::Range;

/// Longer names are refused.
const LONGEST_NAME: usize = 256;

/// An element, and its name in messages: "joint `elbow`: origin".
#[derive(Clone)]
pub(crate) struct Element<'a> {
    node: Node<'a, 'a>,
    pages: &'a Pages<'a>,
    page: usize,
    pub subject: String,
}

/// An attribute's value and its place.
#[derive(Clone, Debug)]
pub(crate) struct Value<'a> {
    pub text: &'a str,
    pub span: Range<usize>,
}

/// The children of an element that may occur once.
pub(crate) type Children<'a> = BTreeMap<&'static str, Element<'a>>;

impl<'a> Element<'a> {
    /// The root of the first text.
    pub fn root(pages: &'a Pages<'a>, subject: &str) -> Option<Self> {
        Element::root_of(pages, 0, subject)
    }

    /// The root of one of the texts.
    pub fn root_of(pages: &'a Pages<'a>, page: usize, subject: &str) -> Option<Self> {
        Some(Element { node: pages.root_of(page)?, pages, page, subject: subject.to_string() })
    }

    /// Changes the name of the element in messages.
    pub fn called(&self, subject: impl Into<String>) -> Self {
        Element { subject: subject.into(), ..self.clone() }
    }

    /// The number of its text.
    pub fn page(&self) -> usize {
        self.page
    }

    /// True if it is in a part of another model.
    pub fn is_attached(&self) -> bool {
        self.pages.source(self.page).is_attached
    }

    /// The name as written, with its prefix.
    pub fn written_name(&self) -> &'a str {
        self.raw(&self.span())
    }

    fn raw(&self, span: &Range<usize>) -> &'a str {
        self.pages.text(span).unwrap_or_default()
    }

    /// Converts a place in this element's text to its place among all texts.
    fn place(&self, span: Range<usize>) -> Range<usize> {
        self.pages.source(self.page).place(span)
    }

    /// The name without prefix.
    pub fn name(&self) -> &'a str {
        self.node.tag_name().name()
    }

    /// The text inside, up to the first child.
    pub fn text(&self) -> &'a str {
        self.node.text().unwrap_or_default()
    }

    /// The text inside without white space around it, and its place; the name's place if there is none.
    pub fn content(&self) -> Value<'a> {
        let text =
            self.node.children().find(|node| node.is_text() && !node.text().unwrap_or_default().trim().is_empty());
        let Some(node) = text else { return Value { text: "", span: self.span() } };
        let raw = self.place(node.range());
        let written = self.raw(&raw);
        let start = raw.start + written.len() - written.trim_start().len();
        Value { text: node.text().unwrap_or_default().trim(), span: start..start + written.trim().len() }
    }

    /// The place of the name in the start tag.
    pub fn span(&self) -> Range<usize> {
        let start = self.node.range().start + 1;
        let rest = self.pages.source(self.page).text.get(start..).unwrap_or_default();
        let ends = |c: char| c.is_ascii_whitespace() || matches!(c, '/' | '>');
        self.place(start..start + rest.find(ends).unwrap_or(rest.len()))
    }

    /// A child, named after this element in messages.
    fn child(&self, node: Node<'a, 'a>, page: usize) -> Element<'a> {
        let subject = format!("{}: {}", self.subject, shown(node.tag_name().name()));
        Element { node, pages: self.pages, page, subject }
    }

    /// All children, and their pages.
    fn children(&self) -> impl Iterator<Item = (Node<'a, 'a>, usize)> + use<'a> {
        self.pages.children(self.node, self.page)
    }

    /// All children that are elements.
    pub fn elements(&self) -> impl Iterator<Item = Element<'a>> {
        self.children().filter(|(node, _)| node.is_element()).map(|(node, page)| self.child(node, page))
    }

    /// An attribute, if it is there.
    pub fn attribute(&self, name: &str) -> Option<Value<'a>> {
        let found = self.node.attributes().find(|attribute| attribute.name() == name && !self.is_foreign(attribute))?;
        Some(Value { text: found.value(), span: self.place(found.range_value()) })
    }

    /// A required attribute.
    pub fn required(&self, name: &str, cx: &mut Context) -> Option<Value<'a>> {
        let value = self.attribute(name);
        if value.is_none() {
            let message = format!("{}: has no attribute `{name}`", self.subject);
            let help = (!self.text().trim().is_empty())
                .then(|| format!("values are attributes: <{} {name}=\"{}\"/>", self.name(), shown(self.text().trim())));
            cx.findings.add(Finding::error("missing_attribute", self.span(), message).maybe_help(help));
        }
        value
    }

    /// A required name of bounded length: names are repeated in messages.
    pub fn required_name(&self, attribute: &str, cx: &mut Context) -> Option<Value<'a>> {
        let value = self.required(attribute, cx)?;
        if value.text.len() <= LONGEST_NAME {
            return Some(value);
        }
        let found = value.text.len();
        let message = format!("{}: {attribute}: has {found} bytes, expected at most {LONGEST_NAME}", self.subject);
        cx.findings.error("long_name", value.span, message);
        None
    }

    /// N numbers of an attribute; None, with a diagnostic, if they are invalid.
    pub fn vector<const N: usize>(&self, name: &str, value: &Value<'a>, cx: &mut Context) -> Option<[f64; N]> {
        match numbers::<N>(value.text) {
            Ok(vector) => Some(vector),
            Err(error) => {
                self.report_numbers(name, value, error, cx);
                None
            }
        }
    }

    /// Reports why a value is not the expected numbers.
    pub fn report_numbers(&self, name: &str, value: &Value<'a>, error: NotNumbers, cx: &mut Context) {
        let subject = &self.subject;
        cx.findings.add(match error {
            NotNumbers::Count { found, expected } => {
                let is_comma = value.text.contains(',');
                let (given, found) = (shown(value.text), counted(found, "number"));
                let message = format!("{subject}: {name}: `{given}` has {found}, expected {expected}");
                let help = is_comma.then(|| "separate numbers by spaces".to_string());
                Finding::error("wrong_count", value.span.clone(), message).maybe_help(help)
            }
            NotNumbers::Word { span, word, why } => {
                // the word's own place, unless an entity shifts the text after it; a line break is read as a space
                let as_read = |byte| if matches!(byte, b'\n' | b'\t') { b' ' } else { byte };
                let raw = self.pages.text(&value.span).unwrap_or_default();
                let at = if raw.bytes().map(as_read).eq(value.text.bytes()) && !span.is_empty() {
                    value.span.start + span.start..value.span.start + span.end
                } else {
                    value.span.clone()
                };
                let message = match word.as_str() {
                    "" => format!("{subject}: {name}: is empty, expected {why}"),
                    word => format!("{subject}: {name}: is `{word}`, expected {why}"),
                };
                Finding::error(why.code(), at, message).maybe_help(why.help().map(str::to_string))
            }
        });
    }

    /// The number of an attribute, if it is given and valid.
    pub fn number(&self, name: &str, cx: &mut Context) -> Option<f64> {
        let value = self.attribute(name)?;
        self.vector::<1>(name, &value, cx).map(|[x]| x)
    }

    /// Reports unknown attributes: a near miss is an error, others a warning once per kind.
    pub fn check_attributes(&self, words: &Vocabulary, cx: &mut Context) {
        for attribute in self.node.attributes() {
            let name = attribute.name();
            if self.is_foreign(&attribute) {
                let span = self.place(attribute.range_qname());
                extension::attribute(self, self.raw(&span), span, cx);
                continue;
            }
            if words.attributes.contains(&name) || words.silent.contains(&name) {
                continue;
            }
            let (subject, span) = (&self.subject, self.place(attribute.range_qname()));
            if let Some(known) = words.listed.iter().find(|&&known| known == name) {
                cx.leave_out(self.name(), known, span);
                continue;
            }
            let language = cx.dialect.name();
            let message = format!("{subject}: has an attribute `{}`, which {language} does not define", shown(name));
            match cx.unknown(self.name(), name, "attribute", words.attributes.iter().copied()) {
                // the two halves of a symmetric matrix
                Unknown::Misspelled(near) if self.contradicts(name, &near) => {
                    let message = format!("{message}, with another value than `{near}`");
                    let help = format!("the inertia is symmetric: remove `{}`, or correct one of them", shown(name));
                    cx.findings.add(Finding::error("contradictory_attribute", span, message).help(help));
                }
                // nothing is lost if the right word is given as well: `k_velocity` next to `velocity`
                Unknown::Misspelled(near) if self.attribute(&near).is_some() => {
                    let message = format!("{message}, next to `{near}`");
                    let help = format!("it is ignored, and `{near}` is used");
                    cx.findings.add(Finding::warning("redundant_attribute", span, message).help(help));
                }
                Unknown::Misspelled(near) => {
                    cx.findings.add(Finding::error("misspelled_attribute", span, message).help(meant(&near)));
                }
                Unknown::First => {
                    let known = crate::urdf::vocabulary::list(words.attributes);
                    let name = self.name();
                    let help = format!("it is ignored here and elsewhere on <{name}>; known attributes are {known}");
                    cx.findings.add(Finding::warning("unknown_attribute", span, message).help(help));
                }
                Unknown::Again => {}
            }
        }
    }

    /// True if `name` is the transposed entry of `near`, such as `iyx` of `ixy`, with a different number.
    fn contradicts(&self, name: &str, near: &str) -> bool {
        let transposed: String = ["i", near.get(2..3).unwrap_or_default(), near.get(1..2).unwrap_or_default()].concat();
        let value = |name: &str| self.attribute(name).map(|value| numbers::<1>(value.text).ok());
        near.len() == 3 && name == transposed && value(name) != value(near)
    }

    /// The children that may occur once, by name. Duplicates and probable misspellings are errors; other unknown
    /// elements and stray text are warnings once per kind.
    pub fn check_children(&self, words: &Vocabulary, cx: &mut Context) -> Children<'a> {
        let mut children = Children::new();
        for (node, page) in self.children() {
            if node.is_text() {
                self.child(node, page).check_text(self, cx);
            }
            if !node.is_element() {
                continue;
            }
            let child = self.child(node, page);
            if let Some(&name) = words.once.iter().find(|&&known| known == child.name() && !child.has_prefix()) {
                if children.contains_key(name) {
                    let message = format!("{}: has a second <{name}>, expected one", self.subject);
                    cx.findings.error("duplicate_element", child.span(), message);
                } else {
                    children.insert(name, child);
                }
            } else {
                child.check_name(self, words, cx);
            }
        }
        children
    }

    /// Reports an unknown name in the parent.
    fn check_name(&self, parent: &Element<'a>, words: &Vocabulary, cx: &mut Context) {
        if self.has_prefix() {
            return extension::element(self, parent, cx);
        }
        let name = self.name();
        if words.many.contains(&name) || words.silent.contains(&name) {
            return extension::settings(self, cx);
        }
        let (language, subject) = (cx.dialect.name(), &parent.subject);
        let message = format!("{subject}: has an element <{}>, which {language} does not define here", shown(name));
        let known = words.once.iter().chain(words.many).copied();
        match cx.unknown(parent.name(), name, "element", known) {
            Unknown::Misspelled(near) => {
                cx.findings.add(Finding::error("misspelled_element", self.span(), message).help(meant(&near)));
            }
            Unknown::First => {
                let help = format!("it is ignored here and elsewhere in <{}>", parent.name());
                cx.findings.add(Finding::warning("unknown_element", self.span(), message).help(help));
            }
            Unknown::Again => {}
        }
    }

    /// Reports text in the parent other than white space.
    fn check_text(&self, parent: &Element<'a>, cx: &mut Context) {
        let text = self.text();
        if !text.trim().is_empty() && matches!(cx.unknown(parent.name(), "", "text", []), Unknown::First) {
            let place = self.place(self.node.range());
            let raw = self.raw(&place);
            let start = place.start + raw.len() - raw.trim_start().len();
            let message = format!("{}: has the text `{}`, expected only elements", parent.subject, shown(text.trim()));
            let help = format!("it is ignored here and elsewhere in <{}>", parent.name());
            let span = start..start + raw.trim().len();
            cx.findings.add(Finding::warning("stray_text", span, message).help(help));
        }
    }

    /// True if the name has a namespace prefix.
    pub fn has_prefix(&self) -> bool {
        self.written_name().contains(':')
    }

    fn is_foreign(&self, attribute: &Attribute) -> bool {
        self.raw(&self.place(attribute.range_qname())).contains(':')
    }
}
