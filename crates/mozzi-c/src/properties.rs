//! Sizes, names and numbers of a model.

use crate::border::{copy_out, put_if_wanted, text};
use crate::handle::{borrow, check_pointer};
use crate::robot::{Frame, ModelHandle, Names};
use crate::status::{Status, guard, guard_or, of_model, refuse};
use mozzi::Model;
use mozzi::model::Bounds;
use std::ffi::c_char;

/// `name: |model| size, about`: functions that return a size, 0 for an invalid handle.
macro_rules! sizes {
    ($($name:ident: $size:expr, $about:literal;)*) => {
        $(#[doc = $about]
        ///
        /// # Safety
        /// See mozzi.h.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(model: *const ModelHandle) -> usize {
            let size: fn(&Model) -> usize = $size;
            // SAFETY: the caller's promise.
            guard_or(0, || unsafe { Ok(size(&borrow(model)?.model)) })
        })*
    };
}
sizes! {
    mozzi_model_n: Model::n, "n.";
    mozzi_model_nq: Model::nq, "nq.";
    mozzi_model_joint_count: |model| model.joint_names().len(), "The independent joints.";
    mozzi_model_frame_count: |model| model.frames().len(), "The frames.";
    mozzi_model_body_count: |model| model.moving_links() + usize::from(model.is_floating()), "The bodies b.";
    mozzi_model_parameter_count: Model::parameter_count, "The inertial parameters p.";
    mozzi_model_constraint_rows: Model::constraint_rows, "The constraints' rows m.";
    mozzi_model_state_count: |model| model.state_names().len(), "The named states.";
    mozzi_model_is_floating: |model| model.is_floating().into(), "1 for a floating base.";
}

/// `name: list, about`: functions that return the k-th name, null if there is none.
macro_rules! names {
    ($($name:ident: $list:ident, $about:literal;)*) => {
        $(#[doc = $about]
        ///
        /// # Safety
        /// See mozzi.h.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(model: *const ModelHandle, k: usize) -> *const c_char {
            // SAFETY: the caller's promise.
            guard_or(std::ptr::null(), || unsafe {
                let Names { $list: list, .. } = &borrow(model)?.names;
                match list.get(k) {
                    Some(name) => Ok(name.as_ptr()),
                    None => refuse!(Status::NOT_FOUND, "there is no name {k} in a list of {}", list.len()),
                }
            })
        })*
    };
}
names! {
    mozzi_model_joint_name: joints, "An independent joint's name.";
    mozzi_model_position_name: positions, "The name of an entry of θ.";
    mozzi_model_velocity_name: velocities, "The name of an entry of θ̇.";
    mozzi_model_frame_name: frames, "A frame's name.";
    mozzi_model_parameter_name: parameters, "A parameter's name.";
    mozzi_model_constraint_row_name: constraint_rows, "The name of a constraint's row.";
    mozzi_model_state_name: states, "A named state's name.";
}

/// The robot's name; null for an invalid handle.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_name(model: *const ModelHandle) -> *const c_char {
    // SAFETY: the caller's promise, as everywhere in this file.
    guard_or(std::ptr::null(), || unsafe { Ok(borrow(model)?.names.model.as_ptr()) })
}

/// The mass, kg.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_mass(model: *const ModelHandle) -> f64 {
    // SAFETY: as above.
    guard_or(f64::NAN, || unsafe { Ok(borrow(model)?.model.mass()) })
}

/// Gravity in {s}.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_gravity(model: *const ModelHandle, gravity: *mut f64) -> Status {
    // SAFETY: as above.
    guard(|| unsafe { copy_out(&borrow(model)?.model.gravity().0, gravity, "gravity") })
}

/// π.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_parameters(model: *const ModelHandle, parameters: *mut f64) -> Status {
    // SAFETY: as above.
    guard(|| unsafe { copy_out(&borrow(model)?.model.parameters(), parameters, "parameters") })
}

/// Where a joint's numbers are in θ and θ̇.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_joint_place(
    model: *const ModelHandle,
    k: usize,
    q: *mut usize,
    positions: *mut usize,
    j: *mut usize,
    velocities: *mut usize,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let model = &borrow(model)?.model;
        let Some(place) = model.places().get(k) else {
            return refuse!(Status::NOT_FOUND, "there is no joint {k}: there are {}", model.places().len());
        };
        put_if_wanted(place.q, q, "q")?;
        put_if_wanted(place.freedom.positions(), positions, "positions")?;
        put_if_wanted(place.j, j, "j")?;
        put_if_wanted(place.freedom.velocities(), velocities, "velocities")
    })
}

/// Limits of the independent joints.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_limits(
    model: *const ModelHandle,
    lower: *mut f64,
    upper: *mut f64,
    velocity: *mut f64,
    effort: *mut f64,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let robot = borrow(model)?;
        let bounds = |side: usize| robot.bounds.joints.iter().map(|both| both[side]).collect::<Vec<_>>();
        let limits = || robot.model.joints().map(|joint| joint.limits);
        let wanted = |list: Vec<f64>, to: *mut f64, name| if to.is_null() { Ok(()) } else { copy_out(&list, to, name) };
        wanted(bounds(0), lower, "lower")?;
        wanted(bounds(1), upper, "upper")?;
        let unlimited = f64::INFINITY;
        let [speeds, _] = Bounds::of_rates(&robot.model);
        wanted(speeds, velocity, "velocity")?;
        wanted(limits().map(|limits| limits.effort.unwrap_or(unlimited)).collect(), effort, "effort")
    })
}

/// The frame of this name.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_frame(
    model: *const ModelHandle,
    name: *const c_char,
    frame: *mut Frame,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let (robot, name) = (borrow(model)?, text(name, "name")?);
        check_pointer(frame.cast_const(), "frame")?;
        frame.write(robot.handle_of(robot.model.frame(name).map_err(|error| of_model(&error))?));
        Ok(())
    })
}

/// The frame of this number.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_frame_at(model: *const ModelHandle, k: usize, frame: *mut Frame) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let robot = borrow(model)?;
        check_pointer(frame.cast_const(), "frame")?;
        let Some(&found) = robot.frames.get(k) else {
            return refuse!(Status::NOT_FOUND, "there is no frame {k}: there are {}", robot.frames.len());
        };
        frame.write(robot.handle_of(found));
        Ok(())
    })
}

/// The end effector.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_end_effector(model: *const ModelHandle, frame: *mut Frame) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let robot = borrow(model)?;
        check_pointer(frame.cast_const(), "frame")?;
        frame.write(robot.handle_of(robot.model.end_effector().map_err(|error| of_model(&error))?));
        Ok(())
    })
}

/// Whether each velocity has a motor: 1 or 0, n numbers; a floating base and free joints have none.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_motors(model: *const ModelHandle, is_driven: *mut u8) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let model = &borrow(model)?.model;
        let mut list = vec![0; model.n()];
        model.motors().into_iter().for_each(|j| list[j] = 1);
        copy_out(&list, is_driven, "is_driven")
    })
}
