//! How well a motion followed its reference.

use crate::trajectories::Reference;
use mozzi::Model;
use mozzi::model::difference;
use mozzi_sim::Trajectory;
use mozzi_sim::{Recorder, Sample};
use std::ops::ControlFlow;

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

/// The error of a simulated motion, over its rows.
///
/// # Panics
/// When the motion or the reference belongs to another robot.
pub fn tracking_error(model: &Model, motion: &Trajectory, reference: &impl Reference) -> TrackingError {
    let mut tracking = Tracking::new(model, reference);
    for row in motion.samples() {
        let ControlFlow::Continue(()) = tracking.take(&row) else { break };
    }
    tracking.error()
}

/// The error of any rows (t, θ).
///
/// # Panics
/// When the rows or the reference belong to another robot.
pub fn tracking_error_of_rows<'a>(
    model: &Model,
    rows: impl IntoIterator<Item = (f64, &'a [f64])>,
    reference: &impl Reference,
) -> TrackingError {
    let mut tracking = Tracking::new(model, reference);
    rows.into_iter().for_each(|(t, theta)| tracking.add(t, theta));
    tracking.error()
}

/// [`tracking_error`] of rows that come one by one.
pub struct Tracking<'a, R> {
    model: &'a Model,
    reference: &'a R,
    rows: usize,
    squares: Vec<f64>,
    largest: Vec<f64>,
    e: Vec<f64>,
}

impl<'a, R: Reference> Tracking<'a, R> {
    /// Starts without rows.
    pub fn new(model: &'a Model, reference: &'a R) -> Self {
        let (n, joints) = (model.n(), model.n() - model.base().velocities());
        Tracking { model, reference, rows: 0, squares: vec![0.0; joints], largest: vec![0.0; joints], e: vec![0.0; n] }
    }

    /// Adds a row.
    ///
    /// # Panics
    /// When the row or the reference belongs to another robot.
    pub fn add(&mut self, t: f64, theta: &[f64]) {
        self.rows += 1;
        difference(self.model, theta, &self.reference.at(t).theta, &mut self.e);
        let base = self.model.base().velocities();
        for (j, e) in self.e[base..].iter().enumerate() {
            self.squares[j] += e * e;
            self.largest[j] = self.largest[j].max(e.abs());
        }
    }

    /// The error over the rows so far.
    pub fn error(&self) -> TrackingError {
        let rms = self.squares.iter().map(|sum| (sum / self.rows.max(1) as f64).sqrt()).collect();
        TrackingError { rms, largest: self.largest.clone() }
    }
}

impl<R: Reference> Recorder for Tracking<'_, R> {
    fn take(&mut self, row: &Sample) -> ControlFlow<()> {
        self.add(row.t, row.theta);
        ControlFlow::Continue(())
    }
}
