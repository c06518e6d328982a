//! Wrong input gets an error that names the table or the state.

use mozzi::model::description::{Joint, JointKind};
use mozzi::testing::{floating_tree, tree};
use mozzi::{Description, SE3, ScrewAxis, Solid, SpatialInertia};
use mozzi_batch::{Batch, Error, InstructionSet, Layout};

fn text(result: Result<(), Error>) -> String {
    result.expect_err("wrong on purpose").to_string()
}

#[test]
fn lengths() {
    let model = tree(1, 7, 0);
    let (batch, s) = (Batch::<f64>::new(&model), model.environment().into());
    let (x, mut tau) = (vec![0.0; 21], vec![0.0; 21]);
    assert_eq!(
        text(batch.inverse_dynamics(&x[..20], &x, &x, &s, &mut tau)),
        "theta has 20 numbers, expected a multiple of 7: 7 positions a state"
    );
    assert_eq!(
        text(batch.inverse_dynamics(&x, &x, &x[..14], &s, &mut tau)),
        "ddtheta has 14 numbers, expected 21 (3 states of 7)"
    );
    assert_eq!(text(batch.mass_matrix(&x, &mut tau)), "M has 21 numbers, expected 147 (3 states of 49)");
    let blocks = batch.clone().with_layout(Layout::Blocks);
    if blocks.lanes() > 1 {
        let expected = format!(
            "theta has 21 numbers, expected a multiple of 7: 7 positions a state, in whole blocks of {} states",
            blocks.lanes()
        );
        assert_eq!(text(blocks.mass_matrix(&x, &mut tau)), expected);
    }
    // no state is no error
    batch.inverse_dynamics(&[], &[], &[], &s, &mut []).unwrap();
}

#[test]
fn a_state_by_its_number() {
    let model = floating_tree(2, 4, 0);
    let batch = Batch::<f64>::new(&model);
    let mut theta: Vec<f64> = model.neutral_configuration().repeat(30);
    theta[17 * model.nq()] = 0.9;
    let mut M = vec![0.0; 30 * model.n() * model.n()];
    let found = text(batch.mass_matrix(&theta, &mut M));
    assert!(found.starts_with("state 17 (counted from 0): the base's orientation in theta is [0.9, "), "{found}");
    theta[17 * model.nq()] = f64::NAN; // no number is no error, as at one state
    batch.mass_matrix(&theta, &mut M).unwrap();
}

#[test]
fn a_singular_state_names_its_joint() {
    // two coaxial joints, the link between without inertia: singular everywhere
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
    for set in InstructionSet::available() {
        let batch = Batch::<f64>::new(&model).with_instruction_set(set).unwrap();
        let (x, mut y) = (vec![0.1; 10], vec![0.0; 10]);
        let found = text(batch.forward_dynamics(&x, &x, &x, &model.environment().into(), &mut y));
        assert!(found.starts_with("state 0 (counted from 0): the mass matrix is singular at joint `first`"), "{found}");
    }
}

#[test]
fn frames_threads_and_registers() {
    let (small, large) = (tree(1, 2, 0), tree(2, 12, 0));
    let batch = Batch::<f64>::new(&small);
    let tip = large.end_effector().unwrap();
    let found = text(batch.forward_kinematics(tip, &[0.0; 2], &mut [0.0; 16]));
    assert!(found.starts_with("the frame is number "), "{found}");
    assert_eq!(
        batch.clone().with_threads(0).map(drop).expect_err("none").to_string(),
        "0 threads could not be started: expected at least one"
    );
    for set in [InstructionSet::Avx2, InstructionSet::Avx512] {
        if !set.is_available() {
            let found = text(batch.clone().with_instruction_set(set).map(drop));
            assert!(found.starts_with(&format!("this machine has no {}; it has portable", set.name())), "{found}");
        }
    }
}
