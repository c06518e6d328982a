//! Wrong input gets an error that names the table or the state.

use mozzi::model::description::{Joint, JointKind};
use mozzi::quantities::{ForwardDynamics, ForwardKinematics, InverseDynamics, MassMatrix, Query};
use mozzi::testing::{floating_tree, mixed_tree, tree};
use mozzi::{Description, Freedom, SE3, ScrewAxis, Solid, SpatialInertia};
use mozzi_engine::{Batch, Error, Shape};

use crate::ways::ways;

fn text(result: Result<(), Error>) -> String {
    result.expect_err("wrong on purpose").to_string()
}

#[test]
fn lengths() {
    let model = tree(1, 7, 0);
    let (batch, s) = (Batch::new(&model), model.environment().into());
    let (x, mut tau, mut M) = (vec![0.0; 21], vec![0.0; 21], vec![0.0; 21]);
    let mut tau_of = |theta, ddtheta| batch.compute(InverseDynamics, &[theta, &x, ddtheta], &s, &mut [&mut tau]);
    assert_eq!(text(tau_of(&x[..20], &x)), "theta has 20 numbers, expected a multiple of 7: 7 numbers a state");
    assert_eq!(text(tau_of(&x, &x[..14])), "ddtheta has 14 numbers, expected 21 (3 states of 7)");
    let mut M_of = |batch: &Batch| batch.compute(MassMatrix, &[&x], &s, &mut [&mut M]);
    assert_eq!(text(M_of(&batch)), "M has 21 numbers, expected 147 (3 states of 49)");
    // zero states give no error
    batch.compute(InverseDynamics, &[&[], &[], &[]], &s, &mut [&mut []]).unwrap();
}

#[test]
fn a_state_by_its_number() {
    let model = floating_tree(2, 4, 0);
    let batch = Batch::new(&model);
    let mut theta: Vec<f64> = model.neutral_configuration().repeat(30);
    theta[17 * model.nq()] = 0.9;
    let mut M = vec![0.0; 30 * model.n() * model.n()];
    let mut M_of = |theta: &[f64]| batch.compute(MassMatrix, &[theta], &model.environment().into(), &mut [&mut M]);
    let found = text(M_of(&theta));
    assert!(found.starts_with("state 17 (counted from 0): the base's orientation in theta is [0.9, "), "{found}");
    theta[17 * model.nq()] = f64::NAN; // NaN gives no error, as at one state
    M_of(&theta).unwrap();
}

#[test]
fn a_balls_orientation() {
    let model = mixed_tree(2, 8, 0);
    let ball = model.places().iter().find(|place| place.freedom != Freedom::One).expect("a ball or a free joint").q;
    let mut theta: Vec<f64> = model.neutral_configuration().repeat(9);
    theta[5 * model.nq() + ball] = 1.1;
    let mut M = vec![0.0; 9 * model.n() * model.n()];
    let found = text(Batch::new(&model).compute(MassMatrix, &[&theta], &model.environment().into(), &mut [&mut M]));
    assert!(found.starts_with("state 5 (counted from 0): a joint's orientation in theta is [1.1, "), "{found}");
}

#[test]
fn a_singular_state_names_its_joint() {
    // two coaxial joints with a massless link between them: singular everywhere
    let axis = ScrewAxis::from_line([0.0, 0.0, 1.0], [0.0; 3], 0.0).unwrap();
    let joint = |name: &str, parent: &str, child: &str| {
        Joint::new(name, parent, child, SE3::identity(), JointKind::Screw(axis))
    };
    let model = Description::new("two")
        .link("base", SpatialInertia::zero())
        .link("between", SpatialInertia::zero())
        .link("end", Solid::Box([1.0, 0.1, 0.1]).inertia(1.0))
        .joint(joint("first", "base", "between"))
        .joint(joint("second", "between", "end"))
        .build()
        .unwrap();
    for (_, batch) in ways::<f64>(&model, &[ForwardDynamics.into()]) {
        let (x, mut y) = (vec![0.1; 10], vec![0.0; 10]);
        let environment = model.environment().into();
        let found = text(batch.compute(ForwardDynamics, &[&x, &x, &x], &environment, &mut [&mut y]));
        assert!(found.starts_with("state 0 (counted from 0): the mass matrix is singular at joint `first`"), "{found}");
    }
}

#[test]
fn frames_threads_and_shapes() {
    let (small, large) = (tree(1, 2, 0), tree(2, 12, 0));
    let batch = Batch::new(&small);
    let tip = large.end_effector().unwrap();
    let (query, environment) = (Query::from(ForwardKinematics), small.environment().into());
    let T_of = |query| text(batch.compute(query, &[&[0.0; 2]], &environment, &mut [&mut [0.0; 16]]));
    let found = T_of(query.of(tip));
    assert!(found.starts_with("the frame is number "), "{found}");
    let found = T_of(query);
    assert!(found.starts_with("the frame is missing for forward_kinematics, expected "), "{found}");
    assert_eq!(
        batch.clone().with_threads(0).map(drop).expect_err("none").to_string(),
        "0 threads could not be started: expected at least one"
    );
    let found = text(batch.clone().with_shape(Shape::OneF64).map(drop));
    assert!(found.contains("for 1 states at once is not for these numbers, or not for this processor"), "{found}");
    assert!(Batch::<f32>::of(&small).with_shape(Shape::EightF64).is_err());
}
