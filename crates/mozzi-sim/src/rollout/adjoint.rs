//! The adjoint of one explicit step: cotangents of its end to cotangents of its start and its torques.
//!
//! With the rates w₁ = θ̇, wᵢ = rate(uᵢ, θ̇ᵢ) and aᵢ = θ̈ᵢ, the step of Runge-Kutta 4 is
//!
//! > θᵢ = θ ⊕ uᵢ, uᵢ = cᵢ wᵢ₋₁; θ̇ᵢ = θ̇ + cᵢ aᵢ₋₁; θ' = θ ⊕ hΣ bᵢwᵢ; θ̇' = θ̇ + hΣ bᵢaᵢ
//!
//! with c = (0, h/2, h/2, h), b = (1/6, 1/3, 1/3, 1/6). The transposed derivatives run through these lines from the
//! last to the first; each θ̈ᵢ takes one vector-Jacobian product of forward dynamics, each ⊕ those of
//! [`retraction.rs`](super::retraction). Euler's step is θ' = θ ⊕ hθ̇, θ̇' = θ̇ + hθ̈; the semi-implicit one has θ̇' in
//! the first.

use super::dynamics::{Stage, StageDynamics};
use super::retraction::{advance_vjp, rate_vjp};
use super::stepper::Cotangents;
use super::tape::Tape;
use crate::Explicit;
use alloc::vec;
use alloc::vec::Vec;
use mozzi::model::ConfigurationSpace;

/// The number of stages of a step.
pub fn stages(method: Explicit) -> usize {
    if method == Explicit::RungeKutta4 { 4 } else { 1 }
}

/// Memory for the adjoint of one step. With several robots, each list holds their numbers one after the other.
#[derive(Clone, Debug)]
pub struct Adjoint {
    space: ConfigurationSpace,
    is_flat: bool,
    /// The number of velocities of one robot.
    n: usize,
    /// wᵢ, stage after stage, and the cotangents of wᵢ and aᵢ.
    w: [Vec<f64>; 4],
    w_bar: [Vec<f64>; 4],
    a_bar: [Vec<f64>; 4],
    /// Scratch for one stage: uᵢ, its cotangents from ⊕ and from the rate, and the products of forward dynamics.
    u: Vec<f64>,
    u_bar: [Vec<f64>; 2],
    products: [Vec<f64>; 3],
}

impl Adjoint {
    pub fn new(space: &ConfigurationSpace, n: usize, robots: usize) -> Self {
        let zeros = || vec![0.0; n * robots];
        let four = || core::array::from_fn(|_| zeros());
        Adjoint {
            space: space.clone(),
            is_flat: space.is_flat(),
            n,
            w: four(),
            w_bar: four(),
            a_bar: four(),
            u: zeros(),
            u_bar: [zeros(), zeros()],
            products: core::array::from_fn(|_| zeros()),
        }
    }

    /// Replaces the cotangents of the end of a step by those of its start. The tape's stages are from `first` on.
    pub fn step<D: StageDynamics>(
        &mut self,
        (method, h): (Explicit, f64),
        (step, t, tau): (usize, f64, &[f64]),
        (tape, first): (&Tape, usize),
        dynamics: &mut D,
        to: &mut Cotangents,
    ) -> Result<(), D::Error> {
        to.tau.fill(0.0);
        let stage = |i: usize| {
            let [theta, dtheta, ddtheta] = tape.stage(first + i);
            (Stage { step, t, theta, dtheta, tau }, ddtheta)
        };
        match method {
            Explicit::Euler => {
                let (start, ddtheta) = stage(0);
                scale(&mut self.a_bar[0], &to.dtheta, h);
                self.advance(start.dtheta, h, &mut to.theta);
                add(&mut to.dtheta, &self.u_bar[0], h);
                self.accelerations(start, ddtheta, 0, dynamics, to)?;
                self.add_products(to);
            }
            Explicit::SemiImplicitEuler => {
                let (start, ddtheta) = stage(0);
                self.w[0].copy_from_slice(start.dtheta);
                add(&mut self.w[0], ddtheta, h);
                let end = core::mem::take(&mut self.w[0]);
                self.advance(&end, h, &mut to.theta);
                self.w[0] = end;
                add(&mut to.dtheta, &self.u_bar[0], h);
                scale(&mut self.a_bar[0], &to.dtheta, h);
                self.accelerations(start, ddtheta, 0, dynamics, to)?;
                self.add_products(to);
            }
            Explicit::RungeKutta4 => self.runge_kutta_4(h, stage, dynamics, to)?,
        }
        Ok(())
    }

