//! `<visual>`, `<collision>`, `<geometry>`, `<material>`.

use super::shape::{Form, Purpose, Shape};
use crate::report::finding::Finding;
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::origin;
use crate::urdf::vocabulary::shown;
use mozzi::SE3;
use std::collections::BTreeMap;

type Colors = BTreeMap<String, [f64; 4]>;

/// The valid shapes; the others are reported.
pub(crate) fn robot(root: &Element, cx: &mut Context) -> Vec<Shape> {
    let mut colors = Colors::new();
    for material in children(root, "material") {
        name_color(&material, &mut colors, cx);
    }
    let mut shapes = Vec::new();
    for link in children(root, "link") {
        let Some(name) = link.attribute("name") else { continue };
        let link = link.called(format!("link `{}`", shown(name.text)));
        for (word, purpose) in [("visual", Purpose::Visual), ("collision", Purpose::Collision)] {
            for element in children(&link, word) {
                let Some((T, form)) = placed_form(&element, cx) else { continue };
                let color = children(&element, "material").next().and_then(|m| name_color(&m, &mut colors, cx));
                let touches = purpose == Purpose::Collision;
                shapes.push(Shape { link: name.text.to_string(), purpose, T, form, color, touches, friction: None });
            }
        }
    }
    shapes
}

fn children<'a>(element: &Element<'a>, name: &'static str) -> impl Iterator<Item = Element<'a>> {
    element.elements().filter(move |child| child.name() == name && !child.has_prefix())
}

pub(super) fn placed_form(element: &Element, cx: &mut Context) -> Option<(SE3, Form)> {
    let T = children(element, "origin").next().map_or(Some(SE3::identity()), |origin| origin::read(&origin, cx));
    let first = children(element, "geometry").next().and_then(|geometry| geometry.elements().next());
    let Some(form) = first else {
        let message = format!("{}: has no <geometry> that contains a shape", element.subject);
        let help = "a shape is <box>, <cylinder>, <sphere>, <capsule> or <mesh>, inside <geometry>";
        cx.findings.add(Finding::warning("missing_element", element.span(), message).help(help));
        return None;
    };
    Some((T?, read_form(&form, cx)?))
}

fn read_form(form: &Element, cx: &mut Context) -> Option<Form> {
    match form.name() {
        "box" => Some(Form::Box { size: lengths(form, "size", cx)? }),
        "sphere" => Some(Form::Sphere { radius: length(form, "radius", cx)? }),
        "cylinder" => Some(Form::Cylinder { radius: length(form, "radius", cx)?, length: length(form, "length", cx)? }),
        "capsule" => Some(Form::Capsule { radius: length(form, "radius", cx)?, length: length(form, "length", cx)? }),
        "mesh" => {
            let file = form.required("filename", cx)?.text.to_string();
            let scale = match form.attribute("scale") {
                Some(value) => form.vector::<3>("scale", &value, cx)?,
                None => [1.0; 3],
            };
            Some(Form::Mesh { file, scale })
        }
        other => {
            let message = format!("{}: `{}` is not a shape that can be drawn", form.subject, shown(other));
            let help = "a shape is <box>, <cylinder>, <sphere>, <capsule> or <mesh>";
            cx.findings.add(Finding::warning("unknown_element", form.span(), message).help(help));
            None
        }
    }
}

fn length(form: &Element, name: &str, cx: &mut Context) -> Option<f64> {
    lengths::<1>(form, name, cx).map(|[length]| length)
}

/// Lengths that are not negative.
fn lengths<const N: usize>(form: &Element, name: &str, cx: &mut Context) -> Option<[f64; N]> {
    let value = form.required(name, cx)?;
    let found = form.vector::<N>(name, &value, cx)?;
    if found.iter().all(|length| *length >= 0.0) {
        return Some(found);
    }
    let message = format!("{}: {name}: is `{}`, expected lengths of 0 or more", form.subject, shown(value.text));
    cx.findings.add(Finding::warning("not_a_number", value.span, message));
    None
}

/// The colour of a material; a colour defined here is stored under the material's name.
fn name_color(material: &Element, colors: &mut Colors, cx: &mut Context) -> Option<[f64; 4]> {
    let name = material.attribute("name").map(|value| value.text);
    let own = children(material, "color").next().and_then(|color| {
        let value = color.required("rgba", cx)?;
        color.vector::<4>("rgba", &value, cx)
    });
    match (name, own) {
        (Some(name), None) => colors.get(name).copied(),
        (name, Some(color)) => {
            name.filter(|name| !name.is_empty()).map(|name| colors.insert(name.to_string(), color));
            Some(color)
        }
        (None, None) => None,
    }
}
