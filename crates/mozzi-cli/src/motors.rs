//! What drives a simulated robot: the flags of `mozzi simulate` as inputs.

use crate::controller::Controller;
use crate::failure::{Failure, Result};
use crate::numbers::{WRENCH, array};
use crate::robot::RobotArguments;
use crate::samples::{Samples, first_column};
use clap::{Args, ValueEnum};
use mozzi::simulation::{self, GravityCompensation, Input, Outside, Table, TorqueTable, WrenchTable, Zero};
use mozzi::{Model, Wrench};
use mozzi_motion::Policy;
use mozzi_motion::trajectories::{Hold, Recorded, Reference};

#[derive(Args, Debug)]
pub struct MotorArguments {
    /// The motors: zero, gravity-compensation, or a CSV file with columns t, tau_1, … (linear in between); beside a controller's
    #[arg(long, value_name = "FILE|zero|gravity-compensation", default_value = "zero")]
    pub torque: String,
    /// What the controller is to follow: a CSV file with columns t, theta_1, … and, where known, dtheta_, ddtheta_
    #[arg(long, value_name = "FILE.csv", requires = "controller")]
    pub follow: Option<String>,
    /// A controller in a JSON file; without --follow it holds the start
    #[arg(long, value_name = "FILE.json")]
    pub controller: Option<String>,
    /// What is made of the motors' effort limits
    #[arg(long, value_name = "WHAT", default_value = "report")]
    pub effort_limits: Limit,
    /// What the tip applies to the environment, in its frame, moment first: a CSV file with columns t, m_x, … f_z, or six numbers
    #[arg(long, value_name = "FILE|mx,my,mz,fx,fy,fz", allow_hyphen_values = true)]
    pub tip_wrench: Option<String>,
    /// What a table says before its first and after its last time
    #[arg(long, value_name = "WHAT", default_value = "error")]
    outside: Beyond,
}

/// What is made of limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Limit {
    /// Nothing
    Ignore,
    /// The robot goes beyond, which is told
    Report,
    /// The robot is kept from it, which is told
    Respect,
}

impl From<Limit> for Policy {
    fn from(limit: Limit) -> Policy {
        match limit {
            Limit::Ignore => Policy::Ignore,
            Limit::Report => Policy::Report,
            Limit::Respect => Policy::Respect,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Beyond {
    /// An error
    Error,
    /// The nearest row
    Hold,
    /// Zero
    Zero,
}

impl MotorArguments {
    /// What is followed, where something is.
    pub fn reference(&self, model: &Model) -> Result<Option<Recorded>> {
        let Some(file) = &self.follow else { return Ok(None) };
        let samples = Samples::read(file, model)?;
        let times = samples.need(&samples.t, "t")?;
        check_times(&samples, times)?;
        let theta = samples.need(&samples.theta, &first_column(model, "theta"))?;
        let rates = [&samples.dtheta, &samples.ddtheta].map(|rows| rows.as_deref());
        let place = |error: mozzi_motion::Error| Failure::wrong(format!("{file}: {error}"));
        Ok(Some(Recorded::new(model, times, theta, rates[0], rates[1]).map_err(place)?))
    }

    pub fn controller(&self, robot: &RobotArguments) -> Result<Option<Controller>> {
        self.controller.as_deref().map(|file| Controller::read(file, robot)).transpose()
    }

    /// --torque and the controller's.
    pub fn motors<'a>(
        &self,
        model: &'a Model,
        controller: Option<&'a Controller>,
        reference: &'a dyn Reference,
        end: f64,
    ) -> Result<Box<dyn Input + 'a>> {
        let given: Box<dyn Input + 'a> = match self.torque.as_str() {
            "zero" => Box::new(Zero),
            "gravity-compensation" => Box::new(GravityCompensation::new(model)),
            file => {
                let samples = Samples::read(file, model)?;
                let values = samples.need(&samples.tau, &first_column(model, "tau"))?.concat();
                Box::new(TorqueTable(self.table(&samples, values, end)?))
            }
        };
        match controller {
            None => Ok(given),
            Some(controller) => Ok(Box::new((given, controller.follow(model, reference)?))),
        }
    }

    pub fn wrench<'m>(&self, model: &'m Model, end: f64) -> Result<Box<dyn Input + 'm>> {
        let Some(text) = self.tip_wrench.as_deref() else { return Ok(Box::new(Zero)) };
        let tip = model.end_effector()?;
        if !std::path::Path::new(text).exists() && text.contains(',') {
            let F = Wrench::from_array(array("--tip-wrench", text, WRENCH)?);
            return Ok(Box::new(simulation::applied(tip, move |_, _, _| F)));
        }
        let samples = Samples::read(text, model)?;
        let list = samples.need(&samples.tip_wrench, "m_x m_y m_z f_x f_y f_z")?;
        let values = list.iter().flat_map(|F| F.to_array()).collect();
        Ok(Box::new(WrenchTable(tip, self.table(&samples, values, end)?)))
    }

    fn table(&self, samples: &Samples, values: Vec<f64>, end: f64) -> Result<Table> {
        let outside = match self.outside {
            Beyond::Error => Outside::Error,
            Beyond::Hold => Outside::Hold,
            Beyond::Zero => Outside::Zero,
        };
        let times = samples.need(&samples.t, "t")?;
        check_times(samples, times)?;
        let [first, last] = [times.first(), times.last()].map(|t| t.copied().unwrap_or(0.0));
        if matches!(self.outside, Beyond::Error) && (first > 0.0 || last < end * (1.0 - 1e-12)) {
            return Err(Failure::wrong(format!(
                "{} covers t = {first} s to {last} s, expected 0 s to {end} s; shorten --time, or say --outside hold or zero",
                samples.file
            )));
        }
        Ok(Table::new(times.clone(), values)?.outside(outside))
    }
}

fn check_times(samples: &Samples, times: &[f64]) -> Result<()> {
    match (1..times.len()).find(|&row| times[row] <= times[row - 1]) {
        None => Ok(()),
        Some(row) => {
            let (place, t, before) = (samples.place(row), times[row], times[row - 1]);
            Err(Failure::wrong(format!("{place}: t is {t} after {before}, expected times that increase")))
        }
    }
}

/// Where nothing is followed, the start is held.
pub fn or_hold<'a>(recorded: Option<&'a Recorded>, hold: &'a Hold) -> &'a dyn Reference {
    match recorded {
        Some(recorded) => recorded,
        None => hold,
    }
}
