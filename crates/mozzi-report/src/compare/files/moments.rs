//! Why a link's moments became others, of the same mass and centre.

use super::inertia::{Body, DIGITS, POUND, alike, entries, scaled, size, steiner, sum, turned};
use super::number::{INCH, shown, ten};
use super::rotation::misread;
use mozzi::{SO3, SpatialInertia, Sym3};

const NAMES: [&str; 6] = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"];

/// Mass and centre agree.
pub fn reason([one, other]: [&str; 2], of: &str, a: Body, b: Body, axes: [Option<SO3>; 2]) -> Option<String> {
    let (x, y) = (entries(a.I), entries(b.I));
    let most = size(a.I).max(size(b.I));
    let differing: Vec<usize> = (0..6).filter(|&k| differs(a.I, b.I, k)).collect();
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
    for (reversed, R, from, to) in [(0, axes[0], a.I, b.I), (1, axes[1], b.I, a.I)] {
        let Some(R) = R.filter(|_| !alike(from, to)) else { continue };
        let raw = turned(from, R.inverse());
        let [right, wrong] = if reversed == 1 { [other, one] } else { [one, other] };
        if alike(turned(raw, R.inverse()), to) {
            return Some(format!("{wrong}'s {of} is rotated by the inverse (conjugate) of {right}'s rotation"));
        }
        if alike(raw, to) {
            return Some(format!("{wrong}'s {of} is not rotated by its inertial's orientation, as {right}'s is"));
        }
        if let Some((_, words)) = misread(R).into_iter().skip(2).find(|(turn, _)| alike(turned(raw, *turn), to)) {
            return Some(format!("{other}'s {of} has its inertial's {}", words[reversed]));
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
    for (unit, words) in [(POUND, "in lb m²"), (POUND * INCH * INCH, "in lb in²"), (INCH * INCH, "in kg in²")] {
        let is_scaled = |ratio: f64| alike(scaled(a.I, ratio), b.I);
        if is_scaled(1.0 / unit) {
            return Some(format!("{other}'s {of} is {words}"));
        }
        if is_scaled(unit) {
            return Some(format!("{other}'s {of} is converted as if it were {words}"));
        }
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
        list.sort_unstable_by(f64::total_cmp);
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
    (!why.is_empty()).then(|| format!("{other}'s {of} has {}{why}", differing_moments(a.I, b.I)))
}

/// "other moments (ixx 2 instead of 1)".
pub fn differing_moments(a: Sym3, b: Sym3) -> String {
    let (x, y) = (entries(a), entries(b));
    let ratio = size(b) / size(a);
    if alike(scaled(a, ratio), b) {
        return format!("moments of {} times the size", shown(ratio));
    }
    let differing = (0..6).filter(|&k| differs(a, b, k));
    let list = differing.map(|k| format!("{} {} instead of {}", NAMES[k], shown(y[k]), shown(x[k])));
    format!("other moments ({})", list.collect::<Vec<_>>().join(", "))
}

fn differs(a: Sym3, b: Sym3, k: usize) -> bool {
    let (x, y) = (entries(a)[k], entries(b)[k]);
    (x - y).abs() > (DIGITS * x.abs().max(y.abs())).max(1e-10 * size(a).max(size(b)))
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
