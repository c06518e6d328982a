//! Why a link's inertia became another: errors of converters, tried on the first file's numbers.

use super::number::{shown, ten};
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
const POUND: f64 = 0.45359237;

const NAMES: [&str; 6] = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"];
/// Half a unit of the sixth digit, which converters keep.
const DIGITS: f64 = 5.1e-6;

impl Body {
    pub fn of(G: SpatialInertia) -> Self {
        Body { m: G.mass, c: G.center_of_mass(), I: G.about_center_of_mass() }
    }
}

pub fn entries(I: Sym3) -> [f64; 6] {
    [I.xx, I.yy, I.zz, I.xy, I.xz, I.yz]
}

fn size(I: Sym3) -> f64 {
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

fn turned(I: Sym3, R: SO3) -> Sym3 {
    I.congruence(R.matrix())
}

/// The reason in words; `axes` are those in which each file gives the inertia, `solid` the link's shapes of 1 kg/m³.
pub fn reason(
    names: [&str; 2],
    link: &str,
    [a, b]: [Body; 2],
    axes: [Option<SO3>; 2],
    solid: Option<SpatialInertia>,
) -> Option<String> {
    let found = forward(names, link, [a, b], axes, solid);
    // the first file may be the wrong one
    found.or_else(|| forward([names[1], names[0]], link, [b, a], [axes[1], axes[0]], solid))
}

fn forward(
    names: [&str; 2],
    link: &str,
    [a, b]: [Body; 2],
    axes: [Option<SO3>; 2],
    solid: Option<SpatialInertia>,
) -> Option<String> {
    let [one, other] = names;
    let of = format!("inertia of `{link}`");
    if b.m == 0.0 && size(b.I) == 0.0 {
        return Some(format!("{other} has no inertia of `{link}`, of {} kg", shown(a.m)));
    }
    if let Some(why) = of_shapes(names, link, a, b, solid) {
        return Some(why);
    }
    if let Some(why) = rounded(other, &of, a, b) {
        return Some(why);
    }
    let (mass, center) = (same_mass(a.m, b.m), near(a.c, b.c));
    if mass && center {
        // in the axes of the file, if both give the inertia in the same
        return match axes {
            [Some(R), Some(other)] if (R.inverse() * other).log().norm() < 1e-6 => {
                let raw = |body: Body| Body { I: turned(body.I, R.inverse()), c: R.inverse() * body.c, ..body };
                of_moments(names, &of, raw(a), raw(b), [None; 2])
            }
            _ => of_moments(names, &of, a, b, axes),
        };
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
    let another_center = || {
        let mirrored =
            (0..3).filter(|&k| b.c.0[k] != 0.0 && same_mass(-a.c.0[k], b.c.0[k])).map(|k| ["x", "y", "z"][k]);
        let mirrored = mirrored.collect::<Vec<_>>().join(", ");
        let rest = (0..3).all(|k| same_mass(a.c.0[k].abs(), b.c.0[k].abs()));
        let why =
            if rest && !mirrored.is_empty() { format!(", with the other sign of {mirrored}") } else { String::new() };
        format!("another centre of mass of `{link}`: {} instead of {}{why}", vector(b.c), vector(a.c))
    };
    let another_mass = || {
        let unit = match b.m / a.m {
            ratio if (ratio * POUND - 1.0).abs() < DIGITS => " (pounds)",
            ratio if (ratio / POUND - 1.0).abs() < DIGITS => " (as if it were in pounds)",
            _ => "",
        };
        format!("another mass of `{link}`: {} kg instead of {} kg{unit}", shown(b.m), shown(a.m))
    };
    if mass && alike(a.I, b.I) {
        return Some(format!("{other} has {}", another_center()));
    }
    if center && alike(scaled(a.I, b.m / a.m), b.I) {
        let (m, n, ratio) = (shown(a.m), shown(b.m), shown(b.m / a.m));
        return Some(format!(
            "{other} has `{link}` of another density: {n} kg instead of {m} kg, mass and moments by {ratio}"
        ));
    }
    if center && alike(a.I, b.I) {
        return Some(format!("{other} has {}, with {one}'s moments", another_mass()));
    }
    if alike(a.I, b.I) {
        return Some(format!("{other} has {} and {}, with {one}'s moments", another_mass(), another_center()));
    }
    None
}

/// Numbers that agree to a part of 10⁴ were rounded, whatever else would explain their last digits.
fn rounded(other: &str, of: &str, a: Body, b: Body) -> Option<String> {
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
    (worst > 0.0 && worst <= DIGITS_LEFT)
        .then(|| format!("{other} has the {of} rounded: its numbers differ by up to {worst:.0e} of the largest"))
}

fn same_mass(a: f64, b: f64) -> bool {
    (a - b).abs() <= DIGITS * a.abs().max(b.abs())
}

fn scaled(I: Sym3, k: f64) -> Sym3 {
    I.map(|x| x * k)
}

pub fn vector(v: Vec3) -> String {
    format!("({})", v.0.map(shown).join(", "))
}

/// One side has the shapes' mass at some density, instead of or in addition to the given one.
fn of_shapes([_, other]: [&str; 2], link: &str, a: Body, b: Body, solid: Option<SpatialInertia>) -> Option<String> {
    let unit = Body::of(solid?);
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

/// Mass and centre agree.
fn of_moments([one, other]: [&str; 2], of: &str, a: Body, b: Body, axes: [Option<SO3>; 2]) -> Option<String> {
    let (x, y) = (entries(a.I), entries(b.I));
    let most = size(a.I).max(size(b.I));
    let differs = |k: &usize| (x[*k] - y[*k]).abs() > (DIGITS * x[*k].abs().max(y[*k].abs())).max(1e-10 * most);
    let differing: Vec<usize> = (0..6).filter(differs).collect();
    let unphysical = || {
        let verdict = |body: Body| SpatialInertia::new(body.m, body.c, body.I).verdict().principal_moments;
        let fits = |[p, q, r]: [f64; 3]| p >= 0.0 && p + q >= r * (1.0 - 1e-9);
        match (fits(verdict(a)), fits(verdict(b))) {
            (true, false) if size(b.I) == 0.0 => "",
            (true, false) if verdict(b)[0] < 0.0 => ": a principal moment is negative, which no body can have",
            (true, false) => ": no body can have it, since the largest principal moment exceeds the sum of the others",
            _ => "",
        }
    };
    for (R, from, to, names) in [(axes[0], a.I, b.I, [one, other]), (axes[1], b.I, a.I, [other, one])] {
        let Some(R) = R else { continue };
        let raw = turned(from, R.inverse());
        if alike(raw, to) && !alike(from, to) {
            return Some(format!(
                "{}'s {of} is not rotated by its inertial's orientation, as {}'s is",
                names[1], names[0]
            ));
        }
        if alike(turned(raw, R.inverse()), to) && !alike(from, to) {
            return Some(format!(
                "{}'s {of} is rotated by the inverse (conjugate) of {}'s rotation",
                names[1], names[0]
            ));
        }
    }
    let is_dropped = |k: usize| y[k] == 0.0 && x[k] != 0.0;
    if !differing.is_empty() && differing.iter().all(|&k| k > 2 && is_dropped(k)) {
        let list = differing.iter().map(|&k| NAMES[k]).collect::<Vec<_>>().join(", ");
        return Some(format!("{other} drops {list} of the {of}"));
    }
    // the axes of one file are only those of the eigenvectors
    if conjugate(a.I, b.I) {
        return Some(format!("{other}'s {of} has its principal axes by the conjugate quaternion"));
    }
    if let &[k] = differing.as_slice() {
        let name = NAMES[k];
        let (p, q) = (shown(x[k]), shown(y[k]));
        if let Some(power) = ten(y[k] / x[k]) {
            let body = unphysical();
            return Some(format!(
                "{other}'s {name} of the {of} is off by a factor 1e{power}, a decimal point: {q} instead of {p}{body}"
            ));
        }
        if (y[k] + x[k]).abs() <= DIGITS * most {
            return Some(format!(
                "{other}'s {name} of the {of} has the other sign: {q} instead of {p}{}",
                unphysical()
            ));
        }
    }
    let power = ten(size(b.I) / size(a.I));
    if let Some(power) = power.filter(|k| alike(scaled(a.I, 10f64.powi(*k)), b.I)) {
        return Some(format!("{other}'s {of} is off by a factor 1e{power}, a unit"));
    }
    if alike(scaled(a.I, -1.0), b.I) {
        return Some(format!("{other}'s {of} has the other sign{}", unphysical()));
    }
    let minus = |I: Sym3| Sym3 { xy: -I.xy, xz: -I.xz, yz: -I.yz, ..I };
    if alike(minus(a.I), b.I) {
        return Some(format!("{other}'s products of the {of} have the other sign"));
    }
    if alike(sum(a.I, steiner(a.m, a.c), 1.0), b.I) {
        return Some(format!("{other}'s {of} is about the link's origin, not the centre of mass"));
    }
    if alike(sum(a.I, steiner(a.m, a.c), -1.0), b.I) {
        return Some(format!("{one}'s {of} is about the link's origin, not the centre of mass, as {other}'s"));
    }
    let sorted = |mut list: [f64; 6]| {
        list.sort_by(f64::total_cmp);
        list
    };
    if sorted(x).iter().zip(sorted(y)).all(|(p, q)| (p - q).abs() <= DIGITS * most) {
        let moved = differing.iter().map(|&k| NAMES[k]).collect::<Vec<_>>().join(", ");
        return Some(format!("{other}'s columns of the {of} are mixed: {moved} are in other places{}", unphysical()));
    }
    let principal = |body: Body| SpatialInertia::new(body.m, body.c, body.I).verdict().principal_moments;
    if principal(a).iter().zip(principal(b)).all(|(p, q)| (p - q).abs() <= 10.0 * DIGITS * most) {
        return Some(format!("{other}'s {of} has the same principal moments about other axes"));
    }
    let why = unphysical();
    (!why.is_empty()).then(|| {
        let list = differing.iter().map(|&k| format!("{} {} instead of {}", NAMES[k], shown(y[k]), shown(x[k])));
        format!("{other}'s {of} has other moments ({}){why}", list.collect::<Vec<_>>().join(", "))
    })
}

/// True if I_b = Rᵀ D R and I_a = R D Rᵀ for one of the orders and signs of the eigenvectors.
fn conjugate(a: Sym3, b: Sym3) -> bool {
    let rows = a.to_mat3().rows();
    let matrix = nalgebra::Matrix3::from_fn(|i, j| rows[i][j]);
    let eigen = matrix.symmetric_eigen();
    if alike(a, b) {
        return false;
    }
    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    ORDERS.iter().any(|order| {
        (0..4).any(|signs| {
            let sign = |k: usize| if signs >> k & 1 == 1 { -1.0 } else { 1.0 };
            let mut R = nalgebra::Matrix3::from_fn(|i, j| sign(j) * eigen.eigenvectors[(i, order[j])]);
            if R.determinant() < 0.0 {
                R.column_mut(2).neg_mut();
            }
            let D = nalgebra::Matrix3::from_diagonal(&nalgebra::Vector3::from_fn(|k, _| eigen.eigenvalues[order[k]]));
            let I = R.transpose() * D * R;
            alike(Sym3 { xx: I[(0, 0)], xy: I[(0, 1)], xz: I[(0, 2)], yy: I[(1, 1)], yz: I[(1, 2)], zz: I[(2, 2)] }, b)
        })
    })
}
