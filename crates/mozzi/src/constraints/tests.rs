//! A against dual numbers of φ and of A θ̇; θ̈, λ, P and the impulse against a dense solution.

use super::*;
use crate::model::description::{Closure, Constraint, ConstraintKind, Gear, Joint, JointKind};
use crate::model::{Environment, Model};
use crate::scalar::Dual;
use crate::testing::{closed, floating_mixed_tree, four_bar, mixed_tree, state, tree, wrench};
use crate::workspace::Workspace;
use crate::{SE3, ScrewAxis, Solid, Vec3, quantities};
use alloc::format;
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

const ALL: [Closure; 5] =
    [Closure::Point, Closure::Distance(0.7), Closure::Rolling(0.3), Closure::Hinge, Closure::Weld];

/// Robots of every kind with some constraints, and the θ at which they hold.
fn robots() -> Vec<(Model, [Vec<f64>; 3])> {
    let mut found = Vec::new();
    for seed in 0..12 {
        let model = match seed % 3 {
            0 => tree(seed, 9, 0),
            1 => mixed_tree(seed, 8, 2),
            _ => floating_mixed_tree(seed, 7, 1),
        };
        let state = state(&model, seed);
        let start = seed as usize % 5;
        let closures = [ALL[start], ALL[(start + 2) % 5]];
        let mut model = closed(&model, &state[0], &closures, seed);
        if seed % 2 == 0 {
            let names: Vec<&str> =
                model.joints().filter(|joint| joint.kind.name() == "revolute").map(|j| &*j.name).collect();
            if let [a, b, ref more @ ..] = names[..] {
                let at = |name: &str| {
                    let place = model.places()[model.joint_names().position(|known| known == name).expect("there")];
                    state[0][place.q]
                };
                // sums of two joints' positions, where there are as many
                let gears = |first: &str, ratio: f64, second: Option<&&str>| {
                    let second = second.map(|&joint| Gear { joint: joint.into(), ratio });
                    [Gear { joint: first.into(), ratio: 1.0 }].into_iter().chain(second).collect::<Vec<_>>()
                };
                let (joints, source) = (gears(a, -0.6, more.first()), gears(b, 1.7, more.get(1)));
                let [y, x] =
                    [&joints, &source].map(|sum| sum.iter().map(|gear| gear.ratio * at(&gear.joint)).sum::<f64>());
                let [c1, c2, c3, c4] = [0.7, -0.3, 0.2, 0.1];
                let c0 = y - x * (c1 + x * (c2 + x * (c3 + x * c4)));
                let kind = ConstraintKind::Joint { joints, source, polynomial: [c0, c1, c2, c3, c4] };
                let joint = Constraint { name: "cam".into(), kind };
                model = model.with_constraints([joint]).expect("joints");
            }
        }
        found.push((model, state));
    }
    found
}

/// (A, Ȧθ̇, φ).
fn found(model: &Model, theta: &[f64], dtheta: &[f64]) -> (DMatrix<f64>, DVector<f64>, DVector<f64>) {
    let (m, n) = (model.constraint_rows(), model.n());
    let (mut A, mut bias, mut phi) = (vec![f64::NAN; m * n], vec![f64::NAN; m], vec![f64::NAN; m]);
    let mut workspace = Workspace::new(model);
    workspace.fill_nan();
    constraint_jacobian(model, theta, dtheta, &mut workspace, &mut A, &mut bias, &mut phi);
    (DMatrix::from_row_slice(m, n, &A), DVector::from_vec(bias), DVector::from_vec(phi))
}

