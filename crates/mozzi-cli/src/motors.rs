//! The inputs of a simulated robot, from the flags of `mozzi simulate`.

use crate::controller::Controller;
use crate::failure::{self, Failure, Result};
use crate::input;
use crate::numbers::{WRENCH, array, is_number, number, numbers_for};
use crate::robot::RobotArguments;
use crate::tables::samples::Samples;
use crate::tables::{motion, read as table_file};
use clap::{Args, ValueEnum};
use mozzi::{Base, Model, Wrench};
use mozzi_motion::Policy;
use mozzi_motion::trajectories::{Hold, OfJoints, Recorded, Reference};
use mozzi_sim::{self, Contacts, GravityCompensation, Input, Outside, Table, TorqueTable, WrenchTable, Zero};
use mozzi_urdf::mjcf::{self, Actuated};
use std::cell::OnceCell;

/// The value of --torque for the actuators of a file.
pub const ACTUATORS: &str = "actuators";
/// Notes about actuators that are not computed.
const MOST_NOTES: usize = 3;

/// A file's actuators as an input.
pub struct Actuators(Actuated);

impl Input for Actuators {
    fn torque(
        &mut self,
        _: f64,
        theta: &[f64],
        dtheta: &[f64],
        tau: &mut [f64],
    ) -> std::result::Result<(), mozzi_sim::Error> {
        self.0.add_forces(theta, dtheta, tau);
        Ok(())
    }

    fn gains(&self, stiffness: &mut [f64], damping: &mut [f64]) {
        self.0.gains(stiffness, damping);
    }
}

/// The default time constant of controllers, s.
const RESPONSE: f64 = 0.1;

#[derive(Args, Debug)]
pub struct MotorArguments {
    /// The first table whose times are counted from its first row, and that row's time, s.
    #[arg(skip)]
    origin: OnceCell<(String, f64)>,
    /// Motor torques: zero, gravity-compensation, actuators (those of an MJCF file with the controls of --state, and
    /// its gravity compensation), numbers τ1,τ2,… that stay, or a table with columns t, tau_1, … (interpolated
    /// linearly); added to a controller's [default: actuators if the file has some that act, else zero]
    #[arg(long, alias = "tau", value_name = "FILE|τ1,τ2,…|zero|gravity-compensation|actuators")]
    pub torque: Option<String>,
    /// Reference for the controller: a table with columns t, theta_1, … and optionally dtheta_, ddtheta_; with a
    /// floating base only the joints are followed, and the base's columns may be missing
    #[arg(long, value_name = "FILE", requires = "controller")]
    pub follow: Option<String>,
    /// A controller by its name (pd-gravity, computed-torque, task-space, impedance, standing), or in a JSON file;
    /// without --follow it holds the initial positions
    #[arg(long, value_name = "NAME|FILE.json")]
    pub controller: Option<String>,
    /// Time constant of a controller's gains that no file gives, s: errors fall as in ë + 2ω ė + ω² e = 0 with ω = 1/T
    /// [default: 0.1]
    #[arg(long, value_name = "T", requires = "controller")]
    response: Option<String>,
    /// How to treat the motors' effort limits
    #[arg(long, value_name = "WHAT", default_value = "report")]
    pub effort_limits: Limit,
    /// Wrench that the tip applies to the environment, in its frame, moment first: a table with columns t, m_x, …
    /// f_z, or six numbers
    #[arg(long, value_name = "FILE|mx,my,mz,fx,fy,fz")]
    pub tip_wrench: Option<String>,
    /// How to extrapolate a table of --torque or --tip-wrench outside its time range; at the end of --follow the robot
    /// is held
    #[arg(long, value_name = "WHAT", default_value = "error")]
    extrapolate: Beyond,
}

/// How limits are treated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Limit {
    /// Ignore limits
    Ignore,
    /// Let the robot exceed limits and report it
    Report,
    /// Enforce limits and report it
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
    /// Refuse with an error
    Error,
    /// Use the nearest row
    Hold,
    /// Use zeros
    Zero,
}

