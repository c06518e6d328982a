//! `mozzi trajectory`: plans a motion.

use crate::angles;
use crate::columns::{Columns, save};
use crate::failure::{self, Failure, Result};
use crate::goals::GoalArguments;
use crate::json;
use crate::limits;
use crate::numbers::number;
use crate::progress::Progress;
use crate::robot::{RobotArguments, Units};
use crate::rows;
use crate::state::{positions, positions_from};
use crate::tables::format::Format;
use crate::tables::{motion, read as table_file};
use crate::text::{Decimals, Page, about, scalar, table};
use clap::{Args, ValueEnum};
use mozzi::model::Bounds;
use mozzi::{Model, SE3};
use mozzi_motion::Goal;
use mozzi_motion::trajectories::{
    Cartesian, Desired, Ends, Limits, Line, Path, Profile, Recorded, Reference, Shape, Spline, Timed, stretched,
    time_optimal,
};
use serde_json::{Value, json};

#[derive(Args, Debug)]
pub struct TrajectoryArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// Initial positions, or the name of a state [default: the robot's start, else joints at 0 and a floating base
    /// at {s}]
    #[arg(long, visible_aliases = ["theta", "q"], alias = "start", value_name = "θ1,θ2,…", conflicts_with = "via")]
    from: Option<String>,
    /// Final positions, or the name of a state; JOINT=POSITION,… leaves the other joints where they are
    #[arg(long, aliases = ["goal", "target"], value_name = "θ1,θ2,…", conflicts_with = "via")]
    to: Option<String>,
    /// Via points in a table with columns theta_1 …; with a column t, passed at these times by a spline at rest at
    /// both ends, or at the velocities dtheta_1 … and accelerations ddtheta_1 … of the table
    #[arg(long, alias = "waypoints", value_name = "FILE")]
    via: Option<String>,
    /// The path: of the joints, or of the end effector to the pose of --to or of --position and --rpy
    #[arg(long, value_name = "PATH", default_value = "joints", conflicts_with = "via")]
    path: Way,
    #[command(flatten)]
    goal: GoalArguments,
    /// Tolerance on the end effector's path, ‖(ω, v)‖, rad and m
    #[arg(long, value_name = "EPS", default_value = "1e-6")]
    deviation: String,
    /// Time scaling along the path [default: quintic]
    #[arg(long)]
    profile: Option<Shaped>,
    /// Duration, s [default: as short as the limits allow]
    #[arg(long, alias = "duration", value_name = "SECONDS")]
    time: Option<String>,
    /// trapezoidal only: the fraction of the time spent accelerating, and decelerating
    #[arg(long, value_name = "FRACTION", default_value = "0.25")]
    ramp_fraction: String,
    /// Velocity limits, one number, one for each joint or JOINT=LIMIT,…, rad/s or m/s [default: the robot's]
    #[arg(long, value_name = "LIST")]
    max_velocity: Option<String>,
    /// Acceleration limits, rad/s² or m/s² [default: the robot's, which URDF 1.2 has]
    #[arg(long, value_name = "LIST")]
    max_acceleration: Option<String>,
    /// Torque limits, N m or N [default: the robot's]
    #[arg(long, value_name = "LIST")]
    max_torque: Option<String>,
    /// Time between two rows, s; the last is the end
    #[arg(long, visible_alias = "dt", value_name = "SECONDS", default_value = "0.01")]
    step: String,
    /// Write the motion to a CSV file ("-": standard output): t, theta_1 … tau_n
    #[arg(long, value_name = "FILE.csv")]
    out: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Way {
    /// A straight line in joint space
    Joints,
    /// A screw motion of the end effector
    Screw,
    /// A straight line of its origin
    Line,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Shaped {
    /// Velocity is zero at both ends
    Cubic,
    /// Velocity and acceleration are zero at both ends
    Quintic,
    /// Constant acceleration, velocity, deceleration, in the fractions of --ramp-fraction; `fastest` finds the ramps
    Trapezoidal,
    /// Time-optimal within the limits of velocity, acceleration and torque
    Fastest,
}

/// Rows of the table on the screen.
const SHOWN: usize = 10;
/// Number of points at which limits are checked.
const PLACES: usize = 500;

pub fn run(arguments: &TrajectoryArguments) -> Result<String> {
    json::unless_rows(arguments.robot.json, arguments.out.as_deref())?;
    arguments.out.as_deref().map(Format::check_csv).transpose()?;
    let model = arguments.robot.load_at(|model| positions("--from", arguments.from.as_deref(), model))?;
    if model.constraint_rows() > 0 {
        let names = model.constraints().iter().map(|one| format!("`{}`", one.name)).collect::<Vec<_>>().join(", ");
        return Err(Failure::wrong(format!(
            "trajectory: the robot has the constraints {names}, which a path of its joints does not keep; expected a robot \
             without constraints"
        )));
    }
    let limits = arguments.limits(&model)?;
    let motion = arguments.motion(&model, &limits).map_err(|failure| match failure {
        Failure::Wrong(sentence) if sentence.starts_with("nothing limits the speed") => {
            Failure::wrong(format!("{sentence}; --time is a duration, --max-velocity a limit"))
        }
        other => other,
    })?;
    let times = rows::times(&arguments.step, motion.duration(), 1 + model.nq() + 3 * model.n())?;
    // limits are judged also between the rows
    let between = (0..=PLACES).map(|k| motion.duration() * k as f64 / PLACES as f64);
    let of = |t: f64| -> Result<Row> {
        let Desired { theta, dtheta, ddtheta } = motion.at(t);
        let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &model.environment())?.as_slice().to_vec();
        Ok(Row { t, theta, dtheta, ddtheta, tau })
    };
    let progress = Progress::new("torques", times.len(), "rows");
    let told = times.iter().enumerate().map(|(k, &t)| of(t).inspect(|_| progress.at(k + 1)));
    let rows = told.collect::<Result<Vec<Row>>>()?;
    drop(progress);
    let between = between.map(of).collect::<Result<Vec<Row>>>()?;
    let judged: Vec<&Row> = rows.iter().chain(&between).collect();
    if let Some((row, name)) = judged.iter().find_map(|row| Some((row, row.not_finite()?))) {
        return Err(Failure::wrong(format!(
            "{name} at t = {} s is not a finite number: the motion is too large or too fast",
            row.t
        )));
    }
    let told = beyond(&model, &judged, &limits);
    told.iter().for_each(|line| failure::note(line));
    let text = columns(&model, &rows).text();
    if let Some(file) = arguments.out.as_deref().filter(|file| *file != "-") {
        save(file, &text)?;
    }
    let refused = !told.is_empty() && arguments.robot.is_strict();
    let text = match arguments.out.as_deref() {
        Some("-") => text,
        _ if arguments.robot.json => json::print(&object(&model, &rows, told)),
        file => page(&model, &rows, &judged, &limits, file),
    };
    if refused { Err(Failure::Answered(text)) } else { Ok(text) }
}

