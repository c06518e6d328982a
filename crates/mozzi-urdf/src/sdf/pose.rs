//! `<pose>`: the configuration of one frame relative to another, which may be named.

use super::part::{Part, truth};
use super::version::Version;
use crate::report::finding::Finding;
use crate::text::context::Context;
use crate::text::element::Value;
use crate::urdf::origin;
use crate::urdf::vocabulary::shown;
use mozzi::{SE3, SO3, Vec3};

/// A configuration, and the name of the frame that it is relative to, if the file gives one.
#[derive(Clone)]
pub(crate) struct Pose<'a> {
    pub T: SE3,
    pub relative_to: Option<Value<'a>>,
}

impl<'a> Pose<'a> {
    /// The pose of an element; the identity if it has none.
    pub fn of(part: &Part<'a>, version: Version, cx: &mut Context) -> Self {
        let Some(element) = part.child("pose") else { return Pose { T: SE3::identity(), relative_to: None } };
        let given = |word| element.attribute(word).filter(|value: &Value| !value.text.trim().is_empty());
        let before = given("frame");
        if let Some(frame) = before.as_ref().filter(|_| version >= Version::WITH_FRAMES) {
            let message =
                format!("{}: pose: frame=\"{}\" is of versions before 1.7", part.element.subject, shown(frame.text));
            let help = "write relative_to instead, or the file's version";
            cx.findings.add(Finding::error("unknown_attribute", frame.span.clone(), message).help(help));
        }
        let relative_to = given("relative_to").or(before);
        let in_degrees = element.attribute("degrees").and_then(|value| truth(element, "degrees", &value, cx));
        let value = element.content();
        if value.text.is_empty() {
            return Pose { T: SE3::identity(), relative_to };
        }
        let format = element.attribute("rotation_format");
        let T = match format.as_ref().map_or("euler_rpy", |format| format.text) {
            "quat_xyzw" => part.element.vector::<7>("pose", &value, cx).and_then(|[x, y, z, a, b, c, d]| {
                let Some((R, _)) = origin::rotation([a, b, c, d]) else {
                    let text = shown(value.text);
                    let message =
                        format!("{}: is `{text}`, expected a position and a unit quaternion", element.subject);
                    cx.findings.add(Finding::error("zero_axis", value.span.clone(), message));
                    return None;
                };
                Some(SE3 { R, p: Vec3([x, y, z]) })
            }),
            "euler_rpy" => part.element.vector::<6>("pose", &value, cx).map(|[x, y, z, a, b, c]| {
                let unit = if in_degrees == Some(true) { core::f64::consts::PI / 180.0 } else { 1.0 };
                origin::suspect_degrees(&format!("{}: pose", element.subject), [a, b, c].map(|x| x * unit), &value, cx);
                SE3 { R: SO3::from_rpy(a * unit, b * unit, c * unit), p: Vec3([x, y, z]) }
            }),
            other => {
                let message = format!(
                    "{}: rotation_format: is `{}`, expected `euler_rpy` or `quat_xyzw`",
                    element.subject,
                    shown(other)
                );
                let span = format.map_or_else(|| element.span(), |format| format.span);
                cx.findings.error("unknown_word", span, message);
                None
            }
        };
        Pose { T: T.unwrap_or_else(SE3::identity), relative_to }
    }
}
