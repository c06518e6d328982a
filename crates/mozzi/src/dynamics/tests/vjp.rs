//! The gradients of energies, momenta, frames and by the robot, against dual numbers of the quantities themselves.

use super::models;
use crate::kinematics::{body_jacobian, frame_acceleration};
use crate::model::{Environment, FrameId, Model, Variation};
use crate::testing::{Random, moving, state, twist, wrench};
use crate::workspace::Workspace;
use crate::{Dual, Twist, Vec3, Wrench, dynamics as kernel};
use alloc::format;
use alloc::vec::Vec;

/// The derivative of a number by the k-th of (θ, θ̇, θ̈), θ along the velocities.
fn gradient(model: &Model, state: &[Vec<f64>; 3], k: usize, of: impl Fn([&[Dual]; 3]) -> Dual) -> Vec<f64> {
    let along = |j: usize| {
        let mut e = alloc::vec![0.0; model.n()];
        e[j] = 1.0;
        let mut x = state.each_ref().map(|x| Dual::constants(x));
        match k {
            0 => x[0] = moving(model, &state[0], &e),
            _ => x[k][j].derivative = 1.0,
        }
        of(x.each_ref().map(Vec::as_slice)).derivative
    };
    (0..model.n()).map(along).collect()
}

/// The difference over ε times the largest entry.
#[track_caller]
fn equal(found: &[f64], expected: &[f64], scale: f64, what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let size = |x: &[f64]| x.iter().fold(scale, |most, x| most.max(x.abs()));
    let scale = f64::EPSILON * size(found).max(size(expected)).max(f64::MIN_POSITIVE);
    for (k, (found, expected)) in found.iter().zip(expected).enumerate() {
        let error = (found - expected).abs() / scale;
        assert!(error < 1000.0, "{what}, entry {k}: {found} {expected}, {error} units");
    }
}

fn power(w: Wrench, V: Twist<Dual>) -> Dual {
    V.dot(w.map(Dual::constant))
}

#[test]
fn of_motions_energies_and_momenta() {
    for (seed, model) in models() {
        let state = state(&model, seed);
        let [theta, dtheta, ddtheta] = state.each_ref().map(Vec::as_slice);
        let rates = dtheta.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
        let (tip, w) = (model.end_effector().expect("named"), wrench(seed));
        let memory = || Workspace::<Dual>::new(&model);
        let check = |k: usize, found: &[f64], of: &dyn Fn([&[Dual]; 3]) -> Dual, what: &str| {
            equal(found, &gradient(&model, &state, k, of), rates * rates, &format!("{what} {k}, {seed}"));
        };

        let velocity = |[theta, dtheta, _]: [&[Dual]; 3]| {
            let mut J = alloc::vec![Twist::zero(); model.n()];
            body_jacobian(&model, theta, tip, &mut J);
            power(w, J.iter().zip(dtheta).fold(Twist::zero(), |V, (&column, &rate)| V + column * rate))
        };
        for (k, found) in model.frame_twist_vjp(theta, dtheta, tip, w).expect("lengths").iter().enumerate() {
            check(k, found.as_slice(), &velocity, "the twist by");
        }
        let acceleration = |[a, b, c]: [&[Dual]; 3]| power(w, frame_acceleration(&model, a, b, c, tip));
        let found = model.frame_acceleration_vjp(theta, dtheta, ddtheta, tip, w).expect("lengths");
        for (k, found) in found.iter().enumerate() {
            check(k, found.as_slice(), &acceleration, "the acceleration by");
        }

        let (x, about) = (twist(seed), Vec3([0.3, -0.2, 0.9]));
        let of = |h: Wrench<Dual>| x.map(Dual::constant).dot(h.about(about.map(Dual::constant)));
        let momentum = |[a, b, _]: [&[Dual]; 3]| of(kernel::momentum(&model, a, b, &mut memory()));
        for (k, found) in model.momentum_vjp(theta, dtheta, about, x).expect("lengths").iter().enumerate() {
            check(k, found.as_slice(), &momentum, "the momentum by");
        }
        let rate = |[a, b, c]: [&[Dual]; 3]| of(kernel::momentum_rate(&model, a, b, c, &mut memory()));
        let found = model.momentum_rate_vjp(theta, dtheta, ddtheta, about, x).expect("lengths");
        for (k, found) in found.iter().enumerate() {
            check(k, found.as_slice(), &rate, "the momentum's rate by");
        }

        let V_s = twist(seed + 1);
        let environment = Environment { base_twist: V_s, ..model.environment() };
        let found = model.energy_gradients(theta, dtheta, &environment).expect("lengths");
        let V_s = V_s.map(Dual::constant);
        let kinetic = |[a, b, _]: [&[Dual]; 3]| kernel::kinetic_energy(&model, a, b, V_s, &mut memory());
        let gravity = model.gravity().map(Dual::constant);
        let potential = |[theta, ..]: [&[Dual]; 3]| kernel::potential_energy(&model, theta, gravity, &mut memory());
        check(0, found.kinetic_d_theta.as_slice(), &kinetic, "the kinetic energy by");
        check(1, found.kinetic_d_dtheta.as_slice(), &kinetic, "the kinetic energy by");
        check(0, found.potential_d_theta.as_slice(), &potential, "the potential energy by");

        let [by_theta, Mx] = model.mass_matrix_product_vjp(theta, ddtheta, dtheta).expect("lengths");
        let matrix = model.mass_matrix_product_derivative(theta, ddtheta).expect("lengths");
        let M = model.mass_matrix(theta).expect("lengths");
        let rates = nalgebra::DVector::from_column_slice(dtheta);
        equal(by_theta.as_slice(), matrix.tr_mul(&rates).as_slice(), matrix.amax() * rates.amax(), "xᵀ∂(Ma)");
        equal(Mx.as_slice(), (&M * &rates).as_slice(), M.amax() * rates.amax(), "Mx");
    }
}

