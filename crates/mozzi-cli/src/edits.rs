//! `--payload`, `--inertia`, `--lock`, `--pin`: edits of the robot before it is used.

use crate::angles::{question, turns};
use crate::failure::{self, Failure, Result};
use crate::numbers::{angle, array, number, numbers};
use crate::text::about;
use crate::workload;
use clap::Args;
use mozzi::linalg::Sym3;
use mozzi::model::description::{Anchor, Constraint};
use mozzi::{Base, Model, SpatialInertia, Vec3};

#[derive(Args, Debug, Default)]
pub struct EditArguments {
    /// Add a payload to a link or frame, the end effector if none is named: its mass, kg, its centre of mass, m, and
    /// moments about that centre, kg m², in the frame's axes [default: a point mass at the frame's origin]
    #[arg(long, value_name = "[FRAME=]m[,cx,cy,cz[,Ixx,Ixy,Ixz,Iyy,Iyz,Izz]]")]
    payload: Vec<String>,
    /// Replace a link's inertia: as --payload, in the link's axes
    #[arg(long, value_name = "LINK=m,cx,cy,cz,Ixx,Ixy,Ixz,Iyy,Iyz,Izz")]
    inertia: Vec<String>,
    /// Lock a joint at a position, rad or m, and its mimic joints with it; θ then has no entry for them
    #[arg(long, value_name = "JOINT=POSITION")]
    lock: Vec<String>,
}

/// A centre of mass that is so far from its frame is questioned, m.
const FAR: f64 = 10.0;
const INERTIA: [&str; 10] = ["m", "c_x", "c_y", "c_z", "I_xx", "I_xy", "I_xz", "I_yy", "I_yz", "I_zz"];

impl EditArguments {
    /// Inertias first, so that a payload is added to the new inertia; then payloads; then locks.
    pub fn apply(&self, mut model: Model) -> Result<Model> {
        for text in &self.inertia {
            let (name, list) = split("--inertia", text, "LINK=m,cx,cy,cz,Ixx,Ixy,Ixz,Iyy,Iyz,Izz")?;
            let place = format!("--inertia {name}");
            let inertia = inertia(&place, array(&place, list, INERTIA)?)?;
            let mut robot = model.description().clone();
            let Some(link) = robot.links.iter_mut().find(|link| link.name == name) else {
                let known: Vec<&str> = model.description().links.iter().map(|link| link.name.as_str()).collect();
                return Err(Failure::wrong(format!(
                    "--inertia: there is no link `{name}`, expected one of {}",
                    known.join(", ")
                )));
            };
            link.inertia = inertia;
            model = robot.build()?;
        }
        for text in &self.payload {
            let (name, list) = match text.rsplit_once('=') {
                Some((name, list)) => (name.to_string(), list),
                None => (model.frame_name(model.end_effector()?).to_string(), text.as_str()),
            };
            let place = format!("--payload {name}");
            model = model.with_payload(model.frame(&name)?, payload(&place, list)?)?;
        }
        let locks = locks(&self.lock, &model)?;
        Ok(if locks.is_empty() { model } else { model.with_locked_joints(&locks)? })
    }
}

/// The robot whose parameters are sought: with the rotors of `--coupled`, and joints locked. One with too many
/// parameters is refused.
pub fn sought(robot: &Model, coupled_texts: &[String], lock_texts: &[String]) -> Result<Model> {
    let coupled = coupled(robot, coupled_texts)?;
    let locks = locks(lock_texts, robot)?;
    let sought = if locks.is_empty() { coupled } else { coupled.with_locked_joints(&locks)? };
    workload::square("parameters", sought.parameter_count())?;
    Ok(sought)
}

/// The robot with the rotors of `--coupled`, each from a text "JOINT[=RATIO],JOINT[=RATIO]".
fn coupled(robot: &Model, texts: &[String]) -> Result<Model> {
    let mut robot = robot.clone();
    for text in texts {
        let mut gears = Vec::new();
        for part in text.split(',') {
            let (joint, ratio) = match part.split_once('=') {
                Some((joint, ratio)) => (joint.trim(), number(format!("--coupled {joint}"), ratio)?),
                None => (part.trim(), 1.0),
            };
            if !robot.description().joints.iter().any(|one| one.name == joint) {
                let names: Vec<&str> = robot.joint_names().collect();
                return Err(Failure::wrong(format!(
                    "--coupled {text}: there is no joint `{joint}`; the robot has {}",
                    names.join(", ")
                )));
            }
            gears.push((joint, ratio));
        }
        if gears.len() < 2 {
            return Err(Failure::wrong(format!("--coupled {text}: one joint, expected two or more with commas")));
        }
        let name = gears.iter().map(|(joint, _)| *joint).collect::<Vec<_>>().join("+");
        robot = robot.with_rotor(name, 0.0, &gears)?;
    }
    Ok(robot)
}

