//! Information content of a motion, and its gradient with respect to the coefficients.

use super::{Basis, ExciteOptions, MotionLimits, lbfgs, state};
use crate::Error;
use crate::columns::{Columns, Equations, Kind};
use crate::rotors::rate;
use crate::signals::Samples;
use mozzi::quantities::{InverseDynamics, InverseDynamicsVjp, Query};
use mozzi::random::Random;
use mozzi::{BaseParameters, fast};
use nalgebra::{DMatrix, DVector};

/// The minimized cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Goal {
    /// −log det of the information YᵀΣ⁻¹Y: the volume of the confidence ellipsoid.
    #[default]
    LogDet,
    /// The logarithm of its condition number, with the units of the first motion.
    Condition,
}

/// Points in time at which a motion is judged, per harmonic.
const POINTS: usize = 12;
/// Points at which limits are checked at the end, per point.
const FINE: usize = 4;
/// A motion is made smaller by this factor, and given up below the second.
const SMALLER: f64 = 0.97;
const LEAST: f64 = 1e-3;
/// Random positions from which one that keeps the limits is sought, and steps from each.
const ATTEMPTS: usize = 20;
const ATTEMPT_STEPS: usize = 200;

pub(super) struct Objective<'a, 'm> {
    columns: &'a Columns<'m>,
    base: &'a BaseParameters,
    basis: &'a Basis,
    options: &'a ExciteOptions,
    /// The one that is minimized now.
    pub goal: Goal,
    equations: Equations<'a, 'm>,
    workspace: fast::Workspace,
    times: Vec<f64>,
    /// Units of the columns: their lengths at the first motion.
    units: Option<DVector<f64>>,
}

impl<'a, 'm> Objective<'a, 'm> {
    pub fn new(
        columns: &'a Columns<'m>,
        base: &'a BaseParameters,
        basis: &'a Basis,
        options: &'a ExciteOptions,
    ) -> Result<Self, Error> {
        let count = POINTS * basis.harmonics;
        let times = (0..count).map(|k| (k as f64 + 0.5) / count as f64 * basis.duration).collect();
        Ok(Objective {
            columns,
            base,
            basis,
            options,
            goal: options.goal,
            equations: Equations::new(columns, &Samples::default())?,
            workspace: fast::Workspace::new(columns.model),
            times,
            units: None,
        })
    }

    /// The weighted base regressor at a time, n × r.
    fn rows(&mut self, c: &[f64], t: f64) -> ([Vec<f64>; 3], DMatrix<f64>) {
        let (n, P) = (self.columns.model.n(), self.columns.count());
        let at = state(self.basis, c, t);
        let (mut A, mut b, zeros) = (vec![0.0; n * P], vec![0.0; n], vec![0.0; n]);
        self.equations.at([&at[0], &at[1], &at[2], &zeros], &mut A, &mut b);
        let noise = &self.options.noise;
        let Y = DMatrix::from_fn(n, self.base.count(), |j, k| A[j * P + self.base.columns[k]] / noise[j]);
        (at, Y)
    }

    /// The information YᵀΣ⁻¹Y of one sample on average.
    fn information(&mut self, c: &[f64]) -> DMatrix<f64> {
        let r = self.base.count();
        let mut S = DMatrix::zeros(r, r);
        for t in self.times.clone() {
            let (_, Y) = self.rows(c, t);
            S.gemm_tr(1.0, &Y, &Y, 1.0);
        }
        S / self.times.len() as f64
    }

