//! The result in one sentence, and whether it can be trusted.

use crate::{Errors, Identification, Kind};
use core::fmt;

/// A larger error of predictions, relative to the forces, means that the result cannot be trusted.
const TRUSTED: f64 = 0.5;

/// Which samples were predicted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Predicted {
    /// Another log.
    OtherLog,
    /// The part that was held out.
    HeldOut,
    /// Blocks of time that were left out in turn.
    LeftOut,
    /// The samples that were fitted.
    Fitted,
}

/// A payload that was weighed.
#[derive(Clone, Debug, PartialEq)]
pub struct Weighed {
    /// The frame that carries it.
    pub frame: String,
    /// Its mass, kg, and the standard deviation.
    pub mass: [f64; 2],
    /// Its centre of mass in the frame's coordinates, m.
    pub center: [f64; 3],
}

/// How well forces are predicted.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// Which samples were predicted.
    pub predicted: Predicted,
    /// Root mean square over the joints of error over force.
    pub nrms: f64,
    /// That of the robot's file.
    pub of_file: f64,
    /// Whether the error is below half of the forces.
    pub is_trusted: bool,
    /// The payload, if one was estimated.
    pub payload: Option<Weighed>,
}

impl Verdict {
    /// From an identification, and the errors on other logs.
    pub fn new<'e>(found: &Identification<'_>, others: impl Iterator<Item = &'e Errors>) -> Self {
        let (predicted, errors) = match (others.last(), &found.held_out, &found.left_out) {
            (Some(errors), ..) => (Predicted::OtherLog, errors),
            (None, Some(errors), _) => (Predicted::HeldOut, errors),
            (None, None, Some(errors)) => (Predicted::LeftOut, errors),
            (None, None, None) => (Predicted::Fitted, &found.fitted),
        };
        let nrms = errors.normalized(&errors.consistent);
        let of_file = errors.normalized(&errors.robot);
        let choice = &found.setup.columns.choice;
        // currents have no force of their own; friction alone does not make up for wrong masses
        let is_judged = !choice.gains && (choice.links || choice.payload.is_some());
        let is_trusted = nrms < TRUSTED || !is_judged;
        Verdict { predicted, nrms, of_file, is_trusted, payload: weighed(found) }
    }
}

fn weighed(found: &Identification<'_>) -> Option<Weighed> {
    let columns = &found.setup.columns;
    let frame = columns.model.frame_name(columns.choice.payload?).to_string();
    let optimum = &found.estimates.consistent;
    let first = columns.index(Kind::Payload(0))?;
    let mass = optimum.x[first];
    let center = core::array::from_fn(|i| if mass > 0.0 { optimum.x[first + 1 + i] / mass } else { 0.0 });
    // with how far the prior draws it from least squares, as in `Standing`
    let drawn = found.setup.alone(first).map_or(0.0, |_| mass - found.estimates.least_squares.x[first]);
    let deviation = optimum.deviations[first].hypot(drawn);
    Some(Weighed { frame, mass: [mass, deviation], center })
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(Weighed { frame, mass: [mass, deviation], center: [x, y, z] }) = &self.payload {
            let deviation = if *deviation < 1e-3 { format!("{deviation:.0e}") } else { format!("{deviation:.3}") };
            writeln!(f, "payload: {mass:.3} kg at ({x:.3}, {y:.3}, {z:.3}) m in {frame}, ± {deviation} kg")?;
        }
        let which = match self.predicted {
            Predicted::OtherLog => "torques of another log",
            Predicted::HeldOut | Predicted::LeftOut => "unseen torques",
            Predicted::Fitted => "the torques that it was fitted to",
        };
        let (nrms, of_file) = (percent(self.nrms), percent(self.of_file));
        write!(f, "predicts {which} to {nrms} (the robot's file: {of_file})")?;
        if !self.is_trusted {
            write!(f, "; NOT to be trusted: columns, units or the robot's file are wrong")?;
        }
        Ok(())
    }
}

/// Two significant digits.
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    match percent {
        0.0..0.1 => format!("{percent:.3} %"),
        0.1..1.0 => format!("{percent:.2} %"),
        1.0..10.0 => format!("{percent:.1} %"),
        _ => format!("{percent:.0} %"),
    }
}
