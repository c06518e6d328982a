//! `mozzi ik`: joint positions that place the end effector at a desired pose.

use crate::angles;
use crate::columns::{Columns, save};
use crate::failure::{self, Failure, Result};
use crate::goals::GoalArguments;
use crate::numbers::{angle, number};
use crate::progress::Progress;
use crate::robot::{RobotArguments, Units, space_frame};
use crate::state::{pasted, positions};
use crate::tables::format::Format;
use crate::text::{Page, about, column, table};
use crate::{goals, interrupt, json};
use clap::{Args, ValueEnum};
use mozzi::Model;
use mozzi_motion::inverse_kinematics::{self, Options, Secondary, Solution};
use mozzi_motion::{Goal, InverseKinematics};
use mozzi_urdf::counted;
use serde_json::{Value, json};
use std::time::Instant;

/// Columns of the table after the positions: reached (1 or 0), remaining errors, effort.
const COLUMNS: [&str; 5] = ["reached", "angle", "distance", "starts", "iterations"];

const NO_GOAL: &str = "the goal is missing, expected --position, --rpy or --quaternion, or --in FILE.csv";

fn seed(text: &str) -> Result<u64, String> {
    let hint = if text.contains([',', '.']) { "; --guess is the initial guess of θ" } else { "" };
    text.parse().map_err(|_| format!("expected a whole number, the seed of random positions{hint}"))
}

#[derive(Args, Debug)]
pub struct IkArguments {
    #[command(flatten)]
    robot: RobotArguments,
    #[command(flatten)]
    goal: GoalArguments,
    /// Goals in a CSV file, one per row: columns x y z, or with qw qx qy qz or roll pitch yaw, or these alone ("-":
    /// standard input)
    #[arg(long = "in", value_name = "FILE.csv", conflicts_with_all = ["position", "rpy", "quaternion"])]
    input: Option<String>,
    /// File for the table theta_1 …, reached, angle, distance, starts, iterations [default: standard output]
    #[arg(long = "out", value_name = "FILE.csv")]
    output: Option<String>,
    /// Initial guess, or the name of a state [default: the robot's start, else joints at 0]; for a table, the guess
    /// of each row
    #[arg(long, value_name = "θ1,θ2,…")]
    guess: Option<String>,
    /// Redundant robots: prefer the solution nearest to these positions, or to a named state
    #[arg(long, value_name = "θ1,θ2,…")]
    near: Option<String>,
    /// Method of the steps
    #[arg(long, default_value = "levenberg-marquardt")]
    method: Way,
    /// Tolerance on the angle to the goal, rad
    #[arg(long, value_name = "RAD", default_value = "1e-8rad")]
    angle: String,
    /// Tolerance on the distance to the goal, m
    #[arg(long, value_name = "M", default_value = "1e-8")]
    distance: String,
    /// Maximum number of iterations per start
    #[arg(long, value_name = "K", default_value_t = Options::default().iterations)]
    iterations: usize,
    /// Maximum number of starts: the guess, then random positions
    #[arg(long, value_name = "K", default_value_t = Options::default().starts)]
    starts: usize,
    /// Seed of the random positions
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = seed)]
    seed: u64,
    /// Ignore joint limits
    #[arg(long)]
    ignore_limits: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Way {
    /// Damped least squares: robust far from the goal
    LevenbergMarquardt,
    /// Newton-Raphson with the pseudo-inverse
    Newton,
}

pub fn run(arguments: &IkArguments) -> Result<String> {
    json::unless_rows(arguments.robot.json, arguments.output.as_deref())?;
    arguments.output.as_deref().map(Format::check_csv).transpose()?;
    let model = arguments.robot.load()?;
    let guess = positions("--guess", arguments.guess.as_deref(), &model)?;
    let near = arguments.near.as_deref().map(|text| positions("--near", Some(text), &model)).transpose()?;
    let secondary = near.as_deref().map_or(Secondary::None, Secondary::Near);
    let mut solver = InverseKinematics::with_options(&model, model.end_effector()?, arguments.options()?)?;
    match &arguments.input {
        Some(file) => arguments.table(&model, &mut solver, file, &guess, &secondary),
        None => {
            let goal = arguments.goal.read()?.ok_or_else(|| Failure::wrong(NO_GOAL))?;
            let found =
                solver.solve_with(goal, &guess, &secondary).map_err(|error| not_reached(&solver, goal, error))?;
            if arguments.robot.json { Ok(json::print(&object(&model, &found)?)) } else { page(&model, &found) }
        }
    }
}

/// The error, beginning with its reason if the robot's shape is one.
fn not_reached(solver: &InverseKinematics, goal: Goal, error: mozzi_motion::Error) -> Failure {
    let mozzi_motion::Error::NotReached { frame, theta, residual, limits, starts, .. } = &error else {
        return error.into();
    };
    let Some(reason) = solver.why_not(goal, theta) else { return error.into() };
    let limits = match limits.len() {
        0 => String::new(),
        _ => format!(
            ", with {} at a limit",
            limits.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
        ),
    };
    Failure::wrong(format!(
        "{reason}; the best of {starts} starts leaves `{frame}` {residual} away{limits}, at θ = {}",
        crate::table::short(theta)
    ))
}

