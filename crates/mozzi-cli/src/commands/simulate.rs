//! `mozzi simulate`: forward dynamics, integrated.

use crate::columns::Columns;
use crate::failure::{Failure, Result};
use crate::json;
use crate::log;
use crate::numbers::{WRENCH, array, number};
use crate::report::{self, MeshArguments};
use crate::robot::{RobotArguments, Units};
use crate::samples::{ENERGIES, Samples, first_column};
use crate::state::StartArguments;
use crate::text::{Decimals, Page, about, scalar, table};
use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use mozzi::simulation::{
    self, Friction, GravityCompensation, Input, Method, Options, Outside, Table, TorqueTable, WrenchTable, Zero,
};
use mozzi::{Model, Trajectory, Wrench};
use serde_json::{Value, json};
use std::ops::ControlFlow;

/// Rows of the table on the screen.
const SHOWN: usize = 20;

#[derive(Args, Debug)]
pub struct SimulateArguments {
    #[command(flatten)]
    robot: RobotArguments,
    #[command(flatten)]
    start: StartArguments,
    /// How a step is taken
    #[arg(long, default_value = "rk4")]
    method: Way,
    /// Longest step, s
    #[arg(long, value_name = "SECONDS", default_value = "0.001", allow_hyphen_values = true)]
    step: String,
    /// How long, s
    #[arg(long, value_name = "SECONDS", default_value = "2", allow_hyphen_values = true)]
    time: String,
    /// The motors: zero, gravity-compensation, or a CSV file with columns t, tau_1, … (linear in between)
    #[arg(long, value_name = "FILE|zero|gravity-compensation", default_value = "zero")]
    torque: String,
    /// What the tip applies to the environment, in its frame, moment first: a CSV file with columns t, m_x, … f_z, or six numbers
    #[arg(long, value_name = "FILE|mx,my,mz,fx,fy,fz", allow_hyphen_values = true)]
    tip_wrench: Option<String>,
    /// What a table says before its first and after its last time
    #[arg(long, value_name = "WHAT", default_value = "error")]
    outside: Beyond,
    /// Make Coulomb friction smooth: μ tanh(θ̇/v_s) with this v_s, rad/s or m/s
    #[arg(long, value_name = "V_S", allow_hyphen_values = true)]
    slip_speed: Option<String>,
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

pub fn run(arguments: &SimulateArguments) -> Result<String> {
    arguments.out.as_deref().map(log::Format::of).transpose()?; // before the motion, which may take long
    let model = arguments.robot.load()?;
    let (theta, dtheta) = arguments.start.read(&model)?;
    let options = arguments.options()?;
    let input = (arguments.torque(&model)?, arguments.wrench(&model)?);
    let motion = simulate(&model, &theta, &dtheta, input, &options)?;
    if let Some(file) = arguments.out.as_deref().filter(|file| *file != "-") {
        log::write(file, &model, &motion)?;
    }
    let said =
        arguments.report.as_deref().map(|file| arguments.write_report(file, &model, &motion, &options)).transpose()?;
    match arguments.out.as_deref() {
        Some("-") => Ok(columns(&model, &motion).text()),
        _ if arguments.robot.json => Ok(json::print(&object(&model, &motion, &options))),
        file => {
            let said = said.map(|line| line + "\n").unwrap_or_default();
            Ok(page(&model, &motion, &options, &arguments.torque, file) + &said)
        }
    }
}

impl SimulateArguments {
    fn options(&self) -> Result<Options> {
        let (step, time) = (number("--step", &self.step)?, number("--time", &self.time)?);
        let method = match self.method {
            Way::Euler => Method::Euler,
            Way::SemiImplicitEuler => Method::SemiImplicitEuler,
            Way::Rk4 => Method::RungeKutta4,
        };
        let friction = match &self.slip_speed {
            None => Friction::Coulomb,
            Some(text) => Friction::Smooth { slip_speed: number("--slip-speed", text)? },
        };
        Ok(Options { method, friction, record_every: self.record_every, ..Options::with_step(time, step)? })
    }

    fn write_report(&self, file: &str, model: &Model, motion: &Trajectory, options: &Options) -> Result<String> {
        let (method, time) = (options.method.name(), scalar(options.duration));
        let title = format!("{method}, {time} s in {} steps, motors: {}", motion.steps, self.torque);
        let motion = report::simulated(title, motion, self.wrench(model)?)?;
        self.meshes.write(file, &self.robot.model, model, Some(&motion))
    }

