//! Properties and macros by name, each scope inside another.

use crate::document::Id;
use crate::expression::Value;
use crate::place::Place;
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

/// A scope of properties.
#[derive(Default)]
pub(crate) struct Scope {
    names: RefCell<HashMap<Rc<str>, Property>>,
    pub parent: Option<Rc<Scope>>,
    /// True for an included namespace, false for a macro.
    pub is_namespace: bool,
    /// Properties of this scope that are being evaluated.
    pub evaluating: RefCell<Vec<Rc<str>>>,
}

#[derive(Clone)]
pub(crate) enum Property {
    Value(Value),
    /// Evaluated when it is first used.
    Text(Rc<str>, Place),
    /// Elements: the children of a property, or of a macro's call.
    Block(Id),
}

impl Scope {
    pub fn inside(parent: &Rc<Scope>) -> Rc<Scope> {
        Rc::new(Scope { parent: Some(parent.clone()), ..Scope::default() })
    }

    pub fn namespace(parent: &Rc<Scope>) -> Rc<Scope> {
        Rc::new(Scope { parent: Some(parent.clone()), is_namespace: true, ..Scope::default() })
    }

    pub fn own(&self, name: &str) -> Option<Property> {
        self.names.borrow().get(name).cloned()
    }

    pub fn set(&self, name: &str, property: Property) {
        self.names.borrow_mut().insert(name.into(), property);
    }

    /// The innermost scope that has the name, and the name's value there.
    pub fn find(self: &Rc<Self>, name: &str) -> Option<(Rc<Scope>, Property)> {
        self.ancestors().find_map(|scope| scope.own(name).map(|property| (scope, property)))
    }

    /// This scope and its outer scopes.
    pub fn ancestors(self: &Rc<Self>) -> impl Iterator<Item = Rc<Scope>> {
        std::iter::successors(Some(self.clone()), |scope| scope.parent.clone())
    }

    /// Removes a name from this scope and all outer scopes.
    pub fn remove(self: &Rc<Self>, name: &str) {
        self.ancestors().for_each(|scope| drop(scope.names.borrow_mut().remove(name)));
    }
}

/// A scope of macros.
#[derive(Default)]
pub(crate) struct Macros {
    names: RefCell<HashMap<Rc<str>, Definition>>,
    parent: Option<Rc<Macros>>,
}

#[derive(Clone)]
pub(crate) enum Definition {
    Macro(Rc<Macro>),
    Namespace(Rc<Macros>),
}

/// A macro: its element, and its parameters in order.
pub(crate) struct Macro {
    pub body: Id,
    pub parameters: Vec<Parameter>,
}

/// A parameter; a default may be text, or the caller's property of the name, or both.
#[derive(Clone)]
pub(crate) struct Parameter {
    pub name: Rc<str>,
    pub forwards: bool,
    pub default: Option<Rc<str>>,
}

impl Macros {
    pub fn inside(parent: &Rc<Macros>) -> Rc<Macros> {
        Rc::new(Macros { parent: Some(parent.clone()), ..Macros::default() })
    }

    pub fn set(&self, name: &str, definition: Definition) {
        self.names.borrow_mut().insert(name.into(), definition);
    }

    pub fn find(&self, name: &str) -> Option<Definition> {
        let own = self.names.borrow().get(name).cloned();
        own.or_else(|| self.parent.as_ref()?.find(name))
    }

    /// The names of all visible macros, for suggestions.
    pub fn known(&self) -> Vec<Rc<str>> {
        let mut names: Vec<Rc<str>> = self.names.borrow().keys().cloned().collect();
        names.extend(self.parent.iter().flat_map(|parent| parent.known()));
        names
    }
}
