//! Robots and states for the tests.
#![allow(dead_code, missing_docs)] // each test uses a part

use mozzi::model::description::{Joint, JointKind, Mimic};
use mozzi::quantities::{LIST, Of, Query};
use mozzi::random::Random;
use mozzi::{Base, Description, Model, SE3, ScrewAxis, Solid, SpatialInertia, Task, TaskFrame, Twist, Vec3};

pub use mozzi::testing::state;

fn body(random: &mut Random) -> SpatialInertia {
    let turn = SE3::exp(Twist::from_array(random.array()));
    Solid::Box([0.3, 0.2 + 0.1 * random.next(), 0.1]).inertia(2.0 + random.next()).transformed(turn)
}

/// A tree of revolute, prismatic and helical joints off every axis, with friction, armature and springs; `mimic joints`
/// of the last joints follow others.
pub fn tree(seed: u64, links: usize, mimics: usize) -> Description {
    let mut random = Random(seed);
    let mut robot = Description::new(format!("tree {seed}")).link("link0", body(&mut random));
    for i in 1..=links {
        let parent = if random.next() < 0.4 { i - 1 } else { random.below(i) };
        let mut V = Twist::from_array(random.array());
        match i % 4 {
            0 => V.w = Vec3([0.0; 3]),                                      // a slide
            1 => {}                                                         // a helix
            2 => V = Twist { w: Vec3([0.0, 0.0, 1.0]), v: Vec3([0.0; 3]) }, // about the link's own z
            _ => V.v = Vec3(random.array()).cross(V.w),
        }
        let (axis, _) = ScrewAxis::normalize(V).expect("a random screw");
        let origin = SE3::exp(Twist::from_array(random.array()));
        let kind = JointKind::Screw(axis);
        let mut joint = Joint::new(format!("joint{i}"), format!("link{parent}"), format!("link{i}"), origin, kind);
        if i % 3 == 0 {
            (joint.damping, joint.friction, joint.armature) = (0.3, 0.5, 0.1);
            (joint.stiffness, joint.spring_reference) = (2.5, 0.4);
        }
        if i > links - mimics {
            let followed = format!("joint{}", 1 + (i * 7) % (links - mimics));
            joint.mimic = Some(Mimic { joint: followed, ratio: 1.5 * random.next(), offset: random.next() });
        }
        robot = robot.link(format!("link{i}"), body(&mut random)).joint(joint);
    }
    robot.end_effector = Some(format!("link{links}"));
    robot.gravity = [0.3, -1.0, -9.7];
    robot
}

/// Arms, quadrupeds and a humanoid of `example-robot-data`, if `MOZZI_ROBOTS` names its folder.
pub fn published() -> Vec<(String, Model)> {
    const FILES: [&str; 6] = [
        "kinova_description/robots/kinova.urdf",
        "xarm_description/urdf/xarm7.urdf",
        "z1_description/urdf/z1.urdf",
        "hyq_description/robots/hyq_no_sensors.urdf",
        "double_pendulum_description/urdf/double_pendulum.urdf",
        "talos_data/robots/talos_reduced.urdf",
    ];
    let Some(folder) = std::env::var_os("MOZZI_ROBOTS").map(std::path::PathBuf::from) else {
        eprintln!("published robots are skipped: MOZZI_ROBOTS does not name the folder of example-robot-data");
        return Vec::new();
    };
    let load = |file: &str| {
        let model = mozzi_urdf::load(folder.join(file)).and_then(mozzi_urdf::Loaded::build);
        (file.to_string(), model.unwrap_or_else(|error| panic!("{file}: {error}")))
    };
    FILES.into_iter().map(load).collect()
}

/// The embedded robots, random trees, both on floating bases, and [`published`] ones.
pub fn robots() -> Vec<(String, Model)> {
    let mut robots: Vec<_> = mozzi_urdf::embedded::names()
        .map(|name| {
            let model = mozzi_urdf::open(name).and_then(|robot| robot.build()).expect("an embedded robot");
            (name.to_string(), model)
        })
        .collect();
    for (seed, links, mimics) in [(1, 2, 0), (2, 4, 0), (3, 9, 0), (4, 8, 2), (5, 12, 3)] {
        let robot = tree(seed, links, mimics);
        robots.push((format!("{} free", robot.name), robot.clone().floating().build().expect("sound")));
        robots.push((robot.name.clone(), robot.build().expect("sound")));
    }
    let free = mozzi_urdf::open("panda").expect("an embedded robot").build().expect("sound").with_base(Base::Floating);
    robots.push(("panda free".to_string(), free.expect("sound")));
    robots.extend(published());
    robots
}

/// Every quantity of a robot: quantities of a frame for the last frame, quantities of a task for the last task that is
/// not singular in any state of the tests.
pub fn quantities(model: &Model) -> Vec<Query<'static>> {
    let frames: Vec<_> = model.frames().map(|(frame, _)| frame).collect();
    let task = |query: Query<'static>| {
        let rows = [&[2, 3, 4][..], &[1, 5], &[2], &[1], &[0]];
        let tasks = frames
            .iter()
            .rev()
            .flat_map(|&frame| rows.map(|rows| query.of_task(Task { frame, coordinates: TaskFrame::Body, rows })));
        let is_regular = |query: &Query| (0..32).all(|seed| compute(model, *query, seed).is_ok());
        tasks.into_iter().find(is_regular).expect("a frame that turns")
    };
    let of_list = |place: usize| {
        let query = Query::at(place);
        match query.declaration().of {
            Of::Robot => query,
            Of::Frame => query.of(frames[frames.len() - 1]),
            Of::Point => query.about(Vec3([0.5, -0.25, 1.0])),
            Of::Task => task(query),
        }
    };
    (0..LIST.len()).map(of_list).collect()
}

/// The entries of a [`state`] that a quantity takes.
pub fn inputs<'s>(query: Query, state: &'s [Vec<f64>; 3]) -> Vec<&'s [f64]> {
    let array = |name| match name {
        "theta" => &state[0][..],
        "dtheta" | "x" => &state[1],
        "w" => &[0.3, -0.7, 1.1, 2.0, -1.5, 0.4],
        _ => &state[2],
    };
    query.declaration().inputs.iter().map(|input| array(input.name)).collect()
}

/// Computed by the kernels, in the robot's own environment.
pub fn compute(model: &Model, query: Query, seed: u64) -> Result<Vec<Vec<f64>>, mozzi::Error> {
    model.compute(query, &inputs(query, &state(model, seed)), &model.environment())
}

/// Pivots and solves lose accuracy in proportion to the matrix's condition number.
pub fn tolerance(query: Query) -> f64 {
    match query.declaration() {
        declaration if !declaration.divides && declaration.name.ends_with("_vjp") => 2e-13, // sums that cancel
        declaration if !declaration.divides => 2e-14,
        declaration if declaration.of == Of::Task => 1e-8,
        _ => 1e-10,
    }
}

/// The largest |found − reference| relative to the largest |reference|.
pub fn error(found: &[f64], reference: &[f64]) -> f64 {
    assert_eq!(found.len(), reference.len());
    let size = reference.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let worst =
        found.iter().zip(reference).fold(0.0_f64, |m, (x, y)| if (x - y).abs() <= m { m } else { (x - y).abs() });
    if worst == 0.0 { 0.0 } else { worst / size }
}
