//! The momentum about the centre of mass (Orin, Goswami and Lee 2013).

use super::center_of_mass::centroidal_frame;
use super::momentum::{columns, rate_in_base};
use crate::quantities::{
    Call, DTHETA, Declaration, JACOBIAN, Kernel, Memory, Quantity, SIX, THETA, by_rows, output, sized,
};
use crate::scalar::Scalar;
use crate::spatial::Wrench;

/// See [`momentum_matrix`](super::momentum_matrix).
#[derive(Clone, Copy, Debug)]
pub struct CentroidalMomentumMatrix;
impl Quantity for CentroidalMomentumMatrix {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "centroidal_momentum_matrix",
        "A_G(θ), angular rows first: h_G = A_Gθ̇ is the momentum about the centre of mass",
        &[THETA],
        &[output("A", JACOBIAN, "kg m² or kg m, kg m or kg")],
    )
    .needs_mass();
}
impl Kernel for CentroidalMomentumMatrix {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ..], [A, ..], Memory { workspace, wrenches, .. }) = (c.inputs, c.outputs, c.memory);
        let T_bg = centroidal_frame(c.model, theta, workspace);
        let found = sized(wrenches, c.model.n(), Wrench::zero());
        columns(c.model, T_bg, workspace, found);
        by_rows(found.iter().map(|column| column.to_array()), A);
    }
}

/// See [`momentum_rate`](super::momentum_rate()).
#[derive(Clone, Copy, Debug)]
pub struct CentroidalMomentumBias;
impl Quantity for CentroidalMomentumBias {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "centroidal_momentum_bias",
        "Ȧ_Gθ̇, of ḣ_G = A_Gθ̈ + Ȧ_Gθ̇",
        &[THETA, DTHETA],
        &[output("b", SIX, "N m, N")],
    )
    .needs_mass()
    .at_rest();
}
impl Kernel for CentroidalMomentumBias {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, zero, ..], [b, ..], w) = (c.inputs, c.outputs, &mut c.memory.workspace);
        let T_bg = centroidal_frame(c.model, theta, w);
        let rate = rate_in_base(c.model, theta, dtheta, zero, w);
        b.copy_from_slice(&(T_bg.Ad().transpose() * rate).to_array());
    }
}
