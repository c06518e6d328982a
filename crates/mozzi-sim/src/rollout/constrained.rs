//! Steps of a robot with constraints, which is brought back onto them after each, and their adjoint.
//!
//! The derivatives A = ∂x'/∂x and B = ∂x'/∂τ of a step, its closing included, are those of dual numbers: see
//! [`step_sensitivity`](crate::step_sensitivity). Then x̄ = Aᵀx̄', τ̄ = Bᵀx̄' and π̄ = Pᵀx̄', at the price of 3n
//! steps on dual numbers, and one for each parameter.

use super::stepper::{Cotangents, Stepper};
use super::tape::Tape;
use crate::Error;
use crate::{Options, held_step, step_sensitivity};
use alloc::vec;
use alloc::vec::Vec;
use mozzi::model::{Model, Variation};
use nalgebra::DVector;

/// Explicit steps of one robot with constraints.
pub struct ConstrainedSteps<'m> {
    model: &'m Model,
    pub options: Options,
    theta: Vec<f64>,
    dtheta: Vec<f64>,
    /// (θ, θ̇) at the beginning of each step.
    tape: Tape,
}

impl<'m> ConstrainedSteps<'m> {
    pub fn new(model: &'m Model, options: Options) -> Self {
        let (nq, n) = (model.nq(), model.n());
        let (theta, dtheta) = (model.neutral_configuration(), vec![0.0; n]);
        ConstrainedSteps { model, options, theta, dtheta, tape: Tape::new(nq, n) }
    }
}

impl Stepper for ConstrainedSteps<'_> {
    type Error = Error;

    fn taped(&self) -> usize {
        self.theta.len() + 2 * self.dtheta.len()
    }

    fn set(&mut self, theta: &[f64], dtheta: &[f64]) {
        self.theta.copy_from_slice(theta);
        self.dtheta.copy_from_slice(dtheta);
    }

    fn state(&self) -> [&[f64]; 2] {
        [&self.theta, &self.dtheta]
    }

    fn clear(&mut self) {
        self.tape.clear();
    }

    fn step(&mut self, _: usize, tau: &[f64], is_taped: bool, _: bool) -> Result<(), Error> {
        let end = held_step(self.model, &self.theta, &self.dtheta, tau, &self.options)?;
        if is_taped {
            self.tape.push(&self.theta, &self.dtheta, &self.dtheta);
        }
        (self.theta, self.dtheta) = end;
        Ok(())
    }

    fn start(&self, at: usize) -> [&[f64]; 2] {
        let [theta, dtheta, _] = self.tape.stage(at);
        [theta, dtheta]
    }

    fn step_back(&mut self, _: usize, at: usize, tau: &[f64], to: &mut Cotangents) -> Result<(), Error> {
        let ([theta, dtheta, _], n, p) = (self.tape.stage(at), tau.len(), to.parameters.len());
        let units: Vec<Vec<f64>> = (0..p).map(|k| (0..p).map(|i| if i == k { 1.0 } else { 0.0 }).collect()).collect();
        let changes: Vec<Variation> = units.iter().map(|unit| Variation::Parameters(unit)).collect();
        let step = step_sensitivity(self.model, theta, dtheta, tau, &self.options, &changes)?;
        let end = DVector::from_iterator(2 * n, to.theta.iter().chain(&to.dtheta).copied());
        let start = step.A.tr_mul(&end);
        to.theta.copy_from_slice(&start.as_slice()[..n]);
        to.dtheta.copy_from_slice(&start.as_slice()[n..]);
        to.tau.copy_from_slice(step.B.tr_mul(&end).as_slice());
        for (sum, entry) in to.parameters.iter_mut().zip(step.P.tr_mul(&end).iter()) {
            *sum += entry;
        }
        Ok(())
    }
}
