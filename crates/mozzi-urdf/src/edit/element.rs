//! Elements of a text, and replacements of parts of it.

use roxmltree::Node;
use std::ops::Range;

/// An element and the text that it is in.
#[derive(Clone, Copy)]
pub(crate) struct Tag<'a> {
    pub node: Node<'a, 'a>,
    pub text: &'a str,
}

impl<'a> Tag<'a> {
    pub fn new(node: Node<'a, 'a>, text: &'a str) -> Self {
        Tag { node, text }
    }

    /// The name as written, with its prefix.
    pub fn name(self) -> &'a str {
        let rest = self.text.get(self.node.range().start + 1..).unwrap_or_default();
        rest.split(|c: char| c.is_ascii_whitespace() || matches!(c, '/' | '>')).next().unwrap_or_default()
    }

    pub fn children(self) -> impl Iterator<Item = Tag<'a>> {
        self.node.children().filter(Node::is_element).map(move |node| Tag { node, text: self.text })
    }

    pub fn child(self, name: &str) -> Option<Tag<'a>> {
        self.children().find(|tag| tag.name() == name)
    }

    /// The child with this element name and this `name` attribute.
    pub fn named(self, element: &str, name: &str) -> Option<Tag<'a>> {
        self.children().find(|tag| tag.name() == element && tag.node.attribute("name") == Some(name))
    }

    pub fn attribute(self, name: &str) -> Option<&'a str> {
        self.node.attribute(name)
    }

    /// The white space before an element from the last end of line on; `None` if other text is on its line.
    fn indentation(self) -> Option<&'a str> {
        let before = self.text.get(..self.node.range().start)?;
        let line = &before[before.rfind('\n')? + 1..];
        line.chars().all(|c| matches!(c, ' ' | '\t')).then_some(line)
    }

    fn is_empty_tag(self) -> bool {
        self.text.get(self.node.range()).is_some_and(|text| text.ends_with("/>"))
    }

    /// The start of the children of an element with an end tag.
    fn inside(self) -> usize {
        let Range { start, end } = self.node.range();
        let end_tag = || self.text.get(start..end).and_then(|text| text.rfind("</")).map_or(end, |at| start + at);
        self.node.first_child().map_or_else(end_tag, |child| child.range().start)
    }
}

