//! The shortest duration of a given shape of s(t) under limits.

use super::demands::demands_of_a_motion;
use super::limits::Limits;
use super::path::Path;
use super::profile::Profile;
use crate::Error;
use crate::error::{check, check_driven, check_open};
use mozzi::Model;

/// The profile with the shortest duration that keeps the limits at N + 1 equal times: with y the old duration over the
/// new one, θ̇ grows as y, θ̈ as y², and τ = A y² + D y + c.
///
/// # Errors
/// [`Error::TooWeak`] if a torque limit cannot hold the robot; [`Error::Unlimited`] if nothing is limited;
/// [`mozzi::Error::BadArgument`], also for a path along which nothing moves.
pub fn stretched(
    model: &Model,
    path: &impl Path,
    profile: &Profile,
    limits: &Limits,
    samples: usize,
) -> Result<Profile, Error> {
    limits.check(model)?;
    check(samples >= 2, "the number of samples", samples, "at least 2")?;
    check_driven(model, "a robot on a timed path")?;
    check_open(model, "a robot on a timed path")?;
    let times: Vec<f64> = (0..=samples).map(|k| profile.duration() * k as f64 / samples as f64).collect();
    let progress: Vec<_> = times.iter().map(|&t| profile.at(t)).collect();
    let demands = demands_of_a_motion(model, path, &progress.iter().map(|p| p.s).collect::<Vec<_>>())?;
    let mut fastest = f64::INFINITY;
    for (demand, now) in demands.iter().zip(&progress) {
        for j in 0..model.n() {
            let rate = demand.slope[j] * now.ds;
            let acceleration = demand.curvature[j] * now.ds * now.ds + demand.slope[j] * now.dds;
            fastest = fastest.min(limits.velocity[j] / rate.abs());
            fastest = fastest.min((limits.acceleration[j] / acceleration.abs()).sqrt());
            let (A, D, c) = (demand.a[j] * now.dds + demand.b[j] * now.ds * now.ds, demand.d[j] * now.ds, demand.c[j]);
            if c.abs() > limits.torque[j] {
                let joint = model.velocity_names().nth(j).unwrap_or_default().to_string();
                return Err(Error::TooWeak { joint, s: demand.s, needed: c.abs(), limit: limits.torque[j] });
            }
            for sign in [1.0, -1.0] {
                fastest = fastest.min(smallest_root(sign * A, sign * D, sign * c - limits.torque[j]));
            }
        }
    }
    if !fastest.is_finite() {
        return Err(Error::Unlimited { s: 0.0 });
    }
    profile.in_time(profile.duration() / fastest)
}

/// The smallest y > 0 at which A y² + D y + c, which is not positive at 0, becomes positive; ∞ if it never does.
fn smallest_root(A: f64, D: f64, c: f64) -> f64 {
    if c == f64::NEG_INFINITY {
        return f64::INFINITY;
    }
    let inside = D * D - 4.0 * A * c;
    if inside < 0.0 {
        return f64::INFINITY;
    }
    // both roots without cancellation
    let q = -0.5 * (D + inside.sqrt().copysign(D));
    let roots = [q / A, c / q];
    roots.into_iter().filter(|y| *y > 0.0 && y.is_finite()).fold(f64::INFINITY, f64::min)
}
