//! Numbers from the files of `oracles/`, and errors relative to them.
//!
//! Errors are normalised: |x − reference| over ε times the size of the terms that x is the sum of.
#![allow(dead_code)] // not every test needs all of it

pub mod derivatives;

use mozzi::accuracy::normalized_error;
use nalgebra::DMatrix;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Largest accepted error, in ε.
pub const BOUND: f64 = 1000.0;

pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

pub fn vector(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}
pub fn matrix(value: &Value) -> DMatrix<f64> {
    let rows: Vec<Vec<f64>> = value.as_array().unwrap().iter().map(vector).collect();
    DMatrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j])
}
pub fn column(v: &[f64]) -> DMatrix<f64> {
    DMatrix::from_column_slice(v.len(), 1, v)
}
pub fn largest_square(v: &[f64]) -> f64 {
    v.iter().fold(0.0, |m: f64, x| m.max(x * x))
}

/// The worst normalised error of each quantity.
#[derive(Default)]
pub struct Worst(pub BTreeMap<&'static str, f64>);

impl Worst {
    pub fn add(&mut self, what: &'static str, found: &DMatrix<f64>, reference: &DMatrix<f64>, terms: f64) {
        assert_eq!(found.shape(), reference.shape(), "{what}");
        let error = normalized_error(found.as_slice(), reference.as_slice(), terms);
        let worst = self.0.entry(what).or_insert(0.0);
        // NaN must not be lost
        *worst = if error >= *worst || error.is_nan() { error } else { *worst };
    }

    /// For a list, or a single number.
    pub fn add_list(&mut self, what: &'static str, found: &[f64], reference: &Value, terms: f64) {
        let reference = reference.as_f64().map_or_else(|| vector(reference), |number| vec![number]);
        self.add(what, &column(found), &column(&reference), terms);
    }

    pub fn line(&self) -> String {
        self.0.iter().map(|(what, error)| format!("{what} {error:.1}")).collect::<Vec<_>>().join(", ")
    }

    /// Is an error too large, or NaN?
    pub fn failed(&self) -> bool {
        self.0.values().any(|error| !(*error < BOUND))
    }
}
