//! The report of an identification: one HTML file with figures, without scripts.

use crate::figure::{Curve, Figure, Panel, Stroke};
use mozzi_identify::estimate::pseudo_inertia::pseudo_inertia;
use mozzi_identify::judgement::Judgement;
use mozzi_identify::{Errors, Finding, Identification, Level};
use std::fmt::Write as _;

/// Points of a curve, at most.
const POINTS: usize = 1500;
/// Corners of an ellipse.
const CORNERS: usize = 72;

/// The report as an HTML file: errors on what was left out, what was noticed, measured and predicted forces with their
/// residuals, the ellipsoids of inertia before and after, and all parameters. It fetches nothing and runs nothing.
pub fn fit_html(found: &Identification<'_>, judged: &Judgement, validations: &[(String, Errors)]) -> String {
    let model = found.setup.columns.model;
    let name = escaped(&model.description().name);
    let mut body = format!("<h1>{name}, identified</h1>\n");
    let least_squares = &found.estimates.least_squares;
    let samples: usize = found.samples.iter().map(|samples| samples.count()).sum();
    let _ = writeln!(
        body,
        "<p>{samples} samples; {} of {} base parameters determined; condition number {:.0}. Differences below 3 % mean \
         nothing on one trajectory.</p>",
        least_squares.rank,
        found.setup.base.count(),
        least_squares.condition
    );
    if let Some(errors) = &found.left_out {
        body += &errors_table("Errors of predictions: five blocks of time, each left out in turn", found, errors);
    }
    if let Some(errors) = &found.held_out {
        body += &errors_table("Errors on the part that was not fitted", found, errors);
    }
    for (file, errors) in validations {
        body += &errors_table(&format!("Errors on {file}"), found, errors);
    }
    body += &errors_table("Errors on the samples that were fitted", found, &found.fitted);
    body += &findings(found.findings.iter().chain(&judged.findings));
    body += &forces(found, judged);
    body += &inertias(found);
    body += &parameters(found, judged);
    format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{name}, identified</title>\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n\
         <style>{STYLE}</style></head>\n<body>\n{body}</body></html>\n"
    )
}

const STYLE: &str = "body{font:15px/1.4 sans-serif;max-width:1100px;margin:2em auto;padding:0 1em;color:#222}\
table{border-collapse:collapse;margin:.5em 0 1.5em}th,td{padding:.15em .7em;text-align:right;border-bottom:1px solid #ddd}\
th:first-child,td:first-child{text-align:left}.weak{color:#a33}svg{max-width:100%;height:auto}li.warning{color:#a33}";

/// Text as HTML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A table from rows of cells; the first row is the head.
fn table(rows: &[Vec<String>]) -> String {
    let mut text = String::from("<table>\n");
    for (k, row) in rows.iter().enumerate() {
        let tag = if k == 0 { "th" } else { "td" };
        let cells: String = row.iter().map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell))).collect();
        let _ = writeln!(text, "<tr>{cells}</tr>");
    }
    text + "</table>\n"
}

fn errors_table(title: &str, found: &Identification<'_>, errors: &Errors) -> String {
    let head = ["", "force", "as it was", "+ friction", "least squares", "identified", "identified, %"];
    let mut rows = vec![head.map(str::to_string).to_vec()];
    for (j, name) in found.setup.columns.model.velocity_names().enumerate() {
        let all = [errors.force[j], errors.robot[j], errors.friction[j], errors.least_squares[j], errors.consistent[j]];
        let percent = if errors.force[j] > 0.0 { 100.0 * errors.consistent[j] / errors.force[j] } else { 0.0 };
        let cells = all.iter().map(|x| format!("{x:.3}"));
        rows.push([name.to_string()].into_iter().chain(cells).chain([format!("{percent:.2}")]).collect());
    }
    let nrms = 100.0 * errors.normalized(&errors.consistent);
    format!("<h2>{}</h2>\n<p>Root mean squares, N m or N; NRMS {nrms:.2} %.</p>\n{}", escaped(title), table(&rows))
}

