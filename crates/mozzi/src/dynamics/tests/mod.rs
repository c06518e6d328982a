//! The kernels against the closed form, against each other, and against the identities of mechanics, on random trees.

mod derivatives;
mod mimics;
mod momentum;
mod numbers;
mod regressor;
mod rotors;
mod springs;
mod vjp;

use crate::model::{Environment, Model};
use crate::testing::{
    chain, floating_mixed_tree, floating_tree, grippers, mixed_tree, moving, state, tree, twist, wrench,
};
use crate::workspace::Workspace;
use crate::{Dual, Scalar, dynamics as kernel};
use nalgebra::{DMatrix, DVector};

const TREES: [(usize, usize); 7] = [(1, 0), (2, 0), (5, 0), (8, 2), (12, 0), (12, 4), (20, 0)];

pub fn models() -> impl Iterator<Item = (u64, Model)> {
    let mixed = [mixed_tree(72, 18, 2), floating_mixed_tree(73, 17, 0)];
    let deep = [tree(70, 20, 0), floating_tree(71, 18, 3), floating_tree(74, 23, 0)].into_iter().chain(mixed);
    let deep = (70..).zip(deep.map(|model| chain(&model)));
    let hands = [tree(80, 12, 0), floating_tree(81, 14, 0), mixed_tree(82, 16, 0)].map(|model| grippers(&model));
    deep.chain(trees()).chain((80..).zip(hands))
}

fn trees() -> impl Iterator<Item = (u64, Model)> {
    TREES.iter().enumerate().flat_map(|(k, &(links, mimics))| {
        (0..6).map(move |s| {
            let make = match s {
                1 | 4 => mixed_tree,
                2 => floating_tree,
                5 => floating_mixed_tree,
                _ => tree,
            };
            (10 * k as u64 + s, make(10 * k as u64 + s, links, mimics))
        })
    })
}

/// |a − b| over ε times the size of the terms.
#[track_caller]
pub fn close(a: &DMatrix<f64>, b: &DMatrix<f64>, scale: f64, bound: f64, what: &str) {
    let error = (a - b).amax() / (f64::EPSILON * scale.max(a.amax()).max(b.amax()));
    assert!(error < bound, "{what}: normalised error {error}");
}
pub fn column(v: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_column_slice(v.len(), 1, v.as_slice())
}

#[test]
fn the_kernels_equal_the_closed_form() {
    for (seed, model) in models() {
        let [theta, dtheta, ddtheta] = state(&model, seed);
        let tip = model.end_effector().expect("named");
        let at_rest = model.environment();
        let form = model.closed_form(&theta, &dtheta, &at_rest).expect("lengths");
        let M = model.mass_matrix(&theta).expect("lengths");
        close(&M, &form.mass_matrix(), 0.0, 300.0, "M");
        let c = column(&model.velocity_product(&theta, &dtheta).expect("lengths"));
        let C = model.coriolis_matrix(&theta, &dtheta).expect("lengths");
        let scale = M.amax() * dtheta.iter().fold(1.0_f64, |m, x| m.max(x * x));
        close(&c, &column(&form.velocity_product()), scale, 300.0, "c");
        close(&C, &form.coriolis_matrix(), scale, 1000.0, "C");
        close(
            &model.mass_matrix_rate(&theta, &dtheta).expect("lengths"),
            &form.mass_matrix_rate(),
            scale,
            1000.0,
            "dM",
        );
        close(
            &column(&model.gravity_forces(&theta).expect("lengths")),
            &column(&form.gravity_forces()),
            0.0,
            300.0,
            "g",
        );

        // all at once: a moving base, wrenches on two frames, friction and armature
        let other = model.frame("link1").expect("a link");
        let applied = [(tip, wrench(seed)), (other, wrench(seed + 1) * 10.0)];
        let everything =
            Environment { base_twist: twist(seed), base_acceleration: twist(seed + 1), applied: &applied, ..at_rest };
        let form = model.closed_form(&theta, &dtheta, &everything).expect("lengths");
        let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &everything).expect("lengths");
        close(
            &column(&tau),
            &column(&form.inverse_dynamics(&DVector::from_column_slice(&ddtheta))),
            0.0,
            1000.0,
            "tau",
        );
        let h = model.bias_forces(&theta, &dtheta, &everything).expect("lengths");
        let terms = [form.velocity_product(), form.gravity_forces(), form.tip_forces()];
        let size = terms.iter().map(DVector::amax).fold(0.0, f64::max);
        close(&column(&h), &column(&terms.into_iter().sum()), size, 1000.0, "h = c + g + JᵀF");
        close(
            &column(&model.tip_forces(&theta, &applied).expect("lengths")),
            &column(&form.tip_forces()),
            0.0,
            300.0,
            "JᵀF",
        );
    }
}

