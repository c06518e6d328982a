//! Forty robots in URDF, MJCF and SDFormat, both ways: names, limits, friction, armature, M and h are the source's, and
//! what a format cannot express is in its list of losses.

use mozzi::Description;
use mozzi::Model;
use mozzi::model::description::{Joint, JointKind};
use mozzi::random::Random;
use mozzi_urdf::{NotWritten, Written, expressible, load, mjcf, parse, sdf};
use std::path::{Path, PathBuf};

/// A format's ending, and its writer.
type Format = (&'static str, fn(&Description) -> Result<Written, NotWritten>);

fn urdf(robot: &Description) -> Result<Written, NotWritten> {
    let mut robot = expressible(robot);
    let states: Vec<String> = robot.states.drain(..).map(|state| format!("the named state {}", state.name)).collect();
    robot.start = None;
    let text = mozzi_urdf::write(&robot).map_err(|error| NotWritten { language: "URDF", reasons: error.reasons })?;
    Ok(Written { text, losses: states, remarks: Vec::new() })
}

const FORMATS: [Format; 3] = [("urdf", urdf), ("sdf", sdf::write), ("xml", mjcf::write)];

/// The robot after it was written and read, and everything that was told.
fn through(robot: &Description, path: &[Format]) -> (Description, String) {
    let (mut robot, mut told) = (robot.clone(), String::new());
    for (ending, write) in path {
        let Written { text, losses, .. } = write(&robot).unwrap_or_else(|error| panic!("{}: {error}", robot.name));
        told += &losses.join("\n");
        let read =
            parse(&format!("r.{ending}"), &text).unwrap_or_else(|error| panic!("{}: {error}\n{text}", robot.name));
        robot = read.description;
    }
    (robot, told)
}

/// With independent mimic joints.
fn freed(robot: &Description) -> Model {
    let mut robot = robot.clone();
    robot.joints.iter_mut().for_each(|joint| joint.mimic = None);
    (robot.states, robot.start) = (Vec::new(), None);
    robot.build().unwrap()
}

/// A moving joint, whose name may have got an ending.
fn twin<'r>(name: &str, robot: &'r Description, told: &str) -> &'r Joint {
    let found = robot.joints.iter().find(|joint| joint.name == name && joint.kind != JointKind::Fixed);
    let renamed = || {
        robot.joints.iter().find(|joint| joint.name == format!("{name}_joint") && told.contains("names that SDFormat"))
    };
    found.or_else(renamed).unwrap_or_else(|| panic!("{}: joint {name} is lost", robot.name))
}

/// Everything but the forces.
fn same_words(before: &Description, after: &Description, told: &str) {
    let mut without_velocity = Vec::new();
    for joint in before.joints.iter().filter(|joint| joint.kind != JointKind::Fixed) {
        let there = twin(&joint.name, after, told);
        let is_told = |what: &str| {
            told.contains(&format!("joint `{}`: {what}", joint.name))
                || told.contains(&format!("joint `{}`: {what}", there.name))
        };
        let place = format!("{}: {}", before.name, joint.name);
        assert!(joint.limits.position == there.limits.position || is_told("the limits"), "{place}: {told}");
        if joint.limits.velocity != there.limits.velocity {
            without_velocity.push([&joint.name, &there.name]);
        }
        assert!(joint.limits.effort == there.limits.effort || is_told("effort limit"), "{place}: {told}");
        assert_eq!(
            (joint.damping, joint.friction, joint.stiffness),
            (there.damping, there.friction, there.stiffness),
            "{place}"
        );
        assert!(joint.armature == there.armature || is_told("armature"), "{place}: {told}");
        let ties = [joint, there].map(|joint| joint.mimic.as_ref().map(|mimic| (mimic.ratio, mimic.offset)));
        assert_eq!(ties[0], ties[1], "{place}");
    }
    // one line for all: the first joint, and how many they are
    if let Some(first) = without_velocity.first() {
        let line =
            |name: &String| told.lines().find(|line| line.starts_with(&format!("the velocity limits of `{name}`")));
        let line = first.iter().find_map(|name| line(name)).unwrap_or_else(|| panic!("{}: {told}", before.name));
        let count = without_velocity.len();
        assert!(count == 1 || line.ends_with(&format!(" ({count})")), "{}: {count}: {line}", before.name);
    }
    for link in &before.links {
        let is_there = after.links.iter().any(|there| there.name == link.name);
        let is_empty = link.inertia == mozzi::SpatialInertia::zero();
        assert!(
            is_there || is_empty && told.contains("links without mass between joints"),
            "{}: link {}",
            before.name,
            link.name
        );
    }
}

