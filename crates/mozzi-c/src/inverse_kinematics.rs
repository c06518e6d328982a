//! Inverse kinematics of one frame.

use crate::border::{check_finite, copy_out, put_if_wanted, slice};
use crate::edits::pose;
use crate::handle::{Handle, borrow, check_pointer, clear, free, kind, put};
use crate::robot::{Frame, ModelHandle, Robot};
use crate::status::{Outcome, Status, guard, of_motion, refuse};
use mozzi::{Mat3, SO3, Vec3};
use mozzi_motion::inverse_kinematics::{Goal, InverseKinematics, Method, Options, Residual, Secondary};
use std::cell::UnsafeCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A solver with its memory.
pub struct Solver {
    /// Refers to the model that `robot` keeps; dropped first.
    memory: UnsafeCell<Memory>,
    robot: Arc<Robot>,
    is_busy: AtomicBool,
}

struct Memory {
    solver: InverseKinematics<'static>,
    /// θ during a search, so that the caller's arrays may overlap.
    theta: Vec<f64>,
}

// SAFETY: the memory is used by the holder of the mark `is_busy` alone.
unsafe impl Sync for Solver {}

kind!(Solver, "mozzi_inverse_kinematics");

/// `struct mozzi_inverse_kinematics`.
pub type SolverHandle = Handle<Solver>;

/// `mozzi_inverse_kinematics_options`.
#[repr(C)]
#[derive(Debug)]
pub struct COptions {
    method: i32,
    ignore_limits: i32,
    angle: f64,
    distance: f64,
    iterations: usize,
    starts: usize,
    seed: u64,
    length: f64,
}

/// `mozzi_solution`.
#[repr(C)]
#[derive(Debug)]
pub struct CSolution {
    angle: f64,
    distance: f64,
    starts: usize,
    iterations: usize,
}

fn read(options: &COptions) -> Outcome<Options> {
    let method = match options.method {
        0 => Method::LevenbergMarquardt,
        1 => Method::Newton,
        other => {
            let expected = "MOZZI_LEVENBERG_MARQUARDT or MOZZI_NEWTON";
            return refuse!(Status::INVALID_ARGUMENT, "options.method is {other}, expected {expected}");
        }
    };
    let COptions { angle, distance, iterations, starts, seed, length, .. } = *options;
    Ok(Options { method, angle, distance, iterations, starts, seed, length, limits: options.ignore_limits == 0 })
}

/// The default options.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_inverse_kinematics_defaults(options: *mut COptions) -> Status {
    // SAFETY: the caller's promise, as everywhere in this file.
    guard(|| unsafe {
        check_pointer(options.cast_const(), "options")?;
        let Options { angle, distance, iterations, starts, seed, length, .. } = Options::default();
        options.write(COptions { method: 0, ignore_limits: 0, angle, distance, iterations, starts, seed, length });
        Ok(())
    })
}

/// A solver for a frame.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_inverse_kinematics_new(
    model: *const ModelHandle,
    frame: Frame,
    options: *const COptions,
    solver: *mut *mut SolverHandle,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        clear(solver)?;
        let robot = borrow(model)?.clone();
        let options = if options.is_null() {
            Options::default()
        } else {
            check_pointer(options, "options")?;
            read(&*options)?
        };
        // the model stays where it is as long as `robot` is kept, which is longer than the solver
        let model = &(*Arc::as_ptr(&robot)).model;
        let found = InverseKinematics::with_options(model, robot.frame(frame)?, options);
        let (found, theta) = (found.map_err(|error| of_motion(&error))?, vec![0.0; robot.model.nq()]);
        let memory = UnsafeCell::new(Memory { solver: found, theta });
        put(Solver { memory, robot, is_busy: AtomicBool::new(false) }, solver)
    })
}

/// The goal of this kind.
///
/// # Safety
/// The pointer is null, or that of as many numbers as the kind has.
unsafe fn goal(kind: i32, numbers: *const f64) -> Outcome<Goal> {
    // SAFETY: the caller's promise.
    unsafe {
        match kind {
            0 => Ok(Goal::Pose(pose(numbers, "goal")?)),
            1 => {
                let p = slice(numbers, 3, "goal")?;
                check_finite(p, "goal")?;
                Ok(Goal::Position(Vec3([p[0], p[1], p[2]])))
            }
            2 => {
                let R = slice(numbers, 9, "goal")?;
                check_finite(R, "goal")?;
                let rows = std::array::from_fn(|row| std::array::from_fn(|column| R[3 * row + column]));
                match SO3::from_rounded_matrix(Mat3::from_rows(rows)) {
                    Ok(R) => Ok(Goal::Orientation(R)),
                    Err(error) => refuse!(Status::INVALID_ARGUMENT, "goal: {error}"),
                }
            }
            other => refuse!(Status::INVALID_ARGUMENT, "the kind of goal is {other}, expected a MOZZI_GOAL_…"),
        }
    }
}

/// Frees the mark when dropped.
struct Mark<'a>(&'a AtomicBool);
impl Drop for Mark<'_> {
    fn drop(&mut self) {
        self.0.store(false, Ordering::Release);
    }
}

/// Positions that reach a goal.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_inverse_kinematics_solve(
    solver: *mut SolverHandle,
    kind: i32,
    goal: *const f64,
    guess: *const f64,
    near: *const f64,
    theta: *mut f64,
    solution: *mut CSolution,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let Solver { memory, robot, is_busy } = borrow(solver.cast_const())?;
        if is_busy.swap(true, Ordering::Acquire) {
            return refuse!(Status::BUSY, "the solver is in use by another call, expected one for each thread");
        }
        let _mark = Mark(is_busy);
        let (nq, goal) = (robot.model.nq(), self::goal(kind, goal)?);
        let guess = slice(guess, nq, "guess")?;
        robot.check_theta(guess, "guess")?;
        let secondary = match near.is_null() {
            true => Secondary::None,
            false => {
                let near = slice(near, nq, "near")?;
                robot.check_theta(near, "near_theta")?;
                Secondary::Near(near)
            }
        };
        check_pointer(theta.cast_const(), "theta")?;
        let Memory { solver, theta: own } = &mut *memory.get();
        own.copy_from_slice(guess);
        let found = solver.search(goal, &secondary, own).map_err(|error| of_motion(&error))?;
        copy_out(own, theta, "theta")?;
        let Residual { angle, distance } = found.residual;
        let none = f64::NAN; // the goal leaves it free
        let written = CSolution {
            angle: angle.unwrap_or(none),
            distance: distance.unwrap_or(none),
            starts: found.starts,
            iterations: found.iterations,
        };
        put_if_wanted(written, solution, "solution")?;
        if found.is_reached {
            return Ok(());
        }
        let searched = format_args!("{} starts, {} iterations in all", found.starts, found.iterations);
        let begin = format_args!("the goal is not reached: the best of {searched}, is");
        match (angle, distance) {
            (Some(angle), Some(distance)) => {
                refuse!(Status::NOT_REACHED, "{begin} {angle:.2e} rad and {distance:.2e} m away")
            }
            (Some(angle), None) => refuse!(Status::NOT_REACHED, "{begin} {angle:.2e} rad away"),
            (None, distance) => refuse!(Status::NOT_REACHED, "{begin} {:.2e} m away", distance.unwrap_or(none)),
        }
    })
}

/// Frees it.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_inverse_kinematics_free(solver: *mut SolverHandle) -> Status {
    // SAFETY: as above.
    guard(|| unsafe { free(solver) })
}
