//! States of a robot, in files.

use super::files::npz;
use mozzi::Model;
use std::path::Path;

/// N states of a robot: θ, θ̇, θ̈ or τ or x, and the tip's wrench.
pub struct States {
    pub count: usize,
    pub widths: [usize; 4],
    pub tables: [Vec<f64>; 4],
}

impl States {
    pub fn new(model: &Model, count: usize) -> Self {
        let widths = [model.nq(), model.n(), model.n(), 6];
        let tables = [0, 1, 2, 3].map(|k| {
            let number = |i: usize| ((i * 7 + k * 13) as f64 * 0.37).sin() * if k == 3 { 5.0 } else { 1.0 };
            (0..count * widths[k]).map(number).collect()
        });
        let mut states = States { count, widths, tables };
        if model.is_floating() {
            for theta in states.tables[0].chunks_exact_mut(model.nq()) {
                theta[..4].copy_from_slice(&[0.5, -0.5, 0.5, 0.5]);
            }
        }
        states
    }

    pub fn at(&self, k: usize, state: usize) -> &[f64] {
        &self.tables[k][state * self.widths[k]..][..self.widths[k]]
    }

    /// The first tables side by side, as one array.
    pub fn beside(&self, tables: &[usize]) -> Vec<f64> {
        (0..self.count).flat_map(|state| tables.iter().flat_map(move |&k| self.at(k, state).to_vec())).collect()
    }

    pub fn npz(&self, folder: &Path, name: &str) -> String {
        let shapes = self.widths.map(|width| [self.count, width]);
        let names = [("theta", 0), ("dtheta", 1), ("ddtheta", 2), ("tau", 2), ("x", 2), ("w", 3), ("wrench", 3)];
        npz(folder, name, &names.map(|(name, k)| (name, &shapes[k][..], &self.tables[k][..])))
    }
}
