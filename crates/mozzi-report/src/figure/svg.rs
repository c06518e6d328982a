//! The figure's text.

use super::{Curve, Figure, Panel, Stroke};
use crate::markup::{SANS, escaped};
use mozzi::spatial::Rounded;
use std::fmt::Write;

/// The width of a paper's page; all lengths are in these units.
const WIDTH: f64 = 720.0;
const PANEL_HEIGHT: f64 = 190.0;
/// The height of a single panel.
const ONLY_HEIGHT: f64 = 340.0;
/// Margins around a panel's axes: left, right, above, below.
const MARGIN: [f64; 4] = [62.0, 12.0, 8.0, 40.0];
/// Points closer than this are merged.
const HAIR: f64 = 0.35;
const LEGEND_LINE: f64 = 17.0;
/// Approximate width of a letter of the legend.
const LETTER: f64 = 6.2;

/// Colours that can be distinguished on white; at least the first four also in grey.
const PALETTE: [&str; 10] =
    ["#2f6fcb", "#d96a26", "#2a8f63", "#b83a5e", "#7a52c7", "#9a7b16", "#16879b", "#c253a6", "#555d66", "#111111"];

/// Dashes of the eleventh and further curves.
const DASHES: [&str; 3] = ["8 4", "2 3", "10 3 2 3"];

fn color(k: usize) -> &'static str {
    PALETTE[k % PALETTE.len()]
}

impl Figure {
    /// The figure as SVG: black on white, text as text.
    pub fn svg(&self) -> String {
        let columns = self.columns.max(1);
        let width = WIDTH / columns as f64;
        let mut body = String::new();
        let mut y = 8.0;
        if !self.title.is_empty() {
            y += 16.0;
            text(&mut body, [WIDTH / 2.0, y], "middle", 14.0, &self.title);
            y += 8.0;
        }
        y = self.legend(&mut body, y);
        for row in self.panels.chunks(columns) {
            let tall = row.iter().map(|panel| panel.height(width, self.panels.len())).fold(0.0, f64::max);
            for (k, panel) in row.iter().enumerate() {
                panel.draw(&mut body, [k as f64 * width, y], [width, tall]);
            }
            y += tall;
        }
        let height = y + 4.0;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height:.0}\" width=\"{WIDTH}\" height=\"{height:.0}\" \
             font-family=\"{SANS}\" fill=\"none\" stroke-linejoin=\"round\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{body}</svg>\n"
        )
    }

    /// The figure as SVG with the colours of a page's style sheet, for light and dark: `--c0` to `--c9`, `--panel`,
    /// `--text`, `--muted`, `--line`.
    pub fn svg_of_page(&self) -> String {
        let colors = PALETTE.iter().enumerate().map(|(k, color)| (*color, format!("var(--c{k})")));
        let grounds = [("#ffffff", "panel"), ("#222", "text"), ("#333", "muted"), ("#e3e6ea", "line")];
        let grounds = grounds.into_iter().map(|(color, name)| (color, format!("var(--{name})")));
        colors
            .chain(grounds)
            .fold(self.svg(), |text, (color, name)| text.replace(&format!("\"{color}\""), &format!("\"{name}\"")))
    }

    /// The names of all panels' curves, once each; returns the legend's end.
    fn legend(&self, out: &mut String, top: f64) -> f64 {
        let mut names: Vec<&Curve> = Vec::new();
        for curve in self.panels.iter().flat_map(|panel| &panel.curves) {
            if !curve.name.is_empty() && names.iter().all(|known| known.name != curve.name) {
                names.push(curve);
            }
        }
        // one name says nothing, but of what is marked
        if names.len() < 2 && names.iter().all(|curve| curve.stroke != Stroke::Rings) {
            return top;
        }
        let (mut x, mut y) = (MARGIN[0], top + 10.0);
        for curve in names {
            let long = 34.0 + LETTER * curve.name.chars().count() as f64;
            if x + long > WIDTH - MARGIN[1] && x > MARGIN[0] {
                (x, y) = (MARGIN[0], y + LEGEND_LINE);
            }
            let ends = [[x, y], [x + 20.0, y]];
            match curve.stroke {
                Stroke::Dots | Stroke::Rings => line(out, &[[x + 10.0, y]], curve, 0),
                Stroke::Dashed => line(out, &ends, curve, 0),
                _ => line(out, &ends, &Curve { stroke: Stroke::Line, ..curve.clone() }, 0),
            }
            text(out, [x + 25.0, y + 3.8], "start", 11.0, &curve.name);
            x += long;
        }
        y + LEGEND_LINE - 4.0
    }
}

