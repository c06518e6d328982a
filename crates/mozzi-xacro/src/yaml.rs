//! `xacro.load_yaml`: a file of YAML 1.1 as values. The syntax is parsed by saphyr-parser; scalars are interpreted
//! here, because crates follow YAML 1.2, in which `010` and `yes` have other meanings than in xacro.

use crate::expander::Expander;
use crate::expander::Names;
use crate::expression::{Dictionary, Host, Value, evaluate, parse};
use crate::fault::{Fault, Result};
use crate::scope::Scope;
use crate::yaml_scalar::plain;
use saphyr_parser::{Event, Parser, ScalarStyle, Tag};
use std::collections::HashMap;
use std::rc::Rc;

/// The deepest nesting.
const MOST_DEPTH: usize = 100;

/// A collection that is being read.
enum Open {
    List(Vec<Value>, usize),
    Dict { entries: Dictionary, merged: Vec<Value>, key: Option<Value>, anchor: usize },
}

impl Expander<'_> {
    /// The content of a file next to the one that is being processed; its dictionaries allow dotted access.
    pub fn load_yaml(&self, file: &str) -> Result<Value> {
        let path = self.beside(file);
        let text = self.text_of(&path)?;
        self.add_file(&path.to_string_lossy(), "")?;
        self.budget.spend(1 + text.len() as u64 / 8)?;
        let within = |mut fault: Box<Fault>| {
            fault.message = format!("{}: {}", path.display(), fault.message);
            fault.at = None;
            fault
        };
        let value = self.yaml(&text).map_err(within)?;
        Ok(value.dotted())
    }

    fn yaml(&self, text: &str) -> Result<Value> {
        let (mut open, mut anchors): (Vec<Open>, HashMap<usize, Value>) = (Vec::new(), HashMap::new());
        let (mut root, mut documents) = (None, 0);
        for event in Parser::new_from_str(text) {
            self.budget.spend(1)?;
            let (event, span) =
                event.map_err(|why| Fault::new(format!("line {}: not YAML: {}", why.marker().line(), why.info())))?;
            let at_line = |mut fault: Box<Fault>| {
                fault.message = format!("line {}: {}", span.start.line(), fault.message);
                fault
            };
            let done = match event {
                Event::DocumentStart(_) => {
                    documents += 1;
                    if documents > 1 {
                        return Err(at_line(Fault::new("a second document begins, expected one")));
                    }
                    continue;
                }
                Event::SequenceStart(anchor, tag) => {
                    refuse_tag(tag.as_deref(), &["seq"]).map_err(at_line)?;
                    open.push(Open::List(Vec::new(), anchor));
                    None
                }
                Event::MappingStart(anchor, tag) => {
                    refuse_tag(tag.as_deref(), &["map"]).map_err(at_line)?;
                    open.push(Open::Dict { entries: Dictionary::default(), merged: Vec::new(), key: None, anchor });
                    None
                }
                Event::SequenceEnd | Event::MappingEnd => match open.pop() {
                    Some(Open::List(items, anchor)) => Some((Value::list(items), anchor)),
                    Some(Open::Dict { entries, merged, anchor, .. }) => {
                        Some((Value::dict(merge(entries, merged).map_err(at_line)?), anchor))
                    }
                    None => None,
                },
                Event::Scalar(text, style, anchor, tag) => {
                    let is_key = matches!(open.last(), Some(Open::Dict { key: None, .. }));
                    let is_merge = is_key && text == "<<" && style == ScalarStyle::Plain && tag.is_none();
                    let value =
                        if is_merge { Ok(Value::Module("<<")) } else { self.scalar(&text, style, tag.as_deref()) };
                    Some((value.map_err(at_line)?, anchor))
                }
                Event::Alias(anchor) => {
                    let value = anchors.get(&anchor).cloned();
                    Some((
                        value.ok_or_else(|| at_line(Fault::new("an alias of what contains it is not supported")))?,
                        0,
                    ))
                }
                _ => None,
            };
            if open.len() > MOST_DEPTH {
                return Err(at_line(Fault::new(format!("more than {MOST_DEPTH} levels"))));
            }
            let Some((value, anchor)) = done else { continue };
            if anchor > 0 {
                anchors.insert(anchor, value.clone());
            }
            match open.last_mut() {
                None => root = Some(value),
                Some(Open::List(items, _)) => items.push(value),
                Some(Open::Dict { entries, merged, key, .. }) => match key.take() {
                    None => *key = Some(value),
                    Some(Value::Module("<<")) => merged.push(value),
                    Some(known) => entries.insert(known, value).map_err(at_line)?,
                },
            }
        }
        Ok(root.unwrap_or(Value::None))
    }

    fn scalar(&self, text: &str, style: ScalarStyle, tag: Option<&Tag>) -> Result<Value> {
        let Some(tag) = tag else {
            return if style == ScalarStyle::Plain { plain(text) } else { Ok(Value::text(text)) };
        };
        if tag.is_yaml_core_schema() {
            return match (&*tag.suffix, plain(text)) {
                ("str", _) => Ok(Value::text(text)),
                ("null", _) => Ok(Value::None),
                ("int", Ok(value @ Value::Int(_))) | ("float", Ok(value @ Value::Float(_))) => Ok(value),
                ("float", Ok(Value::Int(number))) => crate::expression::float_of(&Value::Int(number)).map(Value::Float),
                ("float", Ok(Value::Str(text))) if crate::expression::parse_float(&text).is_some() => {
                    Ok(Value::Float(crate::expression::parse_float(&text).unwrap_or(f64::NAN)))
                }
                ("bool", Ok(value @ Value::Bool(_))) => Ok(value),
                (other, _) => Err(Fault::new(format!("`{text}` is not a value of the tag `!!{other}`"))),
            };
        }
        let unit = match (&*tag.handle, &*tag.suffix) {
            ("!", "radians" | "meters") => 1.0,
            ("!", "degrees") => std::f64::consts::PI / 180.0,
            ("!", "millimeters") => 0.001,
            ("!", "foot") => 0.3048,
            ("!", "inches") => 0.0254,
            ("!", "") => return Ok(Value::text(text)),
            (handle, suffix) => return Err(Fault::new(format!("the tag `{handle}{suffix}` is unknown"))),
        };
        // an expression that sees functions and constants only
        let scope = Rc::new(Scope::default());
        let names = Names { expander: self, scope: &scope };
        let tree = parse(text.trim_matches(crate::space::is_space))?;
        let value = evaluate(&names as &dyn Host, &tree)?;
        let number = match &value {
            Value::Str(text) => crate::expression::parse_float(text),
            other => crate::expression::float_of(other).ok(),
        };
        let number = number.ok_or_else(|| Fault::new(format!("`{text}` is a {}, expected a number", value.kind())))?;
        Ok(Value::Float(number * unit))
    }
}

fn refuse_tag(tag: Option<&Tag>, known: &[&str]) -> Result<()> {
    match tag {
        Some(tag) if !(tag.is_yaml_core_schema() && known.contains(&&*tag.suffix)) => {
            Err(Fault::new(format!("the tag `{}{}` is unknown here", tag.handle, tag.suffix)))
        }
        _ => Ok(()),
    }
}

/// `<<`: the entries of other dictionaries come first; own entries replace them.
fn merge(own: Dictionary, merged: Vec<Value>) -> Result<Dictionary> {
    if merged.is_empty() {
        return Ok(own);
    }
    let mut sources = Vec::new();
    for value in merged {
        match value {
            Value::List(items, _) => sources.extend(items.borrow().iter().rev().cloned()),
            other => sources.push(other),
        }
    }
    let mut all = Dictionary::default();
    for source in sources {
        let Value::Dict(entries, _) = source else {
            return Err(Fault::new(format!("`<<` takes a mapping, found a {}", source.kind())));
        };
        entries.borrow().entries().iter().try_for_each(|(key, value)| all.insert(key.clone(), value.clone()))?;
    }
    own.entries().iter().try_for_each(|(key, value)| all.insert(key.clone(), value.clone()))?;
    Ok(all)
}
