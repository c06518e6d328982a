//! Rollouts of many robots of one model, and gradients through them: [`mozzi_sim::Rollout`] together, or
//! [one by one](each).

mod each;

use crate::many::threads::Threads;
use crate::{Batch, BatchEnvironment, Error};
use mozzi::quantities::{ForwardDynamics, ForwardDynamicsVjp};
use mozzi::{Environment, Model, Vec3};
use mozzi_sim::{ExplicitSteps, LARGEST, Method, ParameterGradient, Stage, StageDynamics, Steps, Tables};
use std::convert::identity;

/// Robots that one thread moves together.
const TOGETHER: usize = 64;

/// How the rollouts of a batch run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BatchRollout {
    /// h > 0, s.
    pub step: f64,
    /// N.
    pub steps: usize,
    /// A method with fixed steps.
    pub method: Method,
    /// In {s} coordinates, m/s², in place of the robot's own.
    pub gravity: Option<Vec3>,
    /// Steps between checkpoints, at least 1; by default as in [`mozzi_sim::Rollout`].
    pub checkpoints_every: Option<usize>,
}

impl BatchRollout {
    /// N steps of h seconds by Runge-Kutta 4.
    pub fn new(step: f64, steps: usize) -> Self {
        BatchRollout { step, steps, method: Method::RungeKutta4, gravity: None, checkpoints_every: None }
    }
}

/// A gradient's tables, by robot.
#[derive(Debug)]
pub struct BatchGradient<'a> {
    /// With respect to θ\[0\], along the velocities, (B, n).
    pub theta: &'a mut [f64],
    /// With respect to θ̇\[0\], (B, n).
    pub dtheta: &'a mut [f64],
    /// With respect to τ, (B, N, n).
    pub tau: &'a mut [f64],
    /// With respect to each robot's [`parameters`](Model::parameters), (B, p); empty if not wanted.
    pub parameters: &'a mut [f64],
}

impl Batch<f64> {
    /// The states (B, N + 1, nq) and (B, N + 1, n) of B robots from (θ\[0\], θ̇\[0\]), (B, nq) and (B, n), under τ,
    /// (B, N, n), τ\[k\] held over step k.
    ///
    /// # Errors
    /// A table has the wrong length, the options are those of no rollout (see
    /// [`Rollout::new`](mozzi_sim::Rollout::new)), or a state fails (the error carries the robot's index).
    pub fn rollout(
        &self,
        [theta, dtheta, tau]: [&[f64]; 3],
        options: &BatchRollout,
        [theta_table, dtheta_table]: [&mut [f64]; 2],
    ) -> Result<(), Error> {
        let (nq, n, rows) = (self.model().nq(), self.model().n(), options.steps + 1);
        let robots = self.check_start([theta, dtheta, tau], options)?;
        let sizes = [("theta_table", theta_table.len(), rows * nq), ("dtheta_table", dtheta_table.len(), rows * n)];
        check_lengths(robots, sizes)?;
        let together = self.together(options);
        let thetas = pieces(theta_table, rows * nq, robots, together).into_iter();
        let tables = thetas.zip(pieces(dtheta_table, rows * n, robots, together));
        if together == 1 {
            let start = [theta, dtheta, tau];
            return self.each_rollout(options, false, start, tables.collect(), |rollout, start, _, tables| {
                let ([theta, dtheta, tau], (theta_table, dtheta_table)) = (start, tables);
                rollout.write_states(theta, dtheta, tau, theta_table, dtheta_table)
            });
        }
        self.by_pieces(options, false, robots, tables.collect(), |steps, first, count, (theta_table, dtheta_table)| {
            let part = |table, width| part(table, first, count, width);
            let (start, tau) = ([part(theta, nq), part(dtheta, n)], part(tau, options.steps * n));
            let mut tables = Rows { robots: count, tau, lost: None, states: [theta_table, dtheta_table], bars: None };
            steps.run(start, options.steps, &mut tables)?;
            let lost = tables.lost;
            self.check_lost(lost, options)
        })
    }

