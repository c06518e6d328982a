//! The place in the text of each element of a description, so that later diagnostics can point at it.

use crate::text::element::Value;
use mozzi::SO3;
use mozzi::model::Element;
use std::ops::Range;

/// The place of one link or joint, and of its attributes, by the names that the checks use.
#[derive(Clone, Debug, Default)]
pub(crate) struct Place {
    element: Range<usize>,
    attributes: Vec<(&'static str, Range<usize>)>,
    /// Attributes that were already reported: findings of the checks about them would be duplicates.
    reported: Vec<&'static str>,
    /// The axes in which the file gives a link's inertia, in the link's.
    pub turned: Option<SO3>,
}

impl Place {
    pub fn new(element: Range<usize>) -> Self {
        Place { element, ..Place::default() }
    }

    pub fn set(&mut self, attribute: &'static str, span: Range<usize>) {
        self.attributes.push((attribute, span));
    }

    pub fn report(&mut self, attribute: &'static str) {
        self.reported.push(attribute);
    }

    /// Keeps the value's place, or notes that its absence was reported; returns its text.
    pub fn note(&mut self, attribute: &'static str, value: Option<Value>) -> String {
        match value {
            Some(value) => {
                self.set(attribute, value.span);
                value.text.to_string()
            }
            None => {
                self.report(attribute);
                String::new()
            }
        }
    }

    /// The span of an attribute's value, or of the element itself if there is none.
    pub fn span(&self, attribute: &str) -> Range<usize> {
        let found = self.attributes.iter().find(|(known, _)| *known == attribute);
        found.map_or(&self.element, |(_, span)| span).clone()
    }

    pub fn has_reported(&self, attribute: &str) -> bool {
        self.reported.contains(&attribute)
    }
}

/// The places of all elements of a description.
#[derive(Debug, Default)]
pub(crate) struct Places {
    pub robot: Place,
    pub links: Vec<Place>,
    pub joints: Vec<Place>,
    pub frames: Vec<Place>,
    pub rotors: Vec<Place>,
    pub constraints: Vec<Place>,
    pub states: Vec<Place>,
    /// Links or joints are missing, for a reason that was reported.
    pub is_partial: bool,
}

impl Places {
    fn of(&self, element: Element) -> &Place {
        let place = match element {
            Element::Link(i) => self.links.get(i),
            Element::Joint(i) => self.joints.get(i),
            Element::Frame(i) => self.frames.get(i),
            Element::Rotor(i) => self.rotors.get(i),
            Element::Constraint(i) => self.constraints.get(i),
            Element::State(i) => self.states.get(i),
            Element::Robot => None,
        };
        place.unwrap_or(&self.robot)
    }

    /// The span of an attribute's value, or of the element itself if there is none.
    pub fn span(&self, element: Element, attribute: &str) -> Range<usize> {
        self.of(element).span(attribute)
    }

    pub fn has_reported(&self, element: Element, attribute: &str) -> bool {
        self.of(element).has_reported(attribute)
    }

    /// True if a name or element is missing, so that the tree cannot be checked.
    pub fn tree_is_partial(&self) -> bool {
        let missing = |place: &Place| ["name", "parent", "child"].iter().any(|name| place.has_reported(name));
        self.is_partial || self.links.iter().chain(&self.joints).any(missing)
    }
}
