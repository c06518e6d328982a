//! `<robot>`: the root element.

use crate::report::finding::Finding;
use crate::report::places::{Place, Places};
use crate::report::spelling::did_you_mean;
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::version;
use crate::urdf::vocabulary::{ROBOT, shown};
use crate::urdf::{drake, floating, joint, link, series, transmission};
use joint::Freedoms;
use mozzi::model::description::ConstraintKind;
use mozzi::{Base, Description};

/// Links and joints in the order of the file, and their places. None if the file is not URDF at all, or is wrong
/// throughout.
pub(crate) fn read(root: &Element, cx: &mut Context) -> Option<(Description, Places)> {
    if root.name() != "robot" {
        cx.findings.add(wrong_root(root));
        return None;
    }
    root.check_attributes(&ROBOT, cx);
    cx.version = version::read(root, cx);
    let mut places = Places { robot: Place::new(root.span()), ..Places::default() };
    let name = root.required_name("name", cx);
    let mut description = Description::new(places.robot.note("name", name));
    let mut floating_joints = Vec::new();
    for child in root.elements() {
        if cx.findings.is_full() {
            return None;
        }
        match child.written_name() {
            "link" => {
                let (link, place) = link::read(&child, cx);
                description.links.push(link);
                places.links.push(place);
            }
            "joint" | "drake:joint" => {
                let joint::Read { joint, place, freedoms } = joint::read(&child, cx);
                if let Freedoms::Series(parts) = &freedoms {
                    series::add(joint, parts, &place, &mut description, &mut places);
                    continue;
                }
                if let Freedoms::Six = freedoms {
                    floating_joints.push(description.joints.len());
                }
                description.joints.push(joint);
                places.joints.push(place);
            }
            "loop_joint" => {
                let message = format!("{}: is not an element of URDF", child.subject);
                let help = "expected a tree of joints: replace it by a <drake:ball_constraint> or by constraints in a \
                            file of their own";
                cx.findings.add(Finding::error("loop_closure", child.span(), message).help(help));
            }
            "constraint" => {
                let message = format!(
                    "{}: is a proposal for URDF that no version defines, and that readers ignore or refuse",
                    child.subject
                );
                let help = "write a <drake:ball_constraint>, or the constraints in a file of their own";
                cx.findings.add(Finding::error("unsupported_constraint", child.span(), message).help(help));
            }
            "drake:ball_constraint" => drake::ball_constraint(&child, &mut description, &mut places, cx),
            _ => {}
        }
    }
    transmission::rotors(root, &mut description, &mut places, cx);
    let before = cx.findings.errors();
    root.check_children(&ROBOT, cx);
    places.is_partial = cx.findings.errors() > before; // a misspelled <link>, a macro
    cx.report_repeated();
    floating::free_base(&floating_joints, &mut description, &mut places);
    // the parent link of a floating base is {s}
    if description.base == Base::Floating {
        for one in &mut description.constraints {
            if let ConstraintKind::Frames { a, b, .. } = &mut one.kind {
                let parent = &description.free_joint.parent;
                [a, b].into_iter().for_each(|anchor| anchor.frame = anchor.frame.take().filter(|name| name != parent));
            }
        }
    }
    Some((description, places))
}

fn wrong_root(root: &Element) -> Finding {
    let message = format!("the root element is <{}>, expected <robot>", shown(root.written_name()));
    let help = match root.name() {
        "COLLADA" => Some("the file is a mesh, not a robot".to_string()),
        other => did_you_mean(other, ["robot"]),
    };
    Finding::error("wrong_root", root.span(), message).maybe_help(help)
}
