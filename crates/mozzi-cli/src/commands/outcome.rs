//! The outcome of `mozzi simulate`.

use mozzi_motion::controllers::{Overload, TrackingError};
use mozzi_report::Touches;
use mozzi_sim::Trajectory;
use mozzi_sim::{Account, Closing, ContactEvent, Method, Occurrence, OneSidedAccount, Stopped};

/// A motion and its notes.
pub struct Outcome {
    /// Its rows, or some of them: those for the table, JSON and the page.
    pub motion: Trajectory,
    /// The energy account over all of its rows.
    pub account: Account,
    pub method: Method,
    /// The names of the contacts.
    pub contacts: Vec<String>,
    /// The contacts by the rows of the motion, for a page.
    pub touches: Option<Touches>,
    /// The solutions for dry friction, stops and contacts.
    pub one_sided: Option<OneSidedAccount>,
    pub contact_events: Vec<ContactEvent>,
    /// Step size in seconds; for an adaptive method, the time between two rows.
    pub step: f64,
    pub duration: f64,
    pub motors: String,
    pub overloads: Vec<Overload>,
    pub stops: Vec<Stopped>,
    /// For a robot with constraints: how far the steps violated them.
    pub closing: Option<Closing>,
    /// The events of `--until` and `--report-event`, in the order of time.
    pub events: Vec<Occurrence>,
    /// The conditions that did not become true.
    pub missed: Vec<String>,
    pub tracking: Option<TrackingError>,
}

impl Outcome {
    /// True if a condition ended the motion.
    pub fn is_ended(&self) -> bool {
        self.events.last().is_some_and(|event| event.stop)
    }

    /// The step in seconds, or the tolerance of an adaptive method.
    pub fn step(&self) -> f64 {
        match self.method {
            Method::DormandPrince { tolerance } => tolerance,
            _ => self.step,
        }
    }
}
