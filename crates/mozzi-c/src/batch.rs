//! Many states at once.

use crate::border::{Span, check_apart, check_finite, slice, slice_mut, span};
use crate::handle::{Handle, borrow, check_pointer, clear, free, kind, put};
use crate::program::ProgramHandle;
use crate::robot::{Frame, ModelHandle, Robot};
use crate::status::{Outcome, Status, guard, of_batch, refuse};
use crate::subject::{CSubject, declaration};
use mozzi::{Environment, FrameId, Vec3};
use mozzi_engine::{Batch, BatchEnvironment};
use mozzi_sim::Method;
use std::mem::ManuallyDrop;
use std::sync::Arc;

/// A model prepared for many states.
pub struct Prepared {
    robot: Arc<Robot>,
    /// Not dropped in a fork: it would wait for threads that are not there.
    batch: ManuallyDrop<Batch>,
    /// The process whose threads it has.
    process: u32,
}

kind!(Prepared, "mozzi_batch");

/// `struct mozzi_batch`.
pub type BatchHandle = Handle<Prepared>;

impl Drop for Prepared {
    fn drop(&mut self) {
        if self.process == std::process::id() {
            // SAFETY: dropped here alone.
            unsafe { ManuallyDrop::drop(&mut self.batch) };
        }
    }
}

/// `mozzi_batch_wrench`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct BatchWrench {
    frame: Frame,
    F: *const f64,
}

/// `mozzi_batch_environment`: a pointer that is null is the model's own.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CBatchEnvironment {
    gravity: *const f64,
    gravity_of_each: *const f64,
    parameters_of_each: *const f64,
    wrenches: *const BatchWrench,
    wrench_count: usize,
}

/// An input or output: rows of one state after the other.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Table<P> {
    data: P,
    length: usize,
}

impl Prepared {
    fn new(robot: &Arc<Robot>, batch: Batch, threads: usize) -> Outcome<Self> {
        // a number, so that the threads are this batch's own: those that all share may be of the process before a fork
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        let threads = if threads == 0 { cores() } else { threads };
        let batch = batch.with_threads(threads).map_err(|error| of_batch(&error))?;
        Ok(Prepared { robot: robot.clone(), batch: ManuallyDrop::new(batch), process: std::process::id() })
    }

    /// The batch, in the process that made it.
    fn batch(&self) -> Outcome<&Batch> {
        if self.process == std::process::id() {
            return Ok(&self.batch);
        }
        let expected = "one that this process makes: threads do not survive a fork";
        refuse!(Status::FORKED, "the batch was made by process {}, expected {expected}", self.process)
    }

    /// Calls with the environment of a batch.
    ///
    /// # Safety
    /// The pointer is null or valid.
    unsafe fn with_environment(
        &self,
        environment: *const CBatchEnvironment,
        states: usize,
        call: impl FnOnce(&BatchEnvironment) -> Outcome,
    ) -> Outcome {
        let robot = &*self.robot;
        if environment.is_null() {
            return call(&robot.own.into());
        }
        check_pointer(environment, "environment")?;
        // SAFETY: the caller's promise, as everywhere in this function.
        let given = unsafe { &*environment };
        let mut own: Environment = robot.own;
        if !given.gravity.is_null() {
            // SAFETY: as above.
            let g = unsafe { slice(given.gravity, 3, "environment.gravity")? };
            check_finite(g, "environment.gravity")?;
            own.gravity = Vec3([g[0], g[1], g[2]]);
        }
        // SAFETY: as above.
        let table = |numbers: *const f64, width: usize, name| unsafe {
            if numbers.is_null() { Ok(None) } else { finite_rows(numbers, states, width, name).map(Some) }
        };
        // SAFETY: as above.
        let wrenches = unsafe { slice(given.wrenches, given.wrench_count, "environment.wrenches")? };
        let wrench = |wrench: &BatchWrench| {
            // SAFETY: as above.
            let table = unsafe { finite_rows(wrench.F, states, 6, "a wrench of the environment")? };
            Ok((robot.frame(wrench.frame)?, table))
        };
        let wrenches: Vec<(FrameId, &[f64])> = wrenches.iter().map(wrench).collect::<Outcome<_>>()?;
        let parameters =
            table(given.parameters_of_each, robot.model.parameter_count(), "environment.parameters_of_each")?;
        let gravity = table(given.gravity_of_each, 3, "environment.gravity_of_each")?;
        call(&BatchEnvironment { environment: own, wrenches: &wrenches, gravity, parameters })
    }
}

