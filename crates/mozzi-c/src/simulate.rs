//! A simulation of one robot: torques come from a callback, rows go to one.

use crate::batch::{AUTOMATIC, method};
use crate::border::{check_finite, slice};
use crate::handle::{borrow, check_pointer};
use crate::program::ProgramHandle;
use crate::robot::ModelHandle;
use crate::status::{Outcome, Status, guard, of_simulation, refuse};
use mozzi::{Model, Vec3};
use mozzi_sim::{Ending, Error, Friction, Input, Options, Policy, Recorder, Sample, Simulation};
use std::cell::Cell;
use std::ffi::c_void;
use std::ops::ControlFlow;

/// `mozzi_torque`.
type Torque = Option<unsafe extern "C" fn(*mut c_void, f64, *const f64, *const f64, *mut f64) -> i32>;
/// `mozzi_record`.
type Record = Option<unsafe extern "C" fn(*mut c_void, *const CSample) -> i32>;

/// `mozzi_sample`: arrays live during the call.
#[repr(C)]
#[derive(Debug)]
pub struct CSample {
    t: f64,
    theta: *const f64,
    dtheta: *const f64,
    ddtheta: *const f64,
    tau: *const f64,
    kinetic_energy: f64,
    potential_energy: f64,
    motor_work: f64,
    friction_loss: f64,
    applied_work: f64,
}

/// `mozzi_simulation_options`.
#[repr(C)]
#[derive(Debug)]
pub struct CSimulationOptions {
    duration: f64,
    steps: usize,
    record_every: usize,
    method: i32,
    joint_limits: i32,
    tolerance: f64,
    slip_speed: f64,
    gravity: *const f64,
}

/// `mozzi_ending`.
#[repr(C)]
#[derive(Debug)]
pub struct CEnding {
    steps: usize,
    complete: i32,
    stops: usize,
    constraint_residual: f64,
}

impl CSimulationOptions {
    /// # Safety
    /// Its pointers are null or valid.
    unsafe fn read(&self) -> Outcome<Options> {
        let gravity = match self.gravity.is_null() {
            true => None,
            // SAFETY: the caller's promise.
            false => unsafe { slice(self.gravity, 3, "options.gravity")?.first_chunk::<3>() },
        };
        let joint_limits = match self.joint_limits {
            0 => Policy::Ignore,
            1 => Policy::Report,
            2 => Policy::Respect,
            other => {
                let expected = "a MOZZI_LIMITS_…";
                return refuse!(Status::INVALID_ARGUMENT, "options.joint_limits is {other}, expected {expected}");
            }
        };
        let friction = match self.slip_speed {
            0.0 => Friction::Coulomb,
            slip_speed => Friction::Smooth { slip_speed },
        };
        Ok(Options {
            method: method(self.method, self.tolerance)?,
            record_every: self.record_every,
            gravity: gravity.copied().map(Vec3),
            friction,
            joint_limits,
            ..Options::new(self.duration, self.steps)
        })
    }
}

/// C's functions and what is handed to them.
struct Caller<'a> {
    torque: Torque,
    record: Record,
    user: *mut c_void,
    /// Set when the torque function reported a failure.
    failed: &'a Cell<bool>,
}

impl Input for Caller<'_> {
    fn torque(&mut self, t: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), Error> {
        let Some(function) = self.torque else { return Ok(()) };
        // SAFETY: the caller's function, with arrays of the lengths that mozzi.h states.
        let status = unsafe { function(self.user, t, theta.as_ptr(), dtheta.as_ptr(), tau.as_mut_ptr()) };
        if status == 0 {
            return Ok(());
        }
        self.failed.set(true);
        let (found, expected) = (format!("{status} at t = {t} s"), "0");
        Err(mozzi::Error::BadArgument { what: "the torque function's result", found, expected }.into())
    }
}

impl Recorder for Caller<'_> {
    fn take(&mut self, row: &Sample) -> ControlFlow<()> {
        let Some(function) = self.record else { return ControlFlow::Continue(()) };
        let sample = CSample {
            t: row.t,
            theta: row.theta.as_ptr(),
            dtheta: row.dtheta.as_ptr(),
            ddtheta: row.ddtheta.as_ptr(),
            tau: row.tau.as_ptr(),
            kinetic_energy: row.energy.kinetic,
            potential_energy: row.energy.potential,
            motor_work: row.energy.motor_work,
            friction_loss: row.energy.friction_loss,
            applied_work: row.energy.applied_work,
        };
        // SAFETY: the caller's function, with a row that lives during the call.
        match unsafe { function(self.user, &raw const sample) } {
            0 => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        }
    }
}

/// Options that are the automatic method, every row, limits reported.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_simulation_defaults(
    duration: f64,
    steps: usize,
    options: *mut CSimulationOptions,
) -> Status {
    // SAFETY: the caller's promise, as everywhere in this file.
    guard(|| unsafe {
        check_pointer(options.cast_const(), "options")?;
        options.write(CSimulationOptions {
            duration,
            steps,
            record_every: 1,
            method: AUTOMATIC,
            joint_limits: 1,
            tolerance: 1e-9,
            slip_speed: 0.0,
            gravity: std::ptr::null(),
        });
        Ok(())
    })
}

/// Simulates.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_simulate(
    model: *const ModelHandle,
    program: *const ProgramHandle,
    options: *const CSimulationOptions,
    theta: *const f64,
    dtheta: *const f64,
    torque: Torque,
    record: Record,
    user: *mut c_void,
    ending: *mut CEnding,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let robot = borrow(model)?;
        let compiled = if program.is_null() { None } else { Some(borrow(program)?) };
        if let Some(program) = compiled
            && !std::sync::Arc::ptr_eq(&program.robot, robot)
        {
            return refuse!(Status::FOREIGN, "the program is of another model");
        }
        check_pointer(options, "options")?;
        let options = (*options).read()?;
        let (theta, dtheta) = (slice(theta, robot.model.nq(), "theta")?, slice(dtheta, robot.model.n(), "dtheta")?);
        robot.check_theta(theta, "theta")?;
        check_finite(dtheta, "dtheta")?;
        let failed = Cell::new(false);
        let forward_dynamics = compiled.and_then(|program| program.compiled.simulator());
        let simulation = Simulation { forward_dynamics, ..Simulation::new(options) };
        let caller = || Caller { torque, record, user, failed: &failed };
        let found = run(&simulation, &robot.model, theta, dtheta, caller(), caller());
        let found = found.map_err(|error| match failed.get() {
            true => crate::status::failure(Status::CALLBACK, format_args!("{error}")),
            false => of_simulation(&error),
        })?;
        let (complete, stops) = (found.complete.into(), found.stops.len());
        let constraint_residual = found.closing.residual;
        let written = CEnding { steps: found.steps, complete, stops, constraint_residual };
        crate::border::put_if_wanted(written, ending, "ending")
    })
}

fn run(
    simulation: &Simulation,
    model: &Model,
    theta: &[f64],
    dtheta: &[f64],
    input: Caller,
    mut recorder: Caller,
) -> Result<Ending, Error> {
    simulation.stream(model, theta, dtheta, input, &mut recorder, |_| ControlFlow::Continue(()))
}
