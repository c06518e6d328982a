//! `mozzi identify`: the robot's parameters from logs of its motion.

mod log_file;
mod output;
mod page;
mod simulators;

use crate::columns::save;
use crate::edits;
use crate::failure::{self, Failure, Result};
use crate::numbers::{array, number};
use crate::progress::Waiting;
use crate::recogniser::Force;
use crate::robot::FileArguments;
use crate::tables::samples::Row;
use crate::{interrupt, json};
use clap::{Args, ValueEnum};
use log_file::{Given, read_log, read_table};
use mozzi::Model;
use mozzi_identify::judgement::judge;
use mozzi_identify::signals::{Acceleration, Cutoff, Filter};
use mozzi_identify::{
    Choice, Finding, Level, Limits, Log, Options, RefineOptions, Sensor, Verdict, describe, identify, refine,
};
use output::Out;

#[derive(Args, Debug)]
pub struct IdentifyArguments {
    #[command(flatten)]
    robot: FileArguments,
    /// Logs: text with a header of names such as theta_JOINT, q1, /joint_states/JOINT/effort (see --columns), .npz,
    /// .npy, .arrow, .parquet; JointState messages of .mcap, .db3 or a folder of rosbag2
    #[arg(value_name = "LOG", required = true)]
    logs: Vec<String>,
    /// Write the identified robot: .urdf, .xml (MJCF), .xacro or .yaml (properties), each by editing the robot's own
    /// text; a folder for all files that change; or .json
    #[arg(long, value_name = "FILE")]
    out: Option<String>,
    /// Keep the old numbers in comments of OUT
    #[arg(long, requires = "out")]
    old_values: bool,
    /// Print armature, friction and the gains of position controllers in the words of a simulator, and where each
    /// parameter went
    #[arg(long, value_name = "SIMULATOR", conflicts_with = "json")]
    write: Option<simulators::Simulator>,
    /// Write a report: forces, residuals, parameters, ellipsoids of inertia
    #[arg(long, value_name = "FILE.html")]
    report: Option<String>,
    /// Another log, whose forces are predicted
    #[arg(long, value_name = "LOG")]
    validate: Vec<String>,
    /// Estimate these parameters alone
    #[arg(long)]
    only: Option<Only>,
    /// The frame that carries the payload of --only payload (one log cannot separate links from a payload) [default:
    /// the end effector]
    #[arg(long, value_name = "FRAME")]
    payload: Option<String>,
    /// Where forces are measured; current: estimate drive gains, which needs --known-payload
    #[arg(long, value_name = "PLACE", default_value = "motor")]
    torque: Torque,
    /// The payload that log N (from 1) carried: its frame, mass and centre of mass
    #[arg(long, value_name = "N:FRAME=m,cx,cy,cz")]
    known_payload: Vec<String>,
    /// Cut-off of the filter, Hz, `auto` or `none` [default: auto, five times the velocities' band]
    #[arg(long, value_name = "HZ", default_value = "auto", hide_default_value = true)]
    cutoff: String,
    /// How accelerations are computed
    #[arg(long, value_name = "HOW", default_value = "differences")]
    acceleration: How,
    /// Weight of the robot file's values for parameters that the data does not determine
    #[arg(long, value_name = "WEIGHT", default_value = "0.3")]
    prior: String,
    /// Reduce the weight of large residuals (Huber)
    #[arg(long)]
    robust: bool,
    /// Percent of each log to fit, in tens; the rest is predicted
    #[arg(long, value_name = "PERCENT", default_value = "100")]
    fit: String,
    /// Add Stribeck friction, with this velocity, rad/s or m/s
    #[arg(long, value_name = "SPEED")]
    stribeck: Option<String>,
    /// Width of Coulomb friction, μ tanh(θ̇/w), rad/s or m/s
    #[arg(long, value_name = "SPEED", default_value = "0.05")]
    width: String,
    /// Then refine on rollouts: motions of 0.3 s, driven by the measured forces, by exact gradients
    #[arg(long)]
    refine: bool,
    /// Estimate springs
    #[arg(long)]
    springs: bool,
    /// Estimate no offsets of forces
    #[arg(long)]
    no_offsets: bool,
    /// The mass of all moving links, kg, and its standard deviation
    #[arg(long, value_name = "M,DEVIATION")]
    total_mass: Option<String>,
    /// Bounds of a parameter
    #[arg(long, value_name = "NAME=LOW,HIGH")]
    between: Vec<String>,
    /// A box in the link's frame that contains its centre of mass, m
    #[arg(long, value_name = "LINK=x,y,z,X,Y,Z")]
    center_in: Vec<String>,
    /// Lock a joint that the log does not move, at this position, rad or m; `*` matches any text: 'gripper_*=0'
    #[arg(long, value_name = "JOINT=POSITION")]
    lock: Vec<String>,
    /// Joints that one rotor turns together, as in the wrists of some arms: its inertia and friction act on the sum of
    /// their motions, each times its ratio, 1 unless it is given
    #[arg(long, value_name = "JOINT[=RATIO],JOINT[=RATIO]")]
    coupled: Vec<String>,
    /// The log's names of joints, in the robot's order
    #[arg(long, value_name = "NAME,NAME,…", value_delimiter = ',')]
    order: Vec<String>,
    /// The topic of a bag, or the beginning of the columns' path
    #[arg(long, value_name = "NAME")]
    topic: Option<String>,
    /// Print every parameter, the meaning of each column of the logs, and what the motion does not determine
    #[arg(long)]
    all: bool,
    /// Print the meaning of each column of the logs, and nothing else
    #[arg(long)]
    columns: bool,
    /// Fit a log that contradicts itself or the robot's file; the contradictions are then warnings
    #[arg(long)]
    trust_log: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Only {
    /// A payload at a frame, with friction and offsets
    Payload,
    /// Friction and offsets
    Friction,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Torque {
    /// By the motor: armature is part of the force
    Motor,
    /// Behind the gear
    Link,
    /// Motor currents, A
    Current,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum How {
    /// Central differences of filtered signals
    Differences,
    /// A smoothing spline, which also filters
    Spline,
}

pub fn run(arguments: &IdentifyArguments) -> Result<String> {
    let (input, settings) = (&arguments.robot.model, || arguments.robot.settings());
    let out = arguments.out.as_deref().map(|out| Out::new(input, out, settings())).transpose()?;
    let whole = arguments.robot.load()?;
    let locks = arguments.lock_list(&whole)?;
    let model = edits::sought(&whole, &arguments.coupled, &locks)?;
    let locked: Vec<String> = locks.iter().filter_map(|lock| Some(lock.split_once('=')?.0.to_string())).collect();
    let given = arguments.given(&locked);
    if arguments.columns {
        return arguments.column_tables(&model, &given);
    }
    let options = arguments.options(&model)?;
    let (mut logs, mut columns) = (Vec::new(), Vec::new());
    for file in &arguments.logs {
        let (log, rows) = read_log(file, &model, &given)?;
        columns.push((log.name.clone(), rows));
        logs.push(log);
    }
    arguments.known_payloads(&model, &mut logs)?;
    interrupt::listen();
    let progress = Waiting::on("identifying");
    let mut found = identify(&model, &logs, &options, &interrupt::is_requested)?;
    if arguments.refine {
        let refined = refine(&found, &RefineOptions::default(), &interrupt::is_requested)?;
        page::refinement(&model, &refined).iter().for_each(|line| failure::note(line));
        found.replace(refined.x)?;
    }
    let mut judged = judge(&found, &logs)?;
    drop(progress);
    let mut validations = Vec::new();
    for file in &arguments.validate {
        let (log, _) = read_log(file, &model, &given)?;
        let (errors, _, findings) = found.validate(&log, &options.filter)?;
        judged.findings.extend(findings);
        if let Some(same) = logs.iter().find(|fitted| fitted.is_same(&log)) {
            let text =
                format!("--validate {file}: it holds the rows of {}, which were fitted: no other log", same.name);
            judged.findings.push(Finding::warning("same_log", text));
        }
        validations.push((file.clone(), errors));
    }
    let (robot, more) = describe(&found.setup.columns, &found.estimates.consistent.x, whole.description())?;
    judged.findings.extend(more);
    let findings: Vec<&Finding> = found.findings.iter().chain(&judged.findings).collect();
    findings.iter().for_each(|finding| failure::write(&format!("{finding}\n")));
    let verdict = Verdict::new(&found, validations.iter().map(|(_, errors)| errors));
    let has_warnings = findings.iter().any(|finding| finding.level != Level::Note);
    let written = match &out {
        Some(out) => out.write(&robot, arguments.old_values, settings())?,
        None => Vec::new(),
    };
    if let Some(file) = &arguments.report {
        save(file, mozzi_report::fit_html(&found, &judged, &validations))?;
    }
    let text = match arguments.robot.json {
        true => json::print(&json::of_robot(&model, mozzi_report::fit_json(&found, &judged, &validations))),
        false => {
            let (verdict, judged, validations, logs) = (&verdict, &judged, &validations, &columns);
            let is_all = arguments.all;
            let text =
                page::text(&found, &page::Shown { verdict, judged, validations, logs, written: &written, is_all });
            let words = arguments.write.map(|to| simulators::page(to, &found, &robot, &judged.servos));
            text + &words.unwrap_or_default()
        }
    };
    match found.estimates.consistent.is_stopped {
        true => Err(Failure::Stopped(text)),
        false if !verdict.is_trusted || arguments.robot.is_strict() && has_warnings => Err(Failure::Answered(text)),
        false => Ok(text),
    }
}

/// Reads a log without options of the command line.
pub fn log(file: &str, model: &Model) -> Result<Log> {
    let given = Given { order: &[], force: Force::Torque, topic: None, locked: &[] };
    Ok(read_log(file, model, &given)?.0)
}

impl IdentifyArguments {
    fn given<'g>(&'g self, locked: &'g [String]) -> Given<'g> {
        let force = if self.torque == Torque::Current { Force::Current } else { Force::Torque };
        Given { order: &self.order, force, topic: self.topic.as_deref(), locked }
    }

    /// The locks with each pattern replaced by the joints that it matches.
    fn lock_list(&self, robot: &Model) -> Result<Vec<String>> {
        let mut all = Vec::new();
        for text in &self.lock {
            let (pattern, position) = edits::split("--lock", text, "JOINT=POSITION")?;
            if !pattern.contains('*') {
                all.push(text.clone());
                continue;
            }
            let joints: Vec<&str> = robot.joint_names().filter(|name| matches(pattern, name)).collect();
            if joints.is_empty() {
                let names: Vec<&str> = robot.joint_names().collect();
                return Err(Failure::wrong(format!(
                    "--lock {text}: no joint matches `{pattern}`; the robot has {}",
                    names.join(", ")
                )));
            }
            failure::note(&format!("--lock {text}: {} are locked", joints.join(", ")));
            all.extend(joints.iter().map(|joint| format!("{joint}={position}")));
        }
        Ok(all)
    }

    /// Tables of the meaning of each column of each log.
    fn column_tables(&self, model: &Model, given: &Given) -> Result<String> {
        let mut tables: Vec<(String, Vec<Row>)> = Vec::new();
        for file in &self.logs {
            let samples = read_table(file, model, given)?;
            tables.push((samples.file.clone(), samples.columns));
        }
        Ok(match self.robot.json {
            true => json::print(&json::of_robot(model, page::columns_json(&tables))),
            false => page::columns(&tables),
        })
    }

    fn options(&self, model: &Model) -> Result<Options> {
        let sensor = if self.torque == Torque::Link { Sensor::Link } else { Sensor::Motor };
        let frame = || match &self.payload {
            Some(name) => model.frame(name),
            None => model.end_effector(),
        };
        let mut choice = match self.only {
            Some(Only::Friction) => Choice::only_friction(sensor),
            Some(Only::Payload) => Choice::only_payload(frame()?, sensor),
            None => Choice::all(sensor),
        };
        choice.gains = self.torque == Torque::Current;
        choice.width = number("--width", &self.width)?;
        choice.stribeck = self.stribeck.as_deref().map(|text| number("--stribeck", text)).transpose()?;
        choice.stiffness |= self.springs;
        choice.offset &= !self.no_offsets;
        let cutoff = match self.cutoff.as_str() {
            "auto" => Cutoff::Automatic,
            "none" => Cutoff::None,
            text => Cutoff::Hz(number("--cutoff", text)?),
        };
        let acceleration = match self.acceleration {
            How::Differences => Acceleration::Differences,
            How::Spline => Acceleration::Spline,
        };
        let percent = number("--fit", &self.fit)?;
        if !(10.0..=100.0).contains(&percent) || percent % 10.0 != 0.0 {
            return Err(Failure::wrong(format!("--fit is {percent}, expected 10, 20, … or 100")));
        }
        Ok(Options {
            choice,
            filter: Filter { cutoff, acceleration, ..Filter::default() },
            prior: number("--prior", &self.prior)?,
            robust: self.robust,
            limits: self.limits()?,
            tenths: (percent / 10.0) as usize,
            trust_log: self.trust_log,
        })
    }

    fn limits(&self) -> Result<Limits> {
        let mut limits = Limits::default();
        if let Some(text) = &self.total_mass {
            let [mass, deviation] = array("--total-mass", text, ["the mass", "its deviation"])?;
            limits.total_mass = Some([mass, deviation]);
        }
        for text in &self.between {
            let (name, list) = edits::split("--between", text, "NAME=LOW,HIGH")?;
            let [low, high] = array(&format!("--between {name}"), list, ["low", "high"])?;
            if low > high {
                return Err(Failure::wrong(format!("--between {name} is {low} to {high}, expected the lower first")));
            }
            limits.between.push((name.to_string(), [low, high]));
        }
        for text in &self.center_in {
            let (name, list) = edits::split("--center-in", text, "LINK=x,y,z,X,Y,Z")?;
            let corners = edits::corners(&format!("--center-in {name}"), list)?;
            limits.center_of_mass.push((name.to_string(), corners));
        }
        Ok(limits)
    }

    fn known_payloads(&self, model: &Model, logs: &mut [Log]) -> Result<()> {
        const EXPECTED: &str = "N:FRAME=m,cx,cy,cz";
        for text in &self.known_payload {
            let (name, list) = edits::split("--known-payload", text, EXPECTED)?;
            let (log, frame) = name
                .split_once(':')
                .ok_or_else(|| Failure::wrong(format!("--known-payload is `{text}`, expected {EXPECTED}")))?;
            let count = logs.len();
            let log =
                log.trim().parse::<usize>().ok().and_then(|k| logs.get_mut(k.checked_sub(1)?)).ok_or_else(|| {
                    Failure::wrong(format!("--known-payload is of log `{log}`, expected a number from 1 to {count}"))
                })?;
            let place = format!("--known-payload {name}");
            log.payload = Some((model.frame(frame)?, edits::payload(&place, list)?));
        }
        Ok(())
    }
}

/// Whether a text matches a pattern, in which `*` stands for any text.
fn matches(pattern: &str, text: &str) -> bool {
    let Some((first, rest)) = pattern.split_once('*') else { return pattern == text };
    let Some(mut left) = text.strip_prefix(first) else { return false };
    let mut parts: Vec<&str> = rest.split('*').collect();
    let last = parts.pop().unwrap_or_default();
    for part in parts {
        let Some(k) = left.find(part) else { return false };
        left = &left[k + part.len()..];
    }
    left.ends_with(last)
}

#[cfg(test)]
mod tests {
    use super::matches;

    #[test]
    fn a_star_matches_any_text() {
        for (pattern, text, expected) in [
            ("gripper_*", "gripper_left_joint", true),
            ("*_wheel_*", "front_wheel_joint", true),
            ("*", "a", true),
            ("arm_*_joint", "arm_1_joint", true),
            ("arm_*_joint", "arm_1_link", false),
            ("a*a", "a", false),
            ("head", "head_1", false),
        ] {
            assert_eq!(matches(pattern, text), expected, "{pattern} {text}");
        }
    }
}
