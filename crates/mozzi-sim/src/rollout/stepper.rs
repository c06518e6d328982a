//! The interface of integrators for rollouts: steps forward, and cotangents back through them.

use alloc::vec;
use alloc::vec::Vec;

/// The running cotangents of a state, and the gradients of one step and of all parameters. With several robots, each
/// list holds their numbers one after the other.
#[derive(Clone, Debug)]
pub struct Cotangents {
    /// The cotangent of θ, along the velocities.
    pub theta: Vec<f64>,
    /// The cotangent of θ̇.
    pub dtheta: Vec<f64>,
    /// The gradient with respect to τ of the last step.
    pub tau: Vec<f64>,
    /// The gradient with respect to the parameters so far; empty if not wanted.
    pub parameters: Vec<f64>,
}

impl Cotangents {
    pub(super) fn new(n: usize) -> Self {
        Cotangents { theta: vec![0.0; n], dtheta: vec![0.0; n], tau: vec![0.0; n], parameters: Vec::new() }
    }
}

/// Steps of one size, of one robot or of many of one model, which it can go back.
pub trait Stepper {
    /// The reason why a state fails.
    type Error;

    /// The numbers that a step leaves on the tape.
    fn taped(&self) -> usize;

    /// Moves to a state.
    fn set(&mut self, theta: &[f64], dtheta: &[f64]);

    /// θ and θ̇ now.
    fn state(&self) -> [&[f64]; 2];

    /// Clears the tape.
    fn clear(&mut self);

    /// Step k from the state now, onto the tape if wanted. The state after it may be left out if it is not needed.
    ///
    /// # Errors
    /// A state that fails.
    fn step(&mut self, k: usize, tau: &[f64], is_taped: bool, needs_end: bool) -> Result<(), Self::Error>;

    /// θ and θ̇ at the beginning of the tape's step `at`.
    fn start(&self, at: usize) -> [&[f64]; 2];

    /// Replaces the cotangents of the end of step k, the tape's step `at`, by those of its start.
    ///
    /// # Errors
    /// As for [`step`](Self::step).
    fn step_back(&mut self, k: usize, at: usize, tau: &[f64], cotangents: &mut Cotangents) -> Result<(), Self::Error>;
}
