//! Energy goes to and fro between joints and their springs.

use crate::{GravityCompensation, Method, Options, Zero, simulate};
use mozzi::model::description::{Joint, JointKind, Mimic};
use mozzi::{Description, Model, SE3, ScrewAxis, SpatialInertia, Sym3, Vec3, testing};

/// A point mass of 2 kg at 0.5 m that turns about z without gravity, on a spring. A prismatic mimic joint carries 3 kg
/// and has a spring of its own.
fn springs() -> Model {
    let turn = JointKind::Screw(ScrewAxis::new([0.0, 0.0, 1.0], [0.0; 3]).expect("unit"));
    let slide = JointKind::Screw(ScrewAxis::new([0.0; 3], [0.0, 0.0, 1.0]).expect("unit"));
    let spring =
        Joint { stiffness: 7.0, spring_reference: 0.4, ..Joint::new("turn", "base", "a", SE3::identity(), turn) };
    let mimic = Some(Mimic { joint: "turn".into(), ratio: -2.0, offset: 0.1 });
    let follower = Joint {
        stiffness: 5.0,
        spring_reference: -0.3,
        mimic,
        ..Joint::new("slide", "base", "b", SE3::identity(), slide)
    };
    Description::new("springs")
        .with_gravity([0.0; 3])
        .link("base", SpatialInertia::zero())
        .link("a", SpatialInertia::point_mass(2.0, Vec3([0.5, 0.0, 0.0])))
        .link("b", SpatialInertia::point_mass(3.0, Vec3::zero()))
        .joint(spring)
        .joint(follower)
        .build()
        .expect("sound")
}

#[test]
fn a_mass_on_a_spring_oscillates_at_its_frequency() {
    let model = springs();
    // M = m r² + ratio² m, K = k + ratio² k, rest at p / K
    let (M, K, p) = (0.5 + 12.0, 27.0_f64, 7.0 * 0.4 + 2.0 * 5.0 * 0.4);
    let (rest, omega) = (p / K, (K / M).sqrt());
    let options = Options { method: Method::RungeKutta4, ..Options::new(2.0, 2000) };
    let motion = simulate(&model, &[1.0], &[0.0], Zero, &options).expect("a motion");
    let expected = rest + (1.0 - rest) * (2.0 * omega).cos();
    assert!((motion.last().theta[0] - expected).abs() < 1e-11, "{:?} {expected}", motion.last());
    assert!(motion.largest_drift() < 1e-11, "{}", motion.largest_drift());
    let held = simulate(&model, &[1.0], &[0.0], GravityCompensation::new(&model), &options).expect("a motion");
    assert!((held.last().theta[0] - 1.0).abs() < 1e-12);
}

/// A body on a ball with a spring, and nothing else.
fn sprung_ball() -> Model {
    let joint =
        Joint { stiffness: 3.0, ..Joint::new("hip", "base", "body", SE3::identity(), JointKind::Ball(Vec3::zero())) };
    Description::new("ball")
        .with_gravity([0.0; 3])
        .link("base", SpatialInertia::zero())
        .link("body", SpatialInertia { mass: 1.0, mc: Vec3::zero(), I: Sym3::diagonal(0.2, 0.3, 0.4) })
        .joint(joint)
        .build()
        .expect("sound")
}

#[test]
fn energy_goes_to_and_fro_between_a_ball_and_its_spring() {
    let model = sprung_ball();
    let (theta, dtheta) = ([0.9, 0.3, -0.1, 0.3], [0.4, 0.2, -0.5]);
    let length = theta.iter().map(|x: &f64| x * x).sum::<f64>().sqrt();
    let options = Options { method: Method::RungeKutta4, ..Options::new(5.0, 5000) };
    let motion = simulate(&model, &theta.map(|x| x / length), &dtheta, Zero, &options).expect("a motion");
    assert!(motion.largest_drift() < 1e-11, "{}", motion.largest_drift());
}

#[test]
fn a_free_joint_with_armature_keeps_its_energy() {
    let joint = Joint { armature: 0.8, ..Joint::new("free", "world", "body", SE3::identity(), JointKind::Free) };
    let robot = Description::new("free").with_gravity([0.0; 3]).link("world", SpatialInertia::zero());
    let model = robot.link("body", testing::inertia(5)).joint(joint).build().expect("sound");
    let [theta, dtheta, _] = testing::state(&model, 2);
    let options = Options { method: Method::RungeKutta4, ..Options::new(1.0, 1000) };
    let motion = simulate(&model, &theta, &dtheta, Zero, &options).expect("a motion");
    assert!(motion.largest_drift() < 1e-9, "{}", motion.largest_drift());
}
