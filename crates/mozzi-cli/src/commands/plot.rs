//! `mozzi plot`: figures for papers.

use crate::failure::{self, Failure, Result};
use crate::figure_file::{self, OutArguments};
use crate::json::print;
use crate::numbers::number;
use crate::progress::Progress;
use crate::report;
use crate::robot::RobotArguments;
use crate::state::{StartArguments, positions};
use crate::text::scalar;
use crate::workload::Workload;
use clap::{Args, Subcommand, ValueEnum};
use mozzi::Model;
use mozzi_motion::convergence::{self, Measured};
use mozzi_report::Motion;
use mozzi_report::figure::Figure;
use mozzi_report::pictures::{self, Convergence, Plane};
use serde_json::{Value, json};
use std::path::Path;

#[derive(Args, Debug)]
pub struct PlotArguments {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand, Debug)]
enum What {
    /// θ, θ̇, θ̈ and τ over time
    Trajectory(MotionArguments),
    /// Kinetic, potential and total energy over time
    Energy(MotionArguments),
    /// θ̇ over θ, joint by joint
    Phase(MotionArguments),
    /// Error of each method over its step and its work, without torques; Dormand-Prince for tolerances from 1e-3 on
    Convergence(ConvergenceArguments),
    /// Manipulability and force ellipses at the end effector, at one or more configurations
    Ellipsoids(EllipsoidArguments),
}

#[derive(Args, Debug)]
struct MotionArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// A table with columns t, theta_1 … and optionally others, as `mozzi simulate --out` writes it
    trajectory: String,
    /// A further run in the same figure, dashed; may be repeated
    #[arg(long, value_name = "TABLE")]
    with: Vec<String>,
    #[command(flatten)]
    out: OutArguments,
}

#[derive(Args, Debug)]
struct ConvergenceArguments {
    #[command(flatten)]
    robot: RobotArguments,
    #[command(flatten)]
    start: StartArguments,
    /// Duration of the motion, s
    #[arg(long, value_name = "SECONDS", default_value = "1")]
    time: String,
    /// Longest step, s
    #[arg(long, value_name = "SECONDS", default_value = "0.02")]
    step: String,
    /// How often the step is halved
    #[arg(long, value_name = "K", default_value_t = 6, value_parser = clap::value_parser!(u8).range(1..=12))]
    halvings: u8,
    #[command(flatten)]
    out: OutArguments,
}

#[derive(Args, Debug)]
struct EllipsoidArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// Positions θ, rad or m, or the name of a state; may be repeated [default: the robot's start, else joints at 0]
    #[arg(long, visible_alias = "q", aliases = ["qpos", "positions"], value_name = "θ1,θ2,…")]
    theta: Vec<String>,
    /// Plane of {s} to project on
    #[arg(long, value_name = "PLANE", default_value = "xz")]
    plane: View,
    #[command(flatten)]
    out: OutArguments,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum View {
    /// From above
    Xy,
    /// From the side
    Xz,
    /// From the front
    Yz,
}

pub fn run(arguments: &PlotArguments) -> Result<String> {
    match &arguments.what {
        What::Trajectory(arguments) => of_motion(arguments, Base::Omitted, pictures::trajectories),
        What::Energy(arguments) => of_motion(arguments, Base::Counted, |model, motion| {
            if motion.kinetic_energy.is_none() {
                failure::note("a motion has no dtheta: its kinetic energy is not drawn");
            }
            pictures::energy(model, motion)
        }),
        What::Phase(arguments) => of_motion(arguments, Base::Omitted, pictures::phase),
        What::Convergence(arguments) => convergence(arguments),
        What::Ellipsoids(arguments) => ellipsoids(arguments),
    }
}

/// Whether a figure of a motion contains a floating base.
#[derive(PartialEq)]
enum Base {
    Omitted,
    Counted,
}

fn of_motion(
    arguments: &MotionArguments,
    base: Base,
    draw: impl Fn(&Model, &Motion) -> std::result::Result<Figure, mozzi_report::Error>,
) -> Result<String> {
    let model = arguments.robot.load()?;
    if base == Base::Omitted && model.is_floating() {
        failure::note("the floating base is not drawn, only the joints");
    }
    let drawn = |file: &str| {
        let motion = Motion { title: model.description().name.clone(), ..report::read(file, &model)? };
        draw(&model, &motion).map_err(|error| Failure::wrong(format!("{file}: {error}")))
    };
    let mut figure = drawn(&arguments.trajectory)?;
    for file in &arguments.with {
        let name = Path::new(file).file_name().map_or_else(|| file.clone(), |name| name.to_string_lossy().into_owned());
        figure.add_run(&name, drawn(file)?);
    }
    Ok(told(&save(figure, &arguments.out)?, &arguments.robot, ""))
}

