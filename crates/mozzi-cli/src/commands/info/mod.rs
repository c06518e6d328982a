//! `mozzi info`: joints, limits, links, masses and frames of a robot.

mod object;

use super::{assemble, robots};
use crate::angles;
use crate::failure::Result;
use crate::json;
use crate::robot::{RobotArguments, Units, screen};
use crate::table::short;
use crate::text::{Decimals, Page, Sections, column, column_within, largest, rows_of, scalar, table, tuple};
use clap::{Arg, Args};
use mozzi::model::State;
use mozzi::model::description::{Anchor, Constraint, ConstraintKind, Gear, Joint, Rotor};
use mozzi::{ConstraintRank, Description, Error, FrameId, Model, SE3, SpatialInertia};
use mozzi::{Freedom, Place};
use mozzi_urdf::counted;
use std::collections::BTreeSet;

#[derive(Args, Debug)]
pub struct InfoArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// Show all sections, however long
    #[arg(long)]
    all: bool,
}

/// Without a robot, the embedded ones are listed.
pub fn model(argument: Arg) -> Arg {
    argument.required(false).default_value("").hide_default_value(true)
}

pub fn run(arguments: &InfoArguments) -> Result<String> {
    if arguments.robot.model.is_empty() {
        return robots::list(arguments.robot.json);
    }
    let model = arguments.robot.load()?;
    let poses = model.frame_poses(&model.neutral_configuration::<f64>())?;
    let most = if arguments.all { usize::MAX } else { screen(&model) };
    Ok(if arguments.robot.json { json::print(&object::object(&model, &poses)) } else { page(&model, &poses, most) })
}

/// The mass of all links, kg.
pub fn total_mass(robot: &Description) -> f64 {
    robot.links.iter().map(|link| link.inertia.mass).sum()
}

/// Revolute, continuous, prismatic, helical or fixed.
pub fn kind(joint: &Joint) -> &'static str {
    match joint.kind.name() {
        "revolute" if joint.limits.position.is_none() => "continuous",
        name => name,
    }
}

pub fn headline(model: &Model) -> String {
    let robot = model.description();
    let joints = model.joint_names().len();
    let mimics = model.moving_links() - joints;
    let coupled = if mimics == 0 { String::new() } else { format!(" and {}", counted(mimics, "mimic joint")) };
    format!(
        "{}: {}{}{coupled}, {}, {} kg",
        robot.name,
        if model.is_floating() { "a floating base, " } else { "" },
        counted(joints, "independent joint"),
        counted(robot.links.len(), "link"),
        scalar(total_mass(robot)),
    )
}

/// Gravity, and the frame of a wrench.
pub fn surroundings(model: &Model) -> String {
    let tip = match model.end_effector() {
        Ok(frame) => format!("{}{}", model.frame_name(frame), coinciding(model, frame)),
        Err(Error::NoEndEffector { leaves }) => match leaves.get(..3) {
            Some(some) if leaves.len() > 3 => format!("to be named, such as {}, …", some.join(", ")),
            _ => format!("to be named, such as {}", leaves.join(", ")),
        },
        Err(error) => error.to_string(),
    };
    format!("gravity: {} m/s²; end effector: {tip}", tuple(&model.gravity().0))
}

/// " (`ee_link` has the same origin)", or " (by its name; other ends: `finger`)", if the end effector was chosen among
/// leaves.
fn coinciding(model: &Model, chosen: FrameId) -> String {
    let robot = model.description();
    let parents: BTreeSet<&str> = robot.joints.iter().map(|joint| joint.parent.as_str()).collect();
    let is_leaf = |name: &str| !parents.contains(name);
    let zero = model.neutral_configuration::<f64>();
    let Ok(at) = model.forward_kinematics(&zero, chosen) else { return String::new() };
    let is_there = |frame: FrameId| {
        model.forward_kinematics(&zero, frame).is_ok_and(|T| (0..3).all(|k| (T.p.0[k] - at.p.0[k]).abs() < 1e-9))
    };
    let name = model.frame_name(chosen);
    if !is_leaf(name) || robot.end_effector.is_some() {
        return String::new();
    }
    let others = model.frames().filter(|&(_, other)| other != name && is_leaf(other));
    let (there, elsewhere): (Vec<_>, Vec<_>) = others.partition(|&(frame, _)| is_there(frame));
    let list = |frames: &[(FrameId, &str)]| {
        let names: Vec<String> = frames.iter().map(|(_, name)| format!("`{name}`")).collect();
        names.join(", ")
    };
    match (&there[..], &elsewhere[..]) {
        ([], []) => String::new(),
        ([_], []) => format!(" ({} has the same origin)", list(&there)),
        (_, []) => format!(" ({} have the same origin)", list(&there)),
        (_, [.., _, _, _, _]) => format!(" (by its name, of {} ends)", elsewhere.len() + 1),
        _ => format!(" (by its name; other ends: {})", list(&elsewhere)),
    }
}

