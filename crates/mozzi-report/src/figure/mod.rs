//! A figure for a paper: panels of curves, as SVG.

mod axis;
mod svg;

pub use axis::Scale;

use axis::{Ticks, without_spikes};

/// Panels in rows, below a common legend.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figure {
    /// The title, above all panels.
    pub title: String,
    /// In reading order.
    pub panels: Vec<Panel>,
    /// Panels in a row; 0 is 1.
    pub columns: usize,
}

/// Two axes and the curves between them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panel {
    /// The label of the abscissa: `"t [s]"`.
    pub x_label: String,
    /// The label of the ordinate: `"θ [rad]"`.
    pub y_label: String,
    /// The scale of both axes.
    pub scale: Scale,
    /// True for equal scales of both axes.
    pub equal: bool,
    /// Later ones are drawn over earlier ones.
    pub curves: Vec<Curve>,
}

/// A list of points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// The name in the legend; a curve with an empty name is not listed.
    pub name: String,
    /// An index of the palette.
    pub color: usize,
    /// How it is drawn.
    pub stroke: Stroke,
    /// (x, y); a point that is not finite breaks the curve.
    pub points: Vec<[f64; 2]>,
}

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stroke {
    /// A line.
    #[default]
    Line,
    /// A line with gaps.
    Dashed,
    /// A line with a mark at each point.
    Marked,
    /// Closed, its inside tinted.
    Filled,
    /// Thick, with a mark at each point: links and joints.
    Links,
    /// Points without a line.
    Dots,
    /// A ring at each point.
    Rings,
}

impl Curve {
    /// A line of a palette's colour.
    pub fn line(name: impl Into<String>, color: usize, points: Vec<[f64; 2]>) -> Self {
        Curve { name: name.into(), color, points, stroke: Stroke::Line }
    }
}

impl Figure {
    /// Adds the curves of another run, dashed, to the panels with the same labels, and panels that this figure does not
    /// have.
    pub fn add_run(&mut self, name: &str, other: Figure) {
        for panel in other.panels {
            let labels = |panel: &Panel| [panel.x_label.clone(), panel.y_label.clone()];
            let named = |curve: Curve| {
                let stroke = if curve.stroke == Stroke::Line { Stroke::Dashed } else { curve.stroke };
                let name = if curve.name.is_empty() { name.to_string() } else { format!("{}, {name}", curve.name) };
                Curve { name, stroke, ..curve }
            };
            let curves: Vec<Curve> = panel.curves.iter().cloned().map(named).collect();
            match self.panels.iter_mut().find(|known| labels(known) == labels(&panel)) {
                Some(known) => known.curves.extend(curves),
                None => self.panels.push(Panel { curves, ..panel }),
            }
        }
    }
}

impl Panel {
    /// Lowest and highest of both coordinates, with a margin; over time without spikes, and the numbers of these.
    fn ranges(&self) -> ([[f64; 2]; 2], [Option<f64>; 2]) {
        let values = |side: usize| self.curves.iter().flat_map(|curve| &curve.points).map(move |point| point[side]);
        let (x, all) = (self.scale.range(values(0)), self.scale.range(values(1)));
        if !self.x_label.starts_with("t [") || self.scale != Scale::Linear {
            return ([x, all], [None; 2]);
        }
        let (usual, cut) = without_spikes(&values(1).collect::<Vec<_>>());
        ([x, if cut == [None; 2] { all } else { self.scale.range(usual.into_iter()) }], cut)
    }

    /// The number of curves before the k-th that it lies on, to less than a line's width.
    fn lies_on(&self, k: usize, height: f64) -> usize {
        let own = &self.curves[k];
        let is_same = |other: &Curve| {
            other.stroke == own.stroke
                && other.points.len() == own.points.len()
                && !own.points.is_empty()
                && other
                    .points
                    .iter()
                    .zip(&own.points)
                    .all(|(a, b)| a[0] == b[0] && (a[1] - b[1]).abs() <= 2e-3 * height)
        };
        if own.stroke != Stroke::Line { 0 } else { self.curves[..k].iter().filter(|other| is_same(other)).count() }
    }