/// The tables of an environment.
fn tables<'a>(environment: &BatchEnvironment<'a>) -> impl Iterator<Item = (&'static str, Span)> + use<'a> {
    let own = [("the gravity of each", environment.gravity), ("the parameters of each", environment.parameters)];
    let wrenches = environment.wrenches.iter().map(|(_, table)| ("a wrench", span(table)));
    own.into_iter().filter_map(|(name, table)| Some((name, span(table?)))).chain(wrenches)
}

/// The numbers of this many rows.
fn count(states: usize, width: usize) -> Outcome<usize> {
    match states.checked_mul(width) {
        Some(count) => Ok(count),
        None => refuse!(Status::INVALID_ARGUMENT, "states is {states}, expected as many as fit in memory"),
    }
}

/// Rows of finite numbers.
///
/// # Safety
/// As [`slice`].
unsafe fn finite_rows<'a>(numbers: *const f64, states: usize, width: usize, name: &str) -> Outcome<&'a [f64]> {
    // SAFETY: the caller's promise.
    let rows = unsafe { slice(numbers, count(states, width)?, name)? };
    check_finite(rows, name)?;
    Ok(rows)
}

/// A batch of a model, changed by `with`.
///
/// # Safety
/// See mozzi.h.
unsafe fn prepare(
    model: *const ModelHandle,
    threads: usize,
    batch: *mut *mut BatchHandle,
    with: impl FnOnce(Batch) -> Batch,
) -> Status {
    // SAFETY: the caller's promise, as everywhere in this file.
    guard(|| unsafe {
        clear(batch)?;
        let robot = borrow(model)?;
        put(Prepared::new(robot, with(Batch::new(&robot.model)), threads)?, batch)
    })
}

/// A batch of a model on this many threads, 0 for all cores.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_batch_new(
    model: *const ModelHandle,
    threads: usize,
    batch: *mut *mut BatchHandle,
) -> Status {
    // SAFETY: the caller's promise, as everywhere in this file.
    unsafe { prepare(model, threads, batch, |batch| batch) }
}

/// A batch that makes no machine code.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_batch_kernels_only(
    model: *const ModelHandle,
    threads: usize,
    batch: *mut *mut BatchHandle,
) -> Status {
    // SAFETY: as above.
    unsafe { prepare(model, threads, batch, Batch::kernels_only) }
}

/// A batch with the machine code of a program.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_batch_with_program(
    program: *const ProgramHandle,
    threads: usize,
    batch: *mut *mut BatchHandle,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        clear(batch)?;
        let program = borrow(program)?;
        put(Prepared::new(&program.robot, program.compiled.batch().clone(), threads)?, batch)
    })
}

