//! The estimate of bodies that exist: a convex problem in the pseudo-inertias, solved by damped Newton steps.

use super::pseudo_inertia::{Prior, basis};
use crate::Error;
use crate::compress::Triangle;
use nalgebra::{DMatrix, DVector, Matrix4};

/// The weight of the barriers that keep friction and armature positive.
const BARRIER: f64 = 1e-5;

/// Newton's steps, at most, for each weight of the prior.
const STEPS: usize = 200;
/// Where no step is better, less than this share of the cost to gain is rounding.
const ROUNDING: f64 = 1e-6;

/// A linear bound: Σ a x > least.
#[derive(Clone, Debug, PartialEq)]
pub struct Bound {
    /// Name for messages.
    pub name: String,
    /// Unknowns and their factors.
    pub terms: Vec<(usize, f64)>,
    /// The least value.
    pub least: f64,
    /// A typical size of the left side.
    pub scale: f64,
}

/// The problem apart from the data: which unknowns are bodies and which are positive.
#[derive(Clone, Debug)]
pub struct Problem {
    /// First unknown and prior of each body, and the weight of the prior relative to γ.
    pub bodies: Vec<(usize, Prior, f64)>,
    /// Unknowns that are positive.
    pub positive: Vec<usize>,
    /// Unknowns of either sign, of which the robot has the positive part.
    pub split: Vec<usize>,
    /// Unknowns that are fixed at 0, because no motion separates them from others.
    pub pinned: Vec<usize>,
    /// Further bounds.
    pub bounds: Vec<Bound>,
    /// γ: the weight of the prior, relative to the weighted squared error per sample.
    pub gamma: f64,
    /// Prior values of all unknowns, where the search begins.
    pub start: Vec<f64>,
}

/// The optimum.
#[derive(Clone, Debug)]
pub struct Optimum {
    /// The unknowns, of a robot that can exist.
    pub x: Vec<f64>,
    /// Additional parts of the unknowns in predictions: friction with memory or that falls with speed, a delay.
    pub apparent: Vec<f64>,
    /// Standard deviations from the noise alone, for one independent sample: the prior is held fixed.
    pub deviations: Vec<f64>,
    /// How much of each unknown's certainty comes from the prior, 0 to 1.
    pub prior_share: Vec<f64>,
    /// Newton's steps.
    pub steps: usize,
    /// The cost: weighted squared error per sample, and the divergence times γ.
    pub cost: f64,
    /// Whether it was stopped before the optimum.
    pub is_stopped: bool,
    /// Whether the search ended without the optimum: x may be far from it.
    pub is_astray: bool,
}

/// How a search with one weight of the prior ended.
#[derive(Clone, Copy, PartialEq)]
enum End {
    Optimum,
    Stopped,
    /// In too many steps, or where no step is better.
    Astray,
}

impl Optimum {
    /// The unknowns that predict: the robot's with what is apparent.
    pub fn predicting(&self) -> Vec<f64> {
        self.x.iter().zip(&self.apparent).map(|(x, more)| x + more).collect()
    }
}

impl Problem {
    /// The problem without apparent unknowns, for the robot alone.
    pub fn of_robot(&self) -> Problem {
        let positive = self.positive.iter().chain(&self.split).copied().collect();
        Problem { positive, split: Vec::new(), ..self.clone() }
    }

    /// Minimizes
    ///
    /// > ‖R x − z‖² + γ Σ_i (tr(J₀ᵢ⁻¹Jᵢ) − log det(J₀ᵢ⁻¹Jᵢ) − 4) + ε Σ (f − log f − 1)
    ///
    /// over links with pseudo-inertias Jᵢ and positive unknowns f, relative to the size that matters to the data. Jᵢ is
    /// linear in x, so the problem is convex and has one optimum. Unknowns are whitened, J = C W Cᵀ with J₀ = C Cᵀ; γ
    /// decreases by decades from the data's cost at the start, each solution the start of the next: a Newton step from
    /// afar would lead to the edge of the cone. `stop` is polled before each step.
    ///
    /// # Errors
    /// [`Error::Infeasible`] if a bound excludes every start; [`Error::NotExciting`] if an unknown has neither data nor
    /// a prior.
    pub fn solve(&self, data: &Triangle, stop: &dyn Fn() -> bool) -> Result<Optimum, Error> {
        let newton = Newton::new(self, data);
        let mut y = newton.start()?;
        let mut steps = 0;
        // γ times the least weight is the data's cost at the start
        let cost = newton.cost(&y, 0.0);
        let mut gamma = self.bodies.iter().map(|(_, _, weight)| cost / weight).fold(self.gamma, f64::max);
        let end = loop {
            let is_last = gamma <= 1.01 * self.gamma;
            gamma = if is_last { self.gamma } else { gamma };
            let tolerance = if is_last { 1e-10 } else { 1e-4 };
            let end = newton.minimize(&mut y, gamma, tolerance, &mut steps, stop)?;
            if is_last || end == End::Stopped {
                break end;
            }
            gamma = (0.1 * gamma).max(self.gamma);
        };
        newton.optimum(y, gamma, steps, end)
    }
}