/// Joints with their positions, from texts "JOINT=POSITION".
pub fn locks<'t>(texts: &'t [String], model: &Model) -> Result<Vec<(&'t str, f64)>> {
    let mut found = Vec::new();
    for text in texts {
        let (name, position) = split("--lock", text, "JOINT=POSITION")?;
        if found.iter().any(|(known, _)| *known == name) {
            return Err(Failure::wrong(format!("--lock {name} is given twice, expected one position for each joint")));
        }
        let is_turning = model.joints().any(|joint| joint.name == name && turns(joint.kind));
        let place = format!("--lock {name}");
        let x = if is_turning { angle(&place, position)? } else { number(&place, position)? };
        question(&place, position, &[x], &[is_turning]);
        found.push((name, x));
    }
    Ok(found)
}

/// A payload: m; m and c; or these and six moments.
pub fn payload(place: &str, list: &str) -> Result<SpatialInertia> {
    let mut list = numbers(place, list)?;
    let found = list.len();
    list.resize(INERTIA.len(), 0.0);
    match (found, list.try_into()) {
        (1 | 4 | 10, Ok(all)) => {
            let [_, x, y, z, ..]: [f64; 10] = all;
            let distance = Vec3([x, y, z]).norm();
            if distance > FAR {
                failure::note(&format!("{place} has its centre of mass {} m away; it is in m", about(distance)));
            }
            inertia(place, all)
        }
        _ => Err(Failure::wrong(format!(
            "{place} has {found} entries, expected m, m and c, or all of {}",
            INERTIA.join(", ")
        ))),
    }
}

/// Two opposite corners of a box, the lower one first: x, y, z, X, Y, Z.
pub fn corners(place: &str, list: &str) -> Result<[[f64; 3]; 2]> {
    let [x, y, z, X, Y, Z] = array(place, list, ["x", "y", "z", "X", "Y", "Z"])?;
    for (axis, low, high) in [("x", x, X), ("y", y, Y), ("z", z, Z)] {
        if low > high {
            return Err(Failure::wrong(format!(
                "{place} goes from {low} to {high} in {axis}, expected the lower first"
            )));
        }
    }
    Ok([[x, y, z], [X, Y, Z]])
}

/// The robot with frames pinned to {s} where they are at θ: a weld, or for FRAME=point a ball joint at its origin. The
/// motors of a floating base are then named, so that gravity compensation knows that the base has none.
pub fn pinned(model: Model, texts: &[String], theta: &[f64]) -> Result<Model> {
    let mut robot = model.description().clone();
    for text in texts {
        let (name, how) = text.rsplit_once('=').unwrap_or((text, "weld"));
        let T = model.forward_kinematics(theta, model.frame(name)?)?;
        let closure = match how {
            "weld" => Constraint::weld,
            "point" => Constraint::point,
            _ => return Err(Failure::wrong(format!("--pin {name} is `{how}`, expected weld or point"))),
        };
        robot.constraints.push(closure(format!("pin {name}"), Anchor::world(T), Anchor::frame(name)));
    }
    if robot.base == Base::Floating && robot.motors.is_none() {
        robot.motors = Some(model.joints().map(|joint| joint.name.clone()).collect());
    }
    Ok(robot.build()?)
}

/// The parts before and after the last `=`.
pub fn split<'t>(flag: &str, text: &'t str, expected: &str) -> Result<(&'t str, &'t str)> {
    text.rsplit_once('=').ok_or_else(|| Failure::wrong(format!("{flag} is `{text}`, expected {expected}")))
}

/// An inertia that a body can have.
pub fn inertia(place: &str, [m, x, y, z, xx, xy, xz, yy, yz, zz]: [f64; 10]) -> Result<SpatialInertia> {
    let G = SpatialInertia::new(m, Vec3([x, y, z]), Sym3 { xx, xy, xz, yy, yz, zz });
    let verdict = G.verdict();
    if verdict.is_physical() { Ok(G) } else { Err(Failure::wrong(format!("{place}: {verdict}"))) }
}