#[test]
fn A_is_the_derivative_of_the_residual_and_its_rate_that_of_the_velocities() {
    for (model, [theta, dtheta, _]) in robots() {
        let (A, bias, phi) = found(&model, &theta, &dtheta);
        let (m, n) = A.shape();
        assert!(phi.amax() < 1e-13, "closed at θ: {phi}");
        // φ and Aθ̇ along θ̇
        let (phi, velocities) = model
            .directional_derivative(&theta, &dtheta, |moving| {
                let rates = Dual::constants(&dtheta);
                let (mut A, mut phi) = (Dual::constants(&vec![0.0; m * n]), Dual::constants(&vec![0.0; m]));
                let mut workspace = Workspace::new(&model);
                constraint_jacobian(&model, moving, &rates, &mut workspace, &mut A, &mut [], &mut phi);
                let velocities: Vec<f64> =
                    (0..m).map(|r| (0..n).map(|j| (A[r * n + j] * rates[j]).derivative).sum()).collect();
                (phi.iter().map(|x| x.derivative).collect::<Vec<_>>(), velocities)
            })
            .expect("lengths");
        let (V, size) = (&A * DVector::from_column_slice(&dtheta), 1.0 + bias.amax());
        for (r, name) in model.constraint_row_names().enumerate() {
            let kind = model.constraints().iter().find(|one| name.starts_with(&*one.name)).expect("of one").kind_name();
            assert!((velocities[r] - bias[r]).abs() < 1e-12 * size, "{kind} {name}: {} {}", velocities[r], bias[r]);
            let is_pfaffian = kind == "rolling" && !name.ends_with("vz");
            let expected = if is_pfaffian { 0.0 } else { V[r] };
            assert!((phi[r] - expected).abs() < 1e-12 * (1.0 + V.amax()), "{kind} {name}: {} {expected}", phi[r]);
        }
    }
}

/// θ̈ and Aᵀλ from the system of equations, by singular values.
fn dense(model: &Model, [theta, dtheta, tau]: [&[f64]; 3], environment: &Environment) -> (DVector<f64>, DVector<f64>) {
    let (A, bias, _) = found(model, theta, dtheta);
    let M = model.mass_matrix(theta).expect("lengths");
    let tree = model.forward_dynamics_by_mass_matrix(theta, dtheta, tau, environment).expect("regular");
    let M = M.cholesky().expect("positive");
    let G = &A * M.solve(&A.transpose());
    let lambda = G.svd(true, true).solve(&(&A * &tree + bias), 1e-9).expect("both");
    let force = A.transpose() * lambda;
    (tree - M.solve(&force), force)
}

#[test]
fn constrained_forward_dynamics_solves_the_equations() {
    for (k, (mut model, [theta, dtheta, tau])) in robots().into_iter().enumerate() {
        if k % 2 == 1 {
            // the same constraints again, so that rows are redundant
            let mut again = model.constraints()[0].clone();
            again.name = "again".into();
            model = model.with_constraints([again]).expect("sound");
        }
        let tip = model.end_effector().unwrap_or(model.frame("link1").expect("there"));
        let applied = [(tip, wrench(3))];
        let environment = Environment { applied: &applied, gravity: Vec3([1.0, 2.0, -9.0]), ..model.environment() };
        // velocities that the constraints allow
        let after = model.compute(quantities::ConstraintImpulse, &[&theta, &dtheta], &environment).expect("regular");
        let (dtheta, impulse) = (&after[0], &after[1]);
        let (A, bias, _) = found(&model, &theta, dtheta);
        let speed = (&A * DVector::from_column_slice(dtheta)).amax();
        assert!(speed < 1e-9, "Aθ̇⁺ = {speed}");
        assert_eq!(impulse.len(), model.constraint_rows());

        let (expected, force) = dense(&model, [&theta, dtheta, &tau], &environment);
        let found = model
            .compute(quantities::ConstrainedForwardDynamics, &[&theta, dtheta, &tau], &environment)
            .expect("regular");
        let (ddtheta, lambda) = (DVector::from_column_slice(&found[0]), DVector::from_column_slice(&found[1]));
        assert!((&ddtheta - &expected).amax() < 1e-7 * expected.amax(), "{ddtheta} {expected}");
        assert!((A.transpose() * &lambda - &force).amax() < 1e-7 * force.amax(), "{k}");
        assert!((&A * &ddtheta + &bias).amax() < 1e-7 * (1.0 + bias.amax() + ddtheta.amax()));
        // τ = inverse dynamics of θ̈ with Aᵀλ
        let inverse = model.inverse_dynamics(&theta, dtheta, ddtheta.as_slice(), &environment).expect("lengths");
        let tau = DVector::from_column_slice(&tau);
        assert!((inverse + A.transpose() * &lambda - &tau).amax() < 1e-9 * (tau.amax() + force.amax()));

        let n = model.n();
        let P = model.compute(quantities::ConstraintProjection, &[&theta], &environment).expect("regular").remove(0);
        let P = DMatrix::from_row_slice(n, n, &P);
        assert!((&P * &P - &P).amax() < 1e-7 * (1.0 + P.amax() * P.amax()), "a projection");
        assert!((&P * A.transpose()).amax() < 1e-7 * (1.0 + P.amax()) * A.amax(), "that removes Aᵀλ");
    }
}

