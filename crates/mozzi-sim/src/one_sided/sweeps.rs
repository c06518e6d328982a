//! Projected Gauss-Seidel (Jourdan, Alart and Jean 1998): one block after the other is solved exactly.

use super::point_contact::point_contact;
use super::{Law, Problem};
use nalgebra::{DVector, Matrix3};

/// Sweeps over all blocks until u changes by at most `tolerance`; returns their number.
pub(super) fn sweep(problem: &Problem, p: &mut DVector<f64>, tolerance: f64, most: usize) -> usize {
    let G = &problem.G;
    let mut u = problem.velocity(p);
    for done in 1..=most {
        let mut largest = 0.0_f64;
        for (first, law) in problem.blocks() {
            let mut change = [0.0; 3];
            if let Law::Contact { mu } = law {
                let block: Matrix3<f64> = G.fixed_view::<3, 3>(first, first).into_owned();
                let mut c = [u[first], u[first + 1], u[first + 2]];
                for r in 0..3 {
                    c[r] -= (0..3).map(|k| block[(r, k)] * p[first + k]).sum::<f64>();
                }
                let new = point_contact(&block, c, mu);
                for k in 0..3 {
                    change[k] = new[k] - p[first + k];
                    p[first + k] = new[k];
                }
            } else {
                let g = G[(first, first)];
                if g <= 0.0 {
                    continue;
                }
                let mut new = [p[first] - u[first] / g];
                law.project(&mut new);
                change[0] = new[0] - p[first];
                p[first] = new[0];
            }
            for k in 0..law.rows() {
                if change[k] != 0.0 {
                    u.axpy(change[k], &G.column(first + k), 1.0);
                    largest = largest.max((G[(first + k, first + k)] * change[k]).abs());
                }
            }
        }
        if largest <= tolerance {
            return done;
        }
    }
    most
}
