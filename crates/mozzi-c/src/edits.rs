//! Edits that give a new model: payloads, locked joints, frames, constraints, states.

use crate::border::{check_finite, slice, text, texts};
use crate::handle::{borrow, clear};
use crate::robot::{Frame, ModelHandle, Robot, put_model};
use crate::status::{Outcome, Status, failure, guard, of_model};
use mozzi::model::{Base, State};
use mozzi::{Error, Model, SE3, SpatialInertia};
use mozzi_urdf::constraints::ConstraintsError;
use std::ffi::c_char;

/// Writes the model that an edit gives, null if it fails.
///
/// # Safety
/// The pointers are null or valid.
unsafe fn edit(
    model: *const ModelHandle,
    edited: *mut *mut ModelHandle,
    how: impl FnOnce(&Robot) -> Outcome<Result<Model, Error>>,
) -> Outcome {
    // SAFETY: the caller's promise.
    unsafe {
        clear(edited)?;
        put_model(how(borrow(model)?)?, edited)
    }
}

/// A configuration of 16 numbers by rows.
///
/// # Safety
/// As [`slice`].
pub unsafe fn pose(T: *const f64, name: &str) -> Outcome<SE3> {
    // SAFETY: the caller's promise.
    let T = unsafe { slice(T, 16, name)? };
    check_finite(T, name)?;
    let rows = std::array::from_fn(|row| std::array::from_fn(|column| T[4 * row + column]));
    SE3::from_rounded_matrix(rows).map_err(|error| failure(Status::INVALID_ARGUMENT, format_args!("{name}: {error}")))
}

fn of_constraints(error: &ConstraintsError) -> Status {
    let status = if matches!(error, ConstraintsError::File { .. }) { Status::NO_FILE } else { Status::REFUSED };
    failure(status, format_args!("{error}"))
}

/// With a payload.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_with_payload(
    model: *const ModelHandle,
    frame: Frame,
    parameters: *const f64,
    edited: *mut *mut ModelHandle,
) -> Status {
    // SAFETY: the caller's promise, as everywhere in this file.
    guard(|| unsafe {
        edit(model, edited, |robot| {
            let parameters = slice(parameters, 10, "parameters")?;
            check_finite(parameters, "parameters")?;
            let inertia = SpatialInertia::from_parameters(std::array::from_fn(|k| parameters[k]));
            Ok(robot.model.with_payload(robot.frame(frame)?, inertia))
        })
    })
}

/// With joints locked at positions.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_with_locked_joints(
    model: *const ModelHandle,
    joints: *const *const c_char,
    positions: *const f64,
    count: usize,
    edited: *mut *mut ModelHandle,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        edit(model, edited, |robot| {
            let (names, positions) = (texts(joints, count, "joints")?, slice(positions, count, "positions")?);
            check_finite(positions, "positions")?;
            let locked: Vec<(&str, f64)> = names.into_iter().zip(positions.iter().copied()).collect();
            Ok(robot.model.with_locked_joints(&locked))
        })
    })
}

/// With a further frame.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_with_frame(
    model: *const ModelHandle,
    name: *const c_char,
    on: Frame,
    T: *const f64,
    edited: *mut *mut ModelHandle,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        edit(model, edited, |robot| {
            let T = pose(T, "T")?;
            Ok(robot.model.with_frame(text(name, "name")?, robot.frame(on)?, T))
        })
    })
}

/// With another end effector.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_with_end_effector(
    model: *const ModelHandle,
    frame: Frame,
    edited: *mut *mut ModelHandle,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe { edit(model, edited, |robot| Ok(robot.model.with_end_effector(robot.frame(frame)?))) })
}

/// Under another gravity.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_with_gravity(
    model: *const ModelHandle,
    gravity: *const f64,
    edited: *mut *mut ModelHandle,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        edit(model, edited, |robot| {
            let g = slice(gravity, 3, "gravity")?;
            check_finite(g, "gravity")?;
            Ok(robot.model.with_gravity([g[0], g[1], g[2]]))
        })
    })
}