fn page(model: &Model, poses: &[SE3], most: usize) -> String {
    let (robot, units) = (model.description(), Units::of(model));
    let mut page = Page::default();
    page.line(headline(model)).line(surroundings(model));
    let mut sections = Sections::default();
    let units = format!("units: {}, {}, {}, s; a dash means none", units.input(0), units.input(1), units.input(3));
    let list: Vec<&Joint> = model.moving_joints().collect();
    let title = match list.first() {
        Some(first) if list.len() > 1 && list.iter().all(|joint| kind(joint) == kind(first)) => {
            format!("joints, all {}", kind(first))
        }
        _ => "joints".to_string(),
    };
    sections.add("joints", title, [joints(model), vec![units]].concat());
    if model.is_floating() {
        sections.add("base", "floating base", base(model));
    }
    sections.add("joints of several axes", "joints of several axes", several(model));
    sections.add("constraints", "constraints", constraints(model));
    sections.add("states", "states", states(model));
    sections.add("masses", "links: mass [kg], centre of mass in the link's frame [m]", masses(robot));
    let unit = angles::unit("rad");
    let frames_title = format!("frames at θ = 0: origin in the base frame [m], rotation vector ω̂θ [{unit}]");
    sections.add("frames", frames_title, frames(model, poses));
    let inertias_title = "links: inertia about the centre of mass, in the link's axes [kg m²]";
    sections.add("inertias", inertias_title, inertias(robot));
    sections.add("rotors", "rotors that several joints turn: inertia [kg m² or kg], gears", rotors(robot));
    sections.add("merged links", "links merged into a moving body by fixed joints [kg]", folded(model));
    sections.write(&mut page, most);
    page.end()
}

/// The entries that a floating base adds to the state.
fn base(model: &Model) -> Vec<String> {
    let list = |names: Vec<&str>| names.join(" ");
    let (positions, velocities) = (model.base().positions(), model.base().velocities());
    let G = model.base_inertia();
    vec![
        format!("θ has nq = {} entries: {}, then the joints", model.nq(), list(model.position_names().take(positions).collect())),
        format!("θ̇, θ̈ and τ have n = {}: {}, then the joints", model.n(), list(model.velocity_names().take(velocities).collect())),
        "the quaternion (w, x, y, z) and the origin, m, are its pose in {s}; its twist (ω, v) and its wrench (m, f) are in its own"
            .to_string(),
        "coordinates; gravity is in {s}".to_string(),
        format!("its mass with all links fixed to it is {} kg, centre of mass at {} m", scalar(G.mass), tuple(&G.center_of_mass().0)),
    ]
}

/// The entries that balls and free joints add to the state.
fn several(model: &Model) -> Vec<String> {
    let of_joint = |(joint, place): (&Joint, &Place)| {
        let says = match place.freedom {
            Freedom::One => return None,
            Freedom::Ball => {
                "the quaternion (w, x, y, z) rotates its link's axes from their orientation at 0; ω in its link's axes"
            }
            Freedom::Free => "pose relative to its link's pose at 0; twist (ω, v) in its link's coordinates",
        };
        let list = |names: Vec<&str>| names.join(" ");
        let (q, j) = (place.positions(), place.velocities());
        let positions = list(model.position_names().skip(q.start).take(q.len()).collect());
        let velocities = list(model.velocity_names().skip(j.start).take(j.len()).collect());
        Some(format!("{}: θ has {positions}, θ̇ has {velocities}: {says}", joint.name))
    };
    model.joints().zip(model.places()).filter_map(of_joint).collect()
}

/// An angle of a turning joint, in degrees with `--deg`.
fn shown(joint: &Joint, x: f64) -> f64 {
    angles::of_joint(joint.kind, x)
}

/// The lowest (0) or highest (1) position.
fn bound(joint: &Joint, side: usize) -> Option<f64> {
    let x = joint.limits.bounds()[side];
    x.is_finite().then(|| shown(joint, x))
}

