//! The error of each method over its step, and over its work.

use crate::figure::{Curve, Figure, Panel, Scale, Stroke};

/// Errors of one method.
#[derive(Clone, Debug, PartialEq)]
pub struct Convergence {
    /// The method's name.
    pub name: String,
    /// Its order.
    pub order: u32,
    /// (h, error): step in seconds, and the largest entry of θ(t_f) ⊖ θ_reference(t_f); empty for adaptive steps.
    pub by_step: Vec<[f64; 2]>,
    /// (evaluations of θ̈, error).
    pub by_work: Vec<[f64; 2]>,
}

impl Convergence {
    /// All methods in two panels: over the step, with the slopes of their orders as dashed lines, and over the
    /// evaluations.
    pub fn figure(title: impl Into<String>, found: &[Convergence]) -> Figure {
        let (mut by_step, mut by_work) = (Vec::new(), Vec::new());
        for (color, Convergence { name, order, by_step: steps, by_work: work }) in found.iter().enumerate() {
            let named = format!("{name} (order {order})");
            if let [first, .., last] = steps[..] {
                let promised = |h: f64| last[1] * (h / last[0]).powi(*order as i32);
                let slope = vec![[first[0], promised(first[0])], last];
                by_step.push(Curve { name: String::new(), color, stroke: Stroke::Dashed, points: slope });
                by_step.push(Curve { name: named.clone(), color, stroke: Stroke::Marked, points: steps.clone() });
            }
            by_work.push(Curve { name: named, color, stroke: Stroke::Marked, points: work.clone() });
        }
        let panel = |x_label: &str, curves| Panel {
            x_label: x_label.into(),
            y_label: "error of θ at the end [rad, m]".into(),
            scale: Scale::Logarithmic,
            curves,
            equal: false,
        };
        let panels = vec![panel("step h [s]", by_step), panel("evaluations of θ̈", by_work)];
        Figure { title: title.into(), panels, columns: 2 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_and_work_have_a_panel_each() {
        let points = |order: i32| (1..5).map(|k| [f64::from(k) * 0.01, (f64::from(k) * 0.01).powi(order)]).collect();
        let fixed = Convergence { name: "Runge-Kutta 4".into(), order: 4, by_step: points(4), by_work: points(-4) };
        let adaptive = Convergence { name: "Dormand-Prince".into(), order: 5, by_step: vec![], by_work: points(-5) };
        let figure = Convergence::figure("", &[fixed, adaptive]);
        let names = |k: usize| figure.panels[k].curves.iter().map(|curve| curve.name.as_str()).collect::<Vec<_>>();
        assert_eq!(names(0), ["", "Runge-Kutta 4 (order 4)"]); // its slope, and itself
        assert_eq!(names(1), ["Runge-Kutta 4 (order 4)", "Dormand-Prince (order 5)"]);
        let slope = &figure.panels[0].curves[0].points;
        assert!((slope[0][1] - 1e-8).abs() < 1e-20, "{slope:?}");
        let svg = figure.svg();
        assert!(svg.contains("Runge-Kutta 4 (order 4)") && svg.contains("evaluations of θ̈") && svg.contains("10⁻"));
    }
}