/// xᵀτ and xᵀθ̈ on dual constants.
fn by_change(model: &Model, state: [&[f64]; 4], tau: &[f64], environment: &Environment, change: Variation) -> [f64; 2] {
    let moved = model.with_parameter_tangent(&[change]).expect("a known change");
    let mut applied: Vec<(FrameId, Wrench<Dual>)> = Vec::new();
    let environment = environment.map(Dual::constant, &mut applied);
    let [theta, dtheta, ddtheta, x] = state.map(Dual::constants);
    let (tau, mut found, mut w) = (Dual::constants(tau), ddtheta.clone(), Workspace::<Dual>::new(&moved));
    let dot = |found: &[Dual]| x.iter().zip(found).map(|(x, y)| x.value * y.derivative).sum();
    kernel::inverse_dynamics(&moved, &theta, &dtheta, &ddtheta, &environment, &mut w, &mut found);
    let of_tau = dot(&found);
    kernel::forward_dynamics(&moved, &theta, &dtheta, &tau, &environment, &mut w, &mut found);
    [of_tau, dot(&found)]
}

#[test]
fn by_the_robot() {
    for (seed, model) in models().step_by(2) {
        let [theta, dtheta, ddtheta] = state(&model, seed);
        let x = Random(seed + 5).vector(model.n(), 1.0);
        let tip = model.end_effector().expect("named");
        let applied = [(tip, wrench(seed)), (model.frame("link0").expect("a link"), wrench(seed + 1))];
        let (base_twist, base_acceleration) = (twist(seed), twist(seed + 1));
        let environment = Environment { base_twist, base_acceleration, applied: &applied, ..model.environment() };
        let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment).expect("lengths");
        let tau = tau.as_slice();
        let of_tau = model.inverse_dynamics_parameter_vjp(&theta, &dtheta, &ddtheta, &x, &environment);
        let of_ddtheta = model.forward_dynamics_parameter_vjp(&theta, &dtheta, tau, &x, &environment);
        let found = [of_tau.expect("lengths"), of_ddtheta.expect("regular")];
        let state = [&theta[..], &dtheta, &ddtheta, &x];
        let along = |change: Variation| by_change(&model, state, tau, &environment, change);

        let p = model.parameter_count();
        let Y = model.regressor(&theta, &dtheta, &ddtheta, &environment).expect("lengths");
        let of_x = Y.tr_mul(&nalgebra::DVector::from_column_slice(&x));
        equal(found[0].d_parameters.as_slice(), of_x.as_slice(), Y.amax(), "xᵀY");
        for k in 0..p {
            let mut rate = alloc::vec![0.0; p];
            rate[k] = 1.0;
            let expected = along(Variation::Parameters(&rate));
            for (found, expected) in found.iter().zip(expected) {
                let size = found.d_parameters.amax();
                equal(&[found.d_parameters[k]], &[expected], size, &format!("parameter {k} of {seed}"));
            }
        }
        let robot = model.description();
        let names = model.parameter_names();
        let links: Vec<&str> = names.iter().filter_map(|name| name.strip_suffix(".mcx")).collect();
        for (body, link) in links.iter().enumerate() {
            let Some(joint) = robot.joints.iter().find(|joint| joint.child == *link) else { continue };
            for k in 0..6 {
                let motion = Twist::axes()[k];
                let placed = along(Variation::Placement { joint: &joint.name, motion });
                for (found, expected) in found.iter().zip(placed) {
                    let size = found.d_placements.amax();
                    equal(&[found.d_placements[(k, body)]], &[expected], size, &format!("{link}'s place, {k}, {seed}"));
                }
                if !matches!(joint.kind, crate::model::description::JointKind::Screw(_)) {
                    assert!(found.iter().all(|found| found.d_axes[(k, body)] == 0.0));
                    continue;
                }
                let turned = along(Variation::Axis { joint: &joint.name, motion });
                for (found, expected) in found.iter().zip(turned) {
                    let size = found.d_axes.amax().max(found.d_placements.amax());
                    equal(&[found.d_axes[(k, body)]], &[expected], size, &format!("{link}'s axis, {k}, {seed}"));
                }
            }
        }
        if model.is_floating() {
            let of_base = model.inverse_dynamics_vjp(&theta, &dtheta, &ddtheta, &x, &environment).expect("lengths");
            let size = found[0].d_placements.amax();
            equal(found[0].d_placements.column(0).as_slice(), &of_base.d_theta.as_slice()[..6], size, "the base");
        }
        for k in 0..3 {
            let mut g = Vec3::zero();
            g.0[k] = 1.0;
            let mut by_g = nalgebra::DVector::zeros(model.n());
            kernel::gravity_forces(&model, &theta, g, &mut Workspace::new(&model), by_g.as_mut_slice());
            let M = model.mass_matrix(&theta).expect("lengths");
            let x = nalgebra::DVector::from_column_slice(&x);
            let y = M.clone().cholesky().expect("positive definite").solve(&x);
            let scale = found[0].d_gravity.amax();
            equal(&[found[0].d_gravity[k]], &[x.dot(&by_g)], scale, "gravity");
            equal(&[found[1].d_gravity[k]], &[-y.dot(&by_g)], y.norm() * by_g.norm(), "gravity, forward");
        }
    }
}
