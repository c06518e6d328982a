//! HTML representation of a model in a notebook: a table of its joints.

use mozzi::Model;
use mozzi_report::escaped;
use mozzi_report::text::scalar;
use std::fmt::Write;

/// The mass of all links, as `mozzi info` prints it, and that of the moving links if it differs.
pub fn masses(model: &Model) -> String {
    let total: f64 = model.description().links.iter().map(|link| link.inertia.mass).sum();
    let moving = model.mass();
    match (total - moving).abs() <= 1e-12 * total {
        true => format!("{} kg", scalar(total)),
        false => format!("{} kg, {} kg moving", scalar(total), scalar(moving)),
    }
}

pub fn table(model: &Model) -> String {
    let (robot, mut text) = (model.description(), String::new());
    let base = if model.is_floating() { ", floating base" } else { "" };
    let mass = masses(model);
    // writing to a String cannot fail
    let _ = write!(
        text,
        "<table><caption>{}: {} joints, {mass}{base}</caption>",
        escaped(&robot.name),
        model.joint_names().len()
    );
    text.push_str(
        "<tr><th>joint</th><th>kind</th><th>moves</th><th>position</th><th>velocity</th><th>effort</th></tr>",
    );
    for joint in model.joints() {
        let limits = joint.limits;
        let [low, high] = limits.bounds();
        let is_free = low.is_infinite() && high.is_infinite();
        let position = if is_free { "free".to_string() } else { format!("{low} … {high}") };
        let most = |limit: Option<f64>| limit.map_or_else(String::new, |x| x.to_string());
        let cells =
            [&joint.name, joint.kind.name(), &joint.child, &position, &most(limits.velocity), &most(limits.effort)];
        text.push_str("<tr>");
        cells.iter().for_each(|cell| {
            let _ = write!(text, "<td>{}</td>", escaped(cell));
        });
        text.push_str("</tr>");
    }
    text + "</table>"
}
