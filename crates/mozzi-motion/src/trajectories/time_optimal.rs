//! The time-optimal profile of a path under limits of velocity, acceleration and torque, by reachability (Pham and Pham
//! 2018).
//!
//! With u = s̈, constant between grid points, and x = ṡ², x[i+1] = x[i] + 2Δu and every limit is linear:
//!
//! > |θ′u + θ″x| ≤ θ̈_max,  |a u + b x + c| ≤ τ_max,  x ≤ (θ̇_max/θ′)²
//!
//! The backward pass gives each point the largest x from which the next point's x can be kept; the forward pass takes
//! the largest u in each step. Limits hold at both ends of each interval.

use super::demands::{Demand, demands, demands_of_a_motion};
use super::limits::{CORRECTIONS, Limits, exceeded};
use super::linear_program::{HalfPlane, maximize};
use super::path::Path;
use super::profile::Profile;
use crate::Error;
use crate::error::{check, check_driven, check_open};
use mozzi::Model;

/// The bound of ṡ² and |s̈| if no limit applies, for a path between 0 and 1.
const UNBOUNDED: f64 = 1e12;
/// Linearisations of viscous friction.
const ROUNDS: usize = 4;
/// Points within each interval at which limits are checked.
const BETWEEN: usize = 15;

/// More intervals are refused: each takes 10 kB.
const MOST: usize = 100_000;

/// The fastest s(t) within the limits, at rest at both ends; N intervals of s, a few hundred. O(N n²). Torques include
/// the model's own gravity and friction; in viscous friction √x is replaced by a tangent, which is never below it.
/// Limits hold at the ends of each interval. If they are exceeded within an interval, by some 10⁻⁴, they are tightened
/// by as much and the problem is solved again.
///
/// # Errors
/// [`Error::TooWeak`] if a torque limit cannot hold the robot, or move it along the path; [`Error::Unlimited`] if no
/// limit applies on some part of the path; [`mozzi::Error::BadArgument`], also for a path along which nothing moves,
/// and for too few intervals.
pub fn time_optimal(model: &Model, path: &impl Path, limits: &Limits, intervals: usize) -> Result<Profile, Error> {
    limits.check(model)?;
    check((2..=MOST).contains(&intervals), "the number of intervals", intervals, "2 to 100,000")?;
    check_driven(model, "a robot on a timed path")?;
    check_open(model, "a robot on a timed path")?;
    let s: Vec<f64> = (0..=intervals).map(|k| k as f64 / intervals as f64).collect();
    let grid = demands_of_a_motion(model, path, &s)?;
    let parts = BETWEEN + 1;
    let inside = (0..intervals * parts).filter(|k| k % parts != 0).map(|k| k as f64 / (intervals * parts) as f64);
    let inside = demands(model, path, &inside.collect::<Vec<_>>());
    let mut drawn_in = limits.clone();
    for _ in 0..CORRECTIONS {
        let speeds = reachable(model, &s, &grid, &drawn_in)?;
        if !drawn_in.draw_in(&shares(&s, &speeds, &inside, limits)) {
            return Ok(Profile::of_speeds(&s, &speeds));
        }
    }
    Err(exceeded("the number of intervals", intervals))
}

/// The largest used fractions of the limits of velocity, acceleration and torque at points between those of the grid,
/// with s̈ constant in between.
fn shares(s: &[f64], speeds: &[f64], inside: &[Demand], limits: &Limits) -> [Vec<f64>; 3] {
    let mut largest = [(); 3].map(|()| vec![0.0_f64; limits.torque.len()]);
    for (k, demand) in inside.iter().enumerate() {
        let i = k / BETWEEN;
        let u = 0.5 * (speeds[i + 1].powi(2) - speeds[i].powi(2)) / (s[i + 1] - s[i]);
        let x = (speeds[i].powi(2) + 2.0 * u * (demand.s - s[i])).max(0.0);
        for j in 0..demand.a.len() {
            let tau = demand.a[j] * u + demand.b[j] * x + demand.c[j] + demand.d[j] * x.sqrt();
            let acceleration = demand.slope[j] * u + demand.curvature[j] * x;
            let used = [
                (demand.slope[j] * x.sqrt(), limits.velocity[j]),
                (acceleration, limits.acceleration[j]),
                (tau, limits.torque[j]),
            ];
            for (largest, (asked, limit)) in largest.iter_mut().zip(used) {
                largest[j] = largest[j].max(asked.abs() / limit);
            }
        }
    }
    largest
}

