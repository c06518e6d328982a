//! Springs in the joints.

use crate::scalar::Scalar;

/// The springs of an independent joint and its mimic joints, as one spring on θ_j: f = K θ_j − p and 𝒫 = ½K θ_j² − p θ_j + a constant. Of springs
/// k(q − θ₀) on q = ratio θ_j + offset these are K = Σ ratio² k and p = Σ ratio k (θ₀ − offset).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spring<C> {
    /// Place in θ.
    pub q: usize,
    /// Place in τ.
    pub j: usize,
    /// K.
    pub stiffness: C,
    /// p, what the spring exerts at θ = 0.
    pub preload: C,
}

impl<C: Scalar> Spring<C> {
    /// f_s = K θ − p.
    #[inline(always)]
    pub fn force<S: Scalar + From<C>>(&self, theta: &[S]) -> S {
        S::from(self.stiffness).mul_add(theta[self.q], -S::from(self.preload))
    }

    /// ½K θ² − p θ: the energy of the spring, less that at θ = 0.
    #[inline(always)]
    pub fn energy<S: Scalar + From<C>>(&self, theta: &[S]) -> S {
        let half = S::from_f64(0.5) * S::from(self.stiffness);
        theta[self.q] * half.mul_add(theta[self.q], -S::from(self.preload))
    }

    pub fn map<U>(&self, f: impl Fn(C) -> U + Copy) -> Spring<U> {
        Spring { q: self.q, j: self.j, stiffness: f(self.stiffness), preload: f(self.preload) }
    }
}