#[test]
fn w_is_nilpotent_and_l_its_geometric_sum() {
    let model = tree(5, 8, 0);
    let [theta, dtheta, _] = state(&model, 5);
    let form = model.closed_form(&theta, &dtheta, &model.environment()).expect("lengths");
    let one = DMatrix::identity(form.W.nrows(), form.W.ncols());
    close(&((&one - &form.W) * &form.L), &one, form.L.amax(), 100.0, "(I − W)L");
    let power = (0..8).fold(one, |power, _| power * &form.W);
    assert_eq!(power.amax(), 0.0);
}

#[test]
fn three_forward_dynamics_invert_inverse_dynamics() {
    for (seed, model) in models() {
        let [theta, dtheta, ddtheta] = state(&model, seed);
        let tip = model.end_effector().expect("named");
        let environment =
            Environment { base_twist: twist(seed), applied: &[(tip, wrench(seed))], ..model.environment() };
        let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment).expect("lengths");
        let M = model.mass_matrix(&theta).expect("lengths");
        for (what, found) in [
            ("default", model.forward_dynamics(&theta, &dtheta, tau.as_slice(), &environment)),
            ("mass matrix", model.forward_dynamics_by_mass_matrix(&theta, &dtheta, tau.as_slice(), &environment)),
            ("n calls", model.forward_dynamics_by_inverse_dynamics(&theta, &dtheta, tau.as_slice(), &environment)),
        ] {
            // backward error: M θ̈ against τ
            let found = found.expect("a regular mass matrix");
            let again = model.inverse_dynamics(&theta, &dtheta, found.as_slice(), &environment).expect("lengths");
            close(&column(&again), &column(&tau), M.amax() * found.amax(), 1000.0, what);
        }
    }
}

#[test]
fn identities_of_the_coriolis_matrix() {
    for (seed, model) in models() {
        let [theta, dtheta, _] = state(&model, seed);
        let C = model.coriolis_matrix(&theta, &dtheta).expect("lengths");
        let c = model.velocity_product(&theta, &dtheta).expect("lengths");
        let scale =
            model.mass_matrix(&theta).expect("lengths").amax() * dtheta.iter().fold(1.0_f64, |m, x| m.max(x * x));
        close(&column(&(&C * DVector::from_column_slice(&dtheta))), &column(&c), scale, 1000.0, "Cθ̇ = c");
        let dM = model.mass_matrix_rate(&theta, &dtheta).expect("lengths");
        let skew = &dM - &C * 2.0;
        close(&(-skew.transpose()), &skew, (C.amax() * 2.0).max(f64::MIN_POSITIVE), 30.0, "Ṁ − 2C skew"); // of the sum of two terms of C
        // Ṁ against dual numbers
        let moving = moving(&model, &theta, &dtheta);
        let (n, dual) = (model.n(), model.map(Dual::constant));
        let mut M = alloc::vec![Dual::zero(); n * n];
        kernel::mass_matrix(&dual, &moving, &mut Workspace::new(&dual), &mut M);
        close(&DMatrix::from_fn(n, n, |i, j| M[i * n + j].derivative), &dM, scale, 1000.0, "Ṁ");
        if !model.configuration_space().is_flat() {
            continue; // a twist is not a rate of coordinates
        }
        // and C against the Christoffel symbols Γ_ijk = ½(∂M_ij/∂θ_k + ∂M_ik/∂θ_j − ∂M_jk/∂θ_i), by dual numbers
        let dM_by: alloc::vec::Vec<DMatrix<f64>> = (0..n)
            .map(|k| {
                let theta: alloc::vec::Vec<Dual> = theta
                    .iter()
                    .enumerate()
                    .map(|(i, &value)| Dual { value, derivative: f64::from(u8::from(i == k)) })
                    .collect();
                kernel::mass_matrix(&model, &theta, &mut Workspace::new(&model), &mut M);
                DMatrix::from_fn(n, n, |i, j| M[i * n + j].derivative)
            })
            .collect();
        let christoffel = DMatrix::from_fn(n, n, |i, j| {
            (0..n).map(|k| 0.5 * (dM_by[k][(i, j)] + dM_by[j][(i, k)] - dM_by[i][(j, k)]) * dtheta[k]).sum()
        });
        close(&christoffel, &C, scale, 1000.0, "Christoffel");
    }
}

