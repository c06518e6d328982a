//! `<default>`: classes of values for attributes that are not written.

use super::attributes::{Item, Values};
use super::law::{self, Law};
use super::vocabulary;
use crate::report::finding::Finding;
use crate::report::spelling::did_you_mean;
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::vocabulary::{Vocabulary, shown};
use std::collections::BTreeMap;
use std::rc::Rc;

/// Largest number of names that are searched for suggestions.
pub(crate) const MOST_SUGGESTED: usize = 100;
/// Longer values are refused: a class's values are read again for each element that uses the class.
const LONGEST_VALUE: usize = 256;

/// The index of a class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Class(usize);

impl Class {
    /// The outermost class.
    pub const MAIN: Class = Class(0);
}

/// All classes. A class contains the values that it inherits, as they were when it was created.
pub(crate) struct Classes<'a> {
    names: BTreeMap<String, Class>,
    values: Vec<BTreeMap<&'static str, Rc<Values<'a>>>>,
    /// The laws of actuators.
    laws: Vec<Law>,
}

/// The elements that each default applies to, and the attributes that are read.
fn of_tag(tag: &str) -> Option<(&'static str, &'static Vocabulary)> {
    Some(match tag {
        "joint" => ("joint", &vocabulary::JOINT),
        "geom" => ("geom", &vocabulary::GEOM),
        "site" => ("site", &vocabulary::SITE),
        "equality" => ("equality", &vocabulary::COUPLING),
        "tendon" => ("tendon", &vocabulary::TENDON),
        // all kinds of actuators share their defaults
        tag if vocabulary::ACTUATORS.contains(&tag) => ("actuator", &vocabulary::ACTUATOR),
        _ => return None,
    })
}

impl<'a> Classes<'a> {
    pub fn read<'s>(sections: impl Iterator<Item = &'s Element<'a>>, cx: &mut Context) -> Self
    where
        'a: 's,
    {
        let mut classes = Classes { names: BTreeMap::new(), values: vec![BTreeMap::new()], laws: vec![Law::default()] };
        for section in sections {
            let name = section.attribute("class").map(|name| name.text.to_string());
            let class = if section.is_attached() { classes.outermost(name.as_deref()) } else { Class::MAIN };
            if let Some(name) = name {
                classes.names.insert(name, class);
            }
            classes.fill(section, class, 0, cx);
        }
        classes.names.entry("main".to_string()).or_insert(Class::MAIN);
        classes
    }

    /// The outermost class of a model of which a part is attached: it inherits nothing.
    fn outermost(&mut self, name: Option<&str>) -> Class {
        if let Some(&class) = name.and_then(|name| self.names.get(name)) {
            return class;
        }
        self.values.push(BTreeMap::new());
        self.laws.push(Law::default());
        Class(self.values.len() - 1)
    }

    /// The values of one class, then the classes inside it.
    fn fill(&mut self, element: &Element<'a>, class: Class, depth: usize, cx: &mut Context) {
        element.check_attributes(&vocabulary::DEFAULT, cx);
        element.check_children(&vocabulary::DEFAULT, cx);
        if super::depth::is_too_deep(element, depth, cx) {
            return;
        }
        for child in element.elements() {
            let Some((tag, words)) = of_tag(child.name()) else {
                match child.name() {
                    "mesh" => self.keep(class, "mesh", &["scale", "inertia", "maxhullvert"], &child),
                    "material" => self.keep(class, "material", &["rgba"], &child),
                    _ => {}
                }
                if let Some(known) =
                    vocabulary::DEFAULT.many.iter().find(|&&known| known == child.name() && known != "default")
                {
                    cx.leave_out("default", known, child.span());
                }
                continue;
            };
            if tag == "actuator" {
                child.check_attributes(&law::ANY_ACTUATOR, cx);
                self.laws[class.0].apply(&child, cx);
            } else {
                child.check_attributes(words, cx);
            }
            if tag == "geom" {
                self.keep(class, tag, &vocabulary::LOOKS, &child);
            }
            let values = Rc::make_mut(self.values[class.0].entry(tag).or_default());
            for &name in words.attributes {
                let Some(value) = child.attribute(name) else { continue };
                if value.text.len() > LONGEST_VALUE {
                    let found = value.text.len();
                    let message =
                        format!("{}: {name}: has {found} bytes, expected at most {LONGEST_VALUE}", child.subject);
                    cx.findings.error("long_value", value.span, message);
                    continue;
                }
                // an outer class's value still matters only if it has more numbers than this one
                let values = values.entry(name).or_default();
                let count = value.text.split_ascii_whitespace().count();
                values.retain(|outer| outer.text.split_ascii_whitespace().count() > count);
                values.push(value);
            }
        }
        for child in element.elements().filter(|child| child.name() == "default") {
            let Some(name) = child.required_name("class", cx) else { continue };
            if self.names.contains_key(name.text) {
                let message =
                    format!("default: the class `{}` is used twice, expected a unique name", shown(name.text));
                cx.findings.error("duplicate_name", name.span, message);
                continue;
            }
            let inner = Class(self.values.len());
            self.values.push(self.values[class.0].clone());
            self.laws.push(self.laws[class.0].clone());
            self.names.insert(name.text.to_string(), inner);
            self.fill(&child.called(format!("default `{}`", shown(name.text))), inner, depth + 1, cx);
        }
    }

    /// Keeps attributes that only shapes use.
    fn keep(&mut self, class: Class, tag: &'static str, names: &[&'static str], element: &Element<'a>) {
        let values = Rc::make_mut(self.values[class.0].entry(tag).or_default());
        for &name in names {
            if let Some(value) = element.attribute(name).filter(|value| value.text.len() <= LONGEST_VALUE) {
                values.insert(name, vec![value]);
            }
        }
    }

    /// The class named by an attribute, or `otherwise`.
    pub fn named(&self, element: &Element<'a>, attribute: &str, otherwise: Class, cx: &mut Context) -> Class {
        let Some(value) = element.attribute(attribute) else { return otherwise };
        if let Some(&class) = self.names.get(value.text) {
            return class;
        }
        let message = format!("{}: {attribute}: there is no default class `{}`", element.subject, shown(value.text));
        let known = self.names.keys().map(String::as_str).take(MOST_SUGGESTED);
        let help = did_you_mean(value.text, known);
        cx.findings.add(Finding::error("unknown_class", value.span, message).maybe_help(help));
        otherwise
    }

    /// The law of an actuator's class.
    pub fn law(&self, element: &Element<'a>) -> Law {
        let named = element.attribute("class").and_then(|value| self.names.get(value.text));
        self.laws[named.unwrap_or(&Class::MAIN).0].clone()
    }

    /// An element with the values of its class, or of the enclosing class.
    pub fn item(&self, element: Element<'a>, tag: &str, around: Class, cx: &mut Context) -> Item<'a> {
        let class = self.named(&element, "class", around, cx);
        let defaults = self.values[class.0].get(tag).cloned();
        Item::new(element, defaults)
    }
}
