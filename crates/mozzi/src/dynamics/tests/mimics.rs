//! Forward dynamics of joints and their mimic joints on the same link, by articulated bodies.

use super::{close, column};
use crate::dynamics as kernel;
use crate::model::Environment;
use crate::model::description::Mimic;
use crate::testing::{floating_tree, grippers, mixed_tree, state, tree, wrench};
use crate::workspace::Workspace;
use alloc::vec;
use nalgebra::DVector;

#[test]
fn articulated_bodies_answer_as_the_mass_matrix_does() {
    let mut followers = 0;
    for seed in 0..8 {
        for (tree, gap) in [(tree(seed, 14, 0), 0), (floating_tree(seed, 15, 0), 1), (mixed_tree(seed, 16, 0), 2)] {
            let model = grippers(&tree);
            assert!(!model.solves_by_mass_matrix());
            followers += tree.n() - model.n();
            let [theta, dtheta, tau] = state(&model, seed + gap);
            let frame = model.frames().last().expect("a frame").0;
            let applied = [(frame, wrench(seed))];
            let environment = Environment { applied: &applied, ..model.environment() };
            let (n, mut w) = (model.n(), Workspace::new(&model));
            let [mut by_bodies, mut by_matrix] = [vec![0.0; n], vec![0.0; n]];
            kernel::forward_dynamics(&model, &theta, &dtheta, &tau, &environment, &mut w, &mut by_bodies);
            let [mut M, mut again] = [vec![0.0; n * n], vec![0.0; n]];
            let matrix = kernel::forward_dynamics_by_mass_matrix;
            matrix(&model, &theta, &dtheta, &tau, &environment, &mut w, &mut M, &mut by_matrix);
            kernel::inverse_dynamics(&model, &theta, &dtheta, &by_bodies, &environment, &mut w, &mut again);
            let columns = [&by_bodies, &by_matrix, &again, &tau].map(|x| column(&DVector::from_column_slice(x)));
            let [by_bodies, by_matrix, again, tau] = &columns;
            close(by_bodies, by_matrix, by_matrix.amax(), 1e6, "θ̈");
            close(again, tau, tau.amax() + by_bodies.amax(), 1e6, "τ");
        }
    }
    assert!(followers > 40, "{followers} mimic joints");
}

#[test]
fn a_mimic_joint_on_another_link_needs_the_mass_matrix() {
    let phalanges = |parent: &str| {
        let mut robot = tree(3, 3, 0).description().clone();
        for (joint, parent) in
            robot.joints.iter_mut().filter(|joint| joint.name != "weld2").zip(["link0", "link1", parent])
        {
            joint.parent = parent.into();
        }
        let last = robot.joints.iter_mut().find(|joint| joint.name == "joint3").expect("three");
        last.mimic = Some(Mimic { joint: "joint2".into(), ratio: 0.7, offset: 0.1 });
        robot.build().expect("sound")
    };
    assert!(phalanges("link2").solves_by_mass_matrix());
    assert!(!phalanges("link1").solves_by_mass_matrix());
}
