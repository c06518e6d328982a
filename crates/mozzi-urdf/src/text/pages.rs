//! The texts of a robot, parsed: one, or several if the first includes others. A place is a byte offset in all of them
//! together; each text begins at its base.

use crate::text::source::Source;
use roxmltree::{Document, Node};
use std::collections::BTreeMap;
use std::ops::Range;

/// Parsed texts; included content replaces its `<include>`.
pub(crate) struct Pages<'a> {
    pages: Vec<(&'a Source, Document<'a>)>,
    /// The page that replaces the element at each place.
    includes: BTreeMap<usize, usize>,
    /// The pages whose elements follow those of the first.
    appended: Vec<usize>,
}

impl<'a> Pages<'a> {
    /// A text that includes no other.
    pub fn single(source: &'a Source, document: Document<'a>) -> Self {
        Pages { pages: vec![(source, document)], includes: BTreeMap::new(), appended: Vec::new() }
    }

    /// The first text and those that are included, with the place of each `<include>` and its page.
    pub fn new(pages: Vec<(&'a Source, Document<'a>)>, includes: BTreeMap<usize, usize>) -> Self {
        Pages { pages, includes, appended: Vec::new() }
    }

    /// With pages whose elements follow those of the first.
    pub fn followed_by(self, appended: Vec<usize>) -> Self {
        Pages { appended, ..self }
    }

    /// The root of one of the texts.
    pub fn root_of(&'a self, page: usize) -> Option<Node<'a, 'a>> {
        Some(self.pages.get(page)?.1.root_element())
    }

    pub fn source(&self, page: usize) -> &'a Source {
        self.pages[page].0
    }

    /// The text at a place.
    pub fn text(&self, span: &Range<usize>) -> Option<&'a str> {
        let after = self.pages.partition_point(|(source, _)| source.base <= span.start);
        let (source, _) = self.pages.get(after.checked_sub(1)?)?;
        source.text.get(span.start - source.base..span.end.checked_sub(source.base)?)
    }

    /// The children of a node, and their pages; included content replaces its `<include>`.
    pub fn children(&'a self, node: Node<'a, 'a>, page: usize) -> Children<'a> {
        let is_first = page == 0 && node.parent_element().is_none();
        let after = self.appended.iter().rev().filter(|_| is_first);
        let after = after.map(|&k| (self.pages[k].1.root_element().children(), k));
        Children { pages: self, open: after.chain([(node.children(), page)]).collect() }
    }
}

/// The children of a node, and their pages.
pub(crate) struct Children<'a> {
    pages: &'a Pages<'a>,
    open: Vec<(roxmltree::Children<'a, 'a>, usize)>,
}

impl<'a> Iterator for Children<'a> {
    type Item = (Node<'a, 'a>, usize);

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let (children, page) = self.open.last_mut()?;
            let page = *page;
            let Some(node) = children.next() else {
                self.open.pop();
                continue;
            };
            let place = self.pages.source(page).base + node.range().start;
            match self.pages.includes.get(&place) {
                Some(&included) => {
                    self.open.push((self.pages.pages[included].1.root_element().children(), included));
                }
                None => return Some((node, page)),
            }
        }
    }
}
