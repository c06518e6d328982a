//! `mozzi view`: shows the robot, still or moving, in a file or served to this machine's browser.

use crate::failure::{Failure, Result};
use crate::json::print;
use crate::report::{self, PageArguments};
use crate::robot::RobotArguments;
use crate::serve;
use crate::state::StartArguments;
use clap::Args;
use serde_json::json;

#[derive(Args, Debug)]
pub struct ViewArguments {
    /// Write the page to a file instead of serving it
    #[arg(long, value_name = "FILE.html")]
    out: Option<String>,
    #[command(flatten)]
    robot: RobotArguments,
    /// A table with columns t, theta_1 … and optionally dtheta_, ddtheta_, tau_ and the tip's wrench; without it,
    /// sliders move the joints
    trajectory: Option<String>,
    #[command(flatten)]
    page: PageArguments,
    #[command(flatten)]
    start: StartArguments,
    /// Port on 127.0.0.1 [default: a free one]
    #[arg(long, value_name = "PORT", conflicts_with = "out")]
    port: Option<u16>,
}

pub fn run(arguments: &ViewArguments) -> Result<String> {
    let model = arguments.robot.load_at(|model| Ok(arguments.start.read(model)?.0))?;
    let model = arguments.start.started(model)?;
    if arguments.trajectory.is_some() && arguments.start.is_given() {
        return Err(Failure::wrong("a table of a motion and --theta or --state are both given, expected one of them"));
    }
    let motion = arguments.trajectory.as_deref().map(|file| report::read(file, &model)).transpose()?;
    let motion = motion.map(|motion| {
        let rows = motion.t.len();
        (motion, rows)
    });
    if let Some(file) = &arguments.out {
        let said = arguments.page.write(file, &arguments.robot, &model, motion)?;
        let object = json!({ "robot": model.description().name, "out": file });
        return Ok(if arguments.robot.json { print(&object) } else { said + "\n" });
    }
    let (page, size) = arguments.page.page(&arguments.robot, &model, motion)?;
    serve::show(&model.description().name, page, &size, arguments.port, arguments.robot.json)?;
    Ok(String::new())
}