#[test]
fn energies_and_power() {
    for (seed, model) in models() {
        let [theta, dtheta, ddtheta] = state(&model, seed);
        let M = model.mass_matrix(&theta).expect("lengths");
        let rates = DVector::from_column_slice(&dtheta);
        let kinetic = model.kinetic_energy(&theta, &dtheta).expect("lengths");
        assert!((kinetic / (0.5 * rates.dot(&(&M * &rates))) - 1.0).abs() < 1e-12);
        // dE/dt = θ̇ᵀ(τ − f(θ̇)) − 𝒱ᵀF_tip, the left side by dual numbers
        let dual = |x: &[f64], dx: &[f64]| -> alloc::vec::Vec<Dual> {
            x.iter().zip(dx).map(|(&value, &derivative)| Dual { value, derivative }).collect()
        };
        let mut workspace = Workspace::new(&model);
        let (q, dq) = (moving(&model, &theta, &dtheta), dual(&dtheta, &ddtheta));
        let energy = kernel::kinetic_energy(&model, &q, &dq, crate::Twist::zero(), &mut workspace)
            + kernel::potential_energy(&model, &q, model.gravity().map(Dual::constant), &mut workspace);
        let tip = model.end_effector().expect("named");
        let F = wrench(seed) * 5.0;
        let environment = Environment { applied: &[(tip, F)], ..model.environment() };
        let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment).expect("lengths");
        let V = &model.body_jacobian(&theta, tip).expect("lengths") * &dtheta[..];
        let friction: f64 =
            (0..model.n()).map(|j| super::joint_friction::joint_friction(&model, j, dtheta[j]) * dtheta[j]).sum();
        let power = rates.dot(&tau) - friction - V.dot(F);
        let scale = rates.amax() * tau.amax() * rates.len() as f64;
        assert!((energy.derivative - power).abs() < 1e-12 * scale, "{} {power}", energy.derivative);
        // g + k(θ − θ₀) is the gradient of the potential energy
        let g = model.gravity_forces(&theta).expect("lengths") + model.spring_forces(&theta).expect("lengths");
        let along: f64 = rates.dot(&g);
        let slope =
            kernel::potential_energy(&model, &q, model.gravity().map(Dual::constant), &mut workspace).derivative;
        assert!((along - slope).abs() < 1e-12 * g.amax() * rates.amax() * rates.len() as f64);
    }
}

#[test]
fn a_hanging_weight_pulls_as_its_wrench_does() {
    use crate::{Mat3, Vec3};
    // a weight glued to the tip, against the wrench that the robot must apply to hold it
    let model = tree(2, 5, 0);
    let [theta, _, _] = state(&model, 2);
    let zero = alloc::vec![0.0; model.n()];
    let tip = model.end_effector().expect("named");
    let (mass, gravity) = (3.0, model.gravity());
    let R: Mat3 = model.forward_kinematics(&theta, tip).expect("lengths").R.matrix();
    let weight = crate::Wrench { m: Vec3::zero(), f: R.transpose_mul(gravity * -mass) }; // holds it up, in tip coordinates
    let held = Environment { applied: &[(tip, weight)], ..model.environment() };
    let by_wrench = model.inverse_dynamics(&theta, &zero, &zero, &held).expect("lengths");
    let glued = model.with_payload(tip, crate::SpatialInertia::point_mass(mass, Vec3::zero())).expect("a frame");
    let by_mass = glued.inverse_dynamics(&theta, &zero, &zero, &glued.environment()).expect("lengths");
    close(&column(&by_wrench), &column(&by_mass), 0.0, 100.0, "weight");
}

#[test]
fn the_mass_matrix_is_the_sum_over_links_of_jacobians_and_inertias() {
    // M = Σ J_ibᵀ 𝒢_i J_ib + armature, with the kernels' body Jacobians of the centre-of-mass frames
    for (seed, model) in models() {
        let [theta, _, _] = state(&model, seed);
        let mut sum = DMatrix::from_diagonal(&DVector::from_column_slice(&model.armature));
        for rotor in &model.description().rotors {
            // its rate by each velocity, through the joints' own rates
            let mut J = DVector::<f64>::zeros(model.n());
            for gear in &rotor.gears {
                let source = model.source_of(&gear.joint).expect("it moves");
                J[model.places()[source.joint].j] += gear.ratio * source.ratio;
            }
            sum += &J * J.transpose() * rotor.armature;
        }
        let base = model.is_floating().then_some((0, "link0"));
        let moving = model.moving_slots().zip(model.moving_joints().map(|joint| joint.child.as_str()));
        for (slot, name) in base.into_iter().chain(moving) {
            let G = if slot == 0 { model.base_inertia } else { model.body_inertia(slot) };
            let link = model.frame(name).expect("a link");
            let T = model.link_frame(slot).inverse() * model.body_frame(slot);
            let J = model.with_frame("{i}", link, T).expect("a new name");
            let J = J.body_jacobian(&theta, J.frame("{i}").expect("just added")).expect("lengths").matrix();
            let G = DMatrix::from_row_slice(6, 6, G.to_matrix().as_flattened());
            sum += J.transpose() * G * &J;
        }
        close(&model.mass_matrix(&theta).expect("lengths"), &sum, 0.0, 300.0, "Σ JᵀGJ");
    }
}
