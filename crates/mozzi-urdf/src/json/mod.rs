//! A robot as JSON: its links and joints, which are read back, and the book's lists, which follow from them. The format
//! of `mozzi convert`, and the only one that expresses every [`Description`]: a round trip gives the same numbers.

mod entry;
mod file;
mod keys;
mod position;
mod states;
mod value;

pub use entry::{At, Read};
pub use file::{File, Misplaced, Step, unknown_key};
pub(crate) use keys::GEAR;
pub use keys::Object;
pub(crate) use position::Place;
pub use value::{pose, print, rows, screws, vector};

use crate::constraints;
use mozzi::model::description::{FreeJoint, Gear, Joint, JointKind, Limits, Mimic, NamedFrame, Rotor};
use mozzi::{Base, Description, Model, ScrewAxis, SpatialInertia, Vec3};
use serde_json::{Value, json};

/// A robot as a file, over several lines, with the book's lists.
pub fn write(model: &Model) -> String {
    let mut value = to_value(model.description());
    value["lists"] = model.screws().ok().map(|lists| screws(&lists)).into(); // of joints of one axis
    print(&value)
}

/// A robot as a value, without the book's lists. Numbers that are not finite become null.
pub fn to_value(robot: &Description) -> Value {
    let is_floating = robot.base == Base::Floating;
    let closing: Value = serde_json::from_str(&constraints::write(robot)).unwrap_or_default();
    let joint = |joint: &Joint| {
        let mut value = json!({
            "name": joint.name, "parent": joint.parent, "child": joint.child,
            "M": pose(joint.origin),
            "A": match joint.kind {
                JointKind::Screw(A) => vector(&A.twist().to_array()),
                JointKind::Fixed | JointKind::Ball(_) | JointKind::Free => Value::Null,
            },
            "ball": match joint.kind {
                JointKind::Ball(center) => vector(&center.0),
                _ => Value::Null,
            },
            "free": joint.kind == JointKind::Free,
            "position": joint.limits.position.map(|limits| vector(&limits)),
            "velocity": joint.limits.velocity, "effort": joint.limits.effort,
            "damping": joint.damping, "friction": joint.friction, "armature": joint.armature,
            "stiffness": joint.stiffness, "spring_reference": joint.spring_reference,
            "mimic": joint.mimic.as_ref().map(|m| json!({ "joint": m.joint, "ratio": m.ratio, "offset": m.offset })),
        });
        if let Some(limit) = joint.limits.acceleration {
            value["acceleration"] = limit.into(); // few robots have one
        }
        value
    };
    json!({
        "robot": robot.name,
        "base": if is_floating { "floating" } else { "fixed" },
        "free_joint": is_floating.then(|| json!({ "name": robot.free_joint.name, "parent": robot.free_joint.parent })),
        "gravity": vector(&robot.gravity),
        "end_effector": robot.end_effector,
        "links": robot.links.iter().map(|link| json!({
            "name": link.name, "G": rows(link.inertia.to_matrix()),
        })).collect::<Value>(),
        "joints": robot.joints.iter().map(joint).collect::<Value>(),
        "rotors": robot.rotors.iter().map(|rotor| json!({
            "name": rotor.name, "armature": rotor.armature,
            "gears": gears(&rotor.gears),
        })).collect::<Value>(),
        "frames": robot.frames.iter().map(|frame| json!({
            "name": frame.name, "link": frame.link, "T": pose(frame.T),
        })).collect::<Value>(),
        "constraints": closing["constraints"],
        "motors": robot.motors,
        "states": robot.states.iter().map(states::write).collect::<Value>(),
        "start": robot.start,
    })
}

/// Joints and their ratios.
pub(crate) fn gears(gears: &[Gear]) -> Value {
    gears.iter().map(|gear| json!({ "joint": gear.joint, "ratio": gear.ratio })).collect()
}

/// The description of a robot in a file.
///
/// # Errors
/// All unknown and missing keys, else the first other error.
pub fn read(file: &File) -> Result<Description, Vec<Misplaced>> {
    let (root, mut errors) = (At::root(file, "the robot"), Vec::new());
    keys::ROBOT.check(&root, &mut errors);
    if errors.is_empty() { description(&root).map_err(|error| vec![error]) } else { Err(errors) }
}

fn description(at: &At) -> Read<Description> {
    let mut robot = Description::new(at.get("robot").text()?).with_gravity(at.get("gravity").vector()?);
    robot.base = at.get("base").some(base)?.unwrap_or_default();
    robot.free_joint = free_joint(&at.get("free_joint"), robot.base)?;
    robot.end_effector = at.get("end_effector").some(At::text)?;
    for link in at.get("links").list()? {
        let at = link.get("G");
        let G = SpatialInertia::from_matrix(at.matrix()?);
        robot = robot.link(link.get("name").text()?, G.or_else(|why| at.wrong(format_args!("an inertia: {why}")))?);
    }
    for entry in at.get("joints").list()? {
        robot = robot.joint(joint(&entry)?);
    }
    robot.rotors = all(&at.get("rotors"), rotor)?;
    robot.frames = all(&at.get("frames"), frame)?;
    robot.constraints = all(&at.get("constraints"), constraints::constraint)?;
    robot.motors = at.get("motors").some(At::texts)?;
    robot.states = all(&at.get("states"), states::read)?;
    robot.start = at.get("start").some(At::text)?;
    lists_agree(&at.get("lists"), &robot)?;
    Ok(robot)
}

