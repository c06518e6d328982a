//! Helpers shared by the examples: agreement within a tolerance, printed numbers, and plots.

#[cfg(doctest)]
mod book;
pub mod chart;
pub mod plot;
pub mod tracking;

use nalgebra::DMatrix;

/// Panics unless two lists of numbers agree to a tolerance, relative to the largest number expected; prints the largest
/// difference.
pub fn agree<'a>(
    what: &str,
    found: impl IntoIterator<Item = &'a f64>,
    expected: impl IntoIterator<Item = &'a f64>,
    tolerance: f64,
) {
    let (found, expected): (Vec<f64>, Vec<f64>) =
        (found.into_iter().copied().collect(), expected.into_iter().copied().collect());
    assert_eq!(found.len(), expected.len(), "{what}: lists of two lengths");
    let largest = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let scale = if largest > 0.0 { largest } else { 1.0 };
    let error = difference(&found, &expected) / scale;
    assert!(error <= tolerance, "{what}: they differ by {error:e}, more than {tolerance:e}: {found:?} {expected:?}");
    println!("  ✓ {what}: relative difference {error:.0e} ≤ {tolerance:.0e}");
}

/// The largest |a − b|; NaN where there is one.
pub fn difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m, (a, b)| if (a - b).abs() <= m { m } else { (a - b).abs() })
}

/// A row of numbers, four decimals each, as text.
pub fn row<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> String {
    let text = |x: &f64| format!("{:9.4}", if x.abs() < 5e-5 { 0.0 } else { *x }); // no −0.0000
    numbers.into_iter().map(text).collect::<Vec<_>>().join(" ")
}

/// Prints a matrix under its name.
pub fn show(name: &str, matrix: &DMatrix<f64>) {
    let rows: Vec<String> = matrix.row_iter().map(|r| row(r.iter())).collect();
    println!("{name} =\n  [{}]", rows.join("]\n  ["));
}