#[test]
fn a_tree_has_no_constraint() {
    let model = tree(3, 5, 0);
    let [theta, dtheta, tau] = state(&model, 3);
    let environment = model.environment();
    let inputs: [&[f64]; 3] = [&theta, &dtheta, &tau];
    let found = model.compute(quantities::ConstrainedForwardDynamics, &inputs, &environment).expect("regular");
    let expected = model.forward_dynamics(&theta, &dtheta, &tau, &environment).expect("regular");
    assert!((DVector::from_column_slice(&found[0]) - &expected).amax() < 1e-11 * expected.amax());
    assert!(found[1].is_empty());
}

/// A cam of slope 10⁶ next to a loop of metres: every row is satisfied to its own size.
#[test]
fn rows_of_very_different_sizes_all_hold() {
    let tree = tree(3, 9, 0);
    let [theta, dtheta, tau] = state(&tree, 3);
    let loops = closed(&tree, &theta, &[Closure::Point, Closure::Distance(0.7)], 3);
    let names: Vec<&str> =
        loops.joints().filter(|joint| joint.kind.name() == "revolute").map(|joint| &*joint.name).collect();
    for slope in [1.0, 1e3, 1e6] {
        let cam = Constraint::joint("cam", names[0], names[1], [0.1, slope, -0.2 * slope, 0.0, 0.0]);
        let model = loops.with_constraints([cam]).expect("joints");
        let rank = model.constraint_rank(&theta).expect("lengths");
        assert_eq!((rank.rank, rank.rows), (5, 5), "slope {slope}: {:?}", rank.redundant);
        assert_satisfied(&model, [&theta, &dtheta, &tau], &format!("slope {slope}"), 0.0);
    }
}

/// Each row of Aθ̈ + Ȧθ̇ = 0 holds to its own size; one of rounding errors to `rounding`.
fn assert_satisfied(model: &Model, [theta, dtheta, tau]: [&[f64]; 3], what: &str, rounding: f64) {
    let moved = model.constrained_forward_dynamics(theta, dtheta, tau, &model.environment()).expect("regular");
    let (A, bias, _) = found(model, theta, dtheta);
    for r in 0..A.nrows() {
        let (mut sum, mut size) = (bias[r], bias[r].abs());
        for (a, x) in A.row(r).iter().zip(moved.ddtheta.iter()) {
            sum += a * x;
            size += (a * x).abs();
        }
        assert!(sum.abs() <= 1e-9 * size + rounding, "{what}, row {r}: {sum} of {size}");
    }
}

/// A rod that turns about its own axis on a bearing, as those of a delta robot do: this is much easier than moving its
/// ends, and no reason to let them go.
#[test]
fn a_thin_rod_in_a_loop_keeps_its_ends() {
    for thickness in [1e-2, 1e-3, 1e-5] {
        let mut robot = four_bar().description().clone();
        let coupler = robot.links.iter_mut().find(|link| link.name == "coupler").expect("a rod");
        coupler.inertia = Solid::Box([0.8, thickness, thickness]).inertia(0.8);
        let pivot = robot.joints.iter_mut().find(|joint| joint.name == "coupler_pivot").expect("a joint");
        pivot.child = "yoke".into();
        let axis = JointKind::Screw(ScrewAxis::new([1.0, 0.0, 0.0], [0.0; 3]).expect("unit"));
        let yoke = Solid::Box([0.02; 3]).inertia(0.01);
        let spin = Joint::new("spin", "yoke", "coupler", SE3::identity(), axis);
        let model = robot.link("yoke", yoke).joint(spin).build().expect("sound");
        let at = |name: &str| model.joint_names().position(|known| known == name).expect("a joint");
        let mut guess = vec![0.0; 4];
        for (name, x) in [("crank_pivot", 1.0), ("coupler_pivot", -0.6), ("rocker_pivot", 1.6)] {
            guess[at(name)] = x;
        }
        let theta = model.assemble(&guess, &["crank_pivot"]).expect("closes");
        let mut rates = vec![0.0; 4];
        rates[at("crank_pivot")] = 1.5;
        let dtheta = model.assemble_velocities(&theta, &rates, &["crank_pivot"]).expect("moves");
        let mut tau = vec![0.0; 4];
        tau[at("crank_pivot")] = 0.3;
        assert_satisfied(&model, [&theta, &dtheta, &tau], &format!("{thickness} m"), 1e-12);
    }
}
