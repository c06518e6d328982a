//! Writes SDFormat text.

use super::FIXED_BASE;
use super::base::{base_link, has_world, start_pose};
use super::names::Names;
use crate::urdf::write::{ball_constraint, triple};
use crate::written::{NotWritten, Written, of_free_joint};
use mozzi::model::description::{Joint, JointKind, Link};
use mozzi::{Base, Description, SE3, ScrewAxis, Vec3};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::{self, Write};

/// The SDFormat text of a robot, which Drake and Gazebo read, too. Armature is Drake's `drake:rotor_inertia`. The
/// version is 1.7, or 1.11 if there are mimic joints, which are written twice: Drake reads its own `drake:mimic` alone.
///
/// A base that is fixed becomes a link with a fixed joint `fixed_base` to the world; a base link `world` is SDFormat's
/// own. Gravity other than (0, 0, −9.81) needs a world around the model.
///
/// # Errors
/// [`NotWritten`] if the robot would be another one: free joints inside the tree, control characters in names.
pub fn write(description: &Description) -> Result<Written, NotWritten> {
    let reasons = reasons(description);
    if !reasons.is_empty() {
        return Err(NotWritten { language: "SDFormat", reasons });
    }
    let (names, mut losses) = Names::of(description);
    losses.extend(super::losses::of(description));
    let mut text = String::new();
    // writing to a String cannot fail
    let _ = sdf(&mut text, description, &names);
    let remarks = super::losses::remarks(description);
    Ok(Written { text, losses, remarks })
}

fn reasons(d: &Description) -> Vec<String> {
    let mut reasons = Vec::new();
    let is_control = |c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}');
    let names = d.links.iter().map(|link| &link.name).chain(d.joints.iter().map(|joint| &joint.name)).chain([&d.name]);
    reasons.extend(names.filter(|name| name.contains(is_control)).map(|name| format!("the name {name:?}")));
    let has_world = has_world(d);
    for joint in d.joints.iter().filter(|joint| joint.kind == JointKind::Free) {
        let is_plain = has_world && joint.parent == "world" && joint.origin == SE3::identity();
        if !is_plain {
            reasons.push(format!("joint `{}`: a free joint that does not begin at the world's origin", joint.name));
        }
        reasons.extend(of_free_joint(joint));
    }
    reasons
}

