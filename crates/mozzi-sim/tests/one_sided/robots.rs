//! Robots of the tests.

use mozzi::model::description::{Joint, JointKind};
use mozzi::{Description, Model, SE3, ScrewAxis, SpatialInertia, Sym3, Vec3};
use mozzi_sim::{Method, Options, Run, Simulation, Zero};

pub fn hinge() -> JointKind {
    JointKind::Screw(ScrewAxis::new([0.0, -1.0, 0.0], [0.0; 3]).expect("unit"))
}

pub fn slide() -> JointKind {
    JointKind::Screw(ScrewAxis::new([0.0; 3], [1.0, 0.0, 0.0]).expect("unit"))
}

/// A point of 1 kg at 1 m that hangs along −z at θ = 0.
pub fn pendulum(friction: f64) -> Model {
    let bob = SpatialInertia::point_mass(1.0, Vec3([0.0, 0.0, -1.0]));
    let pivot = Joint { friction, ..Joint::new("pivot", "base", "bob", SE3::identity(), hinge()) };
    let robot = Description::new("pendulum").link("base", SpatialInertia::zero()).link("bob", bob).joint(pivot);
    robot.build().expect("sound")
}

/// A block that slides along x on a spring.
pub fn block(mass: f64, stiffness: f64, friction: f64, limits: Option<[f64; 2]>) -> Model {
    let body = SpatialInertia::new(mass, Vec3::zero(), Sym3::diagonal(0.01, 0.01, 0.01));
    let mut joint = Joint { friction, stiffness, ..Joint::new("slide", "base", "block", SE3::identity(), slide()) };
    joint.limits.position = limits;
    let robot = Description::new("block").link("base", SpatialInertia::zero()).link("block", body).joint(joint);
    robot.build().expect("sound")
}

pub fn run(model: &Model, theta: &[f64], dtheta: &[f64], options: Options) -> Run {
    Simulation::new(options).run(model, theta, dtheta, Zero).expect("a motion")
}

pub fn by(method: Method, duration: f64, step: f64) -> Options {
    Options { method, ..Options::with_step(duration, step).expect("fits") }
}
