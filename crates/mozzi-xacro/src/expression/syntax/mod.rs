//! The syntax tree of an expression, and its parser.

mod atoms;
mod literal;
pub(crate) mod names;
mod parser;
mod token;

pub(crate) use parser::parse;

use num_bigint::BigInt;
use std::rc::Rc;

/// A constant, as it is written.
#[derive(Clone)]
pub(crate) enum Literal {
    None,
    Bool(bool),
    Int(BigInt),
    Float(f64),
    Str(Rc<str>),
}

/// A node of an expression, and the byte where it begins (the operator's for operations).
pub(crate) struct Node {
    pub at: usize,
    pub kind: Kind,
}

pub(crate) enum Kind {
    Constant(Literal),
    Name(Rc<str>),
    List(Vec<Node>),
    Tuple(Vec<Node>),
    Set(Vec<Node>),
    /// Keys and values; without a key, `**value`.
    Dict(Vec<(Option<Node>, Node)>),
    Unary(Unary, Box<Node>),
    Binary(Binary, Box<(Node, Node)>),
    /// `a < b <= c`
    Compare(Box<Node>, Vec<(usize, Compare, Node)>),
    And(Vec<Node>),
    Or(Vec<Node>),
    /// Condition, then, else.
    Choice(Box<(Node, Node, Node)>),
    Call(Box<Node>, Vec<Argument>),
    Attribute(Box<Node>, Rc<str>),
    Index(Box<(Node, Node)>),
    Slice(Box<(Node, [Option<Node>; 3])>),
    Comprehension(Rc<Comprehension>),
    Lambda(Rc<LambdaSyntax>),
    /// `*items` in a display.
    Starred(Box<Node>),
}

pub(crate) enum Argument {
    Positional(Node),
    Keyword(Rc<str>, Node),
    /// `*items`
    Items(Node),
    /// `**items`
    Keywords(Node),
}

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Unary {
    Plus,
    Minus,
    Invert,
    Not,
}

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    FloorDivide,
    Modulo,
    Power,
    ShiftLeft,
    ShiftRight,
    BitAnd,
    BitOr,
    BitXor,
}

impl Binary {
    pub fn symbol(self) -> &'static str {
        match self {
            Binary::Add => "+",
            Binary::Subtract => "-",
            Binary::Multiply => "*",
            Binary::Divide => "/",
            Binary::FloorDivide => "//",
            Binary::Modulo => "%",
            Binary::Power => "**",
            Binary::ShiftLeft => "<<",
            Binary::ShiftRight => ">>",
            Binary::BitAnd => "&",
            Binary::BitOr => "|",
            Binary::BitXor => "^",
        }
    }
}

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Compare {
    Equal,
    NotEqual,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    In,
    NotIn,
    Is,
    IsNot,
}

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Form {
    List,
    Set,
    Dict,
    Generator,
}

pub(crate) struct Comprehension {
    pub form: Form,
    /// The element, or the key.
    pub element: Node,
    pub value: Option<Node>,
    pub clauses: Vec<Clause>,
}

/// `for target in items if … if …`
pub(crate) struct Clause {
    pub target: Target,
    pub items: Node,
    pub conditions: Vec<Node>,
}

pub(crate) enum Target {
    Name(Rc<str>),
    Several(usize, Vec<Target>),
}

pub(crate) struct LambdaSyntax {
    pub parameters: Vec<(Rc<str>, Option<Node>)>,
    pub body: Node,
}