/// The entries of an optional list.
fn all<T>(at: &At, read: impl Fn(&At) -> Read<T>) -> Read<Vec<T>> {
    at.some(At::list)?.unwrap_or_default().iter().map(read).collect()
}

fn free_joint(at: &At, base: Base) -> Read<FreeJoint> {
    let read = |at: &At| {
        if base == Base::Fixed {
            return at.error(
                "free_joint is given, but the base is fixed; expected \"base\": \"floating\", or no free_joint",
            );
        }
        Ok(FreeJoint { name: at.get("name").text()?, parent: at.get("parent").text()? })
    };
    Ok(at.some(read)?.unwrap_or_default())
}

fn rotor(at: &At) -> Read<Rotor> {
    let gears = at.get("gears").list()?.iter().map(gear).collect::<Read<_>>()?;
    Ok(Rotor { name: at.get("name").text()?, armature: at.get("armature").number()?, gears })
}

/// A joint and its ratio.
pub(crate) fn gear(at: &At) -> Read<Gear> {
    Ok(Gear { joint: at.get("joint").text()?, ratio: at.get("ratio").number()? })
}

fn frame(at: &At) -> Read<NamedFrame> {
    Ok(NamedFrame { name: at.get("name").text()?, link: at.get("link").text()?, T: at.get("T").pose()? })
}

fn base(at: &At) -> Read<Base> {
    match at.value.as_str() {
        Some("fixed") => Ok(Base::Fixed),
        Some("floating") => Ok(Base::Floating),
        _ => at.wrong("\"fixed\" or \"floating\""),
    }
}

/// By its axis A, its centre `ball`, or `free`; fixed if all of them are null or false.
fn kind(at: &At) -> Read<JointKind> {
    let axis =
        |at: &At| ScrewAxis::from_array(at.vector()?).or_else(|why| at.wrong(format_args!("a screw axis: {why}")));
    let keys = ["A", "ball", "free"];
    if !keys.iter().any(|key| at.has(key)) {
        return at.error(format_args!("`A` is missing in {}; null is the axis of a fixed joint", at.name()));
    }
    let axis = at.get("A").some(axis)?.map(JointKind::Screw);
    let ball = at.get("ball").some(At::vector)?.map(|center| JointKind::Ball(Vec3(center)));
    let free = at.get("free").some(At::is_true)?.and_then(|is_free| is_free.then_some(JointKind::Free));
    let kinds = [axis, ball, free];
    let mut given = keys.iter().zip(kinds).filter_map(|(key, kind)| Some((*key, kind?)));
    match (given.next(), given.next()) {
        (kind, None) => Ok(kind.map_or(JointKind::Fixed, |(_, kind)| kind)),
        (_, Some((second, _))) => {
            at.get(second).error(format_args!("{} has several of A, ball and free, expected one of them", at.name()))
        }
    }
}

fn joint(at: &At) -> Read<Joint> {
    let mimic = |at: &At| {
        let (ratio, offset) = (at.get("ratio").number()?, at.get("offset").number()?);
        Ok(Mimic { joint: at.get("joint").text()?, ratio, offset })
    };
    let size = |key| Read::Ok(at.get(key).some(At::number)?.unwrap_or(0.0));
    Ok(Joint {
        name: at.get("name").text()?,
        parent: at.get("parent").text()?,
        child: at.get("child").text()?,
        origin: at.get("M").pose()?,
        kind: kind(at)?,
        limits: Limits {
            position: at.get("position").some(At::vector)?,
            velocity: at.get("velocity").some(At::number)?,
            effort: at.get("effort").some(At::number)?,
            acceleration: at.get("acceleration").some(At::number)?,
        },
        damping: size("damping")?,
        friction: size("friction")?,
        armature: size("armature")?,
        stiffness: size("stiffness")?,
        spring_reference: size("spring_reference")?,
        mimic: at.get("mimic").some(mimic)?,
    })
}

/// The lists follow from the links and joints. An edited list would be ignored silently, so it is refused.
fn lists_agree(at: &At, robot: &Description) -> Read<()> {
    if at.value.is_null() {
        return Ok(());
    }
    let Ok(model) = robot.clone().build() else { return Ok(()) }; // building the robot reports the error
    let expected = screws(&model.screws().or_else(|error| at.error(error))?);
    let lists: Vec<&str> = expected.as_object().into_iter().flatten().map(|(key, _)| key.as_str()).collect();
    if let Some(error) = at.unknown(&lists).into_iter().next() {
        return Err(error);
    }
    for key in lists {
        let found = at.get(key);
        if !found.value.is_null() && !alike(found.value, &expected[key]) {
            return found.error(format_args!(
                "{} disagrees with links and joints; change those, or remove `lists`",
                found.name()
            ));
        }
    }
    Ok(())
}

fn alike(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Array(a), Value::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| alike(a, b)),
        (Value::Object(a), Value::Object(b)) => {
            a.len() == b.len() && a.iter().all(|(key, a)| b.get(key).is_some_and(|b| alike(a, b)))
        }
        _ => match (a.as_f64(), b.as_f64()) {
            (Some(a), Some(b)) => (a - b).abs() <= 1e-9 * a.abs().max(b.abs()).max(1.0),
            _ => a == b,
        },
    }
}
