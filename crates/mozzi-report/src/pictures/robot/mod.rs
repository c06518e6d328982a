//! A robot at one configuration.

mod draw;
mod order;
mod skeleton;
mod solid;
mod view;

pub use view::View;

use crate::Drawing;
use draw::Canvas;
use mozzi::model::Base;
use mozzi::{Error, Model, SE3, SO3, Vec3};
use mozzi_urdf::geometry::{Form, mesh_corners};
use skeleton::{Bone, Skeleton};
use solid::Solid;
use std::collections::BTreeMap;
use view::Projection;

/// The colour of shapes without one, and of bones.
const GREY: [f64; 3] = [0.62, 0.67, 0.73];
/// The radius of a bone over the robot's size.
const THICKNESS: f64 = 0.014;

/// How a robot is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// The direction of view.
    pub view: View,
    /// Light on dark.
    pub is_dark: bool,
    /// All links as bones instead of shapes.
    pub bones: bool,
    /// Joint axes, the centre of mass, the directions of {s} and a scale.
    pub marks: bool,
    /// The frames of the bodies and of the end effector.
    pub frames: bool,
    /// The title; `None`: the robot's name, its joints and its mass.
    pub title: Option<String>,
}

impl Default for Look {
    fn default() -> Self {
        Look { view: View::ISO, is_dark: false, bones: false, marks: true, frames: false, title: None }
    }
}

/// A drawn robot.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotPicture {
    /// The picture.
    pub svg: String,
    /// Its title.
    pub title: String,
    /// Number of drawn bodies.
    pub bodies: usize,
    /// Number of drawn bones.
    pub bones: usize,
    /// Omitted shapes and the reasons, a sentence each.
    pub notes: Vec<String>,
}

/// Each body is compared with those that it overlaps.
const MOST_LINKS: usize = 2000;

/// The robot at θ, as SVG, by parallel projection: the shapes of its links, meshes as their convex hulls; bones for
/// bodies without shapes; the axes of joints and the centre of mass of all that moves. Farther bodies are drawn first.
///
/// # Errors
/// [`Error::WrongLength`]; [`Error::BadArgument`] of more than 2000 links.
pub fn robot(model: &Model, theta: &[f64], drawing: &Drawing, look: &Look) -> Result<RobotPicture, Error> {
    let links = model.description().links.len();
    if links > MOST_LINKS {
        let (what, found) = ("the number of links", links.to_string());
        return Err(Error::BadArgument { what, found, expected: "at most 2000 in a picture" });
    }
    let skeleton = Skeleton::new(model, theta)?;
    let P = Projection::of(look.view);
    let mut notes = Vec::new();
    let mut bodies: BTreeMap<&str, Vec<Solid>> = BTreeMap::new();
    if !look.bones {
        shapes(&skeleton, drawing, &P, &mut bodies, &mut notes);
    }
    let bones: Vec<Bone> = skeleton.bones().into_iter().filter(|bone| !bodies.contains_key(bone.body)).collect();
    let axes = skeleton.axes();
    let ends = bones.iter().flat_map(|bone| bone.ends).chain(axes.iter().map(|axis| axis.point));
    let corners = bodies.values().flatten().flat_map(|solid| solid.outline.iter().copied());
    let all: Vec<[f64; 2]> = ends.map(|p| P.point(p)).chain(corners).collect();
    let [[left, right], [low, high]] = order::bounds(&all);
    let size = if all.is_empty() { 1.0 } else { (right - left).max(high - low).max(1e-3) };
    for bone in &bones {
        let list = bodies.entry(bone.body).or_default();
        list.extend(
            capsule(bone.ends, THICKNESS * size).and_then(|(form, T)| Solid::new(form, T, Vec::new(), GREY, &P)),
        );
    }
    let names: Vec<&str> = bodies.keys().copied().collect();
    let solids: Vec<&[Solid]> = bodies.values().map(Vec::as_slice).collect();
    let title = look.title.clone().unwrap_or_else(|| title(model));
    let mut canvas = Canvas::new(P, look.is_dark, &solids, &all, size);
    for k in order::order(&solids, &P) {
        canvas.body(names[k], solids[k]);
    }
    if look.marks {
        axes.iter().for_each(|axis| canvas.axis(axis));
    }
    if look.frames {
        let of_bodies = skeleton.moving_joints().iter().map(|joint| joint.child.as_str());
        let tip = model.end_effector().ok().map(|frame| model.frame_name(frame));
        of_bodies.chain(tip).filter_map(|name| skeleton.pose(name)).for_each(|T| canvas.frame(T));
    }
    if look.marks {
        let center = model.center_of_mass(theta)?;
        if center.0.iter().all(|x| x.is_finite()) {
            canvas.center_of_mass(center);
        }
    }
    let svg = canvas.svg(&title, look.marks);
    Ok(RobotPicture { svg, title, bodies: names.len(), bones: bones.len(), notes })
}