    /// The goal and `weight` times the squared excess of limits, with the gradient by the coefficients. A weight of 0
    /// leaves the limits out.
    pub fn value(&mut self, c: &[f64], weight: f64) -> (f64, Vec<f64>) {
        let model = self.columns.model;
        let (n, r, count) = (model.n(), self.base.count(), self.times.len() as f64);
        let mut S = self.information(c);
        if self.units.is_none() {
            let units = DVector::from_iterator(r, (0..r).map(|k| S[(k, k)].sqrt()));
            let most = units.max();
            self.units = Some(units.map(|u| u.max(1e-6 * most)));
        }
        let units = self.units.clone().unwrap_or_else(|| DVector::from_element(r, 1.0));
        let scaled = |M: &mut DMatrix<f64>| {
            for k in 0..r {
                for i in 0..r {
                    M[(i, k)] /= units[i] * units[k];
                }
            }
        };
        scaled(&mut S);
        (0..r).for_each(|k| S[(k, k)] += 1e-9);
        let eigen = S.symmetric_eigen();
        let (value, mut G) = goal(self.goal, &eigen);
        scaled(&mut G); // the derivative by the information in its own units
        let mut value = value;
        let mut gradient = vec![0.0; c.len()];
        for t in self.times.clone() {
            let (at, Y) = self.rows(c, t);
            let mut slopes: [Vec<f64>; 3] = core::array::from_fn(|_| vec![0.0; n]);
            self.add_slopes(&at, &(&Y * &G * (2.0 / count)), &mut slopes);
            if weight > 0.0 {
                let mut over: [Vec<f64>; 3] = core::array::from_fn(|_| vec![0.0; n]);
                value += weight / count * self.excess(&self.options.limits, &at, &mut over);
                for (sum, x) in slopes.iter_mut().flatten().zip(over.iter().flatten()) {
                    *sum += weight / count * x;
                }
            }
            let shares = self.basis.at(t);
            for j in 0..n {
                for (k, share) in shares.iter().enumerate() {
                    gradient[j * shares.len() + k] += (0..3).map(|order| slopes[order][j] * share[order]).sum::<f64>();
                }
            }
        }
        (value, gradient)
    }

    /// Adds Σ_j g_jᵀ ∂y_j by θ, θ̇ and θ̈, y_j being the rows of the weighted base regressor. The row of a force is
    /// that of the inverse dynamics of a robot with the parameters g_j.
    fn add_slopes(&mut self, at: &[Vec<f64>; 3], g: &DMatrix<f64>, slopes: &mut [Vec<f64>; 3]) {
        let model = self.columns.model;
        let n = model.n();
        let query = Query::from(InverseDynamicsVjp);
        let shape = self.columns.choice.shape();
        let mut found: [Vec<f64>; 3] = core::array::from_fn(|_| vec![0.0; n]);
        for j in 0..n {
            let (mut pi, mut body) = (vec![0.0; model.parameter_count()], [0.0; 10]);
            // a force J_j f(J θ̇) of a rotor; f' of the joint itself
            let mut add_rotor = |r: usize, slope: &dyn Fn(f64) -> f64| {
                let J = &self.columns.rotors[r];
                let slope = J[j] * slope(rate(J, &at[1]));
                slopes[1].iter_mut().zip(J).for_each(|(sum, J)| *sum += slope * J);
            };
            let mut of_friction = 0.0;
            for (row, &column) in self.base.columns.iter().enumerate() {
                let value = g[(j, row)] / self.options.noise[j];
                match self.columns.unknowns[column].kind {
                    Kind::Link(k) | Kind::Armature(k) | Kind::Viscous(k) | Kind::Stiffness(k) => pi[k] = value,
                    Kind::Coulomb(k) if self.columns.row_of(k) == j => of_friction += value * shape.slopes(at[1][j])[0],
                    Kind::Stribeck(place) if self.columns.rows[place].contains(&j) => {
                        of_friction += value * shape.slopes(at[1][j])[1];
                    }
                    Kind::RotorViscous(r) => add_rotor(r, &|_| value),
                    Kind::RotorCoulomb(r) => add_rotor(r, &|omega| value * shape.slopes(omega)[0]),
                    Kind::Payload(k) => body[k] = value,
                    // other joints' friction, what does not depend on the motion, and what no motion is sought for
                    Kind::Coulomb(_) | Kind::Stribeck(_) | Kind::Offset(_) | Kind::Apparent(_) | Kind::Gain(_) => {}
                }
            }
            if let Some(carried) = &self.columns.payload {
                carried.add(&mut pi, &body);
            }
            slopes[1][j] += of_friction;
            let robot = model.with_parameters(&pi);
            let mut x = vec![0.0; n];
            x[j] = 1.0;
            let [a, b, c] = &mut found;
            let inputs: [&[f64]; 4] = [&at[0], &at[1], &at[2], &x];
            fast::evaluate(&query, &robot, &inputs, &model.environment(), &mut self.workspace, &mut [a, b, c]);
            for (sum, slope) in slopes.iter_mut().flatten().zip(found.iter().flatten()) {
                *sum += slope;
            }
        }
    }

