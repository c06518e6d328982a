//! The implicit midpoint rule's steps, and their adjoint by the implicit function theorem.
//!
//! In z = (v, θ̇') a step from x = (θ, θ̇) under τ solves G(z; x, τ, π) = 0 with
//!
//! > G₁ = M(θ_m)v − p_m,  G₂ = M(θ')θ̇' − p';  θ_m = θ ⊕ ½hv,  θ' = θ ⊕ hv
//!
//! where the momenta p_m and p' follow from p = M(θ)θ̇ and ṗ(θ_m, v, τ): see `midpoint.rs`. A
//! cotangent z̄ gives λ with (∂G/∂z)ᵀλ = z̄, and then x̄ = −(∂G/∂x)ᵀλ, τ̄ = −(∂G/∂τ)ᵀλ, π̄ = −(∂G/∂π)ᵀλ. The
//! derivatives of G are those of dual numbers, 5n evaluations in O(n²), and one for each parameter. A step that was
//! divided goes back part by part.

use super::dynamics::HeldTorque;
use super::retraction::advance_vjp;
use super::stepper::{Cotangents, Stepper};
use super::tape::Tape;
use crate::Error;
use crate::driven::Driven;
use crate::methods::midpoint::{Midpoint, on_the_group, padded};
use crate::state::State;
use crate::{Equation, Options};
use alloc::string::ToString;
use alloc::vec;
use alloc::vec::Vec;
use mozzi::Workspace;
use mozzi::dynamics::{inverse_dynamics, mass_matrix, mass_matrix_rate};
use mozzi::model::{Environment, Freedom, Model, Variation};
use mozzi::model::{integrate, seed_direction};
use mozzi::scalar::{Dual, Real, Scalar};
use nalgebra::{DMatrix, DVector};

/// Implicit midpoint steps of one robot.
pub struct MidpointSteps<'m> {
    pub driven: Driven<'m, HeldTorque>,
    method: Midpoint,
    h: f64,
    state: State,
    /// (θ, θ̇, v) of each part of a step; its length, and θ̇ after it.
    tape: Tape,
    ends: Tape,
    /// The first part of each step, and the number of all parts.
    firsts: Vec<usize>,
    workspace: Workspace<Dual>,
    /// The robot along each of its parameters; made at the first use.
    along: Vec<Model<Dual>>,
}

impl<'m> MidpointSteps<'m> {
    pub fn new(model: &'m Model, options: &Options) -> Self {
        let (nq, n) = (model.nq(), model.n());
        let equation = Equation::new(model, HeldTorque(vec![0.0; n]), options);
        let zeros = vec![0.0; n];
        let (theta, dtheta, ddtheta) = (model.neutral_configuration(), zeros.clone(), zeros);
        MidpointSteps {
            driven: Driven::new(equation),
            method: Midpoint::new(model),
            h: options.step(),
            state: State { t: 0.0, theta, dtheta, ddtheta, powers: [0.0; 3], works: [0.0; 3] },
            tape: Tape::new(nq, n),
            ends: Tape::new(1, n),
            firsts: vec![0],
            workspace: Workspace::new(model),
            along: Vec::new(),
        }
    }
}

impl Stepper for MidpointSteps<'_> {
    type Error = Error;

    fn taped(&self) -> usize {
        self.state.theta.len() + 3 * self.state.dtheta.len()
    }

    fn set(&mut self, theta: &[f64], dtheta: &[f64]) {
        self.state.theta.copy_from_slice(theta);
        self.state.dtheta.copy_from_slice(dtheta);
        self.method.restart();
    }

    fn state(&self) -> [&[f64]; 2] {
        [&self.state.theta, &self.state.dtheta]
    }

    fn clear(&mut self) {
        self.tape.clear();
        self.ends.clear();
        self.firsts.truncate(1);
    }

    fn step(&mut self, k: usize, tau: &[f64], is_taped: bool, _: bool) -> Result<(), Error> {
        let MidpointSteps { driven, method, h, state, tape, ends, firsts, .. } = self;
        driven.equation.input.0.copy_from_slice(tau);
        driven.at_step(k + 1, *h);
        state.t = k as f64 * *h;
        driven.complete(state)?; // θ̈ under this step's torques, from which the iteration starts
        let mut parts = firsts[firsts.len() - 1];
        let end = method.step_in_parts(state, *h, (k + 1) as f64 * *h, driven, |from, h, v, to| {
            if is_taped {
                tape.push(&from.theta, &from.dtheta, v);
                ends.push(&[h], &to.dtheta, &to.dtheta);
                parts += 1;
            }
        })?;
        if is_taped {
            firsts.push(parts);
        }
        self.state = end;
        Ok(())
    }

    fn start(&self, at: usize) -> [&[f64]; 2] {
        let [theta, dtheta, _] = self.tape.stage(self.firsts[at]);
        [theta, dtheta]
    }

    fn step_back(&mut self, _: usize, at: usize, tau: &[f64], to: &mut Cotangents) -> Result<(), Error> {
        to.tau.fill(0.0);
        (self.firsts[at]..self.firsts[at + 1]).rev().try_for_each(|part| self.part_back(part, tau, to))
    }
}