    fn runge_kutta_4<'a, D: StageDynamics>(
        &mut self,
        h: f64,
        stage: impl Fn(usize) -> (Stage<'a>, &'a [f64]),
        dynamics: &mut D,
        to: &mut Cotangents,
    ) -> Result<(), D::Error> {
        let along = [0.0, 0.5 * h, 0.5 * h, h];
        let weights = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];
        let mut mean = core::mem::take(&mut self.u);
        mean.fill(0.0);
        for i in 0..4 {
            let dtheta = stage(i).0.dtheta;
            self.w[i].copy_from_slice(dtheta);
            if i > 0 && !self.is_flat {
                let [before, w] = self.w.get_disjoint_mut([i - 1, i]).unwrap_or_else(|_| unreachable!());
                scale(&mut self.u_bar[0], before, along[i]);
                for (u, w) in self.u_bar[0].chunks_exact(self.n).zip(w.chunks_exact_mut(self.n)) {
                    self.space.rate(u, w);
                }
            }
            add(&mut mean, &self.w[i], weights[i]);
        }
        self.advance(&mean, h, &mut to.theta);
        self.u = mean;
        for i in 0..4 {
            scale(&mut self.w_bar[i], &self.u_bar[0], weights[i] * h);
            scale(&mut self.a_bar[i], &to.dtheta, weights[i] * h);
        }
        for i in (0..4).rev() {
            let (at, ddtheta) = stage(i);
            self.accelerations(at, ddtheta, i, dynamics, to)?;
            if i > 0 {
                self.stage_start(i, along[i], at.dtheta);
            } else {
                add(&mut to.dtheta, &self.w_bar[0], 1.0);
            }
            self.add_products(to);
        }
        Ok(())
    }

    /// From the cotangents of θᵢ and θ̇ᵢ, in the products, those of θ and θ̇, in their place, and of wᵢ₋₁ and aᵢ₋₁.
    fn stage_start(&mut self, i: usize, along: f64, dtheta: &[f64]) {
        let Adjoint { space, n, w, w_bar, a_bar, u, u_bar, products: [d_theta, d_dtheta, _], .. } = self;
        let [by_advance, by_rate] = u_bar;
        if self.is_flat {
            by_advance.copy_from_slice(d_theta);
            add(d_dtheta, &w_bar[i], 1.0);
        } else {
            scale(u, &w[i - 1], along);
            let each = u.chunks_exact(*n).zip(dtheta.chunks_exact(*n)).zip(w_bar[i].chunks_exact_mut(*n));
            for (((u, dtheta), bar), by_rate) in each.zip(by_rate.chunks_exact_mut(*n)) {
                rate_vjp(space, u, dtheta, bar, by_rate);
            }
            add(d_dtheta, &w_bar[i], 1.0);
            let each = u.chunks_exact(*n).zip(d_theta.chunks_exact_mut(*n)).zip(by_advance.chunks_exact_mut(*n));
            for ((u, bar), by_advance) in each {
                advance_vjp(space, u, bar, by_advance);
            }
            add(by_advance, by_rate, 1.0);
        }
        add(&mut w_bar[i - 1], by_advance, along);
        add(&mut a_bar[i - 1], d_dtheta, along);
    }

    fn add_products(&self, to: &mut Cotangents) {
        add(&mut to.theta, &self.products[0], 1.0);
        add(&mut to.dtheta, &self.products[1], 1.0);
    }

    /// Replaces the cotangent of θ ⊕ wh by that of θ; that of wh goes to `u_bar[0]`.
    fn advance(&mut self, w: &[f64], h: f64, theta_bar: &mut [f64]) {
        let (by_u, n) = (&mut self.u_bar[0], self.n);
        if self.is_flat {
            by_u.copy_from_slice(theta_bar);
            return;
        }
        scale(&mut self.products[0], w, h);
        let each = self.products[0].chunks_exact(n).zip(theta_bar.chunks_exact_mut(n)).zip(by_u.chunks_exact_mut(n));
        for ((u, bar), by_u) in each {
            advance_vjp(&self.space, u, bar, by_u);
        }
    }

    /// The products of forward dynamics with āᵢ; adds those by τ and by the parameters.
    fn accelerations<D: StageDynamics>(
        &mut self,
        stage: Stage<'_>,
        ddtheta: &[f64],
        i: usize,
        dynamics: &mut D,
        to: &mut Cotangents,
    ) -> Result<(), D::Error> {
        let [d_theta, d_dtheta, d_tau] = &mut self.products;
        dynamics.vjp(stage, &self.a_bar[i], [d_theta, d_dtheta, d_tau])?;
        add(&mut to.tau, d_tau, 1.0);
        if !to.parameters.is_empty() {
            dynamics.add_parameter_vjp(stage, ddtheta, d_tau, &mut to.parameters)?;
        }
        Ok(())
    }
}

/// x ← x + kh.
fn add(x: &mut [f64], k: &[f64], h: f64) {
    x.iter_mut().zip(k).for_each(|(x, k)| *x += k * h);
}

/// x ← kh.
fn scale(x: &mut [f64], k: &[f64], h: f64) {
    x.iter_mut().zip(k).for_each(|(x, k)| *x = k * h);
}
