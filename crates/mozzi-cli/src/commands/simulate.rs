//! `mozzi simulate`: forward dynamics, integrated.

use super::assemble::{assembled, with_other_starts};
use super::outcome::Outcome;
use super::simulate_page::{object, page, told};
use crate::angles;
use crate::conditions::{EventArguments, happened};
use crate::failure::{self, Failure, Result};
use crate::ground::{GroundArguments, settle};
use crate::motors::{ACTUATORS, Followed, Limit, MotorArguments, damping_rates, or_hold, stiffest};
use crate::numbers::number;
use crate::progress::Progress;
use crate::report::{self, PageArguments};
use crate::robot::RobotArguments;
use crate::state::StartArguments;
use crate::tables::format::Format;
use crate::text::scalar;
use crate::workload::{self, BINARY, TEXT, Workload};
use crate::{input, interrupt, json, log};
use clap::{Args, ValueEnum};
use mozzi::Model;
use mozzi::model::Bounds;
use mozzi::model::description::ConstraintKind;
use mozzi::quantities::ForwardDynamics;
use mozzi_engine::{Compiled, Engine, compile};
use mozzi_motion::controllers::{Saturated, Tracking};
use mozzi_motion::trajectories::Hold;
use mozzi_report::{Motion, Touches};
use mozzi_sim::{
    Account, Contacts, Ending, Event, Friction, Input, Method, Options, Recorder, Simulation, Thinned, Trajectory, Zero,
};
use std::ops::ControlFlow;

#[derive(Args, Debug)]
pub struct SimulateArguments {
    #[command(flatten)]
    robot: RobotArguments,
    #[command(flatten)]
    start: StartArguments,
    #[command(flatten)]
    ground: GroundArguments,
    /// Integration method
    #[arg(long, alias = "integrator", default_value = "auto")]
    method: Way,
    /// Step size, s; dopri: the time between two rows
    #[arg(long, visible_alias = "dt", value_name = "SECONDS", default_value = "0.001")]
    step: String,
    /// dopri only: tolerance on the local error
    #[arg(long, value_name = "EPS", default_value = "1e-9")]
    tolerance: String,
    /// Duration, s [default: that of the --follow table, else 2]
    #[arg(long, alias = "duration", value_name = "SECONDS")]
    time: Option<String>,
    #[command(flatten)]
    motors: MotorArguments,
    /// How to treat position limits; if enforced, a joint stops at its limit [default: respect on the ground, else
    /// report]
    #[arg(long, value_name = "WHAT")]
    joint_limits: Option<Limit>,
    #[command(flatten)]
    events: EventArguments,
    /// Smooth Coulomb friction: μ tanh(θ̇/v_s) with this v_s, rad/s or m/s
    #[arg(long, value_name = "V_S")]
    slip_speed: Option<String>,
    /// Compute forward dynamics by machine code generated for this robot: equal up to rounding, two to three times as
    /// fast
    #[arg(long)]
    compiled: bool,
    /// Record every K-th step
    #[arg(long, value_name = "K", default_value_t = 1)]
    record_every: usize,
    /// Allow a motion of more than 1e9 steps or 16 GB
    #[arg(long)]
    allow_large: bool,
    /// Write the motion to a file, row by row; its ending chooses the format: .csv ("-": standard output), .npy, .npz,
    /// .arrow, .feather, .parquet and .mcap if built with these features. Columns t, theta_1 … tau_n, energies and
    /// works
    #[arg(long, value_name = "FILE")]
    out: Option<String>,
    /// Write the motion as one HTML file that needs no network: the robot in 3-D, and plots
    #[arg(long, value_name = "FILE.html")]
    report: Option<String>,
    #[command(flatten)]
    page: PageArguments,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Way {
    /// moreau if the robot has dry friction, contacts, limits to respect or stiff actuators, else rk4
    Auto,
    /// Moreau-Jean, for dry friction, stops and contacts: order 2 as long as no contact changes
    Moreau,
    /// Euler's method, as in the book: order 1
    Euler,
    /// Semi-implicit Euler, velocities first: order 1, energy stays bounded
    SemiImplicitEuler,
    /// Runge-Kutta, order 4
    Rk4,
    /// Dormand-Prince, order 5, adaptive steps
    Dopri,
    /// Implicit midpoint in (θ, p): order 2, symplectic, energy stays bounded
    Midpoint,
}

/// Where a motion starts, and what is known before it.
struct Start {
    theta: Vec<f64>,
    dtheta: Vec<f64>,
    followed: Option<Followed>,
    contacts: Contacts<'static>,
    limits: Limit,
}

/// Rows that are kept for the table on the screen.
const KEPT: usize = 20_000;

pub fn run(arguments: &SimulateArguments) -> Result<String> {
    json::unless_rows(arguments.robot.json, arguments.out.as_deref())?;
    arguments.out.as_deref().map(log::format).transpose()?; // checked before the motion, which may take long
    let mut start = None;
    let model = arguments.robot.load_at(|model| Ok(start.insert(arguments.started(model)?).theta.clone()))?;
    let start = start.map_or_else(|| arguments.started(&model), Ok)?;
    let outcome = arguments.simulate(&model, start)?;
    let said = arguments.report.as_deref().map(|file| arguments.write_report(file, &model, &outcome)).transpose()?;
    let text = match arguments.out.as_deref() {
        Some("-") => {
            told(&model, &outcome).iter().for_each(|line| failure::note(line));
            String::new() // the rows are written already
        }
        _ if arguments.robot.json => json::print(&object(&model, &outcome)),
        file => {
            let said = said.map(|line| line + "\n").unwrap_or_default();
            page(&model, &outcome, file) + &said
        }
    };
    if outcome.motion.complete || outcome.is_ended() || !interrupt::is_requested() {
        return Ok(text);
    }
    let last = outcome.motion.last().t;
    failure::note(&format!(
        "stopped by Ctrl-C at t = {last} s of {} s; this is the motion until then",
        outcome.duration
    ));
    Err(Failure::Stopped(text))
}

/// Moves the joints of a start that nobody gave, which are left out, into their limits.
fn within_limits(model: &Model, theta: &mut [f64], left_out: &[bool]) {
    let bounds = Bounds::of(model);
    for (k, joint) in model.joints().enumerate() {
        let value = bounds.value(theta, k);
        let is_own = bounds.places[k].positions().all(|q| left_out[q]);
        if let Some(limit) = is_own.then(|| bounds.put_within(theta, k)).flatten() {
            let (name, [limit, value]) = (&joint.name, [limit, value].map(|x| angles::of_joint(joint.kind, x)));
            failure::note(&format!("joint `{name}` starts at its limit {limit}: {value} is beyond"));
        }
    }
}

impl SimulateArguments {
    /// A motion that diverges because a joint is stiff: the joint, and the method that works.
    fn explained(&self, failure: Failure, model: &Model, theta: &[f64], rates: Option<&[f64]>) -> Failure {
        let Failure::Wrong(sentence) = &failure else { return failure };
        if !sentence.contains("diverged") || matches!(self.method, Way::Moreau) {
            return failure;
        }
        let own = damping_rates(model, &[], theta).ok();
        let (Some(rates), Ok(step)) = (rates.or(own.as_deref()), number("--step", &self.step)) else { return failure };
        match stiffest(rates, step) {
            None => failure,
            Some(j) => {
                let name = model.velocity_names().nth(j).unwrap_or_default();
                let (rate, step) = (scalar(rates[j].round()), scalar(0.5 / rates[j]));
                Failure::wrong(format!(
                    "{sentence}. `{name}` is stiff: its damping or gain acts at a rate of {rate} 1/s, too fast for this step; \
                     --method moreau takes it implicitly, --step {step} resolves it"
                ))
            }
        }
    }

