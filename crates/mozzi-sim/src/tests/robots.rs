//! Robots of the tests.

use mozzi::model::description::{Joint, JointKind};
use mozzi::testing;
use mozzi::{Description, Model, SE3, ScrewAxis, SpatialInertia, Sym3, Vec3};

/// A hinge about −y, so that positive angles swing a body that hangs along −z towards +x.
pub fn swing() -> JointKind {
    JointKind::Screw(ScrewAxis::new([0.0, -1.0, 0.0], [0.0; 3]).expect("unit"))
}

/// A point of 2 kg at 0.7 m, hanging along −z at θ = 0, with damping d and Coulomb friction μ.
pub fn pendulum(damping: f64, friction: f64) -> Model {
    let bob = SpatialInertia::point_mass(2.0, Vec3([0.0, 0.0, -0.7]));
    let pivot = Joint { damping, friction, ..Joint::new("pivot", "base", "bob", SE3::identity(), swing()) };
    let robot = Description::new("pendulum").link("base", SpatialInertia::zero()).link("bob", bob).joint(pivot);
    robot.build().expect("sound")
}

/// The pendulum's rotational inertia about its pivot.
pub const INERTIA: f64 = 2.0 * 0.7 * 0.7;

/// Two uniform slender rods, 1 kg and 0.5 m each: `models/double_pendulum.urdf`.
pub fn double_pendulum() -> Model {
    let across = 0.25 / 12.0;
    let rod = SpatialInertia::new(1.0, Vec3([0.0, 0.0, -0.25]), Sym3::diagonal(across, across, 0.0));
    let elbow = SE3::translation([0.0, 0.0, -0.5]);
    let robot = Description::new("double_pendulum").link("base", SpatialInertia::zero()).link("rod1", rod);
    let robot = robot.link("rod2", rod).joint(Joint::new("joint1", "base", "rod1", SE3::identity(), swing()));
    robot.joint(Joint::new("joint2", "rod1", "rod2", elbow, swing())).build().expect("sound")
}

/// A random tree with damping and armature, without Coulomb friction.
pub fn smooth_tree(seed: u64, links: usize, mimics: usize) -> Model {
    let mut robot = testing::tree(seed, links, mimics).description().clone();
    robot.joints.iter_mut().for_each(|joint| joint.friction = 0.0);
    robot.build().expect("sound")
}

/// The largest |a − b|.
pub fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |m, (x, y)| m.max((x - y).abs()))
}