/// The largest difference of M and h at 100 states, as a part of the largest number.
fn gap(before: &Description, after: &Description, told: &str, states: usize) -> f64 {
    let (a, b) = (freed(before), freed(after));
    let base = if a.is_floating() { 6 } else { 0 };
    assert_eq!(a.n(), b.n(), "{}", before.name);
    let names: Vec<&str> = b.joint_names().collect();
    // the place there of each joint here
    let order: Vec<usize> = (a.joint_names())
        .map(|name| names.iter().position(|there| *there == twin(name, after, told).name).unwrap())
        .collect();
    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let (mut random, mut worst) = (Random(3), 0.0_f64);
    for _ in 0..states {
        let (mut theta_a, mut theta_b) = (a.neutral_configuration::<f64>(), b.neutral_configuration::<f64>());
        let (mut dtheta_a, mut dtheta_b) = (vec![0.0; a.n()], vec![0.0; b.n()]);
        for (place, k) in a.places().iter().zip(&order) {
            let there = &b.places()[*k];
            if place.freedom == mozzi::Freedom::One {
                let x = random.next();
                (theta_a[place.q], theta_b[there.q]) = (x, x);
            }
            let rates = random.vector(place.freedom.velocities(), 1.0);
            dtheta_a[place.velocities()].copy_from_slice(&rates);
            dtheta_b[there.velocities()].copy_from_slice(&rates);
        }
        let rows: Vec<usize> = (0..base).chain(order.iter().flat_map(|k| b.places()[*k].velocities())).collect();
        let M = [
            a.mass_matrix(&theta_a).unwrap(),
            b.mass_matrix(&theta_b).unwrap().select_rows(&rows).select_columns(&rows),
        ];
        let h = [
            a.bias_forces(&theta_a, &dtheta_a, &a.environment()).unwrap(),
            b.bias_forces(&theta_b, &dtheta_b, &b.environment()).unwrap().select_rows(&rows),
        ];
        let differences = |x: &[f64], y: &[f64]| {
            let differences: Vec<f64> = x.iter().zip(y).map(|(x, y)| x - y).collect();
            largest(&differences) / largest(x).max(f64::MIN_POSITIVE)
        };
        worst =
            worst.max(differences(M[0].as_slice(), M[1].as_slice())).max(differences(h[0].as_slice(), h[1].as_slice()));
    }
    worst
}

/// The robot in each format, and from it in each other.
fn both_ways(robot: &Description, states: usize) -> f64 {
    let mut worst = 0.0_f64;
    for first in FORMATS {
        let (there, told) = through(robot, &[first]);
        same_words(robot, &there, &told);
        worst = worst.max(gap(robot, &there, &told, states));
        for second in FORMATS.into_iter().filter(|second| second.0 != first.0) {
            let (back, told) = through(robot, &[first, second]);
            same_words(robot, &back, &told);
            worst = worst.max(gap(robot, &back, &told, states));
        }
    }
    worst
}

#[test]
fn robots_are_the_same_in_every_format() {
    let Some(folder) = std::env::var_os("MOZZI_ROBOTS") else {
        return println!("skipped: MOZZI_ROBOTS does not name the folder of example-robot-data");
    };
    let mut paths: Vec<PathBuf> = Vec::new();
    crate::files::urdf_files(Path::new(&folder), &mut paths);
    paths.sort();
    let robots: Vec<Description> = paths.iter().filter_map(|path| Some(load(path).ok()?.description)).collect();
    let (mut count, mut worst) = (0, 0.0_f64);
    for robot in robots.iter().filter(|robot| freed(robot).n() > 0).take(40) {
        let error = both_ways(robot, 100);
        assert!(error < 1e-12, "{}: {error:e}", robot.name);
        (count, worst) = (count + 1, worst.max(error));
    }
    println!("{count} robots, 9 paths each, 100 states: M and h differ by up to {worst:.1e}");
    assert_eq!(count, 40);
}

#[test]
fn embedded_robots_are_the_same_in_every_format() {
    for name in mozzi_urdf::embedded::names() {
        let robot = mozzi_urdf::open(name).unwrap().description;
        let error = both_ways(&robot, 5);
        assert!(error < 1e-12, "{name}: {error:e}");
    }
}

