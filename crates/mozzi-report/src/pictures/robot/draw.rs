//! The picture's text.

use super::order::bounds;
use super::skeleton::Axis;
use super::solid::Solid;
use super::view::{Point, Projection};
use crate::markup::{SANS, escaped};
use mozzi::spatial::Rounded;
use mozzi::{SE3, Vec3};
use std::fmt::Write;

/// The width of the picture and the greatest height of the robot; all lengths are in these units.
const WIDTH: f64 = 720.0;
const TALLEST: f64 = 640.0;
/// Around the robot: left and right, above, below.
const MARGIN: [f64; 3] = [70.0, 58.0, 64.0];
/// Length of half an axis and of a frame's axis over the robot's size.
const AXIS: f64 = 0.085;
const FRAME: f64 = 0.07;
/// x, y, z.
const TRIAD: [&str; 3] = ["#d0393e", "#2a8f63", "#2f6fcb"];

/// Colours that differ between light and dark.
struct Ink {
    ground: &'static str,
    text: &'static str,
    /// Around bodies.
    edge: &'static str,
    axis: &'static str,
}

const LIGHT: Ink = Ink { ground: "#ffffff", text: "#222222", edge: "#2b333c", axis: "#d0393e" };
const DARK: Ink = Ink { ground: "#15191f", text: "#e6eaef", edge: "#8794a3", axis: "#ff8a8e" };

pub(super) struct Canvas {
    P: Projection,
    ink: Ink,
    body: String,
    /// Units per metre.
    scale: f64,
    /// The point of the picture's plane at the left and above, in m.
    corner: Point,
    height: f64,
    /// The robot's size, m.
    size: f64,
}

impl Canvas {
    /// A canvas for these bodies and points.
    pub fn new(P: Projection, is_dark: bool, bodies: &[&[Solid]], points: &[Point], size: f64) -> Self {
        let outlines = bodies.iter().copied().flatten().flat_map(|solid| &solid.outline);
        let [mut x, mut y] = bounds(outlines.chain(points));
        for range in [&mut x, &mut y] {
            if range[0] > range[1] {
                *range = [-0.5, 0.5]; // nothing is drawn
            }
            let air = (0.02 * size).max(0.5 * (0.15 * size - (range[1] - range[0])));
            *range = [range[0] - air, range[1] + air];
        }
        let [wide, tall] = [x[1] - x[0], y[1] - y[0]];
        let scale = ((WIDTH - 2.0 * MARGIN[0]) / wide).min(TALLEST / tall);
        let left = 0.5 * (x[0] + x[1]) - 0.5 * WIDTH / scale;
        let height = MARGIN[1] + tall * scale + MARGIN[2];
        let ink = if is_dark { DARK } else { LIGHT };
        Canvas { P, ink, body: String::new(), scale, corner: [left, y[1] + MARGIN[1] / scale], height, size }
    }

    fn place(&self, [x, y]: Point) -> Point {
        [(x - self.corner[0]) * self.scale, (self.corner[1] - y) * self.scale]
    }

    fn at(&self, p: Vec3) -> Point {
        self.place(self.P.point(p))
    }

    fn polygon(&self, points: &[Point]) -> String {
        let mut path = String::new();
        for (k, &p) in points.iter().enumerate() {
            let [x, y] = self.place(p);
            let _ = write!(path, "{}{x:.1} {y:.1}", if k == 0 { "M" } else { "L" });
        }
        path + "Z"
    }

    /// The solids of one body, with one line around them all.
    pub fn body(&mut self, name: &str, solids: &[Solid]) {
        let mut solids: Vec<&Solid> = solids.iter().collect();
        solids.sort_by(|a, b| a.depth.total_cmp(&b.depth));
        let around: String = solids.iter().map(|solid| self.polygon(&solid.outline)).collect();
        let mut text = format!("<g data-body=\"{}\">\n", escaped(name));
        let _ = writeln!(text, "<path d=\"{around}\" stroke=\"{}\" stroke-width=\"2.4\"/>", self.ink.edge);
        for solid in solids {
            for part in solid.parts(&self.P) {
                let color = solid.color.map(|c| (255.0 * (c * part.brightness).clamp(0.0, 1.0)).round() as u8);
                let [r, g, b] = color;
                let _ = writeln!(text, "<path d=\"{}\" fill=\"#{r:02x}{g:02x}{b:02x}\"/>", self.polygon(&part.outline));
            }
        }
        self.body += &text;
        self.body += "</g>\n";
    }

