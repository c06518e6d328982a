//! `<option>`: gravity, and disabled effects.

use super::attributes::Item;
use super::ignored::Ignored;
use super::vocabulary;
use crate::text::context::Context;
use crate::text::element::Element;
use crate::text::number::all_numbers;

/// The options that mozzi uses.
pub(crate) struct Options {
    pub gravity: [f64; 3],
    pub damper: bool,
    pub spring: bool,
    pub friction: bool,
    pub equality: bool,
    /// Whether actuators act, and whether their controls are clamped.
    pub actuation: bool,
    pub clamps: bool,
    /// Groups of actuators that do not act.
    pub idle_groups: Vec<f64>,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            gravity: [0.0, 0.0, -9.81],
            damper: true,
            spring: true,
            friction: true,
            equality: true,
            actuation: true,
            clamps: true,
            idle_groups: Vec::new(),
        }
    }
}

impl Options {
    /// The last of several sections takes precedence.
    pub fn read<'a: 's, 's>(
        sections: impl Iterator<Item = &'s Element<'a>>,
        ignored: &mut Ignored,
        cx: &mut Context,
    ) -> Self {
        let (mut options, mut weightless) = (Options::default(), false);
        for section in sections {
            let item = Item::plain(&section.called("option"));
            item.element.check_attributes(&vocabulary::OPTION, cx);
            let children = item.element.check_children(&vocabulary::OPTION, cx);
            options.gravity = item.vector::<3>("gravity", cx).unwrap_or(options.gravity);
            if let Some(groups) = item.element.attribute("actuatorgroupdisable") {
                match all_numbers(groups.text) {
                    Ok(found) => options.idle_groups = found,
                    Err(error) => item.element.report_numbers("actuatorgroupdisable", &groups, error, cx),
                }
            }
            for name in ["density", "viscosity"] {
                if item.number(name, 0.0, cx) != 0.0 {
                    ignored.force("fluid", &item, name, "a fluid around the bodies");
                }
            }
            let Some(flag) = children.get("flag") else { continue };
            flag.check_attributes(&vocabulary::FLAG, cx);
            let flag = Item::plain(flag);
            let mut is_off = |name| flag.word(name, &["enable", "disable"], cx) == Some("disable");
            weightless |= is_off("gravity");
            let (passive, constraint) = (is_off("passive"), is_off("constraint"));
            options.damper &= !(passive | is_off("damper"));
            options.spring &= !(passive | is_off("spring"));
            options.friction &= !(constraint | is_off("frictionloss"));
            options.actuation &= !is_off("actuation");
            options.clamps &= !is_off("clampctrl");
            options.equality &= !(constraint | is_off("equality"));
        }
        if weightless {
            options.gravity = [0.0; 3];
        }
        options
    }
}
