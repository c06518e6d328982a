//! One state of a robot, by flags.

use crate::angles;
use crate::failure::{Failure, Result};
use crate::numbers::{self, WRENCH, array, wrong_count};
use crate::text::{Page, page_width, width};
use clap::Args;
use mozzi::model::State;
use mozzi::{Environment, FrameId, Model, Wrench};

#[derive(Args, Debug, Default)]
pub struct StartArguments {
    /// Positions θ, rad or m, a floating base's pose first or left out; JOINT=POSITION,… for some; or the name of a
    /// state [default: the robot's start, else joints at 0 and a floating base at {s}]
    #[arg(long, visible_alias = "q", aliases = ["qpos", "positions"], value_name = "θ1,θ2,…")]
    pub theta: Option<String>,
    /// Velocities θ̇, rad/s or m/s; a floating base's twist first, in its own coordinates; JOINT=VELOCITY,… for some
    /// [default: all 0]
    #[arg(long, visible_alias = "qd", value_name = "θ̇1,θ̇2,…")]
    pub dtheta: Option<String>,
    /// Take θ and θ̇ from a named state of the robot's file, such as a keyframe; `mozzi info` lists them
    #[arg(long, value_name = "NAME", conflicts_with_all = ["theta", "dtheta"])]
    pub state: Option<String>,
}

#[derive(Args, Debug, Default)]
pub struct TipArguments {
    /// Wrench that the end effector applies to the environment, in its own frame, moment first: N m, N [default: 0]
    #[arg(long, value_name = "mx,my,mz,fx,fy,fz")]
    pub tip_wrench: Option<String>,
}

/// Wrenches on the environment, of the end effector and of any frames.
#[derive(Args, Debug, Default)]
pub struct WrenchArguments {
    #[command(flatten)]
    pub tip: TipArguments,
    /// Wrench that a frame applies to the environment, in its own coordinates, moment first: N m, N; may be repeated
    #[arg(long, value_name = "FRAME=mx,my,mz,fx,fy,fz")]
    pub wrench: Vec<String>,
}

/// A state of motion and the tip's wrench: θ, θ̇, and θ̈ or τ.
#[derive(Args, Debug)]
pub struct MotionArguments {
    #[command(flatten)]
    start: StartArguments,
    /// Accelerations θ̈, rad/s² or m/s² [default: all 0]
    #[arg(long, visible_alias = "qdd", value_name = "θ̈1,θ̈2,…")]
    ddtheta: Option<String>,
    /// Joint forces τ, N m or N, instead of θ̈, which is then computed
    #[arg(long, value_name = "τ1,τ2,…", conflicts_with = "ddtheta")]
    tau: Option<String>,
    #[command(flatten)]
    tip: TipArguments,
}

/// (θ, θ̇, θ̈), and the tip's wrench with its frame, if there is one.
pub struct Motion {
    pub state: [Vec<f64>; 3],
    pub applied: Vec<(FrameId, Wrench)>,
}

impl MotionArguments {
    /// (θ, θ̇).
    pub fn start(&self, model: &Model) -> Result<(Vec<f64>, Vec<f64>)> {
        self.start.read(model)
    }

    pub fn read(&self, model: &Model) -> Result<Motion> {
        let (theta, dtheta) = self.start.read(model)?;
        let applied = self.tip.read(model)?;
        let ddtheta = match &self.tau {
            None => velocities("--ddtheta", self.ddtheta.as_deref(), model)?,
            Some(tau) => {
                let tau = velocities("--tau", Some(tau), model)?;
                model.forward_dynamics(&theta, &dtheta, &tau, &environment(model, &applied))?.as_slice().to_vec()
            }
        };
        Ok(Motion { state: [theta, dtheta, ddtheta], applied })
    }
}

/// The name of a state that is given by numbers, if the robot has no state of this name.
const GIVEN: &str = "given";

impl StartArguments {
    /// The name of the requested state.
    pub fn name<'a>(&'a self, model: &Model) -> Option<&'a str> {
        let is_state = |text: &&str| model.state_names().any(|name| name == *text);
        self.state.as_deref().or(self.theta.as_deref().filter(is_state))
    }

    /// The positions that are not given.
    pub fn left_out(&self, model: &Model) -> Vec<bool> {
        let all = |is_left_out: bool| vec![is_left_out; model.nq()];
        match self.theta.as_deref() {
            None => all(self.state.is_none()),
            Some(text) if text.contains('=') => {
                let given: Vec<&str> =
                    text.split(',').filter_map(|entry| Some(entry.split_once('=')?.0.trim())).collect();
                model.position_names().map(|name| !given.contains(&name)).collect()
            }
            Some(text) if gives_joints_only(text, model) => (0..model.nq()).map(|k| k < 7).collect(),
            Some(_) => all(false),
        }
    }

    /// True if a state is given.
    pub fn is_given(&self) -> bool {
        self.state.is_some() || self.theta.is_some() || self.dtheta.is_some()
    }

    /// The robot with the given state as its start.
    pub fn started(&self, model: Model) -> Result<Model> {
        match &self.state {
            _ if !self.is_given() => Ok(model),
            Some(name) => Ok(model.with_start(name)?),
            None => {
                let (theta, dtheta) = self.read(&model)?;
                let state = State { time: 0.0, theta, dtheta };
                Ok(model.with_state(GIVEN, &state)?.with_start(GIVEN)?)
            }
        }
    }

    /// (θ, θ̇).
    pub fn read(&self, model: &Model) -> Result<(Vec<f64>, Vec<f64>)> {
        let [state, theta, dtheta] = [&self.state, &self.theta, &self.dtheta].map(Option::as_deref);
        start(model, state, theta, dtheta)
    }
}

