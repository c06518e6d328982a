//! The text of an SDFormat, MJCF or Python file, and a line for each thing that the format cannot express.

use super::losses::{names, not_written, report};
use super::urdf::shapes;
use crate::commands::screws;
use crate::failure::{self, Result};
use mozzi::model::description::{Joint, Limits};
use mozzi::{Description, Model};
use mozzi_urdf::{Settings, Written, mjcf, named_states, sdf};

pub fn text(input: &str, output: &str, suffix: &str, model: &Model, settings: &Settings) -> Result<String> {
    let robot = model.description();
    let written = match suffix {
        "sdf" => sdf::write(robot),
        "xml" => mjcf::write(robot),
        _ => Ok(Written { text: screws::python(model)?, losses: losses_of_lists(robot), remarks: Vec::new() }),
    };
    let Written { text, losses, remarks } = written.map_err(|why| not_written(output, &why))?;
    report(output, &losses, settings)?;
    remarks.iter().for_each(|remark| failure::note(&format!("{output}: {remark}")));
    shapes(input, output, settings)?;
    Ok(text)
}

/// The numbers of a robot that the book's lists have not.
fn losses_of_lists(robot: &Description) -> Vec<String> {
    type IsOne = fn(&Joint) -> bool;
    let of_joints: [(&str, IsOne); 5] = [
        ("armature", |joint| joint.armature != 0.0),
        ("damping", |joint| joint.damping != 0.0),
        ("friction", |joint| joint.friction != 0.0),
        ("springs", |joint| joint.stiffness != 0.0),
        ("limits", |joint| joint.limits != Limits::default()),
    ];
    let joints =
        of_joints.into_iter().filter_map(|(what, is_one)| Some(format!("the {what} of {}", names(robot, is_one)?)));
    let rotors = robot.rotors.iter().map(|rotor| format!("rotor `{}`", rotor.name));
    let constraints = robot.constraints.iter().map(|constraint| format!("constraint `{}`", constraint.name));
    let motors = robot.motors.iter().map(|_| "the list of motors".to_string());
    joints.chain(rotors).chain(constraints).chain(motors).chain(named_states(robot)).collect()
}
