//! An element whose values are the texts of its children.

use super::vocabulary::{POSE, XYZ};
use crate::report::finding::Finding;
use crate::text::context::Context;
use crate::text::element::{Children, Element, Value};
use crate::text::number::numbers;
use crate::urdf::vocabulary::{NOTHING, Vocabulary, shown};
use std::ops::Range;

/// Elements without attributes and children.
const LEAVES: [&str; 27] = [
    "mass",
    "ixx",
    "ixy",
    "ixz",
    "iyy",
    "iyz",
    "izz",
    "gravity",
    "kinematic",
    "static",
    "uri",
    "name",
    "placement_frame",
    "parent",
    "child",
    "lower",
    "upper",
    "effort",
    "velocity",
    "damping",
    "friction",
    "spring_reference",
    "spring_stiffness",
    "multiplier",
    "offset",
    "reference",
    "initial_position",
];

/// An element, and its children that may occur once.
pub(crate) struct Part<'a> {
    pub element: Element<'a>,
    children: Children<'a>,
}

impl<'a> Part<'a> {
    /// Reports unknown words.
    pub fn new(element: Element<'a>, words: &Vocabulary, cx: &mut Context) -> Self {
        element.check_attributes(words, cx);
        let children = element.check_children(words, cx);
        for (name, child) in &children {
            match *name {
                "pose" => child.check_attributes(&POSE, cx),
                "xyz" => child.check_attributes(&XYZ, cx),
                name if LEAVES.contains(&name) => child.check_attributes(&NOTHING, cx),
                _ => {}
            }
        }
        Part { element, children }
    }

    pub fn child(&self, name: &str) -> Option<&Element<'a>> {
        self.children.get(name)
    }

    /// The text of a child.
    pub fn value(&self, name: &str) -> Option<Value<'a>> {
        self.child(name).map(Element::content)
    }

    /// The place of a child's text, or of this element.
    pub fn span(&self, name: &str) -> Range<usize> {
        self.value(name).map_or_else(|| self.element.span(), |value| value.span)
    }

    /// N numbers; None if there is no such child or, with a diagnostic, if they are invalid.
    pub fn vector<const N: usize>(&self, name: &str, cx: &mut Context) -> Option<[f64; N]> {
        let value = self.value(name)?;
        self.element.vector::<N>(name, &value, cx)
    }

    pub fn number(&self, name: &str, default: f64, cx: &mut Context) -> f64 {
        self.vector::<1>(name, cx).map_or(default, |[x]| x)
    }

    /// A number that may be infinite.
    pub fn bound(&self, name: &str, cx: &mut Context) -> Option<f64> {
        let value = self.value(name)?;
        match value.text.to_ascii_lowercase().as_str() {
            "inf" | "+inf" | "infinity" => Some(f64::INFINITY),
            "-inf" | "-infinity" => Some(f64::NEG_INFINITY),
            _ => self.vector::<1>(name, cx).map(|[x]| x),
        }
    }

    /// `true` or `false`, `1` or `0`.
    pub fn flag(&self, name: &str, default: bool, cx: &mut Context) -> bool {
        let Some(value) = self.value(name) else { return default };
        truth(&self.element, name, &value, cx).unwrap_or(default)
    }

    /// A required child's text, which is a name.
    pub fn name_of(&self, name: &str, cx: &mut Context) -> Option<Value<'a>> {
        let value = self.value(name);
        if value.as_ref().is_none_or(|value| value.text.is_empty()) {
            let message = format!("{}: has no <{name}>", self.element.subject);
            let help = format!("name the link or frame: <{name}>…</{name}>");
            cx.findings.add(Finding::error("missing_element", self.element.span(), message).help(help));
            return None;
        }
        value
    }
}

/// A truth value; None, with a diagnostic, if it is another word.
pub(crate) fn truth(element: &Element, name: &str, value: &Value, cx: &mut Context) -> Option<bool> {
    match value.text.to_ascii_lowercase().as_str() {
        "true" | "1" => Some(true),
        "false" | "0" => Some(false),
        other if numbers::<1>(other).is_ok_and(|[x]| x == 0.0) => Some(false),
        other => {
            let message = format!("{}: {name}: is `{}`, expected `true` or `false`", element.subject, shown(other));
            cx.findings.error("unknown_word", value.span.clone(), message);
            None
        }
    }
}
