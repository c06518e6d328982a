//! Quantities that divide and are derived nevertheless, as fractions.

/// Accelerations of joint forces, by three kernels.
const FORWARD_DYNAMICS: [&str; 3] =
    ["forward_dynamics", "forward_dynamics_by_mass_matrix", "forward_dynamics_by_inverse_dynamics"];
/// Accelerations of a robot with constraints.
pub(crate) const CONSTRAINED: &str = "constrained_forward_dynamics";

/// True if a quantity that divides is derived as a fraction.
pub fn is_fraction(quantity: &str) -> bool {
    FORWARD_DYNAMICS.contains(&quantity)
        || ["mass_matrix_inverse", "task_space_dynamics", CONSTRAINED].contains(&quantity)
}