    fn ticks(&self, range: [f64; 2], about: usize) -> Ticks {
        Ticks::new(self.scale, range, about)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(scale: Scale) -> Figure {
        let points = (1..=2000).map(|k| f64::from(k) * 0.01).map(|t| [t, 2.0 + t.sin()]).collect();
        let panel = Panel { x_label: "t [s]".into(), y_label: "θ̇ <1>".into(), scale, ..Panel::default() };
        let curves = vec![
            Curve::line("a & b", 0, points),
            Curve { name: "none".into(), color: 1, stroke: Stroke::Marked, points: Vec::new() },
        ];
        Figure { title: "A wave".into(), panels: vec![Panel { curves, ..panel }], columns: 1 }
    }

    #[test]
    fn noise_of_many_rows_is_thinned_and_keeps_its_extremes() {
        let mut points: Vec<[f64; 2]> = (0..200_000).map(|k| [f64::from(k), f64::from(k * 7919 % 1000)]).collect();
        points[123_457][1] = 1500.0;
        let panel = Panel { x_label: "x".into(), curves: vec![Curve::line("a", 0, points)], ..Panel::default() };
        let figure = Figure { panels: vec![panel], ..Figure::default() };
        let svg = figure.svg();
        assert!(svg.len() < 100_000, "{} bytes", svg.len());
        let path = svg.lines().filter(|line| line.starts_with("<path d=\"M")).max_by_key(|line| line.len());
        let numbers = path.expect("a curve").split(['M', 'L', '"', ' ']).filter_map(|text| text.parse::<f64>().ok());
        let heights: Vec<f64> = numbers.skip(1).step_by(2).collect();
        let highest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        assert_eq!(heights.iter().filter(|y| **y < highest + 50.0).count(), 1, "one spike is left");
    }

    #[test]
    fn a_figure_is_well_formed_and_small() {
        for scale in [Scale::Linear, Scale::Logarithmic] {
            let svg = wave(scale).svg();
            assert!(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\"") && svg.ends_with("</svg>\n"));
            assert!(svg.contains("a &amp; b") && svg.contains("θ̇ &lt;1&gt;") && svg.contains("A wave"));
            assert!(!svg.contains("NaN") && !svg.contains("inf"));
            assert!(svg.len() < 30_000, "points closer than a hair are one: {} bytes", svg.len());
        }
    }

    #[test]
    fn spikes_are_marked_and_lines_on_one_another_are_dashed() {
        let mut figure = wave(Scale::Linear);
        let first = figure.panels[0].curves[0].clone();
        figure.panels[0].curves.push(Curve { name: "the same".into(), color: 11, ..first });
        assert!(figure.svg().contains("stroke-dasharray=\"6 6\""), "two curves are seen");
        assert!(!figure.svg().contains('▲'));
        figure.panels[0].curves[0].points[700][1] = 2e4;
        let svg = figure.svg();
        assert!(svg.contains("▲ 20000") && svg.contains("l-4 6h8Z"), "{svg:.2000}");
        let mut small = wave(Scale::Linear);
        small.panels[0].curves[0].points.iter_mut().for_each(|p| p[1] *= 1e-9);
        small.panels[0].curves[0].points[700][1] = 2e-5;
        assert!(small.svg().contains("▲ 2e−5"));
        assert!(!svg.contains("stroke-dasharray=\"6 6\"") && svg.contains("stroke-dasharray=\"8 4\""));
        let rings = Curve { name: "start".into(), stroke: Stroke::Rings, points: vec![[0.0, 1.0]], ..Curve::default() };
        let figure = Figure { panels: vec![Panel { curves: vec![rings], ..Panel::default() }], ..Figure::default() };
        assert!(figure.svg().contains(">start</text>"), "a mark is explained");
    }

    #[test]
    fn a_second_run_is_dashed_in_the_same_panels() {
        let mut figure = wave(Scale::Linear);
        let mut other = wave(Scale::Linear);
        other.panels.push(Panel { y_label: "τ [N m]".into(), ..Panel::default() });
        figure.add_run("other.csv", other);
        assert_eq!((figure.panels.len(), figure.panels[0].curves.len()), (2, 4));
        let added = &figure.panels[0].curves[2];
        assert_eq!((added.name.as_str(), added.stroke), ("a & b, other.csv", Stroke::Dashed));
        assert_eq!(added.points, figure.panels[0].curves[0].points);
        assert!(figure.svg().contains("a &amp; b, other.csv") && figure.svg().contains("stroke-dasharray=\"5 3\""));
    }

    #[test]
    fn nothing_to_draw_is_drawn_as_nothing() {
        let empty = Figure { panels: vec![Panel::default()], ..Figure::default() };
        assert!(empty.svg().contains("</svg>") && !empty.svg().contains("NaN"));
    }

    #[test]
    fn curves_break_where_a_number_is_none() {
        let mut figure = wave(Scale::Linear);
        figure.panels[0].curves[0].points[1000] = [10.0, f64::NAN];
        let svg = figure.svg();
        let paths: Vec<&str> = svg.lines().filter(|line| line.contains("stroke=\"#2f6fcb\"")).collect();
        let [_legend, path] = paths[..] else { panic!("{paths:?}") };
        assert_eq!(path.matches('M').count(), 2, "{path:.80}");
    }
}
