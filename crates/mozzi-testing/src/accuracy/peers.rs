//! Pinocchio's and MuJoCo's results at the same states of the same file.

use crate::accuracy::errors::Errors;
use crate::accuracy::measure::Row;
use crate::accuracy::reference::Neighbours;
use crate::accuracy::robot::Robot;
use crate::accuracy::states::States;
use crate::{Double, read_urdf};
use mozzi::Freedom;
use mozzi::quantities::LIST;
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

const SCRIPT: &str = include_str!("peers.py");

/// A library's errors, or the reason why there are none.
pub struct Answer {
    /// "Pinocchio" or "MuJoCo".
    pub library: &'static str,
    /// Its version and its errors, or its message.
    pub rows: Result<(String, Vec<Row>), String>,
}

/// Both libraries on a robot without friction and springs, at this many first states.
pub fn ask(python: &Path, robot: &Robot, states: &States, count: usize, seed: u64) -> Vec<Answer> {
    [("pinocchio", "Pinocchio"), ("mujoco", "MuJoCo")]
        .into_iter()
        .map(|(key, library)| Answer { library, rows: rows(python, robot, states, count, seed, (key, library)) })
        .collect()
}

type Library = (&'static str, &'static str);

fn rows(
    python: &Path,
    robot: &Robot,
    states: &States,
    count: usize,
    seed: u64,
    (key, library): Library,
) -> Result<(String, Vec<Row>), String> {
    let (model, count) = (&robot.model, count.min(states.len()));
    if model.has_mimic_joints() {
        return Err("it moves the joints that follow others on their own".into());
    }
    if model.places().iter().any(|place| place.freedom != Freedom::One) {
        return Err("it is asked about joints of one axis alone".into());
    }
    let list = |x: &[f64]| Value::from(x.to_vec());
    let state = |k: usize| json!([list(states.theta(k)), states.rates(k).map(list)]);
    let question = json!({
        "library": key, "text": robot.text, "floating": model.is_floating(), "gravity": model.gravity().0,
        "frame": model.frame_name(robot.frame), "joints": model.joint_names().collect::<Vec<_>>(),
        "states": (0..count).map(state).collect::<Value>(),
    });
    let answer = run(python, &question)?;
    if let Some(why) = answer["error"].as_str() {
        return Err(why.into());
    }
    // from the same file without friction and springs, which the libraries do not include in the forces
    let mut smooth = read_urdf::<Double>(&robot.text, model.description()).map_err(|error| error.to_string())?;
    for joint in &mut smooth.joints {
        (joint.damping, joint.friction, joint.stiffness) = (0.0.into(), 0.0.into(), 0.0.into());
    }
    let wide = smooth.build().map_err(|error| error.to_string())?;
    let (neighbours, mut rows) = (Neighbours::new(&wide, robot.frame), Vec::new());
    for (quantity, declared) in LIST.iter().enumerate() {
        let Some(found) = answer["quantities"][declared.name].as_array() else { continue };
        let (query, mut errors, mut memory) = (robot.query(quantity), Errors::default(), neighbours.memory());
        for (state, found) in found.iter().enumerate() {
            let found: Option<Vec<Vec<f64>>> =
                found.as_array().and_then(|outputs| outputs.iter().map(numbers).collect());
            let found = found.ok_or_else(|| format!("{} is not as the script writes it", declared.name))?;
            let inputs = states.inputs(&query, state, 1);
            errors.add(&neighbours.at(&query, &inputs, seed ^ state as u64, &mut memory), &found, 1.0);
        }
        rows.push(Row { quantity, way: library, errors });
    }
    Ok((answer["version"].as_str().unwrap_or("unknown").into(), rows))
}

fn numbers(value: &Value) -> Option<Vec<f64>> {
    value.as_array()?.iter().map(|x| if x.is_null() { Some(f64::NAN) } else { x.as_f64() }).collect()
}

/// Runs the script on a question; an error if it prints nothing.
fn run(python: &Path, question: &Value) -> Result<Value, String> {
    let mut command = Command::new(python);
    command.arg("-c").arg(SCRIPT).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(|error| format!("{}: {error}", python.display()))?;
    if let Some(mut stdin) = child.stdin.take() {
        // if a script ends before it has read, its exit status gives the reason
        let _ = stdin.write_all(question.to_string().as_bytes());
    }
    let output = child.wait_with_output().map_err(|error| error.to_string())?;
    let said = String::from_utf8_lossy(&output.stderr);
    let last = said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it said nothing");
    serde_json::from_slice(&output.stdout).map_err(|_| last.trim().to_string())
}
