//! Checks that a quaternion has unit length.

use crate::scalar::Scalar;

/// The length of a quaternion, if it differs from 1 by more than 10⁻³; `None` for NaN.
pub(crate) fn length_off_unit(q: [f64; 4]) -> Option<f64> {
    let length = Scalar::sqrt(q.iter().map(|x| x * x).sum::<f64>());
    ((length - 1.0).abs() > 1e-3).then_some(length)
}
