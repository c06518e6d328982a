//! How well a motion followed its reference.

use crate::trajectories::Reference;
use mozzi::{Model, Trajectory, difference};

/// The error e = θ_d ⊖ θ of each joint over a motion; a floating base follows nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackingError {
    /// √(mean of e²) of each joint, over the rows: rad or m.
    pub rms: Vec<f64>,
    /// max |e| of each.
    pub largest: Vec<f64>,
}

impl TrackingError {
    /// The largest of all.
    pub fn worst(&self) -> f64 {
        self.largest.iter().fold(0.0, |m, &x| m.max(x))
    }

    /// The largest root of a mean square.
    pub fn worst_rms(&self) -> f64 {
        self.rms.iter().fold(0.0, |m, &x| m.max(x))
    }
}

/// Of a simulated motion, over its rows.
///
/// # Panics
/// When the motion or the reference is another robot's.
pub fn tracking_error(model: &Model, motion: &Trajectory, reference: &impl Reference) -> TrackingError {
    let (base, mut e) = (model.base().velocities(), vec![0.0; model.n()]);
    let (mut squares, mut largest) = (vec![0.0; model.n() - base], vec![0.0_f64; model.n() - base]);
    for row in motion.samples() {
        difference(model, row.theta, &reference.at(row.t).theta, &mut e);
        for (j, e) in e[base..].iter().enumerate() {
            squares[j] += e * e;
            largest[j] = largest[j].max(e.abs());
        }
    }
    let rms = squares.iter().map(|sum| (sum / motion.len().max(1) as f64).sqrt()).collect();
    TrackingError { rms, largest }
}
