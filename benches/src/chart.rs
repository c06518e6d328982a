//! The ratios as a picture: for each robot a panel, for each quantity a row, for each library a mark at its time over
//! mozzi's.

use crate::race::Table;
use std::fmt::Write;

/// Medium colours, with contrast on black and on white.
const INK: &str = "#808080";
const COLOURS: [&str; 9] =
    ["#3f87e0", "#e07b2e", "#2aa36b", "#b45fd6", "#e0506e", "#17a2b8", "#a08a1f", "#7a6ff0", "#c46a9a"];

const LEFT: f64 = 210.0;
const PANEL: f64 = 300.0;
const ROW: f64 = 22.0;
const HEAD: f64 = 70.0;
const GAP: f64 = 46.0;
const PANELS_ABREAST: usize = 2;

/// Drawn by hand: a scale, marks and names.
pub fn svg(tables: &[Table]) -> String {
    let names = names(tables);
    let (low, high) = bounds(tables);
    let rows = tables.first().map_or(0, |table| table.rows.len()) as f64;
    let lines = tables.len().div_ceil(PANELS_ABREAST) as f64;
    let width = LEFT + PANELS_ABREAST as f64 * (PANEL + 30.0);
    let height = HEAD + lines * (rows * ROW + GAP) + 10.0;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"12\" fill=\"{INK}\">\n\
         <title>Times over mozzi's at one state, on a logarithmic scale</title>\n\
         <text x=\"10\" y=\"20\" font-size=\"14\">Time over mozzi's at one state; right of the line is slower</text>\n"
    );
    legend(&mut svg, &names);
    for (k, table) in tables.iter().enumerate() {
        let left = LEFT + (k % PANELS_ABREAST) as f64 * (PANEL + 30.0);
        let top = HEAD + (k / PANELS_ABREAST) as f64 * (rows * ROW + GAP) + 20.0;
        panel(&mut svg, table, &names, (left, top), (low, high), k % PANELS_ABREAST == 0);
    }
    svg + "</svg>\n"
}

/// Every column but the first, once.
fn names(tables: &[Table]) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for column in tables.iter().flat_map(|table| table.columns.iter().skip(1)) {
        if !names.contains(&column.name.as_str()) {
            names.push(&column.name);
        }
    }
    names
}

/// The least and the largest ratio, as powers of two around 1.
fn bounds(tables: &[Table]) -> (i32, i32) {
    let (mut low, mut high) = (0.0_f64, 1.0_f64);
    for row in tables.iter().flat_map(|table| &table.rows) {
        let Some(unit) = &row.times[0] else { continue };
        for time in row.times.iter().flatten() {
            let x = (time.least / unit.least).log2();
            (low, high) = (low.min(x), high.max(x));
        }
    }
    (low.floor() as i32, high.ceil() as i32)
}

fn legend(svg: &mut String, names: &[&str]) {
    let mut x = 16.0;
    for (k, name) in names.iter().enumerate() {
        mark(svg, k, x, 40.0);
        let _ = writeln!(svg, "<text x=\"{}\" y=\"44\">{}</text>", x + 9.0, escaped(name));
        x += 30.0 + 7.0 * name.chars().count() as f64;
    }
}

fn panel(
    svg: &mut String,
    table: &Table,
    names: &[&str],
    (left, top): (f64, f64),
    (low, high): (i32, i32),
    is_labelled: bool,
) {
    let place = |x: f64| left + PANEL * (x - f64::from(low)) / f64::from(high - low);
    let bottom = top + ROW * table.rows.len() as f64;
    let _ = writeln!(
        svg,
        "<text x=\"{left}\" y=\"{}\" font-weight=\"bold\">{}, n = {}</text>",
        top - 8.0,
        escaped(&table.robot),
        table.n
    );
    for power in low..=high {
        let (x, thick) = (place(f64::from(power)), if power == 0 { 1.5 } else { 0.4 });
        let label = if power < 0 { format!("1/{}", 1 << -power) } else { format!("{}", 1 << power) };
        let _ = writeln!(
            svg,
            "<line x1=\"{x:.1}\" y1=\"{top}\" x2=\"{x:.1}\" y2=\"{bottom}\" stroke=\"{INK}\" stroke-width=\"{thick}\"/>\
             <text x=\"{x:.1}\" y=\"{:.1}\" font-size=\"10\" text-anchor=\"middle\">{label}</text>",
            bottom + 13.0
        );
    }
    for (k, row) in table.rows.iter().enumerate() {
        let y = top + ROW * (k as f64 + 0.5);
        let _ = writeln!(
            svg,
            "<line x1=\"{left}\" y1=\"{y:.1}\" x2=\"{:.1}\" y2=\"{y:.1}\" stroke=\"{INK}\" stroke-width=\"0.3\"/>",
            left + PANEL
        );
        if is_labelled {
            let (x, y) = (left - 10.0, y + 4.0);
            let name = row.quantity.name();
            let _ = writeln!(svg, "<text x=\"{x}\" y=\"{y:.1}\" text-anchor=\"end\">{name}</text>");
        }
        let Some(unit) = &row.times[0] else { continue };
        for (column, time) in table.columns.iter().zip(&row.times).skip(1) {
            let (Some(time), Some(colour)) = (time, names.iter().position(|name| *name == column.name)) else {
                continue;
            };
            mark(svg, colour, place((time.least / unit.least).log2()), y);
        }
    }
}

/// A mark of the k-th library: libraries differ by shape as well as by colour.
fn mark(svg: &mut String, k: usize, x: f64, y: f64) {
    let colour = COLOURS[k % COLOURS.len()];
    let polygon = |points: &[(f64, f64)]| {
        let points = points.iter().map(|(dx, dy)| format!("{:.1},{:.1}", x + dx, y + dy));
        format!("<polygon points=\"{}\" fill=\"{colour}\"/>", points.collect::<Vec<_>>().join(" "))
    };
    let shape = match k % 5 {
        0 => polygon(&[(-5.0, 0.0), (0.0, -5.0), (5.0, 0.0), (0.0, 5.0)]),
        1 => format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4.5\" fill=\"{colour}\"/>"),
        2 => polygon(&[(-4.0, -4.0), (4.0, -4.0), (4.0, 4.0), (-4.0, 4.0)]),
        3 => polygon(&[(-5.0, 4.0), (5.0, 4.0), (0.0, -5.0)]),
        _ => polygon(&[(-5.0, -4.0), (5.0, -4.0), (0.0, 5.0)]),
    };
    let _ = writeln!(svg, "{shape}");
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

#[cfg(test)]
mod tests {
    use super::svg;
    use crate::count::Count;
    use crate::race::{Column, Row, Table, Time};
    use mozzi::quantities::MassMatrix;

    #[test]
    fn a_mark_stands_at_its_ratio() {
        let column = |name: &str| Column { name: name.into(), width: None, difference: 0.0 };
        let time = |least| Some(Time { algorithm: String::new(), least, median: least, flops: None });
        let row =
            Row { quantity: MassMatrix.into(), count: Count::default(), times: vec![time(100.0), time(200.0), None] };
        let columns = vec![column("mozzi"), column("a & b"), column("c")];
        let rows = vec![row];
        let text =
            svg(&[Table { robot: "arm".into(), n: 6, states: 1, rounds: 1, to_first_result: None, columns, rows }]);
        assert!(text.contains("a &amp; b") && !text.contains(" & "), "{text}");
        assert_eq!(text.matches("<polygon").count(), 2, "the first one's in the legend and in the panel: {text}");
        assert!(text.contains("points=\"505.0,"), "twice as long is at the right end of 1 to 2: {text}");
    }
}