/// A change of an element.
#[derive(Clone)]
pub(crate) enum Change<'a> {
    /// An attribute's value; `None` removes it with the white space before it.
    Set(Tag<'a>, String, Option<String>),
    /// The element, and its line if nothing else is on it.
    Remove(Tag<'a>),
    /// An element or comment before the first child.
    First(Tag<'a>, String),
    /// Elements after the last child.
    Last(Tag<'a>, Vec<String>),
    /// A comment before an element, on a line of its own.
    Before(Tag<'a>, String),
}

impl Change<'_> {
    /// Whether both set the same attribute, or insert at the same end.
    pub fn is_of_same_kind(&self, other: &Change<'_>) -> bool {
        match (self, other) {
            (Change::Set(_, a, _), Change::Set(_, b, _)) => a == b,
            _ => std::mem::discriminant(self) == std::mem::discriminant(other),
        }
    }

    /// Whether both have the same content.
    pub fn is_same(&self, other: &Change<'_>) -> bool {
        match (self, other) {
            (Change::Set(_, a, x), Change::Set(_, b, y)) => (a, x) == (b, y),
            (Change::First(_, a), Change::First(_, b)) | (Change::Before(_, a), Change::Before(_, b)) => a == b,
            (Change::Last(_, a), Change::Last(_, b)) => a == b,
            (Change::Remove(_), Change::Remove(_)) => true,
            _ => false,
        }
    }
}

/// Changes of a text.
pub(crate) struct Editor<'a> {
    text: &'a str,
    pub changes: Vec<Change<'a>>,
}

/// A part of a text and what replaces it.
pub(crate) type Replacement = (Range<usize>, String);

impl<'a> Editor<'a> {
    pub fn new(text: &'a str) -> Self {
        Editor { text, changes: Vec::new() }
    }

    /// Sets an attribute; `None` removes it with the white space before it.
    pub fn set(&mut self, tag: Tag<'a>, name: &str, value: Option<&str>) {
        if value.is_some() || tag.attribute(name).is_some() {
            self.changes.push(Change::Set(tag, name.to_string(), value.map(str::to_string)));
        }
    }

    /// Removes an element, and its line if nothing else is on it.
    pub fn remove(&mut self, tag: Tag<'a>) {
        self.changes.push(Change::Remove(tag));
    }

    /// Inserts an element before the first child.
    pub fn insert_first(&mut self, parent: Tag<'a>, element: &str) {
        self.changes.push(Change::First(parent, element.to_string()));
    }

    /// Inserts elements after the last child.
    pub fn insert_last(&mut self, parent: Tag<'a>, elements: &[String]) {
        self.changes.push(Change::Last(parent, elements.to_vec()));
    }

    /// Inserts a comment before an element, on a line of its own.
    pub fn insert_before(&mut self, tag: Tag<'a>, comment: &str) {
        self.changes.push(Change::Before(tag, comment.to_string()));
    }

    fn set_attribute(&self, tag: Tag<'a>, name: &str, value: Option<&str>) -> Option<Replacement> {
        match (tag.node.attribute_node(name), value) {
            (Some(found), Some(value)) => Some((found.range_value(), value.to_string())),
            (Some(found), None) => {
                let start = self.text[..found.range().start].trim_end().len();
                Some((start..found.range().end, String::new()))
            }
            (None, Some(value)) => {
                let after = tag.node.attributes().next_back().map(|attribute| attribute.range().end);
                let at = after.unwrap_or(tag.node.range().start + 1 + tag.name().len());
                Some((at..at, format!(" {name}=\"{value}\"")))
            }
            (None, None) => None,
        }
    }

    fn removal(&self, tag: Tag<'a>) -> Replacement {
        let Range { start, end } = tag.node.range();
        let rest = &self.text[end..];
        let line_ends = rest.find('\n').filter(|at| rest[..*at].trim().is_empty());
        let range = match (tag.indentation(), line_ends) {
            (Some(indentation), Some(at)) => start - indentation.len()..end + at + 1,
            _ => start..end,
        };
        (range, String::new())
    }

    /// Children at the beginning or end; an empty tag is opened for all of them at once.
    fn insertions(&self, parent: Tag<'a>, first: &[String], last: &[String]) -> Vec<Replacement> {
        let break_line = self.line_before_child(parent);
        let lines = |elements: &[String]| -> String {
            elements.iter().map(|element| format!("{break_line}{element}")).collect()
        };
        if parent.is_empty_tag() {
            let end = parent.node.range().end;
            let start = self.text[..end - 2].trim_end().len();
            let close =
                parent.indentation().map_or(String::new(), |indentation| format!("{}{indentation}", self.newline()));
            let text = format!(">{}{}{close}</{}>", lines(first), lines(last), parent.name());
            return vec![(start..end, text)];
        }
        let begin = parent.inside();
        let child = parent.node.children().rfind(|node| node.is_element() || node.is_comment());
        let end = child.map_or(begin, |node| node.range().end);
        let at = |at: usize, elements: &[String]| (!elements.is_empty()).then(|| (at..at, lines(elements)));
        [at(begin, first), at(end, last)].into_iter().flatten().collect()
    }

    fn newline(&self) -> &'static str {
        match self.text.find('\n') {
            Some(at) if self.text[..at].ends_with('\r') => "\r\n",
            _ => "\n",
        }
    }

    /// The end of line and indentation of a parent's children; nothing if the text is written on one line.
    fn line_before_child(&self, parent: Tag<'a>) -> String {
        let child = parent.children().find_map(|child| child.indentation().map(str::to_string));
        let deeper = || parent.indentation().map(|indentation| format!("{indentation}  "));
        child.or_else(deeper).map_or(String::new(), |indentation| format!("{}{indentation}", self.newline()))
    }

    pub fn replacements(&self) -> Vec<Replacement> {
        let mut all = Vec::new();
        // the children that each parent gets: at its beginning, and at its end
        let mut parents: Vec<(Tag<'a>, Vec<String>, Vec<String>)> = Vec::new();
        let mut of = |parent: &Tag<'a>| -> usize {
            parents.iter().position(|(known, ..)| known.node == parent.node).unwrap_or_else(|| {
                parents.push((*parent, Vec::new(), Vec::new()));
                parents.len() - 1
            })
        };
        let places: Vec<Option<usize>> = self
            .changes
            .iter()
            .map(|change| match change {
                Change::First(parent, _) | Change::Last(parent, _) => Some(of(parent)),
                _ => None,
            })
            .collect();
        for (change, place) in self.changes.iter().zip(places) {
            match (change, place.and_then(|place| parents.get_mut(place))) {
                (Change::First(_, element), Some((_, first, _))) => first.push(element.clone()),
                (Change::Last(_, elements), Some((.., last))) => last.extend(elements.iter().cloned()),
                (Change::Set(tag, name, value), _) => all.extend(self.set_attribute(*tag, name, value.as_deref())),
                (Change::Remove(tag), _) => all.push(self.removal(*tag)),
                (Change::Before(tag, comment), _) => {
                    let at = tag.node.range().start;
                    let indentation = tag.indentation().map(|space| format!("{}{space}", self.newline()));
                    all.push((at..at, format!("{comment}{}", indentation.unwrap_or_default())));
                }
                _ => {}
            }
        }
        all.extend(parents.iter().flat_map(|(parent, first, last)| self.insertions(*parent, first, last)));
        all
    }

    pub fn apply(self) -> String {
        replaced(self.text, self.replacements())
    }
}

/// The text with parts of it replaced.
pub(crate) fn replaced(text: &str, mut replacements: Vec<Replacement>) -> String {
    replacements.sort_by_key(|(range, _)| (range.start, range.end));
    let (mut result, mut at) = (String::with_capacity(text.len()), 0);
    for (range, replacement) in &replacements {
        result += &text[at..range.start.max(at)];
        result += replacement;
        at = range.end.max(at);
    }
    result + &text[at..]
}
