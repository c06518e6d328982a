//! Time scaling of a path: s(t) from 0 to 1.

use crate::Error;
use crate::error::check;

/// s, ṡ and s̈ at some time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress {
    /// Where on the path, 0 to 1.
    pub s: f64,
    /// 1/s.
    pub ds: f64,
    /// 1/s².
    pub dds: f64,
}

/// s(t), a polynomial of at most fifth degree in each of some pieces. Before its start s is 0, after its end 1, both at
/// rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Start times of the pieces, and the end time: s.
    times: Vec<f64>,
    /// Coefficients of 1, τ, …, τ⁵ with τ the time since the piece began.
    pieces: Vec<[f64; 6]>,
}

impl Profile {
    /// s = t/T: starts and stops abruptly. For paths that are functions of time already.
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] unless T is positive and finite; likewise for the others.
    pub fn linear(duration: f64) -> Result<Self, Error> {
        Self::single(duration, [0.0, 1.0, 0.0, 0.0, 0.0, 0.0])
    }

    /// s = 3(t/T)² − 2(t/T)³: at rest at both ends (Modern Robotics 9.2.2.1). Largest ṡ 1.5/T, largest |s̈| 6/T².
    ///
    /// # Errors
    /// As [`linear`](Self::linear).
    pub fn cubic(duration: f64) -> Result<Self, Error> {
        Self::single(duration, [0.0, 0.0, 3.0, -2.0, 0.0, 0.0])
    }

    /// s = 10(t/T)³ − 15(t/T)⁴ + 6(t/T)⁵: s̈ is 0 at both ends, too, so that torques do not jump. Largest ṡ 1.875/T,
    /// largest |s̈| 10/(√3 T²).
    ///
    /// # Errors
    /// As [`linear`](Self::linear).
    pub fn quintic(duration: f64) -> Result<Self, Error> {
        Self::single(duration, [0.0, 0.0, 0.0, 10.0, -15.0, 6.0])
    }

    /// Constant s̈ = a, then constant ṡ = v, then s̈ = −a; without the middle part if v is not reached (v² > a).
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] unless both are positive and finite.
    pub fn trapezoidal(speed: f64, acceleration: f64) -> Result<Self, Error> {
        check(
            speed > 0.0 && speed.is_finite(),
            "the speed of a trapezoidal profile",
            speed,
            "a positive, finite number",
        )?;
        let what = "the acceleration of a trapezoidal profile";
        check(acceleration > 0.0 && acceleration.is_finite(), what, acceleration, "a positive, finite number")?;
        let v = speed.min(acceleration.sqrt());
        let (rise, path) = (v / acceleration, 0.5 * v * v / acceleration);
        let cruise = (1.0 - 2.0 * path).max(0.0) / v;
        let a = 0.5 * acceleration;
        Ok(Profile {
            times: vec![0.0, rise, rise + cruise, 2.0 * rise + cruise],
            pieces: vec![
                [0.0, 0.0, a, 0.0, 0.0, 0.0],
                [path, v, 0.0, 0.0, 0.0, 0.0],
                [1.0 - path, v, -a, 0.0, 0.0, 0.0],
            ],
        })
    }

    /// A trapezoid of this duration; ṡ rises during this part of it, at most ½, and falls during an equal part.
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] unless the duration is positive and the part within (0, ½].
    pub fn trapezoidal_in(duration: f64, part: f64) -> Result<Self, Error> {
        check_duration(duration)?;
        check(part > 0.0 && part <= 0.5, "the part that a trapezoid rises", part, "above 0 and at most 0.5")?;
        let v = 1.0 / (duration * (1.0 - part));
        Self::trapezoidal(v, v / (part * duration))
    }

    /// Pieces of constant s̈ between the points s[i], passed at the speeds ṡ[i]; only the two ends may be at rest.
    pub(super) fn of_speeds(s: &[f64], ds: &[f64]) -> Self {
        let (mut times, mut pieces) = (vec![0.0], Vec::new());
        for (s, v) in s.windows(2).zip(ds.windows(2)) {
            let duration = 2.0 * (s[1] - s[0]) / (v[0] + v[1]);
            pieces.push([s[0], v[0], 0.5 * (v[1] - v[0]) / duration, 0.0, 0.0, 0.0]);
            times.push(times[times.len() - 1] + duration);
        }
        Profile { times, pieces }
    }

    /// From coefficients of t/T.
    fn single(duration: f64, coefficients: [f64; 6]) -> Result<Self, Error> {
        check_duration(duration)?;
        let mut piece = coefficients;
        (0..6).for_each(|k| piece[k] /= duration.powi(k as i32));
        Ok(Profile { times: vec![0.0, duration], pieces: vec![piece] })
    }

    /// The profile scaled to another duration: ṡ scales with the ratio, s̈ with its square.
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] unless the duration is positive and finite.
    pub fn in_time(&self, duration: f64) -> Result<Self, Error> {
        check_duration(duration)?;
        let ratio = self.duration() / duration;
        let slower = |piece: &[f64; 6]| std::array::from_fn(|k| piece[k] * ratio.powi(k as i32));
        Ok(Profile {
            times: self.times.iter().map(|t| t / ratio).collect(),
            pieces: self.pieces.iter().map(slower).collect(),
        })
    }

    /// Seconds.
    pub fn duration(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// The times at which s̈ jumps, without those of the ends.
    pub(super) fn corners(&self) -> &[f64] {
        &self.times[1..self.times.len() - 1]
    }

    /// The time at which s is reached, to rounding: s(t) does not decrease, so halving finds it.
    pub(super) fn time_of(&self, s: f64) -> f64 {
        let (mut low, mut high) = (0.0, self.duration());
        while low < high {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            (low, high) = if self.at(middle).s < s { (middle, high) } else { (low, middle) };
        }
        high
    }

    /// s, ṡ and s̈ at a time.
    pub fn at(&self, t: f64) -> Progress {
        if t < 0.0 {
            return Progress::default();
        }
        if t > self.duration() {
            return Progress { s: 1.0, ..Progress::default() };
        }
        let Progress { s, ds, dds } = self.continued(t);
        // no profile goes back except by rounding
        Progress { s: s.clamp(0.0, 1.0), ds: ds.max(0.0), dds }
    }

    /// As [`at`](Self::at), but extrapolates the first polynomial before the start and the last one after the end, as
    /// in the Modern Robotics package: s leaves 0 to 1 there.
    pub fn continued(&self, t: f64) -> Progress {
        let k = self.times.partition_point(|&begin| begin <= t).clamp(1, self.pieces.len()) - 1;
        let ([a, b, c, d, e, f], x) = (self.pieces[k], t - self.times[k]);
        Progress {
            s: a + x * (b + x * (c + x * (d + x * (e + x * f)))),
            ds: b + x * (2.0 * c + x * (3.0 * d + x * (4.0 * e + x * 5.0 * f))),
            dds: 2.0 * c + x * (6.0 * d + x * (12.0 * e + x * 20.0 * f)),
        }
    }
}

