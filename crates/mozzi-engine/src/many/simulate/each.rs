//! Robots one by one, on all cores, each as alone: those with dry friction that sticks, contacts, stops or events.

use crate::{Batch, BatchEnvironment, Error, Number};
use mozzi::{FrameId, Model, Twist, Vec3, Wrench};
use mozzi_sim::{Input, Options, Run, Simulation};
use std::borrow::Cow;
use std::ops::ControlFlow;

impl<T: Number> Batch<T> {
    /// The motions of robots, each as [`Simulation::run_with_progress`] gives it alone, to the bit, on all cores: of
    /// robot k from row k of θ (N, nq) and θ̇ (N, n), by `simulation(k)` under `input(k)`. Memory grows with the rows
    /// of all motions.
    ///
    /// # Errors
    /// A table has the wrong length, or a simulation fails (the error carries the index of the first such robot).
    pub fn simulate_each<'a>(
        &self,
        [theta, dtheta]: [&[f64]; 2],
        simulation: impl Fn(usize) -> Simulation<'a> + Sync,
        input: impl Fn(usize) -> Box<dyn Input + 'a> + Sync,
        progress: impl Fn(f64) -> ControlFlow<()> + Sync,
    ) -> Result<Vec<Run>, Error> {
        let (nq, n) = (self.model().nq(), self.model().n());
        let states = dtheta.len().checked_div(n).unwrap_or_default();
        for (what, found, width) in [("dtheta", dtheta.len(), n), ("theta", theta.len(), nq)] {
            let expected = states * width;
            if found != expected {
                return Err(Error::WrongLength { what, found, expected, states, width });
            }
        }
        self.one_by_one(states, |k| {
            let start = [&theta[k * nq..][..nq], &dtheta[k * n..][..n]];
            simulation(k).run_with_progress(self.model(), start[0], start[1], input(k), &progress)
        })
    }

    /// Applies f to the indices of robots, on all cores; the error is that of the first robot that fails.
    fn one_by_one<R: Send>(
        &self,
        robots: usize,
        f: impl Fn(usize) -> Result<R, mozzi_sim::Error> + Sync,
    ) -> Result<Vec<R>, Error> {
        let found = self.workers().map((0..robots).collect(), || (), |(), k| (k, f(k)));
        found.into_iter().map(|(index, run)| run.map_err(|source| Error::State { index, source })).collect()
    }

    /// True if dry friction acts on any robot in these environments.
    pub(super) fn has_dry_friction(&self, environment: &BatchEnvironment<T>) -> bool {
        match environment.parameters {
            None => self.model().has_dry_friction(),
            Some(table) => {
                let is_friction: Vec<bool> =
                    self.model().parameter_names().iter().map(|name| name.ends_with(".friction")).collect();
                let rows = table.chunks_exact(is_friction.len().max(1));
                rows.into_iter().any(|row| row.iter().zip(&is_friction).any(|(&x, &is)| is && x.into() != 0.0))
            }
        }
    }

    /// As [`simulate`](Self::simulate), each robot as alone. The tables are row-major.
    pub(super) fn simulate_alone(
        &self,
        [theta, dtheta]: [&mut [T]; 2],
        tau: &[T],
        environment: &BatchEnvironment<T>,
        options: &Options,
    ) -> Result<(), Error> {
        let (model, nq, n) = (self.model(), self.model().nq(), self.model().n());
        let mozzi::Environment { base_twist, base_acceleration, gravity: common, applied } = environment.environment;
        if base_twist != Twist::zero() || base_acceleration != Twist::zero() {
            return Err(mozzi::Error::BadArgument {
                what: "the motion of {s}",
                found: format!("{base_twist:?}, {base_acceleration:?}"),
                expected: "none of robots with dry friction; with_sticking(false) has no such bound",
            }
            .into());
        }
        let double = |table: &[T]| -> Vec<f64> { table.iter().map(|&x| x.into()).collect() };
        let (q, v, tau) = (double(theta), double(dtheta), double(tau));
        let row = |table: &[T], k: usize, width: usize| double(&table[k * width..][..width]);
        let p = model.parameter_count();
        let ends = self.one_by_one(v.len() / n, |k| {
            let model: Cow<Model> = match environment.parameters {
                Some(table) => Cow::Owned(model.with_parameters(&row(table, k, p))),
                None => Cow::Borrowed(model),
            };
            let gravity = match environment.gravity {
                Some(table) => Vec3([0, 1, 2].map(|axis| table[3 * k + axis].into())),
                None => common,
            };
            let wrench = |&(frame, table): &(FrameId, &[T])| {
                (frame, Wrench::from_array([0, 1, 2, 3, 4, 5].map(|i| table[6 * k + i].into())))
            };
            let wrenches = environment.wrenches.iter().map(wrench);
            let wrenches = wrenches.chain(applied.iter().copied()).collect();
            let held = Held { tau: &tau[k * n..][..n], wrenches };
            let simulation = Simulation::new(Options { gravity: Some(gravity), ..*options });
            let run = simulation.run(&model, &q[k * nq..][..nq], &v[k * n..][..n], held)?;
            let last = run.motion.last();
            Ok((last.theta.to_vec(), last.dtheta.to_vec()))
        })?;
        for (k, (q, v)) in ends.into_iter().enumerate() {
            theta[k * nq..][..nq].iter_mut().zip(q).for_each(|(to, x)| *to = T::from_f64(x));
            dtheta[k * n..][..n].iter_mut().zip(v).for_each(|(to, x)| *to = T::from_f64(x));
        }
        Ok(())
    }
}

/// Constant torques and wrenches of one robot.
struct Held<'a> {
    tau: &'a [f64],
    wrenches: Vec<(FrameId, Wrench)>,
}

impl Input for Held<'_> {
    fn torque(&mut self, _: f64, _: &[f64], _: &[f64], tau: &mut [f64]) -> Result<(), mozzi_sim::Error> {
        tau.iter_mut().zip(self.tau).for_each(|(tau, x)| *tau += x);
        Ok(())
    }

    fn applied(
        &mut self,
        _: f64,
        _: &[f64],
        _: &[f64],
        wrenches: &mut Vec<(FrameId, Wrench)>,
    ) -> Result<(), mozzi_sim::Error> {
        wrenches.extend_from_slice(&self.wrenches);
        Ok(())
    }
}