impl MotorArguments {
    /// The reference table, if there is one.
    pub fn followed(&self, model: &Model) -> Result<Option<Followed>> {
        let Some(file) = &self.follow else { return Ok(None) };
        let fixed = model.with_base(Base::Fixed)?;
        let (samples, is_of_joints) = table_file::read_joints(file, model, &fixed, &motion::HOW)?;
        let samples = motion::mended(samples, if is_of_joints { &fixed } else { model })?;
        motion::check(&samples)?;
        self.agree(&samples)?;
        let times = samples.times()?;
        let theta = samples.need("theta", model)?;
        // does the table describe the base and the joints, or the joints only?
        let whole = if is_of_joints { Base::Fixed } else { model.base() };
        let joints = |table: &[f64], base: usize| -> Vec<Vec<f64>> {
            table.chunks(table.len() / samples.count).map(|row| row[base..].to_vec()).collect()
        };
        let [dtheta, ddtheta] =
            ["dtheta", "ddtheta"].map(|name| samples.tables.get(name).map(|table| joints(table, whole.velocities())));
        let place = |error: mozzi_motion::Error| Failure::wrong(format!("{file}: {error}"));
        let (theta, pose) = (joints(theta, whole.positions()), theta.first_chunk().copied());
        if dtheta.is_none() && moves_at_ends(times, &theta) {
            failure::note(&format!(
                "{file}: without velocities the motion is from rest to rest; it moves at its ends: add columns dtheta_ …"
            ));
        }
        let recorded = Recorded::new(&fixed, times, &theta, dtheta.as_deref(), ddtheta.as_deref()).map_err(place)?;
        if !model.is_floating() {
            let start = recorded.at(0.0);
            return Ok(Some(Followed { start: [start.theta, start.dtheta], reference: Box::new(recorded) }));
        }
        let home = model.start().theta.first_chunk().copied();
        let pose = if is_of_joints { home } else { pose }.unwrap_or_default();
        let reference = OfJoints { joints: recorded, pose };
        let mut start = reference.at(0.0);
        if let (false, Some(table)) = (is_of_joints, samples.tables.get("dtheta")) {
            start.dtheta[..6].copy_from_slice(&table[..6]);
        }
        failure::note(&format!(
            "{file}: the joints are followed; nothing drives the base, which begins {}",
            if is_of_joints { "where the robot starts" } else { "as the first row says" }
        ));
        Ok(Some(Followed { start: [start.theta, start.dtheta], reference: Box::new(reference) }))
    }

    /// The actuators of an MJCF file and its gravity compensation, with the controls of a state: if --torque requests
    /// them, or without --torque and --controller if they act.
    pub fn actuated(&self, robot: &RobotArguments, model: &Model, state: Option<&str>) -> Result<Option<Actuators>> {
        let is_asked = self.torque.as_deref() == Some(ACTUATORS);
        if !is_asked && (self.torque.is_some() || self.controller.is_some()) {
            return Ok(None);
        }
        let (xacro, file) = (robot.settings().xacro, &*robot.model);
        let found = match file {
            "-" => {
                let text = input::robot_text().map_err(|error| input::cannot(file, &error))?;
                mjcf::actuation_of(None, input::name(file), text, &xacro)
            }
            file => mjcf::actuation(file, &xacro)?,
        };
        for line in found.left_out.iter().take(MOST_NOTES) {
            failure::note(line);
        }
        if found.left_out.len() > MOST_NOTES {
            failure::note(&format!("and {} more actuators are not computed", found.left_out.len() - MOST_NOTES));
        }
        let count = found.actuators.iter().flatten().count();
        if is_asked && count == 0 && found.compensated.is_empty() {
            return Err(Failure::wrong(format!(
                "--torque actuators: {} has no actuators that are computed, expected MJCF with <actuator>",
                input::name(file)
            )));
        }
        let controls = state.and_then(|name| found.controls.get(name));
        let actuated = Actuated::new(model, &found, controls.map_or(&[], Vec::as_slice))?;
        if !is_asked && !actuated.acts() {
            return Ok(None);
        }
        let with = match (state, controls) {
            (Some(name), Some(_)) => format!("the controls of state `{name}`"),
            _ => "controls of 0".to_string(),
        };
        let weights = match found.compensated.len() {
            0 => None,
            1 => Some("the weight of 1 link is compensated".to_string()),
            many => Some(format!("the weights of {many} links are compensated")),
        };
        let motors = (count > 0).then(|| format!("the file's actuators ({count}) drive the robot with {with}"));
        let told = motors.into_iter().chain(weights).collect::<Vec<_>>().join(", and ");
        failure::note(&format!("{told}; --torque zero leaves this out"));
        Ok(Some(Actuators(actuated)))
    }

    pub fn controller(&self, robot: &RobotArguments) -> Result<Option<Controller>> {
        let response = self.response.as_deref().map_or(Ok(RESPONSE), |text| number("--response", text))?;
        self.controller.as_deref().map(|name| Controller::read(name, response, robot)).transpose()
    }

