//! A model with what computing takes: memory for one state, batches for many.

use crate::compiled;
use crate::failure::of_batch;
use crate::quantity::Quantity;
use crate::threads::Threads;
use mozzi::{Environment, FrameId, Model, fast};
use mozzi_batch::{Batch, Number};
use mozzi_codegen::Compiled;
use pyo3::prelude::*;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Memory for the kernels at one state.
pub struct Memory {
    pub fast: fast::Workspace,
    pub plain: mozzi::Workspace,
}

impl Memory {
    fn new(model: &Model) -> Self {
        Memory { fast: fast::Workspace::new(model), plain: mozzi::Workspace::new(model) }
    }
}

pub struct Robot {
    pub model: Model,
    /// Used while Python's lock is held, so that nobody waits.
    memory: Mutex<Memory>,
    double: Mutex<Engines<f64>>,
    single: Mutex<Engines<f32>>,
    pub compiled: Option<Machine>,
}

/// The quantities that are machine code.
pub struct Machine {
    pub code: Compiled,
    /// As they were asked for.
    pub names: Vec<Asked>,
    pub threads: Option<usize>,
}

/// A quantity's name, and its frame's where it is of one.
pub type Asked = (String, Option<String>);

impl Robot {
    pub fn new(model: Model) -> Self {
        let memory = Mutex::new(Memory::new(&model));
        Robot { model, memory, double: Mutex::default(), single: Mutex::default(), compiled: None }
    }

    /// The quantity at one state, whose lengths were checked; by machine code where nothing but the robot's own surrounds it.
    #[inline(always)]
    pub fn one(
        &self,
        quantity: Quantity,
        state: &[&[f64]],
        environment: Option<&Environment>,
        out: &mut [&mut [f64]],
    ) -> Result<(), mozzi::Error> {
        if let (Some(machine), None) = (&self.compiled, environment)
            && compiled::one(&machine.code, quantity, state, out)?
        {
            return Ok(());
        }
        let own = self.model.environment();
        quantity.one(&self.model, &mut self.memory(), state, environment.unwrap_or(&own), out)
    }

    /// The machine code for many states, if it is for as many threads, which this process has.
    pub fn compiled_for_many(&self, threads: Option<Threads>) -> Option<&Compiled> {
        let machine = self.compiled.as_ref()?;
        let is_asked = threads.is_none_or(|Threads(count)| machine.threads == Some(count));
        (is_asked && (machine.threads == Some(1) || !is_fork())).then_some(&machine.code)
    }

    #[inline(always)]
    pub fn memory(&self) -> MutexGuard<'_, Memory> {
        unpoisoned(&self.memory)
    }

    /// The frame of this name; without one the end effector.
    pub fn frame(&self, name: Option<&str>) -> Result<FrameId, mozzi::Error> {
        name.map_or_else(|| self.model.end_effector(), |name| self.model.frame(name))
    }
}

/// A panic leaves memory that has no meaning between calls, which may be used again.
fn unpoisoned<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The batches of a model that were needed, by their number of threads.
pub struct Engines<T: Number> {
    /// The process that they were made in: a fork has none of their threads.
    process: u32,
    made: Vec<(Option<Threads>, Batch<T>)>,
}

impl<T: Number> Default for Engines<T> {
    fn default() -> Self {
        Engines { process: std::process::id(), made: Vec::new() }
    }
}

/// The numbers that a robot has batches for.
pub trait HasEngines: Number {
    fn engines(robot: &Robot) -> &Mutex<Engines<Self>>;
}
impl HasEngines for f64 {
    fn engines(robot: &Robot) -> &Mutex<Engines<f64>> {
        &robot.double
    }
}
impl HasEngines for f32 {
    fn engines(robot: &Robot) -> &Mutex<Engines<f32>> {
        &robot.single
    }
}

/// Was this process forked from the one that loaded the module? Then the threads that all batches share stayed behind.
fn is_fork() -> bool {
    static LOADED_BY: std::sync::OnceLock<u32> = std::sync::OnceLock::new();
    *LOADED_BY.get_or_init(std::process::id) != std::process::id()
}

/// To be called when the module is loaded.
pub fn remember_process() {
    is_fork();
}

/// The batch on this many threads; without a number on all cores.
pub fn batch<T: HasEngines>(robot: &Robot, threads: Option<Threads>) -> PyResult<Batch<T>> {
    let mut engines = unpoisoned(T::engines(robot));
    if engines.process != std::process::id() {
        // their threads do not exist here, and dropping would wait for them
        std::mem::forget(std::mem::take(&mut *engines));
    }
    if let Some((_, batch)) = engines.made.iter().find(|(known, _)| *known == threads) {
        return Ok(batch.clone());
    }
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    let count = threads.map(|Threads(count)| count).or_else(|| is_fork().then(cores));
    let batch = Batch::<T>::of(&robot.model);
    let batch =
        count.map_or(Ok(batch.clone()), |count| batch.with_threads(count)).map_err(|error| of_batch(error, &[]))?;
    engines.made.push((threads, batch.clone()));
    Ok(batch)
}
