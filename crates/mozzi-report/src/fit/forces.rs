//! Measured and predicted forces, and what is left.

use super::{drawn, units};
use crate::figure::{Curve, Figure, Panel, Stroke};
use mozzi_identify::Identification;
use mozzi_identify::judgement::Judgement;

/// Points of a curve, at most.
const POINTS: usize = 1500;
/// Dots of the measurement, at most.
const DOTS: usize = 500;

pub fn section(found: &Identification<'_>, judged: &Judgement) -> String {
    let model = found.setup.columns.model;
    let (n, units) = (model.n(), units(found));
    let mut text = String::new();
    for (log, (samples, predicted)) in found.samples.iter().zip(&judged.predicted).enumerate() {
        let count = samples.count();
        let points = |most: usize, of: &dyn Fn(usize) -> f64| -> Vec<[f64; 2]> {
            (0..count).step_by(count.div_ceil(most).max(1)).map(|k| [samples.t[k], of(k)]).collect()
        };
        let ends = [samples.t.first(), samples.t.last()].map(|t| t.copied().unwrap_or_default());
        let mut panels = Vec::new();
        for (j, name) in model.velocity_names().enumerate() {
            let left = |k: usize| samples.tau[k * n + j] - predicted[k * n + j];
            let sigma = ((0..count).map(|k| left(k).powi(2)).sum::<f64>() / count.max(1) as f64).sqrt();
            let measured = points(DOTS, &|k| samples.tau[k * n + j]);
            let band = |sign: f64| Curve {
                name: "± 2σ of the residual".into(),
                color: 9,
                stroke: Stroke::Dashed,
                points: ends.map(|t| [t, sign * 2.0 * sigma]).to_vec(),
            };
            panels.push(Panel {
                x_label: "t [s]".into(),
                y_label: format!("{name} [{}]", units[j]),
                curves: vec![
                    Curve { name: "measured".into(), color: 8, stroke: Stroke::Dots, points: measured },
                    Curve::line("predicted", 0, points(POINTS, &|k| predicted[k * n + j])),
                ],
                ..Panel::default()
            });
            panels.push(Panel {
                x_label: "t [s]".into(),
                y_label: format!("residual [{}]", units[j]),
                curves: vec![Curve::line("residual", 3, points(POINTS, &left)), band(1.0), band(-1.0)],
                ..Panel::default()
            });
        }
        let figure = Figure { title: String::new(), panels, columns: 2 };
        let class = if log == 0 { "" } else { " class=\"screen\"" };
        let which = if found.samples.len() > 1 { format!(" of log {}", log + 1) } else { String::new() };
        text += &format!(
            "<section{class}><h2>Forces{which}, measured and predicted</h2>\n{}</section>\n",
            drawn(&figure, "forces")
        );
    }
    text
}
