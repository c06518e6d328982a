//! Information content of a motion, and its gradient with respect to the coefficients.

use super::{Basis, ExciteOptions, MotionLimits, lbfgs, state};
use crate::Error;
use crate::columns::{Columns, Equations, Kind};
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
        let (value, mut G) = goal(self.options.goal, &eigen);
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
        let width = self.columns.choice.width;
        let mut found: [Vec<f64>; 3] = core::array::from_fn(|_| vec![0.0; n]);
        for j in 0..n {
            let mut pi = vec![0.0; model.parameter_count()];
            let mut of_friction = 0.0;
            for (row, &column) in self.base.columns.iter().enumerate() {
                let value = g[(j, row)] / self.options.noise[j];
                match self.columns.unknowns[column].kind {
                    Kind::Link(k) | Kind::Armature(k) | Kind::Viscous(k) | Kind::Stiffness(k) => pi[k] = value,
                    Kind::Coulomb(k) if self.columns.row_of(k) == j => of_friction = value,
                    _ => {}
                }
            }
            let robot = model.with_parameters(&pi);
            let mut x = vec![0.0; n];
            x[j] = 1.0;
            let [a, b, c] = &mut found;
            let inputs: [&[f64]; 4] = [&at[0], &at[1], &at[2], &x];
            fast::evaluate(&query, &robot, &inputs, &model.environment(), &mut self.workspace, &mut [a, b, c]);
            for (sum, slope) in slopes.iter_mut().flatten().zip(found.iter().flatten()) {
                *sum += slope;
            }
            let tanh = (at[1][j] / width).tanh();
            slopes[1][j] += of_friction * (1.0 - tanh * tanh) / width;
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
        let (limits, n) = (&self.options.limits, self.columns.model.n());
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
                let mut gradient = still(theta);
                let at = still(theta);
                gradient[0].fill(0.0);
                (self.excess(&tight, &at, &mut gradient), core::mem::take(&mut gradient[0]))
            };
            lbfgs::minimize(&mut theta, ATTEMPT_STEPS, 1e-6, 0.3, f, &|| false);
            if self.broken(&theta)?.is_none() {
                return Ok(theta);
            }
        }
        let found = self.broken(&limits.middle())?.unwrap_or_else(|| format!("broken by each of {n} joints"));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compress::stacked;
    use crate::excite::{Box3, MotionLimits, Sphere, excite};
    use crate::{Choice, Sensor};
    use mozzi::Model;
    use mozzi::random::Random;

    fn robot(name: &str) -> Model {
        mozzi_urdf::open(name).expect("embedded").description.build().expect("sound")
    }

    #[test]
    fn the_gradient_is_that_of_differences() {
        for (name, choice_of_goal) in
            [("double_pendulum", Goal::LogDet), ("ur5", Goal::LogDet), ("double_pendulum", Goal::Condition)]
        {
            let model = robot(name);
            let mut options = ExciteOptions { harmonics: 3, goal: choice_of_goal, ..ExciteOptions::new(&model, 6.0) };
            options.limits.velocity.fill(0.5);
            options.limits.torque.fill(10.0);
            let tip = model.frames().last().expect("a frame").0;
            let first = model.frames().next().expect("a frame").0;
            options.limits.boxes.push(Box3 { frame: tip, corners: [[-0.1, -0.1, 0.0], [0.2, 0.2, 0.3]] });
            let [a, b] = [first, tip].map(|frame| Sphere { frame, radius: 0.5 });
            options.limits.apart.push((a, b));
            let columns = Columns::new(&model, options.choice.clone()).expect("columns");
            let names = columns.unknowns.iter().map(|unknown| unknown.name.clone()).collect();
            let base = BaseParameters::of_columns(&stacked(&columns, 60).expect("rows"), names);
            let basis = Basis { duration: 6.0, harmonics: 3 };
            let mut objective = Objective::new(&columns, &base, &basis, &options).expect("an objective");
            let mut random = Random(2);
            let c = random.vector(model.n() * basis.count(), 0.4);
            let (_, gradient) = objective.value(&c, 3.0);
            let scale = gradient.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            for k in 0..c.len() {
                let h = 1e-6;
                let mut at = |x: f64| {
                    let mut c = c.clone();
                    c[k] += x;
                    objective.value(&c, 3.0).0
                };
                let slope = (at(h) - at(-h)) / (2.0 * h);
                assert!((slope - gradient[k]).abs() < 2e-5 * scale, "{name} {k}: {slope} and {}", gradient[k]);
            }
        }
    }

    #[test]
    fn the_motion_is_better_than_a_random_one_and_keeps_its_limits() {
        let model = robot("ur5");
        let mut options = ExciteOptions { iterations: 25, starts: 1, ..ExciteOptions::new(&model, 10.0) };
        options.choice = Choice::all(Sensor::Link);
        options.limits = MotionLimits { velocity: vec![1.5; 6], acceleration: vec![5.0; 6], ..options.limits };
        let found = excite(&model, &options, &|| false).expect("a motion");
        eprintln!("condition {:.1} instead of {:.1}", found.condition, found.condition_of_random);
        assert!(found.condition < 0.7 * found.condition_of_random);
        for k in 0..=1000 {
            let [theta, dtheta, ddtheta] = found.at(k as f64 / 100.0);
            let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &model.environment()).expect("lengths");
            for j in 0..6 {
                let [low, high] = options.limits.position[j];
                assert!(theta[j] >= low - 1e-3 && theta[j] <= high + 1e-3);
                assert!(
                    dtheta[j].abs() < 1.51 && ddtheta[j].abs() < 5.05 && tau[j].abs() < 1.01 * options.limits.torque[j]
                );
            }
        }
        let rest = found.at(0.0);
        assert!(rest[1].iter().chain(&rest[2]).all(|x| x.abs() < 1e-9));
    }

    /// Boxes, spheres and torques, about a given start and about one that is found.
    #[test]
    fn boxes_distances_and_torques_hold_all_the_time() {
        let model = robot("ur5");
        let [tip, base] = ["tool0", "base_link"].map(|name| model.frame(name).expect("there"));
        let short = ExciteOptions { iterations: 10, starts: 1, harmonics: 2, ..ExciteOptions::new(&model, 6.0) };
        let excite = |start: Option<Vec<f64>>, change: &dyn Fn(&mut MotionLimits)| {
            let mut options = ExciteOptions { start, ..short.clone() };
            change(&mut options.limits);
            super::super::excite(&model, &options, &|| false).map(|found| (options.limits, found))
        };
        let corners = [[0.2, -0.2, 0.1], [0.7, 0.4, 0.5]];
        let within = |limits: &mut MotionLimits| limits.boxes.push(Box3 { frame: tip, corners });
        let apart = |limits: &mut MotionLimits| {
            let [a, b] = [(tip, 0.3), (base, 0.4)].map(|(frame, radius)| Sphere { frame, radius });
            limits.apart.push((a, b));
        };
        let weak = |limits: &mut MotionLimits| limits.torque = vec![150.0, 60.0, 40.0, 28.0, 28.0, 28.0];
        let inside = vec![0.0, -1.2, 1.5, 0.3, 1.1, 0.0];
        for (start, change) in [
            (Some(inside.clone()), &within as &dyn Fn(&mut MotionLimits)),
            (None, &within),
            (None, &apart),
            (None, &weak),
        ] {
            let (limits, found) = excite(start.clone(), change).expect("a motion");
            for k in 0..=600 {
                let at = found.at(k as f64 / 100.0);
                let tau = model.inverse_dynamics(&at[0], &at[1], &at[2], &model.environment()).expect("lengths");
                let mut loose = limits.clone();
                loose.torque.iter_mut().for_each(|torque| *torque *= 1.01);
                loose.velocity.iter_mut().for_each(|velocity| *velocity *= 1.01);
                loose.acceleration.iter_mut().for_each(|acceleration| *acceleration *= 1.01);
                loose.position.iter_mut().for_each(|[low, high]| (*low, *high) = (*low - 1e-3, *high + 1e-3));
                for Box3 { corners: [low, high], .. } in &mut loose.boxes {
                    (low.iter_mut().for_each(|x| *x -= 1e-3), high.iter_mut().for_each(|x| *x += 1e-3));
                }
                loose.apart.iter_mut().for_each(|(a, _)| a.radius -= 1e-3);
                assert_eq!(loose.broken(&model, &at, tau.as_slice()).expect("frames"), None, "t = {k}/100 s");
            }
            let moves = found.coefficients.iter().map(|c| c.abs()).fold(0.0, f64::max);
            assert!(moves > 1e-2 && start.is_none_or(|start| found.at(0.0)[0] == start), "{moves}");
        }
        // what no motion can keep is named
        let error = |start: Option<Vec<f64>>, change: &dyn Fn(&mut MotionLimits)| {
            excite(start, change).expect_err("impossible").to_string()
        };
        let far = |limits: &mut MotionLimits| {
            limits.boxes.push(Box3 { frame: tip, corners: [[2.0; 3], [3.0; 3]] });
        };
        let message = error(None, &far);
        assert!(message.contains("`tool0` at (") && message.contains("outside its box by"), "{message}");
        let stretched = || Some(vec![0.0, -1.0, 0.0, 0.0, 0.0, 0.0]);
        let message = error(stretched(), &|limits| limits.torque = vec![150.0, 20.0, 20.0, 28.0, 28.0, 28.0]);
        assert!(message.contains("the torque of `shoulder_lift_joint` of") && message.contains("20.0000"), "{message}");
        let message = error(stretched(), &within);
        assert!(message.contains("the start is `tool0`"), "{message}");
        let message = error(Some(inside), &|limits| limits.velocity[2] = 0.0);
        assert!(message.contains("a limit of velocity is 0 for `elbow_joint`"), "{message}");
    }

    #[test]
    fn wrong_options_are_named() {
        let model = robot("double_pendulum");
        let options = ExciteOptions::new(&model, 10.0);
        let error = |options: ExciteOptions| excite(&model, &options, &|| false).expect_err("wrong").to_string();
        assert!(error(ExciteOptions { duration: -1.0, ..options.clone() }).contains("the duration is -1 s"));
        assert!(error(ExciteOptions { harmonics: 0, ..options.clone() }).contains("harmonics is 0"));
        assert!(error(ExciteOptions { start: Some(vec![0.0]), ..options.clone() }).contains("the start is [0.0]"));
        assert!(error(ExciteOptions { noise: vec![0.0, 1.0], ..options }).contains("the noise"));
    }
}
