//! The analytic derivatives against dual numbers, central differences, each other, and identities.

use super::{close, models};
use crate::model::integrate;
use crate::model::{Environment, FrameId, Model};
use crate::quantities::{ForwardDynamicsVjp, InverseDynamicsVjp};
use crate::testing::{
    chain, floating_mixed_tree, floating_tree, limbs, mixed_tree, moving, state, tree, twist, wrench,
};
use crate::workspace::Workspace;
use crate::{Dual, Scalar, Vec3, Wrench, dynamics as kernel};
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

type Applied = Vec<(FrameId, Wrench)>;

/// Wrenches on three frames, one of them the base's.
fn applied(model: &Model, seed: u64) -> Applied {
    let frame = |name| model.frame(name).expect("a link");
    Vec::from([
        (model.end_effector().expect("named"), wrench(seed)),
        (frame("link1"), wrench(seed + 1) * 10.0),
        (frame("link0"), wrench(seed + 2)),
    ])
}

/// A base that moves, and wrenches.
fn everything<'a>(model: &Model, seed: u64, applied: &'a Applied) -> Environment<'a> {
    let (base_twist, base_acceleration) = (twist(seed), twist(seed + 1));
    Environment { base_twist, base_acceleration, applied, ..model.environment() }
}

/// The same environment in another scalar type.
fn lifted<'a, S: Scalar + From<f64>>(e: &Environment, memory: &'a mut Vec<(FrameId, Wrench<S>)>) -> Environment<'a, S> {
    memory.extend(e.applied.iter().map(|&(frame, F)| (frame, F.map(S::from))));
    Environment {
        gravity: e.gravity.map(S::from),
        base_twist: e.base_twist.map(S::from),
        base_acceleration: e.base_acceleration.map(S::from),
        applied: memory,
    }
}

/// τ(θ, θ̇, θ̈) or θ̈(θ, θ̇, τ).
type Quantity<S> = fn(&Model, &[S], &[S], &[S], &Environment<S>, &mut Workspace<S>, &mut [S]);

/// The three derivatives of f, a column at a time, by dual numbers.
fn by_duals(f: Quantity<Dual>, model: &Model, x: [&[f64]; 3], environment: &Environment) -> [DMatrix<f64>; 3] {
    let (n, mut memory) = (model.n(), Vec::new());
    let environment = lifted(environment, &mut memory);
    [0, 1, 2].map(|which| {
        let columns = (0..n).map(|k| {
            let mut e = alloc::vec![0.0; n];
            e[k] = 1.0;
            let mut x = x.map(|x| x.iter().map(|&x| Dual::constant(x)).collect::<Vec<_>>());
            if which == 0 {
                x[0] = moving(model, &x[0].iter().map(|x| x.value).collect::<Vec<_>>(), &e);
            } else {
                x[which][k].derivative = 1.0;
            }
            let mut out = alloc::vec![Dual::zero(); n];
            f(model, &x[0], &x[1], &x[2], &environment, &mut Workspace::new(model), &mut out);
            DVector::from_iterator(n, out.iter().map(|x| x.derivative))
        });
        DMatrix::from_columns(&columns.collect::<Vec<_>>())
    })
}

#[test]
fn of_inverse_dynamics_equal_dual_numbers() {
    for (seed, model) in models() {
        let [theta, dtheta, ddtheta] = state(&model, seed);
        let applied = applied(&model, seed);
        for environment in [model.environment(), everything(&model, seed, &applied)] {
            let x = [&theta[..], &dtheta, &ddtheta];
            let [d_theta, d_dtheta, M] = by_duals(kernel::inverse_dynamics, &model, x, &environment);
            let found = model.inverse_dynamics_derivatives(&theta, &dtheta, &ddtheta, &environment).expect("lengths");
            let scale = M.amax() * dtheta.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
            close(&found.d_theta, &d_theta, 0.0, 1000.0, "∂τ/∂θ");
            close(&found.d_dtheta, &d_dtheta, scale, 1000.0, "∂τ/∂θ̇");
            close(&found.d_ddtheta, &M, 0.0, 1000.0, "∂τ/∂θ̈");
            close(&found.d_ddtheta, &model.mass_matrix(&theta).expect("lengths"), 0.0, 300.0, "M");
        }
    }
}

/// Robots whose ∂θ̈ is computed by articulated bodies: chains with every remainder of eight columns, and several limbs.
fn deep() -> Vec<(u64, Model)> {
    let makes = [tree, floating_tree, mixed_tree, floating_mixed_tree];
    let chains = (0..16).map(|k| (80 + k, chain(&makes[k as usize % 4](80 + k, 20 + k as usize / 2, 0))));
    let limbs = (0..4).map(|k| (96 + k, limbs(&makes[k as usize](96 + k, 63, 0), 21)));
    chains.chain(limbs).collect()
}

