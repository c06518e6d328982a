//! Rotors that several joints turn.

use crate::scalar::Scalar;
use alloc::vec::Vec;

/// A rotor whose rate is a constant combination of velocities, J θ̇: it adds a JᵀJ to M. Mimic joints are included by
/// their source joints, as in M.
#[derive(Clone, Debug)]
pub(crate) struct Rotor<C> {
    /// a.
    pub armature: C,
    /// J: indices of velocities, in order, and the entries there.
    pub J: Vec<(usize, C)>,
}

impl<C: Scalar> Rotor<C> {
    /// J θ̇, or J θ̈.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn rate<S: Scalar + From<C>>(&self, dtheta: &[S]) -> S {
        let mut sum = S::zero();
        for &(j, entry) in &self.J {
            sum = S::from(entry).mul_add(dtheta[j], sum);
        }
        sum
    }

    /// Adds x Jᵀ to a force.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn add<S: Scalar + From<C>>(&self, x: S, tau: &mut [S]) {
        for &(j, entry) in &self.J {
            tau[j] = S::from(entry).mul_add(x, tau[j]);
        }
    }

    /// The velocities that turn it.
    pub fn joints(&self) -> impl Iterator<Item = usize> {
        self.J.iter().map(|&(j, _)| j)
    }

    pub fn map<U>(&self, f: impl Fn(C) -> U + Copy) -> Rotor<U> {
        Rotor { armature: f(self.armature), J: self.J.iter().map(|&(j, entry)| (j, f(entry))).collect() }
    }
}