fn sdf(text: &mut String, d: &Description, names: &Names) -> fmt::Result {
    let has_mimics = d.joints.iter().any(|joint| joint.mimic.is_some());
    let has_drake = has_mimics || !d.constraints.is_empty() || d.joints.iter().any(|joint| joint.armature != 0.0);
    let space = if has_drake { " xmlns:drake=\"http://drake.mit.edu\"" } else { "" };
    let version = if has_mimics { "1.11" } else { "1.7" };
    writeln!(text, "<?xml version=\"1.0\"?>\n<sdf version=\"{version}\"{space}>")?;
    let in_world = d.gravity != Description::new("").gravity;
    if in_world {
        writeln!(text, "<world name=\"default\">\n  <gravity>{}</gravity>", triple(Vec3(d.gravity)))?;
    }
    writeln!(text, "  <model name=\"{}\">", names.model())?;
    if let Some((_, pose)) = start_pose(d) {
        pose_element(text, "    ", SE3::from_pose(pose), None)?;
    }
    let above: BTreeMap<&str, &Joint> = d.joints.iter().map(|joint| (joint.child.as_str(), joint)).collect();
    let has_world = has_world(d);
    let is_world = |link: &str| has_world && link == "world";
    for each in d.links.iter().filter(|link| !is_world(&link.name)) {
        let joint = above.get(each.name.as_str()).copied();
        let place = joint
            .filter(|joint| joint.kind != JointKind::Free)
            .map(|joint| (joint.origin, (!is_world(&joint.parent)).then(|| names.link(&joint.parent))));
        link(text, each, names, place)?;
    }
    if let Some(base) = base_link(d).filter(|_| d.base == Base::Fixed && !has_world) {
        let child = names.link(&base.name);
        writeln!(
            text,
            "    <joint name=\"{FIXED_BASE}\" type=\"fixed\">\n      <parent>world</parent>\n      \
             <child>{child}</child>\n    </joint>"
        )?;
    }
    for each in d.joints.iter().filter(|joint| joint.kind != JointKind::Free) {
        joint(text, each, names, is_world(&each.parent))?;
    }
    for frame in &d.frames {
        let (name, link) = (names.frame(&frame.name), names.link(&frame.link));
        if is_world(&frame.link) {
            writeln!(text, "    <frame name=\"{name}\" attached_to=\"world\">")?;
        } else {
            writeln!(text, "    <frame name=\"{name}\" attached_to=\"{link}\">")?;
        }
        pose_element(text, "      ", frame.T, None)?;
        text.write_str("    </frame>\n")?;
    }
    for each in &d.constraints {
        const TAG: &str = "drake:ball_constraint";
        let Some(ends) = ball_constraint(d, each) else { continue };
        writeln!(text, "    <{TAG}>")?;
        for ([body, point], (link, p)) in [["A", "p_AP"], ["B", "p_BQ"]].into_iter().zip(ends) {
            writeln!(text, "      <{TAG}_body_{body}>{}</{TAG}_body_{body}>", names.link(link))?;
            writeln!(text, "      <{TAG}_{point}>{}</{TAG}_{point}>", triple(p))?;
        }
        writeln!(text, "    </{TAG}>")?;
    }
    text.write_str("  </model>\n")?;
    text.write_str(if in_world { "</world>\n</sdf>\n" } else { "</sdf>\n" })
}

/// A link, and its configuration relative to another.
fn link(text: &mut String, link: &Link, names: &Names, place: Option<(SE3, Option<&str>)>) -> fmt::Result {
    writeln!(text, "    <link name=\"{}\">", names.link(&link.name))?;
    if let Some((T, other)) = place {
        pose_element(text, "      ", T, other)?;
    }
    let G = link.inertia;
    let (c, I) = (G.center_of_mass(), G.about_center_of_mass());
    text.write_str("      <inertial>\n")?;
    pose_element(text, "        ", SE3::translation(c.0), None)?;
    writeln!(text, "        <mass>{:?}</mass>\n        <inertia>", G.mass)?;
    for (name, x) in [("ixx", I.xx), ("ixy", I.xy), ("ixz", I.xz), ("iyy", I.yy), ("iyz", I.yz), ("izz", I.zz)] {
        writeln!(text, "          <{name}>{x:?}</{name}>")?;
    }
    text.write_str("        </inertia>\n      </inertial>\n    </link>\n")
}