impl Panel {
    fn height(&self, width: f64, panels: usize) -> f64 {
        if !self.equal {
            return if panels == 1 { ONLY_HEIGHT } else { PANEL_HEIGHT };
        }
        // as tall as equal units need, within bounds
        let ([[left, right], [low, high]], _) = self.ranges();
        let inner = (width - MARGIN[0] - MARGIN[1]) * ((high - low) / (right - left)).clamp(0.4, 1.2);
        inner + MARGIN[2] + MARGIN[3]
    }

    fn draw(&self, out: &mut String, [x0, y0]: [f64; 2], [width, height]: [f64; 2]) {
        let [left, top] = [x0 + MARGIN[0], y0 + MARGIN[2]];
        let (w, h) = (width - MARGIN[0] - MARGIN[1], height - MARGIN[2] - MARGIN[3]);
        let ([mut xs, mut ys], cut) = self.ranges();
        if self.equal {
            let unit = ((xs[1] - xs[0]) / w).max((ys[1] - ys[0]) / h);
            let widened = |[low, high]: [f64; 2], size: f64| {
                let (middle, half) = (0.5 * (low + high), 0.5 * size * unit);
                [middle - half, middle + half]
            };
            (xs, ys) = (widened(xs, w), widened(ys, h));
        }
        let across = |x: f64| left + (x - xs[0]) / (xs[1] - xs[0]) * w;
        let up = |y: f64| top + (1.0 - (y - ys[0]) / (ys[1] - ys[0])) * h;
        for (place, name) in self.ticks(xs, (w / 75.0) as usize).0 {
            let _ = writeln!(out, "<path d=\"M{0:.1} {top:.1}v{h:.1}\" stroke=\"#e3e6ea\"/>", across(place));
            text(out, [across(place), top + h + 14.0], "middle", 10.5, &name);
        }
        for (place, name) in self.ticks(ys, (h / 28.0) as usize).0 {
            let _ = writeln!(out, "<path d=\"M{left:.1} {0:.1}h{w:.1}\" stroke=\"#e3e6ea\"/>", up(place));
            text(out, [left - 6.0, up(place) + 3.6], "end", 10.5, &name);
        }
        for (k, curve) in self.curves.iter().enumerate() {
            // spikes end at the border
            let height = |y: f64| if cut == [None; 2] { y } else { y.clamp(ys[0], ys[1]) };
            let point = |p: &[f64; 2]| [across(self.scale.place(p[0])), up(height(self.scale.place(p[1])))];
            let points = curve.points.iter().map(point).collect::<Vec<_>>();
            let has_marks = !matches!(curve.stroke, Stroke::Line | Stroke::Dashed);
            let points = if has_marks { points } else { thinned(points) };
            line(out, &points, curve, self.lies_on(k, ys[1] - ys[0]));
        }
        for (side, peak) in cut.into_iter().enumerate().filter_map(|(side, peak)| Some((side, peak?))) {
            let is_beyond = |y: f64| if side == 1 { y > ys[1] } else { y < ys[0] };
            let beyond = self.curves.iter().flat_map(|curve| &curve.points).filter(|p| is_beyond(p[1]));
            let (edge, inside) = if side == 1 { (top, 6.0) } else { (top + h, -6.0) };
            peaks(out, beyond.map(|p| across(p[0])), [edge, inside]);
            let sign = if side == 1 { '▲' } else { '▼' };
            let name = format!("{sign} {}", Rounded(peak));
            text(
                out,
                [left + w - 4.0, edge + if side == 1 { 14.0 } else { -7.0 }],
                "end",
                10.5,
                &name.replace('-', "−"),
            );
        }
        let _ = writeln!(out, "<path d=\"M{left:.1} {top:.1}v{h:.1}h{w:.1}\" stroke=\"#333\"/>");
        text(out, [left + w / 2.0, top + h + 30.0], "middle", 11.5, &self.x_label);
        let (x, y) = (x0 + 14.0, top + h / 2.0);
        let _ = write!(out, "<g transform=\"rotate(-90 {x:.1} {y:.1})\">");
        text(out, [x, y], "middle", 11.5, &self.y_label);
        out.push_str("</g>\n");
    }
}

