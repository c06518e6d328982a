//! Motor saturation at the effort limits.

use crate::Policy;
use mozzi::{FrameId, Model, Wrench};
use mozzi_sim::{Error, Input};

/// A motor whose controller demanded more than its effort limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Overload {
    /// The joint.
    pub joint: String,
    /// The largest demanded |τ|, N m or N.
    pub largest: f64,
    /// The effort limit, N m or N.
    pub limit: f64,
    /// When the demand first exceeded the limit, s.
    pub first: f64,
    /// When the demand last exceeded the limit, s.
    pub last: f64,
}

/// An input whose torques are clamped to the joints' effort limits, or only compared with them. Joints without a limit
/// are not affected.
pub struct Saturated<I> {
    /// The input before its limits are applied.
    pub input: I,
    policy: Policy,
    names: Vec<String>,
    limits: Vec<f64>,
    overloads: Vec<Option<Overload>>,
    own: Vec<f64>,
    /// The time of the last call, and the overloads before it, if later calls may replace it.
    before: Option<(f64, Vec<Option<Overload>>)>,
}

impl<I: Input> Saturated<I> {
    /// With the effort limits of the robot's description.
    pub fn new(model: &Model, input: I, policy: Policy) -> Self {
        let mut limits = vec![f64::INFINITY; model.n()];
        for (place, joint) in model.places().iter().zip(model.joints()) {
            limits[place.velocities()].fill(joint.limits.effort.unwrap_or(f64::INFINITY));
        }
        Saturated {
            input,
            policy,
            names: model.velocity_names().map(str::to_string).collect(),
            overloads: vec![None; limits.len()],
            own: vec![0.0; limits.len()],
            limits,
            before: None,
        }
    }

    /// For a simulation: a call at the time of the last one, or before it, replaces that one's demands. They were those
    /// of an iterate, or of a step that is taken again.
    pub fn of_steps(self) -> Self {
        let before = Some((f64::NEG_INFINITY, self.overloads.clone()));
        Saturated { before, ..self }
    }

    /// The overload of each joint whose effort limit was exceeded since the start, whether the torque was clamped or
    /// not; empty if limits are ignored.
    pub fn overloads(&self) -> impl Iterator<Item = &Overload> {
        self.overloads.iter().flatten()
    }
}

impl<I: Input> Input for Saturated<I> {
    fn torque(&mut self, t: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), Error> {
        self.own.fill(0.0);
        if tau.len() != self.own.len() {
            let (found, expected) = (tau.len(), self.own.len());
            return Err(mozzi::Error::WrongLength { what: "tau", found, expected }.into());
        }
        self.input.torque(t, theta, dtheta, &mut self.own)?;
        if let Some((last, before)) = &mut self.before {
            if t <= *last {
                self.overloads.clone_from(before);
            } else {
                before.clone_from(&self.overloads);
            }
            *last = t;
        }
        for (j, asked) in self.own.iter_mut().enumerate() {
            let limit = self.limits[j];
            if self.policy != Policy::Ignore && asked.abs() > limit {
                let (largest, joint) = (asked.abs(), &self.names[j]);
                let note = self.overloads[j].get_or_insert_with(|| Overload {
                    joint: joint.clone(),
                    largest,
                    limit,
                    first: t,
                    last: t,
                });
                (note.largest, note.last) = (note.largest.max(largest), t);
                if self.policy == Policy::Respect {
                    *asked = asked.clamp(-limit, limit);
                }
            }
            tau[j] += *asked;
        }
        Ok(())
    }

    fn applied(
        &mut self,
        t: f64,
        theta: &[f64],
        dtheta: &[f64],
        wrenches: &mut Vec<(FrameId, Wrench)>,
    ) -> Result<(), Error> {
        self.input.applied(t, theta, dtheta, wrenches)
    }

    fn gains(&self, stiffness: &mut [f64], damping: &mut [f64]) {
        self.input.gains(stiffness, damping);
    }
}