fn joints(model: &Model) -> Vec<String> {
    let list: Vec<&Joint> = model.moving_joints().collect();
    let mut j = 0;
    let number = |joint: &Joint| match &joint.mimic {
        Some(_) => String::new(),
        None => {
            j += 1;
            j.to_string()
        }
    };
    let of = |pick: fn(&Joint) -> Option<f64>| {
        let values: Vec<Option<f64>> = list.iter().map(|joint| pick(joint)).collect();
        let decimals = Decimals::kept(values.iter().flatten());
        values.into_iter().map(|x| x.map_or("–".to_string(), |x| decimals.show(x))).collect::<Vec<_>>()
    };
    let text = |pick: &dyn Fn(&Joint) -> String| list.iter().map(|joint| pick(joint)).collect::<Vec<_>>();
    let follows = |joint: &Joint| match &joint.mimic {
        Some(mimic) => {
            let source = list.iter().find(|source| source.name == mimic.joint);
            let ratio = mimic.ratio * shown(joint, 1.0) / source.map_or(1.0, |source| shown(source, 1.0));
            format!("{} · {} + {}", scalar(ratio), mimic.joint, scalar(shown(joint, mimic.offset)))
        }
        None => String::new(),
    };
    let mut columns = vec![
        ("", list.iter().copied().map(number).collect::<Vec<_>>()),
        ("joint", text(&|joint| joint.name.clone())),
        ("type", text(&|joint| kind(joint).to_string())),
        ("moves", text(&|joint| joint.child.clone())),
        ("lowest", of(|joint| bound(joint, 0))),
        ("highest", of(|joint| bound(joint, 1))),
        ("speed", of(|joint| joint.limits.velocity.map(|speed| shown(joint, speed)))),
        ("effort", of(|joint| joint.limits.effort)),
        ("damping", of(|joint| (joint.damping != 0.0).then_some(joint.damping))),
        ("friction", of(|joint| (joint.friction != 0.0).then_some(joint.friction))),
        ("rotor", of(|joint| (joint.armature != 0.0).then_some(joint.armature))),
        ("stiffness", of(|joint| (joint.stiffness != 0.0).then_some(joint.stiffness))),
        ("rests at", of(|joint| (joint.stiffness != 0.0).then_some(shown(joint, joint.spring_reference)))),
        ("follows", text(&follows)),
    ];
    if list.len() > 1 && list.iter().all(|joint| kind(joint) == kind(list[0])) {
        columns.retain(|(name, _)| *name != "type"); // the title has it
    }
    columns.retain(|(name, cells)| *name == "joint" || cells.iter().any(|cell| !cell.is_empty() && cell != "–"));
    let align: String = columns
        .iter()
        .map(|(name, _)| if ["joint", "type", "moves", "follows"].contains(name) { 'l' } else { 'r' })
        .collect();
    let columns = columns.into_iter().map(|(name, cells)| [vec![name.to_string()], cells].concat()).collect();
    table(&rows_of(columns), &align)
}

fn rotors(robot: &Description) -> Vec<String> {
    let row = |rotor: &Rotor| vec![rotor.name.clone(), scalar(rotor.armature), gears(&rotor.gears)];
    table(&robot.rotors.iter().map(row).collect::<Vec<_>>(), "lrl")
}

/// "2 · shoulder + elbow"
fn gears(gears: &[Gear]) -> String {
    let gear = |gear: &Gear| match gear.ratio {
        1.0 => gear.joint.clone(),
        ratio => format!("{} · {}", scalar(ratio), gear.joint),
    };
    gears.iter().map(gear).collect::<Vec<_>>().join(" + ")
}

/// Each constraint, and the rank of all of them at the assembled start.
fn constraints(model: &Model) -> Vec<String> {
    let anchor = |anchor: &Anchor| anchor.frame.clone().unwrap_or_else(|| "{s}".to_string());
    let row = |constraint: &Constraint| {
        let (what, length) = match &constraint.kind {
            ConstraintKind::Frames { a, b, closure } => (
                format!("{} and {}", anchor(a), anchor(b)),
                closure.length().map_or_else(String::new, |length| format!("{} m", scalar(*length))),
            ),
            ConstraintKind::Joint { joints, source, polynomial } => {
                let powers = ["", " x", " x²", " x³", " x⁴"];
                let terms = polynomial.iter().zip(powers).filter(|(c, _)| **c != 0.0);
                let terms: Vec<String> = terms.map(|(c, power)| format!("{}{power}", scalar(*c))).collect();
                let sum = if terms.is_empty() { "0".to_string() } else { terms.join(" + ") };
                let of = if source.is_empty() { String::new() } else { format!(", x = {}", gears(source)) };
                (format!("{} = {sum}{of}", gears(joints)), String::new())
            }
        };
        vec![constraint.name.clone(), constraint.kind_name().to_string(), what, length]
    };
    let mut lines = table(&model.constraints().iter().map(row).collect::<Vec<_>>(), "l");
    if model.constraint_rows() > 0 {
        lines.push(match rank(model) {
            Ok(rank) => assemble::summary(&rank),
            Err(error) => error.to_string(),
        });
    }
    lines
}

