//! Repairs of inertias that are impossible or do not fit the link's shape.

use super::inertial::{Inertial, MOMENTS, Numbers, of_point};
use super::{Proposal, Robot, twin};
use crate::urdf::vocabulary::shown;
use mozzi::linalg::Sym3;
use mozzi::{SO3, SpatialInertia};

/// A possible inertia is left alone within this many powers of ten of its shape's.
const DOUBTED: f64 = 1.3;
/// A repair of a possible inertia has to come as close.
const FITTING: f64 = 0.7;
/// A repair of an impossible inertia has to come as close.
const ALLOWED: f64 = 1.3;
/// The nearest possible inertia is a repair by itself if it changes no moment by more than this part of the largest.
const ROUNDED: f64 = 0.05;

/// Twins agree to this part of their numbers, which are written with six digits or more.
const EXACT: f64 = 1e-5;
/// Links that differ by less may be twins that are not quite alike.
const CLOSE: f64 = 1e-3;

struct Candidate {
    code: &'static str,
    reason: String,
    numbers: Numbers,
    /// Smaller is simpler.
    cost: f64,
}

/// The repair of a link's inertia, if it needs one and one is found.
pub(super) fn proposal(robot: &Robot<'_>, name: &str, inertial: &Inertial<'_>) -> Option<Proposal> {
    let old = inertial.inertia(&inertial.numbers);
    if old.mass <= 0.0 || inertial.numbers.moments == [0.0; 6] {
        return None; // a massless link, or a point mass
    }
    let (verdict, solid) = (old.verdict(), robot.solid(name).filter(|solid| solid.can_have(old.mass)));
    let misfit = solid.map_or(0.0, |solid| solid.misfit(old));
    let is_possible = verdict.is_physical();
    let twins: Vec<(String, &Inertial<'_>, SpatialInertia)> = twin::names(name)
        .into_iter()
        .filter_map(|name| {
            let other = robot.inertials.get(&name)?;
            let G = other.inertia(&other.numbers);
            (G.mass > 0.0 && G.verdict().is_physical()).then_some((name, other, G))
        })
        .collect();
    if is_possible && let Some(found) = of_twins(inertial, old, &twins) {
        return Some(made(robot, name, inertial, found, String::new()));
    }
    if is_possible && (misfit <= DOUBTED || is_placeholder(&inertial.numbers)) {
        return None;
    }
    let nearest = old.nearest_physical()?;
    let twin = twins.first();
    let is_fitting = |G: SpatialInertia| match solid {
        Some(solid) => solid.misfit(G) <= if is_possible { FITTING } else { ALLOWED },
        None => true,
    };
    let is_alike = |G: SpatialInertia| twin.is_some_and(|(.., twin)| alike(G, *twin));
    let mut best: Option<(f64, Candidate)> = None;
    let mut as_simple: Vec<(f64, String)> = Vec::new();
    let mut consider = |candidate: Candidate| {
        // products of inertia alone move no moment closer to the shape's
        let Numbers { mass, center, moments } = inertial.numbers;
        let new = &candidate.numbers;
        let keeps = |k: usize| new.moments[k] == moments[k];
        if is_possible && (new.mass, new.center) == (mass, center) && [0, 3, 5].into_iter().all(keeps) {
            return;
        }
        let G = inertial.inertia(&candidate.numbers);
        // the mass is right where the other side has it, or where a smaller one would be that of air
        let is_kept = twin.is_some_and(|(.., twin)| (mass - twin.mass).abs() <= 0.01 * twin.mass);
        let is_air = solid.is_some_and(|solid| !solid.may_weigh(new.mass));
        if new.mass != mass && (is_kept || is_air) {
            return;
        }
        if !G.verdict().is_physical() || !is_fitting(G) && !is_alike(G) {
            return;
        }
        let shape = solid.map_or_else(|| spread(&candidate.numbers), |solid| solid.distance(G));
        let score = shape + candidate.cost - if is_alike(G) { 100.0 } else { 0.0 };
        // without a shape or a twin nothing decides between powers of ten but their sizes
        if candidate.code == "power_of_ten" && solid.is_none() && !is_alike(G) {
            as_simple.push((candidate.cost, candidate.reason.clone()));
        }
        if best.as_ref().is_none_or(|(least, _)| score < *least) {
            best = Some((score, candidate));
        }
    };
    let is_negative = [0, 3, 5].iter().any(|&k| inertial.numbers.moments[k] < 0.0);
    let is_rounded = !is_possible && !is_negative && moved(old, nearest) <= ROUNDED;
    let mirrored = twin.and_then(|(name, other, _)| mirrored(inertial, name, other));
    let all = all(inertial, old).into_iter().chain(mirrored);
    // of numbers that are off by little, only those of the twin are better than the nearest possible ones
    let is_twin = |candidate: &Candidate| is_alike(inertial.inertia(&candidate.numbers)) && !is_alike(old);
    all.filter(|candidate| !is_rounded || is_twin(candidate)).for_each(&mut consider);
    let found = best.map(|(_, candidate)| candidate).or_else(|| {
        let reason = format!("{verdict}; this is the nearest inertia that a body can have");
        let numbers = inertial.numbers_of(nearest);
        (!is_possible).then_some(Candidate { code: "nearest_inertia", reason, numbers, cost: 0.0 })
    })?;
    let why = match (is_possible, solid) {
        (true, Some(solid)) => format!("; as written, {}", solid.doubt(old, inertial.R)),
        _ if found.code == "nearest_inertia" => String::new(),
        _ => format!("; as written, {verdict}"),
    };
    let others = as_simple.iter().filter(|(cost, reason)| *cost <= found.cost && *reason != found.reason);
    let others: Vec<&str> = others.map(|(_, reason)| reason.as_str()).collect();
    let or =
        if others.is_empty() { String::new() } else { format!(" (it may as well be that {})", others.join(", or ")) };
    Some(made(robot, name, inertial, found, or + &why))
}

/// The proposal of a candidate; `why` follows its reason.
fn made(robot: &Robot<'_>, name: &str, inertial: &Inertial<'_>, found: Candidate, why: String) -> Proposal {
    let mut numbers = found.numbers;
    keep_equal(&inertial.numbers, &mut numbers);
    let (editor, change) = inertial.write(&numbers);
    let mut proposal = robot.proposal(found.code, inertial.link, &editor);
    proposal.change = change;
    proposal.reason = format!("{}{why}", found.reason);
    let both = [inertial.numbers, numbers].map(|numbers| inertial.inertia(&numbers));
    proposal.inertia = Some((name.to_string(), both[0], both[1]));
    proposal
}

/// A repair that gives a possible inertia the numbers of twins, to which as written it is not even close. It is one
/// about the origin, which no twin's repair can be in reverse, or has more twins than the numbers as written.
fn of_twins(
    inertial: &Inertial<'_>,
    old: SpatialInertia,
    twins: &[(String, &Inertial<'_>, SpatialInertia)],
) -> Option<Candidate> {
    if twins.iter().any(|(.., twin)| within(old, *twin, CLOSE)) {
        return None;
    }
    let mut candidates = all(inertial, old).into_iter();
    candidates.find_map(|candidate| {
        let least = match candidate.code {
            "about_origin" => 1,
            "parallel_axis" => 2,
            _ => return None,
        };
        let G = inertial.inertia(&candidate.numbers);
        let same: Vec<&str> =
            twins.iter().filter(|(.., twin)| within(G, *twin, EXACT)).map(|(name, ..)| name.as_str()).collect();
        (same.len() >= least).then(|| {
            let list = same.iter().map(|name| format!("`{}`", shown(name))).collect::<Vec<_>>().join(", ");
            Candidate { reason: format!("{}: without that they are those of {list}", candidate.reason), ..candidate }
        })
    })
}

/// Everything that it may have been.
fn all(inertial: &Inertial<'_>, old: SpatialInertia) -> Vec<Candidate> {
    let numbers = inertial.numbers;
    let mut found = Vec::new();
    let mut add = |code, cost, reason: String, numbers: Numbers| found.push(Candidate { code, reason, numbers, cost });
    for (k, name) in MOMENTS.into_iter().enumerate().filter(|&(k, _)| numbers.moments[k] != 0.0) {
        for power in [-1, 1, -2, 2, -3, 3] {
            let mut moments = numbers.moments;
            moments[k] = shifted(moments[k], power);
            let reason = format!("{name} is off by a factor of 10^{}", -power);
            add("power_of_ten", 0.05 * f64::from(power.abs()), reason, Numbers { moments, ..numbers });
        }
    }
    for (k, name) in [(0, "ixx"), (3, "iyy"), (5, "izz")] {
        let mut moments = numbers.moments;
        moments[k] = moments[k].abs();
        if moments != numbers.moments {
            add("negative_moment", 0.0, format!("{name} lost its sign"), Numbers { moments, ..numbers });
        }
    }
    let turned = [0, 3, 5].map(|k| numbers.moments[k]);
    if turned.iter().filter(|moment| **moment < 0.0).count() > 1 {
        let mut moments = numbers.moments;
        [0, 3, 5].into_iter().for_each(|k| moments[k] = moments[k].abs());
        add("negative_moment", 0.05, "the moments have wrong signs".into(), Numbers { moments, ..numbers });
    }
    // numbers in the order of another program, written in that of URDF: where each belongs
    for (order, said) in [
        ([0, 3, 5, 1, 2, 4], "ixx iyy izz ixy ixz iyz"),
        ([0, 3, 5, 1, 4, 2], "ixx iyy izz ixy iyz ixz"),
        ([0, 3, 5, 4, 2, 1], "ixx iyy izz iyz ixz ixy"),
        ([0, 1, 3, 2, 4, 5], "ixx ixy iyy ixz iyz izz"),
    ] {
        let mut moments = [0.0; 6];
        order.into_iter().zip(numbers.moments).for_each(|(place, moment)| moments[place] = moment);
        if moments != numbers.moments {
            let reason = format!("its numbers are in the order {said}");
            add("mixed_columns", 0.1, reason, Numbers { moments, ..numbers });
        }
    }
    // I_c = I_o − m(‖c‖² E − c cᵀ)
    let c = old.center_of_mass();
    if c.norm() > 0.0 {
        let more = of_point(c).congruence(inertial.R.inverse().matrix()) * numbers.mass;
        let Sym3 { xx, xy, xz, yy, yz, zz } = more;
        let mut moments = numbers.moments;
        moments.iter_mut().zip([xx, xy, xz, yy, yz, zz]).for_each(|(moment, more)| *moment -= more);
        let reason = "the moments are about the origin of the link, expected those about the centre of mass".into();
        add("about_origin", 0.1, reason, Numbers { moments, ..numbers });
        // simpler than a power of ten of a single product
        for sign in [-2.0, 2.0] {
            let mut moments = numbers.moments;
            [(1, xy), (2, xz), (4, yz)].into_iter().for_each(|(k, more)| moments[k] += sign * more);
            let reason = "the products have the parallel-axis term with the wrong sign".into();
            add("parallel_axis", 0.04, reason, Numbers { moments, ..numbers });
        }
    }
    for (mass, moment, center, said) in [
        (0, -6, 0, "the moments are in kg mm²"),
        (0, -4, 0, "the moments are in kg cm²"),
        (0, -3, 0, "the moments are in g m²"),
        (0, -9, 0, "the moments are in g mm²"),
        (-3, 0, 0, "the mass is in g"),
        (-3, -3, 0, "the mass is in g, and the moments are in g m²"),
        (-3, -6, 0, "the mass is in g, and the moments are in kg mm²"),
        (-3, -9, 0, "the mass is in g, and the moments are in g mm²"),
        (0, 3, 0, "the moments are a thousandth of kg m²"),
        (0, 6, 0, "the moments are a millionth of kg m²"),
        (0, 0, -3, "the centre of mass is in mm"),
        (0, -6, -3, "the centre of mass and the moments are in mm"),
        (-3, -9, -3, "everything is in g and mm"),
        (-3, 0, -3, "the mass is in g, and the centre in mm"),
    ] {
        if center != 0 && numbers.center == [0.0; 3] {
            continue;
        }
        let numbers = Numbers {
            mass: shifted(numbers.mass, mass),
            center: numbers.center.map(|x| shifted(x, center)),
            moments: numbers.moments.map(|x| shifted(x, moment)),
        };
        let count = [mass, moment, center].into_iter().filter(|power| *power != 0).count();
        add("units", 0.1 * count as f64, said.to_string(), numbers);
    }
    found
}

/// The products of a twin that is the mirror image of this link: the same mass and moments, and the centre on the other
/// side of a plane of its axes.
fn mirrored(inertial: &Inertial<'_>, name: &str, twin: &Inertial<'_>) -> Option<Candidate> {
    let (own, other) = (&inertial.numbers, &twin.numbers);
    let near = |a: f64, b: f64| (a - b).abs() <= 0.01 * b.abs();
    let is_same = near(own.mass, other.mass) && [0, 3, 5].into_iter().all(|k| near(own.moments[k], other.moments[k]));
    let is_turned = [inertial, twin].iter().any(|one| one.R != SO3::identity());
    // the axis across the plane, and the products that change their sign
    let across = [("x", [1, 2]), ("y", [1, 4]), ("z", [2, 4])].into_iter().enumerate().find(|(axis, _)| {
        let side = |k: usize| if k == *axis { -1.0 } else { 1.0 };
        own.center[*axis] != 0.0 && (0..3).all(|k| near(own.center[k], side(k) * other.center[k]))
    });
    let (_, (axis, products)) = across.filter(|_| is_same && !is_turned)?;
    let mut numbers = *own;
    [1, 2, 4].into_iter().for_each(|k| numbers.moments[k] = other.moments[k]);
    products.into_iter().for_each(|k| numbers.moments[k] = 0.0 - numbers.moments[k]);
    let reason = format!("the products are not those of link `{}`, its mirror image across {axis} = 0", shown(name));
    Some(Candidate { code: "mirrored_products", reason, numbers, cost: 0.0 })
}

/// True if all three moments are the same number of one digit and the products are 0: a placeholder, which no change of
/// units or columns can repair.
fn is_placeholder(numbers: &Numbers) -> bool {
    let [xx, xy, xz, yy, yz, zz] = numbers.moments;
    let digits = format!("{xx:e}");
    xx == yy && yy == zz && [xy, xz, yz] == [0.0; 3] && digits.split('e').next().is_some_and(|digits| digits.len() == 1)
}

/// x times 10^power, with the digits of x.
fn shifted(x: f64, power: i32) -> f64 {
    let text = format!("{x:e}");
    let shifted = text
        .split_once('e')
        .and_then(|(digits, exponent)| format!("{digits}e{}", exponent.parse::<i32>().ok()? + power).parse().ok());
    shifted.unwrap_or(x)
}

/// True for possible mirror images: mass, principal moments and ‖c‖ agree within 1 %.
fn alike(a: SpatialInertia, b: SpatialInertia) -> bool {
    within(a, b, 0.01)
}

fn within(a: SpatialInertia, b: SpatialInertia, part: f64) -> bool {
    let (p, q) = (a.verdict().principal_moments, b.verdict().principal_moments);
    let near = |a: f64, b: f64| (a - b).abs() <= part * b.abs();
    let distance = (a.center_of_mass().norm() - b.center_of_mass().norm()).abs();
    near(a.mass, b.mass) && p.iter().zip(q).all(|(a, b)| near(*a, b)) && distance <= part * b.center_of_mass().norm()
}

/// The moments of a compact body are of about the same size.
fn spread(numbers: &Numbers) -> f64 {
    let diagonal = [0, 3, 5].map(|k| numbers.moments[k].abs());
    let (low, high) = diagonal.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), &x| (low.min(x), high.max(x)));
    (high / low.max(f64::MIN_POSITIVE)).log10().powi(2)
}

/// The largest change of a moment, as a part of the largest.
fn moved(old: SpatialInertia, new: SpatialInertia) -> f64 {
    let list = |G: SpatialInertia| G.about_center_of_mass().to_mat3().rows();
    let (a, b) = (list(old), list(new));
    let scale = a.as_flattened().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    a.as_flattened().iter().zip(b.as_flattened()).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs())) / scale
}

/// Restores the digits of numbers that changed only by rounding.
fn keep_equal(old: &Numbers, new: &mut Numbers) {
    let scale = new.moments.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for (new, old) in new.moments.iter_mut().zip(old.moments) {
        if (*new - old).abs() <= 1e-14 * scale {
            *new = old;
        }
    }
    for (new, old) in new.center.iter_mut().zip(old.center) {
        if (*new - old).abs() <= 1e-14 * old.abs() {
            *new = old;
        }
    }
    if (new.mass - old.mass).abs() <= 1e-14 * old.mass {
        new.mass = old.mass;
    }
}
