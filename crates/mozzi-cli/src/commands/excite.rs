//! `mozzi excite`: a motion that determines a robot's parameters.

use crate::angles;
use crate::columns::{Columns, save};
use crate::edits;
use crate::failure::{self, Failure, Result};
use crate::limits;
use crate::numbers::{self, array, number, one_or_each};
use crate::robot::FileArguments;
use crate::rows;
use crate::tables::format::Format;
use crate::text::{Page, digits, table};
use crate::{interrupt, json};
use clap::{Args, ValueEnum};
use mozzi::Model;
use mozzi_identify::excite::{self, Box3, Excitation, ExciteOptions, Goal, MotionLimits, Sphere, excite};
use mozzi_identify::{Choice, Sensor};
use serde_json::{Value, json};

#[derive(Args, Debug)]
pub struct ExciteArguments {
    #[command(flatten)]
    robot: FileArguments,
    /// Duration, s
    #[arg(long, alias = "time", value_name = "SECONDS", default_value = "20")]
    duration: String,
    /// Write the motion to a CSV file: t, theta_1 … tau_n
    #[arg(long, value_name = "FILE.csv")]
    out: Option<String>,
    /// Time between two rows of OUT, s; the last is the end
    #[arg(long, value_name = "SECONDS", default_value = "0.01")]
    step: String,
    /// Harmonics of the Fourier series
    #[arg(long, value_name = "COUNT", default_value = "5")]
    harmonics: usize,
    /// Optimality criterion
    #[arg(long, value_name = "GOAL", default_value = "log-det")]
    goal: GoalArgument,
    /// Velocity limits, one number or one for each joint, rad/s or m/s [default: the robot's, else 1 rad/s]
    #[arg(long, value_name = "LIST")]
    max_velocity: Option<String>,
    /// Acceleration limits, rad/s² or m/s² [default: to reach the velocity limit in 0.3 s]
    #[arg(long, value_name = "LIST")]
    max_acceleration: Option<String>,
    /// Torque limits, N m or N [default: the robot's]
    #[arg(long, value_name = "LIST")]
    max_torque: Option<String>,
    /// Position limits of a joint, instead of the robot's
    #[arg(long, value_name = "JOINT=LOW,HIGH")]
    range: Vec<String>,
    /// A box in the base frame that a frame's origin stays in, m
    #[arg(long, value_name = "FRAME=x,y,z,X,Y,Z")]
    within: Vec<String>,
    /// Spheres about two frames that stay apart: their radii, m
    #[arg(long, value_name = "FRAME,FRAME=r,R")]
    apart: Vec<String>,
    /// Where the motion begins and ends [default: the middle of the limits, optimized]
    #[arg(long, value_name = "θ1,θ2,…")]
    start: Option<String>,
    /// Standard deviation of the force's noise, one number or one for each joint [default: 1 % of the torque limit]
    #[arg(long, value_name = "LIST")]
    noise: Option<String>,
    /// Independent samples per second of the later log
    #[arg(long, value_name = "HZ", default_value = "100")]
    rate: String,
    /// Where forces will be measured
    #[arg(long, value_name = "PLACE", default_value = "motor")]
    torque: Place,
    /// Lock a joint at this position, rad or m
    #[arg(long, value_name = "JOINT=POSITION")]
    lock: Vec<String>,
    /// Joints that one rotor turns together: as in identify
    #[arg(long, value_name = "JOINT[=RATIO],JOINT[=RATIO]")]
    coupled: Vec<String>,
    /// List all base parameters
    #[arg(long)]
    all: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum GoalArgument {
    /// The largest determinant of the information
    LogDet,
    /// The least condition number
    Condition,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Place {
    /// By the motor: armature is estimated
    Motor,
    /// Behind the gear
    Link,
}

pub fn run(arguments: &ExciteArguments) -> Result<String> {
    json::unless_rows(arguments.robot.json, arguments.out.as_deref())?;
    arguments.out.as_deref().map(Format::check_csv).transpose()?;
    let whole = arguments.robot.load()?;
    let model = edits::sought(&whole, &arguments.coupled, &arguments.lock)?;
    let options = arguments.options(&model)?;
    for (name, [low, high]) in model.joint_names().zip(&options.limits.position) {
        if low >= high {
            failure::note(&format!(
                "joint `{name}` has a range of 0 and does not move, so that its parameters are not determined; --range \
                 {name}=LOW,HIGH gives it another"
            ));
        }
    }
    let times = rows::times(&arguments.step, options.duration, 1 + 4 * model.n())?;
    interrupt::listen();
    let found = excite(&model, &options, &interrupt::is_requested)?;
    if let Some(file) = &arguments.out {
        let text = columns(&model, &found, &times)?.text();
        if file == "-" {
            return Ok(text);
        }
        save(file, &text)?;
    }
    let text = if arguments.robot.json {
        object(&model, &found)
    } else {
        page(&model, &found, arguments.out.as_deref(), arguments.all)
    };
    if found.is_stopped { Err(Failure::Stopped(text)) } else { Ok(text) }
}

impl ExciteArguments {
    fn options(&self, model: &Model) -> Result<ExciteOptions> {
        let mut options = ExciteOptions::new(model, number("--duration", &self.duration)?);
        let (rates, none) = (angles::of_velocities(model), vec![false; model.n()]);
        let file = mozzi_motion::trajectories::Limits::of(model);
        let of_flag = |flag: &str, text: &Option<String>, both: [&[f64]; 2], are_angles: &[bool]| {
            limits::of_flag(model, flag, text.as_deref(), both, are_angles)
        };
        let MotionLimits { velocity, acceleration, torque, .. } = &mut options.limits;
        *velocity = of_flag("--max-velocity", &self.max_velocity, [velocity, &file.velocity], &rates)?;
        let both = [&acceleration[..], &file.acceleration];
        *acceleration = of_flag("--max-acceleration", &self.max_acceleration, both, &rates)?;
        if self.max_torque.is_some() {
            *torque = of_flag("--max-torque", &self.max_torque, [torque, &file.torque], &none)?;
            options.noise = excite::noise(torque);
        }
        if let Some(text) = &self.noise {
            options.noise = one_or_each("--noise", text, &none)?;
        }
        let positions = angles::of_positions(model);
        for text in &self.range {
            let (name, pair) = edits::split("--range", text, "JOINT=LOW,HIGH")?;
            let joint = model.joint_names().position(|known| known == name).ok_or_else(|| {
                let known: Vec<&str> = model.joint_names().collect();
                Failure::wrong(format!("--range: there is no joint `{name}`, expected one of {}", known.join(", ")))
            })?;
            let place = format!("--range {name}");
            let found = numbers::angles(&place, pair, &[positions[joint]; 2])?;
            let [low, high] = found[..] else {
                return Err(numbers::wrong_number(&place, found.len(), &["low", "high"]));
            };
            if !(low < high) {
                return Err(Failure::wrong(format!(
                    "--range {name} is {low} to {high}, expected the lower number first"
                )));
            }
            options.limits.position[joint] = [low, high];
        }
        for text in &self.within {
            let (name, corners) = edits::split("--within", text, "FRAME=x,y,z,X,Y,Z")?;
            let corners = edits::corners(&format!("--within {name}"), corners)?;
            options.limits.boxes.push(Box3 { frame: model.frame(name)?, corners });
        }
        for text in &self.apart {
            const EXPECTED: &str = "FRAME,FRAME=r,R";
            let (names, radii) = edits::split("--apart", text, EXPECTED)?;
            let (a, b) = names
                .split_once(',')
                .ok_or_else(|| Failure::wrong(format!("--apart is `{text}`, expected {EXPECTED}")))?;
            let [r, R] = array(&format!("--apart {names}"), radii, ["r", "R"])?;
            let sphere = |name: &str, radius| Ok::<_, Failure>(Sphere { frame: model.frame(name)?, radius });
            options.limits.apart.push((sphere(a, r)?, sphere(b, R)?));
        }
        options.start = self.start.as_deref().map(|text| numbers::angles("--start", text, &positions)).transpose()?;
        options.rate = number("--rate", &self.rate)?;
        options.harmonics = self.harmonics;
        options.goal = match self.goal {
            GoalArgument::LogDet => Goal::LogDet,
            GoalArgument::Condition => Goal::Condition,
        };
        options.choice = Choice::all(match self.torque {
            Place::Motor => Sensor::Motor,
            Place::Link => Sensor::Link,
        });
        Ok(options)
    }
}

/// The motion with the robot's own torques.
fn columns(model: &Model, found: &Excitation, times: &[f64]) -> Result<Columns> {
    let mut groups: [Vec<Vec<f64>>; 4] = Default::default();
    for &t in times {
        let [theta, dtheta, ddtheta] = found.at(t);
        let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &model.environment())?;
        groups
            .iter_mut()
            .zip([theta, dtheta, ddtheta, tau.as_slice().to_vec()])
            .for_each(|(group, row)| group.push(row));
    }
    let mut columns = Columns::default();
    columns.add("t", times.to_vec());
    for (name, rows) in ["theta", "dtheta", "ddtheta", "tau"].into_iter().zip(&groups) {
        columns.add_group(model, name, rows);
    }
    Ok(columns)
}

/// Base parameters of a default page.
const SHOWN: usize = 40;
/// Longest name of one.
const LONGEST: usize = 44;

fn page(model: &Model, found: &Excitation, out: Option<&str>, is_long: bool) -> String {
    let mut page = Page::default();
    page.line(format!(
        "{}: a motion of {} s, {} harmonics",
        model.description().name,
        found.basis.duration,
        found.basis.harmonics
    ));
    page.line(format!(
        "condition number {:.1}; of a random motion within the same limits {:.1}",
        found.condition, found.condition_of_random
    ));
    let weak =
        found.parameters.iter().filter(|(_, value, deviation)| *value != 0.0 && !(deviation < &value.abs())).count();
    page.line(format!(
        "{weak} of {} base parameters will have a deviation larger than their value",
        found.parameters.len()
    ));
    let mut rows = vec![["", "value", "deviation"].map(str::to_string).to_vec()];
    let most = if is_long { usize::MAX } else { SHOWN };
    for (name, value, deviation) in found.parameters.iter().take(most) {
        let is_cut = name.chars().count() > LONGEST;
        let name: String =
            if is_cut { name.chars().take(LONGEST - 1).chain("…".chars()).collect() } else { name.clone() };
        rows.push(vec![name, digits(*value, 5), digits(*deviation, 5)]);
    }
    page.title("predicted confidence: base parameters of the robot's file").lines(&table(&rows, "lrr"));
    page.line("  A base parameter is a sum of parameters that forces depend on, such as m c_x + l m'.");
    if found.parameters.len() > most {
        page.line(format!("  … {} more base parameters; --all shows them", found.parameters.len() - most));
    }
    match out {
        Some(file) => {
            page.blank().line(format!("{file} is written; check the motion for collisions before you run it"));
        }
        None => failure::note("--out FILE.csv writes the motion"),
    }
    page.end()
}

fn object(model: &Model, found: &Excitation) -> String {
    let parameters: Vec<Value> = found
        .parameters
        .iter()
        .map(|(name, value, deviation)| json!({ "name": name, "value": value, "deviation": deviation }))
        .collect();
    json::print(&json::of_robot(
        model,
        json!({
            "duration": found.basis.duration, "harmonics": found.basis.harmonics,
            "coefficients": json::nested(&[model.n(), found.basis.count()], &found.coefficients),
            "condition": found.condition, "condition_of_random": found.condition_of_random, "parameters": parameters,
        }),
    ))
}
