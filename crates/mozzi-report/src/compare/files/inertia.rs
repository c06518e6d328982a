//! Why a link's inertia became another: errors of converters, tried on the first file's numbers.

use super::moments;
use super::number::{decimals, length, shown, ten};
use mozzi::{SO3, SpatialInertia, Sym3, Vec3};

/// A link's numbers in its own frame.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    pub m: f64,
    pub c: Vec3,
    /// About the centre of mass.
    pub I: Sym3,
}

/// kg in a pound.
pub const POUND: f64 = 0.45359237;

/// Half a unit of the sixth digit, which converters keep.
pub const DIGITS: f64 = 5.1e-6;

impl Body {
    pub fn of(G: SpatialInertia) -> Self {
        Body { m: G.mass, c: G.center_of_mass(), I: G.about_center_of_mass() }
    }
}

pub fn entries(I: Sym3) -> [f64; 6] {
    [I.xx, I.yy, I.zz, I.xy, I.xz, I.yz]
}

pub fn size(I: Sym3) -> f64 {
    entries(I).iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

pub fn alike(a: Sym3, b: Sym3) -> bool {
    let most = size(a).max(size(b));
    entries(a).iter().zip(entries(b)).all(|(x, y)| (x - y).abs() <= DIGITS * most)
}

pub fn near(a: Vec3, b: Vec3) -> bool {
    (a - b).norm() <= DIGITS * a.norm().max(b.norm())
}

/// m (|c|² 1 − c cᵀ)
pub fn steiner(m: f64, c: Vec3) -> Sym3 {
    let square = m * c.dot(c);
    let product = Sym3::outer(c, m);
    let [xx, yy, zz, xy, xz, yz] = entries(product);
    Sym3 { xx: square - xx, yy: square - yy, zz: square - zz, xy: -xy, xz: -xz, yz: -yz }
}

pub fn sum(a: Sym3, b: Sym3, k: f64) -> Sym3 {
    let [x, y] = [entries(a), entries(b)];
    let [xx, yy, zz, xy, xz, yz] = core::array::from_fn(|i| x[i] + k * y[i]);
    Sym3 { xx, xy, xz, yy, yz, zz }
}

pub fn turned(I: Sym3, R: SO3) -> Sym3 {
    I.congruence(R.matrix())
}

/// The difference in words, and whether it has a reason; `axes` are those in which each file gives the inertia,
/// `solids` the link's shapes of 1 kg/m³.
pub fn difference(
    names: [&str; 2],
    link: &str,
    [a, b]: [Body; 2],
    axes: [Option<SO3>; 2],
    solids: &[SpatialInertia],
) -> (String, bool) {
    let found = forward(names, link, [a, b], axes, solids);
    // the first file may be the wrong one
    let found = found.or_else(|| forward([names[1], names[0]], link, [b, a], [axes[1], axes[0]], solids));
    found.map_or_else(|| separate(names, link, [a, b], axes), |why| (why, true))
}

/// Mass, centre and moments, each by itself.
fn separate(names: [&str; 2], link: &str, [a, b]: [Body; 2], axes: [Option<SO3>; 2]) -> (String, bool) {
    let other = names[1];
    let number = |what: String| format!("{other} has {what}");
    let mut parts = Vec::new();
    if !same_mass(a.m, b.m) {
        parts.push(number(another_mass(link, a, b)));
    }
    if !near(a.c, b.c) {
        parts.push(number(another_center(link, a, b)));
    }
    let moments = Body { I: b.I, ..a };
    let of = format!("inertia of `{link}`");
    let why = (!alike(a.I, b.I)).then(|| moments_in_axes(names, &of, [a, moments], axes));
    let has_reason = !matches!(why, Some(None));
    parts.extend(why.map(|why| why.unwrap_or_else(|| number(moments::differing_moments(a.I, b.I) + " of the " + &of))));
    let unknown = if has_reason { "" } else { ": no known reason" };
    (format!("{}{unknown}", parts.join("; ")), has_reason)
}

/// In the axes of the file, if both give the inertia in the same.
fn moments_in_axes(names: [&str; 2], of: &str, [a, b]: [Body; 2], axes: [Option<SO3>; 2]) -> Option<String> {
    match axes {
        [Some(R), Some(other)] if (R.inverse() * other).log().norm() < 1e-6 => {
            let raw = |body: Body| Body { I: turned(body.I, R.inverse()), c: R.inverse() * body.c, ..body };
            moments::reason(names, of, raw(a), raw(b), [None; 2])
        }
        _ => moments::reason(names, of, a, b, axes),
    }
}

fn another_center(link: &str, a: Body, b: Body) -> String {
    let mirrored = (0..3).filter(|&k| b.c.0[k] != 0.0 && same_mass(-a.c.0[k], b.c.0[k])).map(|k| ["x", "y", "z"][k]);
    let mirrored = mirrored.collect::<Vec<_>>().join(", ");
    let rest = (0..3).all(|k| same_mass(a.c.0[k].abs(), b.c.0[k].abs()));
    let (x, y) = (a.c.norm(), b.c.norm());
    let unit = if x > 0.0 && near(a.c * (1.0 / x), b.c * (1.0 / y)) { length(y / x) } else { None };
    let why = match unit {
        Some(unit) => format!(", {unit}"),
        None if rest && !mirrored.is_empty() => format!(", with the other sign of {mirrored}"),
        None => String::new(),
    };
    format!("another centre of mass of `{link}`: {} instead of {}{why}", vector(b.c), vector(a.c))
}

fn another_mass(link: &str, a: Body, b: Body) -> String {
    let unit = match b.m / a.m {
        ratio if (ratio * POUND - 1.0).abs() < DIGITS => " (pounds)",
        ratio if (ratio / POUND - 1.0).abs() < DIGITS => " (as if it were in pounds)",
        ratio if ten(ratio) == Some(3) => " (g)",
        _ => "",
    };
    format!("another mass of `{link}`: {} kg instead of {} kg{unit}", shown(b.m), shown(a.m))
}

fn forward(
    names: [&str; 2],
    link: &str,
    [a, b]: [Body; 2],
    axes: [Option<SO3>; 2],
    solids: &[SpatialInertia],
) -> Option<String> {
    let [one, other] = names;
    let of = format!("inertia of `{link}`");
    if b.m == 0.0 && size(b.I) == 0.0 {
        return Some(format!("{other} has no inertia of `{link}`, of {} kg", shown(a.m)));
    }
    if let Some(why) = solids.iter().find_map(|solid| of_shapes(names, link, a, b, *solid)) {
        return Some(why);
    }
    if let Some(why) = rounded(other, &of, a, b) {
        return Some(why);
    }
    let (mass, center) = (same_mass(a.m, b.m), near(a.c, b.c));
    if mass && center {
        return moments_in_axes(names, &of, [a, b], axes);
    }
    // units: each of mass, lengths and moments by a power of ten
    let power = |x: f64, y: f64| if same_mass(x, y) { Some(0) } else { ten(y / x) };
    let lengths = match (a.c.norm(), b.c.norm()) {
        (x, y) if x < 1e-12 && y < 1e-12 => Some(0),
        (x, y) if x > 0.0 && y > 0.0 && near(a.c * (1.0 / x), b.c * (1.0 / y)) => power(x, y),
        _ => None,
    };
    let moments = power(size(a.I), size(b.I)).filter(|k| alike(scaled(a.I, 10f64.powi(*k)), b.I));
    if let (Some(m), Some(l), Some(k)) = (power(a.m, b.m), lengths, moments) {
        let part = |name: &str, unit: &str, k: i32| {
            (k != 0).then(|| format!("{name} by 1e{k}{}", if k == 3 || k == 6 { unit } else { "" }))
        };
        let parts =
            [part("mass", " (g)", m), part("centre of mass", " (mm)", l), part("moments", " (g m² or kg mm²)", k)];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        return Some(format!("{other} has the {of} in other units: {}", parts.join(", ")));
    }
    if mass && alike(a.I, b.I) {
        return Some(format!("{other} has {}", another_center(link, a, b)));
    }
    if center && alike(scaled(a.I, b.m / a.m), b.I) {
        let (m, n, ratio) = (shown(a.m), shown(b.m), shown(b.m / a.m));
        return Some(format!(
            "{other} has `{link}` of another density: {n} kg instead of {m} kg, mass and moments by {ratio}"
        ));
    }
    if center && alike(a.I, b.I) {
        return Some(format!("{other} has {}, with {one}'s moments", another_mass(link, a, b)));
    }
    if alike(a.I, b.I) {
        return Some(format!(
            "{other} has {} and {}, with {one}'s moments",
            another_mass(link, a, b),
            another_center(link, a, b)
        ));
    }
    None
}

/// By how much of the largest number two bodies differ, if it is a part of 10⁴ or less: such numbers were rounded,
/// whatever else would explain their last digits.
pub fn rounding(a: Body, b: Body) -> Option<f64> {
    const DIGITS_LEFT: f64 = 1e-4;
    let most = size(a.I).max(size(b.I));
    let reach = a.c.norm().max(b.c.norm());
    let moments = entries(a.I).iter().zip(entries(b.I)).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    let worst = [
        (a.m - b.m).abs() / a.m.abs().max(b.m.abs()),
        if reach > 0.0 { (a.c - b.c).norm() / reach } else { 0.0 },
        if most > 0.0 { moments / most } else { 0.0 },
    ];
    let worst = worst.into_iter().fold(0.0, f64::max);
    (worst > 0.0 && worst <= DIGITS_LEFT).then_some(worst)
}

fn rounded(other: &str, of: &str, a: Body, b: Body) -> Option<String> {
    let list = |body: Body| [&[body.m], body.c.0.as_slice(), &entries(body.I)].concat();
    if let Some(count) = decimals(&list(a), &list(b)) {
        return Some(format!("{other} has the {of} rounded to {count} decimals"));
    }
    let worst = rounding(a, b)?;
    Some(format!("{other} has the {of} rounded: its numbers differ by up to {worst:.0e} of the largest"))
}

fn same_mass(a: f64, b: f64) -> bool {
    (a - b).abs() <= DIGITS * a.abs().max(b.abs())
}

pub fn scaled(I: Sym3, k: f64) -> Sym3 {
    I.map(|x| x * k)
}

pub fn vector(v: Vec3) -> String {
    let least = 1e-12 * v.norm(); // rounding
    format!("({})", v.0.map(|x| if x.abs() <= least { 0.0 } else { x }).map(shown).join(", "))
}

/// One side has the shapes' mass at some density, instead of or in addition to the given one.
fn of_shapes([_, other]: [&str; 2], link: &str, a: Body, b: Body, solid: SpatialInertia) -> Option<String> {
    let unit = Body::of(solid);
    let is_solid = |body: Body| {
        let density = body.m / unit.m;
        (density > 0.0 && near(body.c, unit.c) && alike(body.I, scaled(unit.I, density))).then_some(density)
    };
    if let (Some(density), None) = (is_solid(b), is_solid(a)) {
        let (m, n, density) = (shown(a.m), shown(b.m), shown(density));
        return Some(format!(
            "{other} computes the inertia of `{link}` from its shapes, of {density} kg/m³: {n} kg instead of the given {m} kg"
        ));
    }
    let whole = |body: Body| SpatialInertia::new(body.m, body.c, body.I);
    let minus = |G: SpatialInertia| SpatialInertia { mass: -G.mass, mc: -G.mc, I: G.I.map(|x| -x) };
    if b.m > a.m {
        let density = is_solid(Body::of(whole(b) + minus(whole(a))))?;
        let (m, n, density) = (shown(a.m), shown(b.m), shown(density));
        return Some(format!(
            "{other} adds the mass of the shapes of `{link}`, of {density} kg/m³, to the given one: {n} kg instead of {m} kg"
        ));
    }
    None
}
