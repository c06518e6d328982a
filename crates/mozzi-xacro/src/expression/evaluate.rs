//! Evaluates a syntax tree.

use crate::expression::library::function;
use crate::expression::library::methods;
use crate::expression::operations::arguments::Arguments;
use crate::expression::operations::compare;
use crate::expression::operations::context::Evaluator;
use crate::expression::operations::host::Host;
use crate::expression::operations::index;
use crate::expression::operations::operators;
use crate::expression::syntax::names::KEYWORDS;
use crate::expression::syntax::{Argument, Binary, Compare, Kind, Node, Unary};
use crate::expression::values::kinds;
use crate::expression::values::value::Dictionary;
use crate::expression::values::value::{Bindings, Lambda, Value, bind};
use crate::fault::{Fault, Result};
use std::cell::RefCell;
use std::rc::Rc;

/// The value of a tree for a host.
pub(crate) fn evaluate(host: &dyn Host, node: &Node) -> Result<Value> {
    let calls = |cx: &Evaluator, called: &Value, arguments| cx.call_value(called, arguments);
    Evaluator { host, calls, attributes: methods::attribute }.value(node, &None)
}

impl Evaluator<'_> {
    /// The value of a node; an error gets the node's place, if it has none of its own.
    pub fn value(&self, node: &Node, bindings: &Bindings) -> Result<Value> {
        let budget = self.host.budget();
        budget.spend(1).and_then(|()| budget.deeper(|| self.part(node, bindings))).map_err(|fault| fault.or_at(node.at))
    }

    fn part(&self, node: &Node, bindings: &Bindings) -> Result<Value> {
        match &node.kind {
            Kind::Constant(literal) => Ok(Value::from(literal)),
            Kind::Name(name) => self.name(name, bindings),
            Kind::List(items) => Ok(Value::list(self.items(items, bindings)?)),
            Kind::Tuple(items) => Ok(Value::Tuple(self.items(items, bindings)?.into())),
            Kind::Set(items) => {
                let set = Dictionary::of_keys(self.items(items, bindings)?)?;
                Ok(Value::Set(Rc::new(RefCell::new(set))))
            }
            Kind::Dict(entries) => self.dictionary(entries, bindings),
            Kind::Unary(operator, operand) => self.unary(*operator, operand, bindings),
            Kind::Binary(operator, operands) => self.binary(*operator, operands, bindings),
            Kind::Compare(first, others) => self.comparison(first, others, bindings),
            Kind::And(parts) => self.until(parts, false, bindings),
            Kind::Or(parts) => self.until(parts, true, bindings),
            Kind::Choice(parts) => {
                let (condition, then, other) = &**parts;
                let chosen = if self.value(condition, bindings)?.truth() { then } else { other };
                self.value(chosen, bindings)
            }
            Kind::Call(called, arguments) => self.call_node(called, arguments, bindings),
            Kind::Attribute(of, name) => {
                let of = self.value(of, bindings)?;
                methods::attribute(self, &of, name)
            }
            Kind::Index(parts) => {
                let (of, at) = (self.value(&parts.0, bindings)?, self.value(&parts.1, bindings)?);
                index::item(&of, &at)
            }
            Kind::Slice(parts) => self.slice(&parts.0, &parts.1, bindings),
            Kind::Comprehension(parts) => self.comprehension(parts, bindings),
            Kind::Lambda(syntax) => {
                let default = |(_, default): &(_, Option<Node>)| {
                    default.as_ref().map(|default| self.value(default, bindings)).transpose()
                };
                let defaults = syntax.parameters.iter().map(default).collect::<Result<_>>()?;
                Ok(Value::Lambda(Rc::new(Lambda { syntax: syntax.clone(), defaults, bindings: bindings.clone() })))
            }
            Kind::Starred(_) => Err(Fault::new("`*` is not allowed here")),
        }
    }

    fn name(&self, name: &Rc<str>, bindings: &Bindings) -> Result<Value> {
        let mut inner = bindings;
        while let Some(binding) = inner {
            if *binding.name == **name {
                return Ok(binding.value.clone());
            }
            inner = &binding.outer;
        }
        if name.starts_with("__") {
            return Err(Fault::new(format!("the name `{name}` is not allowed: it begins with two underscores")));
        }
        self.host.lookup(name, bindings.is_some())?.ok_or_else(|| Fault::new(unknown_name(name)))
    }

    /// The items of a display, `*items` among them.
    fn items(&self, nodes: &[Node], bindings: &Bindings) -> Result<Vec<Value>> {
        let mut items = Vec::with_capacity(nodes.len());
        for node in nodes {
            match &node.kind {
                Kind::Starred(inner) => items.extend(self.all_items(&self.value(inner, bindings)?)?),
                _ => items.push(self.value(node, bindings)?),
            }
        }
        Ok(items)
    }

    fn dictionary(&self, nodes: &[(Option<Node>, Node)], bindings: &Bindings) -> Result<Value> {
        let mut entries = Dictionary::default();
        for (key, value) in nodes {
            match key {
                Some(key) => {
                    let key = self.value(key, bindings)?;
                    entries.insert(key, self.value(value, bindings)?)?;
                }
                None => match self.value(value, bindings)? {
                    Value::Dict(others, _) => {
                        self.host.budget().items(others.borrow().len())?;
                        others.borrow().entries().iter().try_for_each(|(k, v)| entries.insert(k.clone(), v.clone()))?;
                    }
                    other => return Err(Fault::new(format!("`**` takes a dict, found a {}", other.kind()))),
                },
            }
        }
        Ok(Value::dict(entries))
    }

    fn unary(&self, operator: Unary, operand: &Node, bindings: &Bindings) -> Result<Value> {
        let value = self.value(operand, bindings)?;
        operators::unary(operator, &value)
    }

    fn binary(&self, operator: Binary, operands: &(Node, Node), bindings: &Bindings) -> Result<Value> {
        let left = self.value(&operands.0, bindings)?;
        let right = self.value(&operands.1, bindings)?;
        operators::binary(self, operator, &left, &right)
    }

    fn comparison(&self, first: &Node, others: &[(usize, Compare, Node)], bindings: &Bindings) -> Result<Value> {
        let mut left = self.value(first, bindings)?;
        let mut result = true;
        for (at, operator, node) in others {
            if !result {
                break;
            }
            let right = self.value(node, bindings)?;
            result = compare::holds(self, *operator, &left, &right).map_err(|fault| fault.or_at(*at))?;
            left = right;
        }
        Ok(Value::Bool(result))
    }

    /// `and` and `or`: the first value with this truth, or the last one.
    fn until(&self, parts: &[Node], stop: bool, bindings: &Bindings) -> Result<Value> {
        let mut value = Value::None;
        for part in parts {
            value = self.value(part, bindings)?;
            if value.truth() == stop {
                break;
            }
        }
        Ok(value)
    }

    fn slice(&self, of: &Node, bounds: &[Option<Node>; 3], bindings: &Bindings) -> Result<Value> {
        let of = self.value(of, bindings)?;
        let mut values = [None, None, None];
        for (value, bound) in values.iter_mut().zip(bounds) {
            if let Some(bound) = bound {
                let bound = self.value(bound, bindings)?;
                *value = if matches!(bound, Value::None) { None } else { Some(kinds::whole(&bound, "a slice")?) };
            }
        }
        index::slice(self, &of, values)
    }

    fn call_node(&self, called: &Node, arguments: &[Argument], bindings: &Bindings) -> Result<Value> {
        // a method call on a receiver, without a bound-method object
        let (method, function) = match &called.kind {
            Kind::Attribute(of, name) => {
                let of = self.value(of, bindings)?;
                match methods::has(&of, name) {
                    true => (Some((of, name)), None),
                    false => {
                        let found = methods::attribute(self, &of, name).map_err(|fault| fault.or_at(called.at))?;
                        (None, Some(found))
                    }
                }
            }
            _ => (None, Some(self.value(called, bindings)?)),
        };
        let mut given = Arguments::default();
        for argument in arguments {
            match argument {
                Argument::Positional(node) => given.positional.push(self.value(node, bindings)?),
                Argument::Keyword(name, node) => given.named.push((name.clone(), self.value(node, bindings)?)),
                Argument::Items(node) => given.positional.extend(self.all_items(&self.value(node, bindings)?)?),
                Argument::Keywords(node) => match self.value(node, bindings)? {
                    Value::Dict(entries, _) => {
                        for (key, value) in entries.borrow().entries() {
                            let Value::Str(key) = key else {
                                return Err(Fault::new("`**` takes a dict whose keys are strings"));
                            };
                            given.named.push((key.clone(), value.clone()));
                        }
                    }
                    other => return Err(Fault::new(format!("`**` takes a dict, found a {}", other.kind()))),
                },
            }
        }
        match (method, function) {
            (Some((of, name)), _) => methods::call(self, &of, name, given),
            (None, Some(function)) => self.call(&function, given),
            (None, None) => Err(Fault::new("nothing to call")),
        }
    }

    /// Calls a function, a method or a lambda.
    fn call_value(&self, called: &Value, mut arguments: Arguments) -> Result<Value> {
        self.spend(1)?;
        match called {
            Value::Function(function) => function::call(self, *function, arguments),
            Value::Method(method) => methods::call(self, &method.0, &method.1, arguments),
            Value::Lambda(lambda) => {
                let mut bindings = lambda.bindings.clone();
                let mut positional = std::mem::take(&mut arguments.positional).into_iter();
                for ((name, _), default) in lambda.syntax.parameters.iter().zip(&lambda.defaults) {
                    let given = positional.next().or_else(|| arguments.take(name)).or_else(|| default.clone());
                    let value =
                        given.ok_or_else(|| Fault::new(format!("the lambda's argument `{name}` is missing")))?;
                    bindings = bind(&bindings, name, value);
                }
                if positional.next().is_some() || !arguments.named.is_empty() {
                    return Err(Fault::new("the lambda is called with too many arguments"));
                }
                self.value(&lambda.syntax.body, &bindings)
            }
            other => Err(Fault::new(format!("a {} cannot be called", other.kind()))),
        }
    }
}

/// Python builtins that xacro has under another name, or not at all.
fn unknown_name(name: &str) -> String {
    let hint = if function::module_has("python", name) {
        format!("; Python's function is `python.{name}`")
    } else if name == "true" || name == "false" {
        format!("; did you mean `{}{}`?", name[..1].to_uppercase(), &name[1..])
    } else if KEYWORDS.contains(&name) {
        "; it is a keyword".to_string()
    } else {
        String::new()
    };
    format!("the name `{name}` is not defined{hint}")
}
