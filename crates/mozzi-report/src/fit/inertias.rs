//! The ellipsoids of inertia.

use super::drawn;
use crate::figure::{Curve, Figure, Panel, Stroke};
use mozzi_identify::Identification;
use mozzi_identify::estimate::pseudo_inertia::pseudo_inertia;

/// Corners of an ellipse.
const CORNERS: usize = 72;

/// In each link's frame, in the planes x z and y z: the solid ellipsoid of uniform density with the link's inertia.
pub fn section(found: &Identification<'_>) -> String {
    let columns = &found.setup.columns;
    let x = &found.estimates.consistent.x;
    let mut panels = Vec::new();
    for first in columns.bodies() {
        let name = columns.unknowns[first].name.trim_end_matches(".m");
        for (a, b, axes) in [(0, 2, "x"), (1, 2, "y")] {
            let of = |values: &[f64], name: &str, color: usize| {
                let points = ellipse(values, a, b);
                Curve { name: name.to_string(), color, stroke: Stroke::Filled, points }
            };
            let before: Vec<f64> = (first..first + 10).map(|k| columns.unknowns[k].prior).collect();
            panels.push(Panel {
                x_label: format!("{axes} [m]"),
                y_label: format!("{name}, z [m]"),
                equal: true,
                curves: vec![of(&before, "before", 7), of(&x[first..first + 10], "identified", 1)],
                ..Panel::default()
            });
        }
    }
    if panels.is_empty() {
        return String::new();
    }
    let figure = Figure { title: String::new(), panels, columns: 2 };
    format!(
        "<details><summary>Ellipsoids of inertia, before and after</summary>\n<p>Uniform solids with the mass and the \
         inertia of each link.</p>\n{}</details>\n",
        drawn(&figure, "")
    )
}

/// The outline in a plane of the ellipsoid with semi-axes √(5 σ), σ the second moments of the mass per mass.
fn ellipse(p: &[f64], a: usize, b: usize) -> Vec<[f64; 2]> {
    let J = pseudo_inertia(p);
    let m = J[(3, 3)];
    if !(m > 0.0) {
        return Vec::new();
    }
    let c = [J[(a, 3)] / m, J[(b, 3)] / m];
    let entry = |i: usize, j: usize| J[(i, j)] / m - J[(i, 3)] * J[(j, 3)] / (m * m);
    // the outline of an ellipsoid in a plane is the ellipse of the plane's own block: a Cholesky factor draws it
    let (aa, ab, bb) = (entry(a, a).max(0.0), entry(a, b), entry(b, b).max(0.0));
    let l = aa.sqrt();
    let (k, d) = if l > 0.0 { (ab / l, (bb - ab * ab / aa).max(0.0).sqrt()) } else { (0.0, bb.sqrt()) };
    let size = 5.0_f64.sqrt();
    let corner = |i: usize| {
        let (s, t) = (std::f64::consts::TAU * i as f64 / CORNERS as f64).sin_cos();
        [c[0] + size * l * t, c[1] + size * (k * t + d * s)]
    };
    (0..CORNERS).map(corner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ellipse_of_a_solid_ellipsoid_is_its_outline() {
        let [a, b, c] = [0.3, 0.2, 0.1_f64];
        let m = 2.0;
        let I = |x: f64, y: f64| m * (x * x + y * y) / 5.0;
        let p = [m, 0.0, 0.0, 0.0, I(b, c), 0.0, 0.0, I(a, c), 0.0, I(a, b)];
        let largest = |points: &[[f64; 2]], k: usize| points.iter().map(|p| p[k].abs()).fold(0.0, f64::max);
        let points = ellipse(&p, 0, 2);
        assert!((largest(&points, 0) - a).abs() < 1e-3 && (largest(&points, 1) - c).abs() < 1e-3);
        assert!(ellipse(&[0.0; 10], 0, 2).is_empty());
    }
}