/// With a fixed or floating base.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_with_base(
    model: *const ModelHandle,
    floating: i32,
    edited: *mut *mut ModelHandle,
) -> Status {
    let base = if floating == 0 { Base::Fixed } else { Base::Floating };
    // SAFETY: as above.
    guard(|| unsafe { edit(model, edited, |robot| Ok(robot.model.with_base(base))) })
}

/// The chain between two links.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_sub_chain(
    model: *const ModelHandle,
    from: Frame,
    to: Frame,
    edited: *mut *mut ModelHandle,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe { edit(model, edited, |robot| Ok(robot.model.sub_chain(robot.frame(from)?, robot.frame(to)?))) })
}

/// With other inertial parameters.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_with_parameters(
    model: *const ModelHandle,
    parameters: *const f64,
    edited: *mut *mut ModelHandle,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        edit(model, edited, |robot| {
            let parameters = slice(parameters, robot.model.parameter_count(), "parameters")?;
            check_finite(parameters, "parameters")?;
            Ok(Ok(robot.model.with_parameters(parameters)))
        })
    })
}

/// With the constraints and motors of a text.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_with_constraints(
    model: *const ModelHandle,
    constraints: *const c_char,
    edited: *mut *mut ModelHandle,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        edit(model, edited, |robot| {
            let content = text(constraints, "constraints")?;
            let described = robot.model.described().map_err(|error| of_model(&error))?;
            let parsed = mozzi_urdf::constraints::parse("constraints", content, described);
            Ok(parsed.map_err(|error| of_constraints(&error))?.build())
        })
    })
}

/// The tree alone.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_without_constraints(
    model: *const ModelHandle,
    edited: *mut *mut ModelHandle,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe { edit(model, edited, |robot| Ok(robot.model.without_constraints())) })
}

/// With a named state.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_with_state(
    model: *const ModelHandle,
    name: *const c_char,
    theta: *const f64,
    dtheta: *const f64,
    time: f64,
    edited: *mut *mut ModelHandle,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        edit(model, edited, |robot| {
            let (theta, dtheta) = (slice(theta, robot.model.nq(), "theta")?, slice(dtheta, robot.model.n(), "dtheta")?);
            let state = State { time, theta: theta.to_vec(), dtheta: dtheta.to_vec() };
            Ok(robot.model.with_state(text(name, "name")?, &state))
        })
    })
}

/// With one of its states as the start.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_with_start(
    model: *const ModelHandle,
    name: *const c_char,
    edited: *mut *mut ModelHandle,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe { edit(model, edited, |robot| Ok(robot.model.with_start(text(name, "name")?))) })
}

/// Writes θ, θ̇ or θ̈ that satisfy the constraints.
///
/// # Safety
/// As the functions below.
unsafe fn assembled(found: Result<Vec<f64>, Error>, to: *mut f64, name: &str) -> Outcome {
    // SAFETY: the caller's promise.
    unsafe { crate::border::copy_out(&found.map_err(|error| of_model(&error))?, to, name) }
}

/// Positions near a guess that satisfy the constraints.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_assemble(
    model: *const ModelHandle,
    guess: *const f64,
    hold: *const *const c_char,
    hold_count: usize,
    theta: *mut f64,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let robot = borrow(model)?;
        let guess = slice(guess, robot.model.nq(), "guess")?;
        check_finite(guess, "guess")?;
        assembled(robot.model.assemble(guess, &texts(hold, hold_count, "hold")?), theta, "theta")
    })
}

/// Velocities near a guess that satisfy the constraints.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_assemble_velocities(
    model: *const ModelHandle,
    theta: *const f64,
    guess: *const f64,
    hold: *const *const c_char,
    hold_count: usize,
    dtheta: *mut f64,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let robot = borrow(model)?;
        let (theta, guess) = (slice(theta, robot.model.nq(), "theta")?, slice(guess, robot.model.n(), "guess")?);
        robot.check_theta(theta, "theta")?;
        check_finite(guess, "guess")?;
        let hold = texts(hold, hold_count, "hold")?;
        assembled(robot.model.assemble_velocities(theta, guess, &hold), dtheta, "dtheta")
    })
}
