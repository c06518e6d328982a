//! The robot's environment: gravity, the motion of {s}, applied wrenches.

use crate::border::{check_finite, slice};
use crate::handle::{borrow, check_pointer};
use crate::robot::{Frame, ModelHandle, Robot};
use crate::status::{Outcome, Status, guard, refuse};
use mozzi::{Environment, FrameId, Twist, Vec3, Wrench};

/// `mozzi_wrench`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct AppliedWrench {
    frame: Frame,
    F: [f64; 6],
}

/// `mozzi_environment`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CEnvironment {
    gravity: [f64; 3],
    base_twist: [f64; 6],
    base_acceleration: [f64; 6],
    wrenches: *const AppliedWrench,
    wrench_count: usize,
}

impl CEnvironment {
    /// In mozzi's types, the wrenches in a list that has room for one on each frame: nothing is allocated.
    ///
    /// # Safety
    /// The pointer is that of a valid environment.
    pub unsafe fn read<'a>(
        this: *const CEnvironment,
        robot: &Robot,
        applied: &'a mut Vec<(FrameId, Wrench)>,
    ) -> Outcome<Environment<'a>> {
        check_pointer(this, "environment")?;
        // SAFETY: the caller's promise.
        let (this, wrenches) = unsafe {
            let this = &*this;
            (this, slice(this.wrenches, this.wrench_count, "environment.wrenches")?)
        };
        check_finite(&this.gravity, "environment.gravity")?;
        check_finite(&this.base_twist, "environment.base_twist")?;
        check_finite(&this.base_acceleration, "environment.base_acceleration")?;
        let most = robot.frames.len();
        if wrenches.len() > most {
            let found = wrenches.len();
            let expected = "at most one for each frame: add those of one frame";
            return refuse!(
                Status::INVALID_ARGUMENT,
                "environment has {found} wrenches for {most} frames, expected {expected}"
            );
        }
        applied.clear();
        for wrench in wrenches {
            check_finite(&wrench.F, "a wrench of the environment")?;
            applied.push((robot.frame(wrench.frame)?, Wrench::from_array(wrench.F)));
        }
        Ok(Environment {
            gravity: Vec3(this.gravity),
            base_twist: Twist::from_array(this.base_twist),
            base_acceleration: Twist::from_array(this.base_acceleration),
            applied,
        })
    }
}

/// The model's own environment.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_environment(model: *const ModelHandle, environment: *mut CEnvironment) -> Status {
    // SAFETY: the caller's promise.
    guard(|| unsafe {
        let robot = borrow(model)?;
        check_pointer(environment.cast_const(), "environment")?;
        environment.write(CEnvironment {
            gravity: robot.own.gravity.0,
            base_twist: [0.0; 6],
            base_acceleration: [0.0; 6],
            wrenches: std::ptr::null(),
            wrench_count: 0,
        });
        Ok(())
    })
}
