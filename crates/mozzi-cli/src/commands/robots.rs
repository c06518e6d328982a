//! `mozzi robots`: the embedded robots, and the kinds of files.

use super::info::total_mass;
use crate::failure::Result;
use crate::json;
use crate::text::{Page, scalar, table};
use clap::Args;
use mozzi::Model;
use mozzi_urdf::embedded;
use serde_json::{Value, json};

#[derive(Args, Debug)]
pub struct RobotsArguments {
    /// Print one JSON object instead of text
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &RobotsArguments) -> Result<String> {
    list(arguments.json)
}

/// As text, or as JSON.
pub fn list(is_json: bool) -> Result<String> {
    let robots = embedded::names()
        .map(|name| Ok((name, mozzi_urdf::open(name)?.build()?)))
        .collect::<Result<Vec<(&str, Model)>>>()?;
    if is_json {
        let object = |(name, model): &(&str, Model)| json!({ "name": name, "n": model.n(), "joints": json::names(model.joint_names()), "mass": total_mass(model.description()) });
        return Ok(json::print(&json!({ "robots": robots.iter().map(object).collect::<Value>() })));
    }
    let mut rows = vec![["robot", "joints", "mass [kg]", "end effector"].map(str::to_string).to_vec()];
    for (name, model) in &robots {
        let tip = model.end_effector().map_or("several", |frame| model.frame_name(frame));
        rows.push(vec![
            name.to_string(),
            model.joint_names().len().to_string(),
            scalar(total_mass(model.description())),
            tip.to_string(),
        ]);
    }
    let mut page = Page::default();
    page.line("embedded robots:").lines(&table(&rows, "lrrl"));
    page.line(
        "A file is a robot, too: URDF, xacro, MuJoCo's MJCF, SDFormat, JSON of `mozzi convert`; - is standard input.",
    );
    page.line("mozzi info ur5    mozzi terms ur5    mozzi simulate panda    mozzi play my_robot.urdf");
    Ok(page.end())
}
