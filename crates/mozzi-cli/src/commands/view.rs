//! `mozzi view`: shows the robot, still or moving, in a file or served to this machine's browser.

use crate::failure::{self, Failure, Result};
use crate::json::print;
use crate::report::{self, PageArguments};
use crate::robot::RobotArguments;
use crate::serve;
use clap::Args;
use serde_json::json;
use std::io::Write;

#[derive(Args, Debug)]
pub struct ViewArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// A table with columns t, theta_1 … and optionally dtheta_, ddtheta_, tau_ and the tip's wrench; without it,
    /// sliders move the joints
    trajectory: Option<String>,
    #[command(flatten)]
    page: PageArguments,
    /// Named state shown at first [default: the robot's start]
    #[arg(long, value_name = "NAME", conflicts_with = "trajectory")]
    state: Option<String>,
    /// Write the page to a file instead of serving it
    #[arg(long, value_name = "FILE.html")]
    out: Option<String>,
    /// Port on 127.0.0.1 [default: a free one]
    #[arg(long, value_name = "PORT", conflicts_with = "out")]
    port: Option<u16>,
}

pub fn run(arguments: &ViewArguments) -> Result<String> {
    let mut model = arguments.robot.load()?;
    if let Some(name) = &arguments.state {
        model = model.with_start(name)?;
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
    let cannot = |error: std::io::Error| Failure::wrong(format!("the page cannot be served on 127.0.0.1: {error}"));
    let server = serve::Server::new(arguments.port.unwrap_or(0)).map_err(cannot)?;
    let address = server.address().map_err(cannot)?;
    failure::write(&format!(
        "{} is at http://{address}/ on this machine only ({size}); Ctrl-C ends it\n",
        model.description().name
    ));
    if arguments.robot.json {
        // before the page is served, which takes until Ctrl-C
        let object = json!({ "robot": model.description().name, "address": format!("http://{address}/") });
        let mut output = std::io::stdout().lock();
        output.write_all(print(&object).as_bytes()).and_then(|()| output.flush()).map_err(cannot)?;
    }
    server.run(page).map_err(cannot)?;
    Ok(String::new())
}
