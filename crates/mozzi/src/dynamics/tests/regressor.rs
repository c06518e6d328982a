//! The regressors against inverse dynamics and energies.

use super::{close, column, models};
use crate::dynamics as kernel;
use crate::model::Environment;
use crate::testing::{state, twist};
use crate::workspace::Workspace;
use nalgebra::{DMatrix, DVector};

#[test]
fn forces_are_linear_in_the_parameters() {
    for (seed, model) in models() {
        let [theta, dtheta, ddtheta] = state(&model, seed);
        let environment =
            Environment { base_twist: twist(seed), base_acceleration: twist(seed + 1), ..model.environment() };
        let (n, p) = (model.n(), model.parameter_count());
        let (mut Y, mut workspace) = (vec![f64::NAN; n * p], Workspace::new(&model));
        workspace.fill_nan();
        kernel::regressor(&model, &theta, &dtheta, &ddtheta, &environment, &mut workspace, &mut Y);
        let (Y, pi) = (DMatrix::from_row_slice(n, p, &Y), DVector::from_vec(model.parameters()));
        let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment).expect("lengths");
        let terms = Y.row_iter().map(|y| y.transpose().component_mul(&pi).amax()).fold(0.0, f64::max);
        close(&column(&(&Y * &pi)), &column(&tau), terms, 300.0, "Y π");
        assert_eq!(Y, model.regressor(&theta, &dtheta, &ddtheta, &environment).expect("lengths"));
    }
}

#[test]
fn energies_are_linear_in_the_parameters() {
    for (seed, model) in models() {
        let [theta, dtheta, _] = state(&model, seed);
        let mut workspace = Workspace::new(&model);
        let (mut y_k, mut y_p) = (vec![f64::NAN; model.parameter_count()], vec![f64::NAN; model.parameter_count()]);
        let (V_s, g) = (twist(seed), model.gravity());
        workspace.fill_nan();
        kernel::energy_regressors(&model, &theta, &dtheta, V_s, g, &mut workspace, &mut y_k, &mut y_p);
        let K = kernel::kinetic_energy(&model, &theta, &dtheta, V_s, &mut workspace);
        let P = kernel::potential_energy(&model, &theta, g, &mut workspace) - model.spring_energy;
        let pi = model.parameters();
        for (what, y, energy) in [("kinetic", &y_k, K), ("potential", &y_p, P)] {
            let terms: Vec<f64> = y.iter().zip(&pi).map(|(y, x)| y * x).collect();
            let scale = terms.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let error = (terms.iter().sum::<f64>() - energy).abs() / (f64::EPSILON * scale.max(energy.abs()));
            assert!(error < 100.0, "{what} energy of model {seed}: normalised error {error}");
        }
        let (K, _) = model.energy_regressors(&theta, &dtheta).expect("lengths");
        let at_rest = model.kinetic_energy(&theta, &dtheta).expect("lengths");
        assert!(((K * DVector::from_vec(pi))[0] / at_rest - 1.0).abs() < 1e-10);
    }
}
