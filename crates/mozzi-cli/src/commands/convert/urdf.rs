//! The text of a URDF: the edited text of IN, if IN is a URDF, or a newly written one.

use super::losses::{names, of_these, report};
use crate::failure::{self, Failure, Result};
use crate::input;
use crate::robot_json;
use clap::ValueEnum;
use mozzi::Description;
use mozzi_urdf::{
    Settings, chosen_end_effector, drives_of_fixed_joints, edit, edit_with_old_values, embedded, expanded, expressible,
    geometry::shape_count, mjcf, named_states, only_ball_constraints, sdf,
};
use std::path::Path;

/// Parts that the written URDF leaves out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LeftOut {
    Armature,
    Springs,
    Gravity,
    Rotors,
    Constraints,
}

pub fn text(
    input: &str,
    output: &str,
    robot: &Description,
    left_out: &[LeftOut],
    settings: Settings,
) -> Result<String> {
    let not_written =
        |why: &dyn std::fmt::Display, help: &str| Failure::wrong(format!("{output} is not written: {why}; {help}"));
    let is_strict = settings.policy == mozzi_urdf::Policy::Strict;
    match source(input, settings.clone())? {
        Some(text) if left_out.is_empty() => {
            relative_meshes(input, output, &text);
            let text = edit(input.strip_suffix(".xacro").unwrap_or(input), &text, robot)
                .map_err(|why| not_written(&why, "convert to .json first, and that to .urdf"))?;
            let drives = drives_of_fixed_joints(&text, robot);
            if let Some(drive) = drives.first().filter(|_| is_strict) {
                return Err(not_written(&format!("--strict, and {drive}"), "remove the drive"));
            }
            for drive in drives {
                failure::write(&format!("{output}: warning: {drive}; controllers may refuse it: remove the drive\n"));
            }
            Ok(text)
        }
        _ => {
            // a note names each thing that URDF cannot express; --strict refuses it, unless the user leaves it out
            let all = [LeftOut::Gravity, LeftOut::Rotors, LeftOut::Constraints];
            let told = all.into_iter().filter(|what| !is_strict && !left_out.contains(what));
            let left_out: Vec<LeftOut> = left_out.iter().copied().chain(told).collect();
            let lost = chosen_end_effector(robot).into_iter().chain(named_states(robot));
            report(output, &lost.collect::<Vec<_>>(), &settings)?;
            let robot = reduced(output, robot, &left_out);
            let text = mozzi_urdf::write(&robot).map_err(|why| not_written(&why, &help(&robot)))?;
            ignored_elsewhere(output, &robot);
            shapes(input, output, &settings)?;
            Ok(text)
        }
    }
}

/// The text of an identified robot: that of IN with other numbers, or, if IN is no URDF, a new one.
pub fn edited(input: &str, output: &str, robot: &Description, keeps_old: bool, settings: Settings) -> Result<String> {
    match source(input, settings.clone())? {
        Some(text) if keeps_old => {
            relative_meshes(input, output, &text);
            edit_with_old_values(input, &text, robot)
                .map_err(|why| Failure::wrong(format!("{output} is not written: {why}; {JSON}")))
        }
        _ => text(input, output, robot, &[], settings),
    }
}

const JSON: &str = ".json can express all of it";

/// The remedy for a robot that URDF cannot express; flags are named only if they help.
fn help(robot: &Description) -> String {
    let mut rest = robot.clone();
    rest.gravity = Description::new("").gravity;
    rest.rotors.clear();
    only_ball_constraints(&mut rest);
    rest.motors = None;
    match mozzi_urdf::write(&rest) {
        Ok(_) => {
            format!("{JSON}; without --strict, or with --leave-out, gravity, rotors and constraints are left out")
        }
        Err(_) => JSON.to_string(),
    }
}

/// A note about the shapes of IN, which are not written.
pub fn shapes(input: &str, output: &str, settings: &Settings) -> Result<()> {
    let Some(text) = any_source(input, settings.clone())? else { return Ok(()) };
    let count = shape_count(&text);
    if count == 0 {
        return Ok(());
    }
    let count = of_these(count, "shape");
    failure::note(&format!("{output} omits the {count} of {}, for pictures and contacts", input::name(input)));
    Ok(())
}

