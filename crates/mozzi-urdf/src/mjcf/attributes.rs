//! The attributes of an element, its own and those of its class.

use crate::report::finding::Finding;
use crate::report::spelling::did_you_mean;
use crate::text::context::Context;
use crate::text::element::{Element, Value};
use crate::text::number::{NotNumbers, numbers, up_to};
use crate::urdf::vocabulary::{list, shown};
use std::collections::BTreeMap;
use std::rc::Rc;

/// The values of attributes, outermost class first.
pub(crate) type Values<'a> = BTreeMap<&'static str, Vec<Value<'a>>>;

/// An element with or without a default class.
#[derive(Clone)]
pub(crate) struct Item<'a> {
    pub element: Element<'a>,
    pub defaults: Option<Rc<Values<'a>>>,
}

impl<'a> Item<'a> {
    pub fn new(element: Element<'a>, defaults: Option<Rc<Values<'a>>>) -> Self {
        Item { element, defaults }
    }

    /// An element without a class.
    pub fn plain(element: &Element<'a>) -> Self {
        Item { element: element.clone(), defaults: None }
    }

    fn inherited(&self, name: &str) -> &[Value<'a>] {
        self.defaults.as_ref().and_then(|values| values.get(name)).map_or(&[], Vec::as_slice)
    }

    /// The value of an attribute, from the element itself or its class.
    pub fn value(&self, name: &str) -> Option<Value<'a>> {
        self.element.attribute(name).or_else(|| self.inherited(name).last().cloned())
    }

    /// True if the element itself or its class has the attribute.
    pub fn has(&self, name: &str) -> bool {
        self.value(name).is_some()
    }

    /// N numbers; None if there are none or, with a diagnostic, if they are invalid.
    pub fn vector<const N: usize>(&self, name: &str, cx: &mut Context) -> Option<[f64; N]> {
        let value = self.value(name)?;
        match numbers::<N>(value.text) {
            Ok(vector) => Some(vector),
            Err(error) => self.unreadable(name, &value, error, cx),
        }
    }

    pub fn number(&self, name: &str, default: f64, cx: &mut Context) -> f64 {
        self.vector::<1>(name, cx).map_or(default, |[x]| x)
    }

    /// At most N numbers. Missing ones are taken from the class; the rest are zero.
    pub fn overlaid<const N: usize>(&self, name: &str, cx: &mut Context) -> [f64; N] {
        let own = self.element.attribute(name);
        let mut result = [0.0; N];
        for value in self.inherited(name).iter().chain(own.as_ref()) {
            match up_to::<N>(value.text) {
                Ok((numbers, found)) if found <= N => result[..found].copy_from_slice(&numbers[..found]),
                Ok((_, found)) => {
                    self.unreadable::<()>(name, value, NotNumbers::Count { found, expected: N }, cx);
                }
                Err(error) => {
                    self.unreadable::<()>(name, value, error, cx);
                }
            }
        }
        result
    }

    /// Reported once, even if many elements take it from their class.
    fn unreadable<T>(&self, name: &str, value: &Value<'a>, error: NotNumbers, cx: &mut Context) -> Option<T> {
        if cx.unreadable.insert(value.span.start) {
            self.element.report_numbers(name, value, error, cx);
        }
        None
    }

    /// One of some words; None if there is none or, with a diagnostic, if it is another word.
    pub fn word(&self, name: &str, known: &[&'static str], cx: &mut Context) -> Option<&'static str> {
        let value = self.value(name)?;
        let found = known.iter().copied().find(|&word| word == value.text);
        if found.is_none() && cx.unreadable.insert(value.span.start) {
            let (subject, text) = (&self.element.subject, shown(value.text));
            let message = format!("{subject}: {name}: is `{text}`, expected one of {}", list(known));
            let help = did_you_mean(value.text, known.iter().copied());
            cx.findings.add(Finding::error("unknown_word", value.span, message).maybe_help(help));
        }
        found
    }

    /// `true` or `false`.
    pub fn flag(&self, name: &str, default: bool, cx: &mut Context) -> bool {
        self.word(name, &["true", "false"], cx).map_or(default, |word| word == "true")
    }

    /// An error at an attribute, or at the element if the attribute is not written.
    pub fn error(&self, code: &'static str, name: &str, message: &str) -> Finding {
        let span = self.value(name).map_or_else(|| self.element.span(), |value| value.span);
        Finding::error(code, span, format!("{}: {message}", self.element.subject))
    }
}
