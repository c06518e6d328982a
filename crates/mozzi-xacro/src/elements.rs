//! Processes the elements of a file: evaluates attributes and texts, and executes xacro's elements.

use crate::condition::truth;
use crate::document::{Attribute, Content, Id};
use crate::expander::Expander;
use crate::expression::{Value, text_of};
use crate::fault::{Fault, Result};
use crate::place::Place;
use crate::scope::{Macros, Property, Scope};
use crate::space::is_space;
use std::rc::Rc;

impl Expander<'_> {
    /// Evaluates a node and everything below it.
    pub fn evaluate_node(&self, id: Id, macros: &Rc<Macros>, scope: &Rc<Scope>) -> Result<()> {
        self.attributes(id, scope)?;
        let mut next = self.document.borrow().node(id).first;
        let mut evaluates_comments = false;
        while let Some(child) = next {
            self.budget.spend(1)?;
            let (name, text, comment) = {
                let document = self.document.borrow();
                let node = document.node(child);
                next = node.next;
                *self.place.borrow_mut() = node.place.clone();
                match &node.content {
                    Content::Element { name, .. } => (Some(name.clone()), None, None),
                    Content::Text(text) => (None, Some(text.clone()), None),
                    Content::Comment(text) => (None, None, Some(text.clone())),
                    _ => (None, None, None),
                }
            };
            if let Some(name) = name {
                evaluates_comments = false;
                self.budget
                    .deeper(|| self.element(child, &name, macros, scope))
                    .map_err(|fault| self.located(fault, child))?;
            } else if let Some(text) = text {
                let place = self.document.borrow().node(child).place.clone();
                let value = self.evaluate_text(&text, scope, &place)?;
                evaluates_comments &= value.chars().all(is_space);
                *self.document.borrow_mut().content_mut(child) = Content::Text(value);
            } else if let Some(comment) = comment {
                if comment.contains("xacro:eval-comments") {
                    evaluates_comments = !comment.contains("xacro:eval-comments:off");
                    self.document.borrow_mut().remove(child);
                } else if evaluates_comments {
                    let place = self.document.borrow().node(child).place.clone();
                    let value = self.evaluate_text(&comment, scope, &place)?;
                    *self.document.borrow_mut().content_mut(child) = Content::Comment(value);
                }
            }
        }
        Ok(())
    }

    /// Sets an error's place to the name of an element, unless it has a place.
    pub fn located(&self, mut fault: Box<Fault>, id: Id) -> Box<Fault> {
        if fault.place.is_none() {
            fault.place = Some(self.document.borrow().node(id).place.clone());
            fault.at = None;
        }
        fault
    }

    fn attributes(&self, id: Id, scope: &Rc<Scope>) -> Result<()> {
        let is_odd = |a: &Attribute| a.name.starts_with("xacro:") || *a.name == *"xmlns:xacro" || a.value.contains('$');
        if !self.document.borrow().attributes(id).iter().any(is_odd) {
            return Ok(());
        }
        let mut attributes = self.document.borrow().attributes(id).to_vec();
        attributes.retain(|attribute| !attribute.name.starts_with("xacro:"));
        for attribute in &mut attributes {
            attribute.value = self.evaluate_text(&attribute.value, scope, &attribute.place)?;
        }
        attributes.retain(|attribute| *attribute.name != *"xmlns:xacro");
        if let Content::Element { attributes: known, .. } = self.document.borrow_mut().content_mut(id) {
            *known = attributes;
        }
        Ok(())
    }

    fn element(&self, id: Id, name: &str, macros: &Rc<Macros>, scope: &Rc<Scope>) -> Result<()> {
        match name.strip_prefix("xacro:") {
            None => self.evaluate_node(id, macros, scope),
            Some("insert_block") => self.insert_block(id, macros, scope),
            Some("include") => self.include(id, macros, scope),
            Some("property") => self.define_property(id, scope),
            Some("macro") => self.define_macro(id, macros),
            Some("arg") => self.define_argument(id, scope),
            Some("element") => {
                let name = self.required(id, "xacro:name")?;
                let value = self.evaluate(&name.value, scope, &name.place)?;
                let Value::Str(new) = &value else {
                    return Err(Fault::new(format!("xacro:element: the name is {}, expected text", value.kind())));
                };
                if new.is_empty() {
                    return Err(Fault::new("xacro:element: the name is empty"));
                }
                self.check_name(new).map_err(|fault| self.placed(fault, &name.value, &name.place))?;
                let mut document = self.document.borrow_mut();
                document.remove_attribute(id, "xacro:name");
                if let Content::Element { name, .. } = document.content_mut(id) {
                    *name = new.clone();
                }
                drop(document);
                self.budget.deeper(|| self.element(id, new, macros, scope))
            }
            Some("attribute") => self.add_attribute(id, scope),
            Some(word @ ("if" | "unless")) => {
                self.remove_comments_before(id);
                let condition = self.checked(id, &["value"], &[])?;
                let value = self.evaluate(&condition.value, scope, &condition.place)?;
                let holds = truth(&value).map_err(|fault| self.placed(fault, &condition.value, &condition.place))?;
                if holds == (word == "if") {
                    self.evaluate_node(id, macros, scope)?;
                    self.document.borrow_mut().replace_by_content(id, &[id]);
                } else {
                    self.document.borrow_mut().remove(id);
                }
                Ok(())
            }
            Some(called) => self.call_macro(id, called, macros, scope),
        }
    }

    /// The name of an element or attribute, accepted by the file's reader.
    fn check_name(&self, name: &str) -> Result<()> {
        let begins = |c: char| c.is_alphabetic() || c == '_' || c == ':';
        let goes_on = |c: char| c.is_alphanumeric() || "_:-.".contains(c);
        match name.starts_with(begins) && name.chars().all(goes_on) {
            true => Ok(()),
            false => Err(Fault::new(format!("`{name}` is not a name of XML"))),
        }
    }

    /// A required attribute.
    pub fn required(&self, id: Id, name: &str) -> Result<Attribute> {
        let document = self.document.borrow();
        let found = document.attribute(id, name).cloned();
        found.ok_or_else(|| {
            Fault::new(format!("<{}> has no attribute `{name}`", document.name(id).map_or("", |name| name)))
        })
    }

    /// The first of the required attributes; warns about unknown ones.
    pub fn checked(&self, id: Id, required: &[&str], optional: &[&str]) -> Result<Attribute> {
        for name in required.iter().skip(1) {
            self.required(id, name)?;
        }
        let first = self.required(id, required[0])?;
        let document = self.document.borrow();
        let is_known = |name: &str| required.contains(&name) || optional.contains(&name) || name.starts_with("xmlns:");
        let unknown = document.attributes(id).iter().find(|attribute| !is_known(&attribute.name));
        if let Some(attribute) = unknown {
            let element = document.name(id).map_or("", |name| name);
            self.warn(format!("<{element}> has an attribute `{}`, which xacro does not define", attribute.name));
        }
        Ok(first)
    }

    pub fn optional(&self, id: Id, name: &str) -> Option<Attribute> {
        self.document.borrow().attribute(id, name).cloned()
    }

    fn insert_block(&self, id: Id, macros: &Rc<Macros>, scope: &Rc<Scope>) -> Result<()> {
        let name = self.checked(id, &["name"], &[])?.value;
        let block = |stars: &str| match scope.find(&format!("{stars}{name}")) {
            Some((_, Property::Block(block))) => Some(block),
            _ => None,
        };
        let (block, content_only) = match (block("**"), block("*")) {
            (Some(block), _) => (block, true),
            (None, Some(block)) => (block, false),
            (None, None) => return Err(Fault::new(format!("the block `{name}` is not defined"))),
        };
        let copy = self.document.borrow_mut().copy(block, None, &self.budget)?;
        self.evaluate_node(copy, macros, scope)?;
        let mut document = self.document.borrow_mut();
        match document.node(id).parent {
            Some(parent) if !content_only => {
                document.insert(parent, copy, Some(id));
                document.remove(id);
            }
            _ => document.replace_by_content(id, &[copy]),
        }
        Ok(())
    }

    fn define_argument(&self, id: Id, scope: &Rc<Scope>) -> Result<()> {
        let name = self.checked(id, &["name", "default"], &[])?.value;
        if self.argument(&name).is_none() {
            let default = self.required(id, "default")?;
            let value = self.evaluate_text(&default.value, scope, &default.place)?;
            self.arguments.borrow_mut().insert(name, value);
        }
        self.remove_comments_before(id);
        self.document.borrow_mut().remove(id);
        Ok(())
    }

    /// Sets an attribute of the enclosing element.
    fn add_attribute(&self, id: Id, scope: &Rc<Scope>) -> Result<()> {
        let text = |attribute: &Attribute| match self.evaluate(&attribute.value, scope, &attribute.place)? {
            Value::Str(text) => Ok(text),
            other => {
                let shown = text_of(&self.budget, &other).unwrap_or_default();
                let fault = Fault::new(format!(
                    "xacro:attribute: {} is the {} {shown}, which xacro cannot write, expected text: `${{str(…)}}`",
                    attribute.name,
                    other.kind()
                ));
                Err(self.placed(fault, &attribute.value, &attribute.place))
            }
        };
        let (name, value) = (self.required(id, "name")?, self.required(id, "value")?);
        let (new, text) = (text(&name)?, text(&value)?);
        if new.is_empty() {
            return Err(Fault::new("xacro:attribute: the name is empty"));
        }
        self.check_name(&new).map_err(|fault| self.placed(fault, &name.value, &name.place))?;
        let mut document = self.document.borrow_mut();
        if let Some(parent) = document.node(id).parent {
            let name_start = value.place.start;
            document.set_attribute(parent, Attribute { name: new, value: text, name_start, place: value.place });
        }
        document.remove(id);
        Ok(())
    }

    /// Removes the comments directly before a xacro element, which is removed, too.
    pub fn remove_comments_before(&self, id: Id) {
        let mut document = self.document.borrow_mut();
        let next = document.node(id).next;
        let mut previous = document.node(id).previous;
        while let Some(mut before) = previous {
            let is_gap = |text: &str| !text.is_empty() && text.chars().all(is_space) && text.matches('\n').count() <= 1;
            if matches!(&document.node(before).content, Content::Text(text) if is_gap(text)) {
                match document.node(before).previous {
                    Some(earlier) => before = earlier,
                    None => before = id, // not a comment
                }
            }
            if !matches!(document.node(before).content, Content::Comment(_)) {
                if let (Some(next), Some(parent)) = (next, document.node(id).parent)
                    && next != self.spacer
                {
                    document.insert(parent, self.spacer, Some(next));
                }
                return;
            }
            previous = document.node(before).previous;
            document.remove(before);
        }
    }

    /// Moves declarations of namespaces to the enclosing element.
    pub fn import_namespaces(&self, parent: Id, from: &[Attribute]) {
        for attribute in from.iter().filter(|attribute| attribute.name.starts_with("xmlns:")) {
            let known = self.document.borrow().attribute(parent, &attribute.name).map(|known| known.value.clone());
            match known {
                Some(known) if known != attribute.value => {
                    self.warn(format!(
                        "the namespace `{}` is `{known}` here, and `{}` inside",
                        attribute.name, attribute.value
                    ));
                }
                _ => self.document.borrow_mut().set_attribute(parent, attribute.clone()),
            }
        }
    }

    /// The place of a node.
    pub fn place_of(&self, id: Id) -> Place {
        self.document.borrow().node(id).place.clone()
    }
}