/// The text of a URDF, or the expansion of a xacro file.
fn source(input: &str, settings: Settings) -> Result<Option<String>> {
    let text = any_source(input, settings)?;
    Ok(text.filter(|text| !mjcf::is_mjcf(text) && !sdf::is_sdf(text)))
}

/// The text of any file but JSON.
fn any_source(input: &str, settings: Settings) -> Result<Option<String>> {
    if let Some(text) = embedded::text(input) {
        return Ok(Some(text.to_string()));
    }
    if robot_json::is_json(input) {
        return Ok(None);
    }
    let text = input::robot_file(input)?;
    let text = expanded(input::name(input), &text, settings)?.unwrap_or(text);
    Ok(Some(text))
}

/// Notes visuals whose files are named relative to the text's folder.
fn relative_meshes(input: &str, output: &str, text: &str) {
    let folder = |file: &str| {
        let parent = Path::new(file).parent().filter(|parent| !parent.as_os_str().is_empty());
        std::fs::canonicalize(parent.unwrap_or(Path::new("."))).ok()
    };
    let is_relative = |name: &&str| !name.contains("://") && !Path::new(name).is_absolute();
    let meshes = text.split("<mesh").skip(1).filter_map(|rest| rest.split_once("filename="));
    let mut files = meshes.filter_map(|(_, rest)| rest.get(1..)?.split(['"', '\'']).next());
    if let Some(file) = files.find(is_relative).filter(|_| folder(input) != folder(output)) {
        failure::note(&format!(
            "{output} is in another folder than {input}; its paths of meshes, such as `{file}`, are unchanged"
        ));
    }
}

/// The robot without the content that URDF cannot express, with a note for each loss.
fn reduced(output: &str, robot: &Description, left_out: &[LeftOut]) -> Description {
    let mut robot = expressible(robot);
    let omitted = |what: String| failure::note(&format!("{output} omits {what}"));
    robot.end_effector = None;
    for what in left_out {
        match what {
            LeftOut::Armature => {
                let names = names(&robot, |joint| joint.armature != 0.0);
                robot.joints.iter_mut().for_each(|joint| joint.armature = 0.0);
                names.into_iter().for_each(|names| omitted(format!("the armature of {names}: M differs")));
            }
            LeftOut::Springs => {
                let names = names(&robot, |joint| joint.stiffness != 0.0);
                robot.joints.iter_mut().for_each(|joint| (joint.stiffness, joint.spring_reference) = (0.0, 0.0));
                names.into_iter().for_each(|names| omitted(format!("the springs of {names}: τ differs")));
            }
            LeftOut::Gravity => {
                let standard = Description::new("").gravity;
                if robot.gravity != standard {
                    omitted(format!("gravity {:?}, read as {standard:?}: τ differs", robot.gravity));
                }
                robot.gravity = standard;
            }
            LeftOut::Rotors => {
                let names: Vec<String> = robot.rotors.drain(..).map(|rotor| format!("`{}`", rotor.name)).collect();
                if !names.is_empty() {
                    omitted(format!("the rotors {}: M differs", names.join(", ")));
                }
            }
            LeftOut::Constraints => {
                let (dropped, renamed) = only_ball_constraints(&mut robot);
                let dropped: Vec<String> = dropped.iter().map(|name| format!("`{name}`")).collect();
                if !dropped.is_empty() {
                    omitted(format!("the constraints {}, which hold no longer", dropped.join(", ")));
                }
                for [name, there] in renamed {
                    omitted(format!("the name of constraint `{name}`, which is read as `{there}`"));
                }
                if robot.motors.take().is_some() {
                    omitted("the list of motors".to_string());
                }
            }
        }
    }
    robot
}

/// A warning about extensions, which only mozzi reads.
fn ignored_elsewhere(output: &str, robot: &Description) {
    for (attributes, quantity, names) in [
        ("armature", "M", names(robot, |joint| joint.armature != 0.0)),
        ("spring_stiffness", "τ", names(robot, |joint| joint.stiffness != 0.0)),
    ] {
        if let Some(names) = names {
            failure::write(&format!(
                "{output}: warning: `{attributes}` of {names} is an extension of <dynamics> that other readers ignore: \
                 their {quantity} differs from mozzi's\n"
            ));
        }
    }
}