/// (θ, θ̇) of a named state, or from numbers. The default is the robot's start; θ̇ is 0 if only θ is given.
pub fn start(
    model: &Model,
    state: Option<&str>,
    theta: Option<&str>,
    dtheta: Option<&str>,
) -> Result<(Vec<f64>, Vec<f64>)> {
    let State { theta: begin, dtheta: rates, .. } = match state {
        Some(name) => model.state(name)?,
        None => model.start(),
    };
    let dtheta = match (theta, dtheta) {
        (None, None) => rates,
        _ => velocities("--dtheta", dtheta, model)?,
    };
    Ok((if theta.is_some() { positions("--theta", theta, model)? } else { begin }, dtheta))
}

impl TipArguments {
    /// The wrench with its frame; an error if there is a wrench but no end effector.
    pub fn read(&self, model: &Model) -> Result<Vec<(FrameId, Wrench)>> {
        match &self.tip_wrench {
            None => Ok(Vec::new()),
            Some(text) => Ok(vec![(model.end_effector()?, Wrench::from_array(array("--tip-wrench", text, WRENCH)?))]),
        }
    }
}

impl WrenchArguments {
    /// Each frame's wrench.
    pub fn read(&self, model: &Model) -> Result<Vec<(FrameId, Wrench)>> {
        let mut applied = self.tip.read(model)?;
        for text in &self.wrench {
            let Some((name, numbers)) = text.rsplit_once('=') else {
                let of_tip = format!("; --tip-wrench {text} is the end effector's");
                let remedy = if numbers::count(text) == WRENCH.len() { of_tip.as_str() } else { "" };
                return Err(Failure::wrong(format!("--wrench is `{text}`, expected FRAME=mx,my,mz,fx,fy,fz{remedy}")));
            };
            let numbers = array(&format!("--wrench {name}"), numbers, WRENCH)?;
            applied.push((model.frame(name)?, Wrench::from_array(numbers)));
        }
        check_frames(model, applied.iter().map(|(frame, _)| *frame))?;
        Ok(applied)
    }
}

/// Checks that each frame's wrench is given once.
pub fn check_frames(model: &Model, frames: impl Iterator<Item = FrameId>) -> Result<()> {
    let mut seen = Vec::new();
    for frame in frames {
        if seen.contains(&frame) {
            let name = model.frame_name(frame);
            return Err(Failure::wrong(format!("the wrench of the frame `{name}` is given twice, expected once")));
        }
        seen.push(frame);
    }
    Ok(())
}

/// nq numbers, or those of a state by its name; the robot's start if the flag is not given, and for what it leaves out.
pub fn positions(flag: &str, text: Option<&str>, model: &Model) -> Result<Vec<f64>> {
    let start = model.start().theta;
    match text {
        None => Ok(start),
        Some(text) => positions_from(start, flag, text, model),
    }
}

/// nq numbers, or those of a state by its name; what is left out stays as it is.
pub fn positions_from(theta: Vec<f64>, flag: &str, text: &str, model: &Model) -> Result<Vec<f64>> {
    let is_name =
        |text: &str| model.state_names().len() > 0 && numbers::angle(flag, text).is_err() && !text.contains(',');
    let are_angles = angles::of_positions(model);
    match text {
        text if text.contains('=') => {
            let names: Vec<&str> = model.position_names().collect();
            with_named(theta, flag, text, &names, &are_angles)
        }
        name if is_name(name) => Ok(model.state(name)?.theta),
        text => {
            if gives_joints_only(text, model) {
                let mut theta = theta;
                theta[7..].copy_from_slice(&numbers::angles(flag, text, &are_angles[7..])?);
                angles::question(flag, text, &theta[7..], &are_angles[7..]);
                return Ok(theta);
            }
            let layout = "base quaternion (w, x, y, z), base origin";
            entries(flag, text, model, model.position_names().collect(), layout, &are_angles)
        }
    }
}

