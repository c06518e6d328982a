//! Transmissions and controllers that still drive a joint fixed by an edit.

use mozzi::Description;
use mozzi::model::description::JointKind;
use roxmltree::{Document, Node};

/// Drives of joints that do not move in this robot, which controllers refuse: each `<joint>` in a `<transmission>` or a
/// `<ros2_control>` of the text that names a fixed joint, as "`<transmission>` elbow_drive drives joint elbow, which is
/// fixed". None if the text is not XML.
pub fn drives_of_fixed_joints(text: &str, robot: &Description) -> Vec<String> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let Ok(document) = Document::parse(text) else { return Vec::new() };
    let is_fixed =
        |name: &str| robot.joints.iter().any(|joint| joint.name == name && matches!(joint.kind, JointKind::Fixed));
    let is_drive = |node: &Node| matches!(node.tag_name().name(), "transmission" | "ros2_control");
    let mut found = Vec::new();
    for drive in document.root_element().children().filter(is_drive) {
        let joints = drive.descendants().filter(|node| node.tag_name().name() == "joint");
        for joint in joints.filter_map(|node| node.attribute("name")).filter(|name| is_fixed(name)) {
            let (kind, name) = (drive.tag_name().name(), drive.attribute("name").unwrap_or_default());
            found.push(format!("<{kind}> `{name}` drives joint `{joint}`, which is fixed"));
        }
    }
    found
}