    /// τ of a state.
    fn torques(&mut self, at: &[Vec<f64>; 3]) -> Vec<f64> {
        let model = self.columns.model;
        let inputs: [&[f64]; 3] = [&at[0], &at[1], &at[2]];
        let mut tau = vec![0.0; model.n()];
        let query = Query::from(InverseDynamics);
        fast::evaluate(&query, model, &inputs, &model.environment(), &mut self.workspace, &mut [&mut tau]);
        tau
    }

    /// The squared excess of limits at a state, and its gradient.
    fn excess(&mut self, limits: &MotionLimits, at: &[Vec<f64>; 3], gradient: &mut [Vec<f64>; 3]) -> f64 {
        let model = self.columns.model;
        let n = model.n();
        let mut sum = limits.excess(at, gradient);
        if limits.torque.iter().any(|limit| limit.is_finite()) {
            let tau = self.torques(at);
            let mut x = vec![0.0; n];
            for j in 0..n {
                let over = tau[j].abs() / limits.torque[j] - 1.0;
                if over > 0.0 {
                    sum += over * over;
                    x[j] = 2.0 * over * tau[j].signum() / limits.torque[j];
                }
            }
            if x.iter().any(|x| *x != 0.0) {
                let mut found: [Vec<f64>; 3] = core::array::from_fn(|_| vec![0.0; n]);
                let [a, b, c] = &mut found;
                let inputs: [&[f64]; 4] = [&at[0], &at[1], &at[2], &x];
                let query = Query::from(InverseDynamicsVjp);
                fast::evaluate(&query, model, &inputs, &model.environment(), &mut self.workspace, &mut [a, b, c]);
                for (sum, slope) in gradient.iter_mut().flatten().zip(found.iter().flatten()) {
                    *sum += slope;
                }
            }
        }
        // frames are checked when the options are made
        sum + limits.collisions(model, &at[0], &mut gradient[0]).unwrap_or(0.0)
    }

    /// Where a motion may begin: the given start, which must keep the limits at rest, or a state that does.
    pub fn start(&mut self) -> Result<Vec<f64>, Error> {
        let limits = &self.options.limits;
        if let Some(start) = &self.options.start {
            return match self.broken(start)? {
                None => Ok(start.clone()),
                Some(found) => Err(Error::BadOption {
                    option: "the start",
                    found,
                    expected: "a start that keeps all limits".into(),
                }),
            };
        }
        let tight = limits.tightened();
        let mut random = Random(17);
        for attempt in 0..ATTEMPTS {
            let mut theta = limits.middle();
            if attempt > 0 {
                let share = |[low, high]: &[f64; 2]| 0.5 * (high - low);
                theta.iter_mut().zip(&limits.position).for_each(|(x, range)| *x += share(range) * random.next());
            }
            let f = |theta: &[f64]| {
                let mut gradient = still(&vec![0.0; theta.len()]);
                let excess = self.excess(&tight, &still(theta), &mut gradient);
                (excess, core::mem::take(&mut gradient[0]))
            };
            lbfgs::minimize(&mut theta, ATTEMPT_STEPS, 1e-6, 0.3, f, &|| false);
            if self.broken(&theta)?.is_none() {
                return Ok(theta);
            }
        }
        let found = self.broken(&limits.middle())?.unwrap_or_else(|| "kept nowhere".into());
        let expected = "limits that the robot can keep at rest";
        Err(Error::BadOption { option: "what limits the motion", found, expected: expected.into() })
    }