#[test]
fn deep_robots_have_every_remainder_and_every_kind_of_branch() {
    let deep = deep();
    assert!(deep.iter().all(|(_, model)| model.structure.has_long_limbs));
    for remainder in 0..8 {
        assert!(deep.iter().any(|(_, model)| model.links.len() % 8 == remainder), "{remainder} columns are left");
    }
    let branching = deep.iter().filter(|(_, model)| model.structure.forks.iter().filter(|&&fork| fork).count() >= 2);
    assert!(branching.clone().all(|(_, model)| model.structure.forks[0]));
    assert!([true, false].map(|is| branching.clone().any(|(_, model)| model.is_floating() == is)) == [true; 2]);
}

#[test]
fn of_forward_dynamics_equal_dual_numbers() {
    for (seed, model) in models().chain(deep()) {
        let [theta, dtheta, _] = state(&model, seed);
        let applied = applied(&model, seed);
        let environment = everything(&model, seed, &applied);
        let tau = model.inverse_dynamics(&theta, &dtheta, &dtheta, &environment).expect("lengths");
        let x = [&theta[..], &dtheta, tau.as_slice()];
        let by_dual = by_duals(kernel::forward_dynamics, &model, x, &environment);
        let found = model.forward_dynamics_derivatives(&theta, &dtheta, tau.as_slice(), &environment).expect("regular");
        let expected = model.forward_dynamics(&theta, &dtheta, tau.as_slice(), &environment).expect("regular");
        // backward errors: M θ̈ and M ∂θ̈, in units of the terms of the product
        let M = model.mass_matrix(&theta).expect("lengths");
        let [mine, by_bodies] = [&found.ddtheta, &expected].map(|x| DMatrix::from_columns(&[&M * x]));
        close(&mine, &by_bodies, M.amax() * expected.amax().max(1.0) + tau.amax(), 1000.0, "θ̈");
        for (what, found, expected) in [
            ("∂θ̈/∂θ", &found.d_theta, &by_dual[0]),
            ("∂θ̈/∂θ̇", &found.d_dtheta, &by_dual[1]),
            ("∂θ̈/∂τ", &found.d_tau, &by_dual[2]),
        ] {
            let scale = M.amax() * expected.amax().max(1.0);
            close(&(&M * found), &(&M * expected), scale, 1000.0, what);
        }
        let one = DMatrix::identity(model.n(), model.n());
        close(&(&M * &found.d_tau), &one, M.amax() * found.d_tau.amax(), 100.0, "M ∂θ̈/∂τ = 1");
        assert_eq!(found.d_tau, found.d_tau.transpose());
    }
}

#[test]
fn products_with_a_vector_are_those_of_the_matrices() {
    for (seed, model) in models() {
        let [theta, dtheta, ddtheta] = state(&model, seed);
        let [_, x, _] = state(&model, seed + 1);
        let x_ = DVector::from_column_slice(&x);
        let (n, applied) = (model.n(), applied(&model, seed));
        let product = |X: &DMatrix<f64>, x: &DVector<f64>| DMatrix::from_columns(&[X.transpose() * x]);
        for environment in [model.environment(), everything(&model, seed, &applied)] {
            let at = |ddtheta: &[f64]| {
                model.inverse_dynamics_derivatives(&theta, &dtheta, ddtheta, &environment).expect("lengths")
            };
            let full = at(&ddtheta);
            let terms = full.d_ddtheta.amax() * dtheta.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
            let state = [&theta[..], &dtheta, &ddtheta, &x];
            let found = model.compute(InverseDynamicsVjp, &state, &environment).expect("lengths");
            for (found, X) in found.iter().zip([&full.d_theta, &full.d_dtheta, &full.d_ddtheta]) {
                let scale = (X.amax() + terms) * x_.amax();
                close(&DMatrix::from_column_slice(n, 1, found), &product(X, &x_), scale, 1000.0, "xᵀ∂τ");
            }

            let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment).expect("lengths");
            let state = [&theta[..], &dtheta, tau.as_slice(), &x];
            let found = model.compute(ForwardDynamicsVjp, &state, &environment).expect("regular");
            let [d_theta, d_dtheta, y] = [0, 1, 2].map(|k| DVector::from_column_slice(&found[k]));
            let scale = full.d_ddtheta.amax() * y.amax();
            close(&product(&full.d_ddtheta, &y), &DMatrix::from_column_slice(n, 1, &x), scale, 1000.0, "M y = x");
            let ddtheta = model.forward_dynamics(&theta, &dtheta, tau.as_slice(), &environment).expect("regular");
            let full = at(ddtheta.as_slice());
            for (found, X) in [(d_theta, &full.d_theta), (d_dtheta, &full.d_dtheta)] {
                let scale = (X.amax() + terms) * y.amax();
                close(&DMatrix::from_columns(&[found]), &-product(X, &y), scale, 1000.0, "xᵀ∂θ̈");
            }
        }
    }
}