fn findings<'f>(all: impl Iterator<Item = &'f Finding>) -> String {
    let items: String = all
        .map(|finding| {
            let class = if finding.level != Level::Note { " class=\"warning\"" } else { "" };
            format!("<li{class}>{}</li>\n", escaped(&finding.text))
        })
        .collect();
    if items.is_empty() { String::new() } else { format!("<h2>What was noticed</h2>\n<ul>\n{items}</ul>\n") }
}

/// Measured and predicted forces, and their difference.
fn forces(found: &Identification<'_>, judged: &Judgement) -> String {
    let model = found.setup.columns.model;
    let n = model.n();
    let mut text = String::new();
    for (log, (samples, predicted)) in found.samples.iter().zip(&judged.predicted).enumerate() {
        let step = samples.count().div_ceil(POINTS).max(1);
        let points = |of: &dyn Fn(usize) -> f64| -> Vec<[f64; 2]> {
            (0..samples.count()).step_by(step).map(|k| [samples.t[k], of(k)]).collect()
        };
        let mut panels = Vec::new();
        for (j, name) in model.velocity_names().enumerate() {
            let measured = points(&|k| samples.tau[k * n + j]);
            let of_model = points(&|k| predicted[k * n + j]);
            let residual = points(&|k| samples.tau[k * n + j] - predicted[k * n + j]);
            panels.push(Panel {
                x_label: "t [s]".into(),
                y_label: format!("{name} [N m]"),
                curves: vec![Curve::line("measured", 7, measured), Curve::line("identified", 1, of_model)],
                ..Panel::default()
            });
            panels.push(Panel {
                x_label: "t [s]".into(),
                y_label: format!("residual of {name}"),
                curves: vec![Curve::line("residual", 3, residual)],
                ..Panel::default()
            });
        }
        let figure = Figure { title: String::new(), panels, columns: 2 };
        let _ = writeln!(text, "<h2>Forces of log {}</h2>\n{}", log + 1, figure.svg());
    }
    text
}

/// In each link's frame, in the planes x z and y z: the solid ellipsoid of uniform density with the link's inertia.
fn inertias(found: &Identification<'_>) -> String {
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
    format!("<h2>Ellipsoids of inertia, before and after</h2>\n{}\n", figure.svg())
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

fn parameters(found: &Identification<'_>, judged: &Judgement) -> String {
    let optimum = &found.estimates.consistent;
    let mut rows =
        vec![["parameter", "before", "identified", "deviation", "from the prior"].map(str::to_string).to_vec()];
    for (k, unknown) in found.setup.columns.unknowns.iter().enumerate() {
        rows.push(vec![
            format!("{} [{}]", unknown.name, found.setup.columns.unit(k)),
            format!("{:.5}", unknown.prior),
            format!("{:.5}", optimum.x[k]),
            judged.standings[k].text(),
            format!("{:.0} %", 100.0 * optimum.prior_share[k]),
        ]);
    }
    let mut base = vec![
        ["base parameter", "before", "least squares", "deviation", "identified", "what would determine it"]
            .map(str::to_string)
            .to_vec(),
    ];
    for one in &judged.parameters {
        base.push(vec![
            one.name.clone(),
            format!("{:.5}", one.robot),
            format!("{:.5}", one.least_squares),
            format!("{:.5}", one.deviation),
            format!("{:.5}", one.consistent),
            one.advice.clone().unwrap_or_default(),
        ]);
    }
    format!(
        "<h2>Base parameters</h2>\n<p>The combinations on which forces depend. Deviations are those of least \
         squares.</p>\n{}<h2>Parameters</h2>\n<p>Of bodies that can exist. Where most comes from the prior, the number is \
         the robot's own, not the data's.</p>\n{}",
        table(&base),
        table(&rows)
    )
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

    #[test]
    fn names_are_escaped() {
        assert_eq!(escaped("<b>&\""), "&lt;b&gt;&amp;&quot;");
        assert!(table(&[vec!["<script>".to_string()]]).contains("&lt;script&gt;"));
    }
}