    fn torque<'m>(&self, model: &'m Model) -> Result<Box<dyn Input + 'm>> {
        match self.torque.as_str() {
            "zero" => Ok(Box::new(Zero)),
            "gravity-compensation" => Ok(Box::new(GravityCompensation::new(model))),
            file => {
                let samples = Samples::read(file, model)?;
                let values = samples.need(&samples.tau, &first_column(model, "tau"))?.concat();
                Ok(Box::new(TorqueTable(self.table(&samples, values)?)))
            }
        }
    }

    fn wrench<'m>(&self, model: &'m Model) -> Result<Box<dyn Input + 'm>> {
        let Some(text) = self.tip_wrench.as_deref() else { return Ok(Box::new(Zero)) };
        let tip = model.end_effector()?;
        if !std::path::Path::new(text).exists() && text.contains(',') {
            let F = Wrench::from_array(array("--tip-wrench", text, WRENCH)?);
            return Ok(Box::new(simulation::applied(tip, move |_, _, _| F)));
        }
        let samples = Samples::read(text, model)?;
        let list = samples.need(&samples.tip_wrench, "m_x m_y m_z f_x f_y f_z")?;
        let values = list.iter().flat_map(|F| F.to_array()).collect();
        Ok(Box::new(WrenchTable(tip, self.table(&samples, values)?)))
    }

    fn table(&self, samples: &Samples, values: Vec<f64>) -> Result<Table> {
        let outside = match self.outside {
            Beyond::Error => Outside::Error,
            Beyond::Hold => Outside::Hold,
            Beyond::Zero => Outside::Zero,
        };
        let times = samples.need(&samples.t, "t")?;
        if let Some(row) = (1..times.len()).find(|&row| times[row] <= times[row - 1]) {
            let (place, t, before) = (samples.place(row), times[row], times[row - 1]);
            return Err(Failure::wrong(format!("{place}: t is {t} after {before}, expected times that increase")));
        }
        let [first, last] = [times.first(), times.last()].map(|t| t.copied().unwrap_or(0.0));
        let end = number("--time", &self.time)?;
        if matches!(self.outside, Beyond::Error) && (first > 0.0 || last < end * (1.0 - 1e-12)) {
            return Err(Failure::wrong(format!(
                "{} covers t = {first} s to {last} s, expected 0 s to {end} s; shorten --time, or say --outside hold or zero",
                samples.file
            )));
        }
        Ok(Table::new(times.clone(), values)?.outside(outside))
    }
}

/// With progress on standard error, where that is a terminal.
pub fn simulate(
    model: &Model,
    theta: &[f64],
    dtheta: &[f64],
    input: impl Input,
    options: &Options,
) -> Result<Trajectory> {
    let bar = ProgressBar::new(options.steps as u64);
    if let Ok(style) = ProgressStyle::with_template("{msg:22} {bar:40} {pos}/{len} steps, {eta} left") {
        bar.set_style(style);
    }
    bar.set_message(options.method.name());
    let motion = model.simulate_with_progress(theta, dtheta, input, options, |done, _| {
        bar.set_position(done as u64);
        ControlFlow::Continue(())
    });
    bar.finish_and_clear();
    Ok(motion?)
}

/// The motion by columns, as it goes to a file.
pub fn columns(model: &Model, motion: &Trajectory) -> Columns {
    let mut columns = Columns::default();
    let group = |values: &[f64], n: usize| values.chunks(n.max(1)).map(<[f64]>::to_vec).collect::<Vec<_>>();
    columns.add("t", motion.t.clone());
    columns.add_group(model, "theta", &group(&motion.theta, motion.nq));
    columns.add_group(model, "dtheta", &group(&motion.dtheta, motion.n));
    columns.add_group(model, "ddtheta", &group(&motion.ddtheta, motion.n));
    columns.add_group(model, "tau", &group(&motion.tau, motion.n));
    for (name, values) in ENERGIES.iter().zip(energies(motion)) {
        columns.add(*name, values);
    }
    columns
}

pub fn energies(motion: &Trajectory) -> [Vec<f64>; 5] {
    let of = |pick: fn(&simulation::Energy) -> f64| motion.energy.iter().map(pick).collect();
    [of(|e| e.kinetic), of(|e| e.potential), of(|e| e.motor_work), of(|e| e.friction_loss), of(|e| e.applied_work)]
}

