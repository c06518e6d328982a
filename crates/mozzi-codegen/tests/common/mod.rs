//! Robots and states for the tests.
#![allow(dead_code, missing_docs)] // each test uses a part

use mozzi::model::description::{Joint, JointKind, Mimic};
use mozzi::{Base, Description, Model, SE3, ScrewAxis, Solid, SpatialInertia, Twist, Vec3};
use mozzi_codegen::Quantity;

/// Numbers in [−1, 1) from a seed: SplitMix64.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() >> 16) as usize % n
    }
    pub fn number(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
    pub fn array<const K: usize>(&mut self) -> [f64; K] {
        std::array::from_fn(|_| self.number())
    }
    pub fn vector(&mut self, n: usize, size: f64) -> Vec<f64> {
        (0..n).map(|_| size * self.number()).collect()
    }
}

fn body(random: &mut Random) -> SpatialInertia {
    let turn = SE3::exp(Twist::from_array(random.array()));
    Solid::Box([0.3, 0.2 + 0.1 * random.number(), 0.1]).inertia(2.0 + random.number()).transformed(turn)
}

/// A tree of revolute, prismatic and helical joints off every axis, with friction and armature; `mimic joints` of the last joints follow
/// others.
pub fn tree(seed: u64, links: usize, mimics: usize) -> Description {
    let mut random = Random(seed);
    let mut robot = Description::new(format!("tree {seed}")).link("link0", body(&mut random));
    for i in 1..=links {
        let parent = if random.number() < 0.4 { i - 1 } else { random.below(i) };
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
        }
        if i > links - mimics {
            let followed = format!("joint{}", 1 + (i * 7) % (links - mimics));
            joint.mimic = Some(Mimic { joint: followed, ratio: 1.5 * random.number(), offset: random.number() });
        }
        robot = robot.link(format!("link{i}"), body(&mut random)).joint(joint);
    }
    robot.end_effector = Some(format!("link{links}"));
    robot.gravity = [0.3, -1.0, -9.7];
    robot
}

/// Arms, quadrupeds and a humanoid of `example-robot-data`, where `MOZZI_ROBOTS` names its folder.
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

/// Every quantity of a robot; those of a frame of its last one.
pub fn quantities(model: &Model) -> Vec<Quantity> {
    let frame = model.frames().last().expect("a frame").0;
    vec![
        Quantity::InverseDynamics,
        Quantity::MassMatrix,
        Quantity::ForwardDynamics,
        Quantity::BiasForces,
        Quantity::VelocityProduct,
        Quantity::GravityForces,
        Quantity::ForwardKinematics(frame),
        Quantity::BodyJacobian(frame),
        Quantity::SpaceJacobian(frame),
        Quantity::InverseDynamicsDerivatives,
        Quantity::ForwardDynamicsDerivatives,
    ]
}

/// θ, θ̇, and θ̈ or τ.
pub fn state(model: &Model, seed: u64) -> [Vec<f64>; 3] {
    let mut random = Random(seed);
    let mut theta = random.vector(model.nq(), 3.0);
    if let (Some(pose), true) = (theta.first_chunk_mut(), model.is_floating()) {
        *pose = SE3::exp(Twist::from_array(random.array()) * 2.0).to_pose();
    }
    [theta, random.vector(model.n(), 2.0), random.vector(model.n(), 5.0)]
}

/// The largest |found − reference| beside the largest |reference|.
pub fn error(found: &[f64], reference: &[f64]) -> f64 {
    assert_eq!(found.len(), reference.len());
    let size = reference.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let worst =
        found.iter().zip(reference).fold(0.0_f64, |m, (x, y)| if (x - y).abs() <= m { m } else { (x - y).abs() });
    if worst == 0.0 { 0.0 } else { worst / size }
}
