//! How well a motion followed its reference.

use crate::trajectories::Reference;
use mozzi::{Model, Trajectory, difference};

/// The error e = θ_d ⊖ θ over a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackingError {
    /// √(mean of e²) of each velocity, over the rows: rad or m.
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
    let (mut squares, mut largest, mut e) = (vec![0.0; model.n()], vec![0.0_f64; model.n()], vec![0.0; model.n()]);
    for row in motion.samples() {
        difference(model, row.theta, &reference.at(row.t).theta, &mut e);
        for j in 0..e.len() {
            squares[j] += e[j] * e[j];
            largest[j] = largest[j].max(e[j].abs());
        }
    }
    let rms = squares.iter().map(|sum| (sum / motion.len().max(1) as f64).sqrt()).collect();
    TrackingError { rms, largest }
}
