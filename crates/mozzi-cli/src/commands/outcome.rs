//! What `mozzi simulate` has to say.

use mozzi::Trajectory;
use mozzi_motion::controllers::{Overload, TrackingError};
use mozzi_motion::integrators::{Occurrence, Stopped};

/// A motion, and what is to be said of it.
pub struct Outcome {
    pub motion: Trajectory,
    /// The method's name, and its step in seconds or its tolerance.
    pub method: &'static str,
    pub step: f64,
    pub duration: f64,
    pub motors: String,
    pub overloads: Vec<Overload>,
    pub stops: Vec<Stopped>,
    /// What `--until` and `--report-event` found, in the order of time.
    pub events: Vec<Occurrence>,
    /// The conditions that were looked for and not found.
    pub missed: Vec<String>,
    pub tracking: Option<TrackingError>,
}

impl Outcome {
    /// Did a condition end it?
    pub fn is_ended(&self) -> bool {
        self.events.last().is_some_and(|event| event.stop)
    }
}
