//! The outcome of `mozzi simulate`.

use mozzi::Trajectory;
use mozzi::simulation::{Account, Closing, Method, Occurrence, Stopped};
use mozzi_motion::controllers::{Overload, TrackingError};

/// A motion and its notes.
pub struct Outcome {
    /// Its rows, or some of them: those for the table, JSON and the page.
    pub motion: Trajectory,
    /// What all of its rows say of the energy.
    pub account: Account,
    pub method: Method,
    /// Seconds; of an adaptive method between two rows.
    pub step: f64,
    pub duration: f64,
    pub motors: String,
    pub overloads: Vec<Overload>,
    pub stops: Vec<Stopped>,
    /// Of a robot with constraints, how far the steps left them.
    pub closing: Option<Closing>,
    /// What `--until` and `--report-event` found, in the order of time.
    pub events: Vec<Occurrence>,
    /// The conditions that did not become true.
    pub missed: Vec<String>,
    pub tracking: Option<TrackingError>,
}

impl Outcome {
    /// Did a condition end it?
    pub fn is_ended(&self) -> bool {
        self.events.last().is_some_and(|event| event.stop)
    }

    /// The step in seconds, of an adaptive method its tolerance.
    pub fn step(&self) -> f64 {
        match self.method {
            Method::DormandPrince { tolerance } => tolerance,
            _ => self.step,
        }
    }
}