#[test]
fn central_differences_agree() {
    for (seed, model) in models().step_by(5) {
        let [theta, dtheta, ddtheta] = state(&model, seed);
        let applied = applied(&model, seed);
        let (n, environment) = (model.n(), everything(&model, seed, &applied));
        let found = model.inverse_dynamics_derivatives(&theta, &dtheta, &ddtheta, &environment).expect("lengths");
        let step = 1e-5;
        let tau = |k: usize, h: f64| {
            let (mut theta, mut e) = (theta.clone(), alloc::vec![0.0; n]);
            e[k] = 1.0;
            integrate(&model, &mut theta, &e, h);
            model.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment).expect("lengths")
        };
        let columns: Vec<_> = (0..n).map(|k| (tau(k, step) - tau(k, -step)) / (2.0 * step)).collect();
        let error = (DMatrix::from_columns(&columns) - &found.d_theta).amax();
        assert!(error < 1e-7 * found.d_theta.amax(), "{error:e} of {}", found.d_theta.amax());
    }
}

#[test]
fn of_the_parts_equal_those_of_the_whole() {
    for (seed, mut model) in models() {
        model.springs.clear(); // the parts do not include springs
        let [theta, dtheta, x] = state(&model, seed);
        let (zero, applied) = (alloc::vec![0.0; model.n()], applied(&model, seed));
        let nothing = Environment::with_gravity(Vec3::zero());
        let at = |x: &[f64], environment: &Environment| {
            model.inverse_dynamics_derivatives(&theta, &zero, x, environment).expect("lengths").d_theta
        };
        let dg = model.gravity_forces_derivative(&theta).expect("lengths");
        assert_eq!(dg, at(&zero, &model.environment()));
        let pushing = Environment { applied: &applied, ..nothing };
        let dF = model.tip_forces_derivative(&theta, &applied).expect("lengths");
        assert_eq!(dF, at(&zero, &pushing));
        let dMx = model.mass_matrix_product_derivative(&theta, &x).expect("lengths");
        assert_eq!(dMx, at(&x, &nothing));
        // the whole at rest is their sum
        let whole = at(&x, &Environment { applied: &applied, ..model.environment() });
        close(&(&dg + &dF + &dMx), &whole, dMx.amax(), 100.0, "∂g + ∂(JᵀF) + ∂(Mx)");
        if !model.configuration_space().is_flat() {
            continue;
        }
        close(&dg.transpose(), &dg, 0.0, 300.0, "∂g is symmetric");
        // ∂(Mθ̇)/∂θ θ̇ = Ṁθ̇
        let dtheta_ = DVector::from_column_slice(&dtheta);
        let dMx = model.mass_matrix_product_derivative(&theta, &dtheta).expect("lengths");
        let dM = model.mass_matrix_rate(&theta, &dtheta).expect("lengths");
        let (a, b, scale) = (dMx * &dtheta_, dM * &dtheta_, dtheta_.amax().powi(2));
        let scale = scale * model.mass_matrix(&theta).expect("lengths").amax();
        close(&DMatrix::from_columns(&[a]), &DMatrix::from_columns(&[b]), scale, 1000.0, "Ṁθ̇");
    }
}

