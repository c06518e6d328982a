//! The motion within a step.

use crate::state::State;
use alloc::vec;
use alloc::vec::Vec;
use mozzi::model::Model;
use mozzi::model::{difference, integrate};

/// θ = θ₀ ⊕ u(x) and θ̇(x) for x from 0 to 1 of a step, by polynomials.
#[derive(Clone, Debug)]
pub(crate) struct Dense {
    pub t: f64,
    pub h: f64,
    theta: Vec<f64>,
    /// Coefficients of u, then of θ̇, then of the works: y = c₀ + x(c₁ + (1 − x)(c₂ + x(c₃ + (1 − x)c₄))).
    pub coefficients: [Vec<f64>; 5],
}

/// u̇ of θ = θ₀ ⊕ u, where θ moves with θ̇.
pub(crate) fn rate(model: &Model, u: &[f64], dtheta: &[f64], du: &mut [f64]) {
    du.copy_from_slice(dtheta);
    model.configuration_space().rate(u, du);
}

impl Dense {
    /// From coefficients of u, θ̇ and the works.
    pub fn new(from: &State, h: f64, coefficients: [Vec<f64>; 5]) -> Self {
        Dense { t: from.t, h, theta: from.theta.clone(), coefficients }
    }

    /// The cubics that meet both ends and their rates.
    pub fn hermite(model: &Model, from: &State, to: &State) -> Self {
        let (n, h) = (model.n(), to.t - from.t);
        let (mut u, mut du) = (vec![0.0; n], vec![0.0; n]);
        difference(model, &from.theta, &to.theta, &mut u);
        rate(model, &u, &to.dtheta, &mut du);
        let starts = [&vec![0.0; n][..], &from.dtheta, &from.works].concat();
        let ends = [&u[..], &to.dtheta, &to.works].concat();
        let first = [&from.dtheta[..], &from.ddtheta, &from.powers].concat();
        let last = [&du[..], &to.ddtheta, &to.powers].concat();
        let way: Vec<f64> = ends.iter().zip(&starts).map(|(b, a)| b - a).collect();
        let bend: Vec<f64> = first.iter().zip(&way).map(|(k, way)| h * k - way).collect();
        let twist = (0..way.len()).map(|k| way[k] - h * last[k] - bend[k]).collect();
        let none = vec![0.0; way.len()];
        Self::new(from, h, [starts, way, bend, twist, none])
    }

    /// The state at a time within the step, its θ̈ and powers not known.
    pub fn at(&self, model: &Model, t: f64) -> State {
        let (n, x) = (model.n(), (t - self.t) / self.h);
        let [a, b, c, d, e] = &self.coefficients;
        let y: Vec<f64> =
            (0..a.len()).map(|k| a[k] + x * (b[k] + (1.0 - x) * (c[k] + x * (d[k] + (1.0 - x) * e[k])))).collect();
        let mut theta = self.theta.clone();
        integrate(model, &mut theta, &y[..n], 1.0);
        State {
            t,
            theta,
            dtheta: y[n..2 * n].to_vec(),
            ddtheta: vec![0.0; n],
            powers: [0.0; 3],
            works: [y[2 * n], y[2 * n + 1], y[2 * n + 2]],
        }
    }
}
