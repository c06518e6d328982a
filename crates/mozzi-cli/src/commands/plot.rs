//! `mozzi plot`: figures for papers.

use crate::columns;
use crate::failure::{Failure, Result};
use crate::numbers::number;
use crate::progress::Progress;
use crate::report;
use crate::robot::RobotArguments;
use crate::state::{StartArguments, positions};
use crate::text::scalar;
use clap::{Args, Subcommand, ValueEnum};
use mozzi::Model;
use mozzi_motion::integrators::{self, Measured};
use mozzi_report::Motion;
use mozzi_report::figure::Figure;
use mozzi_report::pictures::{self, Convergence, Plane};

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
    /// How the error of each method falls with its step and with the work, the motors being off; of Dormand-Prince by tolerances from 1e-3 on
    Convergence(ConvergenceArguments),
    /// Manipulability and force ellipses at the end effector, at one configuration or more
    Ellipsoids(EllipsoidArguments),
}

#[derive(Args, Debug)]
struct OutArguments {
    /// Where the figure goes: .svg, or .png where the program was built with the feature `png`
    #[arg(long, value_name = "FILE.svg")]
    out: String,
    /// What stands above it [default: what it shows]
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
}

#[derive(Args, Debug)]
struct MotionArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// A CSV file with columns t, theta_1 …, and what else is known; such as `mozzi simulate --out` writes
    trajectory: String,
    #[command(flatten)]
    out: OutArguments,
}

#[derive(Args, Debug)]
struct ConvergenceArguments {
    #[command(flatten)]
    robot: RobotArguments,
    #[command(flatten)]
    start: StartArguments,
    /// How long the motion is, s
    #[arg(long, value_name = "SECONDS", default_value = "1", allow_hyphen_values = true)]
    time: String,
    /// Longest step, s
    #[arg(long, value_name = "SECONDS", default_value = "0.02", allow_hyphen_values = true)]
    step: String,
    /// How often it is halved
    #[arg(long, value_name = "K", default_value_t = 6, value_parser = clap::value_parser!(u8).range(1..=12))]
    halvings: u8,
    #[command(flatten)]
    out: OutArguments,
}

#[derive(Args, Debug)]
struct EllipsoidArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// Positions θ, rad or m; may be given often
    #[arg(long, value_name = "θ1,θ2,…", allow_hyphen_values = true)]
    theta: Vec<String>,
    /// The plane of {s} that is looked at
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
        What::Trajectory(arguments) => of_motion(arguments, pictures::trajectories),
        What::Energy(arguments) => of_motion(arguments, pictures::energy),
        What::Phase(arguments) => of_motion(arguments, pictures::phase),
        What::Convergence(arguments) => convergence(arguments),
        What::Ellipsoids(arguments) => ellipsoids(arguments),
    }
}

fn of_motion(
    arguments: &MotionArguments,
    draw: impl Fn(&Model, &Motion) -> std::result::Result<Figure, mozzi_report::Error>,
) -> Result<String> {
    let model = arguments.robot.load()?;
    let file = &arguments.trajectory;
    let motion = Motion { title: model.description().name.clone(), ..report::read(file, &model)? };
    let figure = draw(&model, &motion).map_err(|error| Failure::wrong(format!("{file}: {error}")))?;
    save(figure, &arguments.out)
}

fn convergence(arguments: &ConvergenceArguments) -> Result<String> {
    let model = arguments.robot.load()?;
    let (theta, dtheta) = arguments.start.read(&model)?;
    let (time, step) = (number("--time", &arguments.time)?, number("--step", &arguments.step)?);
    let coarsest = mozzi::simulation::Options::with_step(time, step)?.steps;
    let mut progress = None;
    let found =
        integrators::convergence(&model, [&theta, &dtheta], time, coarsest, arguments.halvings.into(), |done, all| {
            progress.get_or_insert_with(|| Progress::new("convergence", all, "evaluations")).at(done);
        })?;
    drop(progress);
    let curve = |each: &integrators::Convergence| {
        let points = |x: fn(&Measured) -> f64| each.measured.iter().map(|of| [x(of), of.error]).collect::<Vec<_>>();
        let by_step = if each.is_adaptive() { Vec::new() } else { points(|of| of.step) };
        let by_work = points(|of| of.evaluations as f64);
        Convergence { name: each.name.into(), order: each.order, by_step, by_work }
    };
    let title = format!("{}, {} s", model.description().name, scalar(time));
    let figure = Convergence::figure(title, &found.iter().map(curve).collect::<Vec<_>>());
    let mut text = save(figure, &arguments.out)?;
    for each in &found {
        let by = if each.is_adaptive() { " by its evaluations" } else { "" };
        let order = each
            .measured_order()
            .map_or("unknown: too few motions went well, or all too well".into(), |order| format!("{order:.2}{by}"));
        text += &format!("{}: order {}, measured {order}\n", each.name, each.order);
    }
    Ok(text)
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
    save(pictures::ellipsoids(&model, &configurations, model.end_effector()?, plane)?, &arguments.out)
}

fn save(figure: Figure, out: &OutArguments) -> Result<String> {
    let title = out.title.clone().unwrap_or(figure.title);
    let svg = Figure { title, ..figure }.svg();
    let file = &out.out;
    let bytes = match std::path::Path::new(file).extension().and_then(|ending| ending.to_str()) {
        Some("svg") => svg.into_bytes(),
        Some("png") => png(&svg)?,
        _ => return Err(Failure::wrong(format!("--out is {file}, expected a file that ends in .svg or .png"))),
    };
    columns::save(file, bytes)?;
    Ok(format!("a figure written to {file}\n"))
}

/// The figure at twice its size in points, with the fonts of this machine.
#[cfg(feature = "png")]
fn png(svg: &str) -> Result<Vec<u8>> {
    use resvg::{tiny_skia, usvg};
    let wrong = |why: String| Failure::wrong(format!("the figure cannot be drawn as PNG: {why}"));
    let mut options = usvg::Options::default();
    options.fontdb_mut().load_system_fonts();
    if options.fontdb.is_empty() {
        return Err(wrong("this machine has no fonts; .svg needs none".into()));
    }
    let tree = usvg::Tree::from_str(svg, &options).map_err(|error| wrong(error.to_string()))?;
    let size = tree.size().to_int_size().scale_by(2.0);
    let mut pixels = size.and_then(|size| tiny_skia::Pixmap::new(size.width(), size.height()));
    let pixels = pixels.as_mut().ok_or_else(|| wrong("it has no size".into()))?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(2.0, 2.0), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| wrong(error.to_string()))
}

#[cfg(not(feature = "png"))]
fn png(_svg: &str) -> Result<Vec<u8>> {
    Err(Failure::wrong(
        "--out ends in .png, which this program was built without: cargo install --features png; .svg works",
    ))
}