pub(crate) struct Newton<'p> {
    problem: &'p Problem,
    P: usize,
    /// Whitened triangle, and what no x can reach.
    R: DMatrix<f64>,
    z: DVector<f64>,
    rest: f64,
    /// 2RᵀR + a ridge.
    H: DMatrix<f64>,
    /// From whitened to plain unknowns.
    pub(crate) T: DMatrix<f64>,
    basis: [Matrix4<f64>; 10],
    /// Sizes of positive unknowns that matter to the data.
    sizes: Vec<f64>,
    /// Bounds in whitened unknowns.
    bounds: Vec<DVector<f64>>,
}

impl<'p> Newton<'p> {
    pub(crate) fn new(problem: &'p Problem, data: &Triangle) -> Self {
        let P = data.unknowns();
        let mut T = DMatrix::identity(P, P);
        for (first, prior, _) in &problem.bodies {
            T.view_mut((*first, *first), (10, 10)).copy_from(&prior.map());
        }
        problem.pinned.iter().for_each(|&k| T[(k, k)] = 0.0);
        let plain = data.R.view((0, 0), (P, P)).clone_owned();
        let sizes = problem.positive.iter().map(|&k| {
            let norm = plain.column(k).norm();
            if norm > 0.0 { 1.0 / norm } else { 1.0 }
        });
        let (sizes, R) = (sizes.collect(), &plain * &T);
        let mut H = 2.0 * R.tr_mul(&R);
        let ridge = 1e-12 * (0..P).map(|k| H[(k, k)]).fold(0.0, f64::max) + f64::MIN_POSITIVE;
        (0..P).for_each(|k| H[(k, k)] += ridge);
        let bounds = problem.bounds.iter().map(|bound| {
            let mut a = DVector::zeros(P);
            bound.terms.iter().for_each(|&(k, factor)| a[k] += factor);
            T.tr_mul(&a)
        });
        let bounds = bounds.collect();
        let z = DVector::from_iterator(P, (0..P).map(|k| data.R[(k, P)]));
        Newton { problem, P, R, z, rest: data.R[(P, P)].powi(2), H, T, basis: basis(), sizes, bounds }
    }

    /// W of a body.
    fn body(&self, y: &DVector<f64>, first: usize) -> Matrix4<f64> {
        self.basis.iter().enumerate().fold(Matrix4::zeros(), |W, (k, B)| W + y[first + k] * B)
    }

    /// The prior, or, where a bound excludes it, a body in the middle of its bounds.
    fn start(&self) -> Result<DVector<f64>, Error> {
        let mut y = DVector::from_column_slice(&self.problem.start);
        for (first, ..) in &self.problem.bodies {
            (0..10).for_each(|k| y[first + k] = self.basis[k].trace());
        }
        for (&k, size) in self.problem.positive.iter().zip(&self.sizes) {
            y[k] = self.problem.start[k].max(0.1 * size);
        }
        // towards the bounds that are violated, by projections, inside the cone
        for _ in 0..2000 {
            let Some(b) = (0..self.bounds.len()).find(|&b| !(self.slack(&y, b) > 1e-6)) else {
                return if self.cost(&y, 1.0).is_finite() { Ok(y) } else { self.infeasible(&y) };
            };
            let (a, bound) = (&self.bounds[b], &self.problem.bounds[b]);
            let step = (1e-3 - self.slack(&y, b)) * bound.scale / a.norm_squared();
            let mut t = 1.0;
            while t > 1e-6 && !self.is_inside(&(&y + a * (t * step))) {
                t *= 0.5;
            }
            if t <= 1e-6 {
                break;
            }
            y += a * (t * step);
        }
        self.infeasible(&y)
    }

