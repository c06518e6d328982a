//! A model prepared for computing: memory for one state, batches for many.

use crate::failure::of_batch;
use crate::numpy::Element;
use crate::threads::Threads;
use mozzi::quantities::Query;
use mozzi::{Environment, Error, FrameId, Model, fast};
use mozzi_engine::{Batch, Compiled};
use pyo3::prelude::*;
use std::sync::{Mutex, MutexGuard, PoisonError};

pub struct Robot {
    pub model: Model,
    /// Its own gravity, its base at rest, no applied wrenches.
    own: Environment<'static>,
    /// Used while the GIL is held, so that no thread waits for it.
    memory: Mutex<fast::Workspace>,
    double: Mutex<Engines<f64>>,
    single: Mutex<Engines<f32>>,
    pub compiled: Option<Machine>,
    /// Arrays are computed without machine code.
    pub is_kernels_only: bool,
}

/// The quantities that are compiled to machine code.
pub struct Machine {
    pub code: Compiled,
    /// The requested quantities.
    pub names: Vec<Asked>,
    /// For calls without `threads`.
    pub threads: Option<usize>,
}

/// A quantity's name, and its frame's.
pub type Asked = (String, Option<String>);

impl Robot {
    pub fn new(model: Model) -> Self {
        let memory = Mutex::new(fast::Workspace::new(&model));
        Robot {
            own: model.environment(),
            model,
            memory,
            double: Mutex::default(),
            single: Mutex::default(),
            compiled: None,
            is_kernels_only: false,
        }
    }

    /// Computes the quantity at one state; lengths, frame and rows are already checked. Uses machine code if there is
    /// some and the environment is the robot's own, which is `None`. `fast::compute` would repeat all checks, which
    /// takes a tenth of the time of an arm's recursion.
    #[inline]
    pub fn one(
        &self,
        query: &Query,
        inputs: &[&[f64]],
        environment: Option<&Environment>,
        out: &mut [&mut [f64]],
    ) -> Result<(), Error> {
        if query.declaration().needs_mass {
            query.check_subject(&self.model)?;
        }
        if inputs[0].len() == self.model.nq() {
            self.model.check_configuration(inputs[0])?;
        }
        let are_pivots_clear = match (&self.compiled, environment) {
            (Some(machine), None) => machine.code.evaluate(*query, inputs, out),
            (_, environment) => {
                let (environment, mut memory) = (environment.unwrap_or(&self.own), unpoisoned(&self.memory));
                fast::evaluate(query, &self.model, inputs, environment, &mut memory, out);
                memory.are_pivots_clear(query)
            }
        };
        if !are_pivots_clear {
            let found = self.model.compute(*query, inputs, environment.unwrap_or(&self.own))?;
            out.iter_mut().zip(found).for_each(|(out, found)| out.copy_from_slice(&found));
        }
        Ok(())
    }

    fn fresh_batch<T: Element>(&self) -> Batch<T> {
        let batch = Batch::of(&self.model);
        if self.is_kernels_only { batch.kernels_only() } else { batch }
    }

    /// The frame of this name; without a name, the end effector.
    #[inline]
    pub fn frame(&self, name: Option<&str>) -> Result<FrameId, Error> {
        name.map_or_else(|| self.model.end_effector(), |name| self.model.frame(name))
    }

    /// The batch on this many threads; without a number, on the threads for which the robot was compiled, or all cores.
    pub fn batch<T: HasEngines>(&self, threads: Option<Threads>) -> PyResult<Batch<T>> {
        let compiled_for = || self.compiled.as_ref().and_then(|machine| machine.threads).map(Threads);
        let threads = threads.or_else(compiled_for);
        let mut engines = unpoisoned(T::engines(self));
        if engines.process != std::process::id() {
            // their threads do not exist in this process, and dropping would wait for them
            std::mem::forget(std::mem::take(&mut *engines));
        }
        if let Some((_, batch)) = engines.made.iter().find(|(known, _)| *known == threads) {
            return Ok(batch.clone());
        }
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        let count = threads.map(|Threads(count)| count).or_else(|| is_fork().then(cores));
        // all share their machine code
        let batch = engines.base.get_or_insert_with(|| T::batch(self)).clone();
        let batch =
            count.map_or(Ok(batch.clone()), |count| batch.with_threads(count)).map_err(|error| of_batch(error, &[]))?;
        engines.made.push((threads, batch.clone()));
        Ok(batch)
    }
}

/// Ignores poisoning: memory left by a panic means nothing between calls and may be used again.
fn unpoisoned<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The batches that were needed for a model, by their number of threads.
pub struct Engines<T: Element> {
    /// The process in which they were made: a fork has none of their threads.
    process: u32,
    base: Option<Batch<T>>,
    made: Vec<(Option<Threads>, Batch<T>)>,
}

impl<T: Element> Default for Engines<T> {
    fn default() -> Self {
        Engines { process: std::process::id(), base: None, made: Vec::new() }
    }
}

/// The number types that a robot computes with.
pub trait HasEngines: Element {
    fn engines(robot: &Robot) -> &Mutex<Engines<Self>>;

    /// A batch on the threads that all batches share; for a compiled robot with its machine code.
    fn batch(robot: &Robot) -> Batch<Self>;

    /// [`Robot::one`], for the number type that it supports.
    fn one_state(
        _robot: &Robot,
        _query: &Query,
        _inputs: &[&[Self]],
        _environment: Option<&Environment>,
        _out: &mut [&mut [Self]],
    ) -> Option<Result<(), Error>> {
        None
    }
}

impl HasEngines for f64 {
    fn engines(robot: &Robot) -> &Mutex<Engines<f64>> {
        &robot.double
    }
    fn batch(robot: &Robot) -> Batch<f64> {
        match &robot.compiled {
            Some(machine) => machine.code.batch().clone(),
            None => robot.fresh_batch(),
        }
    }
    fn one_state(
        robot: &Robot,
        query: &Query,
        inputs: &[&[f64]],
        environment: Option<&Environment>,
        out: &mut [&mut [f64]],
    ) -> Option<Result<(), Error>> {
        Some(robot.one(query, inputs, environment, out))
    }
}

impl HasEngines for f32 {
    fn engines(robot: &Robot) -> &Mutex<Engines<f32>> {
        &robot.single
    }
    fn batch(robot: &Robot) -> Batch<f32> {
        robot.fresh_batch()
    }
}

/// True if this process was forked from the one that loaded the module: then it lacks the threads that all batches
/// share.
fn is_fork() -> bool {
    static LOADED_BY: std::sync::OnceLock<u32> = std::sync::OnceLock::new();
    *LOADED_BY.get_or_init(std::process::id) != std::process::id()
}

/// Must be called when the module is loaded.
pub fn remember_process() {
    is_fork();
}
