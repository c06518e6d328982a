//! Results of a library.

use crate::compare::constants::{Constants, JointConstants, body};
use crate::compare::convention::velocity_names;
use crate::compare::numbers::Side;
use crate::compare::question::name_of;
use crate::compare::terms::Numbers;
use nalgebra::{DMatrix, DVector};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// A workaround for a file that MuJoCo refuses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Workaround {
    /// Without visual and collision elements.
    Geometry,
    /// Without inertias of links that no joint moves.
    Fixed,
    /// With balanceinertia.
    Balance,
    /// With boundmass and boundinertia.
    Bound,
}

/// The reason why a library computed nothing.
#[derive(Clone, Debug)]
pub enum Unavailable {
    NotInstalled(String),
    Refuses(String),
    /// The script ended without a result, or was killed at the time limit.
    Died(String, Fault),
}

/// The part at fault for a missing result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The library's own code, or its installation.
    Library,
    /// The program that was run as Python.
    Python,
    /// mozzi's script.
    Mozzi,
}

impl Fault {
    pub const ALL: [(Fault, &'static str); 3] =
        [(Fault::Library, "library"), (Fault::Python, "python"), (Fault::Mozzi, "mozzi")];

    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(fault, _)| *fault == self).map_or("", |(_, name)| name)
    }

    fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(_, known)| *known == name).map(|(fault, _)| *fault)
    }
}

/// A library that loaded the robot.
#[derive(Clone, Debug)]
pub struct Robot {
    pub constants: Constants,
    pub side: Side,
    /// τ without the forces of constraints, and the kinds of these constraints: "limits", "contacts".
    pub unconstrained: Vec<DVector<f64>>,
    pub constraints: BTreeSet<String>,
    /// Other forces that τ contains and mozzi does not compute, by the library's name, one vector for each state.
    pub forces: BTreeMap<String, Vec<DVector<f64>>>,
    /// Joints that the library couples to others by a constraint.
    pub couplings: Vec<(String, String)>,
    /// Bodies without an inertia in the file, whose inertia the library computed from their shapes.
    pub from_geometry: Vec<String>,
    pub settings: Value,
}

#[derive(Clone, Debug)]
pub struct Answer {
    /// "Pinocchio" or "MuJoCo".
    pub library: &'static str,
    pub version: Option<String>,
    /// Its message for the unchanged file, and the workaround that was applied.
    pub attempts: Vec<(String, Workaround)>,
    pub robot: Result<Robot, Unavailable>,
}

impl Answer {
    pub fn silent(library: &str, unavailable: Unavailable) -> Self {
        Answer { library: name_of(library), version: None, attempts: Vec::new(), robot: Err(unavailable) }
    }

    /// Parses the script's JSON; `None` if it does not have the script's form.
    pub fn read(value: &Value) -> Option<Self> {
        let attempt = |step: &Value| {
            let workaround = match step["then"].as_str()? {
                "geometry" => Workaround::Geometry,
                "fixed" => Workaround::Fixed,
                "balance" => Workaround::Balance,
                "bound" => Workaround::Bound,
                _ => return None,
            };
            Some((step["message"].as_str()?.to_string(), workaround))
        };
        let error = &value["error"];
        let robot = match error["stage"].as_str() {
            None => Ok(robot(value)?),
            Some("compute") => {
                Err(Unavailable::Died(error["message"].as_str()?.to_string(), Fault::named(error["fault"].as_str()?)?))
            }
            Some("import") => Err(Unavailable::NotInstalled(error["message"].as_str()?.to_string())),
            Some(_) => Err(Unavailable::Refuses(error["message"].as_str()?.to_string())),
        };
        Some(Answer {
            library: name_of(value["library"].as_str()?),
            version: value["version"].as_str().map(str::to_string),
            attempts: value["attempts"].as_array()?.iter().map(attempt).collect::<Option<_>>()?,
            robot,
        })
    }
}

