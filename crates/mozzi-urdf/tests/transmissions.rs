//! Rotors of ROS's transmissions, limits of URDF 1.2, limits that a CAD program left at 0.

use mozzi_urdf::{Loaded, Policy, parse, parse_with};

/// A body of 0.1 kg m² about its joint, and more elements.
fn text(root: &str, limit: &str, more: &str) -> String {
    format!(
        "<robot name='r'{root}><link name='b'/><link name='arm'><inertial><mass value='1'/><inertia ixx='0.1' \
         iyy='0.1' izz='0.1' ixy='0' ixz='0' iyz='0'/></inertial></link><joint name='j' type='revolute'>\
         <parent link='b'/><child link='arm'/><axis xyz='0 0 1'/>{limit}</joint>{more}</robot>"
    )
}

const LIMIT: &str = "<limit lower='-1' upper='1' effort='5' velocity='2'/>";

fn read(text: &str) -> Loaded {
    parse("r.urdf", text).unwrap_or_else(|error| panic!("{error}"))
}

fn inertia(more: &str) -> f64 {
    let robot = parse_with("r.urdf", text("", LIMIT, more), Policy::Strict).unwrap_or_else(|error| panic!("{error}"));
    robot.build().unwrap().mass_matrix(&[0.3]).unwrap()[(0, 0)]
}

fn codes(robot: &Loaded) -> Vec<&str> {
    robot.warnings.iter().map(|found| found.code().trim_start_matches("mozzi::urdf::")).collect()
}

#[test]
fn a_rotor_behind_a_reduction_is_an_armature() {
    let simple = "<type>transmission_interface/SimpleTransmission</type><joint name='j'/>";
    let ros = |actuator: &str| {
        format!("<transmission name='t'>{simple}<actuator name='m'>{actuator}</actuator></transmission>")
    };
    let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    close(inertia(&ros("<mechanicalReduction>50</mechanicalReduction><motorInertia>4e-5</motorInertia>")), 0.1 + 0.1);
    close(inertia(&ros("<rotor_inertia>0.02</rotor_inertia>")), 0.12);
    close(inertia(&ros("<mechanicalReduction>50</mechanicalReduction>")), 0.1);
    // ros2_control's transmission, with the reduction at the joint
    let inner = "<transmission name='t'><plugin>transmission_interface/SimpleTransmission</plugin><actuator name='m'>\
                 <motor_inertia>1e-4</motor_inertia></actuator><joint name='j'><mechanical_reduction>-10\
                 </mechanical_reduction></joint></transmission>";
    close(inertia(&format!("<ros2_control name='c' type='system'>{inner}</ros2_control>")), 0.11);
}

#[test]
fn a_rotor_that_is_not_used_is_named() {
    let with = |kind: &str, more: &str| {
        let of = |inside: &str| format!("<transmission name='t'><type>{kind}</type>{inside}</transmission>");
        let text =
            text("", LIMIT, &of(&format!("<actuator name='m'><motorInertia>1e-4</motorInertia></actuator>{more}")));
        parse("r.urdf", text)
    };
    let robot = with("transmission_interface/DifferentialTransmission", "<joint name='j'/>").unwrap();
    assert_eq!(codes(&robot), ["ignored_property"]);
    assert!(robot.warnings[0].message().contains("its rotor is ignored: the type is"), "{}", robot.warnings[0]);
    let two = with("SimpleTransmission", "<joint name='j'/><joint name='j'/>").unwrap();
    assert!(two.warnings[0].message().contains("several joints or actuators"), "{}", two.warnings[0]);
    let missing = with("SimpleTransmission", "<joint name='jj'/>").unwrap_err().to_string();
    assert!(missing.contains("there is no joint `jj`"), "{missing}");
    let wrong = with("SimpleTransmission", "<joint name='j'><mechanicalReduction>ten</mechanicalReduction></joint>");
    assert!(wrong.unwrap_err().to_string().contains("`ten`"));
    let twice = "<joint name='j'><mechanicalReduction>10</mechanicalReduction></joint><gearRatio>9</gearRatio>";
    assert!(with("SimpleTransmission", twice).unwrap_err().to_string().contains("another reduction"));
}

#[test]
fn limits_of_acceleration_are_read_from_version_1_2_on() {
    let limit = "<limit lower='-1' upper='1' effort='5' velocity='2' acceleration='8' deceleration='6'/>";
    let acceleration = |robot: &Loaded| robot.description.joints[0].limits.acceleration;
    let robot = read(&text(" version='1.2'", limit, ""));
    assert_eq!((acceleration(&robot), codes(&robot).len()), (Some(6.0), 0));
    let earlier = read(&text("", limit, ""));
    assert_eq!((acceleration(&earlier), codes(&earlier)), (None, vec!["ignored_limit", "ignored_limit"]));
    let jerk = read(&text(" version='1.2'", &limit.replace("deceleration", "jerk"), ""));
    assert_eq!((acceleration(&jerk), codes(&jerk)), (Some(8.0), vec!["ignored_limit"]));
    let negative = parse("r.urdf", text(" version='1.2'", &limit.replace("'6'", "'-6'"), ""));
    assert!(negative.unwrap_err().to_string().contains("acceleration limit: is -6, expected at least 0"));
    // a round trip, in URDF and in JSON
    let written = mozzi_urdf::write(&robot.description).unwrap();
    assert_eq!(acceleration(&read(&written)), Some(6.0), "{written}");
    let json = mozzi_urdf::json::write(&robot.description.clone().build().unwrap());
    let file = mozzi_urdf::json::File::parse("r.json", json).unwrap();
    let again = mozzi_urdf::json::read(&file).unwrap();
    assert_eq!(again.joints[0].limits, robot.description.joints[0].limits);
}

#[test]
fn limits_that_are_all_zero_are_reported() {
    let robot = read(&text("", "<limit lower='0' upper='0' effort='0' velocity='0'/>", ""));
    assert_eq!(codes(&robot), ["zero_limits"]);
    for limit in
        ["<limit lower='0' upper='0' effort='5' velocity='2'/>", "<limit lower='0' upper='1' effort='0' velocity='0'/>"]
    {
        assert!(codes(&read(&text("", limit, ""))).is_empty(), "{limit}");
    }
}