impl MidpointSteps<'_> {
    /// Replaces the cotangents of a part's end by those of its start; adds to those of τ.
    fn part_back(&mut self, part: usize, tau: &[f64], to: &mut Cotangents) -> Result<(), Error> {
        let MidpointSteps { driven, tape, ends, workspace, along, .. } = self;
        let (model, equation, n, p) = (driven.model, &driven.equation, tau.len(), to.parameters.len());
        let options = Options { gravity: Some(equation.gravity), ..equation.options };
        let ([theta, dtheta, v], [h, end, _]) = (tape.stage(part), ends.stage(part));
        let h = h[0];
        let (zero, still) = (vec![0.0; n], model.map(Dual::constant));
        let mut along_unit = |which: usize, j: usize| {
            let mut e = zero.clone();
            e[j] = 1.0;
            let by = |k: usize| if k == which { &e[..] } else { &zero[..] };
            let step =
                [Dual::list(dtheta, by(1)), Dual::list(v, by(2)), Dual::list(end, by(3)), Dual::list(tau, by(4))];
            gap(
                &still,
                &seed_direction(model, theta, by(0)),
                step.each_ref().map(Vec::as_slice),
                (h, &options),
                workspace,
            )
        };
        let mut columns = |which: usize| (0..n).map(|j| along_unit(which, j)).collect::<Vec<_>>();
        let [by_theta, by_dtheta, by_v, by_end, by_tau] = [0, 1, 2, 3, 4].map(&mut columns);

        let mut z = vec![0.0; 2 * n];
        let way: Vec<f64> = v.iter().map(|v| v * h).collect();
        let (to_v, to_end) = z.split_at_mut(n);
        advance_vjp(model.configuration_space(), &way, &mut to.theta, to_v);
        to_v.iter_mut().for_each(|x| *x *= h);
        to_end.copy_from_slice(&to.dtheta);
        let G = DMatrix::from_columns(&[by_v, by_end].concat());
        let Some(lambda) = G.transpose().lu().solve(&DVector::from_vec(z)) else {
            let (found, expected) = ("singular".to_string(), "regular");
            return Err(Error::Model(mozzi::Error::BadArgument {
                what: "the midpoint rule's equation",
                found,
                expected,
            }));
        };
        for j in 0..n {
            to.theta[j] -= by_theta[j].dot(&lambda);
            to.dtheta[j] = -by_dtheta[j].dot(&lambda);
            to.tau[j] -= by_tau[j].dot(&lambda);
        }
        if along.len() < p {
            *along = varied(model)?;
        }
        let step = [dtheta, v, end, tau].map(Dual::constants);
        for (sum, model) in to.parameters.iter_mut().zip(&*along) {
            let step = step.each_ref().map(Vec::as_slice);
            *sum -= gap(model, &Dual::constants(theta), step, (h, &options), workspace).dot(&lambda);
        }
        Ok(())
    }
}

/// The robot along each of its parameters.
fn varied(model: &Model) -> Result<Vec<Model<Dual>>, Error> {
    let p = model.parameter_count();
    let along = |i: usize| {
        let mut e = vec![0.0; p];
        e[i] = 1.0;
        Ok(model.with_parameter_tangent(&[Variation::Parameters(&e)])?)
    };
    (0..p).map(along).collect()
}

/// The derivative of G.
fn gap(
    model: &Model<Dual>,
    theta: &[Dual],
    step: [&[Dual]; 4],
    way: (f64, &Options),
    workspace: &mut Workspace<Dual>,
) -> DVector<f64> {
    let G = equations(model, theta, step, way, workspace);
    DVector::from_iterator(G.len(), G.iter().map(|x| x.derivative))
}

/// G for a step from (θ, θ̇) with v to θ̇' under τ: 2n numbers.
pub fn equations<S: Real + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    [dtheta, v, end, tau]: [&[S]; 4],
    (h, options): (f64, &Options),
    workspace: &mut Workspace<S>,
) -> Vec<S> {
    let (n, half) = (model.n(), S::from_f64(0.5 * h));
    let gravity = options.gravity.map_or(model.gravity().map(S::from), |g| g.map(S::from_f64));
    let environment = Environment::with_gravity(gravity);
    let moved = |h: f64| {
        let mut theta = theta.to_vec();
        integrate(model, &mut theta, v, S::from_f64(h));
        theta
    };
    let (middle, after) = (moved(0.5 * h), moved(h));
    let mut square = vec![S::zero(); n * n];
    let times = |matrix: &[S], x: &[S]| -> Vec<S> {
        let row = |row: &[S]| row.iter().zip(x).fold(S::zero(), |sum, (&a, &b)| sum + a * b);
        matrix.chunks_exact(n.max(1)).map(row).collect()
    };
    mass_matrix(model, theta, workspace, &mut square);
    let p = times(&square, dtheta);
    mass_matrix(model, &after, workspace, &mut square);
    let found_end = times(&square, end);
    mass_matrix(model, &middle, workspace, &mut square);
    let Mv = times(&square, v);
    mass_matrix_rate(model, &middle, v, workspace, &mut square);
    let mut rate = times(&square, v);
    let (zeros, mut force, mut bias) = (vec![S::zero(); n], tau.to_vec(), vec![S::zero(); n]);
    options.friction.force(model, tau, v, &mut force);
    inverse_dynamics(model, &middle, v, &zeros, &environment, workspace, &mut bias);
    for j in 0..n {
        rate[j] += force[j] - bias[j];
    }
    // G, with p_m and p' subtracted: first as on lines, then as on the group
    let mut G: Vec<S> = Mv.iter().zip(&p).zip(&rate).map(|((&Mv, &p), &rate)| Mv - (p + rate * half)).collect();
    G.extend(found_end.iter().zip(&Mv).zip(&p).map(|((&end, &Mv), &p)| end - (Mv + Mv - p)));
    for place in model.configuration_space().places().iter().filter(|place| place.freedom != Freedom::One) {
        let of = |x: &[S]| padded(x, place);
        let found = on_the_group(of(&p), of(&rate), of(&Mv), of(v), S::from_f64(h));
        for (k, j) in place.velocities().enumerate() {
            G[j] = Mv[j] - found.middle[k];
            G[n + j] = found_end[j] - found.end[k];
        }
    }
    G
}
