//! `$(arg …)`, `$(find …)`, `$(env …)`, `$(optenv …)`, `$(cwd)`, `$(eval …)`.

use crate::condition;
use crate::expander::Expander;
use crate::expression::{Value, evaluate, global, parse, parse_float, parse_int, text_of};
use crate::fault::{Fault, Result};
use crate::scope::Scope;
use std::rc::Rc;

const COMMANDS: [&str; 5] = ["find", "env", "optenv", "dirname", "arg"];

impl Expander<'_> {
    /// Evaluates the content of `$(…)`; always text.
    pub fn substitution(&self, written: &str, scope: &Rc<Scope>) -> Result<Value> {
        let content = match written.contains('$') {
            true => {
                let value = self.pieces(written, scope).map_err(|fault| fault.further(2))?;
                text_of(&self.budget, &value)?
            }
            false => written.to_string(),
        };
        if content == "cwd" {
            let folder = std::env::current_dir().map_err(|why| Fault::new(format!("no current folder: {why}")))?;
            return Ok(Value::text(folder.to_string_lossy()));
        }
        let whole = format!("$({content})");
        if let Some(expression) = whole.strip_prefix("$(eval ").and_then(|rest| rest.strip_suffix(')')) {
            return self.eval(expression, written == content);
        }
        let resolved = self.resolve(&whole, &COMMANDS)?;
        // a path given as an argument may name a package
        Ok(Value::text(if resolved.contains('$') { self.resolve(&resolved, &["find"])? } else { resolved }))
    }

    /// Replaces the commands of a text.
    fn resolve(&self, text: &str, commands: &[&str]) -> Result<String> {
        let mut resolved = text.to_string();
        for command in collect(text)? {
            let words: Vec<&str> = command.split(' ').filter(|word| !word.is_empty()).collect();
            let Some((name, words)) = words.split_first() else {
                return Err(Fault::new("`$()` has no command, expected `$(arg NAME)` or the like"));
            };
            if !COMMANDS.contains(name) {
                return Err(Fault::new(format!(
                    "`$({command})`: the command `{name}` is unknown, expected one of {}, eval, cwd",
                    COMMANDS.join(", ")
                )));
            }
            if commands.contains(name) {
                let value = self.command(name, words)?;
                self.budget.text(resolved.len().saturating_add(value.len()))?;
                resolved = resolved.replace(&format!("$({command})"), &value);
                self.budget.text(resolved.len())?;
            }
        }
        Ok(resolved)
    }

    /// A variable of the environment, which is noted.
    fn variable(&self, name: &str) -> Option<String> {
        let value = std::env::var(name).ok()?;
        self.variables.borrow_mut().insert(name.to_string());
        Some(value)
    }

    fn command(&self, name: &str, words: &[&str]) -> Result<String> {
        let one = || match words {
            [word] => Ok(*word),
            _ => Err(Fault::new(format!("`$({name} …)` takes one word, found {}", words.len()))),
        };
        match name {
            "arg" => {
                let key = one()?;
                let value = self.argument(key);
                value.map(|value| value.to_string()).ok_or_else(|| self.unknown_argument(key))
            }
            "env" => {
                let variable = one()?;
                self.variable(variable)
                    .ok_or_else(|| Fault::new(format!("the environment variable `{variable}` is not set")))
            }
            "optenv" => match words {
                [] => Err(Fault::new("`$(optenv …)` names no environment variable")),
                [variable, default @ ..] => Ok(self.variable(variable).unwrap_or_else(|| default.join(" "))),
            },
            "find" => self.find_package(one()?),
            _ => Err(Fault::new(
                "`$(dirname)` is not known to xacro, which refuses it; `${xacro.abs_filename('')}` is the file's folder",
            )),
        }
    }

    fn unknown_argument(&self, name: &str) -> Box<Fault> {
        Fault::new(format!("the argument `{name}` is not given and has no default; `{name}:=VALUE` gives it"))
    }

    /// `$(eval …)`: names are arguments, constants, and functions. The functions cannot be called, because the first
    /// `)` ends the command.
    fn eval(&self, expression: &str, is_as_written: bool) -> Result<Value> {
        if expression.contains("__") {
            return Err(Fault::new("`$(eval …)` must not contain two underscores in a row"));
        }
        let trimmed = expression.trim_start_matches([' ', '\t']);
        let place = |fault: Box<Fault>| match is_as_written {
            true => fault.further("$(eval ".len() + expression.len() - trimmed.len()),
            false => Box::new(Fault { at: None, ..*fault }),
        };
        let tree = parse(trimmed).map_err(place)?;
        let value = evaluate(self, &tree).map_err(place)?;
        Ok(Value::text(text_of(&self.budget, &value)?))
    }

    /// A name in `$(eval …)`.
    pub fn eval_name(&self, name: &str) -> Option<Value> {
        match name {
            "true" => return Some(Value::Bool(true)),
            "false" => return Some(Value::Bool(false)),
            _ => {}
        }
        let is_module = |value: &Value| matches!(value, Value::Module(_));
        if let Some(value) = global(name).filter(|value| !is_module(value)) {
            return Some(value);
        }
        let text = self.argument(name)?;
        let number = if text.contains('.') {
            parse_float(&text).map(Value::Float)
        } else {
            parse_int(&text, 10).map(Value::Int)
        };
        let truth = match text.to_lowercase().as_str() {
            "true" => Some(Value::Bool(true)),
            "false" => Some(Value::Bool(false)),
            _ => None,
        };
        Some(number.or(truth).unwrap_or(Value::Str(text)))
    }

    /// The truth value of an attribute, evaluated.
    pub fn truth_of(&self, text: &Rc<str>, scope: &Rc<Scope>, place: &crate::place::Place) -> Result<bool> {
        let value = self.evaluate(text, scope, place)?;
        condition::truth(&value).map_err(|fault| self.placed(fault, text, place))
    }
}

/// The contents of all `$(…)` of a text.
fn collect(text: &str) -> Result<Vec<String>> {
    #[derive(PartialEq)]
    enum State {
        Outside,
        Dollar,
        Parenthesis,
        Inside,
    }
    let (mut found, mut buffer, mut state) = (Vec::new(), String::new(), State::Outside);
    for c in text.chars() {
        match c {
            '$' => match state {
                State::Outside | State::Dollar => state = State::Dollar,
                _ => return Err(Fault::new(format!("a `$` is inside of a substitution in `{text}`"))),
            },
            '(' => match state {
                State::Dollar => state = State::Parenthesis,
                State::Outside => {}
                _ => return Err(Fault::new(format!("a `(` is inside of a substitution in `{text}`"))),
            },
            ')' => {
                if state == State::Inside {
                    found.push(std::mem::take(&mut buffer));
                }
                state = State::Outside;
            }
            _ => match state {
                State::Dollar => state = State::Outside,
                State::Parenthesis => state = State::Inside,
                _ => {}
            },
        }
        if state == State::Inside {
            buffer.push(c);
        }
    }
    Ok(found)
}