    fn infeasible(&self, y: &DVector<f64>) -> Result<DVector<f64>, Error> {
        let violated = (0..self.bounds.len()).filter(|&b| !(self.slack(y, b) > 0.0));
        let mut names: Vec<&str> = violated.map(|b| self.problem.bounds[b].name.as_str()).collect();
        names.dedup(); // a box is six bounds
        let what = match names.is_empty() {
            true => "no point satisfies all of them in double precision; a number is infinite or far too large".into(),
            false => names.join(", "),
        };
        Err(Error::Infeasible { what })
    }

    /// A bound's left side above its least, relative to its size.
    fn slack(&self, y: &DVector<f64>, b: usize) -> f64 {
        (self.bounds[b].dot(y) - self.problem.bounds[b].least) / self.problem.bounds[b].scale
    }

    /// True if all bodies and positive unknowns are inside their cones.
    fn is_inside(&self, y: &DVector<f64>) -> bool {
        self.problem.positive.iter().all(|&k| y[k] > 0.0)
            && self.problem.bodies.iter().all(|(first, ..)| self.body(y, *first).cholesky().is_some())
    }

    /// The cost; infinite outside of the cones.
    pub(crate) fn cost(&self, y: &DVector<f64>, gamma: f64) -> f64 {
        let mut cost = (&self.R * y - &self.z).norm_squared();
        for (first, _, weight) in &self.problem.bodies {
            let W = self.body(y, *first);
            let Some(L) = W.cholesky() else { return f64::INFINITY };
            let log_det = 2.0 * (0..4).map(|k| L.l_dirty()[(k, k)].ln()).sum::<f64>();
            cost += gamma * weight * (W.trace() - log_det - 4.0);
        }
        for (&k, size) in self.problem.positive.iter().zip(&self.sizes) {
            let f = y[k] / size;
            if !(f > 0.0) {
                return f64::INFINITY;
            }
            cost += BARRIER * (f - f.ln() - 1.0);
        }
        for b in 0..self.bounds.len() {
            let s = self.slack(y, b);
            if !(s > 0.0) {
                return f64::INFINITY;
            }
            cost -= BARRIER * s.ln();
        }
        cost
    }

    /// The gradient, and the Hessian without that of the data.
    pub(crate) fn derivatives(&self, y: &DVector<f64>, gamma: f64) -> (DVector<f64>, DMatrix<f64>) {
        let mut g = 2.0 * self.R.tr_mul(&(&self.R * y - &self.z));
        let mut H = DMatrix::zeros(self.P, self.P);
        for (first, _, weight) in &self.problem.bodies {
            let Some(inverse) = self.body(y, *first).try_inverse() else { continue };
            let M: Vec<Matrix4<f64>> = self.basis.iter().map(|B| inverse * B).collect();
            for k in 0..10 {
                g[first + k] += gamma * weight * (self.basis[k].trace() - M[k].trace());
                for l in 0..=k {
                    let entry = gamma * weight * M[k].dot(&M[l].transpose());
                    H[(first + k, first + l)] += entry;
                    if l < k {
                        H[(first + l, first + k)] += entry;
                    }
                }
            }
        }
        for (&k, size) in self.problem.positive.iter().zip(&self.sizes) {
            g[k] += BARRIER * (1.0 / size - 1.0 / y[k]);
            H[(k, k)] += BARRIER / (y[k] * y[k]);
        }
        for (b, a) in self.bounds.iter().enumerate() {
            let s = self.slack(y, b) * self.problem.bounds[b].scale;
            g.axpy(-BARRIER / s, a, 1.0);
            H.ger(BARRIER / (s * s), a, a, 1.0);
        }
        (g, H)
    }

    /// L⁻ᵀ of the cost's Hessian L Lᵀ: steps of its columns change the cost alike.
    ///
    /// # Errors
    /// [`Error::NotExciting`] if the Hessian is singular.
    pub(crate) fn directions(&self, y: &DVector<f64>, gamma: f64) -> Result<DMatrix<f64>, Error> {
        let (_, prior) = self.derivatives(y, gamma);
        let factor = self.factor(&self.H + prior)?;
        let singular = || Error::NotExciting { reason: "the equations are singular".into() };
        let L = factor.cholesky.l();
        let mut S = L.transpose().solve_upper_triangular(&DMatrix::identity(self.P, self.P)).ok_or_else(singular)?;
        S.row_iter_mut().zip(&factor.scale).for_each(|(mut row, scale)| row.scale_mut(*scale));
        Ok(S)
    }