/// The solids of the drawing's shapes, by the root links of their bodies.
fn shapes<'m>(
    skeleton: &'m Skeleton<'_>,
    drawing: &'m Drawing,
    P: &Projection,
    bodies: &mut BTreeMap<&'m str, Vec<Solid>>,
    notes: &mut Vec<String>,
) {
    let mut known: BTreeMap<&str, Result<Vec<Vec3>, String>> = BTreeMap::new();
    for shape in drawing.shapes() {
        let Some(T) = skeleton.pose(&shape.link) else { continue };
        let vertices = match &shape.form {
            Form::Mesh { file, scale } => {
                let read = || drawing.mesh_file(file).and_then(|(format, bytes)| mesh_corners(format, &bytes));
                let is_new = !known.contains_key(file.as_str());
                match known.entry(file).or_insert_with(read) {
                    Ok(found) => found.iter().map(|v| Vec3([0, 1, 2].map(|k| v.0[k] * scale[k]))).collect(),
                    Err(why) => {
                        notes.extend(is_new.then(|| format!("mesh {file}: {why}")));
                        continue;
                    }
                }
            }
            _ => Vec::new(),
        };
        let color = shape.color.map_or(GREY, |[r, g, b, _]| [r, g, b]);
        if let Some(solid) = Solid::new(shape.form.clone(), T * shape.T, vertices, color, P) {
            bodies.entry(skeleton.root(&shape.link)).or_default().push(solid);
        }
    }
}

/// A capsule between two points; `None` if one is infinite or NaN.
fn capsule([from, to]: [Vec3; 2], radius: f64) -> Option<(Form, SE3)> {
    let (along, length) = (to - from, (to - from).norm());
    if !length.is_finite() {
        return None;
    }
    // the rotation of z to the bone, about z × d
    let R = match along.0 {
        _ if length < 1e-9 => SO3::identity(),
        [x, y, z] => {
            let across = x.hypot(y);
            let turn = if across > 0.0 { Vec3([-y / across, x / across, 0.0]) } else { Vec3([1.0, 0.0, 0.0]) };
            SO3::exp(turn * across.atan2(z))
        }
    };
    Some((Form::Capsule { radius, length }, SE3 { R, p: (from + to) * 0.5 }))
}

/// "ur5, 6 joints, 21.0 kg".
fn title(model: &Model) -> String {
    let robot = model.description();
    let joints = mozzi_urdf::counted(model.joint_names().len(), "joint");
    let mass: f64 = robot.links.iter().map(|link| link.inertia.mass).sum();
    let base = if robot.base == Base::Floating { ", floating base" } else { "" };
    let digits = if mass > 0.0 { (2.0 - mass.log10().floor()).clamp(0.0, 9.0) as usize } else { 0 };
    format!("{}{base}, {joints}, {mass:.digits$} kg", robot.name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Meshes;

    fn drawn(name: &str, theta: &[f64], look: &Look) -> RobotPicture {
        let model = mozzi_urdf::open(name).and_then(mozzi_urdf::Loaded::build).expect("embedded");
        robot(&model, theta, &Drawing::of_file(name, Meshes::Visual).expect("embedded"), look).expect("a picture")
    }

    #[test]
    fn a_robot_without_shapes_has_a_bone_to_each_joint_and_one_to_the_tip() {
        let bare = Look { bones: true, ..Look::default() };
        for (name, n, bones) in [("ur5", 6, 7), ("double_pendulum", 2, 3), ("anymal", 12, 16)] {
            let model = mozzi_urdf::open(name).and_then(mozzi_urdf::Loaded::build).expect("embedded");
            let found = drawn(name, &model.start().theta, &bare);
            assert_eq!((model.joint_names().len(), found.bones), (n, bones), "{name}");
            assert_eq!(found.svg.matches("class=\"axis\"").count(), n, "{name}");
            roxmltree::Document::parse(&found.svg).expect("well-formed");
        }
    }

    #[test]
    fn nearer_bodies_are_drawn_later() {
        // the upper arm points to the viewer of the front view, then away from it
        let body = |svg: &str, name: &str| svg.find(&format!("data-body=\"{name}\"")).expect("a body");
        let front = Look { view: View::FRONT, ..Look::default() };
        for (shoulder, is_near) in [(0.0, true), (std::f64::consts::PI, false)] {
            let svg = drawn("ur5", &[shoulder, 0.0, 0.0, 0.0, 0.0, 0.0], &front).svg;
            let is_found_near = body(&svg, "wrist_3_link") > body(&svg, "base_link");
            assert_eq!(is_found_near, is_near, "{shoulder}");
        }
    }

    #[test]
    fn the_scale_of_a_small_robot_has_a_length() {
        let mut small = mozzi_urdf::open("double_pendulum").expect("embedded").description;
        small.joints.iter_mut().for_each(|joint| joint.origin.p = joint.origin.p * 1e-4);
        small.frames.iter_mut().for_each(|frame| frame.T.p = frame.T.p * 1e-4);
        let model = small.build().expect("sound");
        let bare = Look { bones: true, ..Look::default() };
        let svg = robot(&model, &[0.3, 0.2], &Drawing::default(), &bare).expect("a picture").svg;
        assert!(svg.contains(" mm</text>") && !svg.contains(">0 mm</text>"), "{svg:.3000}");
    }

    #[test]
    fn titles_are_escaped_and_dark_is_dark() {
        let look = Look { is_dark: true, title: Some("A & <B>".into()), frames: true, ..Look::default() };
        let svg = drawn("panda", &[0.0; 8], &look).svg;
        assert!(svg.contains("A &amp; &lt;B&gt;") && svg.contains("fill=\"#15191f\""), "{svg:.600}");
        roxmltree::Document::parse(&svg).expect("well-formed");
        let light = drawn("ur5", &[0.0; 6], &Look::default());
        assert!(
            light.svg.contains("fill=\"#ffffff\"") && light.title.starts_with("ur5, 6 joints, "),
            "{}",
            light.title
        );
        assert!(light.bones == 0 && light.notes.is_empty() && !light.svg.contains("NaN"));
    }
}
