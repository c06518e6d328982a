//! Named states, and the operations ⊕ and ⊖ on positions.

use crate::border::{check_apart, check_finite, copy_out, put_if_wanted, slice, slice_mut, span, text};
use crate::handle::borrow;
use crate::robot::ModelHandle;
use crate::status::{Outcome, Status, guard, of_model};
use mozzi::model::State;
use std::ffi::c_char;

/// Writes the parts of a state that are wanted.
///
/// # Safety
/// The pointers are null or valid.
unsafe fn write(state: &State, theta: *mut f64, dtheta: *mut f64, time: *mut f64) -> Outcome {
    // SAFETY: the caller's promise.
    unsafe {
        if !theta.is_null() {
            copy_out(&state.theta, theta, "theta")?;
        }
        if !dtheta.is_null() {
            copy_out(&state.dtheta, dtheta, "dtheta")?;
        }
        put_if_wanted(state.time, time, "time")
    }
}

/// The state of this name.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_state(
    model: *const ModelHandle,
    name: *const c_char,
    theta: *mut f64,
    dtheta: *mut f64,
    time: *mut f64,
) -> Status {
    // SAFETY: the caller's promise, as everywhere in this file.
    guard(|| unsafe {
        let state = borrow(model)?.model.state(text(name, "name")?).map_err(|error| of_model(&error))?;
        write(&state, theta, dtheta, time)
    })
}

/// The start.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_start(
    model: *const ModelHandle,
    theta: *mut f64,
    dtheta: *mut f64,
    time: *mut f64,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe { write(&borrow(model)?.model.start(), theta, dtheta, time) })
}

/// θ ← θ ⊕ θ̇h. No allocation.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_integrate(
    model: *const ModelHandle,
    theta: *mut f64,
    dtheta: *const f64,
    h: f64,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let robot = borrow(model)?;
        let dtheta = slice(dtheta, robot.model.n(), "dtheta")?;
        robot.check_theta(slice(theta.cast_const(), robot.model.nq(), "theta")?, "theta")?;
        check_finite(dtheta, "dtheta")?;
        check_finite(&[h], "h")?;
        check_apart("theta", (theta.cast_const(), robot.model.nq()), [("dtheta", span(dtheta))])?;
        mozzi::model::integrate(&robot.model, slice_mut(theta, robot.model.nq(), "theta")?, dtheta, h);
        Ok(())
    })
}

/// θ₁ ⊖ θ₀. No allocation.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_difference(
    model: *const ModelHandle,
    theta0: *const f64,
    theta1: *const f64,
    difference: *mut f64,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let robot = borrow(model)?;
        let nq = robot.model.nq();
        let (theta0, theta1) = (slice(theta0, nq, "theta0")?, slice(theta1, nq, "theta1")?);
        robot.check_theta(theta0, "theta0")?;
        robot.check_theta(theta1, "theta1")?;
        let output = (difference.cast_const(), robot.model.n());
        check_apart("difference", output, [("theta0", span(theta0)), ("theta1", span(theta1))])?;
        mozzi::model::difference(&robot.model, theta0, theta1, slice_mut(difference, robot.model.n(), "difference")?);
        Ok(())
    })
}