impl TrajectoryArguments {
    fn limits(&self, model: &Model) -> Result<Limits> {
        let robots = Limits::of(model);
        let (rates, none) = (angles::of_velocities(model), vec![false; model.n()]);
        let list = |flag: &str, text: &Option<String>, own: Vec<f64>, are_angles: &[bool]| {
            limits::of_flag(model, flag, text.as_deref(), [&own, &own], are_angles)
        };
        Ok(Limits {
            velocity: list("--max-velocity", &self.max_velocity, robots.velocity, &rates)?,
            acceleration: list("--max-acceleration", &self.max_acceleration, robots.acceleration, &rates)?,
            torque: list("--max-torque", &self.max_torque, robots.torque, &none)?,
        })
    }

    fn motion<'m>(&self, model: &'m Model, limits: &Limits) -> Result<Box<dyn Reference + 'm>> {
        let path: Box<dyn Path + 'm> = match &self.via {
            Some(file) => {
                let samples = table_file::read(file, model)?;
                angles::of_file(file);
                let rows = |table: &[f64], width: usize| table.chunks(width).map(<[f64]>::to_vec).collect::<Vec<_>>();
                let points = &rows(samples.need("theta", model)?, model.nq());
                let place = |error: mozzi_motion::Error| Failure::wrong(format!("{file}: {error}"));
                let [dtheta, ddtheta] =
                    ["dtheta", "ddtheta"].map(|name| samples.tables.get(name).map(|table| rows(table, model.n())));
                if let Some(times) = &samples.t {
                    motion::check(&samples)?;
                    if self.profile.is_some() {
                        return Err(Failure::wrong(format!(
                            "--profile and the column t of {file} both define the timing, expected one of them"
                        )));
                    }
                    let span = times[times.len() - 1] - times[0];
                    let duration = self.time.as_deref().map_or(Ok(span), |text| number("--time", text))?;
                    if times[0] != 0.0 {
                        failure::note(&format!("{file} begins at t = {} s, the motion at 0", times[0]));
                    }
                    if (duration - span).abs() > 1e-12 * span {
                        failure::note(&format!(
                            "--time makes the {span} s of {file} {duration} s: its times are scaled"
                        ));
                    }
                    if dtheta.is_none() && ddtheta.is_none() {
                        let spline = Spline::new(model, times, points, Ends::AtRest).map_err(place)?;
                        return Ok(Box::new(Timed::new(spline, Profile::linear(duration)?)));
                    }
                    if self.time.is_some() && (duration - span).abs() > 1e-12 * span {
                        return Err(Failure::wrong(format!(
                            "--time is {duration} s, but {file} has velocities at times over {span} s; expected this \
                             duration, or a table without velocities"
                        )));
                    }
                    let begun: Vec<f64> = times.iter().map(|t| t - times[0]).collect();
                    let motion = Recorded::new(model, &begun, points, dtheta.as_deref(), ddtheta.as_deref());
                    return Ok(Box::new(motion.map_err(place)?));
                }
                for (name, _) in [("dtheta", dtheta), ("ddtheta", ddtheta)].iter().filter(|(_, rows)| rows.is_some()) {
                    failure::note(&format!("{file}: the columns {name}_… have no effect without a column t"));
                }
                Box::new(Spline::through(model, points, Ends::Natural).map_err(place)?)
            }
            None => self.path(model)?,
        };
        let rise = number("--ramp-fraction", &self.ramp_fraction)?;
        let asked = self.profile.unwrap_or(Shaped::Quintic);
        let shape = |duration: f64| match asked {
            Shaped::Cubic => Profile::cubic(duration),
            Shaped::Quintic => Profile::quintic(duration),
            Shaped::Trapezoidal | Shaped::Fastest => Profile::trapezoidal_in(duration, rise),
        };
        let profile = match (&self.time, asked) {
            (None, Shaped::Fastest) => time_optimal(model, &path, limits, PLACES)?,
            (Some(text), Shaped::Fastest) => {
                time_optimal(model, &path, limits, PLACES)?.in_time(number("--time", text)?)?
            }
            (None, _) => stretched(model, &path, &shape(1.0)?, limits, PLACES)?,
            (Some(text), _) => shape(number("--time", text)?)?,
        };
        Ok(Box::new(Timed::new(path, profile)))
    }

    fn path<'m>(&self, model: &'m Model) -> Result<Box<dyn Path + 'm>> {
        let from = positions("--from", self.from.as_deref(), model)?;
        let to = self.to.as_deref().map(|text| positions_from(from.clone(), "--to", text, model)).transpose()?;
        let shape = match (self.path, &to) {
            (Way::Joints, Some(to)) => return Ok(Box::new(Line::new(model, &from, to)?)),
            (Way::Joints, None) => return Err(Failure::wrong("the final position is missing, expected --to or --via")),
            (Way::Screw, _) => Shape::Screw,
            (Way::Line, _) => Shape::Straight,
        };
        let frame = model.end_effector()?;
        let start = model.forward_kinematics(&from, frame)?;
        let goal = match (&to, self.goal.read()?) {
            (Some(to), None) => model.forward_kinematics(to, frame)?,
            (None, Some(Goal::Pose(T))) => T,
            (None, Some(Goal::Position(p))) => SE3::new(start.R, p),
            (None, Some(Goal::Orientation(R))) => SE3::new(R, start.p),
            _ => return Err(Failure::wrong("--path expects either --to, or --position, --rpy or --quaternion")),
        };
        let deviation = number("--deviation", &self.deviation)?;
        let path = Cartesian::new(model, frame, &from, goal, shape, deviation)?;
        let end = path.at(1.0).theta;
        let is_off = |to: &Vec<f64>| end.iter().zip(to).any(|(a, b)| (a - b).abs() > 1e-3);
        if to.as_ref().is_some_and(is_off) {
            let (end, frame) = (crate::table::short(&end), model.frame_name(frame));
            failure::note(&format!("the path of `{frame}` ends at the pose of --to, at other positions: θ = {end}"));
        }
        Ok(Box::new(path))
    }
}

