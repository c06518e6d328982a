//! Plots of curves in a plane, with equal scales on both axes, as an SVG file.

use std::fmt::Write;

/// Pixels: the width of the plotted part of the plane, and the margins around it.
const WIDTH: f64 = 660.0;
const LEFT: f64 = 80.0;
const RIGHT: f64 = 30.0;
const TOP: f64 = 80.0;
const BOTTOM: f64 = 70.0;

/// A part of the plane around the origin, from −range to range along each axis.
#[derive(Clone, Debug)]
pub struct Plot {
    range: [f64; 2],
    marks: String,
}

impl Plot {
    /// With a title and a line below it, the names of the axes (units in them), and grid lines at multiples of `tick`.
    pub fn new(title: [&str; 2], axes: [&str; 2], range: [f64; 2], tick: f64) -> Self {
        let mut plot = Plot { range, marks: String::new() };
        let ([left, bottom], [right, top]) = (plot.pixel([-range[0], -range[1]]), plot.pixel(range));
        for axis in [0, 1] {
            let count = (range[axis] / tick).floor() as i32;
            for k in -count..=count {
                let at = f64::from(k) * tick;
                let ([x, y], colour) = (plot.pixel([at, at]), if k == 0 { "#888" } else { "#e4e4e4" });
                let label = format!("{at}").replace('-', "−");
                if axis == 0 {
                    plot.add(&format!("<path d='M{x:.1} {top}V{bottom}' stroke='{colour}'/>"));
                    plot.label([x, bottom + 20.0], "middle", "#333", 14, &label);
                } else {
                    plot.add(&format!("<path d='M{left} {y:.1}H{right}' stroke='{colour}'/>"));
                    plot.label([left - 8.0, y + 5.0], "end", "#333", 14, &label);
                }
            }
        }
        let (width, height, x, y) = (right - left, bottom - top, (left + right) / 2.0, (top + bottom) / 2.0);
        plot.add(&format!("<rect x='{left}' y='{top}' width='{width}' height='{height}' fill='none' stroke='#333'/>"));
        plot.label([x, 34.0], "middle", "#000", 20, title[0]);
        plot.label([x, 60.0], "middle", "#555", 15, title[1]);
        plot.label([x, bottom + 50.0], "middle", "#000", 16, axes[0]);
        plot.add(&format!(
            "<text transform='translate(32 {y}) rotate(-90)' text-anchor='middle' font-size='16'>{}</text>",
            axes[1]
        ));
        plot
    }

    /// A line through points; dashed or not.
    pub fn curve(&mut self, points: impl IntoIterator<Item = [f64; 2]>, colour: &str, width: f64, dashed: bool) {
        let path: Vec<String> =
            points.into_iter().map(|p| self.pixel(p)).map(|[x, y]| format!("{x:.2},{y:.2}")).collect();
        let dash = if dashed { " stroke-dasharray='7 5'" } else { "" };
        let points = path.join(" ");
        self.add(&format!("<polyline points='{points}' fill='none' stroke='{colour}' stroke-width='{width}'{dash}/>"));
    }

    /// An arrow from the origin.
    pub fn arrow(&mut self, to: [f64; 2], colour: &str) {
        self.curve([[0.0; 2], to], colour, 2.2, false);
        let ([x, y], [x0, y0]) = (self.pixel(to), self.pixel([0.0; 2]));
        let length = (x - x0).hypot(y - y0);
        let (c, s) = ((x - x0) / length, (y - y0) / length);
        let side = |k: f64| format!("{:.2},{:.2}", x - 13.0 * c - k * s, y - 13.0 * s + k * c);
        self.add(&format!("<polygon points='{x:.2},{y:.2} {} {}' fill='{colour}'/>", side(5.0), side(-5.0)));
    }

    /// A dot.
    pub fn dot(&mut self, at: [f64; 2], colour: &str) {
        let [x, y] = self.pixel(at);
        self.add(&format!("<circle cx='{x:.2}' cy='{y:.2}' r='4.5' fill='{colour}'/>"));
    }

    /// Text at a point, with a white outline; `anchor` is `start`, `middle` or `end`.
    pub fn text(&mut self, at: [f64; 2], anchor: &str, colour: &str, words: &str) {
        let [x, y] = self.pixel(at);
        self.add(&format!(
            "<text x='{x:.1}' y='{y:.1}' text-anchor='{anchor}' font-size='15' stroke='white' stroke-width='5'>{words}</text>"
        ));
        self.label([x, y], anchor, colour, 15, words);
    }

    /// The whole file.
    pub fn svg(&self) -> String {
        let [w, h] = [LEFT + WIDTH + RIGHT, TOP + WIDTH * self.range[1] / self.range[0] + BOTTOM];
        format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='{w}' height='{h}' viewBox='0 0 {w} {h}' \
             font-family='DejaVu Sans, Helvetica, Arial, sans-serif'>\n<rect width='100%' height='100%' fill='white'/>\n{}</svg>\n",
            self.marks
        )
    }

    fn pixel(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let scale = WIDTH / (2.0 * self.range[0]);
        [LEFT + (x + self.range[0]) * scale, TOP + (self.range[1] - y) * scale]
    }

    fn label(&mut self, [x, y]: [f64; 2], anchor: &str, colour: &str, size: u32, words: &str) {
        self.add(&format!(
            "<text x='{x:.1}' y='{y:.1}' text-anchor='{anchor}' fill='{colour}' font-size='{size}'>{words}</text>"
        ));
    }

    fn add(&mut self, element: &str) {
        // writing to a String cannot fail
        let _ = writeln!(self.marks, "{element}");
    }
}