    /// The start, before frames are pinned: loops are closed, then the base is put on the ground; but if a constraint
    /// holds the robot to {s}, the base is where the ground wants it first.
    fn started(&self, model: &Model) -> Result<Start> {
        workload::matrices(model)?;
        let followed = self.motors.followed(model)?;
        let (mut theta, mut dtheta) = self.start.read(model)?;
        if let (None, None, Some(Followed { start, .. })) = (&self.start.state, &self.start.theta, &followed) {
            theta.clone_from(&start[0]);
            if self.start.dtheta.is_none() {
                dtheta.clone_from(&start[1]);
            }
        }
        let contacts = self.ground.contacts(&self.robot, model)?;
        let left_out = if followed.is_none() { self.start.left_out(model) } else { vec![false; model.nq()] };
        let limits = self.joint_limits.unwrap_or(if contacts.is_empty() { Limit::Report } else { Limit::Respect });
        if limits == Limit::Respect {
            within_limits(model, &mut theta, &left_out);
        }
        let ground = self.ground.flag();
        let on_ground = |theta: &mut [f64]| match contacts.is_empty() {
            true => Ok(()),
            false => settle(ground, model, &contacts, theta, model.is_floating() && left_out[6]), // the base's z
        };
        let is_held = model.constraints().iter().any(|constraint| match &constraint.kind {
            ConstraintKind::Frames { a, b, .. } => a.frame.is_none() || b.frame.is_none(),
            ConstraintKind::Joint { .. } => false,
        });
        if is_held {
            on_ground(&mut theta)?;
        }
        (theta, dtheta) = assembled(model, theta, dtheta)
            .map_err(|why| with_other_starts(why, model, self.start.name(model), limits == Limit::Respect))?;
        if !is_held {
            on_ground(&mut theta)?;
        }
        Ok(Start { theta, dtheta, followed, contacts, limits })
    }

