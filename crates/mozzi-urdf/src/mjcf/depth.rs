//! How deep elements may nest.

use crate::text::context::Context;
use crate::text::element::Element;
use crate::text::scan::MOST_DEPTH;

/// Files may include each other, and so nest deeper than one file can.
pub(crate) fn is_too_deep(element: &Element, depth: usize, cx: &mut Context) -> bool {
    if depth > MOST_DEPTH {
        let message = format!("more than {MOST_DEPTH} nested elements");
        cx.findings.error("too_deep", element.span(), message);
    }
    depth > MOST_DEPTH
}
