//! `mozzi simulate`: forward dynamics, integrated.

use super::outcome::Outcome;
use super::simulate_page::{columns, object, page, told};
use crate::conditions::{EventArguments, happened};
use crate::controller::Controller;
use crate::failure::{self, Failure, Result};
use crate::motors::{Followed, Limit, MotorArguments, or_hold};
use crate::numbers::number;
use crate::progress::Progress;
use crate::report::{self, MeshArguments};
use crate::robot::RobotArguments;
use crate::state::StartArguments;
use crate::text::scalar;
use crate::{interrupt, json, log};
use clap::{Args, ValueEnum};
use mozzi::Model;
use mozzi::quantities::ForwardDynamics;
use mozzi::simulation::{Friction, Input, Method, Options};
use mozzi_batch::{Compiled, Engine, compile};
use mozzi_motion::controllers::{Saturated, tracking_error};
use mozzi_motion::integrators::{Event, Integrator, Run, Simulation};
use mozzi_motion::trajectories::Hold;
use std::ops::ControlFlow;

#[derive(Args, Debug)]
pub struct SimulateArguments {
    #[command(flatten)]
    robot: RobotArguments,
    #[command(flatten)]
    start: StartArguments,
    /// How a step is taken
    #[arg(long, default_value = "rk4")]
    method: Way,
    /// Longest step, s; of dopri the time between two rows
    #[arg(long, value_name = "SECONDS", default_value = "0.001", allow_hyphen_values = true)]
    step: String,
    /// Of dopri: the largest estimated error of a step
    #[arg(long, value_name = "EPS", default_value = "1e-9", allow_hyphen_values = true)]
    tolerance: String,
    /// How long, s [default: as long as what is followed, else 2]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    time: Option<String>,
    #[command(flatten)]
    motors: MotorArguments,
    /// What is made of the joints' position limits; where they are respected a joint comes to rest at its limit
    #[arg(long, value_name = "WHAT", default_value = "report")]
    joint_limits: Limit,
    #[command(flatten)]
    events: EventArguments,
    /// Make Coulomb friction smooth: μ tanh(θ̇/v_s) with this v_s, rad/s or m/s
    #[arg(long, value_name = "V_S", allow_hyphen_values = true)]
    slip_speed: Option<String>,
    /// Forward dynamics by machine code, made for the robot before it moves: each step the same to rounding, in a fraction of the time
    #[arg(long)]
    compiled: bool,
    /// Record every K-th step
    #[arg(long, value_name = "K", default_value_t = 1)]
    record_every: usize,
    /// Write the motion to a file, by its ending: .csv ("-": standard output), .npy, .npz, .arrow, .feather; .parquet and .mcap where
    /// the program was built with these features. Columns t, theta_1 … tau_n, energies and works
    #[arg(long, value_name = "FILE")]
    out: Option<String>,
    /// Write the motion as a page to look at: the robot in 3-D, plots, one HTML file that needs no network
    #[arg(long, value_name = "FILE.html")]
    report: Option<String>,
    #[command(flatten)]
    meshes: MeshArguments,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Way {
    /// The book's: order 1
    Euler,
    /// Velocities first: order 1, energy stays bounded
    SemiImplicitEuler,
    /// Runge-Kutta of order 4
    Rk4,
    /// Dormand-Prince of order 5, steps by tolerance
    Dopri,
    /// Implicit midpoint in (θ, p): order 2, symplectic, energy stays bounded
    Midpoint,
}

pub fn run(arguments: &SimulateArguments) -> Result<String> {
    arguments.out.as_deref().map(log::Format::of).transpose()?; // before the motion, which may take long
    let model = arguments.robot.load()?;
    let outcome = arguments.simulate(&model)?;
    if let Some(file) = arguments.out.as_deref().filter(|file| *file != "-") {
        log::write(file, &model, &outcome.motion)?;
    }
    let said = arguments.report.as_deref().map(|file| arguments.write_report(file, &model, &outcome)).transpose()?;
    let text = match arguments.out.as_deref() {
        Some("-") => {
            told(&outcome).iter().for_each(|line| failure::note(line));
            columns(&model, &outcome.motion).text()
        }
        _ if arguments.robot.json => json::print(&object(&model, &outcome)),
        file => {
            let said = said.map(|line| line + "\n").unwrap_or_default();
            page(&model, &outcome, file) + &said
        }
    };
    if outcome.motion.complete || outcome.is_ended() {
        return Ok(text);
    }
    let last = outcome.motion.last().t;
    failure::note(&format!(
        "stopped by Ctrl-C at t = {last} s of {} s; this is the motion until then",
        outcome.duration
    ));
    Err(Failure::Stopped(text))
}

impl SimulateArguments {
    fn simulate(&self, model: &Model) -> Result<Outcome> {
        let followed = self.motors.followed(model)?;
        let (mut theta, mut dtheta) = self.start.read(model)?;
        if let (None, Some(Followed { start, .. })) = (&self.start.theta, &followed) {
            theta.clone_from(&start[0]);
            if self.start.dtheta.is_none() {
                dtheta.clone_from(&start[1]);
            }
        }
        let hold = Hold::new(&theta, model.n());
        let controller = self.motors.controller(&self.robot)?;
        let end = match (&self.time, &followed) {
            (Some(text), _) => number("--time", text)?,
            (None, Some(followed)) => followed.reference.duration(),
            (None, None) => 2.0,
        };
        let motors = self.motors.motors(model, controller.as_ref(), or_hold(followed.as_ref(), &hold), end)?;
        let mut motors = Saturated::new(model, motors, self.motors.effort_limits.into());
        let input = (&mut motors, self.motors.wrench(model, end)?);
        let events = self.events.events(model, [&theta, &dtheta])?;
        let (Run { motion, events, stops }, method, step) =
            self.integrate(model, [&theta, &dtheta], input, end, events)?;
        Ok(Outcome {
            method,
            step,
            duration: end,
            motors: controller.as_ref().map_or_else(|| self.motors.torque.clone(), Controller::name),
            overloads: motors.overloads().cloned().collect(),
            stops,
            missed: self.events.missed(&events),
            events,
            tracking: followed.as_ref().map(|followed| tracking_error(model, &motion, &followed.reference)),
            motion,
        })
    }