    /// Whitened unknowns from plain ones.
    pub(crate) fn whitened(&self, x: &[f64]) -> Option<DVector<f64>> {
        let mut T = self.T.clone();
        self.problem.pinned.iter().for_each(|&k| T[(k, k)] = 1.0);
        T.lu().solve(&DVector::from_column_slice(x))
    }

    /// Solves with a positive definite matrix, its diagonal scaled to 1.
    fn factor(&self, H: DMatrix<f64>) -> Result<Factor, Error> {
        let scale = DVector::from_iterator(self.P, (0..self.P).map(|k| 1.0 / H[(k, k)].max(f64::MIN_POSITIVE).sqrt()));
        let mut H = H;
        for k in 0..self.P {
            for i in 0..self.P {
                H[(i, k)] *= scale[i] * scale[k];
            }
            H[(k, k)] += 1e-13;
        }
        let reason = || "the equations are singular: an unknown has neither data nor a prior".to_string();
        let cholesky = H.cholesky().ok_or_else(|| Error::NotExciting { reason: reason() })?;
        Ok(Factor { cholesky, scale })
    }

    /// Damped Newton steps.
    fn minimize(
        &self,
        y: &mut DVector<f64>,
        gamma: f64,
        tolerance: f64,
        steps: &mut usize,
        stop: &dyn Fn() -> bool,
    ) -> Result<End, Error> {
        let mut cost = self.cost(y, gamma);
        for _ in 0..STEPS {
            if stop() {
                return Ok(End::Stopped);
            }
            *steps += 1;
            let (g, H) = self.derivatives(y, gamma);
            let step = -self.factor(&self.H + H)?.solve(&g);
            let decrement = -g.dot(&step);
            let share = 0.5 * decrement / cost.abs().max(1e-12);
            if !(share > tolerance) {
                return Ok(if share.is_nan() { End::Astray } else { End::Optimum });
            }
            let mut t = 1.0;
            loop {
                let next = &*y + t * &step;
                let at = self.cost(&next, gamma);
                if at <= cost - 0.1 * t * decrement {
                    (*y, cost) = (next, at);
                    break;
                }
                t *= 0.5;
                if t < 1e-12 {
                    return Ok(if share < ROUNDING { End::Optimum } else { End::Astray });
                }
            }
        }
        Ok(End::Astray)
    }

    fn optimum(&self, y: DVector<f64>, gamma: f64, steps: usize, end: End) -> Result<Optimum, Error> {
        let (_, prior) = self.derivatives(&y, gamma);
        let factor = self.factor(&self.H + &prior)?;
        // rows of T times H⁻¹: one solve for each unknown
        let mut sensitivities = self.T.transpose();
        let (mut deviations, mut prior_share) = (Vec::with_capacity(self.P), Vec::with_capacity(self.P));
        for k in 0..self.P {
            let column = sensitivities.column(k).clone_owned();
            let solved = factor.solve(&column);
            let (total, of_prior) = (column.dot(&solved), solved.dot(&(&prior * &solved)));
            deviations.push((2.0 * (&self.R * &solved).norm()).max(0.0));
            prior_share.push(if total > 0.0 { (of_prior / total).clamp(0.0, 1.0) } else { 1.0 });
            sensitivities.set_column(k, &solved);
        }
        let cost = self.cost(&y, gamma) + self.rest;
        let x: Vec<f64> = (&self.T * y).iter().copied().collect();
        let apparent = vec![0.0; self.P];
        let (is_stopped, is_astray) = (end == End::Stopped, end == End::Astray);
        Ok(Optimum { x, apparent, deviations, prior_share, steps, cost, is_stopped, is_astray })
    }
}

struct Factor {
    cholesky: nalgebra::Cholesky<f64, nalgebra::Dyn>,
    scale: DVector<f64>,
}

impl Factor {
    fn solve(&self, rhs: &DVector<f64>) -> DVector<f64> {
        self.cholesky.solve(&rhs.component_mul(&self.scale)).component_mul(&self.scale)
    }
}
