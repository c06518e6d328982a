//! Random inertias, placements and joints.

use crate::campaign::generate::one_in;
use mozzi::model::description::JointKind;
use mozzi::random::Random;
use mozzi::{SE3, SO3, ScrewAxis, SpatialInertia, Sym3, Twist, Vec3};
use std::f64::consts::FRAC_PI_2;

/// A physical inertia, of masses over ± these decades.
pub fn inertia(random: &mut Random, decades: f64, is_aligned: bool) -> SpatialInertia {
    let [a, b, c] = random.array().map(|x: f64| 0.02 + 0.2 * x * x);
    let turn = if is_aligned { SO3::identity() } else { pose(random, false).R };
    let center = if is_aligned { [0.0, 0.0, 0.3 * random.next()] } else { random.array::<3>().map(|x| 0.4 * x) };
    let scale = 10.0_f64.powf(decades * random.next());
    SpatialInertia::new(1.0, Vec3(center), Sym3::diagonal(b + c, a + c, a + b).congruence(turn.matrix())) * scale
}

/// A configuration; an aligned one is turned by right angles about one axis, and moved along one.
pub fn pose(random: &mut Random, is_aligned: bool) -> SE3 {
    if !is_aligned {
        return SE3::exp(Twist::from_array(random.array()));
    }
    let along = |k: usize, x: f64| Vec3(std::array::from_fn(|i| if i == k { x } else { 0.0 }));
    let w = along(random.below(3), FRAC_PI_2 * (random.below(4) as f64 - 1.0));
    let R = SE3::exp(Twist { w, v: Vec3::zero() }).R;
    SE3 { R, p: along(random.below(3), 0.5 * random.next()) }
}

/// How a joint moves: one of all kinds.
pub fn kind(random: &mut Random, is_aligned: bool) -> JointKind {
    let axis = match is_aligned {
        true => std::array::from_fn(|k| if k == random.0 as usize % 3 { 1.0 } else { 0.0 }),
        false => unit(random),
    };
    let point = if is_aligned { [0.0; 3] } else { random.array::<3>().map(|x| 0.5 * x) };
    let pitch = 0.3 * random.next();
    let screw = |axis: Result<ScrewAxis, _>| JointKind::Screw(axis.expect("a unit axis"));
    match random.below(16) {
        0 => JointKind::Fixed,
        1 => JointKind::Free,
        2 | 3 => JointKind::Ball(Vec3(point)),
        4..=6 => screw(ScrewAxis::prismatic(axis)),
        7 | 8 => screw(ScrewAxis::from_line(axis, point, pitch)),
        _ if one_in(3, random) => screw(ScrewAxis::from_line([0.0, 0.0, 1.0], [0.0; 3], 0.0)),
        _ => screw(ScrewAxis::from_line(axis, point, 0.0)),
    }
}

fn unit(random: &mut Random) -> [f64; 3] {
    let x = random.array::<3>();
    let length = x.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.1 { x.map(|x| x / length) } else { [0.6, 0.0, 0.8] }
}
