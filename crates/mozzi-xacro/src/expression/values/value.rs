//! Values of expressions: the subset of Python's that xacro needs.

use crate::expression::syntax::{LambdaSyntax, Literal};
use crate::expression::values::reference::Function;
use crate::scope::Scope;
use num_bigint::BigInt;
use num_traits::Zero;
use std::cell::RefCell;
use std::collections::{HashMap, VecDeque};
use std::rc::Rc;

/// Entries in the order of insertion, found by key.
#[derive(Clone, Default)]
pub(crate) struct Dictionary {
    pub(super) entries: Vec<(Value, Value)>,
    pub(super) index: HashMap<Key, usize>,
}

/// Equality of keys: 1, 1.0 and True are equal.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(crate) enum Key {
    None,
    Int(BigInt),
    Float(u64),
    Str(Rc<str>),
    Tuple(Vec<Key>),
}

/// A list's elements, shared by all references to the list.
pub(crate) type Elements = Rc<RefCell<Vec<Value>>>;
/// A dictionary's entries, shared likewise.
pub(crate) type Entries = Rc<RefCell<Dictionary>>;

#[derive(Clone)]
pub(crate) enum Value {
    None,
    Bool(bool),
    Int(BigInt),
    Float(f64),
    Str(Rc<str>),
    /// The flag is true for a list from YAML: its items allow dotted access, too.
    List(Elements, bool),
    Tuple(Rc<[Value]>),
    /// Likewise.
    Dict(Entries, bool),
    /// A set: only the keys count.
    Set(Entries),
    Range(Progression),
    /// The result of `map`, `zip` and generator expressions: read once.
    Iterator(Rc<RefCell<Stream>>),
    /// `keys`, `values` or `items` of a dictionary.
    View(View, Entries),
    Function(Function),
    Method(Rc<(Value, Rc<str>)>),
    Lambda(Rc<Lambda>),
    Namespace(Rc<Scope>),
    /// `math`, `python` or `xacro`.
    Module(&'static str),
}

/// A lambda, with the names bound where it was defined.
pub(crate) struct Lambda {
    pub syntax: Rc<LambdaSyntax>,
    pub defaults: Vec<Option<Value>>,
    pub bindings: Bindings,
}

/// Names that comprehensions and lambdas bind, innermost first.
pub(crate) type Bindings = Option<Rc<Binding>>;

pub(crate) struct Binding {
    pub name: Rc<str>,
    pub value: Value,
    pub outer: Bindings,
}

/// Binds a name.
pub(crate) fn bind(bindings: &Bindings, name: &Rc<str>, value: Value) -> Bindings {
    Some(Rc::new(Binding { name: name.clone(), value, outer: bindings.clone() }))
}

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum View {
    Keys,
    Values,
    Items,
}

/// Items still to be read, and the error that ends them.
#[derive(Default)]
pub(crate) struct Stream {
    pub items: VecDeque<Value>,
    pub end: Option<Box<crate::fault::Fault>>,
}

/// `range(start, stop, step)`.
#[derive(Clone, PartialEq)]
pub(crate) struct Progression {
    pub start: i64,
    pub stop: i64,
    pub step: i64,
}

impl Progression {
    pub fn len(&self) -> usize {
        let (start, stop, step) = (i128::from(self.start), i128::from(self.stop), i128::from(self.step));
        let distance = if step > 0 { stop - start } else { start - stop };
        if distance <= 0 { 0 } else { usize::try_from((distance - 1) / step.abs() + 1).unwrap_or(usize::MAX) }
    }

    pub fn item(&self, index: usize) -> Value {
        Value::Int(BigInt::from(self.start) + BigInt::from(self.step) * BigInt::from(index))
    }
}

impl From<&Literal> for Value {
    fn from(literal: &Literal) -> Value {
        match literal {
            Literal::None => Value::None,
            Literal::Bool(value) => Value::Bool(*value),
            Literal::Int(number) => Value::Int(number.clone()),
            Literal::Float(number) => Value::Float(*number),
            Literal::Str(text) => Value::Str(text.clone()),
        }
    }
}

impl Value {
    pub fn int(number: impl Into<BigInt>) -> Value {
        Value::Int(number.into())
    }

    pub fn text(text: impl Into<Rc<str>>) -> Value {
        Value::Str(text.into())
    }

    pub fn list(items: Vec<Value>) -> Value {
        Value::List(Rc::new(RefCell::new(items)), false)
    }

    pub fn dict(entries: Dictionary) -> Value {
        Value::Dict(Rc::new(RefCell::new(entries)), false)
    }

    pub fn stream(items: VecDeque<Value>, end: Option<Box<crate::fault::Fault>>) -> Value {
        Value::Iterator(Rc::new(RefCell::new(Stream { items, end })))
    }

    /// Python's name of the type.
    pub fn kind(&self) -> &'static str {
        match self {
            Value::None => "NoneType",
            Value::Bool(_) => "bool",
            Value::Int(_) => "int",
            Value::Float(_) => "float",
            Value::Str(_) => "str",
            Value::List(_, false) => "list",
            Value::List(_, true) => "YamlListWrapper",
            Value::Tuple(_) => "tuple",
            Value::Dict(_, false) => "dict",
            Value::Dict(_, true) => "YamlDictWrapper",
            Value::Set(_) => "set",
            Value::Range(_) => "range",
            Value::Iterator(_) => "iterator",
            Value::View(View::Keys, _) => "dict_keys",
            Value::View(View::Values, _) => "dict_values",
            Value::View(View::Items, _) => "dict_items",
            Value::Function(_) | Value::Method(_) | Value::Lambda(_) => "function",
            Value::Namespace(_) | Value::Module(_) => "NameSpace",
        }
    }

    pub fn truth(&self) -> bool {
        match self {
            Value::None => false,
            Value::Bool(value) => *value,
            Value::Int(value) => !value.is_zero(),
            Value::Float(value) => *value != 0.0,
            Value::Str(text) => !text.is_empty(),
            Value::List(items, _) => !items.borrow().is_empty(),
            Value::Tuple(items) => !items.is_empty(),
            Value::Dict(entries, _) | Value::Set(entries) | Value::View(_, entries) => !entries.borrow().is_empty(),
            Value::Range(range) => range.len() > 0,
            _ => true,
        }
    }

    /// An int, or a bool as one.
    pub fn as_int(&self) -> Option<BigInt> {
        match self {
            Value::Int(number) => Some(number.clone()),
            Value::Bool(value) => Some(BigInt::from(i32::from(*value))),
            _ => None,
        }
    }

    pub fn as_text(&self) -> Option<&Rc<str>> {
        match self {
            Value::Str(text) => Some(text),
            _ => None,
        }
    }

    pub fn is_number(&self) -> bool {
        matches!(self, Value::Bool(_) | Value::Int(_) | Value::Float(_))
    }

    /// The value as an item of a list or dictionary from YAML: a copy with dotted access.
    pub fn dotted(&self) -> Value {
        match self {
            Value::List(items, _) => Value::List(Rc::new(RefCell::new(items.borrow().clone())), true),
            Value::Dict(entries, _) => Value::Dict(Rc::new(RefCell::new(entries.borrow().clone())), true),
            other => other.clone(),
        }
    }
}
