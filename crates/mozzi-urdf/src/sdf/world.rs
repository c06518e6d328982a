//! `<sdf>` and `<world>`: which models are the robot.

use super::Reader;
use super::part::Part;
use super::version::Version;
use super::vocabulary::{SDF, WORLD};
use crate::report::finding::{Finding, Topic};
use crate::report::places::{Place, Places};
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::vocabulary::shown;
use mozzi::Description;

/// The gravity of a world that gives none.
const GRAVITY: [f64; 3] = [0.0, 0.0, -9.8];

impl<'a> Reader<'a> {
    /// From the root element to a description.
    pub fn root(mut self, root: &Element<'a>, cx: &mut Context) -> Option<(Description, Places)> {
        let version = Version::read(root, cx);
        root.check_attributes(&SDF, cx);
        root.check_children(&SDF, cx);
        let of = |name: &'static str| root.elements().filter(move |child| child.name() == name && !child.has_prefix());
        let mut worlds = of("world");
        let (world, mut gravity, mut name) = (worlds.next(), Description::new("").gravity, None);
        if let Some(second) = worlds.next() {
            let message = "sdf: has a second <world>, expected one".to_string();
            cx.findings.error("duplicate_element", second.span(), message);
        }
        let mut models: Vec<Element<'a>> = of("model").collect();
        if let Some(world) = &world {
            let part = Part::new(world.called("world"), &WORLD, cx);
            gravity = part.vector::<3>("gravity", cx).unwrap_or(GRAVITY);
            name = world.attribute("name").map(|name| name.text.to_string());
            self.plugins(&part.element, cx);
            models.extend(world.elements().filter(|child| ["model", "include"].contains(&child.written_name())));
        }
        models.retain(|model| self.moves(model, cx));
        if models.is_empty() {
            let message = "sdf: has no <model> that moves".to_string();
            let of_first = |name: &String| {
                format!("`{}` is static, fixed in the world: delete its <static>, or choose another file", shown(name))
            };
            let help = self.graph.statics.first().map(of_first);
            cx.findings.add(Finding::error("no_model", root.span(), message).maybe_help(help));
            return None;
        }
        let is_robot = models.len() == 1;
        let scope = self.graph.world.clone();
        for model in models {
            let of_robot = match model.name() {
                "include" => self.include(&model.called("include"), &scope, version, is_robot, cx),
                _ => self.model(&model, &scope, version, None, is_robot, cx),
            };
            name = of_robot.filter(|_| is_robot).or(name);
        }
        if let Some(world) = &world {
            self.contents(&world.called("world"), &scope, version, cx);
        }
        if cx.findings.is_full() {
            return None;
        }
        let places = Places { robot: Place::new(root.span()), ..Places::default() };
        self.assemble(name.unwrap_or_else(|| "sdf".to_string()), gravity, places, cx)
    }

    /// True if a model is a part of the robot; false for static models of a world and for included lights.
    fn moves(&mut self, model: &Element<'a>, cx: &mut Context) -> bool {
        let is_set = |element: &Element| {
            let flag = element.elements().find(|child| child.name() == "static");
            flag.is_some_and(|flag| ["1", "true"].contains(&flag.content().text.to_ascii_lowercase().as_str()))
        };
        let mut is_static = is_set(model);
        if model.name() == "include" {
            let root =
                self.includes.get(&model.span().start).and_then(|page| Element::root_of(self.pages, *page, "sdf"));
            let Some(root) = root else { return false }; // Gazebo's own, or reported
            let inner = root.elements().find(|child| child.name() == "model");
            is_static |= inner.is_none_or(|inner| is_set(&inner));
        }
        if is_static {
            let name = model.attribute("name").map_or("", |name| name.text);
            self.graph.statics.push(name.to_string());
            let message = format!("model `{}`: is static, and no part of the robot", shown(name));
            cx.findings.add(Finding::unused(Topic::Looks, "ignored_element", model.span(), message));
        }
        !is_static
    }
}
