//! Friction over velocity: the identified curve, and what is left of each sample if all else is taken away.

use super::{drawn, sliding, units};
use crate::figure::{Curve, Figure, Panel, Stroke};
use mozzi::model::Freedom;
use mozzi_identify::judgement::Judgement;
use mozzi_identify::signals::Shape;
use mozzi_identify::{Identification, Kind};

/// Dots of the data, at most.
const DOTS: usize = 800;
/// Points of a curve.
const POINTS: usize = 241;

pub fn section(found: &Identification<'_>, judged: &Judgement) -> String {
    let columns = &found.setup.columns;
    let (model, choice) = (columns.model, &columns.choice);
    if !choice.viscous && !choice.coulomb && choice.stribeck.is_none() {
        return String::new();
    }
    let (x, n) = (&found.estimates.consistent.x, model.n());
    let of = |is: fn(Kind) -> bool| -> Vec<f64> {
        columns.unknowns.iter().zip(x).filter(|(unknown, _)| is(unknown.kind)).map(|(_, x)| *x).collect()
    };
    let viscous = of(|kind| matches!(kind, Kind::Viscous(_)));
    let coulomb = of(|kind| matches!(kind, Kind::Coulomb(_)));
    let stribeck = of(|kind| matches!(kind, Kind::Stribeck(_)));
    let shape = Shape { width: choice.width, stribeck: choice.stribeck };
    let (units, slides) = (units(found), sliding(model));
    let mut panels = Vec::new();
    for (k, (name, place)) in model.joint_names().zip(model.places()).enumerate() {
        if place.freedom != Freedom::One {
            continue;
        }
        let j = place.j;
        let at = |list: &[f64]| list.get(k).copied().unwrap_or_default();
        let friction =
            |rate: f64| at(&viscous) * rate + at(&coulomb) * shape.coulomb(rate) + at(&stribeck) * shape.stribeck(rate);
        let mut dots = Vec::new();
        for (samples, predicted) in found.samples.iter().zip(&judged.predicted) {
            let step = (samples.count() * found.samples.len()).div_ceil(DOTS).max(1);
            for row in (0..samples.count()).step_by(step).filter(|row| samples.is_valid[row * n + j]) {
                let rate = samples.dtheta[row * n + j];
                dots.push([rate, samples.tau[row * n + j] - predicted[row * n + j] + friction(rate)]);
            }
        }
        let most = dots.iter().map(|dot| dot[0].abs()).fold(0.0, f64::max);
        let rate = |k: usize| most * (2.0 * k as f64 / (POINTS - 1) as f64 - 1.0);
        let curve = (0..POINTS).map(rate).map(|rate| [rate, friction(rate)]).collect();
        panels.push(Panel {
            x_label: format!("{name}, θ̇ [{}]", if slides[j] { "m/s" } else { "rad/s" }),
            y_label: format!("friction [{}]", units[j]),
            curves: vec![
                Curve { name: "data without all other forces".into(), color: 8, stroke: Stroke::Dots, points: dots },
                Curve::line("identified friction", 1, curve),
            ],
            ..Panel::default()
        });
    }
    if panels.is_empty() {
        return String::new();
    }
    let columns = panels.len().clamp(1, 3);
    let figure = Figure { title: String::new(), panels, columns };
    format!("<section><h2>Friction</h2>\n{}</section>\n", drawn(&figure, "friction"))
}
