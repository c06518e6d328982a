//! A generalized derivative of Alart and Curnier's function, factored.

use super::law::norm;
use super::newton::{Function, Side};
use super::scaled::Scaled;
use super::{Law, Problem};
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector, Dyn, LU};

/// A system with more than so many times as many rows as the robot has velocities is solved by one of the velocities.
const LOW_RANK: usize = 2;
/// (E + ε)⁻¹ is up to 10⁸, so that such a solution has eight digits: it is refined.
const REFINED: usize = 3;

/// A generalized derivative F' + ε of F, factored.
pub(super) struct Derivative {
    sides: Vec<Side>,
    weight: f64,
    /// The rows that are not at their bounds, where F' is not just 1 on the diagonal.
    free: Vec<usize>,
    /// The blocks of these rows: F' = E + P G there.
    blocks: Vec<Block>,
    factors: Factors,
}

/// The factors of E + P G + ε in the free rows and columns.
enum Factors {
    Dense(LU<f64, Dyn, Dyn>),
    /// With G = Y Yᵀ and B = P Y: those of 1 + Yᵀ(E + ε)⁻¹B, of as many rows as the robot has velocities.
    LowRank {
        Y: DMatrix<f64>,
        B: DMatrix<f64>,
        lu: LU<f64, Dyn, Dyn>,
    },
}

/// A block of free rows, which begins at one of them.
struct Block {
    at: usize,
    rows: usize,
    slides: Option<Sliding>,
}

/// A contact that slides: μ, the direction d of p_t − u_t, and the radius of its disc by the size of p_t − u_t.
struct Sliding {
    mu: f64,
    d: [f64; 2],
    turn: f64,
}

impl Block {
    /// x ← (E + ε)⁻¹x.
    fn divide(&self, x: &mut [f64], epsilon: f64) {
        let x = &mut x[self.at..][..self.rows];
        let Some(Sliding { mu, d, turn }) = &self.slides else {
            x.iter_mut().for_each(|x| *x /= epsilon);
            return;
        };
        x[0] /= epsilon;
        let v = [x[1] + mu * d[0] * x[0], x[2] + mu * d[1] * x[0]];
        let (across, along) = (1.0 - turn + epsilon, d[0] * v[0] + d[1] * v[1]);
        let more = along * (1.0 / (1.0 + epsilon) - 1.0 / across);
        (x[1], x[2]) = (v[0] / across + d[0] * more, v[1] / across + d[1] * more);
    }

    /// y ← y + (E + ε)x.
    fn multiply_add(&self, x: &[f64], epsilon: f64, y: &mut [f64]) {
        let (x, y) = (&x[self.at..][..self.rows], &mut y[self.at..][..self.rows]);
        for (y, x) in y.iter_mut().zip(x) {
            *y += epsilon * x;
        }
        if let Some(Sliding { mu, d, turn }) = &self.slides {
            let along = turn * (d[0] * x[1] + d[1] * x[2]) - mu * x[0];
            for k in 0..2 {
                y[1 + k] += (1.0 - turn) * x[1 + k] + d[k] * along;
            }
        }
    }

    /// x ← P x.
    fn project(&self, x: &mut [f64]) {
        let x = &mut x[self.at..][..self.rows];
        if let Some(Sliding { mu, d, turn }) = &self.slides {
            let along = mu * x[0] - turn * (d[0] * x[1] + d[1] * x[2]);
            for k in 0..2 {
                x[1 + k] = turn * x[1 + k] + d[k] * along;
            }
        }
    }
}

