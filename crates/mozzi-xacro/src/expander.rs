//! The state of an expansion, and the names visible to its expressions.

use crate::bounds::Budget;
use crate::condition::literal;
use crate::document::{Document, Id};
use crate::expression::{Host, Node, Value, global};
use crate::fault::{Fault, Result};
use crate::place::Place;
use crate::scope::{Property, Scope};
use crate::{Arguments, Warning};
use std::cell::{Cell, RefCell};
use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

/// A file that was read.
#[derive(Clone, Debug)]
pub struct File {
    /// As it was named: relative to the current folder, or absolute.
    pub name: Arc<str>,
    /// Its text, without a byte order mark.
    pub text: Arc<str>,
}

pub(crate) struct Expander<'a> {
    pub given: &'a Arguments,
    pub budget: Budget,
    pub document: RefCell<Document>,
    pub files: RefCell<Vec<File>>,
    /// The files that are being processed, outermost first.
    pub open: RefCell<Vec<PathBuf>>,
    /// The arguments that were given, and defaults.
    pub arguments: RefCell<HashMap<Rc<str>, Rc<str>>>,
    /// The names of arguments that the files declare or read.
    pub known_arguments: RefCell<BTreeSet<Rc<str>>>,
    /// Variables of the environment that were read.
    pub variables: RefCell<BTreeSet<String>>,
    pub expressions: RefCell<HashMap<Rc<str>, Rc<Node>>>,
    pub warnings: RefCell<Vec<Warning>>,
    /// The place that is being processed.
    pub place: RefCell<Place>,
    pub calls: Cell<usize>,
    /// The single text node of two line ends that keeps comments before it; it is moved to the latest place.
    pub spacer: Id,
}

impl Expander<'_> {
    /// A path relative to the file that is being processed.
    pub fn beside(&self, file: &str) -> PathBuf {
        let open = self.open.borrow();
        open.last().and_then(|current| current.parent()).unwrap_or(Path::new("")).join(file)
    }

    pub fn warn(&self, message: String) {
        let place = self.place.borrow().clone();
        self.warnings.borrow_mut().push(Warning { message, place: crate::Origin::of(&place) });
    }

    /// The value of an argument that a file declares or reads; None if no argument has this name.
    pub fn argument(&self, name: &str) -> Option<Rc<str>> {
        self.known_arguments.borrow_mut().insert(name.into());
        self.arguments.borrow().get(name).cloned()
    }

    /// The arguments that files declare or read, with their values.
    pub fn known_values(&self) -> Vec<(String, String)> {
        let (known, values) = (self.known_arguments.borrow(), self.arguments.borrow());
        known.iter().filter_map(|name| Some((name.to_string(), values.get(name)?.to_string()))).collect()
    }

    /// Warns about given arguments that no file declares or reads.
    pub fn warn_of_unused_arguments(&self) {
        let known = self.known_arguments.borrow();
        let mut names: Vec<&str> = known.iter().map(|name| &**name).collect();
        for (name, _) in self.given.values.iter().filter(|(name, _)| !known.contains(name.as_str())) {
            names.truncate(20);
            let expected = if names.is_empty() { "none".to_string() } else { names.join(", ") };
            let message = format!("the argument `{name}` is given and not used, expected some of: {expected}");
            self.warnings.borrow_mut().push(Warning { message, place: crate::Origin::of(&Place::default()) });
        }
    }

    /// The value of a property; None if no property has this name.
    pub fn property(&self, name: &str, scope: &Rc<Scope>) -> Result<Option<Value>> {
        match scope.find(name) {
            None => Ok(None),
            Some((_, Property::Value(value))) => Ok(Some(value)),
            Some((_, Property::Block(_))) => Err(Fault::new(format!("`{name}` is a block of elements, not a value"))),
            Some((owner, Property::Text(text, place))) => {
                let mut waiting: Vec<Rc<str>> = owner.evaluating.borrow().clone();
                if waiting.iter().any(|other| **other == *name) {
                    waiting.push(name.into());
                    let circle = waiting.join(" -> ");
                    return Err(Fault::new(format!(
                        "the property is defined by itself: {circle}; `lazy_eval=\"false\"` evaluates it where it stands"
                    )));
                }
                owner.evaluating.borrow_mut().push(name.into());
                let value = literal(self.budget.deeper(|| self.evaluate(&text, &owner, &place))?);
                owner.evaluating.borrow_mut().pop();
                owner.set(name, Property::Value(value.clone()));
                Ok(Some(value))
            }
        }
    }
}

/// The names visible to expressions of a scope.
pub(crate) struct Names<'n> {
    pub expander: &'n Expander<'n>,
    pub scope: &'n Rc<Scope>,
}

impl Host for Names<'_> {
    fn budget(&self) -> &Budget {
        &self.expander.budget
    }

    fn lookup(&self, name: &str, _: bool) -> Result<Option<Value>> {
        Ok(self.expander.property(name, self.scope)?.or_else(|| global(name)))
    }

    fn member(&self, scope: &Rc<Scope>, name: &str) -> Result<Option<Value>> {
        Ok(self.expander.property(name, scope)?.or_else(|| global(name)))
    }

    fn load_yaml(&self, file: &str) -> Result<Value> {
        self.expander.load_yaml(file)
    }

    fn absolute(&self, file: &str) -> String {
        self.expander.beside(file).to_string_lossy().into_owned()
    }

    fn argument(&self, name: &str) -> Option<Rc<str>> {
        self.expander.argument(name)
    }

    fn message(&self, kind: &str, text: String) {
        self.expander.warn(if kind == "message" { text } else { format!("{kind}: {text}") });
    }
}

/// The names visible to `$(eval …)`.
impl Host for Expander<'_> {
    fn budget(&self) -> &Budget {
        &self.budget
    }

    fn lookup(&self, name: &str, is_nested: bool) -> Result<Option<Value>> {
        Ok(if is_nested { None } else { self.eval_name(name) })
    }

    fn member(&self, _: &Rc<Scope>, _: &str) -> Result<Option<Value>> {
        Ok(None)
    }

    fn load_yaml(&self, _: &str) -> Result<Value> {
        Err(Fault::new("`load_yaml` is not known in `$(eval …)`"))
    }

    fn absolute(&self, file: &str) -> String {
        file.to_string()
    }

    fn argument(&self, _: &str) -> Option<Rc<str>> {
        None
    }

    fn message(&self, _: &str, _: String) {}
}