    /// Where it was asked for; what it will not compute is said.
    fn machine_code(&self, model: &Model) -> Result<Option<Compiled>> {
        if !self.compiled {
            return Ok(None);
        }
        let robot = compile(model, &[ForwardDynamics.into()])?;
        if let Engine::Kernels(refusal) = robot.engine(ForwardDynamics) {
            failure::note(&format!("--compiled: not by machine code: {refusal}"));
        } else if self.motors.tip_wrench.is_some() {
            failure::note("--compiled: machine code knows no tip wrench; where there is one, the kernels compute");
        }
        Ok(Some(robot))
    }

    fn write_report(&self, file: &str, model: &Model, outcome: &Outcome) -> Result<String> {
        let (motion, method, motors) = (&outcome.motion, outcome.method, &outcome.motors);
        let happened: Vec<String> = std::iter::once(String::new()).chain(happened(&outcome.events)).collect();
        let (time, happened) = (scalar(motion.last().t), happened.join("; "));
        let title = format!("{method}, {time} s in {} steps, motors: {motors}{happened}", motion.steps);
        let motion = report::simulated(title, motion, self.motors.wrench(model, outcome.duration)?)?;
        self.meshes.write(file, &self.robot.model, model, Some(&motion))
    }

    fn integrate(
        &self,
        model: &Model,
        [theta, dtheta]: [&[f64]; 2],
        input: impl Input,
        end: f64,
        events: Vec<Event>,
    ) -> Result<(Run, &'static str, f64)> {
        let step = number("--step", &self.step)?;
        let friction = match &self.slip_speed {
            None => Friction::Coulomb,
            Some(text) => Friction::Smooth { slip_speed: number("--slip-speed", text)? },
        };
        let options = Options { friction, record_every: self.record_every, ..Options::with_step(end, step)? };
        // of a motion of no duration there is no shorter step
        let step = if end == 0.0 { step } else { options.step() };
        let integrator = match self.method {
            Way::Euler => Integrator::Fixed(Method::Euler, step),
            Way::SemiImplicitEuler => Integrator::Fixed(Method::SemiImplicitEuler, step),
            Way::Rk4 => Integrator::Fixed(Method::RungeKutta4, step),
            Way::Dopri => Integrator::DormandPrince { tolerance: number("--tolerance", &self.tolerance)? },
            Way::Midpoint => Integrator::Midpoint { step },
        };
        let robot = self.machine_code(model)?;
        let simulation = Simulation {
            integrator,
            forward_dynamics: robot.as_ref().and_then(Compiled::simulator),
            friction,
            stops: self.joint_limits.into(),
            record: step * self.record_every as f64,
            events,
            ..Simulation::new(end)
        };
        interrupt::listen();
        let progress = Progress::new(integrator.name(), options.steps, "steps of time");
        let run = simulation.run_with_progress(model, theta, dtheta, input, |t| {
            progress.at((t / end * options.steps as f64) as usize);
            if interrupt::asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })?;
        let shown = match integrator {
            Integrator::DormandPrince { tolerance } => tolerance,
            _ => step,
        };
        Ok((run, integrator.name(), shown))
    }
}