fn check_duration(duration: f64) -> Result<(), Error> {
    check(duration > 0.0 && duration.is_finite(), "the duration", duration, "a positive, finite number of seconds")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> Vec<Profile> {
        vec![
            Profile::linear(2.0).expect("fine"),
            Profile::cubic(0.7).expect("fine"),
            Profile::quintic(3.0).expect("fine"),
            Profile::trapezoidal(0.5, 2.0).expect("fine"),
            Profile::trapezoidal(9.0, 2.0).expect("fine"),
            Profile::trapezoidal_in(4.0, 0.25).expect("fine"),
            Profile::of_speeds(&[0.0, 0.2, 0.6, 1.0], &[0.0, 1.0, 0.5, 0.0]),
        ]
    }

    #[test]
    fn rates_are_derivatives_and_the_ends_are_the_ends() {
        for profile in all().into_iter().flat_map(|p| [p.in_time(1.3).expect("fine"), p]) {
            let T = profile.duration();
            assert!(profile.at(0.0).s.abs() < 1e-15 && (profile.at(T).s - 1.0).abs() < 1e-14, "{profile:?}");
            assert_eq!((profile.at(-0.1).s, profile.at(T + 0.1).s, profile.at(T + 0.1).ds), (0.0, 1.0, 0.0));
            let (mut s, e) = (0.0, 1e-5);
            for k in 1..200 {
                let t = T * (k as f64 + 0.123) / 200.3;
                let (before, now, after) = (profile.at(t - e), profile.at(t), profile.at(t + e));
                let inside = profile.times.iter().all(|begin| (t - begin).abs() > 2.0 * e);
                assert!(now.s >= s);
                s = now.s;
                assert!((after.s - before.s - 2.0 * e * now.ds).abs() < 1e-9);
                assert!(!inside || (after.ds - before.ds - 2.0 * e * now.dds).abs() < 1e-8, "{profile:?} {t}");
            }
        }
    }

    #[test]
    fn beyond_the_ends_the_polynomials_go_on() {
        let (cubic, quintic) = (Profile::cubic(2.0).expect("fine"), Profile::quintic(1.0).expect("fine"));
        for x in [-0.7_f64, 0.4, 1.9] {
            assert!((cubic.continued(2.0 * x).s - x * x * (3.0 - 2.0 * x)).abs() < 1e-14);
            assert!((quintic.continued(x).s - x.powi(3) * (10.0 + x * (6.0 * x - 15.0))).abs() < 1e-13);
        }
    }

    #[test]
    fn the_largest_rates_are_those_of_the_book() {
        let largest = |profile: &Profile| {
            let rates = (0..=1000).map(|k| profile.at(profile.duration() * k as f64 / 1000.0));
            rates.fold((0.0_f64, 0.0_f64), |(v, a), p| (v.max(p.ds), a.max(p.dds.abs())))
        };
        for (profile, ds, dds) in [
            (Profile::cubic(2.0), 0.75, 1.5),
            (Profile::quintic(2.0), 0.9375, 10.0 / (4.0 * 3_f64.sqrt())),
            (Profile::trapezoidal(0.5, 2.0), 0.5, 2.0),
            (Profile::trapezoidal(5.0, 2.0), 2_f64.sqrt(), 2.0), // a triangle
            (Profile::trapezoidal_in(2.0, 0.25), 2.0 / 3.0, 4.0 / 3.0),
        ] {
            let profile = profile.expect("fine");
            let (v, a) = largest(&profile);
            assert!((v - ds).abs() < 2e-3 && (a - dds).abs() < 2e-3, "{v} {a}, expected {ds} {dds}");
        }
        assert!((Profile::trapezoidal_in(2.0, 0.25).expect("fine").duration() - 2.0).abs() < 1e-15);
        for bad in [
            Profile::cubic(0.0),
            Profile::linear(f64::NAN),
            Profile::trapezoidal(1.0, -1.0),
            Profile::trapezoidal_in(1.0, 0.6),
        ] {
            assert!(bad.is_err());
        }
    }
}