/// The rank at the assembled start.
fn rank(model: &Model) -> std::result::Result<ConstraintRank, Error> {
    model.constraint_rank(&model.assemble(&model.start().theta, &[])?)
}

/// Positions of a state that fit into a line.
const SHOWN: usize = 2;

/// The states that the robot's file names, and which of them is the start.
fn states(model: &Model) -> Vec<String> {
    let (start, are_angles) = (model.description().start.as_deref(), angles::of_positions(model));
    let row = |name: &str| {
        let State { time, theta, dtheta } = model.state(name).ok()?;
        let more = if theta.len() > SHOWN { format!(" … {} in all", theta.len()) } else { String::new() };
        let is_start = if start == Some(name) { "the start" } else { "" };
        let moves = if dtheta.iter().any(|&x| x != 0.0) { "moving" } else { "at rest" };
        let theta = angles::shown(&theta[..theta.len().min(SHOWN)], &are_angles);
        let theta = format!("{}{more}", short(&theta));
        Some(
            [name, is_start, &format!("t = {} s", scalar(time)), moves, &format!("θ = {theta}")]
                .map(str::to_string)
                .to_vec(),
        )
    };
    table(&model.state_names().filter_map(row).collect::<Vec<_>>(), "l")
}

/// Each body made of several links: its own link, then those fixed to it, each with its mass.
fn folded(model: &Model) -> Vec<String> {
    let mut rows = Vec::new();
    for body in model.folded_links().iter().filter(|body| body.links.len() > 1) {
        let of = body.joint.map_or("base".to_string(), |joint| format!("moved by {joint}"));
        for (k, (link, mass)) in body.links.iter().enumerate() {
            let first = if k == 0 { format!("{of}, {}", scalar(body.mass())) } else { String::new() };
            rows.push(vec![first, if k == 0 { link.to_string() } else { format!("+ {link}") }, scalar(*mass)]);
        }
    }
    table(&rows, "l")
}

type Pick = fn(&SpatialInertia) -> f64;

fn masses(robot: &Description) -> Vec<String> {
    let c: [(&str, Pick); 4] = [
        ("mass", |G| G.mass),
        ("c_x", |G| G.center_of_mass().0[0]),
        ("c_y", |G| G.center_of_mass().0[1]),
        ("c_z", |G| G.center_of_mass().0[2]),
    ];
    of_links(robot, &c)
}

fn inertias(robot: &Description) -> Vec<String> {
    let I: [(&str, Pick); 6] = [
        ("I_xx", |G| G.about_center_of_mass().xx),
        ("I_yy", |G| G.about_center_of_mass().yy),
        ("I_zz", |G| G.about_center_of_mass().zz),
        ("I_xy", |G| G.about_center_of_mass().xy),
        ("I_xz", |G| G.about_center_of_mass().xz),
        ("I_yz", |G| G.about_center_of_mass().yz),
    ];
    of_links(robot, &I)
}

fn of_links(robot: &Description, picks: &[(&str, Pick)]) -> Vec<String> {
    let mut columns =
        vec![[vec!["link".to_string()], robot.links.iter().map(|link| link.name.clone()).collect()].concat()];
    for (name, pick) in picks {
        let values: Vec<f64> = robot.links.iter().map(|link| pick(&link.inertia)).collect();
        columns.push([vec![name.to_string()], column(&values)].concat());
    }
    table(&rows_of(columns), "lr")
}

fn frames(model: &Model, poses: &[SE3]) -> Vec<String> {
    let names: Vec<String> = model.frames().map(|(_, name)| name.to_string()).collect();
    let origins: Vec<[f64; 3]> = poses.iter().map(|T| T.p.0).collect();
    let turns: Vec<[f64; 3]> = poses.iter().map(|T| T.R.log().0.map(angles::of_turn)).collect();
    let mut columns = vec![[vec!["frame".to_string()], names].concat()];
    for (heads, rows) in [(["x", "y", "z"], origins), (["about x", "about y", "about z"], turns)] {
        let most = largest(rows.as_flattened());
        for (k, head) in heads.iter().enumerate() {
            let values: Vec<f64> = rows.iter().map(|row| row[k]).collect();
            columns.push([vec![head.to_string()], column_within(&values, most)].concat());
        }
    }
    table(&rows_of(columns), "lr")
}
