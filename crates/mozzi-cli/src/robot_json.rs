//! A robot as JSON: its links and joints, which are read back, and the book's lists, which follow from them.

mod states;

use crate::failure::{Failure, Result};
use crate::{input, json, json_file};
use mozzi::model::description::{FreeJoint, Gear, Joint, JointKind, Limits, Mimic, NamedFrame, Rotor};
use mozzi::{Base, Description, Model, SE3, ScrewAxis, SpatialInertia, Vec3};
use serde_json::{Value, json};

pub fn write(model: &Model) -> String {
    let robot = model.description();
    let joint = |joint: &Joint| {
        json!({
            "name": joint.name, "parent": joint.parent, "child": joint.child,
            "M": json::pose(joint.origin),
            "A": match joint.kind {
                JointKind::Screw(A) => json::vector(&A.twist().to_array()),
                JointKind::Fixed | JointKind::Ball(_) | JointKind::Free => Value::Null,
            },
            "ball": match joint.kind {
                JointKind::Ball(center) => json::vector(&center.0),
                _ => Value::Null,
            },
            "free": joint.kind == JointKind::Free,
            "position": joint.limits.position.map(|limits| json::vector(&limits)),
            "velocity": joint.limits.velocity, "effort": joint.limits.effort,
            "damping": joint.damping, "friction": joint.friction, "armature": joint.armature,
            "stiffness": joint.stiffness, "spring_reference": joint.spring_reference,
            "mimic": joint.mimic.as_ref().map(|m| json!({ "joint": m.joint, "ratio": m.ratio, "offset": m.offset })),
        })
    };
    json::print(&json!({
        "robot": robot.name,
        "base": json::base(model),
        "free_joint": model.is_floating().then(|| json!({ "name": robot.free_joint.name, "parent": robot.free_joint.parent })),
        "gravity": json::vector(&robot.gravity),
        "end_effector": robot.end_effector,
        "links": robot.links.iter().map(|link| json!({
            "name": link.name, "G": json::rows(link.inertia.to_matrix()),
        })).collect::<Value>(),
        "joints": robot.joints.iter().map(joint).collect::<Value>(),
        "rotors": robot.rotors.iter().map(|rotor| json!({
            "name": rotor.name, "armature": rotor.armature,
            "gears": rotor.gears.iter().map(|gear| json!({ "joint": gear.joint, "ratio": gear.ratio })).collect::<Value>(),
        })).collect::<Value>(),
        "frames": robot.frames.iter().map(|frame| json!({
            "name": frame.name, "link": frame.link, "T": json::pose(frame.T),
        })).collect::<Value>(),
        "states": robot.states.iter().map(states::write).collect::<Value>(),
        "start": robot.start,
        "lists": model.screws().ok().map(|lists| json::screws(&lists)), // of joints of one axis
    }))
}

/// Is this file one that [`write`] made, by its name? Standard input is if it is an object.
pub fn is_json(name_or_path: &str) -> bool {
    if name_or_path == "-" {
        let text = input::robot_text().unwrap_or_default();
        return text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text).trim_ascii_start().starts_with(b"{");
    }
    std::path::Path::new(name_or_path).extension().is_some_and(|suffix| suffix == "json")
}

pub fn read(file: &str) -> Result<Description> {
    let value = json_file::read(file)?;
    description(&At { value: &value, place: String::new() })
        .map_err(|why| Failure::wrong(format!("{}: {why}", input::name(file))))
}

type Read<T> = std::result::Result<T, String>;

/// A value and its place.
struct At<'v> {
    value: &'v Value,
    place: String,
}

impl<'v> At<'v> {
    fn get(&self, key: &str) -> At<'v> {
        let dot = if self.place.is_empty() { "" } else { "." };
        At { value: self.value.get(key).unwrap_or(&Value::Null), place: format!("{}{dot}{key}", self.place) }
    }

    fn wrong<T>(&self, expected: impl std::fmt::Display) -> Read<T> {
        let found: String = self.value.to_string().chars().take(60).collect();
        Err(format!("{} is {found}, expected {expected}", self.place))
    }

    fn text(&self) -> Read<String> {
        self.value.as_str().map_or_else(|| self.wrong("a text"), |text| Ok(text.to_string()))
    }

    fn number(&self) -> Read<f64> {
        self.value.as_f64().map_or_else(|| self.wrong("a number"), Ok)
    }

    fn list(&self) -> Read<Vec<At<'v>>> {
        let entry = |(k, value)| At { value, place: format!("{}[{k}]", self.place) };
        self.value
            .as_array()
            .map_or_else(|| self.wrong("a list"), |all| Ok(all.iter().enumerate().map(entry).collect()))
    }

    fn numbers(&self) -> Read<Vec<f64>> {
        self.list()?.iter().map(At::number).collect()
    }

    fn vector<const N: usize>(&self) -> Read<[f64; N]> {
        self.numbers()?.try_into().or_else(|_| self.wrong(format_args!("{N} numbers")))
    }

    fn matrix<const N: usize>(&self) -> Read<[[f64; N]; N]> {
        let all: Vec<[f64; N]> = self.list()?.iter().map(At::vector).collect::<Read<_>>()?;
        all.try_into().or_else(|_| self.wrong(format_args!("{N} rows")))
    }

    fn pose(&self) -> Read<SE3> {
        SE3::from_matrix(self.matrix()?).or_else(|why| self.wrong(format_args!("a configuration: {why}")))
    }

    /// Nothing where there is null or no such key.
    fn some<T>(&self, read: impl Fn(&Self) -> Read<T>) -> Read<Option<T>> {
        if self.value.is_null() { Ok(None) } else { read(self).map(Some) }
    }
}