impl Derivative {
    pub fn new(Scaled { problem, root, .. }: &Scaled, p: &DVector<f64>, at: &Function, weight: f64) -> Self {
        let (mut free, mut blocks) = (Vec::with_capacity(p.len()), Vec::with_capacity(at.sides.len()));
        for ((i, law), side) in problem.blocks().zip(&at.sides) {
            let slides = match (side, law) {
                (Side::Bound, _) => continue,
                (Side::Slides, Law::Contact { mu }) => {
                    let [x_n, x_1, x_2] = [i, i + 1, i + 2].map(|r| p[r] - at.u[r]);
                    let size = norm(x_1, x_2);
                    Some(Sliding { mu, d: [x_1 / size, x_2 / size], turn: mu * x_n / size })
                }
                _ => None,
            };
            blocks.push(Block { at: free.len(), rows: law.rows(), slides });
            free.extend(i..i + law.rows());
        }
        let f = free.len();
        let project = |mut A: DMatrix<f64>| {
            for mut column in A.column_iter_mut() {
                blocks.iter().for_each(|block| block.project(column.as_mut_slice()));
            }
            A
        };
        let factors = match root {
            Some(R) if LOW_RANK * R.nrows() < f => {
                let Y = R.select_columns(&free).transpose();
                let B = project(Y.clone());
                let mut divided = B.clone();
                for mut column in divided.column_iter_mut() {
                    blocks.iter().for_each(|block| block.divide(column.as_mut_slice(), weight));
                }
                let mut S = Y.tr_mul(&divided);
                (0..S.nrows()).for_each(|k| S[(k, k)] += 1.0);
                Factors::LowRank { Y, B, lu: S.lu() }
            }
            _ => {
                let m = p.len();
                let G = problem.G.as_slice();
                let mut A = project(DMatrix::from_fn(f, f, |i, j| G[free[j] * m + free[i]]));
                let (mut unit, mut column) = (alloc::vec![0.0; f], alloc::vec![0.0; f]);
                for block in &blocks {
                    for c in block.at..block.at + block.rows {
                        unit[c] = 1.0;
                        block.multiply_add(&unit, weight, &mut column);
                        for r in block.at..block.at + block.rows {
                            A[(r, c)] += core::mem::take(&mut column[r]);
                        }
                        unit[c] = 0.0;
                    }
                }
                Factors::Dense(A.lu())
            }
        };
        Derivative { sides: at.sides.clone(), weight, free, blocks, factors }
    }

    /// True if no block has changed sides.
    pub fn is_of(&self, at: &Function) -> bool {
        self.sides == at.sides
    }

    /// p⁺ − p. Rows at their bounds give theirs at once, −F; a system of the others remains.
    pub fn step(
        &self,
        problem: &Problem,
        p: &DVector<f64>,
        F: &DVector<f64>,
        best: &DVector<f64>,
    ) -> Option<DVector<f64>> {
        let mut x = -F;
        if self.free.is_empty() {
            return Some(x);
        }
        self.free.iter().for_each(|&r| x[r] = 0.0);
        let mut right = (&problem.G * &x).select_rows(&self.free);
        self.blocks.iter().for_each(|block| block.project(right.as_mut_slice()));
        for (i, &r) in self.free.iter().enumerate() {
            right[i] = -right[i] - F[r] - self.weight * (p[r] - best[r]);
        }
        match &self.factors {
            Factors::Dense(lu) => {
                if !lu.solve_mut(&mut right) {
                    return None;
                }
            }
            Factors::LowRank { Y, B, lu } => {
                let mut found = DVector::zeros(right.len());
                for _ in 0..REFINED {
                    let mut change = right.clone();
                    self.divide(&mut change);
                    let mut inner = Y.tr_mul(&change);
                    if !lu.solve_mut(&mut inner) {
                        return None;
                    }
                    let mut less = B * inner;
                    self.divide(&mut less);
                    change -= less;
                    // what is left
                    let mut product = B * Y.tr_mul(&change);
                    let (y, x) = (product.as_mut_slice(), change.as_slice());
                    self.blocks.iter().for_each(|block| block.multiply_add(x, self.weight, y));
                    right -= product;
                    found += change;
                }
                right = found;
            }
        }
        self.free.iter().enumerate().for_each(|(i, &r)| x[r] = right[i]);
        Some(x)
    }

    fn divide(&self, x: &mut DVector<f64>) {
        self.blocks.iter().for_each(|block| block.divide(x.as_mut_slice(), self.weight));
    }
}
