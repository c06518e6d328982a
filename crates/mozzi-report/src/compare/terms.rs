//! Compared terms of the dynamics at one state.

use nalgebra::{DMatrix, DVector};

/// M, g, h and τ.
#[derive(Clone, Debug)]
pub struct Numbers {
    pub M: DMatrix<f64>,
    pub g: DVector<f64>,
    pub h: DVector<f64>,
    pub tau: DVector<f64>,
}
