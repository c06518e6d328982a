//! `<xacro:macro>` and its calls.

use crate::bounds::MOST_CALLS;
use crate::condition::literal;
use crate::document::{Attribute, Content, Id};
use crate::expander::Expander;
use crate::expression::Value;
use crate::fault::{Fault, Result};
use crate::parameters;
use crate::place::{Call, Place};
use crate::scope::{Definition, Macro, Macros, Parameter, Property, Scope};
use std::rc::Rc;
use std::sync::Arc;

/// The number of characters shown of a call's arguments.
const SHOWN: usize = 120;

impl Expander<'_> {
    pub fn define_macro(&self, id: Id, macros: &Rc<Macros>) -> Result<()> {
        self.remove_comments_before(id);
        let name = self.checked(id, &["name"], &["params"])?.value;
        if *name == *"call" {
            return Err(Fault::new("the macro's name is `call`, which is reserved for <xacro:call>"));
        }
        if name.contains('.') {
            return Err(Fault::new(format!(
                "the macro's name is `{name}`, expected no `.`, which is reserved for namespaces"
            )));
        }
        let params = self.optional(id, "params").map(|params| params.value);
        let parameters = parameters::parse(params.as_deref().unwrap_or_default());
        let name = name.strip_prefix("xacro:").unwrap_or(&name);
        macros.set(name, Definition::Macro(Rc::new(Macro { body: id, parameters })));
        self.document.borrow_mut().remove(id);
        Ok(())
    }

    /// The macro of a name, maybe with namespaces before it, and the scopes in which it is expanded.
    fn find_macro(
        &self,
        name: &str,
        macros: &Rc<Macros>,
        scope: &Rc<Scope>,
    ) -> Result<(Rc<Macro>, Rc<Macros>, Rc<Scope>)> {
        if let Some(Definition::Macro(found)) = macros.find(name) {
            return Ok((found, macros.clone(), scope.clone()));
        }
        let (mut macros_there, mut scope_there) = (macros.clone(), scope.clone());
        let unknown = || {
            let known = macros.known();
            let near = known.iter().find(|known| known.eq_ignore_ascii_case(name)).or(known.iter().min());
            let hint = near.map_or(String::new(), |near| format!("; a macro `{near}` is known"));
            Fault::new(format!(
                "the macro `{name}` is not defined{}",
                if near.is_some() { hint } else { String::new() }
            ))
        };
        let mut words = name.split('.').peekable();
        while let Some(word) = words.next() {
            let found = macros_there.find(word);
            match (found, words.peek()) {
                (Some(Definition::Macro(found)), None) => return Ok((found, macros_there, scope_there)),
                (Some(Definition::Namespace(inner)), Some(_)) => {
                    let Some((_, Property::Value(Value::Namespace(properties)))) = scope_there.find(word) else {
                        return Err(Fault::new(format!("`{word}` is not a namespace here")));
                    };
                    (macros_there, scope_there) = (inner, properties);
                }
                _ => return Err(unknown()),
            }
        }
        Err(unknown())
    }

    pub fn call_macro(&self, id: Id, name: &str, macros: &Rc<Macros>, scope: &Rc<Scope>) -> Result<()> {
        if name == "call" {
            let dynamic = self.required(id, "macro")?;
            if dynamic.value.is_empty() {
                return Err(Fault::new("<xacro:call> has an empty attribute `macro`"));
            }
            let name = self.evaluate_text(&dynamic.value, scope, &dynamic.place)?;
            self.document.borrow_mut().remove_attribute(id, "macro");
            return self.budget.deeper(|| self.call_macro(id, &name, macros, scope));
        }
        if self.calls.get() >= MOST_CALLS {
            return Err(Fault::new(format!(
                "more than {MOST_CALLS} macros call each other; does one call itself without end?"
            )));
        }
        self.calls.set(self.calls.get() + 1);
        let done = self.expand_macro(id, name, macros, scope);
        self.calls.set(self.calls.get() - 1);
        done
    }

    fn expand_macro(&self, id: Id, name: &str, macros: &Rc<Macros>, scope: &Rc<Scope>) -> Result<()> {
        let (called, macros_there, scope_there) = self.find_macro(name, macros, scope)?;
        let (inner_scope, inner_macros) = (Scope::inside(&scope_there), Macros::inside(&macros_there));
        let place = self.place_of(id);
        let mut missing: Vec<Parameter> = called.parameters.clone();
        let mut shown = Vec::new();
        let attributes = self.document.borrow().attributes(id).to_vec();
        for attribute in &attributes {
            let Some(at) = missing.iter().position(|parameter| parameter.name == attribute.name) else {
                let fault =
                    Fault::new(format!("the macro `{name}` has no parameter `{}`{}", attribute.name, listed(&called)));
                return Err(self.placed(fault, "", &self.name_place(attribute)));
            };
            missing.remove(at);
            let value = literal(self.evaluate(&attribute.value, scope, &attribute.place)?);
            shown.push((attribute.name.clone(), value.clone()));
            inner_scope.set(&attribute.name, Property::Value(value));
        }
        if let Content::Element { attributes, .. } = self.document.borrow_mut().content_mut(id) {
            attributes.retain(|_| false);
        }
        // blocks are evaluated by the caller
        self.evaluate_node(id, macros, scope)?;
        let blocks: Vec<Id> = self.document.borrow().element_children(id).collect();
        let mut next = blocks.into_iter();
        for parameter in called.parameters.iter().filter(|parameter| parameter.name.starts_with('*')) {
            let Some(block) = next.next() else {
                return Err(Fault::new(format!("the macro `{name}` is called without the block `{}`", parameter.name)));
            };
            missing.retain(|other| other.name != parameter.name);
            inner_scope.set(&parameter.name, Property::Block(block));
        }
        if let Some(unused) = next.next() {
            let fault = Fault::new(format!("the macro `{name}` does not take this block"));
            return Err(self.located(fault, unused));
        }
        let mut absent = Vec::new();
        for parameter in missing {
            match self.default(&parameter, scope, &called)? {
                Some(value) => inner_scope.set(&parameter.name, Property::Value(literal(value))),
                None => absent.push(format!("`{}`", parameter.name)),
            }
        }
        if !absent.is_empty() {
            return Err(Fault::new(format!("the macro `{name}` is called without {}", absent.join(", "))));
        }
        let call = Arc::new(Call { place, arguments: shown_arguments(&shown) });
        let body = self.document.borrow_mut().copy(called.body, Some(&call), &self.budget)?;
        self.evaluate_node(body, &inner_macros, &inner_scope)?;
        self.remove_comments_before(id);
        let declared = self.document.borrow().attributes(body).to_vec();
        let parent = self.document.borrow().node(id).parent;
        if let Some(parent) = parent {
            self.import_namespaces(parent, &declared);
        }
        self.document.borrow_mut().replace_by_content(id, &[body]);
        Ok(())
    }

    /// The value of a parameter that the caller does not give.
    fn default(&self, parameter: &Parameter, scope: &Rc<Scope>, called: &Macro) -> Result<Option<Value>> {
        if parameter.forwards {
            if let Some(value) =
                self.property(&parameter.name, scope)?.or_else(|| crate::expression::global(&parameter.name))
            {
                return Ok(Some(value));
            }
            if parameter.default.is_none() {
                return Err(Fault::new(format!(
                    "the parameter `{}` is forwarded, but no property has this name here",
                    parameter.name
                )));
            }
        }
        let Some(default) = &parameter.default else { return Ok(None) };
        let place =
            self.optional(called.body, "params").map_or_else(|| self.place_of(called.body), |params| params.place);
        self.evaluate(default, scope, &place).map(Some)
    }

    fn name_place(&self, attribute: &Attribute) -> Place {
        let end = attribute.name_start + attribute.name.len() as u32;
        Place { start: attribute.name_start, end, ..attribute.place.clone() }
    }
}

fn listed(called: &Macro) -> String {
    let names: Vec<String> = called.parameters.iter().map(|parameter| format!("`{}`", parameter.name)).collect();
    if names.is_empty() { ", it has none".to_string() } else { format!(", expected {}", names.join(", ")) }
}

/// `prefix = "left_", mass = 2.5`
fn shown_arguments(arguments: &[(Rc<str>, Value)]) -> String {
    let mut shown = String::new();
    for (name, value) in arguments {
        let value = match value {
            Value::Str(text) => format!("{:?}", text.chars().take(SHOWN).collect::<String>()),
            Value::Bool(_) | Value::Int(_) | Value::Float(_) | Value::None => crate::expression::short(value),
            other => other.kind().to_string(),
        };
        shown.push_str(if shown.is_empty() { "" } else { ", " });
        shown.push_str(&format!("{name} = {value}"));
    }
    match shown.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", &shown[..end]),
        None => shown,
    }
}
