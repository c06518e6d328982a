//! Many robots of one model in time.

use crate::quantity::ForwardDynamics;
use crate::threads::Threads;
use crate::{Batch, BatchEnvironment, Error, Layout, Number};
use mozzi::simulation::{Method, Motion};

/// Robots that one thread moves together: their states and the method's stages stay in its cache.
const TOGETHER: usize = 512;

impl<T: Number> Batch<T> {
    /// (θ, θ̇) of every robot after `steps` steps of `duration` / `steps` seconds, in place, under torques τ that stay as they are:
    /// a controller's interval. Robots move by pieces that fit the cache; each piece's accelerations are the batch's.
    pub(crate) fn simulate_all(
        &self,
        [theta, dtheta]: [&mut [T]; 2],
        tau: &[T],
        surroundings: &BatchEnvironment<T>,
        (method, duration, steps): (Method, f64, usize),
    ) -> Result<(), Error> {
        let (nq, n) = (self.model().nq(), self.model().n());
        let inputs = [("theta", (&*theta, nq)), ("dtheta", (&*dtheta, n)), ("tau", (tau, n))];
        let states = self.check(&inputs, &[], surroundings)?;
        let h = duration / steps as f64;
        if !(h.is_finite() && h >= 0.0) {
            let found = format!("{steps} steps in {duration} s");
            let expected = "at least one step, in a finite number of seconds, at least 0";
            return Err(mozzi::Error::BadArgument { what: "the simulation", found, expected }.into());
        }
        if states == 0 || n == 0 {
            return Ok(());
        }
        if self.layout() == Layout::Blocks {
            // robots move in rows: their quaternions are turned one by one
            let rows = |table: &[T], width| self.to_rows(table, width, states);
            let wrenches: Vec<_> =
                surroundings.wrenches.iter().map(|&(frame, table)| (frame, rows(table, 6))).collect();
            let wrenches: Vec<_> = wrenches.iter().map(|(frame, table)| (*frame, &table[..])).collect();
            let surroundings = BatchEnvironment { wrenches: &wrenches, ..*surroundings };
            let (mut q, mut v, tau) = (rows(theta, nq), rows(dtheta, n), rows(tau, n));
            let by_rows = self.clone().with_layout(Layout::Rows);
            by_rows.simulate_all([&mut q, &mut v], &tau, &surroundings, (method, duration, steps))?;
            theta.copy_from_slice(&self.to_blocks(&q, nq));
            dtheta.copy_from_slice(&self.to_blocks(&v, n));
            return Ok(());
        }

        let alone = self.on(Threads::One);
        let pieces: Vec<_> = theta.chunks_mut(TOGETHER * nq).zip(dtheta.chunks_mut(TOGETHER * n)).enumerate().collect();
        let results = self.workers().map(
            pieces,
            || (),
            |(), (k, (theta, dtheta))| {
                let (first, robots) = (k * TOGETHER, dtheta.len() / n);
                let wrenches: Vec<_> = surroundings
                    .wrenches
                    .iter()
                    .map(|&(frame, table)| (frame, &table[first * 6..][..robots * 6]))
                    .collect();
                let surroundings = BatchEnvironment { wrenches: &wrenches, ..*surroundings };
                let tau = &tau[first * n..][..robots * n];
                let accelerations = |_t: f64, theta: &[T], dtheta: &[T], ddtheta: &mut [T]| {
                    let inputs = [("theta", (theta, nq)), ("dtheta", (dtheta, n)), ("tau", (tau, n))];
                    let outputs = vec![("ddtheta", (ddtheta, n))];
                    alone
                        .run(&ForwardDynamics, &inputs, outputs, surroundings)
                        .map(|()| [])
                        .map_err(|error| error.after(first))
                };
                let base = alone.model().base();
                let mut motion: Motion<T> = Motion::start_many(base, robots, 0.0, theta, dtheta, accelerations)?;
                for k in 1..=steps {
                    motion.step(method, h, k as f64 * h, accelerations)?;
                }
                let diverged = lost(dtheta, &motion.dtheta).map(|k| {
                    let (joint, value) =
                        (alone.model().velocity_names().nth(k % n).unwrap_or_default(), motion.dtheta[k].into());
                    let (joint, time) = (joint.to_string(), duration);
                    let source =
                        mozzi::Error::Diverged { quantity: "dtheta", joint, value, step: steps, time, step_size: h };
                    Error::State { index: first + k / n, source }
                });
                theta.copy_from_slice(&motion.theta);
                dtheta.copy_from_slice(&motion.dtheta);
                diverged.map_or(Ok(()), Err)
            },
        );
        results.into_iter().collect()
    }
}

/// The first number that was one and is none now.
fn lost<T: Number>(before: &[T], after: &[T]) -> Option<usize> {
    let finite = |x: T| x * T::zero() == T::zero();
    before.iter().zip(after).position(|(&before, &after)| finite(before) && !finite(after))
}
