//! An element of the text: its attributes as words and numbers, its children by name, each misuse reported at its place.

use crate::context::{Context, Unknown};
use crate::finding::Finding;
use crate::number::{NotNumbers, numbers};
use crate::words::{Vocabulary, shown};
use roxmltree::{Attribute, Node};
use std::collections::BTreeMap;
use std::ops::Range;

/// Longer names are refused.
const LONGEST_NAME: usize = 256;

/// An element, and how messages call it: "joint `elbow`: origin".
#[derive(Clone)]
pub(crate) struct Element<'a> {
    node: Node<'a, 'a>,
    text: &'a str,
    pub subject: String,
}

/// An attribute's value and where it stands.
#[derive(Clone, Debug)]
pub(crate) struct Value<'a> {
    pub text: &'a str,
    pub span: Range<usize>,
}

/// The children of an element that may stand once.
pub(crate) type Children<'a> = BTreeMap<&'static str, Element<'a>>;

impl<'a> Element<'a> {
    pub fn new(node: Node<'a, 'a>, text: &'a str, subject: String) -> Self {
        Element { node, text, subject }
    }

    /// The same, called otherwise.
    pub fn called(&self, subject: impl Into<String>) -> Self {
        Element { subject: subject.into(), ..self.clone() }
    }

    /// The name as written, with its prefix.
    pub fn written_name(&self) -> &'a str {
        &self.text[self.span()]
    }

    /// The name without prefix.
    pub fn name(&self) -> &'a str {
        self.node.tag_name().name()
    }

    /// The place of the name in the start tag.
    pub fn span(&self) -> Range<usize> {
        let start = self.node.range().start + 1;
        let rest = self.text.get(start..).unwrap_or_default();
        let ends = |c: char| c.is_ascii_whitespace() || matches!(c, '/' | '>');
        start..start + rest.find(ends).unwrap_or(rest.len())
    }

    /// A child, called after this element.
    fn child(&self, node: Node<'a, 'a>) -> Element<'a> {
        let subject = format!("{}: {}", self.subject, shown(node.tag_name().name()));
        Element { node, text: self.text, subject }
    }

    /// All children that are elements.
    pub fn elements(&self) -> impl Iterator<Item = Element<'a>> {
        self.node.children().filter(Node::is_element).map(|node| self.child(node))
    }

    /// An attribute, if it is there.
    pub fn attribute(&self, name: &str) -> Option<Value<'a>> {
        let found = self.node.attributes().find(|attribute| attribute.name() == name && !self.is_foreign(attribute))?;
        Some(Value { text: found.value(), span: found.range_value() })
    }

    /// An attribute that has to be there.
    pub fn required(&self, name: &str, cx: &mut Context) -> Option<Value<'a>> {
        let value = self.attribute(name);
        if value.is_none() {
            let message = format!("{}: has no attribute `{name}`", self.subject);
            let help = (!self.node.text().unwrap_or_default().trim().is_empty()).then(|| {
                format!(
                    "values stand in attributes: <{} {name}=\"{}\"/>",
                    self.name(),
                    shown(self.node.text().unwrap_or_default().trim())
                )
            });
            cx.findings.add(Finding::error("missing_attribute", self.span(), message).maybe_help(help));
        }
        value
    }

    /// A name that has to be there, and is not endless: names are repeated in messages.
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

    /// N numbers of an attribute; None, and reported, when they are not.
    pub fn vector<const N: usize>(&self, name: &str, value: &Value<'a>, cx: &mut Context) -> Option<[f64; N]> {
        let error = match numbers::<N>(value.text) {
            Ok(vector) => return Some(vector),
            Err(error) => error,
        };
        let subject = &self.subject;
        cx.findings.add(match error {
            NotNumbers::Count { found, expected } => {
                let is_comma = value.text.contains(',');
                let message =
                    format!("{subject}: {name}: `{}` has {found} numbers, expected {expected}", shown(value.text));
                let help = is_comma.then(|| "numbers are separated by spaces".to_string());
                Finding::error("wrong_count", value.span.clone(), message).maybe_help(help)
            }
            NotNumbers::Word { span, word, why } => {
                // the word's own place, unless an entity shifts what follows it
                let is_raw = self.text.get(value.span.clone()) == Some(value.text) && !span.is_empty();
                let at = if is_raw {
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
        None
    }

    /// The number of an attribute, if it is there and is one.
    pub fn number(&self, name: &str, cx: &mut Context) -> Option<f64> {
        let value = self.attribute(name)?;
        self.vector::<1>(name, &value, cx).map(|[x]| x)
    }

    /// Reports attributes that are not known: a near miss is an error, others a warning once per kind.
    pub fn check_attributes(&self, words: &Vocabulary, cx: &mut Context) {
        for attribute in self.node.attributes().filter(|attribute| !self.is_foreign(attribute)) {
            let name = attribute.name();
            if words.attributes.contains(&name) || words.silent.contains(&name) {
                continue;
            }
            let (subject, span) = (&self.subject, attribute.range_qname());
            let message = format!("{subject}: has an attribute `{}`, which URDF does not know", shown(name));
            match cx.unknown(self.name(), name, "attribute", words.attributes.iter().copied()) {
                Unknown::Misspelled(help) => {
                    cx.findings.add(Finding::error("misspelled_attribute", span, message).help(help));
                }
                Unknown::First => {
                    let known = crate::words::list(words.attributes);
                    let name = self.name();
                    let help = format!("it is ignored here and wherever it stands on <{name}>; known are {known}");
                    cx.findings.add(Finding::warning("unknown_attribute", span, message).help(help));
                }
                Unknown::Again => {}
            }
        }
    }

    /// The children that may stand once, by name. Duplicates are errors; so are near misses of words; other unknown
    /// elements and stray text are warnings once per kind.
    pub fn check_children(&self, words: &Vocabulary, cx: &mut Context) -> Children<'a> {
        let mut children = Children::new();
        for node in self.node.children() {
            if node.is_text() {
                self.check_text(node, cx);
            }
            if !node.is_element() {
                continue;
            }
            let child = self.child(node);
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

    /// Reports a name that is not known in the parent.
    fn check_name(&self, parent: &Element<'a>, words: &Vocabulary, cx: &mut Context) {
        if self.has_prefix() {
            if self.node.tag_name().namespace().is_some_and(|space| space.ends_with("/xacro")) {
                let message = format!("{}: has <{}>, a xacro macro", parent.subject, shown(self.written_name()));
                let help = "expand the file first: `xacro robot.xacro > robot.urdf`";
                cx.findings.add(Finding::error("xacro", self.span(), message).help(help));
            }
            return;
        }
        let name = self.name();
        if words.many.contains(&name) || words.silent.contains(&name) {
            return;
        }
        let message = format!("{}: has an element <{}>, which URDF does not know here", parent.subject, shown(name));
        let known = words.once.iter().chain(words.many).copied();
        match cx.unknown(parent.name(), name, "element", known) {
            Unknown::Misspelled(help) => {
                cx.findings.add(Finding::error("misspelled_element", self.span(), message).help(help));
            }
            Unknown::First => {
                let help = format!("it is ignored here and wherever it stands in <{}>", parent.name());
                cx.findings.add(Finding::warning("unknown_element", self.span(), message).help(help));
            }
            Unknown::Again => {}
        }
    }

    fn check_text(&self, node: Node<'a, 'a>, cx: &mut Context) {
        let text = node.text().unwrap_or_default();
        if !text.trim().is_empty() && matches!(cx.unknown(self.name(), "", "text", []), Unknown::First) {
            let raw = &self.text[node.range()];
            let start = node.range().start + raw.len() - raw.trim_start().len();
            let message = format!("{}: has the text `{}`, expected only elements", self.subject, shown(text.trim()));
            let help = format!("it is ignored here and wherever text stands in <{}>", self.name());
            let span = start..start + raw.trim().len();
            cx.findings.add(Finding::warning("stray_text", span, message).help(help));
        }
    }

    /// Does the name have a prefix of a namespace?
    pub fn has_prefix(&self) -> bool {
        self.written_name().contains(':')
    }

    fn is_foreign(&self, attribute: &Attribute) -> bool {
        self.text.get(attribute.range_qname()).is_some_and(|name| name.contains(':'))
    }
}
