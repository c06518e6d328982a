//! Elements of a text, and replacements of parts of it.

use roxmltree::Node;
use std::ops::Range;

/// An element and the text that it is in.
#[derive(Clone, Copy)]
pub(super) struct Tag<'a> {
    node: Node<'a, 'a>,
    text: &'a str,
}

impl<'a> Tag<'a> {
    pub fn new(node: Node<'a, 'a>, text: &'a str) -> Self {
        Tag { node, text }
    }

    /// The name as written, with its prefix.
    fn name(self) -> &'a str {
        let rest = self.text.get(self.node.range().start + 1..).unwrap_or_default();
        rest.split(|c: char| c.is_ascii_whitespace() || matches!(c, '/' | '>')).next().unwrap_or_default()
    }

    fn children(self) -> impl Iterator<Item = Tag<'a>> {
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

/// Replacements of parts of a text.
pub(super) struct Editor<'a> {
    text: &'a str,
    replacements: Vec<(Range<usize>, String)>,
}

impl<'a> Editor<'a> {
    pub fn new(text: &'a str) -> Self {
        Editor { text, replacements: Vec::new() }
    }

    /// Sets an attribute; `None` removes it with the white space before it.
    pub fn set(&mut self, tag: Tag<'a>, name: &str, value: Option<&str>) {
        let found = tag.node.attribute_node(name);
        match (found, value) {
            (Some(found), Some(value)) => self.replacements.push((found.range_value(), value.to_string())),
            (Some(found), None) => {
                let start = self.text[..found.range().start].trim_end().len();
                self.replacements.push((start..found.range().end, String::new()));
            }
            (None, Some(value)) => {
                let after = tag.node.attributes().next_back().map(|attribute| attribute.range().end);
                let at = after.unwrap_or(tag.node.range().start + 1 + tag.name().len());
                self.replacements.push((at..at, format!(" {name}=\"{value}\"")));
            }
            (None, None) => {}
        }
    }

    /// Removes an element, and its line if nothing else is on it.
    pub fn remove(&mut self, tag: Tag<'a>) {
        let Range { start, end } = tag.node.range();
        let rest = &self.text[end..];
        let line_ends = rest.find('\n').filter(|at| rest[..*at].trim().is_empty());
        let range = match (tag.indentation(), line_ends) {
            (Some(indentation), Some(at)) => start - indentation.len()..end + at + 1,
            _ => start..end,
        };
        self.replacements.push((range, String::new()));
    }

    /// Inserts an element before the first child.
    pub fn insert_first(&mut self, parent: Tag<'a>, element: &str) {
        match parent.is_empty_tag() {
            true => self.open(parent, &[element.to_string()]),
            false => {
                let break_line = self.line_before_child(parent);
                let at = parent.inside();
                self.replacements.push((at..at, format!("{break_line}{element}")));
            }
        }
    }

    /// Inserts elements after the last child.
    pub fn insert_last(&mut self, parent: Tag<'a>, elements: &[String]) {
        if parent.is_empty_tag() {
            return self.open(parent, elements);
        }
        let break_line = self.line_before_child(parent);
        let last = parent.node.children().rfind(|node| node.is_element() || node.is_comment());
        let at = last.map_or_else(|| parent.inside(), |node| node.range().end);
        self.replacements.push((at..at, elements.iter().map(|element| format!("{break_line}{element}")).collect()));
    }

    /// Makes `<a/>` an `<a>` with children.
    fn open(&mut self, parent: Tag<'a>, elements: &[String]) {
        let end = parent.node.range().end;
        let start = self.text[..end - 2].trim_end().len();
        let children: String =
            elements.iter().map(|element| format!("{}{element}", self.line_before_child(parent))).collect();
        let close =
            parent.indentation().map_or(String::new(), |indentation| format!("{}{indentation}", self.newline()));
        self.replacements.push((start..end, format!(">{children}{close}</{}>", parent.name())));
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

    pub fn apply(mut self) -> String {
        self.replacements.sort_by_key(|(range, _)| (range.start, range.end));
        let (mut text, mut at) = (String::with_capacity(self.text.len()), 0);
        for (range, replacement) in &self.replacements {
            text += &self.text[at..range.start.max(at)];
            text += replacement;
            at = range.end.max(at);
        }
        text + &self.text[at..]
    }
}
