//! The structural zeros of a tree.

use super::{Model, Rotor};
use crate::scalar::Scalar;

impl<C: Scalar> Model<C> {
    /// Whether the entry (i, j) of M(θ), C, ∂τ/∂θ or ∂τ/∂θ̇ can be nonzero: if both joints are on one path from the
    /// base to a tip. A joint with mimic joints is on the paths of all of them; joints that turn the same rotor are
    /// coupled; the six velocities of a floating base are on every path. The pattern is symmetric, and true for i = j.
    ///
    /// M⁻¹ and ∂θ̈ have more nonzeros: two joints are also coupled through a third one.
    ///
    /// Cost O(N · depth), no allocation.
    ///
    /// # Panics
    /// When i or j is not below n.
    pub fn couples(&self, i: usize, j: usize) -> bool {
        assert!(i.max(j) < self.n(), "velocity {} of {}", i.max(j), self.n());
        let base = self.base.velocities();
        let turn_one_rotor =
            |rotor: &Rotor<C>| [i, j].into_iter().all(|j| rotor.joints().any(|of_rotor| of_rotor == j));
        i == j
            || i < base
            || j < base
            || self.carries(i, j)
            || self.carries(j, i)
            || self.rotors.iter().any(turn_one_rotor)
    }

    /// Whether a link moved by velocity i is an ancestor of a link moved by velocity j.
    fn carries(&self, i: usize, j: usize) -> bool {
        let moved = (1..=self.links.len()).filter(|&slot| self.links[slot - 1].j == j);
        moved.into_iter().any(|slot| self.to_base::<C>(slot).any(|(_, link)| link.j == i))
    }
}
