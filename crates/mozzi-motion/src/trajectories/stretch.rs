//! The shortest duration of a given shape of s(t) under limits.

use super::demands::{Demand, demands_of_a_motion};
use super::limits::{CORRECTIONS, Limits, exceeded};
use super::path::Path;
use super::profile::{Profile, Progress};
use crate::Error;
use crate::error::{check, check_driven, check_open};
use mozzi::Model;

/// More samples are refused: each takes 600 bytes.
const MOST: usize = 1_000_000;

/// The profile with the shortest duration that keeps the limits at all times. With y the old duration over the new one,
/// θ̇ grows as y, θ̈ as y², and τ = A y² + D y + c at each of N + 1 equal times, and where s̈ or θ″ jumps. A peak
/// between three of these times is that of their parabola.
///
/// # Errors
/// [`Error::TooWeak`] if a torque limit cannot hold the robot; [`Error::Unlimited`] if nothing is limited;
/// [`mozzi::Error::BadArgument`], also for a path along which nothing moves, and for too few samples.
pub fn stretched(
    model: &Model,
    path: &impl Path,
    profile: &Profile,
    limits: &Limits,
    samples: usize,
) -> Result<Profile, Error> {
    limits.check(model)?;
    check((2..=MOST).contains(&samples), "the number of samples", samples, "2 to 1,000,000")?;
    check_driven(model, "a robot on a timed path")?;
    check_open(model, "a robot on a timed path")?;
    let places = places(profile, &path.knots(), samples);
    let demands = demands_of_a_motion(model, path, &places.iter().map(|place| place.now.s).collect::<Vec<_>>())?;
    let sampled = Sampled { demands, places };
    let mut drawn_in = limits.clone();
    for _ in 0..CORRECTIONS {
        let y = sampled.fastest(model, &drawn_in)?;
        if !drawn_in.draw_in(&sampled.peaks(y, limits)) {
            return profile.in_time(profile.duration() / y);
        }
    }
    Err(exceeded("the number of samples", samples))
}

/// A moment of a motion.
struct Place {
    now: Progress,
    /// θ″ or s̈ jumps here or next to it: no parabola leads over it.
    is_corner: bool,
}

/// Equal times, and both sides of each corner of the profile and of each knot of the path.
fn places(profile: &Profile, knots: &[f64], samples: usize) -> Vec<Place> {
    let T = profile.duration();
    let mut times: Vec<(f64, bool)> = (0..=samples).map(|k| (T * k as f64 / samples as f64, false)).collect();
    let corners = profile.corners().iter().copied().chain(knots.iter().map(|&s| profile.time_of(s)));
    for t in corners.filter(|&t| t > 0.0 && t < T) {
        times.extend([t * (1.0 - 1e-12), t * (1.0 + 1e-12)].map(|t| (t, true)));
    }
    times.sort_by(|a, b| a.0.total_cmp(&b.0));
    times.into_iter().map(|(t, is_corner)| Place { now: profile.at(t), is_corner }).collect()
}

struct Sampled {
    demands: Vec<Demand>,
    places: Vec<Place>,
}

impl Sampled {
    /// The largest y that keeps the limits at every place.
    fn fastest(&self, model: &Model, limits: &Limits) -> Result<f64, Error> {
        let mut fastest = f64::INFINITY;
        for (demand, Place { now, .. }) in self.demands.iter().zip(&self.places) {
            for j in 0..model.n() {
                let [rate, acceleration] = motion(demand, now, j);
                fastest = fastest.min(limits.velocity[j] / rate.abs());
                fastest = fastest.min((limits.acceleration[j] / acceleration.abs()).sqrt());
                let [A, D, c] = torque(demand, now, j);
                let y = [1.0, -1.0].map(|sign| smallest_root(sign * A, sign * D, sign * c - limits.torque[j]));
                let y = y[0].min(y[1]);
                if c.abs() > limits.torque[j] || y == 0.0 {
                    let joint = model.velocity_names().nth(j).unwrap_or_default().to_string();
                    return Err(Error::TooWeak { joint, s: demand.s, needed: c.abs(), limit: limits.torque[j] });
                }
                fastest = fastest.min(y);
            }
        }
        if fastest.is_finite() { Ok(fastest) } else { Err(Error::Unlimited { s: 0.0 }) }
    }

    /// The largest used fractions of the limits of velocity, acceleration and torque at y, of each joint.
    fn peaks(&self, y: f64, limits: &Limits) -> [Vec<f64>; 3] {
        let share = |k: usize, j: usize| {
            let (demand, now) = (&self.demands[k], &self.places[k].now);
            let ([rate, acceleration], [A, D, c]) = (motion(demand, now, j), torque(demand, now, j));
            [
                rate * y / limits.velocity[j],
                acceleration * y * y / limits.acceleration[j],
                ((A * y + D) * y + c) / limits.torque[j],
            ]
            .map(f64::abs)
        };
        let mut peaks = [(); 3].map(|()| vec![0.0_f64; limits.torque.len()]);
        for j in 0..limits.torque.len() {
            let all: Vec<[f64; 3]> = (0..self.places.len()).map(|k| share(k, j)).collect();
            for (kind, peaks) in peaks.iter_mut().enumerate() {
                let at_places = all.iter().map(|shares| shares[kind]).fold(0.0_f64, f64::max);
                let three = all.windows(3).zip(self.places.windows(3));
                let smooth = three.filter(|(_, places)| places.iter().all(|place| !place.is_corner));
                let between = smooth.map(|(shares, _)| top([shares[0][kind], shares[1][kind], shares[2][kind]]));
                peaks[j] = between.fold(at_places, f64::max);
            }
        }
        peaks
    }
}

/// θ̇_j and θ̈_j at y = 1.
fn motion(demand: &Demand, now: &Progress, j: usize) -> [f64; 2] {
    [demand.slope[j] * now.ds, demand.curvature[j] * now.ds * now.ds + demand.slope[j] * now.dds]
}

/// A, D and c of τ_j = A y² + D y + c.
fn torque(demand: &Demand, now: &Progress, j: usize) -> [f64; 3] {
    [demand.a[j] * now.dds + demand.b[j] * now.ds * now.ds, demand.d[j] * now.ds, demand.c[j]]
}

/// The top of the parabola through three equidistant values, if the middle one is the largest; else 0.
fn top([a, b, c]: [f64; 3]) -> f64 {
    let bend = a - 2.0 * b + c;
    if b >= a && b >= c && bend < 0.0 { b - (c - a) * (c - a) / (8.0 * bend) } else { 0.0 }
}

/// The smallest y ≥ 0 at which A y² + D y + c, which is not positive at 0, becomes positive; ∞ if it never does.
fn smallest_root(A: f64, D: f64, c: f64) -> f64 {
    if c == f64::NEG_INFINITY {
        return f64::INFINITY;
    }
    if c == 0.0 && (D > 0.0 || D == 0.0 && A > 0.0) {
        return 0.0;
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

#[cfg(test)]
mod tests {
    use super::smallest_root;

    #[test]
    fn parabolas_that_begin_at_zero_become_positive_at_once_or_later() {
        assert_eq!(smallest_root(-1.0, 2.0, 0.0), 0.0);
        assert_eq!(smallest_root(1.0, 0.0, 0.0), 0.0);
        assert_eq!(smallest_root(2.0, -1.0, 0.0), 0.5);
        assert_eq!(smallest_root(-1.0, -1.0, 0.0), f64::INFINITY);
        assert_eq!(smallest_root(1.0, 1.0, -2.0), 1.0);
    }
}
