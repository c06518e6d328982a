//! What is written is read again as it was.

use mozzi::model::Element;
use mozzi::{Description, ScrewAxis, Vec3};
use mozzi_urdf::{embedded, open, parse, write};

/// The largest difference of numbers, against their size; panics where something else differs.
fn difference(a: &Description, b: &Description) -> f64 {
    let mut largest = 0.0_f64;
    let mut compare = |a: &[f64], b: &[f64]| {
        let scale = a.iter().fold(1e-300_f64, |m, x| m.max(x.abs()));
        largest = a.iter().zip(b).fold(largest, |m, (x, y)| m.max((x - y).abs() / scale));
    };
    assert_eq!((a.base, &a.free_joint), (b.base, &b.free_joint));
    assert_eq!((a.links.len(), a.joints.len()), (b.links.len(), b.joints.len()));
    for (a, b) in a.links.iter().zip(&b.links) {
        assert_eq!(a.name, b.name);
        compare(a.inertia.to_matrix().as_flattened(), b.inertia.to_matrix().as_flattened());
    }
    for (a, b) in a.joints.iter().zip(&b.joints) {
        compare(a.origin.to_matrix().as_flattened(), b.origin.to_matrix().as_flattened());
        compare(&axis(a), &axis(b));
        // all else is equal to the last digit
        let same = mozzi::model::description::Joint { origin: a.origin, kind: a.kind, ..b.clone() };
        assert_eq!(*a, same);
    }
    largest
}

fn axis(joint: &mozzi::model::description::Joint) -> [f64; 6] {
    match joint.kind {
        mozzi::model::description::JointKind::Fixed => [0.0; 6],
        mozzi::model::description::JointKind::Screw(A) => A.twist().to_array(),
        mozzi::model::description::JointKind::Ball(_) | mozzi::model::description::JointKind::Free => [1.0; 6],
    }
}

fn round_trip(name: &str) {
    let robot = open(name).expect(name);
    let text = write(&robot.description).expect("from URDF");
    let again = parse("again.urdf", &text).unwrap_or_else(|error| panic!("{name}: {error}"));
    let found = difference(&robot.description, &again.description);
    assert!(found < 1e-14, "{name}: {found:e}");
}

#[test]
fn the_robots_that_mozzi_brings_along() {
    embedded::names().for_each(round_trip);
}

#[test]
fn free_bases() {
    for name in embedded::names() {
        let robot = open(name).expect(name).description.floating();
        let again = parse("again.urdf", write(&robot).expect("URDF")).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(again.warnings.is_empty(), "{:?}", again.warnings);
        assert!(difference(&robot, &again.description) < 1e-14, "{name}");
    }
    // its names are kept, and names that the robot itself has are not taken
    let text = "<robot name='r'><link name='odom'/><joint name='free' type='floating'><parent link='odom'/><child link='b'/></joint>\
                <link name='b'/></robot>";
    let robot = parse("r.urdf", text).expect("a robot").description;
    let text = write(&robot).expect("URDF");
    assert!(
        text.contains("<link name=\"odom\"/>") && text.contains("<joint name=\"free\" type=\"floating\">"),
        "{text}"
    );
    assert_eq!(parse("again.urdf", text).expect("a robot").description, robot);
    let world = Description::new("w").link("world", mozzi::SpatialInertia::zero()).floating();
    assert!(write(&world).expect("URDF").contains("<link name=\"world'\"/>"));
}

#[test]
fn published_robots() {
    let Ok(folder) = std::env::var("MOZZI_ROBOTS") else {
        eprintln!("skipped: MOZZI_ROBOTS does not name the folder of example-robot-data");
        return;
    };
    for file in [
        "talos_data/robots/talos_reduced.urdf",
        "tiago_description/robots/tiago.urdf",
        "icub_description/robots/icub.urdf",
    ] {
        round_trip(&format!("{folder}/{file}"));
    }
}

#[test]
fn odd_names() {
    let description = Description::new("a \"b\" <c> & 'd'\n\té").link("<l>", mozzi::SpatialInertia::zero());
    assert!(description.check().iter().all(|problem| problem.element != Element::Robot));
    let again = parse("a.urdf", write(&description).expect("URDF")).expect("a robot").description;
    assert_eq!(again, description);
}

#[test]
fn names_for_xacro_are_not_written() {
    let description = Description::new("${a}").link("$5 (b)", mozzi::SpatialInertia::zero());
    let message = write(&description).expect_err("xacro would evaluate it").to_string();
    assert_eq!(message, "URDF cannot express the name \"${a}\"");
}

#[test]
fn springs_are_written_and_read() {
    let mut description = open("ur5").expect("embedded").description;
    (description.joints[1].stiffness, description.joints[1].spring_reference) = (12.5, -0.3);
    let text = write(&description).expect("URDF");
    assert!(text.contains(" spring_stiffness=\"12.5\" spring_reference=\"-0.3\"/>"), "{text}");
    let again = mozzi_urdf::parse("again.urdf", &text).expect("sound");
    assert!(again.warnings.is_empty(), "{:?}", again.warnings);
    let spring =
        |joint: &mozzi::model::description::Joint| (joint.name.clone(), joint.stiffness, joint.spring_reference);
    assert!(again.description.joints.iter().map(spring).eq(description.joints.iter().map(spring)));
    let message = mozzi_urdf::parse("a.urdf", text.replace("\"12.5\"", "\"-1\"")).expect_err("negative").to_string();
    assert!(message.contains("stiffness: is -1, expected a finite number, at least 0"), "{message}");
}

#[test]
fn what_would_be_lost_is_refused() {
    let mut description = open("ur5").expect("embedded").description;
    description.gravity = [0.0, 0.0, -1.62];
    description.joints[1].armature = 0.5;
    let screw = ScrewAxis::from_line([0.0, 0.0, 1.0], [0.0; 3], 0.1).expect("unit");
    description.joints[2].kind = mozzi::model::description::JointKind::Screw(screw);
    assert!(screw.twist().v != Vec3::zero());
    let message = write(&description).expect_err("not URDF").to_string();
    let [first, second] = [&description.joints[1].name, &description.joints[2].name];
    assert_eq!(
        message,
        format!(
            "URDF cannot express joint `{first}`: armature 0.5, nor joint `{second}`: a helical joint, nor gravity [0.0, 0.0, -1.62]"
        )
    );
}