/// A moment of the motion.
struct Row {
    t: f64,
    theta: Vec<f64>,
    dtheta: Vec<f64>,
    ddtheta: Vec<f64>,
    tau: Vec<f64>,
}

impl Row {
    /// The part that is not finite.
    fn not_finite(&self) -> Option<&'static str> {
        let parts = [
            ("a position", &self.theta),
            ("a velocity", &self.dtheta),
            ("an acceleration", &self.ddtheta),
            ("a torque", &self.tau),
        ];
        parts.into_iter().find_map(|(name, list)| list.iter().any(|x| !x.is_finite()).then_some(name))
    }
}

fn columns(model: &Model, rows: &[Row]) -> Columns {
    let mut columns = Columns::default();
    let group = |pick: fn(&Row) -> &Vec<f64>| rows.iter().map(|row| pick(row).clone()).collect::<Vec<_>>();
    columns.add("t", rows.iter().map(|row| row.t).collect());
    columns.add_group(model, "theta", &group(|row| &row.theta));
    columns.add_group(model, "dtheta", &group(|row| &row.dtheta));
    columns.add_group(model, "ddtheta", &group(|row| &row.ddtheta));
    columns.add_group(model, "tau", &group(|row| &row.tau));
    columns
}

/// A message for each exceeded limit: the robot's position limits, and the given limits of velocity, acceleration and
/// torque.
fn beyond(model: &Model, rows: &[&Row], limits: &Limits) -> Vec<String> {
    let mut told = Vec::new();
    let mut say =
        |what: &str, name: &str, asked: &dyn Fn(usize) -> f64, [low, high]: [f64; 2], shown: &dyn Fn(f64) -> f64| {
            let excess = |row: usize| (low - asked(row)).max(asked(row) - high);
            let worst = (0..rows.len()).max_by(|&a, &b| excess(a).total_cmp(&excess(b))).unwrap_or(0);
            // a motion within a limit may exceed it by rounding
            let (x, limit) = (asked(worst), if asked(worst) < low { low } else { high });
            if excess(worst) > 1e-9 + 1e-6 * limit.abs() {
                let (x, limit, t) = (scalar(shown(x)), scalar(shown(limit)), scalar(rows[worst].t));
                told.push(format!("{what} limit: `{name}` reaches {x}, beyond its limit {limit}, at t = {t} s"));
            }
        };
    let names: Vec<&str> = model.velocity_names().collect();
    let bounds = Bounds::of(model);
    let rates = angles::of_velocities(model);
    for ((joint, range), place) in model.joints().zip(&bounds.joints).zip(model.places()) {
        let shown = |x: f64| angles::of_joint(joint.kind, x);
        say("joint", &joint.name, &|row| place.bounded_value(&rows[row].theta), *range, &shown);
        for v in place.velocities() {
            for (what, asked, limit) in [
                ("velocity", &(|row: usize| rows[row].dtheta[v]) as &dyn Fn(usize) -> f64, limits.velocity[v]),
                ("acceleration", &|row| rows[row].ddtheta[v], limits.acceleration[v]),
                ("effort", &|row| rows[row].tau[v], limits.torque[v]),
            ] {
                let shown = |x: f64| angles::shown(&[x], &[rates[v] && what != "effort"])[0];
                say(what, names[v], asked, [-limit, limit], &shown);
            }
        }
    }
    told
}