    /// The vector-Jacobian product of [`rollout`](Self::rollout): from cotangents θ̄ (along the velocities) and θ̇̄ of
    /// all states, both (B, N + 1, n), the gradient with respect to the starts, the torques and the parameters.
    ///
    /// # Errors
    /// As [`rollout`](Self::rollout).
    pub fn rollout_vjp(
        &self,
        [theta, dtheta, tau]: [&[f64]; 3],
        options: &BatchRollout,
        [theta_bar, dtheta_bar]: [&[f64]; 2],
        gradient: BatchGradient<'_>,
    ) -> Result<(), Error> {
        let (nq, n, N) = (self.model().nq(), self.model().n(), options.steps);
        let (rows, p) = (N + 1, if gradient.parameters.is_empty() { 0 } else { self.model().parameter_count() });
        let robots = self.check_start([theta, dtheta, tau], options)?;
        let BatchGradient { theta: to_theta, dtheta: to_dtheta, tau: to_tau, parameters } = gradient;
        let sizes = [
            ("theta_bar", theta_bar.len(), rows * n),
            ("dtheta_bar", dtheta_bar.len(), rows * n),
            ("theta's gradient", to_theta.len(), n),
            ("dtheta's gradient", to_dtheta.len(), n),
            ("tau's gradient", to_tau.len(), N * n),
            ("parameters' gradient", parameters.len(), p),
        ];
        check_lengths(robots, sizes)?;
        let outputs = [(to_theta, n), (to_dtheta, n), (to_tau, N * n), (parameters, p)];
        let together = self.together(options);
        let [a, b, c, d] = outputs.map(|(table, width)| pieces(table, width, robots, together));
        let outputs = a.into_iter().zip(b).zip(c).zip(d).map(|(((a, b), c), d)| [a, b, c, d]).collect();
        if together == 1 {
            return self.each_rollout(
                options,
                p > 0,
                [theta, dtheta, tau],
                outputs,
                |rollout, start, robot, outputs| {
                    let [theta, dtheta, tau, parameters] = outputs;
                    let bars = [theta_bar, dtheta_bar].map(|table| part(table, robot, 1, rows * n));
                    BatchGradient { theta, dtheta, tau, parameters }.of_one(rollout, start, bars)
                },
            );
        }
        self.by_pieces(
            options,
            true,
            robots,
            outputs,
            |steps, first, count, [to_theta, to_dtheta, to_tau, to_parameters]| {
                let part = |table, width| part(table, first, count, width);
                let (start, tau) = ([part(theta, nq), part(dtheta, n)], part(tau, N * n));
                let bars = Some(([part(theta_bar, rows * n), part(dtheta_bar, rows * n)], to_tau));
                let mut tables = Rows { robots: count, tau, lost: None, states: [&mut [], &mut []], bars };
                let found = steps.gradient(start, N, options.checkpoints_every, p > 0, &mut tables)?;
                to_theta.copy_from_slice(found.theta);
                to_dtheta.copy_from_slice(found.dtheta);
                to_parameters.copy_from_slice(found.parameters);
                let lost = tables.lost;
                self.check_lost(lost, options)
            },
        )
    }

    /// Checks the starts and the options; the number of robots.
    fn check_start(&self, [theta, dtheta, tau]: [&[f64]; 3], options: &BatchRollout) -> Result<usize, Error> {
        options.of_one(self.model())?;
        let (nq, n) = (self.model().nq().max(1), self.model().n());
        if !theta.len().is_multiple_of(nq) {
            return Err(Error::IncompleteState { what: "theta", found: theta.len(), width: nq });
        }
        let robots = theta.len() / nq;
        check_lengths(robots, [("dtheta", dtheta.len(), n), ("tau", tau.len(), options.steps * n)])?;
        for (what, table, width) in [("theta", theta, nq), ("dtheta", dtheta, n)] {
            if let Some(k) = table.iter().position(|x| !x.is_finite()) {
                let (found, expected) = (table[k].to_string(), "finite numbers");
                let source = mozzi::Error::BadArgument { what, found, expected }.into();
                return Err(Error::State { index: k / width, source });
            }
        }
        Ok(robots)
    }

    /// Robots of a piece: one, if steps iterate.
    fn together(&self, options: &BatchRollout) -> usize {
        let is_explicit = options.method.explicit().is_ok();
        if is_explicit && self.model().constraint_rows() == 0 { TOGETHER } else { 1 }
    }