    /// The torques of --torque and of the controller.
    pub fn motors<'a>(
        &self,
        model: &'a Model,
        controller: Option<&'a Controller>,
        reference: &'a dyn Reference,
        contacts: &Contacts,
        end: f64,
    ) -> Result<Box<dyn Input + 'a>> {
        let given: Box<dyn Input + 'a> = match self.torque.as_deref() {
            None | Some("zero" | ACTUATORS) => Box::new(Zero),
            Some("gravity-compensation" | "gravity" | "gravity_compensation") => {
                Box::new(GravityCompensation::new(model))
            }
            Some(list) if !std::path::Path::new(list).exists() && list.split(',').all(is_number) => {
                let constant = numbers_for("--torque", list, model.velocity_names())?;
                Box::new(mozzi_sim::torque(move |_, _, _, tau| tau.copy_from_slice(&constant)))
            }
            Some(file) => {
                let samples = table_file::read(file, model)?;
                let values = samples.need("tau", model)?.to_vec();
                Box::new(TorqueTable(self.table(&samples, values, end)?))
            }
        };
        match controller {
            None => Ok(given),
            Some(controller) => Ok(Box::new((given, controller.follow(model, reference, contacts)?))),
        }
    }

    pub fn wrench<'m>(&self, model: &'m Model, end: f64) -> Result<Box<dyn Input + 'm>> {
        let Some(text) = self.tip_wrench.as_deref() else { return Ok(Box::new(Zero)) };
        let tip = model.end_effector()?;
        if !std::path::Path::new(text).exists() && text.contains(',') {
            let F = Wrench::from_array(array("--tip-wrench", text, WRENCH)?);
            return Ok(Box::new(mozzi_sim::applied(tip, move |_, _, _| F)));
        }
        let samples = table_file::read(text, model)?;
        let values = samples.need("wrench", model)?.to_vec();
        Ok(Box::new(WrenchTable(tip, self.table(&samples, values, end)?)))
    }

    /// Tables whose times are counted from their first rows must begin together.
    fn agree(&self, samples: &Samples) -> Result<()> {
        let Samples { file, start, .. } = samples;
        if *start == 0.0 {
            return Ok(());
        }
        let (first, begin) = self.origin.get_or_init(|| (file.clone(), *start));
        if begin == start {
            return Ok(());
        }
        Err(Failure::wrong(format!(
            "{first} begins at t = {begin} s, and {file} at {start} s: times are counted from the first row of each; \
             subtract one time from both"
        )))
    }

    fn table(&self, samples: &Samples, values: Vec<f64>, end: f64) -> Result<Table> {
        let outside = match self.extrapolate {
            Beyond::Error => Outside::Error,
            Beyond::Hold => Outside::Hold,
            Beyond::Zero => Outside::Zero,
        };
        let times = samples.times()?;
        motion::check(samples)?;
        if samples.start != 0.0 {
            failure::note(&format!("{}: times are counted from the first row, t = {} s", samples.file, samples.start));
        }
        self.agree(samples)?;
        let [first, last] = [times.first(), times.last()].map(|t| t.copied().unwrap_or(0.0));
        if matches!(self.extrapolate, Beyond::Error) && (first > 0.0 || last < end * (1.0 - 1e-12)) {
            return Err(Failure::wrong(format!(
                "{} covers t = {first} s to {last} s, expected 0 s to {end} s; shorten --time, or use --extrapolate hold or zero",
                samples.file
            )));
        }
        Ok(Table::new(times.to_vec(), values)?.outside(outside))
    }
}

/// True if positions of 20 rows or more move at the first or last one with a tenth of their largest speed.
fn moves_at_ends(times: &[f64], theta: &[Vec<f64>]) -> bool {
    let speed = |k: usize| {
        let ways = theta[k + 1].iter().zip(&theta[k]).map(|(b, a)| (b - a).abs());
        ways.fold(0.0, f64::max) / (times[k + 1] - times[k])
    };
    let steps = times.len().saturating_sub(1);
    let most = (0..steps).map(speed).fold(0.0, f64::max);
    steps >= 19 && speed(0).max(speed(steps - 1)) > 0.1 * most
}

/// A reference table.
pub struct Followed {
    pub reference: Box<dyn Reference>,
    /// θ and θ̇ at its beginning.
    pub start: [Vec<f64>; 2],
}

/// Without a reference, the initial positions are held.
pub fn or_hold<'a>(followed: Option<&'a Followed>, hold: &'a Hold) -> &'a dyn Reference {
    match followed {
        Some(followed) => &*followed.reference,
        None => hold,
    }
}

/// The rates d/M_jj of each velocity at which damping of the joints and of a controller acts, 1/s; or √(k/M_jj), if
/// that is larger.
pub fn damping_rates(model: &Model, inputs: &[&dyn Input], theta: &[f64]) -> Result<Vec<f64>> {
    let M = model.mass_matrix(theta)?;
    let (mut stiffness, mut damping) = (vec![0.0; model.n()], vec![0.0; model.n()]);
    inputs.iter().for_each(|input| input.gains(&mut stiffness, &mut damping));
    damping.iter_mut().zip(model.damping()).for_each(|(sum, own)| *sum += own);
    let rate = |j: usize| (damping[j] / M[(j, j)]).max((stiffness[j] / M[(j, j)]).sqrt());
    Ok((0..model.n()).map(rate).collect())
}

/// The joint with the largest rate, if a step cannot resolve it.
pub fn stiffest(rates: &[f64], step: f64) -> Option<usize> {
    let fastest = (0..rates.len()).max_by(|&a, &b| rates[a].total_cmp(&rates[b]));
    fastest.filter(|&j| rates[j] * step > 1.0)
}