fn joint(text: &mut String, joint: &Joint, names: &Names, of_world: bool) -> fmt::Result {
    // a point of the axis in the child's frame: ω × v
    let (kind, axis, point) = match joint.kind {
        JointKind::Fixed | JointKind::Free => ("fixed", None, Vec3::zero()),
        JointKind::Ball(center) => ("ball", None, center),
        JointKind::Screw(A) if A.is_prismatic() => ("prismatic", Some(A.twist().v), Vec3::zero()),
        JointKind::Screw(A) => {
            let kind = if joint.kind.name() == "helical" { "screw" } else { "revolute" };
            (kind, Some(A.twist().w), A.twist().w.cross(A.twist().v))
        }
    };
    writeln!(text, "    <joint name=\"{}\" type=\"{kind}\">", names.joint(&joint.name))?;
    pose_element(text, "      ", SE3::translation(point.0), None)?;
    let parent = if of_world { "world" } else { names.link(&joint.parent) };
    writeln!(text, "      <parent>{parent}</parent>\n      <child>{}</child>", names.link(&joint.child))?;
    match joint.kind {
        JointKind::Screw(A) if kind == "screw" => {
            writeln!(text, "      <screw_thread_pitch>{:?}</screw_thread_pitch>", travel(A))?;
        }
        _ => {}
    }
    if let Some(xyz) = axis {
        writeln!(text, "      <axis>\n        <xyz>{}</xyz>", triple(xyz))?;
        inside_axis(text, joint, names)?;
        text.write_str("      </axis>\n")?;
    } else if joint.damping != 0.0 && kind == "ball" {
        let damping = joint.damping;
        writeln!(
            text,
            "      <axis>\n        <xyz>0 0 1</xyz>\n        <dynamics>\n          <damping>{damping:?}</damping>\n        \
             </dynamics>\n      </axis>"
        )?;
    }
    if joint.armature != 0.0 && axis.is_some() {
        let armature = joint.armature;
        writeln!(
            text,
            "      <drake:rotor_inertia>{armature:?}</drake:rotor_inertia>\n      <drake:gear_ratio>1</drake:gear_ratio>"
        )?;
    }
    if let Some(mimic) = joint.mimic.as_ref().filter(|_| axis.is_some()) {
        let (source, ratio, offset) = (names.joint(&mimic.joint), mimic.ratio, mimic.offset);
        writeln!(text, "      <drake:mimic joint=\"{source}\" multiplier=\"{ratio:?}\" offset=\"{offset:?}\"/>")?;
    }
    text.write_str("    </joint>\n")
}

/// The travel of a screw per turn.
fn travel(A: ScrewAxis) -> f64 {
    A.pitch() * TAU
}

/// Limits, friction, spring and coupling.
fn inside_axis(text: &mut String, joint: &Joint, names: &Names) -> fmt::Result {
    let limits = joint.limits;
    let bound = |x: f64| x.clamp(-1e16, 1e16);
    let [low, high] = limits.position.map_or([None; 2], |[low, high]| [Some(bound(low)), Some(bound(high))]);
    element(
        text,
        "limit",
        &[("lower", low), ("upper", high), ("effort", limits.effort), ("velocity", limits.velocity)],
    )?;
    let given = |x: f64| (x != 0.0).then_some(x);
    element(
        text,
        "dynamics",
        &[
            ("damping", given(joint.damping)),
            ("friction", given(joint.friction)),
            ("spring_reference", given(joint.spring_reference)),
            ("spring_stiffness", given(joint.stiffness)),
        ],
    )?;
    let Some(mimic) = &joint.mimic else { return Ok(()) };
    writeln!(text, "        <mimic joint=\"{}\">", names.joint(&mimic.joint))?;
    writeln!(text, "          <multiplier>{:?}</multiplier>", mimic.ratio)?;
    writeln!(
        text,
        "          <offset>{:?}</offset>\n          <reference>0</reference>\n        </mimic>",
        mimic.offset
    )
}

/// An element with the numbers that there are.
fn element(text: &mut String, name: &str, numbers: &[(&str, Option<f64>)]) -> fmt::Result {
    if numbers.iter().all(|(_, x)| x.is_none()) {
        return Ok(());
    }
    writeln!(text, "        <{name}>")?;
    for (word, x) in numbers.iter().filter_map(|(word, x)| Some((word, (*x)?))) {
        writeln!(text, "          <{word}>{x:?}</{word}>")?;
    }
    writeln!(text, "        </{name}>")
}

/// Nothing for the identity without another frame.
fn pose_element(text: &mut String, indent: &str, T: SE3, relative_to: Option<&str>) -> fmt::Result {
    let frame = relative_to.map_or_else(String::new, |name| format!(" relative_to=\"{name}\""));
    if T == SE3::identity() && frame.is_empty() {
        return Ok(());
    }
    let rpy = if T.R == SE3::identity().R { [0.0; 3] } else { T.R.to_rpy() };
    writeln!(text, "{indent}<pose{frame}>{} {}</pose>", triple(T.p), triple(Vec3(rpy)))
}