    fn simulate(&self, model: &Model, start: Start) -> Result<Outcome> {
        let Start { theta, dtheta, followed, contacts, limits } = start;
        let (theta, dtheta) = assembled(model, theta, dtheta)?; // with pinned frames
        let hold = Hold::new(&theta, model.n());
        let controller = self.motors.controller(&self.robot)?;
        let end = match (&self.time, &followed) {
            (Some(text), _) => number("--time", text)?,
            (None, Some(followed)) => followed.reference.duration(),
            (None, None) => 2.0,
        };
        let actuated = self.motors.actuated(&self.robot, model, self.start.name(model))?;
        let is_actuated = actuated.is_some();
        let actuated: Box<dyn Input> = match actuated {
            Some(actuated) => Box::new(actuated),
            None => Box::new(Zero),
        };
        let reference = or_hold(followed.as_ref(), &hold);
        let motors = self.motors.motors(model, controller.as_ref(), reference, &contacts, end)?;
        let gains = (self.motors.controller.is_some() || is_actuated)
            .then(|| damping_rates(model, &[&motors, &actuated], &theta))
            .transpose()?;
        let mut motors = Saturated::new(model, motors, self.motors.effort_limits.into()).of_steps();
        let input = ((&mut motors, actuated), self.motors.wrench(model, end)?);
        let events = self.events.events(model, [&theta, &dtheta])?;
        self.workload(model, end)?.check(self.allow_large)?;
        let mut options = self.options(end, limits)?;
        let stiff = gains.as_ref().and_then(|rates| Some((rates, stiffest(rates, options.step())?)));
        if let (Way::Auto, true, Some((rates, j))) = (self.method, is_actuated, stiff) {
            let (name, rate) = (model.velocity_names().nth(j).unwrap_or_default(), scalar(rates[j].round()));
            failure::note(&format!(
                "`{name}` is stiff: its actuator acts at a rate of {rate} 1/s; the method is moreau, which takes it implicitly"
            ));
            options.method = Method::MoreauJean;
        }
        let is_led = followed.is_some() || controller.is_some();
        let mut tracking = is_led.then(|| Tracking::new(model, &reference));
        let names: Vec<String> = contacts.names().collect();
        let (motion, account, ending, touches) = self
            .integrate(model, [&theta, &dtheta], input, options, (events, contacts), &mut tracking)
            .map_err(|failure| self.explained(failure, model, &theta, gains.as_deref()))?;
        let Ending { events, stops, closing, method, one_sided, contact_events, .. } = ending;
        Ok(Outcome {
            method,
            contacts: names,
            touches,
            one_sided,
            contact_events,
            // a motion of zero duration has no shorter step
            step: if end == 0.0 { number("--step", &self.step)? } else { options.step() },
            duration: end,
            account,
            motors: match (&controller, &self.motors.torque) {
                (Some(controller), _) => controller.name(),
                (None, Some(torque)) => torque.clone(),
                (None, None) => if is_actuated { ACTUATORS } else { "zero" }.to_string(),
            },
            overloads: motors.overloads().cloned().collect(),
            stops,
            closing: (model.constraint_rows() > 0).then_some(closing),
            missed: self.events.missed(&events),
            events,
            tracking: tracking.map(|tracking| tracking.error()),
            motion,
        })
    }

    /// Machine code, with --compiled; reports quantities that it does not compute.
    fn machine_code(&self, model: &Model) -> Result<Option<Compiled>> {
        if !self.compiled {
            return Ok(None);
        }
        if model.constraint_rows() > 0 {
            failure::note(
                "--compiled: machine code is not used: the robot has constraints; the kernels compute the steps",
            );
            return Ok(None);
        }
        let robot = compile(model, &[ForwardDynamics.into()])?;
        if let Engine::Kernels(refusal) = robot.engine(ForwardDynamics) {
            failure::note(&format!("--compiled: machine code is not used: {refusal}"));
        } else if self.motors.tip_wrench.is_some() {
            failure::note("--compiled: machine code does not support a tip wrench; the kernels compute steps with one");
        }
        Ok(Some(robot))
    }

