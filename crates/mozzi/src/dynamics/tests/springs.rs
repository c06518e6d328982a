//! Springs against hand calculation, with every algorithm for θ̈, and with mimic joints.

use crate::model::description::{Joint, JointKind, Mimic};
use crate::spatial::{ScrewAxis, SpatialInertia};
use crate::{Description, Model, SE3, Vec3};

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
fn a_mimic_joints_spring_acts_on_its_own_variable() {
    let (model, theta) = (springs(), 9.0); // beyond a turn: an angle is not wrapped
    let q = -2.0 * theta + 0.1;
    let force = 7.0 * (theta - 0.4) - 2.0 * 5.0 * (q + 0.3);
    let energy = 0.5 * 7.0 * (theta - 0.4_f64).powi(2) + 0.5 * 5.0 * (q + 0.3_f64).powi(2);
    let found = model.spring_forces(&[theta]).expect("lengths")[0];
    assert!((found - force).abs() < 1e-13 * force, "{found} {force}");
    let tau = model.inverse_dynamics(&[theta], &[0.0], &[0.0], &model.environment()).expect("lengths")[0];
    assert!((tau - force).abs() < 1e-13 * force, "{tau} {force}");
    let found = model.potential_energy(&[theta]).expect("lengths");
    assert!((found - energy).abs() < 1e-13 * energy, "{found} {energy}");
    let names = model.parameter_names();
    let of = |name: &str| model.parameters()[names.iter().position(|known| known == name).expect("a parameter")];
    assert!((of("turn.stiffness") - (7.0 + 4.0 * 5.0)).abs() < 1e-13);
    assert!((of("turn.preload") - (7.0 * 0.4 - 2.0 * 5.0 * -0.4)).abs() < 1e-13);
}

#[test]
fn a_derivative_by_the_stiffness_of_a_spring_that_is_none_is_kept() {
    use crate::{Dual, Scalar, Workspace};
    let mut robot = springs().description().map(Dual::constant);
    (robot.joints[0].stiffness, robot.joints[1].stiffness) = (Dual { value: 0.0, derivative: 1.0 }, Dual::zero());
    let (model, theta) = (robot.build().expect("sound"), [Dual::constant(0.9)]);
    let (mut tau, still) = ([Dual::zero()], [Dual::zero()]);
    super::kernel::inverse_dynamics(
        &model,
        &theta,
        &still,
        &still,
        &model.environment(),
        &mut Workspace::new(&model),
        &mut tau,
    );
    assert!((tau[0].derivative - (0.9 - 0.4)).abs() < 1e-15, "{tau:?}");
}

/// A body on a ball with a spring, and nothing else.
fn sprung_ball() -> Model {
    let joint =
        Joint { stiffness: 3.0, ..Joint::new("hip", "base", "body", SE3::identity(), JointKind::Ball(Vec3::zero())) };
    Description::new("ball")
        .with_gravity([0.0; 3])
        .link("base", SpatialInertia::zero())
        .link("body", SpatialInertia { mass: 1.0, mc: Vec3::zero(), I: crate::Sym3::diagonal(0.2, 0.3, 0.4) })
        .joint(joint)
        .build()
        .expect("sound")
}

#[test]
fn a_balls_spring_turns_it_back_the_shorter_way() {
    let model = sprung_ball();
    for (angle, torque) in [(0.0, 0.0), (0.5, 1.5), (3.0, 9.0), (4.0, 3.0 * (4.0 - core::f64::consts::TAU))] {
        let (s, c) = (0.5_f64 * angle).sin_cos();
        let theta = [c, 0.0, 0.6 * s, 0.8 * s];
        let f = model.spring_forces(&theta).expect("lengths");
        for (k, axis) in [0.0, 0.6, 0.8].into_iter().enumerate() {
            assert!((f[k] - torque * axis).abs() < 1e-14, "{angle}: {f}");
        }
        let energy = model.potential_energy(&theta).expect("lengths");
        assert!((energy - torque * torque / 6.0).abs() < 1e-14, "{angle}: {energy}");
    }
}

#[test]
fn wrong_springs_are_errors_by_name() {
    let mut robot = sprung_ball().description().clone();
    robot.joints[0].spring_reference = 0.1;
    let text = robot.clone().build().expect_err("no angle").to_string();
    assert!(text.contains("joint `hip`: spring reference: is 0.1 of a ball, expected 0"), "{text}");
    (robot.joints[0].kind, robot.joints[0].spring_reference) = (JointKind::Free, 0.0);
    let text = robot.build().expect_err("no such spring").to_string();
    assert!(text.contains("joint `hip`: stiffness: is 3 of a free joint, expected 0"), "{text}");

    let message = |stiffness: f64, spring_reference: f64| {
        let mut robot = springs().description().clone();
        (robot.joints[0].stiffness, robot.joints[0].spring_reference) = (stiffness, spring_reference);
        robot.build().expect_err("a wrong spring").to_string()
    };
    assert!(
        message(-1.0, 0.0).contains("joint `turn`: stiffness: is -1, expected a finite number, at least 0"),
        "{}",
        message(-1.0, 0.0)
    );
    assert!(message(f64::NAN, 0.0).contains("stiffness: is NaN"));
    assert!(message(1.0, f64::INFINITY).contains("spring reference: is inf, expected a finite number"));
}