fn convergence(arguments: &ConvergenceArguments) -> Result<String> {
    let model = arguments.robot.load()?;
    let (theta, dtheta) = arguments.start.read(&model)?;
    let (time, step) = (number("--time", &arguments.time)?, number("--step", &arguments.step)?);
    let coarsest = mozzi_sim::Options::with_step(time, step)?.steps;
    let steps = coarsest as f64 * f64::from(1 << u32::from(arguments.halvings));
    let cause = format!("--step {} with --halvings {}", arguments.step.trim(), arguments.halvings);
    Workload { cause, steps, rows: 0.0, bytes: 0.0, place: "memory".into(), flag: None }.check(false)?;
    if model.has_dry_friction() {
        failure::note("dry friction is left out: the methods are those of smooth motions");
    }
    let mut progress = None;
    let found =
        convergence::convergence(&model, [&theta, &dtheta], time, coarsest, arguments.halvings.into(), |done, all| {
            progress.get_or_insert_with(|| Progress::new("convergence", all, "evaluations")).at(done);
        })?;
    drop(progress);
    let curve = |each: &convergence::Convergence| {
        let points = |x: fn(&Measured) -> f64| each.measured.iter().map(|of| [x(of), of.error]).collect::<Vec<_>>();
        let by_step = if each.is_adaptive() { Vec::new() } else { points(|of| of.step) };
        let by_work = points(|of| of.evaluations as f64);
        Convergence { name: each.name.into(), order: each.order, by_step, by_work }
    };
    let title = format!("{}, {} s", model.description().name, scalar(time));
    let figure = Convergence::figure(title, &found.iter().map(curve).collect::<Vec<_>>());
    let mut object = save(figure, &arguments.out)?;
    object["methods"] = found.iter().map(method).collect();
    let mut text = String::new();
    for each in &found {
        let by = if each.is_adaptive() { " by equal steps" } else { "" };
        let order = each
            .measured_order()
            .map_or("unknown: too few motions succeeded, or all errors are rounding".into(), |order| {
                format!("{order:.2}{by}")
            });
        text += &format!("{}: order {}, measured {order}\n", each.name, each.order);
    }
    Ok(told(&object, &arguments.robot, &text))
}

fn ellipsoids(arguments: &EllipsoidArguments) -> Result<String> {
    let model = arguments.robot.load()?;
    let mut configurations = Vec::new();
    for theta in &arguments.theta {
        configurations.push(positions("--theta", Some(theta), &model)?);
    }
    if configurations.is_empty() {
        configurations.push(positions("--theta", None, &model)?);
    }
    let plane = match arguments.plane {
        View::Xy => Plane::Xy,
        View::Xz => Plane::Xz,
        View::Yz => Plane::Yz,
    };
    let figure = pictures::ellipsoids(&model, &configurations, model.end_effector()?, plane)?;
    Ok(told(&save(figure, &arguments.out)?, &arguments.robot, ""))
}

/// A method's errors, for the given steps or tolerances.
fn method(each: &convergence::Convergence) -> Value {
    let points = |list: &[Measured]| -> Value {
        let point = |of: &Measured| json!({ "step": of.step, "evaluations": of.evaluations, "error": of.error });
        list.iter().map(point).collect()
    };
    json!({
        "method": each.name, "order": each.order, "measured_order": each.measured_order(),
        "adaptive": each.is_adaptive(), "measured": points(&each.measured), "equal_steps": points(&each.equal_steps),
    })
}

/// The written figure, in words or as JSON.
fn told(object: &Value, robot: &RobotArguments, more: &str) -> String {
    match robot.json {
        true => print(object),
        false => format!("wrote a figure to {}\n{more}", object["out"].as_str().unwrap_or_default()),
    }
}

fn save(figure: Figure, out: &OutArguments) -> Result<Value> {
    let title = out.title.clone().unwrap_or(figure.title);
    let object = json!({ "out": out.out, "title": title });
    let svg = Figure { title: title.clone(), ..figure }.svg();
    figure_file::save(&out.out, &title, svg)?;
    Ok(object)
}