/// ṡ at each grid point.
fn reachable(model: &Model, s: &[f64], demands: &[Demand], limits: &Limits) -> Result<Vec<f64>, Error> {
    for demand in demands {
        let weak = (0..model.n()).find(|&j| demand.c[j].abs() > limits.torque[j]);
        if let Some(j) = weak {
            return Err(too_weak(model, demand, limits, j));
        }
    }
    let damped =
        demands.iter().any(|demand| demand.d.iter().any(|&d| d != 0.0)) && limits.torque.iter().any(|x| x.is_finite());
    // the speeds at which √x is linearized: at first ∞, which means no friction, so that a solution exists to start
    // from
    let mut speeds = vec![f64::INFINITY; s.len()];
    for round in 0..if damped { ROUNDS } else { 1 } {
        let mut all: Vec<Vec<HalfPlane>> =
            demands.iter().zip(&speeds).map(|(demand, &speed)| planes(demand, limits, speed)).collect();
        // at both ends the robot rests, where friction neither hinders nor helps
        for end in [0, demands.len() - 1] {
            let rest = Demand { c: demands[end].g.clone(), ..demands[end].clone() };
            all[end].extend(planes(&rest, limits, speeds[end]));
        }
        let found = fastest(model, demands, limits, &all)?;
        if round == 0 && damped {
            // the first round ignores friction: half its speed is a suitable point of linearization
            speeds = found.iter().map(|x| 0.5 * x.sqrt()).collect();
        } else {
            speeds = found.iter().map(|x| x.sqrt()).collect();
        }
    }
    Ok(speeds)
}

/// The limits at a point, as half-planes of (u, x); √x is linearized at this speed, viscous friction is left out if it
/// is infinite.
fn planes(demand: &Demand, limits: &Limits, speed: f64) -> Vec<HalfPlane> {
    let mut planes = Vec::new();
    for j in 0..demand.a.len() {
        let (dq, ddq) = (demand.slope[j], demand.curvature[j]);
        if limits.velocity[j].is_finite() && dq != 0.0 {
            planes.push(HalfPlane { a: 0.0, b: 1.0, c: (limits.velocity[j] / dq).powi(2) });
        }
        if limits.acceleration[j].is_finite() {
            let c = limits.acceleration[j];
            planes.extend([HalfPlane { a: dq, b: ddq, c }, HalfPlane { a: -dq, b: -ddq, c }]);
        }
        if limits.torque[j].is_finite() {
            for sign in [1.0, -1.0] {
                // a u + b x + c + d √x ≤ τ, where √x ≤ (x/y + y)/2 for every y; if d helps, it is left out
                let d = (sign * demand.d[j]).max(0.0);
                let (slope, offset) = match speed {
                    y if d == 0.0 || y.is_infinite() => (0.0, 0.0),
                    y => (0.5 * d / y.max(1e-6), 0.5 * d * y.max(1e-6)),
                };
                let [a, b, c] = [demand.a[j], demand.b[j], demand.c[j]].map(|x| sign * x);
                planes.push(HalfPlane { a, b: b + slope, c: limits.torque[j] - c - offset });
            }
        }
    }
    planes
}

/// x at each grid point.
fn fastest(model: &Model, demands: &[Demand], limits: &Limits, planes: &[Vec<HalfPlane>]) -> Result<Vec<f64>, Error> {
    let (last, step) = (planes.len() - 1, 1.0 / (planes.len() - 1) as f64);
    let bounds = [[-UNBOUNDED, UNBOUNDED], [0.0, UNBOUNDED]];
    // the constraints of an interval on (u, x) at its beginning, if x at its end must be between 0 and `next`
    let interval = |i: usize, next: f64| {
        let mut all = planes[i].clone();
        all.extend(planes[i + 1].iter().map(|p| HalfPlane { a: p.a + 2.0 * step * p.b, ..*p }));
        all.extend([HalfPlane { a: 2.0 * step, b: 1.0, c: next }, HalfPlane { a: -2.0 * step, b: -1.0, c: 0.0 }]);
        all
    };
    let stuck = |i: usize| {
        // name the joint with the least room at rest
        let room = |j: &usize| limits.torque[*j] - demands[i].c[*j].abs();
        let j = (0..model.n()).min_by(|a, b| room(a).total_cmp(&room(b))).unwrap_or(0);
        too_weak(model, &demands[i], limits, j)
    };
    let mut largest = vec![0.0; last + 1];
    for i in (0..last).rev() {
        let [_, x] = maximize([0.0, 1.0], bounds, &interval(i, largest[i + 1])).ok_or_else(|| stuck(i))?;
        if x > 0.5 * UNBOUNDED {
            return Err(Error::Unlimited { s: demands[i].s });
        }
        largest[i] = if i == 0 { 0.0 } else { x };
    }
    let mut x = vec![0.0; last + 1];
    for i in 0..last {
        let mut all = interval(i, largest[i + 1]);
        // x is fixed up to rounding
        let room = 1e-12 * x[i];
        all.extend([HalfPlane { a: 0.0, b: 1.0, c: x[i] + room }, HalfPlane { a: 0.0, b: -1.0, c: room - x[i] }]);
        let [u, _] = maximize([1.0, 0.0], bounds, &all).ok_or_else(|| stuck(i))?;
        x[i + 1] = if i + 1 == last { 0.0 } else { (x[i] + 2.0 * step * u).clamp(0.0, largest[i + 1]) };
        if x[i + 1] <= 0.0 && i + 1 < last {
            return Err(stuck(i + 1));
        }
    }
    Ok(x)
}

fn too_weak(model: &Model, demand: &Demand, limits: &Limits, j: usize) -> Error {
    let joint = model.velocity_names().nth(j).unwrap_or_default().to_string();
    Error::TooWeak { joint, s: demand.s, needed: demand.c[j].abs(), limit: limits.torque[j] }
}