#[test]
fn second_derivatives_by_dual_numbers() {
    type Dual2 = Dual<Dual>;
    for (seed, model) in models().filter(|(_, model)| model.n() < 20).step_by(4) {
        let [theta, dtheta, ddtheta] = state(&model, seed);
        let (n, environment) = (model.n(), model.environment());
        let along = twist(seed).to_array();
        let along: Vec<f64> = (0..n).map(|k| along[k % 6]).collect();
        // the analytic kernel on dual numbers that move along `along` …
        let dual = |x: &[f64]| x.iter().map(|&x| Dual::constant(x)).collect::<Vec<_>>();
        let mut first = [(); 3].map(|()| alloc::vec![Dual::zero(); n * n]);
        let (q, dq, ddq) = (moving(&model, &theta, &along), dual(&dtheta), dual(&ddtheta));
        kernel::inverse_dynamics_derivatives(
            &model,
            &q,
            &dq,
            &ddq,
            &model.environment(),
            &mut Workspace::new(&model),
            first.each_mut().map(|x| &mut x[..]),
        );
        let found = DMatrix::from_fn(n, n, |i, j| first[0][i * n + j].derivative);
        // … against inverse dynamics on duals of duals: along `along`, and from there along each velocity
        let dual2 = |x: &[f64]| x.iter().map(|&x| Dual2::from(x)).collect::<Vec<_>>();
        let (dq, ddq, mut out) = (dual2(&dtheta), dual2(&ddtheta), alloc::vec![Dual2::zero(); n]);
        let columns: Vec<_> = (0..n)
            .map(|k| {
                let (mut q, mut e) = (dual2(&theta), alloc::vec![Dual2::zero(); n]);
                e[k] = Dual2::one();
                let inner = Dual::constant(Dual { value: 0.0, derivative: 1.0 });
                integrate(&model, &mut q, &dual2(&along), inner);
                integrate(&model, &mut q, &e, Dual { value: Dual::zero(), derivative: Dual::one() });
                let (w, environment) = (&mut Workspace::new(&model), model.environment());
                kernel::inverse_dynamics(&model, &q, &dq, &ddq, &environment, w, &mut out);
                DVector::from_iterator(n, out.iter().map(|x| x.derivative.derivative))
            })
            .collect();
        close(&found, &DMatrix::from_columns(&columns), 0.0, 2000.0, "∂²τ/∂θ²");
        // and differences of the analytic derivative
        let at = |h: f64| {
            let mut theta = theta.clone();
            integrate(&model, &mut theta, &along, h);
            model.inverse_dynamics_derivatives(&theta, &dtheta, &ddtheta, &environment).expect("lengths").d_theta
        };
        let difference = (at(1e-5) - at(-1e-5)) / 2e-5;
        assert!((&found - difference).amax() < 1e-6 * found.amax());
    }
}

#[test]
fn zeros_are_where_the_tree_says() {
    for (seed, model) in models() {
        let [theta, dtheta, ddtheta] = state(&model, seed);
        let applied = applied(&model, seed);
        let environment = everything(&model, seed, &applied);
        let found = model.inverse_dynamics_derivatives(&theta, &dtheta, &ddtheta, &environment).expect("lengths");
        for i in 0..model.n() {
            for j in 0..model.n() {
                let entries = [&found.d_theta, &found.d_dtheta, &found.d_ddtheta].map(|X| X[(i, j)]);
                assert_eq!(model.couples(i, j), model.couples(j, i));
                if !model.couples(i, j) {
                    assert_eq!(entries, [0.0; 3]);
                }
                // elsewhere they are 0 by chance alone, or in the blocks of a free body's own inertia
                let own = model.configuration_space().places().iter().any(|place| {
                    place.velocities().contains(&i) && place.velocities().contains(&j) && place.velocities().len() == 6
                });
                assert!(own || model.couples(i, j) == (entries[2] != 0.0), "{seed}: ({i}, {j}) {entries:?}");
            }
        }
    }
}

#[test]
fn extreme_masses_and_odd_arguments() {
    for heavier in [1.0e10, 1.0e-10] {
        let mut robot = tree(8, 10, 0).description().clone();
        for (i, link) in robot.links.iter_mut().enumerate().filter(|(i, _)| i % 2 == 0) {
            link.inertia = link.inertia * if i > 0 { heavier } else { 1.0 };
        }
        let model = robot.build().expect("a sound robot");
        let [theta, dtheta, ddtheta] = state(&model, 8);
        let environment = model.environment();
        let x = [&theta[..], &dtheta, &ddtheta];
        let [d_theta, d_dtheta, _] = by_duals(kernel::inverse_dynamics, &model, x, &environment);
        let found = model.inverse_dynamics_derivatives(&theta, &dtheta, &ddtheta, &environment).expect("lengths");
        close(&found.d_theta, &d_theta, 0.0, 1000.0, "∂τ/∂θ");
        close(&found.d_dtheta, &d_dtheta, 0.0, 1000.0, "∂τ/∂θ̇");
        let short = model.inverse_dynamics_derivatives(&theta, &dtheta[1..], &ddtheta, &environment);
        assert_eq!(short.expect_err("nine rates").to_string(), "dtheta has 9 entries, expected 10");
        let short = model.forward_dynamics_derivatives(&theta, &dtheta, &theta[1..], &environment);
        assert_eq!(short.expect_err("nine torques").to_string(), "tau has 9 entries, expected 10");
        let mut odd = theta.clone();
        odd[2] = f64::NAN;
        let found = model.forward_dynamics_derivatives(&odd, &dtheta, &ddtheta, &environment).expect("NaN is no error");
        assert!(found.d_theta.iter().any(|x| x.is_nan()));
    }
}
