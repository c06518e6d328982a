//! Writes the expanded tree as text, with the place of each piece: an element or text on its own line, attributes in
//! order of name.

use crate::bounds::MOST_BYTES;
use crate::document::{Content, Document, Id};
use crate::fault::{Fault, Result};
use crate::place::Place;
use crate::space::is_space;
use std::ops::Range;

/// A part of the written text, and its origin.
#[derive(Debug)]
pub(crate) struct Piece {
    /// The name of an element, an attribute, or a text.
    pub span: Range<usize>,
    /// For an attribute: where its value begins, and where its name begins in the file.
    pub value: Option<(usize, u32)>,
    pub place: Place,
}

pub(crate) struct Writer<'w> {
    pub document: &'w Document,
    pub text: String,
    pub pieces: Vec<Piece>,
}

impl Writer<'_> {
    /// A node and everything below it.
    pub fn node(&mut self, id: Id, indent: usize) -> Result<()> {
        if self.text.len() > MOST_BYTES {
            return Err(Fault::new(format!("the expansion has more than {MOST_BYTES} bytes")));
        }
        let document = self.document;
        let node = document.node(id);
        match &node.content {
            Content::Data(data) => {
                self.piece(|text| *text += &format!("<![CDATA[{data}]]>"), &node.place);
                Ok(())
            }
            Content::Text(data) => {
                self.indent(indent);
                self.piece(|text| escape(data, text), &node.place);
                self.text.push('\n');
                Ok(())
            }
            Content::Comment(data) => {
                if data.contains("--") || data.ends_with('-') {
                    let fault = Fault::new(
                        "a comment has `--` or ends with `-` after its evaluation, which XML does not allow",
                    );
                    return Err(Box::new(Fault { place: Some(node.place.clone()), ..*fault }));
                }
                self.indent(indent);
                self.text += &format!("<!--{data}-->\n");
                Ok(())
            }
            Content::Instruction(data) => {
                self.indent(indent);
                self.text += &format!("<?{data}?>\n");
                Ok(())
            }
            Content::Element { name, attributes } => {
                self.indent(indent);
                self.text.push('<');
                self.piece(|text| *text += name, &node.place);
                let mut sorted: Vec<_> = attributes.iter().collect();
                sorted.sort_unstable_by(|a, b| a.name.cmp(&b.name));
                for attribute in sorted {
                    self.text.push(' ');
                    let start = self.text.len();
                    self.text += &attribute.name;
                    self.text += "=\"";
                    let value = Some((self.text.len(), attribute.name_start));
                    escape(&attribute.value, &mut self.text);
                    self.pieces.push(Piece { span: start..self.text.len(), value, place: attribute.place.clone() });
                    self.text.push('"');
                }
                self.children(id, name, indent)
            }
        }
    }

    fn children(&mut self, id: Id, name: &str, indent: usize) -> Result<()> {
        let document = self.document;
        let node = document.node(id);
        let Some(first) = node.first else {
            self.text.push_str("/>\n");
            return Ok(());
        };
        self.text.push('>');
        let only_text = match &document.node(first).content {
            Content::Text(text) if node.last == Some(first) => Some(text),
            _ => None,
        };
        if let Some(text) = only_text {
            self.piece(|out| escape(text, out), &document.node(first).place);
        } else {
            self.text.push('\n');
            for child in document.children(id) {
                let is_blank =
                    matches!(&document.node(child).content, Content::Text(text) if text.chars().all(is_space));
                if !is_blank {
                    self.node(child, indent + 1)?;
                }
            }
            self.indent(indent);
        }
        self.text.push_str("</");
        self.text += name;
        self.text.push_str(">\n");
        Ok(())
    }

    fn indent(&mut self, levels: usize) {
        // indentation is limited in deep trees
        self.text.extend(std::iter::repeat_n("  ", levels.min(200)));
    }

    fn piece(&mut self, write: impl FnOnce(&mut String), place: &Place) {
        let start = self.text.len();
        write(&mut self.text);
        self.pieces.push(Piece { span: start..self.text.len(), value: None, place: place.clone() });
    }
}

fn escape(text: &str, out: &mut String) {
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c => out.push(c),
        }
    }
}