    /// The limit that the robot breaks most at rest.
    fn broken(&mut self, theta: &[f64]) -> Result<Option<String>, Error> {
        let at = still(theta);
        let tau = self.torques(&at);
        Ok(self.options.limits.broken(self.columns.model, &at, &tau)?)
    }

    /// Makes the motion smaller, about a state that keeps the limits at rest, until every limit holds all the time.
    /// False if it would become nothing.
    pub fn shrink(&mut self, c: &mut [f64], about: &[f64]) -> bool {
        let count = self.basis.count();
        let fine = FINE * self.times.len();
        let mut size = 1.0;
        while size > LEAST {
            let inside = (0..=fine).all(|k| {
                let t = k as f64 / fine as f64 * self.basis.duration;
                let at = state(self.basis, c, t);
                let mut unused: [Vec<f64>; 3] = core::array::from_fn(|_| vec![0.0; at[0].len()]);
                self.excess(&self.options.limits, &at, &mut unused) == 0.0
            });
            if inside {
                return true;
            }
            size *= SMALLER;
            for (k, c) in c.iter_mut().enumerate() {
                let middle = if k % count == 0 { about[k / count] } else { 0.0 };
                *c = middle + SMALLER * (*c - middle);
            }
        }
        false
    }

    /// The condition number of the weighted regressor with unit columns.
    pub fn condition(&mut self, c: &[f64]) -> f64 {
        let mut S = self.information(c);
        let units: Vec<f64> = (0..S.nrows()).map(|k| S[(k, k)].sqrt()).collect();
        if units.contains(&0.0) {
            return f64::INFINITY; // no force shows this parameter
        }
        for k in 0..units.len() {
            for i in 0..units.len() {
                S[(i, k)] /= units[i] * units[k];
            }
        }
        let values = S.symmetric_eigenvalues();
        (values.max() / values.min().max(f64::MIN_POSITIVE)).sqrt()
    }

    /// The standard deviations of the base parameters from a log of this motion.
    pub fn deviations(&mut self, c: &[f64]) -> Vec<f64> {
        let samples = self.options.duration * self.options.rate;
        let S = self.information(c) * samples;
        match S.clone().cholesky() {
            Some(L) => L.inverse().diagonal().iter().map(|v| v.max(0.0).sqrt()).collect(),
            None => vec![f64::INFINITY; S.nrows()],
        }
    }
}

/// A state at rest.
fn still(theta: &[f64]) -> [Vec<f64>; 3] {
    [theta.to_vec(), vec![0.0; theta.len()], vec![0.0; theta.len()]]
}

/// The value of a goal, and its derivative by the information.
fn goal(goal: Goal, eigen: &nalgebra::SymmetricEigen<f64, nalgebra::Dyn>) -> (f64, DMatrix<f64>) {
    let (values, V) = (&eigen.eigenvalues, &eigen.eigenvectors);
    let least = 1e-12 * values.max();
    let values = values.map(|x| x.max(least));
    match goal {
        Goal::LogDet => {
            let value = -values.iter().map(|x| x.ln()).sum::<f64>();
            (value, -(V * DMatrix::from_diagonal(&values.map(|x| 1.0 / x)) * V.transpose()))
        }
        Goal::Condition => {
            let (a, b) = (values.imax(), values.imin());
            let of = |k: usize| V.column(k) * V.column(k).transpose() / values[k];
            ((values[a] / values[b]).ln(), of(a) - of(b))
        }
    }
}