fn object(model: &Model, motion: &Trajectory, options: &Options) -> Value {
    let lists = |values: &[f64], n: usize| values.chunks(n.max(1)).map(json::vector).collect::<Value>();
    let [kinetic, potential, motor, friction, applied] = energies(motion).map(|list| json::vector(&list));
    json::of_robot(
        model,
        json!({
            "method": options.method.name(),
            "step": options.step(),
            "steps": motion.steps,
            "t": json::vector(&motion.t),
            "theta": lists(&motion.theta, motion.nq),
            "dtheta": lists(&motion.dtheta, motion.n),
            "ddtheta": lists(&motion.ddtheta, motion.n),
            "tau": lists(&motion.tau, motion.n),
            "kinetic_energy": kinetic,
            "potential_energy": potential,
            "motor_work": motor,
            "friction_loss": friction,
            "applied_work": applied,
            "largest_drift": motion.largest_drift(),
        }),
    )
}

/// Positions that a row has room for: eight, or a free base's seven.
fn shown_positions(model: &Model) -> usize {
    match model.base().positions() {
        0 => 8,
        base => base,
    }
}

/// Some rows of a motion: t, θ, 𝒦, 𝒫, drift.
pub fn rows(model: &Model, motion: &Trajectory, shown: usize) -> Vec<String> {
    let (last, n) = (motion.len() - 1, motion.nq.min(shown_positions(model)));
    let picked: Vec<usize> = (0..=shown).map(|k| k * last / shown.max(1)).collect();
    let mut picked = picked;
    picked.dedup();
    let positions: Vec<String> = match model.is_floating() {
        true => model.position_names().take(n).map(str::to_string).collect(),
        false => (1..=n).map(|j| format!("θ_{j}")).collect(),
    };
    let heads = positions.into_iter().chain(["K [J]", "P [J]", "drift [J]"].map(str::to_string));
    let mut cells = vec![std::iter::once("t [s]".to_string()).chain(heads).collect::<Vec<_>>()];
    let decimals = |pick: &dyn Fn(usize) -> f64| Decimals::of(&picked.iter().map(|&k| pick(k)).collect::<Vec<_>>());
    let theta = Decimals::of(picked.iter().flat_map(|&k| &motion.sample(k).theta[..n]));
    let [time, kinetic, potential] = [
        decimals(&|k| motion.t[k]),
        decimals(&|k| motion.energy[k].kinetic),
        decimals(&|k| motion.energy[k].potential),
    ];
    for &k in &picked {
        let sample = motion.sample(k);
        let mut row = vec![time.show(sample.t)];
        row.extend(sample.theta.iter().take(n).map(|&x| theta.show(x)));
        row.extend([kinetic.show(sample.energy.kinetic), potential.show(sample.energy.potential)]);
        row.push(about(motion.drift(k)));
        cells.push(row);
    }
    table(&cells, "r")
}

fn page(model: &Model, motion: &Trajectory, options: &Options, torque: &str, file: Option<&str>) -> String {
    let mut page = Page::default();
    page.line(format!(
        "{} for {} s by {}, {} steps of {} s, motors: {torque}",
        model.description().name,
        scalar(options.duration),
        options.method.name(),
        motion.steps,
        scalar(options.step()),
    ));
    page.blank().lines(&rows(model, motion, SHOWN));
    let shown = shown_positions(model);
    if model.nq() > shown {
        let what = if model.is_floating() { "positions" } else { "joints" };
        page.lines(&[format!("… the first {shown} of {} {what}; --out FILE.csv or --json gives all", model.nq())]);
    }
    let end = motion.last().energy;
    page.blank().line(format!("θ in {}; K kinetic, P potential energy", Units::of(model).position));
    page.line(format!(
        "work since the start: motors {} J, lost in friction {} J, given to the environment {} J",
        scalar(end.motor_work),
        scalar(end.friction_loss),
        scalar(end.applied_work)
    ));
    page.line(format!(
        "drift: energy that the method made or lost, at most {} J, against {} J of kinetic energy",
        about(motion.largest_drift()),
        scalar(motion.largest_kinetic_energy())
    ));
    if let Some(file) = file {
        page.line(format!("{} rows written to {file}", motion.len()));
    }
    page.end()
}