    fn write_report(&self, file: &str, model: &Model, outcome: &Outcome) -> Result<String> {
        let (motion, method, motors) = (&outcome.motion, outcome.method.name(), &outcome.motors);
        let happened: Vec<String> = std::iter::once(String::new()).chain(happened(&outcome.events)).collect();
        let (time, happened) = (scalar(motion.last().t), happened.join("; "));
        let title = format!("{method}, {time} s in {} steps, motors: {motors}{happened}", motion.steps);
        let motion = report::simulated(title, motion, self.motors.wrench(model, outcome.duration)?)?;
        let motion = Motion { contacts: outcome.touches.clone(), ..motion };
        self.page.write(file, &self.robot, model, Some((motion, outcome.account.rows)))
    }

    fn options(&self, end: f64, limits: Limit) -> Result<Options> {
        let friction = match &self.slip_speed {
            None => Friction::Coulomb,
            Some(text) => Friction::Smooth { slip_speed: number("--slip-speed", text)? },
        };
        let method = match self.method {
            Way::Auto => Method::Automatic,
            Way::Moreau => Method::MoreauJean,
            Way::Euler => Method::Euler,
            Way::SemiImplicitEuler => Method::SemiImplicitEuler,
            Way::Rk4 => Method::RungeKutta4,
            Way::Dopri => Method::DormandPrince { tolerance: number("--tolerance", &self.tolerance)? },
            Way::Midpoint => Method::Midpoint,
        };
        let (record_every, joint_limits) = (self.record_every, limits.into());
        let options = Options::with_step(end, number("--step", &self.step)?)?;
        Ok(Options { method, friction, record_every, joint_limits, ..options })
    }

    /// The estimated work. Rows go to a file as they come; those for JSON and the page stay in memory.
    fn workload(&self, model: &Model, end: f64) -> Result<Workload> {
        // an invalid step or duration is refused later
        let step = number("--step", &self.step)?;
        let steps = if step > 0.0 { (end / step).ceil().max(0.0) } else { 0.0 };
        let rows = 1.0 + (steps / self.record_every.max(1) as f64).ceil();
        let kept = if self.robot.json { f64::INFINITY } else { self.page.rows(self.report.is_some()) as f64 };
        let numbers = log::Row::new(model).names().len() as f64;
        let in_memory = rows.min(kept) * numbers * BINARY;
        let is_text =
            self.out.as_deref().is_some_and(|file| log::format(file).is_ok_and(|format| format == Format::Csv));
        let written = if self.out.is_some() { rows * numbers * if is_text { TEXT } else { BINARY } } else { 0.0 };
        let (bytes, place) = match self.out.as_deref() {
            Some(file) if written >= in_memory => (written, input::name(file)),
            _ => (in_memory, "memory"),
        };
        let cause = format!("--step {}", self.step.trim());
        Ok(Workload { cause, steps, rows, bytes, place: place.to_string(), flag: Some("--allow-large") })
    }

    /// The motion, with its rows written as they come, and the rows that are kept.
    fn integrate(
        &self,
        model: &Model,
        [theta, dtheta]: [&[f64]; 2],
        input: impl Input,
        options: Options,
        (events, contacts): (Vec<Event>, Contacts),
        tracking: &mut impl Recorder,
    ) -> Result<(Trajectory, Account, Ending, Option<Touches>)> {
        options.check()?;
        let robot = self.machine_code(model)?;
        let forward_dynamics = robot.as_ref().and_then(Compiled::simulator);
        let simulation = Simulation { options, events, forward_dynamics, contacts };
        let rows = 1 + options.steps.div_ceil(options.record_every);
        let columns = || match self.ground.writes_forces() {
            true => log::Row::new(model).with_forces(&simulation.contacts),
            false => log::Row::new(model),
        };
        let mut log = self.out.as_deref().map(|file| log::Log::new(file, columns(), rows)).transpose()?;
        let kept = if self.robot.json { usize::MAX } else { self.page.rows(self.report.is_some()).max(KEPT) };
        let (mut kept, mut account) = (Thinned::new(model, kept), Account::default());
        interrupt::listen();
        let progress = Progress::new(options.method.name(), options.steps, "steps of time");
        let mut recorder = (&mut log, (&mut kept, (&mut account, tracking)));
        let ending = simulation.stream(model, theta, dtheta, input, &mut recorder, |t| {
            progress.at((t / options.duration * options.steps as f64) as usize);
            if interrupt::is_requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })?;
        drop(progress);
        log.map(log::Log::finish).transpose()?;
        let mut motion = kept.into_trajectory();
        (motion.steps, motion.complete) = (ending.steps, ending.complete);
        let touches = || report::touches(model, &simulation.contacts, &motion, &ending.contact_events);
        let touches = self.report.is_some().then(touches).transpose()?.flatten();
        Ok((motion, account, ending, touches))
    }
}
