//! Why a number became another.

use std::f64::consts::PI;

/// Equal to the digits that a file has.
pub fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * a.abs().max(b.abs())
}

/// Numbers of five digits, after rounding.
const ROUNDED: f64 = 2e-5;

/// `new instead of old`, with as many digits as tell them apart.
pub fn instead(old: f64, new: f64) -> String {
    match (shown(old), shown(new)) {
        (old_text, new_text) if old_text == new_text => format!("{new:?} instead of {old:?}"),
        (old, new) => format!("{new} instead of {old}"),
    }
}

/// How a number's unit contains an angle.
#[derive(Clone, Copy, PartialEq)]
pub enum Angle {
    None,
    /// rad, rad/s …
    Of,
    /// N m/rad, N m s/rad.
    Per,
}

/// The reason of a difference between two numbers: a unit, a decimal point or a sign, in words that follow the number's
/// name.
pub fn reason(a: f64, b: f64, angle: Angle) -> Option<String> {
    if b == 0.0 {
        return Some("is dropped".to_string());
    }
    if a == 0.0 {
        return Some("appears".to_string());
    }
    let ratio = b / a;
    if (ratio - 1.0).abs() <= ROUNDED {
        return Some("is rounded".to_string());
    }
    if same(ratio, -1.0) {
        return Some("has the other sign".to_string());
    }
    let (to_degrees, to_radians) = (180.0 / PI, PI / 180.0);
    let words = match angle {
        Angle::None => None,
        Angle::Of => Some([(to_degrees, "is in degrees"), (to_radians, "is in radians, not degrees")]),
        Angle::Per => {
            Some([(to_radians, "is per degree, not per radian"), (to_degrees, "is converted as if it were per degree")])
        }
    };
    for (factor, what) in words.into_iter().flatten() {
        if (ratio / factor - 1.0).abs() < 1e-6 {
            return Some(what.to_string());
        }
    }
    ten(ratio).map(|power| format!("is off by a factor 1e{power}: a unit or a decimal point"))
}

/// The exponent of a power of ten other than 1.
pub fn ten(ratio: f64) -> Option<i32> {
    let power = ratio.abs().log10().round();
    let is_power = ratio > 0.0 && power != 0.0 && power.abs() <= 18.0 && (ratio / 10f64.powf(power) - 1.0).abs() < 1e-6;
    is_power.then_some(power as i32)
}

/// Metres in an inch.
pub const INCH: f64 = 0.0254;

/// The unit that multiplies lengths by this ratio, in words that follow a name.
pub fn length(ratio: f64) -> Option<String> {
    let is = |x: f64| (ratio / x - 1.0).abs() < 1e-5;
    match ten(ratio) {
        Some(3) => Some("in mm".to_string()),
        Some(power) => Some(format!("off by a factor 1e{power}, a unit")),
        None if is(1.0 / INCH) => Some("in inches".to_string()),
        None => is(INCH).then(|| "converted as if it were in inches".to_string()),
    }
}

/// At most six digits.
pub fn shown(x: f64) -> String {
    let rounded = format!("{x:.5e}").parse::<f64>().unwrap_or(x);
    let is_plain = rounded == 0.0 || (1e-4..1e6).contains(&rounded.abs());
    if is_plain { rounded.to_string() } else { format!("{rounded:e}") }
}

/// Three digits.
pub fn digits(x: f64) -> String {
    format!("{x:.2e}").parse::<f64>().map_or_else(|_| x.to_string(), shown)
}

/// The number of decimals, two or more, to which all numbers of the second list are rounded.
pub fn decimals(x: &[f64], y: &[f64]) -> Option<i32> {
    (2..=6).find(|&count| {
        let unit = 10f64.powi(-count);
        let is_whole = |y: f64| (y - (y / unit).round() * unit).abs() < 1e-9 * unit;
        x != y && x.iter().zip(y).all(|(x, y)| (x - y).abs() <= 0.5001 * unit && is_whole(*y))
    })
}