fn description(at: &At) -> Read<Description> {
    let mut robot = Description::new(at.get("robot").text()?).with_gravity(at.get("gravity").vector()?);
    robot.base = at.get("base").some(base)?.unwrap_or_default(); // files of before had fixed bases only
    let free_joint = |at: &At| Ok(FreeJoint { name: at.get("name").text()?, parent: at.get("parent").text()? });
    robot.free_joint = at.get("free_joint").some(free_joint)?.unwrap_or_default();
    robot.end_effector = at.get("end_effector").some(At::text)?;
    for link in at.get("links").list()? {
        let at = link.get("G");
        let G = SpatialInertia::from_matrix(at.matrix()?);
        robot = robot.link(link.get("name").text()?, G.or_else(|why| at.wrong(format_args!("an inertia: {why}")))?);
    }
    for entry in at.get("joints").list()? {
        robot = robot.joint(joint(&entry)?);
    }
    for rotor in at.get("rotors").some(At::list)?.unwrap_or_default() {
        let gear = |at: &At| Ok(Gear { joint: at.get("joint").text()?, ratio: at.get("ratio").number()? });
        let gears = rotor.get("gears").list()?.iter().map(gear).collect::<Read<_>>()?;
        robot.rotors.push(Rotor { name: rotor.get("name").text()?, armature: rotor.get("armature").number()?, gears });
    }
    for frame in at.get("frames").some(At::list)?.unwrap_or_default() {
        let (name, link) = (frame.get("name").text()?, frame.get("link").text()?);
        robot.frames.push(NamedFrame { name, link, T: frame.get("T").pose()? });
    }
    let all = at.get("states").some(At::list)?.unwrap_or_default(); // files of before had none
    robot.states = all.iter().map(states::read).collect::<Read<_>>()?;
    robot.start = at.get("start").some(At::text)?;
    lists_agree(&at.get("lists"), &robot)?;
    Ok(robot)
}

fn base(at: &At) -> Read<Base> {
    match at.value.as_str() {
        Some("fixed") => Ok(Base::Fixed),
        Some("floating") => Ok(Base::Floating),
        _ => at.wrong("\"fixed\" or \"floating\""),
    }
}

/// By its axis A, its centre `ball`, or `free`; fixed where there is none of them.
fn kind(at: &At) -> Read<JointKind> {
    let axis =
        |at: &At| ScrewAxis::from_array(at.vector()?).or_else(|why| at.wrong(format_args!("a screw axis: {why}")));
    let is_free = |at: &At| at.value.as_bool().map_or_else(|| at.wrong("true or false"), Ok);
    let axis = at.get("A").some(axis)?.map(JointKind::Screw);
    let ball = at.get("ball").some(At::vector)?.map(|center| JointKind::Ball(Vec3(center)));
    let free = at.get("free").some(is_free)?.and_then(|is_free| is_free.then_some(JointKind::Free));
    let mut kinds = [axis, ball, free].into_iter().flatten();
    match (kinds.next(), kinds.next()) {
        (kind, None) => Ok(kind.unwrap_or(JointKind::Fixed)),
        _ => Err(format!("{} has several of A, ball and free, expected one of them", at.place)),
    }
}

fn joint(at: &At) -> Read<Joint> {
    let mimic = |at: &At| {
        let (ratio, offset) = (at.get("ratio").number()?, at.get("offset").number()?);
        Ok(Mimic { joint: at.get("joint").text()?, ratio, offset })
    };
    let size = |key: &str| Read::Ok(at.get(key).some(At::number)?.unwrap_or(0.0));
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
        },
        damping: size("damping")?,
        friction: size("friction")?,
        armature: size("armature")?,
        stiffness: size("stiffness")?,
        spring_reference: size("spring_reference")?,
        mimic: at.get("mimic").some(mimic)?,
    })
}

/// The lists follow from the links and joints. One that was edited would be ignored in silence, so it is refused.
fn lists_agree(at: &At, robot: &Description) -> Read<()> {
    if at.value.is_null() {
        return Ok(());
    }
    let model = robot.clone().build().map_err(|error| error.to_string())?;
    let expected = json::screws(&model.screws().map_err(|error| error.to_string())?);
    for key in ["joints", "links", "parents", "M", "M_relative", "S", "A", "B", "G", "end_effector"] {
        let found = at.get(key);
        if !found.value.is_null() && !alike(found.value, &expected[key]) {
            return Err(format!("{} disagrees with links and joints; change those, or remove `lists`", found.place));
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
