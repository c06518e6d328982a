//! `version` of `<robot>`.

use crate::report::finding::Finding;
use crate::text::context::Context;
use crate::text::element::Element;
use crate::text::version::Version;
use crate::urdf::vocabulary::shown;

/// The version of a robot: 1.0 if it has none or, with a diagnostic, an unknown one.
pub(crate) fn read(root: &Element, cx: &mut Context) -> Version {
    let Some(value) = root.attribute("version") else { return Version::default() };
    Version::parse(value.text).unwrap_or_else(|| {
        let message = format!("{}: version: is `{}`, expected 1.0, 1.1 or 1.2", root.subject, shown(value.text));
        cx.findings.add(Finding::error("unsupported_version", value.span, message));
        Version::default()
    })
}
