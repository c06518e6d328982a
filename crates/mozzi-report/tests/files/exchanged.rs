//! Numbers and names of two that are exchanged, and several numbers of a link at once.

use crate::{compare_description, has_cause};
use mozzi::model::description::Description;
use mozzi::{SpatialInertia, Sym3, Vec3};

fn inertia<'r>(robot: &'r mut Description, link: &str) -> &'r mut SpatialInertia {
    &mut robot.links.iter_mut().find(|each| each.name == link).unwrap().inertia
}

fn parts(G: SpatialInertia) -> (f64, Vec3, Sym3) {
    (G.mass, G.center_of_mass(), G.about_center_of_mass())
}

#[test]
fn inertias_of_two_links() {
    let comparison = compare_description(|robot| {
        let (upper, lower) = (*inertia(robot, "upper"), *inertia(robot, "lower"));
        (*inertia(robot, "upper"), *inertia(robot, "lower")) = (lower, upper);
    });
    has_cause(&comparison, "b.urdf has the inertias of `upper` and `lower` exchanged", true);
}

#[test]
fn names_of_two_joints() {
    let comparison = compare_description(|robot| {
        for joint in &mut robot.joints {
            joint.name = match joint.name.as_str() {
                "shoulder" => "elbow".into(),
                "elbow" => "shoulder".into(),
                other => other.to_string(),
            };
        }
    });
    let text = comparison.text();
    let causes: Vec<&str> = comparison.causes().filter(|cause| !cause.contains("limit")).collect();
    assert!(causes.len() == 1, "{text}");
    assert!(causes[0].contains("b.urdf has the names of `shoulder` and `elbow` exchanged"), "{text}");
    assert!(crate::is_accounted_for(&comparison), "{text}");
}

#[test]
fn damping_and_friction_and_limits_of_a_joint() {
    let comparison = compare_description(|robot| {
        let joint = robot.joints.iter_mut().find(|joint| joint.name == "shoulder").unwrap();
        (joint.damping, joint.friction) = (joint.friction, joint.damping);
    });
    has_cause(&comparison, "b.urdf has damping and friction of `shoulder` exchanged", true);
    let comparison = compare_description(|robot| {
        let limits = &mut robot.joints.iter_mut().find(|joint| joint.name == "shoulder").unwrap().limits;
        (limits.effort, limits.velocity) = (limits.velocity, limits.effort);
    });
    has_cause(&comparison, "b.urdf has the limits of velocity and effort of `shoulder` exchanged", true);
}

#[test]
fn several_numbers_of_a_link() {
    let with = |m: f64, mirrored: f64, products: f64| {
        compare_description(|robot| {
            let G = inertia(robot, "upper");
            let (mass, c, I) = parts(*G);
            let c = Vec3([c.0[0], mirrored * c.0[1], c.0[2]]);
            let I = Sym3 { xy: products * I.xy, xz: products * I.xz, yz: products * I.yz, ..I };
            *G = SpatialInertia::new(m * mass, c, I);
        })
    };
    let pounds = 1.0 / 0.45359237;
    has_cause(&with(pounds, 1.0, 1.0), "another mass of `upper`: 4.40925 kg instead of 2 kg (pounds)", true);
    has_cause(&with(1.0, -1.0, 1.0), "with the other sign of y", true);
    has_cause(&with(1.0, 1.0, 0.0), "b.urdf drops ixy, ixz, iyz of the inertia of `upper`", true);
    has_cause(
        &with(1.1, -1.0, 1.0),
        "another mass of `upper`: 2.2 kg instead of 2 kg and another centre of mass",
        true,
    );
}
