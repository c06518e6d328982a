//! The repairs of the lenient policy, each of them told.

use crate::finding::{Finding, Findings};
use crate::places::Places;
use mozzi::Description;
use mozzi::model::Element;

/// Replaces each inertia that no body can have by the nearest that one can.
pub(crate) fn inertias(description: &mut Description, places: &Places, findings: &mut Findings) {
    for (i, link) in description.links.iter_mut().enumerate() {
        let verdict = link.inertia.verdict();
        let Some(nearest) = link.inertia.nearest_physical().filter(|nearest| *nearest != link.inertia) else {
            continue;
        };
        let [a, b, c] = nearest.verdict().principal_moments;
        let message = format!(
            "link `{}`: inertia: {verdict}; replaced by the nearest that a body can have, of the moments {a:.6e}, {b:.6e} and \
             {c:.6e} kg m²",
            link.name
        );
        let span = places.span(Element::Link(i), "inertia");
        let help = "the lenient policy repairs this; mend the file to be sure of what is computed";
        findings.add(Finding::warning("repaired_inertia", span, message).help(help));
        link.inertia = nearest;
    }
}