fn object(model: &Model, rows: &[Row], beyond: Vec<String>) -> Value {
    let group = |pick: fn(&Row) -> &Vec<f64>| rows.iter().map(|row| json::vector(pick(row))).collect::<Value>();
    json::of_robot(
        model,
        json!({
            "t": rows.iter().map(|row| Value::from(row.t)).collect::<Value>(),
            "theta": group(|row| &row.theta),
            "dtheta": group(|row| &row.dtheta),
            "ddtheta": group(|row| &row.ddtheta),
            "tau": group(|row| &row.tau),
            "beyond": beyond,
        }),
    )
}

/// Largest values are those of the `judged` moments.
fn page(model: &Model, rows: &[Row], judged: &[&Row], limits: &Limits, file: Option<&str>) -> String {
    let mut page = Page::default();
    let duration = rows.last().map_or(0.0, |row| row.t);
    page.line(format!("{}: a motion of {} s", model.description().name, scalar(duration)));
    let shown = model.nq().min(8);
    let mut cells =
        vec![std::iter::once("t [s]".to_string()).chain((1..=shown).map(|j| format!("θ_{j}"))).collect::<Vec<_>>()];
    let picked: Vec<usize> = (0..=SHOWN).map(|k| k * (rows.len() - 1) / SHOWN).collect();
    let are_angles = angles::of_positions(model);
    let of = |row: &Row| angles::shown(&row.theta[..shown], &are_angles[..shown]);
    let theta = Decimals::of(&rows.iter().flat_map(of).collect::<Vec<_>>());
    let time = Decimals::of(rows.iter().map(|row| &row.t));
    for &k in &picked {
        let row = &rows[k];
        cells.push(std::iter::once(time.show(row.t)).chain(of(row).into_iter().map(|q| theta.show(q))).collect());
    }
    cells.dedup();
    page.blank().lines(&table(&cells, "r")).blank();
    // the largest value of each joint, and of its limit
    let largest = |pick: fn(&Row) -> &Vec<f64>| {
        let all = judged.iter().map(|row| pick(row));
        all.fold(vec![0.0_f64; model.n()], |m, row| m.iter().zip(row).map(|(m, x)| m.max(x.abs())).collect())
    };
    let units = Units::of(model);
    for (what, unit, found, limit) in [
        ("velocity", units.input(1), largest(|row| &row.dtheta), &limits.velocity),
        ("acceleration", units.input(2), largest(|row| &row.ddtheta), &limits.acceleration),
        ("torque", units.input(3), largest(|row| &row.tau), &limits.torque),
    ] {
        let share = found.iter().zip(limit).map(|(x, limit)| x / limit).fold(0.0, f64::max);
        let most = found.iter().fold(0.0_f64, |m, &x| m.max(x));
        let of = if share > 0.0 {
            format!(", {} % of its limit where nearest", about(100.0 * share))
        } else {
            String::new()
        };
        let are_angles = angles::of_velocities(model);
        let is_of_angles = what != "torque" && are_angles.iter().all(|&is_angle| is_angle);
        let most = if is_of_angles && angles::are_degrees() { most.to_degrees() } else { most };
        let unit = if is_of_angles { unit } else { angles::in_radians(&unit) };
        page.line(format!("largest {what}: {} {unit}{of}", scalar(most)));
    }
    if let Some(file) = file {
        page.line(format!("{} rows written to {file}", rows.len()));
    }
    page.end()
}