    /// Applies f to pieces of robots: with memory for them, the first one's index, and their number.
    fn by_pieces<I: Send>(
        &self,
        options: &BatchRollout,
        is_gradient: bool,
        robots: usize,
        pieces: Vec<I>,
        f: impl Fn(&mut Steps<ExplicitSteps<Together>>, usize, usize, I) -> Result<(), Error> + Sync,
    ) -> Result<(), Error> {
        let method = options.method.explicit()?;
        let queries = [ForwardDynamics.into(), ForwardDynamicsVjp.into()];
        let environment = environment(self.model(), options.gravity);
        let alone =
            self.for_job_of(&queries[..if is_gradient { 2 } else { 1 }], &environment, robots * options.steps)?;
        let alone = alone.on(Threads::One);
        let pieces: Vec<_> = pieces.into_iter().enumerate().collect();
        let results = self.workers().map(
            pieces,
            || None::<(usize, Steps<ExplicitSteps<Together>>)>,
            |memory, (k, piece)| {
                let (first, count) = (k * TOGETHER, TOGETHER.min(robots - k * TOGETHER));
                let kept = memory.take().filter(|(robots, _)| *robots == count);
                let (_, steps) = memory.insert(kept.unwrap_or_else(|| {
                    let (model, dynamics) = (alone.model(), Together::new(&alone, options.gravity, count));
                    let stepper = ExplicitSteps::new(model, count, method, options.step, dynamics);
                    (count, Steps::new(stepper, model.n() * count, model.parameter_count() * count))
                }));
                f(steps, first, count, piece).map_err(|error| error.after(first))
            },
        );
        results.into_iter().try_for_each(identity)
    }

    /// The error of a robot whose state became infinite or NaN, by its index in a piece.
    fn check_lost(&self, lost: Option<Lost>, options: &BatchRollout) -> Result<(), Error> {
        let Some(Lost { robot, joint, step, value }) = lost else { return Ok(()) };
        let joint = self.model().velocity_names().nth(joint).unwrap_or_default().to_string();
        let (time, step_size) = (step as f64 * options.step, options.step);
        let source = mozzi_sim::Error::Diverged { quantity: "dtheta", joint, value, step, time, step_size };
        Err(Error::State { index: robot, source })
    }
}

/// The robot's own environment, or with this gravity.
fn environment(model: &Model, gravity: Option<Vec3>) -> BatchEnvironment<'static, f64> {
    let own = model.environment();
    Environment { gravity: gravity.unwrap_or(own.gravity), ..own }.into()
}

/// Many robots' forward dynamics and its products, on one thread.
struct Together<'b> {
    batch: &'b Batch<f64>,
    environment: BatchEnvironment<'b, f64>,
    parameters: ParameterGradient,
    robots: usize,
}

impl<'b> Together<'b> {
    fn new(batch: &'b Batch<f64>, gravity: Option<Vec3>, robots: usize) -> Self {
        let (model, parameters) = (batch.model(), ParameterGradient::new(batch.model()));
        Together { batch, environment: environment(model, gravity), parameters, robots }
    }

    fn model(&self) -> &'b Model {
        self.batch.model()
    }
}

impl StageDynamics for Together<'_> {
    type Error = Error;

    fn accelerations(&mut self, stage: Stage<'_>, ddtheta: &mut [f64]) -> Result<(), Error> {
        let Stage { theta, dtheta, tau, .. } = stage;
        self.batch.compute(ForwardDynamics, &[theta, dtheta, tau], &self.environment, &mut [ddtheta])
    }

    fn vjp(&mut self, stage: Stage<'_>, x: &[f64], [a, b, c]: [&mut [f64]; 3]) -> Result<(), Error> {
        let Stage { theta, dtheta, tau, .. } = stage;
        self.batch.compute(ForwardDynamicsVjp, &[theta, dtheta, tau, x], &self.environment, &mut [a, b, c])
    }

    fn add_parameter_vjp(
        &mut self,
        stage: Stage<'_>,
        ddtheta: &[f64],
        y: &[f64],
        gradient: &mut [f64],
    ) -> Result<(), Error> {
        let (nq, n, p) = (self.model().nq(), self.model().n(), gradient.len() / self.robots);
        for (robot, gradient) in gradient.chunks_exact_mut(p).enumerate() {
            let of = |table, width| part(table, robot, 1, width);
            let state = [of(stage.theta, nq), of(stage.dtheta, n), of(ddtheta, n)];
            let environment = &self.environment.environment;
            self.parameters.add(self.batch.model(), state, of(y, n), environment, gradient);
        }
        Ok(())
    }
}

