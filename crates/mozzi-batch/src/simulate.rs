//! Many robots of one model in time.

use crate::chunk::Table;
use crate::request::Request;
use crate::threads::Threads;
use crate::{Batch, BatchEnvironment, Error, Layout, Number};
use mozzi::quantities::ForwardDynamics;
use mozzi::simulation::{Method, Motion};

/// Robots that one thread moves together: their states and the method's stages stay in its cache.
const TOGETHER: usize = 512;

impl<T: Number> Batch<T> {
    /// (θ, θ̇) (N, nq) and (N, n) of every robot after `steps` steps of a method over `duration` seconds, in place,
    /// under torques τ (N, n) and an environment that stay as they are: a controller's interval. Robots move by pieces
    /// that fit the cache. See [`mozzi::simulation`].
    ///
    /// # Errors
    /// A table has the wrong length, the method is not [explicit](Method::explicit), or a state fails (the error
    /// carries its index): its mass matrix is singular, or it became infinite or NaN. Neighbouring states are computed
    /// before the error is returned.
    #[allow(clippy::too_many_arguments)] // a state, what drives it, and how
    pub fn simulate(
        &self,
        theta: &mut [T],
        dtheta: &mut [T],
        tau: &[T],
        environment: &BatchEnvironment<T>,
        method: Method,
        duration: f64,
        steps: usize,
    ) -> Result<(), Error> {
        let (nq, n) = (self.model().nq(), self.model().n());
        let m = self.model().constraint_rows();
        if m > 0 {
            let (found, expected) = (format!("one with {m} constraint rows"), "a robot without constraints");
            return Err(mozzi::Error::BadArgument { what: "the robot of a batch's simulation", found, expected }.into());
        }
        let table = |name, numbers, width| Table { name, numbers, width };
        let mut inputs = vec![table("theta", &*theta, nq), table("dtheta", &*dtheta, n), table("tau", tau, n)];
        inputs.extend(Request::new(ForwardDynamics.into(), self.model(), environment).further());
        let frames = environment.wrenches.iter().map(|&(frame, _)| frame);
        let states = self.check(&inputs, [].into_iter(), &environment.environment, frames)?;
        let explicit = method.explicit()?;
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
            let wrenches: Vec<_> = environment.wrenches.iter().map(|&(frame, table)| (frame, rows(table, 6))).collect();
            let wrenches: Vec<_> = wrenches.iter().map(|(frame, table)| (*frame, &table[..])).collect();
            let gravity = environment.gravity.map(|table| rows(table, 3));
            let parameters = environment.parameters.map(|table| rows(table, self.model().parameter_count()));
            let (gravity, parameters) = (gravity.as_deref(), parameters.as_deref());
            let environment = BatchEnvironment { wrenches: &wrenches, gravity, parameters, ..*environment };
            let (mut q, mut v, tau) = (rows(theta, nq), rows(dtheta, n), rows(tau, n));
            let by_rows = self.clone().with_layout(Layout::Rows);
            by_rows.simulate(&mut q, &mut v, &tau, &environment, method, duration, steps)?;
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
                let wrenches: Vec<_> = environment
                    .wrenches
                    .iter()
                    .map(|&(frame, table)| (frame, &table[first * 6..][..robots * 6]))
                    .collect();
                let p = self.model().parameter_count();
                let gravity = environment.gravity.map(|table| &table[first * 3..][..robots * 3]);
                let parameters = environment.parameters.map(|table| &table[first * p..][..robots * p]);
                let environment = BatchEnvironment { wrenches: &wrenches, gravity, parameters, ..*environment };
                let tau = &tau[first * n..][..robots * n];
                let accelerations = |_t: f64, theta: &[T], dtheta: &[T], ddtheta: &mut [T]| {
                    alone
                        .compute(ForwardDynamics, &[theta, dtheta, tau], &environment, &mut [ddtheta])
                        .map(|()| [])
                        .map_err(|error| error.after(first))
                };
                let space = alone.model().configuration_space();
                let mut motion: Motion<T> = Motion::start_many(space, robots, 0.0, theta, dtheta, accelerations)?;
                for k in 1..=steps {
                    motion.step(explicit, h, k as f64 * h, accelerations)?;
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
