//! The tree of a file during expansion: all nodes are in one arena and are moved by changing links.

use crate::bounds::Budget;
use crate::fault::Result;
use crate::place::{Call, Place};
use std::rc::Rc;
use std::sync::Arc;

pub(crate) type Id = usize;

#[derive(Clone)]
pub(crate) enum Content {
    Element { name: Rc<str>, attributes: Vec<Attribute> },
    Text(Rc<str>),
    Data(Rc<str>),
    Comment(Rc<str>),
    Instruction(Rc<str>),
}

#[derive(Clone)]
pub(crate) struct Attribute {
    pub name: Rc<str>,
    pub value: Rc<str>,
    /// The position of the name in the file.
    pub name_start: u32,
    /// The value's place.
    pub place: Place,
}

pub(crate) struct Node {
    pub content: Content,
    /// For an element, the place of its name.
    pub place: Place,
    pub parent: Option<Id>,
    pub first: Option<Id>,
    pub last: Option<Id>,
    pub next: Option<Id>,
    pub previous: Option<Id>,
}

/// All nodes that were ever made.
#[derive(Default)]
pub(crate) struct Document {
    nodes: Vec<Node>,
}

impl Document {
    pub fn node(&self, id: Id) -> &Node {
        &self.nodes[id]
    }

    pub fn content_mut(&mut self, id: Id) -> &mut Content {
        &mut self.nodes[id].content
    }

    pub fn add(&mut self, content: Content, place: Place) -> Id {
        let (parent, first, last, next, previous) = (None, None, None, None, None);
        self.nodes.push(Node { content, place, parent, first, last, next, previous });
        self.nodes.len() - 1
    }

    pub fn name(&self, id: Id) -> Option<&Rc<str>> {
        match &self.nodes[id].content {
            Content::Element { name, .. } => Some(name),
            _ => None,
        }
    }

    pub fn attributes(&self, id: Id) -> &[Attribute] {
        match &self.nodes[id].content {
            Content::Element { attributes, .. } => attributes,
            _ => &[],
        }
    }

    pub fn attribute(&self, id: Id, name: &str) -> Option<&Attribute> {
        self.attributes(id).iter().find(|attribute| *attribute.name == *name)
    }

    /// Sets an attribute, in its place if there is one of the name.
    pub fn set_attribute(&mut self, id: Id, new: Attribute) {
        let Content::Element { attributes, .. } = &mut self.nodes[id].content else { return };
        match attributes.iter_mut().find(|attribute| attribute.name == new.name) {
            Some(known) => *known = new,
            None => attributes.push(new),
        }
    }

    pub fn remove_attribute(&mut self, id: Id, name: &str) {
        if let Content::Element { attributes, .. } = &mut self.nodes[id].content {
            attributes.retain(|attribute| *attribute.name != *name);
        }
    }

    pub fn children(&self, id: Id) -> impl Iterator<Item = Id> {
        std::iter::successors(self.nodes[id].first, |child| self.nodes[*child].next)
    }

    pub fn element_children(&self, id: Id) -> impl Iterator<Item = Id> {
        self.children(id).filter(|child| self.name(*child).is_some())
    }

    pub fn append(&mut self, parent: Id, child: Id) {
        self.insert(parent, child, None);
    }

    /// Moves a node before a sibling, or to the end.
    pub fn insert(&mut self, parent: Id, child: Id, before: Option<Id>) {
        self.remove(child);
        let previous = before.map_or(self.nodes[parent].last, |next| self.nodes[next].previous);
        let node = &mut self.nodes[child];
        (node.parent, node.previous, node.next) = (Some(parent), previous, before);
        match previous {
            Some(previous) => self.nodes[previous].next = Some(child),
            None => self.nodes[parent].first = Some(child),
        }
        match before {
            Some(next) => self.nodes[next].previous = Some(child),
            None => self.nodes[parent].last = Some(child),
        }
    }

    pub fn remove(&mut self, id: Id) {
        let node = &mut self.nodes[id];
        let (parent, previous, next) = (node.parent.take(), node.previous.take(), node.next.take());
        let Some(parent) = parent else { return };
        match previous {
            Some(previous) => self.nodes[previous].next = next,
            None => self.nodes[parent].first = next,
        }
        match next {
            Some(next) => self.nodes[next].previous = previous,
            None => self.nodes[parent].last = previous,
        }
    }

    /// Replaces a node by the children of other nodes.
    pub fn replace_by_content(&mut self, id: Id, others: &[Id]) {
        let Some(parent) = self.nodes[id].parent else { return };
        for &other in others {
            while let Some(child) = self.nodes[other].first {
                self.insert(parent, child, Some(id));
            }
        }
        self.remove(id);
    }

    /// A copy of a node and its descendants; in a macro's call, their places become that call's.
    pub fn copy(&mut self, id: Id, call: Option<&Arc<Call>>, budget: &Budget) -> Result<Id> {
        budget.spend(2)?;
        let place = |place: &Place| call.map_or_else(|| place.clone(), |call| place.called(call));
        let mut content = self.nodes[id].content.clone();
        if let (Content::Element { attributes, .. }, Some(_)) = (&mut content, call) {
            attributes.iter_mut().for_each(|attribute| attribute.place = place(&attribute.place));
        }
        let copy = self.add(content, place(&self.nodes[id].place));
        let mut child = self.nodes[id].first;
        while let Some(id) = child {
            let inner = budget.deeper(|| self.copy(id, call, budget))?;
            self.append(copy, inner);
            child = self.nodes[id].next;
        }
        Ok(copy)
    }
}
