//! Curves over time, as an SVG file.

use std::fmt::Write;

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 300.0;
const LEFT: f64 = 90.0;
const TOP: f64 = 60.0;

/// Colours that people with colour blindness can distinguish, too.
const COLOURS: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];

/// A curve: its name, and (t, value) from left to right.
pub type Curve = (String, Vec<[f64; 2]>);

/// The whole file: a title, what the values are, and the curves with their names below each other at the right.
pub fn chart(title: &str, values: &str, curves: &[Curve]) -> String {
    let all = || curves.iter().flat_map(|(_, points)| points);
    let end = all().fold(0.0_f64, |m, p| m.max(p[0]));
    let [low, high] = all().fold([0.0_f64; 2], |[low, high], p| [low.min(p[1]), high.max(p[1])]);
    let span = if high > low { high - low } else { 1.0 };
    let pixel = |[t, y]: [f64; 2]| [LEFT + WIDTH * t / end.max(1e-9), TOP + HEIGHT * (high - y) / span];
    let (w, h) = (LEFT + WIDTH + 210.0, TOP + HEIGHT + 60.0);
    let mut svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{w}' height='{h}' viewBox='0 0 {w} {h}' \
         font-family='DejaVu Sans, Helvetica, Arial, sans-serif' font-size='13'>\n\
         <rect width='100%' height='100%' fill='white'/>\n<text x='{LEFT}' y='28' font-size='17'>{title}</text>\n"
    );
    let mut add = |element: String| {
        // writing to a String cannot fail
        let _ = writeln!(svg, "{element}");
    };
    for k in 0..=5 {
        let (t, y) = (end * f64::from(k) / 5.0, low + span * f64::from(k) / 5.0);
        let ([x, _], [_, at]) = (pixel([t, 0.0]), pixel([0.0, y]));
        let (bottom, right) = (TOP + HEIGHT, LEFT + WIDTH);
        add(format!("<line x1='{x:.1}' y1='{TOP}' x2='{x:.1}' y2='{bottom}' stroke='#e4e4e4'/>"));
        add(format!("<line x1='{LEFT}' y1='{at:.1}' x2='{right}' y2='{at:.1}' stroke='#e4e4e4'/>"));
        add(format!("<text x='{x:.1}' y='{:.1}' text-anchor='middle'>{t:.2}</text>", bottom + 20.0));
        add(format!("<text x='{:.1}' y='{:.1}' text-anchor='end'>{y:.2e}</text>", LEFT - 8.0, at + 4.0));
    }
    add(format!(
        "<text x='{:.1}' y='{:.1}' text-anchor='middle'>t in s</text>",
        LEFT + 0.5 * WIDTH,
        TOP + HEIGHT + 45.0
    ));
    add(format!("<text x='{LEFT}' y='48'>{values}</text>"));
    for (k, (name, points)) in curves.iter().enumerate() {
        let colour = COLOURS[k % COLOURS.len()];
        let line: Vec<String> = points.iter().map(|&p| pixel(p)).map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        add(format!("<polyline points='{}' fill='none' stroke='{colour}' stroke-width='1.8'/>", line.join(" ")));
        let (x, y) = (LEFT + WIDTH + 16.0, TOP + 14.0 + 20.0 * k as f64);
        add(format!(
            "<line x1='{x}' y1='{:.1}' x2='{:.1}' y2='{:.1}' stroke='{colour}' stroke-width='3'/>",
            y - 4.0,
            x + 20.0,
            y - 4.0
        ));
        add(format!("<text x='{:.1}' y='{y}'>{name}</text>", x + 28.0));
    }
    svg + "</svg>\n"
}
