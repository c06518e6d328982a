//! A robot of files.

use super::files::settings;
use super::shapes::drawn;
use crate::robot::Robot;
use mozzi::{Description, Model};
use mozzi_urdf::geometry::{FRICTION, Geometry, contact_points, end_points, parse_with as geometry};
use mozzi_urdf::{Diagnostic, Style, json};
use serde_json::{Map, Value, json};
use std::path::Path;

/// At most so many warnings are printed.
const WARNINGS: usize = 20;

/// Coefficients of contact points; the settings replace them.
const COEFFICIENTS: (Option<f64>, f64) = (Some(FRICTION), 0.0);

/// The robot of `{"file": name, "files": {path: text, …}}`, in which `name` is one of the paths. A `description`, of
/// [`mozzi_urdf::json`], replaces that of the file; shapes stay those of the file. `arguments` are xacro's.
///
/// Returns the robot, and what the page needs besides [`Robot::about`].
pub fn open(text: &str) -> Result<(Robot, Value), String> {
    let asked: Value = serde_json::from_str(text).map_err(|error| format!("the files are not JSON: {error}"))?;
    let none = Map::new();
    let files = asked["files"].as_object().unwrap_or(&none);
    let name = asked["file"].as_str().unwrap_or_default();
    let Some(source) = files.get(name).and_then(Value::as_str) else {
        return Err(format!("the file `{name}` is not among the files"));
    };
    let settings = settings(files, asked["arguments"].as_object().unwrap_or(&none));
    let is_json = name.to_ascii_lowercase().ends_with(".json");
    let (mut description, mut warnings, mut arguments) = (None, Vec::new(), None);
    if is_json {
        description = Some(from_json(name, source)?);
    } else if asked["description"].is_null() {
        let loaded =
            mozzi_urdf::parse_with(name, source, settings.clone()).map_err(|error| error.pretty(Style::Unicode))?;
        warnings =
            loaded.warnings.iter().take(WARNINGS).map(|warning: &Diagnostic| warning.pretty(Style::Unicode)).collect();
        description = Some(loaded.description);
        arguments = Some(loaded.xacro_arguments);
    }
    if !asked["description"].is_null() {
        description = Some(from_json("robot.json", &asked["description"].to_string())?);
    }
    let model: Model = match description {
        Some(description) => description.build().map_err(|error| error.to_string())?,
        None => return Err(format!("{name} has no robot")),
    };
    let Geometry { shapes, left_out, .. } =
        if is_json { Geometry::default() } else { geometry(name, source, &settings.xacro) };
    let touching = contact_points(&model, &shapes, Path::new(name), None, COEFFICIENTS);
    let mut notes: Vec<String> = left_out.iter().map(ToString::to_string).collect();
    let points = if touching.points.is_empty() { end_points(&model, FRICTION, 0.0) } else { touching.points };
    notes.extend(touching.left_out);
    let said = json!({
        "description": json::to_value(model.description()),
        "shapes": drawn(&model, &shapes), "warnings": warnings, "notes": notes,
        "arguments": arguments,
    });
    let mut robot = Robot::new(model);
    robot.settings.points = points;
    Ok((robot, said))
}

fn from_json(file_name: &str, text: &str) -> Result<Description, String> {
    let file = json::File::parse(file_name, text).map_err(|error| error.to_string())?;
    json::read(&file).map_err(|errors| errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))
}
