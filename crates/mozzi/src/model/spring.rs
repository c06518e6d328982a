//! Joint springs.

use super::{Freedom, Place};
use crate::lie::RotationVector;
use crate::linalg::Vec3;
use crate::scalar::Scalar;

/// The springs of an independent joint and its mimic joints, as one spring on θ_j: f = K θ_j − p and 𝒫 = ½K θ_j² − p
/// θ_j + a constant. For springs k(q − θ₀) on q = ratio θ_j + offset, K = Σ ratio² k and p = Σ ratio k (θ₀ − offset). A
/// ball's spring acts on the rotation vector φ from its orientation at 0: f = K φ and 𝒫 = ½K ‖φ‖², with p = 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spring<C> {
    /// The joint's place.
    pub place: Place,
    /// K.
    pub stiffness: C,
    /// p = −f_s at θ = 0.
    pub preload: C,
}

impl<C: Scalar> Spring<C> {
    /// The spring's displacement from 0, one number per velocity of the joint: θ, or φ for a ball.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn stretch<S: Scalar>(place: &Place, theta: &[S]) -> [S; 3] {
        match place.freedom {
            Freedom::One => [theta[place.q], S::zero(), S::zero()],
            _ => of_ball(place, theta).phi.0,
        }
    }

    /// Adds f_s = K θ − p to a force.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn add_force<S: Scalar + From<C>>(&self, theta: &[S], tau: &mut [S]) {
        let (stiffness, preload) = (S::from(self.stiffness), S::from(self.preload));
        for (j, x) in self.place.velocities().zip(Self::stretch(&self.place, theta)) {
            tau[j] += stiffness.mul_add(x, -preload);
        }
    }

    /// Adds ∂f_s/∂θ to the n × n entries of ∂τ/∂θ: K on the diagonal; for a ball, K ∂φ.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn add_stiffness<S: Scalar + From<C>>(&self, n: usize, theta: &[S], d_theta: &mut [S]) {
        let (stiffness, j) = (S::from(self.stiffness), self.place.j);
        match self.place.freedom {
            Freedom::One => d_theta[j * n + j] += stiffness,
            _ => {
                for (r, row) in of_ball(&self.place, theta).derivative().rows().into_iter().enumerate() {
                    for (c, entry) in row.into_iter().enumerate() {
                        d_theta[(j + r) * n + j + c] += stiffness * entry;
                    }
                }
            }
        }
    }

    /// Adds xᵀ∂f_s/∂θ.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn add_vjp<S: Scalar + From<C>>(&self, theta: &[S], x: &[S], d_theta: &mut [S]) {
        let (stiffness, j) = (S::from(self.stiffness), self.place.j);
        match self.place.freedom {
            Freedom::One => d_theta[j] = stiffness.mul_add(x[j], d_theta[j]),
            _ => {
                for (r, row) in of_ball(&self.place, theta).derivative().rows().into_iter().enumerate() {
                    for (c, entry) in row.into_iter().enumerate() {
                        d_theta[j + c] += stiffness * entry * x[j + r];
                    }
                }
            }
        }
    }

    /// ½K θ² − p θ: the energy of the spring, less that at θ = 0.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn energy<S: Scalar + From<C>>(&self, theta: &[S]) -> S {
        let (half, preload) = (S::from_f64(0.5) * S::from(self.stiffness), S::from(self.preload));
        let stretch = Vec3(Self::stretch(&self.place, theta));
        half.mul_add(stretch.dot(stretch), -preload * stretch.0[0])
    }

    pub fn map<U>(&self, f: impl Fn(C) -> U + Copy) -> Spring<U> {
        Spring { place: self.place, stiffness: f(self.stiffness), preload: f(self.preload) }
    }
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn of_ball<S: Scalar>(place: &Place, theta: &[S]) -> RotationVector<S> {
    let [w, x, y, z] = core::array::from_fn(|k| theta[place.q + k]);
    RotationVector::new(w, Vec3([x, y, z]))
}
