//! Compares the logged velocity of a floating base, a free joint or a ball with its differentiated pose: other axes,
//! another order, another unit, signs.

use crate::Finding;
use mozzi::model::Place;
use mozzi::{SO3, Vec3};

/// The velocity is doubtful above this difference, relative to its size.
const DOUBTFUL: f64 = 0.2;
/// A mistake is named if without it the difference is below this, and below this part of what it was.
const EXPLAINED: f64 = 0.3;

/// ω and v, or ω alone, of each sample.
type Velocities = Vec<Vec<Vec3>>;

/// Another reading of the columns than ω and v in the axes of the body: its name, and what they hold, from R, ω and v.
type Reading = (&'static str, fn(SO3, [Vec3; 2]) -> [Vec3; 2]);

const READINGS: [Reading; 7] = [
    ("its v is along the axes in which the pose is given", |R, [w, v]| [w, R * v]),
    ("all of it is along the axes in which the pose is given", |R, [w, v]| [R * w, R * v]),
    ("it is (v, ω)", |_, [w, v]| [v, w]),
    ("it is (v, ω), its v along the axes in which the pose is given, as MuJoCo has it", |R, [w, v]| [R * v, w]),
    ("it is (v, ω), all of it along the axes in which the pose is given", |R, [w, v]| [R * v, R * w]),
    ("its ω is in deg/s", |_, [w, v]| [w * 1_f64.to_degrees(), v]),
    ("it has the opposite sign", |_, [w, v]| [-w, -v]),
];

/// A finding if the velocity of a place is not the derivative of its pose, from all positions, their derivatives and
/// the logged velocities, by columns. Parts slower than `slow` are not compared.
pub fn check(
    log: &str,
    name: &str,
    place: &Place,
    [theta, slopes, logged]: [&[Vec<f64>]; 3],
    slow: f64,
) -> Option<Finding> {
    let vectors = |x: &[Vec<f64>]| -> Velocities {
        let count = x[place.j].len();
        let part = |first: usize| (0..count).map(|k| Vec3([0, 1, 2].map(|i| x[first + i][k]))).collect();
        place.velocities().step_by(3).map(part).collect()
    };
    let (pose, logged) = (vectors(slopes), vectors(logged));
    let square = |x: &[Vec3]| x.iter().map(|x| x.dot(*x)).sum::<f64>();
    let moves = |part: &[Vec3]| square(part).sqrt() > slow;
    if !pose.iter().any(|part| moves(part)) {
        return None;
    }
    // the difference of the worse one of the parts that are expected to move
    let apart = |expected: &Velocities| {
        let of = |k: usize| {
            let rest: Vec<Vec3> = logged[k].iter().zip(&expected[k]).map(|(a, b)| *a - *b).collect();
            (square(&rest) / square(&expected[k]).max(f64::MIN_POSITIVE)).sqrt()
        };
        (0..pose.len()).filter(|&k| moves(&expected[k])).map(of).reduce(f64::max).unwrap_or(f64::INFINITY)
    };
    let as_read = apart(&pose);
    if as_read < DOUBTFUL {
        return None;
    }
    let turn = |k: usize| {
        let q = [0, 1, 2, 3].map(|i| theta[place.q + i][k]);
        SO3::from_quaternion(q[0], Vec3([q[1], q[2], q[3]]))
    };
    let under = |reading: &Reading| {
        let mut expected = pose.clone();
        for k in 0..pose[0].len() {
            let found = (reading.1)(turn(k), [pose[0][k], pose.get(1).map_or(Vec3::zero(), |v| v[k])]);
            expected.iter_mut().zip(found).for_each(|(part, x)| part[k] = x);
        }
        (reading.0.to_string(), apart(&expected))
    };
    let opposite = |entry: usize| {
        let mut expected = pose.clone();
        expected[entry / 3].iter_mut().for_each(|x| x.0[entry % 3] *= -1.0);
        let entry = ["ω_x", "ω_y", "ω_z", "v_x", "v_y", "v_z"][entry];
        (format!("its {entry} has the opposite sign"), apart(&expected))
    };
    let all = READINGS.iter().map(under).chain((0..3 * pose.len()).map(opposite));
    let best = all.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|best| best.1 < EXPLAINED && best.1 < EXPLAINED * as_read);
    let body = name.rsplit_once('.').map_or(name, |(body, _)| body);
    let text = |what: &str| {
        let differs = format!(
            "{log}: the velocity of {body} differs by {:.0} % from the derivative of its pose",
            100.0 * as_read
        );
        let expected = if pose.len() == 1 { "ω" } else { "(ω, v)" };
        format!(
            "{differs}: {what}; expected {expected} in the axes of the body, rad/s and m/s. Without its columns the pose \
             is differentiated"
        )
    };
    Some(match best {
        Some((reading, _)) => Finding::fault("velocity", text(&reading)),
        None => {
            let what = "noise, a delay, other axes, another order of the quaternion, or another motion";
            Finding::warning("velocity", text(what))
        }
    })
}
