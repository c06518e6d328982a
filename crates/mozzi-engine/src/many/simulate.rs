//! Simulation of many robots of one model: together, or [one by one](each).

mod each;

use crate::many::chunk::Table;
use crate::many::request::Request;
use crate::many::threads::Threads;
use crate::{Batch, BatchEnvironment, Error, Number};
use mozzi_sim::{Closer, Method, Motion, Options, forward_dynamics_of};

/// The number of robots that one thread moves together, so that their states and the method's stages stay in its cache.
const TOGETHER: usize = 512;

impl<T: Number> Batch<T> {
    /// Replaces (θ, θ̇) (N, nq) and (N, n) of every robot by its state after `steps` steps of a method over `duration`
    /// seconds, under constant torques τ (N, n) and a constant environment: one interval of a controller. Robots are
    /// moved in pieces that fit the cache. The state of a robot with constraints is projected onto them after each
    /// step. See [`mozzi_sim`].
    ///
    /// Robots with dry friction are moved one by one, each as [`mozzi_sim::simulate`] moves it alone, by any method,
    /// unless [`with_sticking(false)`](Batch::with_sticking) was set.
    ///
    /// # Errors
    /// A table has the wrong length, the method of robots without dry friction is not [explicit](Method::explicit), or
    /// a state fails (the error carries its index): its mass matrix is singular, it violates the constraints, or became
    /// infinite or NaN.
    /// Neighbouring states are computed before the error is returned.
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
        let table = |name, numbers, width| Table { name, numbers, width };
        let mut inputs = vec![table("theta", &*theta, nq), table("dtheta", &*dtheta, n), table("tau", tau, n)];
        let query = forward_dynamics_of(self.model());
        inputs.extend(Request::new(query, self.model(), environment).further());
        let frames = environment.wrenches.iter().map(|&(frame, _)| frame);
        let states = self.check(&inputs, [].into_iter(), &environment.environment, frames)?;
        let is_alone = self.sticks() && self.has_dry_friction(environment);
        let h = duration / steps as f64;
        if !(h.is_finite() && h >= 0.0) {
            let found = format!("{steps} steps in {duration} s");
            let expected = "at least one step, in a finite number of seconds, at least 0";
            return Err(mozzi::Error::BadArgument { what: "the simulation", found, expected }.into());
        }
        if states == 0 || n == 0 {
            return Ok(());
        }
        self.check_closed(theta, dtheta)?;
        if is_alone {
            let options = Options { method, record_every: steps, ..Options::new(duration, steps) };
            return self.simulate_alone([theta, dtheta], tau, environment, &options);
        }
        let explicit = method.explicit()?;
        let alone = self.for_job_of(&[query], environment, states * steps)?.on(Threads::One);
        let m = self.model().constraint_rows();
        let pieces: Vec<_> = theta.chunks_mut(TOGETHER * nq).zip(dtheta.chunks_mut(TOGETHER * n)).enumerate().collect();
        let results = self.workers().map(
            pieces,
            || Closer::new(self.constants()),
            |closer, (k, (theta, dtheta))| {
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
                let mut lambda = vec![T::zero(); robots * m];
                let mut accelerations = |_t: f64, theta: &[T], dtheta: &[T], ddtheta: &mut [T]| {
                    let outputs = &mut [ddtheta, &mut lambda][..query.declaration().outputs.len()];
                    alone
                        .compute(query, &[theta, dtheta, tau], &environment, outputs)
                        .map(|()| [])
                        .map_err(|error| error.after(first))
                };
                let space = alone.model().configuration_space();
                let mut motion: Motion<T> = Motion::start_many(space, robots, 0.0, theta, dtheta, &mut accelerations)?;
                for k in 1..=steps {
                    motion.advance(explicit, h, k as f64 * h, &mut accelerations)?;
                    if let Some(closer) = closer {
                        self.close_by(closer, motion.t, &mut motion.theta, &mut motion.dtheta)
                            .map_err(|error| error.after(first))?;
                    }
                    motion.find_rates(&mut accelerations)?;
                }
                let diverged = lost(dtheta, &motion.dtheta).map(|k| {
                    let (joint, value) =
                        (alone.model().velocity_names().nth(k % n).unwrap_or_default(), motion.dtheta[k].into());
                    let (joint, time) = (joint.to_string(), duration);
                    let source = mozzi_sim::Error::Diverged {
                        quantity: "dtheta",
                        joint,
                        value,
                        step: steps,
                        time,
                        step_size: h,
                    };
                    Error::State { index: first + k / n, source }
                });
                theta.copy_from_slice(&motion.theta);
                dtheta.copy_from_slice(&motion.dtheta);
                diverged.map_or(Ok(()), Err)
            },
        );
        results.into_iter().collect()
    }

    /// Checks that these states, row-major tables, satisfy the robot's constraints. See [`Closer::check_start`].
    ///
    /// # Errors
    /// [`mozzi_sim::Error::OpenStart`] for the first state that violates them.
    pub fn check_closed(&self, theta: &[T], dtheta: &[T]) -> Result<(), Error> {
        let (nq, n) = (self.model().nq(), self.model().n().max(1));
        let pieces = theta.chunks(TOGETHER * nq.max(1)).zip(dtheta.chunks(TOGETHER * n));
        self.each(pieces.collect(), |closer, (theta, dtheta)| {
            for (k, (theta, dtheta)) in theta.chunks_exact(nq).zip(dtheta.chunks_exact(n)).enumerate() {
                closer
                    .check_start(self.constants(), theta, dtheta)
                    .map_err(|source| Error::State { index: k, source })?;
            }
            Ok(())
        })
    }

    /// Projects states at time t, row-major tables, onto the robot's constraints. See [`Closer::close`].
    ///
    /// # Errors
    /// [`mozzi_sim::Error::Opened`] or [`Jumped`](mozzi_sim::Error::Jumped) for the first state whose loops cannot be
    /// closed; a state that is not finite gives no error.
    pub fn close(&self, t: f64, theta: &mut [T], dtheta: &mut [T]) -> Result<(), Error> {
        let (nq, n) = (self.model().nq(), self.model().n().max(1));
        let pieces = theta.chunks_mut(TOGETHER * nq.max(1)).zip(dtheta.chunks_mut(TOGETHER * n));
        self.each(pieces.collect(), |closer, (theta, dtheta)| self.close_by(closer, t, theta, dtheta))
    }

    fn close_by(&self, closer: &mut Closer<T>, t: f64, theta: &mut [T], dtheta: &mut [T]) -> Result<(), Error> {
        let (nq, n) = (self.model().nq(), self.model().n().max(1));
        let finite = |numbers: &[T]| numbers.iter().all(|&x| x * T::zero() == T::zero());
        for (k, (theta, dtheta)) in theta.chunks_exact_mut(nq).zip(dtheta.chunks_exact_mut(n)).enumerate() {
            if finite(theta) && finite(dtheta) {
                let closed = closer.close(self.constants(), t, theta, dtheta);
                closed.map_err(|source| Error::State { index: k, source })?;
            }
        }
        Ok(())
    }

    /// Applies f to pieces of [`TOGETHER`] states; does nothing if the robot has no constraints.
    fn each<I: Send>(
        &self,
        pieces: Vec<I>,
        f: impl Fn(&mut Closer<T>, I) -> Result<(), Error> + Sync,
    ) -> Result<(), Error> {
        if self.model().constraint_rows() == 0 {
            return Ok(());
        }
        let pieces: Vec<_> = pieces.into_iter().enumerate().collect();
        let results = self.workers().map(
            pieces,
            || Closer::new(self.constants()),
            |closer, (k, piece)| match closer {
                Some(closer) => f(closer, piece).map_err(|error| error.after(k * TOGETHER)),
                None => Ok(()),
            },
        );
        results.into_iter().collect()
    }
}

/// The index of the first number that was finite and is no longer.
fn lost<T: Number>(before: &[T], after: &[T]) -> Option<usize> {
    let finite = |x: T| x * T::zero() == T::zero();
    before.iter().zip(after).position(|(&before, &after)| finite(before) && !finite(after))
}
