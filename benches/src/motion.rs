//! The simulated motion that simulations are timed with.

pub const STEPS: usize = 1000;
/// Seconds.
pub const STEP: f64 = 1e-3;
/// τ = −BRAKE θ̇, in N m s.
pub const BRAKE: f64 = 0.1;
