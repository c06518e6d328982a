//! The repairs of the lenient policy, each of them reported.

use crate::report::finding::{Finding, Findings};
use crate::report::places::Places;
use mozzi::Description;
use mozzi::model::Element;
use mozzi::spatial::Rounded;

/// Replaces each unphysical inertia by the nearest physical one.
pub(crate) fn inertias(description: &mut Description, places: &Places, findings: &mut Findings) {
    for (i, link) in description.links.iter_mut().enumerate() {
        let verdict = link.inertia.verdict();
        let Some(nearest) = link.inertia.nearest_physical().filter(|nearest| *nearest != link.inertia) else {
            continue;
        };
        let [a, b, c] = nearest.verdict().principal_moments.map(Rounded);
        let message = format!(
            "link `{}`: inertia: {verdict}; replaced by the nearest physical inertia, with the moments {a}, {b} and {c} kg m²",
            link.name
        );
        let span = places.span(Element::Link(i), "inertia");
        findings.add(Finding::warning("repaired_inertia", span, message));
        link.inertia = nearest;
    }
}
