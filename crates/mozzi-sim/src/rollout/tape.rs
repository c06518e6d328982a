//! The stages of the steps of a segment, in the order in which they were evaluated.

use alloc::vec::Vec;
use core::ops::Range;

/// θ, θ̇ and θ̈ of each stage, row after row.
#[derive(Clone, Debug, Default)]
pub struct Tape {
    theta: Vec<f64>,
    dtheta: Vec<f64>,
    ddtheta: Vec<f64>,
    widths: [usize; 2],
}

impl Tape {
    /// For rows of θ and of θ̇ of these lengths.
    pub fn new(nq: usize, n: usize) -> Self {
        Tape { widths: [nq, n], ..Tape::default() }
    }

    pub fn clear(&mut self) {
        self.theta.clear();
        self.dtheta.clear();
        self.ddtheta.clear();
    }

    pub fn push(&mut self, theta: &[f64], dtheta: &[f64], ddtheta: &[f64]) {
        self.theta.extend_from_slice(theta);
        self.dtheta.extend_from_slice(dtheta);
        self.ddtheta.extend_from_slice(ddtheta);
    }

    /// θ, θ̇ and θ̈ of one stage.
    pub fn stage(&self, k: usize) -> [&[f64]; 3] {
        let [nq, n] = self.widths;
        let rows = |width: usize| -> Range<usize> { k * width..(k + 1) * width };
        [&self.theta[rows(nq)], &self.dtheta[rows(n)], &self.ddtheta[rows(n)]]
    }
}
