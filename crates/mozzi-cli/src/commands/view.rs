//! `mozzi view`: the robot to look at, still or moving, in a file or served to this machine's browser.

use crate::failure::{self, Failure, Result};
use crate::report::{self, MeshArguments};
use crate::robot::RobotArguments;
use crate::serve;
use clap::Args;

#[derive(Args, Debug)]
pub struct ViewArguments {
    #[command(flatten)]
    robot: RobotArguments,
    /// A CSV file with columns t, theta_1 …, and what else is known of dtheta_, ddtheta_, tau_ and the tip's wrench;
    /// without it sliders move the joints
    trajectory: Option<String>,
    #[command(flatten)]
    meshes: MeshArguments,
    /// Write the page to a file instead of serving it
    #[arg(long, value_name = "FILE.html")]
    out: Option<String>,
    /// The port on 127.0.0.1 [default: a free one]
    #[arg(long, value_name = "PORT", conflicts_with = "out")]
    port: Option<u16>,
}

pub fn run(arguments: &ViewArguments) -> Result<String> {
    let model = arguments.robot.load()?;
    let motion = arguments.trajectory.as_deref().map(|file| report::read(file, &model)).transpose()?;
    if let Some(file) = &arguments.out {
        return Ok(arguments.meshes.write(file, &arguments.robot.model, &model, motion.as_ref())? + "\n");
    }
    let page = arguments.meshes.page(&arguments.robot.model, &model, motion.as_ref())?;
    let cannot = |error: std::io::Error| Failure::wrong(format!("the page cannot be served on 127.0.0.1: {error}"));
    let server = serve::Server::new(arguments.port.unwrap_or(0)).map_err(cannot)?;
    let address = server.address().map_err(cannot)?;
    failure::write(&format!(
        "{} is at http://{address}/ for this machine alone; Ctrl-C ends it\n",
        model.description().name
    ));
    server.run(&page).map_err(cannot)?;
    Ok(String::new())
}