/// Marks where curves leave the panel, none nearer to another than its width.
fn peaks(out: &mut String, places: impl Iterator<Item = f64>, [edge, inside]: [f64; 2]) {
    let mut places: Vec<f64> = places.collect();
    places.sort_unstable_by(f64::total_cmp);
    let mut last = f64::NEG_INFINITY;
    for x in places {
        if x - last < 9.0 {
            continue;
        }
        last = x;
        let _ = writeln!(out, "<path d=\"M{x:.1} {edge:.1}l-4 {inside}h8Z\" fill=\"#333\"/>");
    }
}

/// A curve from left to right, with at most four points in each strip of half a unit: its first, lowest, highest and
/// last one, so that it looks the same.
fn thinned(points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let strip = |p: &[f64; 2]| (2.0 * p[0]).floor();
    let is_forward = points.windows(2).all(|pair| pair[0][0] <= pair[1][0]);
    if !is_forward || points.iter().any(|p| !p[1].is_finite()) {
        return points;
    }
    let mut found = Vec::new();
    for run in points.chunk_by(|a, b| strip(a) == strip(b)) {
        let by_height = |(_, a): &(usize, &[f64; 2]), (_, b): &(usize, &[f64; 2])| a[1].total_cmp(&b[1]);
        let end = |k: Option<(usize, &[f64; 2])>| k.map_or(0, |(k, _)| k);
        let low = end(run.iter().enumerate().min_by(by_height));
        let high = end(run.iter().enumerate().max_by(by_height));
        let mut kept = [0, low, high, run.len() - 1];
        kept.sort_unstable();
        let distinct = kept.chunk_by(|a, b| a == b).map(|same| run[same[0]]);
        found.extend(distinct);
    }
    found
}

/// A curve that lies `on` others is dashes on them.
fn line(out: &mut String, points: &[[f64; 2]], curve: &Curve, on: usize) {
    let (mut path, mut marks) = (String::new(), String::new());
    let mut last: Option<[f64; 2]> = None;
    for (k, &[x, y]) in points.iter().enumerate() {
        if !(x.is_finite() && y.is_finite()) {
            last = None;
            continue;
        }
        let is_end = points.get(k + 1).is_none_or(|next| !(next[0].is_finite() && next[1].is_finite()));
        if let (Some([a, b]), false) = (last, is_end)
            && (x - a).hypot(y - b) < HAIR
        {
            continue;
        }
        let _ = write!(path, "{}{x:.1} {y:.1}", if last.is_some() { "L" } else { "M" });
        if matches!(curve.stroke, Stroke::Marked | Stroke::Links | Stroke::Rings) {
            let _ = write!(marks, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.8\"/>");
        } else if curve.stroke == Stroke::Dots {
            let _ = write!(marks, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"1.9\"/>");
        }
        last = Some([x, y]);
    }
    let color = color(curve.color);
    let style = match curve.stroke {
        Stroke::Line if on > 0 => format!("stroke-width=\"1.4\" stroke-dasharray=\"6 {}\"", 6 * on),
        // colours come again from the eleventh on, with other dashes
        Stroke::Line | Stroke::Marked => match curve.color / PALETTE.len() {
            0 => "stroke-width=\"1.4\"".to_string(),
            k => format!("stroke-width=\"1.4\" stroke-dasharray=\"{}\"", DASHES[(k - 1) % DASHES.len()]),
        },
        Stroke::Dots | Stroke::Rings => String::new(),
        Stroke::Dashed => "stroke-width=\"1.2\" stroke-dasharray=\"5 3\"".to_string(),
        Stroke::Filled => format!("stroke-width=\"1.2\" fill=\"{color}\" fill-opacity=\"0.12\""),
        Stroke::Links => "stroke-width=\"3\" stroke-linecap=\"round\"".to_string(),
    };
    if curve.stroke == Stroke::Dots {
        let _ = writeln!(out, "<g fill=\"{color}\" fill-opacity=\"0.45\">{marks}</g>");
        return;
    }
    if curve.stroke == Stroke::Rings {
        let _ = writeln!(out, "<g fill=\"#ffffff\" stroke=\"{color}\" stroke-width=\"1.6\">{marks}</g>");
        return;
    }
    let close = if curve.stroke == Stroke::Filled && !path.is_empty() { "Z" } else { "" };
    let _ = writeln!(out, "<path d=\"{path}{close}\" stroke=\"{color}\" {style}/>");
    if !marks.is_empty() {
        let _ = writeln!(out, "<g fill=\"{color}\">{marks}</g>");
    }
}

fn text(out: &mut String, [x, y]: [f64; 2], anchor: &str, size: f64, what: &str) {
    let what = escaped(what);
    let _ = writeln!(
        out,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" font-size=\"{size}\" fill=\"#222\">{what}</text>"
    );
}
