//! Desired motions: θ, θ̇ and θ̈ at every time.

use super::path::{Path, Point};
use super::profile::Profile;

/// θ_d, θ̇_d and θ̈_d at some time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Desired {
    /// nq positions.
    pub theta: Vec<f64>,
    /// n velocities.
    pub dtheta: Vec<f64>,
    /// n accelerations.
    pub ddtheta: Vec<f64>,
}

/// A desired motion of a robot.
pub trait Reference {
    /// Seconds; the motion begins at 0.
    fn duration(&self) -> f64;
    /// The desired state at a time. Before the motion the robot stays at its start, afterwards at its end.
    fn at(&self, t: f64) -> Desired;
    /// At N + 1 equal times from 0 to the end.
    fn sampled(&self, steps: usize) -> Vec<(f64, Desired)> {
        let time = |k: usize| self.duration() * k as f64 / steps.max(1) as f64;
        (0..=steps).map(|k| (time(k), self.at(time(k)))).collect()
    }
}

impl<R: Reference + ?Sized> Reference for &R {
    fn duration(&self) -> f64 {
        (**self).duration()
    }
    fn at(&self, t: f64) -> Desired {
        (**self).at(t)
    }
}

impl<R: Reference + ?Sized> Reference for Box<R> {
    fn duration(&self) -> f64 {
        (**self).duration()
    }
    fn at(&self, t: f64) -> Desired {
        (**self).at(t)
    }
}

/// A path with a time profile: θ̇ = θ′ṡ, θ̈ = θ″ṡ² + θ′s̈.
#[derive(Clone, Debug)]
pub struct Timed<P> {
    /// θ(s).
    pub path: P,
    /// s(t).
    pub profile: Profile,
}

impl<P: Path> Timed<P> {
    /// θ(s(t)).
    pub fn new(path: P, profile: Profile) -> Self {
        Timed { path, profile }
    }
}

impl<P: Path> Reference for Timed<P> {
    fn duration(&self) -> f64 {
        self.profile.duration()
    }

    fn at(&self, t: f64) -> Desired {
        let now = self.profile.at(t);
        let Point { theta, slope, curvature } = self.path.at(now.s);
        let dtheta = slope.iter().map(|x| x * now.ds).collect();
        let ddtheta = slope.iter().zip(&curvature).map(|(x, y)| y * now.ds * now.ds + x * now.dds).collect();
        Desired { theta, dtheta, ddtheta }
    }
}

/// A joint motion of a robot with a floating base. The base has no motors, so controllers ignore its desired state: a
/// constant pose, at rest.
#[derive(Clone, Debug)]
pub struct OfJoints<R> {
    /// The joints' motion, as for the robot with a fixed base.
    pub joints: R,
    /// The base's, as in θ.
    pub pose: [f64; 7],
}

impl<R: Reference> Reference for OfJoints<R> {
    fn duration(&self) -> f64 {
        self.joints.duration()
    }

    fn at(&self, t: f64) -> Desired {
        let Desired { theta, dtheta, ddtheta } = self.joints.at(t);
        let still = [0.0; 6];
        Desired {
            theta: [&self.pose[..], &theta].concat(),
            dtheta: [&still[..], &dtheta].concat(),
            ddtheta: [&still[..], &ddtheta].concat(),
        }
    }
}

/// Constant positions.
#[derive(Clone, Debug)]
pub struct Hold {
    desired: Desired,
}

impl Hold {
    /// These positions at all times, of a robot with n velocities.
    pub fn new(theta: &[f64], n: usize) -> Self {
        Hold { desired: Desired { theta: theta.to_vec(), dtheta: vec![0.0; n], ddtheta: vec![0.0; n] } }
    }
}

impl Reference for Hold {
    fn duration(&self) -> f64 {
        0.0
    }
    fn at(&self, _: f64) -> Desired {
        self.desired.clone()
    }
}

/// Two times are farther apart, relative to the step.
const APART: f64 = 1e-9;

/// The multiples of a step before the end of a motion, and the end, s.
pub fn times(step: f64, duration: f64) -> Vec<f64> {
    let before = (duration / step - APART).ceil().max(0.0) as usize;
    (0..before).map(|k| k as f64 * step).chain([duration]).collect()
}