fn numbers(value: &Value) -> Option<Vec<f64>> {
    let number = |x: &Value| if x.is_null() { Some(f64::NAN) } else { x.as_f64() };
    value.as_array()?.iter().map(number).collect()
}

fn array<const K: usize>(value: &Value) -> Option<[f64; K]> {
    numbers(value)?.try_into().ok()
}

fn joint(value: &Value) -> Option<JointConstants> {
    let axes: Vec<[f64; 6]> = value["axes"].as_array()?.iter().map(array).collect::<Option<_>>()?;
    let rows: Vec<[f64; 3]> = value["inertia"].as_array()?.iter().map(array).collect::<Option<_>>()?;
    let first = |key: &str| Some(numbers(&value[key])?.first().copied().unwrap_or(0.0));
    Some(JointConstants {
        name: value["name"].as_str()?.to_string(),
        called: value["called"].as_str()?.to_string(),
        parent: value["parent"].as_u64().map(|k| k as usize),
        nq: value["nq"].as_u64()? as usize,
        nv: value["nv"].as_u64()? as usize,
        axes,
        body: body(value["mass"].as_f64()?, array(&value["center"])?, rows.try_into().ok()?),
        armature: first("armature")?,
        damping: first("damping")?,
        friction: first("friction")?,
        stiffness: 0.0,
    })
}

fn robot(value: &Value) -> Option<Robot> {
    let mut joints: Vec<JointConstants> = value["joints"].as_array()?.iter().map(joint).collect::<Option<_>>()?;
    let has_base = value["joints"].get(0).is_some_and(|first| first["base"].as_bool() == Some(true));
    if joints.iter().enumerate().any(|(k, joint)| joint.parent.is_some_and(|up| up >= k)) {
        return None;
    }
    if has_base {
        joints[0].name = "base".into();
    }
    let names: Vec<String> = joints.iter().flat_map(|joint| velocity_names(&joint.name, joint.nv)).collect();
    if has_base {
        joints.remove(0);
        joints.iter_mut().for_each(|joint| joint.parent = joint.parent.and_then(|up| up.checked_sub(1)));
    }
    let n = names.len();
    let vector = |value: &Value| Some(DVector::from_vec(numbers(value)?)).filter(|v| v.len() == n);
    let (mut states, mut forces) = (Vec::new(), BTreeMap::<String, Vec<DVector<f64>>>::new());
    let (mut unconstrained, mut constraints) = (Vec::new(), BTreeSet::new());
    for state in value["states"].as_array()? {
        let rows: Vec<f64> = state["M"].as_array()?.iter().map(numbers).collect::<Option<Vec<_>>>()?.concat();
        states.push(Numbers {
            M: (rows.len() == n * n).then(|| DMatrix::from_row_slice(n, n, &rows))?,
            g: vector(&state["g"])?,
            h: vector(&state["h"])?,
            tau: vector(&state["tau"])?,
        });
        unconstrained.push(vector(state.get("unconstrained").unwrap_or(&state["tau"]))?);
        let kinds = state["constraints"].as_array().map_or(&[][..], Vec::as_slice);
        constraints.extend(kinds.iter().filter_map(|kind| kind.as_str().map(str::to_string)));
        for (name, force) in state["parts"].as_object()? {
            forces.entry(name.clone()).or_default().push(vector(force)?);
        }
    }
    forces.retain(|_, list| list.iter().any(|force| force.amax() > 0.0));
    let text = |value: &Value| value.as_str().map(str::to_string);
    let coupling = |entry: &Value| Some((text(&entry["joint"])?, text(&entry["source"])?));
    Some(Robot {
        constants: Constants { joints, gravity: array(&value["gravity"])? },
        side: Side { names, states },
        unconstrained,
        constraints,
        forces,
        couplings: value["couplings"].as_array()?.iter().map(coupling).collect::<Option<_>>()?,
        from_geometry: value["from_geometry"].as_array()?.iter().map(text).collect::<Option<_>>()?,
        settings: value["settings"].clone(),
    })
}