/// A quantity at many states.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_batch_compute(
    batch: *const BatchHandle,
    quantity: i32,
    subject: *const CSubject,
    states: usize,
    inputs: *const Table<*const f64>,
    input_count: usize,
    environment: *const CBatchEnvironment,
    outputs: *const Table<*mut f64>,
    output_count: usize,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let prepared = borrow(batch)?;
        let (_, declaration) = declaration(quantity)?;
        let query = CSubject::query(subject, &prepared.robot, quantity)?;
        crate::border::check_length("inputs", input_count, declaration.inputs.len())?;
        crate::border::check_length("outputs", output_count, declaration.outputs.len())?;
        let mut given: Vec<&[f64]> = Vec::with_capacity(input_count);
        let widths = query.input_lengths(&prepared.robot.model);
        for ((table, declared), width) in
            slice(inputs, input_count, "inputs")?.iter().zip(declaration.inputs).zip(widths)
        {
            crate::border::check_length(declared.name, table.length, count(states, width)?)?;
            let numbers = slice(table.data, table.length, declared.name)?;
            check_finite(numbers, declared.name)?;
            given.push(numbers);
        }
        let batch = prepared.batch()?;
        prepared.with_environment(environment, states, |environment| {
            let inputs = declaration.inputs.iter().zip(&given).map(|(input, numbers)| (input.name, span(numbers)));
            let mut taken: Vec<(&str, Span)> = inputs.chain(tables(environment)).collect();
            let mut places: Vec<&mut [f64]> = Vec::with_capacity(output_count);
            let widths = query.output_lengths(&prepared.robot.model);
            for ((table, declared), width) in
                slice(outputs, output_count, "outputs")?.iter().zip(declaration.outputs).zip(widths)
            {
                crate::border::check_length(declared.name, table.length, count(states, width)?)?;
                let place = (table.data.cast_const(), table.length);
                check_apart(declared.name, place, taken.iter().copied())?;
                taken.push((declared.name, place));
                places.push(slice_mut(table.data, table.length, declared.name)?);
            }
            batch.compute(query, &given, environment, &mut places).map_err(|error| of_batch(&error))
        })
    })
}

/// `MOZZI_AUTOMATIC`.
pub const AUTOMATIC: i32 = 6;

/// The method of a number in C.
pub fn method(number: i32, tolerance: f64) -> Outcome<Method> {
    match number {
        0 => Ok(Method::RungeKutta4),
        1 => Ok(Method::Euler),
        2 => Ok(Method::SemiImplicitEuler),
        3 => Ok(Method::DormandPrince { tolerance }),
        4 => Ok(Method::Midpoint),
        5 => Ok(Method::MoreauJean),
        AUTOMATIC => Ok(Method::Automatic),
        other => refuse!(Status::INVALID_ARGUMENT, "the method is {other}, expected one of MOZZI_RUNGE_KUTTA_4, …"),
    }
}

/// Steps of many robots.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_batch_simulate(
    batch: *const BatchHandle,
    states: usize,
    theta: *mut f64,
    dtheta: *mut f64,
    tau: *const f64,
    environment: *const CBatchEnvironment,
    method: i32,
    duration: f64,
    steps: usize,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let prepared = borrow(batch)?;
        let (nq, n) = (prepared.robot.model.nq(), prepared.robot.model.n());
        let method = self::method(method, 1e-9)?;
        if steps == 0 {
            return refuse!(Status::INVALID_ARGUMENT, "steps is 0, expected at least 1");
        }
        let (nq, n) = (count(states, nq)?, count(states, n)?);
        let tau = slice(tau, n, "tau")?;
        check_finite(slice(theta.cast_const(), nq, "theta")?, "theta")?;
        check_finite(slice(dtheta.cast_const(), n, "dtheta")?, "dtheta")?;
        check_finite(tau, "tau")?;
        let batch = prepared.batch()?;
        prepared.with_environment(environment, states, |environment| {
            let [to_theta, to_dtheta] = [(theta.cast_const(), nq), (dtheta.cast_const(), n)];
            let others = || tables(environment).chain([("tau", span(tau))]);
            check_apart("theta", to_theta, others().chain([("dtheta", to_dtheta)]))?;
            check_apart("dtheta", to_dtheta, others())?;
            let (theta, dtheta) = (slice_mut(theta, nq, "theta")?, slice_mut(dtheta, n, "dtheta")?);
            batch.simulate(theta, dtheta, tau, environment, method, duration, steps).map_err(|error| of_batch(&error))
        })
    })
}

/// Frees it.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_batch_free(batch: *mut BatchHandle) -> Status {
    // SAFETY: as above.
    guard(|| unsafe { free(batch) })
}
