//! `mozzi play`: the playground, in a file or served to this machine's browser.

use crate::columns::save;
use crate::failure::{Failure, Result};
use crate::input;
use crate::json::print;
use crate::report::MeshArguments;
use crate::robot::RobotArguments;
use crate::serve;
use crate::state::StartArguments;
use clap::{Arg, Args};
use mozzi::Model;
use mozzi_report::{Played, lesson_html, lessons, play_html};
use mozzi_urdf::mjcf::included;
use mozzi_urdf::{embedded, expanded};
use serde_json::json;
use std::path::Path;

/// The robot that is shown at first if none is named.
const FIRST: &str = "panda";

#[derive(Args, Debug)]
pub struct PlayArguments {
    /// Write the page to a file instead of serving it
    #[arg(long, value_name = "FILE.html")]
    out: Option<String>,
    #[command(flatten)]
    robot: RobotArguments,
    #[command(flatten)]
    start: StartArguments,
    #[command(flatten)]
    meshes: MeshArguments,
    /// Show a lesson next to its robot: a section of Modern Robotics, 8.1 to 8.7
    #[arg(long, value_name = "SECTION")]
    lesson: Option<String>,
    /// Port on 127.0.0.1 [default: a free one]
    #[arg(long, value_name = "PORT", conflicts_with = "out")]
    port: Option<u16>,
}

/// The robot need not be named.
pub fn model(argument: Arg) -> Arg {
    argument.required(false).default_value(FIRST)
}

pub fn run(arguments: &PlayArguments) -> Result<String> {
    let model = arguments.robot.load_at(|model| Ok(arguments.start.read(model)?.0))?;
    if arguments.start.dtheta.is_some() {
        return Err(Failure::wrong("--dtheta has no effect: the playground begins at rest"));
    }
    let page = match &arguments.lesson {
        Some(number) => lesson(arguments, number)?,
        None => page(arguments, &model)?,
    };
    let name = match &arguments.lesson {
        Some(number) => format!("lesson {number}"),
        None => model.description().name.clone(),
    };
    let size = format!("page: {:.1} MB", page.len() as f64 / 1e6);
    if let Some(file) = &arguments.out {
        save(file, &page)?;
        let object = json!({ "robot": name, "out": file });
        return Ok(if arguments.robot.json { print(&object) } else { format!("{size}, written to {file}\n") });
    }
    serve::show(&name, page, &size, arguments.port, arguments.robot.json)?;
    Ok(String::new())
}

/// The robot, its start and its meshes are the lesson's own.
fn lesson(arguments: &PlayArguments, number: &str) -> Result<String> {
    if arguments.robot.model != FIRST || arguments.start.is_given() {
        return Err(Failure::wrong(format!("--lesson {number} has a robot and a start of its own, expected neither")));
    }
    let all: Vec<&str> = lessons().collect();
    lesson_html(number)
        .ok_or_else(|| Failure::wrong(format!("--lesson is `{number}`, expected one of {}", all.join(", "))))
}

fn page(arguments: &PlayArguments, model: &Model) -> Result<String> {
    let name_or_path = arguments.robot.model.as_str();
    let file = match embedded::unless_file(name_or_path) {
        Some(text) => (format!("{name_or_path}.urdf"), text.to_string()),
        None => text(&arguments.robot)?,
    };
    let drawing = arguments.meshes.drawing(&arguments.robot)?;
    let theta = if arguments.start.is_given() { Some(arguments.start.read(model)?.0) } else { None };
    let name = input::name(name_or_path);
    let theta = theta.as_deref();
    let included = if name_or_path == "-" { Vec::new() } else { included(Path::new(name_or_path)) };
    let [file, text] = [&file.0, &file.1];
    Ok(play_html(&Played { name, file, text, included: &included, model, drawing: &drawing, theta }))
}

/// A name and the text of the robot's file, expanded if it is xacro.
fn text(robot: &RobotArguments) -> Result<(String, String)> {
    let name_or_path = robot.model.as_str();
    let text = input::robot_file(name_or_path)?;
    let file = Path::new(input::name(name_or_path))
        .file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    Ok(match expanded(input::name(name_or_path), &text, robot.settings())? {
        Some(expansion) => (file.trim_end_matches(".xacro").trim_end_matches(".urdf").to_string() + ".urdf", expansion),
        None => (file, text),
    })
}
