//! The columns of ∂θ̈ on their way from their joint outward; see `mod.rs`.

use crate::dynamics::base_rates::BaseRates;
use crate::linalg::Vec3;
use crate::model::Model;
use crate::scalar::Scalar;
use crate::spatial::{Twist, Wrench};
use crate::workspace::{Columns, LongLimbs, Passed, Source, Turned, W};

/// The columns of a floating base's six axes. They start at the base with a + r = −Φ𝓑̂s.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn columns_of_base<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    rates: [BaseRates<S>; 2],
    limbs: &mut LongLimbs<S>,
    matrices: &mut [&mut [S]; 3],
) {
    let (n, Source { Phi, B_hat, .. }) = (model.n(), limbs.sources[0]);
    let mut now = Columns::filled_with(S::zero());
    for (e, axis) in Twist::axes().into_iter().enumerate() {
        let [(r, s), (r_rates, s_rates)] = [rates[0].of(axis), rates[1].of(axis)];
        let a = times(&Phi, (-product(B_hat, s)).to_array());
        let a_rates = times(&Phi, (-product(B_hat, s_rates)).to_array());
        let (r, r_rates) = (r.to_array(), r_rates.to_array());
        for k in 0..6 {
            (now.a[0][k][e], now.a[1][k][e], now.a[2][k][e]) = (Phi[k][e], a[k], a_rates[k]);
            matrices[0][k * n + e] = Phi[k][e];
            matrices[1][k * n + e] = a[k] - r[k];
            matrices[2][k * n + e] = a_rates[k] - r_rates[k];
        }
        for k in 0..3 {
            (now.s[0][k][e], now.s[1][k][e]) = (s.0[k], s_rates.0[k]);
        }
    }
    if model.structure.forks[0] {
        limbs.at_forks[0] = now;
    }
    let mut tile = [[[S::zero(); W]; W]; 3];
    let block = Block { first: 1, c: 0, width: 6, e: [[S::zero(); W]; 2] };
    for i in 1..=model.links.len() {
        let x = now.pass(model, i, limbs);
        block.write(model, i, &now, x, 6, limbs, matrices, &mut tile);
    }
}

/// Up to W columns, starting at a slot.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn columns_of_joints<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    first: usize,
    limbs: &mut LongLimbs<S>,
    matrices: &mut [&mut [S]; 3],
) {
    let links = model.links.len();
    let width = W.min(links + 1 - first);
    let mut tile = [[[S::zero(); W]; W]; 3];
    let mut block = Block { first, c: model.n() - links + first - 1, width, e: [[S::zero(); W]; 2] };
    if !limbs.at_forks.is_empty() {
        for w in 0..width {
            start_at_forks(model, first + w, w, limbs);
        }
    }
    let mut now = Columns::filled_with(S::zero());
    for w in 0..width {
        let i = first + w;
        let mut x = match w {
            0 => [[S::zero(); W]; 3],
            _ => now.pass(model, i, limbs),
        };
        let (source, s) = (&limbs.sources[i], [limbs.turned[i].by_theta.1, limbs.turned[i].by_rates.1]);
        for k in 0..3 {
            for r in 0..6 {
                now.a[k][r][w] = source.a[k][r];
            }
        }
        for k in 0..2 {
            for r in 0..3 {
                now.s[k][r][w] = s[k].0[r];
            }
            block.e[k][w] = limbs.passed[i].minus_e[k];
        }
        x[0][w] = source.x;
        block.write(model, i, &now, x, w + 1, limbs, matrices, &mut tile);
    }
    let (mut now, block) = (now, block);
    for i in first + width..=links {
        let x = now.pass(model, i, limbs);
        block.write(model, i, &now, x, width, limbs, matrices, &mut tile);
    }
}

/// Sets column w, of the joint of slot i, at the links between it and the base that another limb branches off from:
/// a = −ΦP, the wrench P being what is left of Q or of the force at the joint.
#[cfg_attr(not(debug_assertions), inline(always))]
fn start_at_forks<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, i: usize, w: usize, limbs: &mut LongLimbs<S>) {
    let LongLimbs { turned, passed, sources, at_forks, .. } = limbs;
    let at = &passed[i];
    let [Q, Q_rates] = at.minus_Q;
    // −P
    let mut minus_P = [Wrench::from_array(at.minus_U), at.passed_on(&turned[i], Q), at.passed_on(&turned[i], Q_rates)];
    let mut q = model.links[i - 1].parent;
    loop {
        if model.structure.forks[q] {
            for k in 0..3 {
                let a = times(&sources[q].Phi, minus_P[k].to_array());
                for r in 0..6 {
                    at_forks[q].a[k][r][w] = a[r];
                }
            }
            for s in at_forks[q].s.as_flattened_mut() {
                s[w] = S::zero();
            }
        }
        if q == 0 {
            break;
        }
        for P in &mut minus_P {
            *P = passed[q].passed_on(&turned[q], P.to_array());
        }
        q = model.links[q - 1].parent;
    }
}