/// Everything that a description can have, in the formats that have it.
#[test]
fn what_is_lost_is_told() {
    let model = "<mujoco><compiler angle='radian'/><option gravity='0 0 -1.62'/><worldbody><body name='a'><freejoint name='f'/><geom size='0.1'/>\
         <site name='s' pos='0.1 0 0'/><body name='b'><joint name='j' armature='0.2' stiffness='3' springref='0.1' \
         damping='0.3' frictionloss='0.4' range='-1 1' actuatorfrcrange='-5 5'/><joint name='k' axis='0 1 0'/>\
         <geom size='0.1' pos='0.2 0 0'/></body><body name='c'><joint name='l' type='ball' damping='0.1'/>\
         <geom size='0.1' pos='0 0.3 0'/></body></body></worldbody><tendon><fixed name='t' armature='0.3'><joint joint='j' \
         coef='1'/><joint joint='k' coef='-2'/></fixed></tendon><keyframe><key name='up' qpos='0 0 1 1 0 0 0 0.1 0.2 1 0 0 0'/></keyframe></mujoco>";
    let robot = parse("m.xml", model).unwrap().description;
    let (there, told) = through(&robot, &[("xml", mjcf::write)]);
    assert_eq!((told.as_str(), there.states[0].name.as_str()), ("", "up"));
    assert_eq!((there.rotors.len(), there.frames.len(), there.gravity), (1, 1, robot.gravity));
    assert!(gap(&robot, &there, &told, 10) < 1e-12);
    let written = sdf::write(&robot).unwrap();
    assert_eq!(
        written.losses,
        ["rotor `t`: M differs", "the name of the base's free joint, `f`", "the named states `up`"]
    );
    let of_drake = "Drake ignores the gravity of a file: set [0.0, 0.0, -1.62] in the program";
    assert_eq!(written.remarks, ["Gazebo refuses links without mass: `b:j`", of_drake]);
    let there = parse("r.sdf", &written.text).unwrap().description;
    assert_eq!((there.gravity, there.frames[0].name.as_str(), there.joints.len()), (robot.gravity, "s", 3));
    assert_eq!((there.joints[0].armature, there.joints[0].spring_reference, there.joints[2].damping), (0.2, 0.1, 0.1));
}

/// A screw is a hinge and a slide in MJCF.
#[test]
fn a_screw_moves_alike_in_every_format() {
    let text = "<sdf version='1.11'><model name='r'><link name='a'><inertial><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.2</iyy>\
         <izz>0.25</izz></inertia></inertial></link><link name='b'><inertial><pose>0.1 0.2 0.3 0 0 0</pose><mass>2</mass><inertia>\
         <ixx>0.1</ixx><iyy>0.2</iyy><izz>0.25</izz></inertia></inertial></link><joint name='fixed_base' type='fixed'>\
         <parent>world</parent><child>a</child></joint><joint name='j' type='screw'><pose>0.1 0.2 0 0 0 0</pose><parent>a</parent>\
         <child>b</child><axis><xyz>0 0.6 0.8</xyz></axis><screw_thread_pitch>0.3</screw_thread_pitch></joint></model></sdf>";
    let robot = parse("r.sdf", text).unwrap().description;
    assert_eq!((robot.links.len(), robot.joints.len()), (2, 1), "the base is the link itself");
    let (again, told) = through(&robot, &[("sdf", sdf::write)]);
    assert!(told.is_empty() && gap(&robot, &again, "", 10) < 1e-14);
    let (there, told) = through(&robot, &[("xml", mjcf::write)]);
    assert!(told.contains("joint `j`: a screw, written as a hinge and the slide `j.travel`, tied to it"), "{told}");
    let (a, b) = (robot.build().unwrap(), there.build().unwrap());
    assert_eq!((a.n(), b.n()), (1, 1));
    for x in [-1.0, 0.3, 2.0] {
        let [M, N] = [a.mass_matrix(&[x]).unwrap()[0], b.mass_matrix(&[x]).unwrap()[0]];
        let [g, h] = [
            a.bias_forces(&[x], &[0.7], &a.environment()).unwrap()[0],
            b.bias_forces(&[x], &[0.7], &b.environment()).unwrap()[0],
        ];
        assert!((M - N).abs() < 1e-14 && (g - h).abs() < 1e-13, "{M} {N} {g} {h}");
    }
}

#[test]
fn what_acts_on_a_free_joint_is_named_if_it_cannot_be_written() {
    let body = |joint: &str| format!("<body>{joint}<geom size='0.1'/></body>");
    let bodies = body("<joint name='f' type='free' damping='1' armature='0.5'/>") + &body("<freejoint name='g'/>");
    let text = format!("<mujoco><worldbody>{bodies}</worldbody></mujoco>");
    let robot = parse("free.xml", &text).unwrap().description;
    let found = [sdf::write(&robot).unwrap_err().to_string(), mozzi_urdf::write(&robot).unwrap_err().to_string()];
    for (why, language) in found.iter().zip(["SDFormat", "URDF"]) {
        let expected = "joint `f`: damping 1, armature 0.5 of a free joint";
        assert_eq!(*why, format!("{language} cannot express {expected}"));
    }
}
