//! `mozzi picture`: a drawing of the robot at one configuration.

use crate::failure::{Failure, Result};
use crate::figure_file::{self, OutArguments};
use crate::json::print;
use crate::numbers::angle;
use crate::report::{self, MeshArguments};
use crate::robot::RobotArguments;
use crate::state::StartArguments;
use clap::{Args, ValueEnum};
use mozzi_report::pictures::{self, Look, View};
use serde_json::json;

#[derive(Args, Debug)]
pub struct PictureArguments {
    #[command(flatten)]
    robot: RobotArguments,
    #[command(flatten)]
    start: StartArguments,
    /// Direction of view
    #[arg(long, value_name = "VIEW", default_value = "iso")]
    view: Named,
    /// Angle of the viewer about z of {s}, from x, rad, instead of the view's
    #[arg(long, value_name = "ANGLE")]
    azimuth: Option<String>,
    /// Angle of the viewer above the plane xy of {s}, rad, instead of the view's
    #[arg(long, value_name = "ANGLE")]
    elevation: Option<String>,
    /// Draw on a dark ground
    #[arg(long)]
    dark: bool,
    /// Draw all links as bones instead of their shapes
    #[arg(long, conflicts_with = "meshes")]
    bones: bool,
    /// Draw the frames of the moving links and of the end effector: x red, y green, z blue
    #[arg(long)]
    frames: bool,
    /// Omit the joint axes, the centre of mass, the directions of {s} and the scale
    #[arg(long)]
    plain: bool,
    #[command(flatten)]
    meshes: MeshArguments,
    #[command(flatten)]
    out: OutArguments,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Named {
    /// From +x, −y and above, isometric
    Iso,
    /// From +x: y to the right
    Front,
    /// From −y: x to the right
    Side,
    /// From above: x to the right, y up
    Top,
}

pub fn run(arguments: &PictureArguments) -> Result<String> {
    let PictureArguments { robot, start, out, .. } = arguments;
    let model = robot.load_at(|model| Ok(start.read(model)?.0))?;
    if start.dtheta.is_some() {
        return Err(Failure::wrong("--dtheta has no effect: a picture has no velocities"));
    }
    let (theta, _) = start.read(&model)?;
    let mut view = match arguments.view {
        Named::Iso => View::ISO,
        Named::Front => View::FRONT,
        Named::Side => View::SIDE,
        Named::Top => View::TOP,
    };
    for (flag, text, own) in [
        ("--azimuth", &arguments.azimuth, &mut view.azimuth),
        ("--elevation", &arguments.elevation, &mut view.elevation),
    ] {
        if let Some(text) = text {
            *own = angle(flag, text)?;
        }
    }
    let look = Look {
        view,
        is_dark: arguments.dark,
        bones: arguments.bones,
        marks: !arguments.plain,
        frames: arguments.frames,
        title: out.title.clone(),
    };
    let drawing = arguments.meshes.read(robot)?;
    let picture = pictures::robot(&model, &theta, &drawing, &look)?;
    if !arguments.bones {
        report::note(&[drawing.notes, picture.notes].concat(), "");
    }
    figure_file::save(&out.out, &picture.title, picture.svg)?;
    let object = json!({
        "robot": model.description().name, "out": out.out, "title": picture.title,
        "bodies": picture.bodies, "bones": picture.bones,
    });
    Ok(if robot.json { print(&object) } else { format!("wrote a picture to {}\n", out.out) })
}