impl<S: Scalar> Passed<S> {
    /// (1 − U Aᵀ) P about the parent's origin.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn passed_on(&self, link: &Turned<S>, P: [S; 6]) -> Wrench<S> {
        let P = Wrench::from_array(P);
        P.about(link.p) + Wrench::from_array(self.minus_U) * link.A.dot(P)
    }
}

impl<S: Scalar> Columns<S> {
    /// Moves from the parent to a link, and returns x.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn pass<C: Scalar>(&mut self, model: &Model<C>, i: usize, limbs: &LongLimbs<S>) -> [[S; W]; 3] {
        let (at, parent) = (&limbs.passed[i], model.links[i - 1].parent);
        if parent + 1 != i {
            *self = limbs.at_forks[parent];
        }
        let mut x = [[S::zero(); W]; 3];
        for k in 0..3 {
            let (a, mut by_force) = (&mut self.a[k], [S::zero(); W]);
            if k > 0 {
                for r in 0..3 {
                    add(&mut by_force, at.minus_y[r], self.s[k - 1][r]);
                }
            }
            for r in 0..3 {
                add(&mut x[k], at.minus_U[r], a[r]);
                add(&mut by_force, at.minus_U[r + 3], a[r + 3]);
            }
            for w in 0..W {
                x[k][w] += by_force[w];
            }
            shift_rows(a, at.p);
            for r in 0..6 {
                add(&mut a[r], at.A[r], x[k]);
            }
        }
        x
    }
}

/// W columns, of joints that follow each other, or the base's six.
struct Block<S> {
    /// The first slot that they pass.
    first: usize,
    /// The first column.
    c: usize,
    width: usize,
    /// −e of their joints, by θ and by θ̇.
    e: [[S; W]; 2],
}

impl<S: Scalar> Block<S> {
    /// Writes row i of the columns, and column i of their rows; keeps the columns if another limb branches off. `count`
    /// columns have started.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[allow(clippy::too_many_arguments)]
    fn write<C: Scalar>(
        &self,
        model: &Model<C>,
        i: usize,
        now: &Columns<S>,
        mut x: [[S; W]; 3],
        count: usize,
        limbs: &mut LongLimbs<S>,
        matrices: &mut [&mut [S]; 3],
        tile: &mut [[[S; W]; W]; 3],
    ) {
        if model.structure.forks[i] {
            limbs.at_forks[i].copy_from(now, count);
        }
        let (n, at) = (model.n(), &limbs.passed[i]);
        let (j, t) = (n - model.links.len() + i - 1, (i - self.first) % W);
        // columns of the rows: −aᵀQ_j
        tile[0][t] = x[0];
        for k in 0..2 {
            let y = &mut tile[k + 1][t];
            for w in 0..W {
                y[w] = x[0][w] * at.minus_e[k];
            }
            for r in 0..6 {
                add(y, at.minus_Q[k][r], now.a[0][r]);
            }
        }
        // rows of the columns
        for k in 0..2 {
            for w in 0..W {
                x[k + 1][w] = x[0][w].mul_add(self.e[k][w], x[k + 1][w]);
            }
        }
        for k in 0..3 {
            set_row(&mut matrices[k][j * n + self.c..], &x[k], self.width);
        }
        if t + 1 == W || i == model.links.len() {
            let from = j - t;
            for k in 0..3 {
                if t + 1 == W && self.width == W && from != self.c {
                    for w in 0..W {
                        let row: &mut [S] = &mut matrices[k][(self.c + w) * n + from..][..W];
                        for t in 0..W {
                            row[t] = tile[k][t][w];
                        }
                    }
                } else {
                    for w in 0..self.width {
                        let started = if self.c == from { w } else { 0 };
                        for t in started..=t {
                            matrices[k][(self.c + w) * n + from + t] = tile[k][t][w];
                        }
                    }
                }
            }
        }
    }
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn set_row<S: Scalar>(X: &mut [S], x: &[S; W], width: usize) {
    if width == W {
        X[..W].copy_from_slice(x);
    } else {
        X[..width].copy_from_slice(&x[..width]);
    }
}

/// 𝓑̂s.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn product<S: Scalar>([x, y, z]: [Wrench<S>; 3], s: Vec3<S>) -> Wrench<S> {
    x * s.0[0] + y * s.0[1] + z * s.0[2]
}

/// Φ F, Φ being symmetric.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn times<S: Scalar>(Phi: &[[S; 6]; 6], F: [S; 6]) -> [S; 6] {
    let mut a = [S::zero(); 6];
    for r in 0..6 {
        add(&mut a, F[r], Phi[r]);
    }
    a
}

/// y += k x.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn add<const K: usize, S: Scalar>(y: &mut [S; K], k: S, x: [S; K]) {
    for w in 0..K {
        y[w] = x[w].mul_add(k, y[w]);
    }
}

/// Adds p × ω to v, p = (x, y, z), for K twists at once as structure of arrays.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
pub(super) fn shift_rows<const K: usize, S: Scalar>(a: &mut [[S; K]; 6], [x, y, z]: [S; 3]) {
    let [f, g, h, ..] = *a;
    add(&mut a[3], y, h); add(&mut a[3], -z, g);
    add(&mut a[4], z, f); add(&mut a[4], -x, h);
    add(&mut a[5], x, g); add(&mut a[5], -y, f);
}
