//! Normalised errors between two computations of a quantity.

/// The largest |x − reference| over ε times the size of the terms that x is the sum of: `terms`, or the largest
/// |reference| if that is larger. About 1 is rounding error; NaN in either gives NaN.
///
/// # Panics
/// When the lengths differ.
pub fn normalized_error(found: &[f64], reference: &[f64], terms: f64) -> f64 {
    assert_eq!(found.len(), reference.len(), "two values of one quantity have as many entries");
    let scale = reference.iter().fold(terms, |m, x| m.max(x.abs()));
    let unit = f64::EPSILON * if scale > 0.0 { scale } else { 1.0 };
    let errors = found.iter().zip(reference).map(|(x, y)| (x - y).abs() / unit);
    errors.fold(0.0, |worst: f64, error| if error.is_nan() || worst.is_nan() { f64::NAN } else { worst.max(error) })
}

/// The sizes of the terms of which the dynamics' quantities are sums, at a state.
#[derive(Clone, Copy, Debug)]
pub struct TermSizes {
    /// Terms of c: max |M| max θ̇².
    pub velocity_product: f64,
    /// Terms of h = c + g.
    pub bias_forces: f64,
    /// Terms of τ = Mθ̈ + h.
    pub inverse_dynamics: f64,
}

impl TermSizes {
    /// From the largest entries of M and of g.
    pub fn new(M: f64, g: f64, dtheta: &[f64], ddtheta: &[f64]) -> Self {
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let velocity_product = M * largest(dtheta) * largest(dtheta);
        let bias_forces = velocity_product + g;
        TermSizes { velocity_product, bias_forces, inverse_dynamics: M * largest(ddtheta) + bias_forces }
    }
}

#[cfg(test)]
mod tests {
    use super::{TermSizes, normalized_error};

    #[test]
    fn errors_are_measured_by_the_terms() {
        let unit = f64::EPSILON;
        assert_eq!(normalized_error(&[1.0 + 2.0 * unit, 0.0], &[1.0, 0.0], 0.0), 2.0);
        assert_eq!(normalized_error(&[8.0 * unit], &[0.0], 4.0), 2.0);
        assert_eq!(normalized_error(&[3.0 * unit], &[0.0], 0.0), 3.0);
        assert!(normalized_error(&[f64::NAN, 1.0], &[0.0, 0.0], 1.0).is_nan());
        assert_eq!(normalized_error(&[], &[], 0.0), 0.0);
        let sizes = TermSizes::new(2.0, 5.0, &[1.0, -3.0], &[4.0, 0.0]);
        assert_eq!((sizes.velocity_product, sizes.bias_forces, sizes.inverse_dynamics), (18.0, 23.0, 31.0));
    }
}
