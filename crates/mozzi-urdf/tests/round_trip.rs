//! Round trips: a written robot is read back unchanged.

use mozzi::model::Element;
use mozzi::{Description, ScrewAxis, Vec3};
use mozzi_urdf::{embedded, open, parse, write};

/// The largest relative difference of numbers; panics if anything else differs.
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
        // everything else is equal to the last digit
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

/// urdfdom refuses a limit without effort and velocity, and reads bounds that are missing as 0.
#[test]
fn limits_are_complete_and_armature_is_an_extension() {
    let mut description = open("ur5").expect("embedded").description;
    let slide = ScrewAxis::prismatic([0.0, 0.0, 1.0]).expect("unit");
    description.joints[1].kind = mozzi::model::description::JointKind::Screw(slide);
    description.joints[1].limits = mozzi::model::description::Limits::default();
    description.joints[1].armature = 0.5;
    description.joints[2].limits.effort = None;
    description.joints[3].limits = mozzi::model::description::Limits::default();
    let text = write(&description).expect("URDF");
    let unlimited = "1.7976931348623157e308";
    let limit = |more: &str| format!("<limit {more}effort=\"{unlimited}\" velocity=\"");
    assert!(text.contains(&(limit(&format!("lower=\"-{unlimited}\" upper=\"{unlimited}\" ")) + unlimited)), "{text}");
    assert_eq!(text.matches(" effort=").count(), 5, "a continuous joint without limits has none");
    assert!(text.contains("armature=\"0.5\"/>"), "{text}");
    let again = parse("again.urdf", &text).expect("sound");
    assert!(again.warnings.is_empty(), "{:?}", again.warnings);
    assert!(difference(&description, &again.description) < 1e-14);
}

/// Frames become links, and a joint whose axis misses its link's frame turns a link on its axis.
#[test]
fn other_robots_are_made_expressible() {
    let text = include_str!("convert/offset.xml");
    let robot = parse("offset.xml", text).expect("sound").description;
    assert!(write(&robot).is_err());
    let again = parse("again.urdf", write(&mozzi_urdf::expressible(&robot)).expect("URDF")).expect("sound").description;
    let [a, b]: [mozzi::Model; 2] = [robot, again].map(|robot| robot.build().expect("sound"));
    assert!(a.joint_names().eq(b.joint_names()) && a.n() == 3);
    let theta = [0.3, -0.2, 0.7];
    let (M, N) = (a.mass_matrix(&theta).expect("M"), b.mass_matrix(&theta).expect("M"));
    assert!((M.clone() - N).amax() < 1e-14 * M.amax());
    for (frame, name) in a.frames() {
        let found = b.forward_kinematics(&theta, b.frame(name).expect("the same name")).expect("a pose");
        let apart = a.forward_kinematics(&theta, frame).expect("a pose").inverse() * found;
        assert!(apart.log().to_array().iter().all(|x| x.abs() < 1e-14), "{name}");
    }
}

#[test]
fn what_would_be_lost_is_refused() {
    let mut description = open("ur5").expect("embedded").description;
    description.gravity = [0.0, 0.0, -1.62];
    let screw = ScrewAxis::from_line([0.0, 0.0, 1.0], [0.0; 3], 0.1).expect("unit");
    description.joints[2].kind = mozzi::model::description::JointKind::Screw(screw);
    assert!(screw.twist().v != Vec3::zero());
    let message = write(&description).expect_err("not URDF").to_string();
    let name = &description.joints[2].name;
    let expected = format!("URDF cannot express joint `{name}`: a helical joint, nor gravity [0.0, 0.0, -1.62]");
    assert_eq!(message, expected);
}