/// True for the joints of a floating base alone; the base then stays where it is.
fn gives_joints_only(text: &str, model: &Model) -> bool {
    model.is_floating() && model.nq() > 7 && numbers::count(text) == model.nq() - 7
}

/// `elbow=90deg,wrist=0.1`: these entries, the others as they are.
fn with_named(mut x: Vec<f64>, flag: &str, text: &str, names: &[&str], are_angles: &[bool]) -> Result<Vec<f64>> {
    for (k, value) in by_name(flag, text, names)? {
        let place = format!("{flag} {}", names[k]);
        x[k] = if are_angles[k] { numbers::angle(place, value)? } else { numbers::number(place, value)? };
        angles::question(flag, value, &x[k..=k], &are_angles[k..=k]);
    }
    Ok(x)
}

/// Each entry of `elbow=90deg,wrist=0.1`: its place among the names, and its value.
pub fn by_name<'t>(flag: &str, text: &'t str, names: &[&str]) -> Result<Vec<(usize, &'t str)>> {
    let mut found: Vec<(usize, &str)> = Vec::new();
    for entry in text.split(',').filter(|entry| !entry.trim().is_empty()) {
        let Some((name, value)) = entry.split_once('=').map(|(name, value)| (name.trim(), value.trim())) else {
            return Err(Failure::wrong(format!("{flag}: `{entry}` has no name, expected JOINT=NUMBER,… or numbers")));
        };
        let Some(k) = names.iter().position(|known| *known == name) else {
            let near = mozzi_urdf::did_you_mean(name, names.iter().copied());
            let near = near.unwrap_or_else(|| format!("expected {}", names.join(", ")));
            return Err(Failure::wrong(format!("{flag}: there is no joint `{name}`; {near}")));
        };
        if found.iter().any(|(known, _)| *known == k) {
            return Err(Failure::wrong(format!("{flag}: `{name}` is given twice, expected once")));
        }
        found.push((k, value));
    }
    Ok(found)
}

/// n numbers, zeros where none is given.
pub fn velocities(flag: &str, text: Option<&str>, model: &Model) -> Result<Vec<f64>> {
    let (base, are_rates) = match flag {
        "--tau" => ("base wrench (m, f)", false),
        "--ddtheta" => ("base acceleration (ω̇, v̇)", true),
        "--x" => ("the base's entries", false),
        _ => ("base twist (ω, v)", true),
    };
    let are_angles = if are_rates { angles::of_velocities(model) } else { vec![false; model.n()] };
    match text {
        None => Ok(vec![0.0; model.n()]),
        Some(text) if text.contains('=') => {
            let names: Vec<&str> = model.velocity_names().collect();
            with_named(vec![0.0; model.n()], flag, text, &names, &are_angles)
        }
        Some(text) => entries(flag, text, model, model.velocity_names().collect(), base, &are_angles),
    }
}

/// One number for each name; for a floating base, `layout` describes the entries before the joints.
fn entries(
    flag: &str,
    text: &str,
    model: &Model,
    names: Vec<&str>,
    layout: &str,
    are_angles: &[bool],
) -> Result<Vec<f64>> {
    let found = numbers::angles(flag, text, are_angles)?;
    if found.len() == names.len() {
        angles::question(flag, text, &found, are_angles);
        return Ok(found);
    }
    if !model.is_floating() {
        let failure = numbers::wrong_number(flag, found.len(), &names); // by name: a ball has several entries
        return Err(match (failure, found.len().checked_sub(names.len())) {
            (Failure::Wrong(said), Some(6 | 7)) => Failure::Wrong(format!("{said}; --floating frees the base")),
            (failure, _) => failure,
        });
    }
    let joints = match model.joint_names().len() {
        0 => String::new(),
        many => format!(", then {}", mozzi_urdf::counted(many, "joint")),
    };
    Err(wrong_count(flag, found.len(), names.len(), &format!("{layout}{joints}")))
}

/// Flags with all digits, to paste into another command; a long list goes on in the next line, as shells join them.
pub fn pasted(page: &mut Page, flags: &[(&str, &[f64])]) {
    let mut line = if angles::are_degrees() { "--deg".to_string() } else { String::new() };
    for (flag, values) in flags {
        line += if line.is_empty() { "" } else { " " };
        line += flag;
        line.push('=');
        for (k, x) in values.iter().enumerate() {
            let entry = format!("{x:?}{}", if k + 1 < values.len() { "," } else { "" });
            if width(&line) + entry.len() + 1 > page_width() {
                page.verbatim(&(line + "\\"));
                line = String::new();
            }
            line += &entry;
        }
    }
    page.verbatim(&line);
}

/// The model's gravity, and the wrenches that the robot applies.
pub fn environment<'a>(model: &Model, applied: &'a [(FrameId, Wrench)]) -> Environment<'a> {
    Environment { applied, ..model.environment() }
}