    /// A dash-dotted line along a turning joint's axis, an arrow along a sliding joint's, a ring at a ball.
    pub fn axis(&mut self, axis: &Axis) {
        let color = self.ink.axis;
        let [x, y] = self.at(axis.point);
        let _ = write!(self.body, "<g class=\"axis\" stroke=\"{color}\" stroke-width=\"1.2\">");
        if let Some(direction) = axis.direction {
            let half = direction * (AXIS * self.size);
            let ends = [axis.point - half, axis.point + half].map(|p| self.at(p));
            let [[a, b], [c, d]] = ends;
            let dashes = if axis.is_sliding { "" } else { " stroke-dasharray=\"9 3 2 3\"" };
            let _ = write!(self.body, "<path d=\"M{a:.1} {b:.1}L{c:.1} {d:.1}\"{dashes}/>");
            let length = (c - a).hypot(d - b);
            if length > 6.0 {
                let (u, v) = ((c - a) / length, (d - b) / length);
                let back = [c - 6.0 * u, d - 6.0 * v];
                let [l, r] = [1.0, -1.0].map(|s| [back[0] - 2.5 * s * v, back[1] + 2.5 * s * u]);
                let _ = write!(
                    self.body,
                    "<path d=\"M{c:.1} {d:.1}L{:.1} {:.1}L{:.1} {:.1}Z\" fill=\"{color}\" stroke=\"none\"/>",
                    l[0], l[1], r[0], r[1]
                );
            }
        }
        let radius = if axis.direction.is_some() { 2.2 } else { 6.0 };
        let fill = if axis.direction.is_some() { color } else { "none" };
        let _ = writeln!(self.body, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{fill}\"/></g>");
    }

    /// x red, y green, z blue.
    pub fn frame(&mut self, T: SE3) {
        let [x, y] = self.at(T.p);
        let _ = write!(self.body, "<g class=\"frame\" stroke-width=\"1.8\" stroke-linecap=\"round\">");
        for (k, color) in TRIAD.into_iter().enumerate() {
            let mut e = Vec3::zero();
            e.0[k] = FRAME * self.size;
            let [a, b] = self.at(T * e);
            let _ = write!(self.body, "<path d=\"M{x:.1} {y:.1}L{a:.1} {b:.1}\" stroke=\"{color}\"/>");
        }
        self.body += "</g>\n";
    }

    /// A disc of four quarters.
    pub fn center_of_mass(&mut self, p: Vec3) {
        let [x, y] = self.at(p);
        let _ = writeln!(
            self.body,
            "<g class=\"mass\" stroke=\"#111111\"><circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"7\" fill=\"#ffffff\"/>\
             <path d=\"M{x:.1} {y:.1}v-7a7 7 0 0 1 7 7ZM{x:.1} {y:.1}v7a7 7 0 0 1 -7 -7Z\" fill=\"#111111\"/></g>"
        );
    }

    /// The directions of {s}, and a scale: lengths across the direction of view are true.
    fn corner_marks(&mut self) {
        let (x, y) = (40.0, self.height - 34.0);
        let _ = write!(self.body, "<g class=\"space\" stroke-width=\"1.5\">");
        for (k, color) in TRIAD.into_iter().enumerate() {
            let mut e = Vec3::zero();
            e.0[k] = 1.0;
            let [a, b] = self.P.point(e);
            if a.hypot(b) < 0.1 {
                continue; // towards the viewer
            }
            let _ = write!(self.body, "<path d=\"M{x} {y:.1}l{:.1} {:.1}\" stroke=\"{color}\"/>", 24.0 * a, -24.0 * b);
            let (a, b) = (x + 32.0 * a, y - 32.0 * b + 3.5);
            let name = ["x", "y", "z"][k];
            let text = self.ink.text;
            let _ = write!(
                self.body,
                "<text x=\"{a:.1}\" y=\"{b:.1}\" text-anchor=\"middle\" font-size=\"11\" fill=\"{text}\">{name}</text>"
            );
        }
        self.body += "</g>\n";
        let longest = 150.0 / self.scale;
        let power = 10.0_f64.powf(longest.log10().floor());
        let length = [5.0, 2.0, 1.0].map(|k| k * power).into_iter().find(|l| *l <= longest).unwrap_or(power);
        let (end, bar) = (WIDTH - 24.0, length * self.scale);
        let (start, y, text) = (end - bar, self.height - 22.0, self.ink.text);
        let name = if length < 0.1 { format!("{} mm", Rounded(1e3 * length)) } else { format!("{length} m") };
        let _ = writeln!(
            self.body,
            "<g class=\"scale\"><path d=\"M{start:.1} {:.1}v8m0 -4h{bar:.1}m0 -4v8\" stroke=\"{text}\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\" font-size=\"11\" fill=\"{text}\">{name}</text></g>",
            y - 4.0,
            0.5 * (start + end),
            y - 8.0
        );
    }

    pub fn svg(mut self, title: &str, has_marks: bool) -> String {
        if has_marks {
            self.corner_marks();
        }
        let Ink { ground, text, .. } = self.ink;
        let (height, title, body) = (self.height, escaped(title), self.body);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height:.0}\" width=\"{WIDTH}\" height=\"{height:.0}\" \
             font-family=\"{SANS}\" fill=\"none\" stroke-linejoin=\"round\">\n<title>{title}</title>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"{ground}\"/>\n\
             <text x=\"{}\" y=\"28\" text-anchor=\"middle\" font-size=\"15\" fill=\"{text}\">{title}</text>\n{body}</svg>\n",
            WIDTH / 2.0
        )
    }
}