/// The first robot whose state is infinite or NaN.
#[derive(Clone, Copy)]
struct Lost {
    robot: usize,
    joint: usize,
    step: usize,
    value: f64,
}

/// The tables of a piece, rows by robot.
struct Rows<'a> {
    robots: usize,
    tau: &'a [f64],
    lost: Option<Lost>,
    /// Filled by a rollout.
    states: [&'a mut [f64]; 2],
    /// The cotangents of the states, and the gradient with respect to τ; `None` without gradients.
    bars: Option<([&'a [f64]; 2], &'a mut [f64])>,
}

impl Rows<'_> {
    fn check(&mut self, step: usize, dtheta: &[f64]) {
        if self.lost.is_none()
            && let Some(k) = dtheta.iter().position(|x| !(x.abs() < LARGEST))
        {
            let n = dtheta.len() / self.robots;
            self.lost = Some(Lost { robot: k / n, joint: k % n, step, value: dtheta[k] });
        }
    }

    /// Row k of each robot in a table by robot: (index in a row of all robots, index in the table).
    fn places(&self, table: usize, all: usize, k: usize) -> impl Iterator<Item = [std::ops::Range<usize>; 2]> + use<> {
        let (width, of_robot) = (all / self.robots, table / self.robots);
        (0..self.robots).map(move |r| {
            let at = r * of_robot + k * width;
            [r * width..(r + 1) * width, at..at + width]
        })
    }
}

impl Tables for Rows<'_> {
    fn torque(&mut self, k: usize, tau: &mut [f64]) {
        for [to, from] in self.places(self.tau.len(), tau.len(), k) {
            tau[to].copy_from_slice(&self.tau[from]);
        }
    }

    fn record(&mut self, k: usize, theta: &[f64], dtheta: &[f64]) {
        self.check(k, dtheta);
        for (table, row) in [theta, dtheta].into_iter().enumerate() {
            for [from, to] in self.places(self.states[table].len(), row.len(), k) {
                self.states[table][to].copy_from_slice(&row[from]);
            }
        }
    }

    fn cotangent(&mut self, k: usize, _: &[f64], dtheta: &[f64], theta_bar: &mut [f64], dtheta_bar: &mut [f64]) {
        self.check(k, dtheta);
        let Some((bars, _)) = &self.bars else { return };
        for (table, row) in bars.iter().zip([theta_bar, dtheta_bar]) {
            for [to, from] in self.places(table.len(), row.len(), k) {
                row[to].iter_mut().zip(&table[from]).for_each(|(x, bar)| *x += bar);
            }
        }
    }

    fn take(&mut self, k: usize, tau_bar: &[f64]) {
        let places = self.places(self.tau.len(), tau_bar.len(), k);
        let Some((_, table)) = &mut self.bars else { return };
        places.for_each(|[from, to]| table[to].copy_from_slice(&tau_bar[from]));
    }
}

fn check_lengths<const K: usize>(robots: usize, tables: [(&'static str, usize, usize); K]) -> Result<(), Error> {
    match tables.into_iter().find(|&(_, found, width)| found != robots * width) {
        None => Ok(()),
        Some((what, found, width)) => {
            Err(Error::WrongLength { what, found, expected: robots * width, states: robots, width })
        }
    }
}

/// The rows of some robots.
fn part(table: &[f64], first: usize, count: usize, width: usize) -> &[f64] {
    &table[first * width..(first + count) * width]
}

/// The rows of each `together` robots.
fn pieces(mut table: &mut [f64], width: usize, robots: usize, together: usize) -> Vec<&mut [f64]> {
    let mut pieces = Vec::with_capacity(robots.div_ceil(together));
    for first in (0..robots).step_by(together) {
        let (piece, rest) = core::mem::take(&mut table).split_at_mut(together.min(robots - first) * width);
        pieces.push(piece);
        table = rest;
    }
    pieces
}
