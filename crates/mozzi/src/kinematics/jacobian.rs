//! Jacobians of a frame (Modern Robotics, chapter 5).

use super::base_pose;
use crate::lie::SE3;
use crate::model::{FrameId, Model};
use crate::quantities::{Call, Declaration, JACOBIAN, Kernel, Of, Quantity, THETA, by_rows, output, sized};
use crate::scalar::{Scalar, pass};
use crate::spatial::{Twist, Wrench};
use alloc::vec::Vec;
use core::ops::Mul;
use nalgebra::{DMatrix, DVector};

/// The n columns of a Jacobian: 𝒱 = Jθ̇, τ = JᵀF.
#[derive(Clone, Debug, PartialEq)]
pub struct Jacobian<S = f64>(pub Vec<Twist<S>>);

impl<S: Scalar> Mul<&[S]> for &Jacobian<S> {
    type Output = Twist<S>;
    /// 𝒱 = Jθ̇.
    fn mul(self, dtheta: &[S]) -> Twist<S> {
        twist_of(&self.0, dtheta)
    }
}

impl Mul<&DVector<f64>> for &Jacobian<f64> {
    type Output = Twist;
    /// 𝒱 = Jθ̇.
    fn mul(self, dtheta: &DVector<f64>) -> Twist {
        twist_of(&self.0, dtheta.as_slice())
    }
}

impl Jacobian<f64> {
    /// τ = JᵀF.
    pub fn transpose_mul(&self, F: Wrench) -> DVector<f64> {
        DVector::from_iterator(self.0.len(), self.0.iter().map(|column| column.dot(F)))
    }

    /// The 6 × n matrix, angular rows first.
    pub fn matrix(&self) -> DMatrix<f64> {
        DMatrix::from_fn(6, self.0.len(), |row, column| self.0[column].to_array()[row])
    }
}

/// J θ̇, the twist.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn twist_of<S: Scalar>(columns: &[Twist<S>], dtheta: &[S]) -> Twist<S> {
    let mut V = Twist::zero();
    for (&column, &rate) in columns.iter().zip(dtheta) {
        V += column * rate;
    }
    V
}

pass! {
/// The body Jacobian `J_b`(θ) of a frame {b}: 𝒱_b = `J_b` θ̇ in {b} coordinates (Modern Robotics 5.18). Fills the n
/// columns of `J`; zero for joints that do not move the frame. A mimic joint adds ratio × its own column to its source
/// joint's.
///
/// Cost O(depth), no allocation.
///
/// # Panics
/// When θ is not nq long, or `J` not n.
pub fn body_jacobian<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    frame: FrameId,
    J: &mut [Twist<S>],
) {
    body_columns(model, theta, frame, J);
}
}

pass! {
/// The space Jacobian `J_s`(θ) of a frame {b}: 𝒱_s = `J_s` θ̇ in {s} coordinates (Modern Robotics 5.11), by
/// `J_s` = `[Ad_T_sb]` `J_b`. Fills the n columns of `J`.
///
/// Cost O(depth), no allocation.
///
/// # Panics
/// When θ is not nq long, or `J` not n.
pub fn space_jacobian<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    frame: FrameId,
    J: &mut [Twist<S>],
) {
    let T_sb = body_columns(model, theta, frame, J);
    for column in J {
        *column = T_sb.Ad() * *column;
    }
}
}

pass! {
/// Fills the body Jacobian and returns `T_sb`.
pub(crate) fn body_columns<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], frame: FrameId, J: &mut [Twist<S>]) -> SE3<S> {
    model.assert_lengths(theta.len(), [J.len()]);
    J.fill(Twist::zero());
    let frame = model.frame_at::<S>(frame);
    let mut T = frame.T.inverse();                                        // T_{b,i}
    for (_, link) in model.to_base::<S>(frame.slot) {
        J[link.j] += T.Ad() * link.A().twist();                // J_i = Ad_{T_{b,i}} A_i
        T = T * link.transform(theta);                                    // T_{b,i−1} = T_{b,i} T_{i,i−1}
    }
    if model.is_floating() {
        for (column, e) in J.iter_mut().zip(Twist::axes()) {
            *column = T.Ad() * e;                                         // A_0 = I
        }
    }
    base_pose(model, theta) * T.inverse()
}
}

/// See [`space_jacobian`].
#[derive(Clone, Copy, Debug)]
pub struct SpaceJacobian;
impl Quantity for SpaceJacobian {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "space_jacobian",
        "J_s(θ) of a frame: its twist in {s} is J_sθ̇, (ω, v)",
        &[THETA],
        &[output("J", JACOBIAN, "1 or m")],
    )
    .of(Of::Frame);
}
impl Kernel for SpaceJacobian {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ..], [J, ..], frame) = (c.inputs, c.outputs, c.of.frame());
        let columns = sized(&mut c.memory.twists, c.model.n(), Twist::zero());
        space_jacobian(c.model, theta, frame, columns);
        by_rows(columns.iter().map(|column| column.to_array()), J);
    }
}

/// See [`body_jacobian`].
#[derive(Clone, Copy, Debug)]
pub struct BodyJacobian;
impl Quantity for BodyJacobian {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "body_jacobian",
        "J_b(θ) of a frame: its twist in its own coordinates is J_bθ̇, (ω, v)",
        &[THETA],
        &[output("J", JACOBIAN, "1 or m")],
    )
    .of(Of::Frame);
}
impl Kernel for BodyJacobian {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ..], [J, ..], frame) = (c.inputs, c.outputs, c.of.frame());
        let columns = sized(&mut c.memory.twists, c.model.n(), Twist::zero());
        body_jacobian(c.model, theta, frame, columns);
        by_rows(columns.iter().map(|column| column.to_array()), J);
    }
}
