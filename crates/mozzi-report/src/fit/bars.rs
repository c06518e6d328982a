//! Parameters as bars with intervals, before and after.

use super::sliding;
use crate::markup::escaped;
use crate::text::digits;
use mozzi_identify::{Identification, Kind};
use std::fmt::Write as _;

const WIDTH: f64 = 720.0;
/// Where bars begin and end, the rest is for names and numbers.
const LEFT: f64 = 190.0;
const RIGHT: f64 = 540.0;
const ROW: f64 = 26.0;

/// A parameter: before and after, two standard deviations, how much comes from the robot's file.
struct Bar<'f> {
    name: &'f str,
    before: f64,
    after: f64,
    interval: f64,
    share: f64,
}

/// A title, a unit, and what belongs to it.
type Group = (&'static str, &'static str, fn(Kind) -> bool);

/// Groups of one unit, each with bars of its own length.
const GROUPS: [Group; 8] = [
    ("Masses", "kg", |kind| matches!(kind, Kind::Link(k) if k % 10 == 0) || kind == Kind::Payload(0)),
    ("Armature", "kg m²", |kind| matches!(kind, Kind::Armature(_))),
    ("Viscous friction", "N m s/rad or N s/m", |kind| matches!(kind, Kind::Viscous(_))),
    ("Coulomb friction", "N m or N", |kind| matches!(kind, Kind::Coulomb(_) | Kind::Stribeck(_))),
    ("Offsets", "N m or N", |kind| matches!(kind, Kind::Offset(_))),
    ("Stiffness and gains", "N m/rad, N m/A or N/m, N/A", |kind| matches!(kind, Kind::Stiffness(_) | Kind::Gain(_))),
    ("First moments", "kg m", |kind| matches!(kind, Kind::Link(k) | Kind::Payload(k) if (1..4).contains(&(k % 10)))),
    ("Moments of inertia", "kg m²", |kind| matches!(kind, Kind::Link(k) | Kind::Payload(k) if k % 10 > 3)),
];
/// The last groups have many bars: they are folded.
const FOLDED: usize = 6;

pub fn section(found: &Identification<'_>) -> String {
    let unknowns = &found.setup.columns.unknowns;
    let optimum = &found.estimates.consistent;
    let slides = sliding(found.setup.columns.model);
    let mut text = String::from(
        "<section class=\"screen\"><h2>Parameters, before and after</h2>\n<p>Bars are the identified values, with two \
         standard deviations; rings are those of the robot's file. A pale bar comes for more than half from the file, \
         not from the data.</p>\n",
    );
    for (k, (title, unit, is_of)) in GROUPS.into_iter().enumerate() {
        let bars: Vec<Bar> = (unknowns.iter().enumerate())
            .filter(|(_, unknown)| is_of(unknown.kind))
            .map(|(k, unknown)| Bar {
                name: &unknown.name,
                before: unknown.prior,
                after: optimum.x[k],
                interval: 2.0 * optimum.deviations[k],
                share: optimum.prior_share[k],
            })
            .collect();
        if bars.is_empty() {
            continue;
        }
        let unit = match unit.split_once(" or ") {
            Some((turning, _)) if slides.iter().all(|slides| !slides) => turning,
            Some((_, sliding)) if slides.iter().all(|slides| *slides) => sliding,
            _ => unit,
        };
        let drawn = svg(&bars);
        text += &match k < FOLDED {
            true => format!("<h2>{title} [{unit}]</h2>\n<figure>{drawn}</figure>\n"),
            false => format!("<details><summary>{title} [{unit}]</summary>\n<figure>{drawn}</figure></details>\n"),
        };
    }
    text + "</section>\n"
}

fn svg(bars: &[Bar]) -> String {
    let finite = |x: f64| if x.is_finite() { x } else { 0.0 };
    // an interval that is wider than all values is cut
    let values = bars.iter().flat_map(|bar| [bar.before, bar.after]).map(finite);
    let (low, high) = values.fold((0.0_f64, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
    let size = if high > low { high - low } else { 1.0 };
    let (low, high) = (if low < 0.0 { low - 0.15 * size } else { low }, high + 0.15 * size);
    let x = |value: f64| LEFT + (value.clamp(low, high) - low) / (high - low) * (RIGHT - LEFT);
    let height = ROW * bars.len() as f64 + 6.0;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" height=\"{height}\" \
         font-size=\"12\" fill=\"none\">\n"
    );
    let _ = writeln!(out, "<path d=\"M{0:.1} 0V{height}\" stroke=\"var(--line)\"/>", x(0.0));
    for (k, bar) in bars.iter().enumerate() {
        let y = ROW * (k as f64 + 0.5);
        let (from, to) = (x(finite(bar.after).min(0.0)), x(finite(bar.after).max(0.0)));
        let opacity = if bar.share > 0.5 { 0.3 } else { 0.85 };
        let (a, b) = (x(finite(bar.after - bar.interval)), x(finite(bar.after + bar.interval)));
        let _ = write!(
            out,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"var(--text)\">{}</text>\n\
             <rect x=\"{from:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"11\" fill=\"var(--c0)\" fill-opacity=\"{opacity}\"/>\n\
             <path d=\"M{a:.1} {y:.1}H{b:.1}M{a:.1} {:.1}v8M{b:.1} {:.1}v8\" stroke=\"var(--text)\" stroke-width=\"1.2\"/>\n\
             <circle cx=\"{:.1}\" cy=\"{y:.1}\" r=\"4.5\" stroke=\"var(--c1)\" stroke-width=\"2\"/>\n\
             <text x=\"{:.1}\" y=\"{:.1}\" fill=\"var(--text)\">{} ± {}, was {}</text>\n",
            LEFT - 8.0,
            y + 4.0,
            escaped(bar.name),
            y - 5.5,
            to - from,
            y - 4.0,
            y - 4.0,
            x(finite(bar.before)),
            RIGHT + 10.0,
            y + 4.0,
            three(bar.after),
            three(bar.interval),
            three(bar.before),
        );
    }
    out + "</svg>"
}

fn three(x: f64) -> String {
    digits(x, 3).replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_stand_for_their_numbers() {
        let bar = |after, share| Bar { name: "a<b", before: 1.0, after, interval: 0.5, share };
        let text = svg(&[bar(2.0, 0.1), bar(-1.0, 0.9)]);
        // one unit is as wide in both: 2 + 1 and air make 3.9
        let width = (RIGHT - LEFT) / 3.9;
        assert!(text.contains(&format!("width=\"{:.1}\"", 2.0 * width)), "{text}");
        assert!(text.contains(&format!("width=\"{width:.1}\"")), "{text}");
        assert!(text.contains("a&lt;b") && text.contains("2.00 ± 0.500, was 1.00") && text.contains("−1.00"));
        assert_eq!(text.matches("fill-opacity=\"0.3\"").count(), 1, "what the file says is pale");
        assert_eq!([three(0.012345), three(123.4), three(0.0), three(1.26e-6)], ["0.0123", "123", "0", "1.26e−6"]);
    }
}