impl IkArguments {
    fn options(&self) -> Result<Options> {
        let method = match self.method {
            Way::LevenbergMarquardt => inverse_kinematics::Method::LevenbergMarquardt,
            Way::Newton => inverse_kinematics::Method::Newton,
        };
        let (angle, distance) = (angle("--angle", &self.angle)?, number("--distance", &self.distance)?);
        let (iterations, starts, seed, limits) = (self.iterations, self.starts, self.seed, !self.ignore_limits);
        Ok(Options { method, angle, distance, iterations, starts, seed, limits, ..Options::default() })
    }

    /// A row for each pose; for poses that were not reached, the best result with its remaining error.
    fn table(
        &self,
        model: &Model,
        solver: &mut InverseKinematics,
        file: &str,
        guess: &[f64],
        secondary: &Secondary,
    ) -> Result<String> {
        let (poses, frame) = (goals::read(file)?, model.frame_name(model.end_effector()?));
        interrupt::listen();
        let (progress, begin) = (Progress::new("inverse kinematics", poses.len(), "poses"), Instant::now());
        let (mut theta, mut numbers, mut missed) = (Vec::new(), [const { Vec::new() }; 5], Vec::new());
        for (row, (line, goal)) in poses.iter().enumerate() {
            if interrupt::is_requested() {
                break;
            }
            let (positions, residual, starts, iterations) = match solver.solve_with(*goal, guess, secondary) {
                Ok(Solution { theta, residual, starts, iterations }) => (theta, residual, starts, iterations),
                Err(mozzi_motion::Error::NotReached { theta, residual, starts, iterations, .. }) => {
                    missed.push(line);
                    (theta, residual, starts, iterations)
                }
                Err(error) => return Err(error.into()),
            };
            theta.push(positions);
            let [angle, distance] = [residual.angle, residual.distance].map(|x| x.unwrap_or(0.0));
            let reached = if missed.last() == Some(&line) { 0.0 } else { 1.0 };
            for (column, x) in numbers.iter_mut().zip([reached, angle, distance, starts as f64, iterations as f64]) {
                column.push(x);
            }
            progress.at(row + 1);
        }
        drop(progress);
        let (count, seconds) = (theta.len(), begin.elapsed().as_secs_f64());
        let micros = 1e6 * seconds / count.max(1) as f64;
        failure::note(&format!(
            "{} of {count} poses reached, {} s, {} µs per pose",
            count - missed.len(),
            about(seconds),
            about(micros)
        ));
        let object = self.robot.json.then(|| {
            let lists = theta.iter().map(|row| json::vector(row)).collect::<Value>();
            let mut object = json!({ "frame": frame, "theta": lists, "complete": count == poses.len() });
            COLUMNS.into_iter().zip(&numbers).for_each(|(name, list)| object[name] = json::vector(list));
            json::print(&json::of_robot(model, object))
        });
        let mut columns = Columns::default();
        columns.add_group(model, "theta", &theta);
        for (name, values) in COLUMNS.into_iter().zip(numbers) {
            columns.add(name, values);
        }
        let text = match (self.output.as_deref().filter(|file| *file != "-"), object) {
            (None, None) => columns.text(),
            (None, Some(object)) => object,
            (Some(file), object) => {
                save(file, columns.text())?;
                object.unwrap_or_else(|| format!("{count} rows written to {file}\n"))
            }
        };
        if count < poses.len() {
            failure::note(&format!("stopped by Ctrl-C: {count} of {} poses", poses.len()));
            return Err(Failure::Stopped(text));
        }
        match missed.first() {
            None => Ok(text),
            Some(line) => {
                failure::note(&format!(
                    "{} of the poses {} not reached, the first in line {line} of {file}",
                    missed.len(),
                    if missed.len() == 1 { "was" } else { "were" },
                ));
                Err(Failure::Answered(text))
            }
        }
    }
}

fn object(model: &Model, found: &Solution) -> Result<serde_json::Value> {
    let frame = model.end_effector()?;
    let T = model.forward_kinematics(&found.theta, frame)?;
    Ok(json::of_robot(
        model,
        json!({
            "frame": model.frame_name(frame),
            "theta": json::vector(&found.theta),
            "T": json::pose(T),
            "angle": found.residual.angle,
            "distance": found.residual.distance,
            "starts": found.starts,
            "iterations": found.iterations,
        }),
    ))
}

fn page(model: &Model, found: &Solution) -> Result<String> {
    let frame = model.end_effector()?;
    let mut page = Page::default();
    let [starts, iterations] =
        [(found.starts, "start"), (found.iterations, "iteration")].map(|(n, noun)| counted(n, noun));
    page.line(format!(
        "{}: `{}` reaches its goal within {}; {starts}, {iterations}",
        model.description().name,
        model.frame_name(frame),
        found.residual
    ));
    let names = model.position_names().map(str::to_string);
    let theta = angles::shown(&found.theta, &angles::of_positions(model));
    let rows: Vec<Vec<String>> = names.zip(column(&theta)).map(|(name, value)| vec![name, value]).collect();
    page.blank().line(format!("θ in {}", Units::of(model).input(0))).lines(&table(&rows, "lr"));
    let T = model.forward_kinematics(&found.theta, frame)?.to_matrix();
    page.blank().line(format!("T, its pose in {}", space_frame(model))).lines(&crate::text::constants(T));
    page.blank();
    pasted(&mut page, &[("--theta", &theta)]);
    Ok(page.end())
}
