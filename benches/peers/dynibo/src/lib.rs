//! dynibo behind the C interface of `benches/peers/peer.hpp`. It reads only URDF. For a floating base it uses
//! velocities, accelerations and forces in the world's axes, at the root's origin; they are converted here, outside of
//! the timed section.
#![allow(non_snake_case)] // R, X, M

mod robot;

use robot::{QUANTITIES, Robot};
use std::ffi::{CStr, CString, c_char, c_int};
use std::hint::black_box;
use std::sync::OnceLock;

#[unsafe(no_mangle)]
pub extern "C" fn peer_version() -> *const c_char {
    c"dynibo 0.5.3".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn peer_convention() -> *const c_char {
    c"mozzi".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn peer_flags() -> *const c_char {
    static TEXT: OnceLock<CString> = OnceLock::new();
    let flags = || CString::new(option_env!("PEER_FLAGS").unwrap_or("release")).unwrap_or_default();
    TEXT.get_or_init(flags).as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn peer_quantity(_robot: *const Robot, k: c_int) -> *const c_char {
    QUANTITIES.get(k as usize).map_or(std::ptr::null(), |(quantity, _)| quantity.as_ptr())
}

#[unsafe(no_mangle)]
pub extern "C" fn peer_algorithm(_robot: *const Robot, k: c_int) -> *const c_char {
    QUANTITIES[k as usize].1.as_ptr()
}

/// # Safety
/// `urdf` is a null-terminated string; the numbers are not used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peer_robot(
    name: *const c_char,
    urdf: *const c_char,
    _gravity: *const f64,
    is_floating: c_int,
    _bodies: *const f64,
    _count: c_int,
) -> *mut Robot {
    // SAFETY: by the caller.
    let (name, urdf) = unsafe { (CStr::from_ptr(name), CStr::from_ptr(urdf)) };
    match Robot::new(&urdf.to_string_lossy(), is_floating != 0) {
        Ok(robot) => Box::into_raw(Box::new(robot)),
        Err(why) => {
            eprintln!("dynibo, {}: {why}", name.to_string_lossy());
            std::ptr::null_mut()
        }
    }
}

/// # Safety
/// The robot is one of `peer_robot`'s, and not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peer_free(robot: *mut Robot) {
    // SAFETY: by the caller.
    drop(unsafe { Box::from_raw(robot) });
}

/// # Safety
/// The robot is one of `peer_robot`'s; `x` has `count` states, each θ, θ̇, θ̈, τ.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peer_states(robot: *mut Robot, x: *const f64, count: c_int) {
    // SAFETY: by the caller.
    let robot = unsafe { &mut *robot };
    let length = count as usize * robot.state_length();
    // SAFETY: by the caller.
    robot.set_states(unsafe { std::slice::from_raw_parts(x, length) });
}

/// # Safety
/// The robot is one of `peer_robot`'s.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peer_run(robot: *mut Robot, algorithm: c_int) {
    // SAFETY: by the caller.
    let robot = unsafe { &mut *robot };
    for state in 0..robot.state_count() {
        robot.run(algorithm as usize, state);
        black_box(&mut *robot);
    }
}

/// # Safety
/// The robot is one of `peer_robot`'s; `out` has room for the quantity.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peer_result(robot: *mut Robot, algorithm: c_int, state: c_int, out: *mut f64) {
    // SAFETY: by the caller.
    let robot = unsafe { &mut *robot };
    let result = robot.result(algorithm as usize, state as usize);
    // SAFETY: by the caller.
    unsafe { std::slice::from_raw_parts_mut(out, result.len()) }.copy_from_slice(&result);
}
