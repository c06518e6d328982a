//! The structural zeros of a tree.

use super::Model;
use crate::scalar::Scalar;

impl<C: Scalar> Model<C> {
    /// Can the entry (i, j) of M(θ), C, ∂τ/∂θ or ∂τ/∂θ̇ be other than 0? It can where a link that velocity i moves carries one that
    /// velocity j moves, or the other way round: where both joints are on one path from the base to a tip. A joint with its mimic joints
    /// is on the paths of all of them; the six of a floating base are on every path. (i, j) and (j, i) are alike, (i, i) is always true.
    ///
    /// M⁻¹ and ∂θ̈ are fuller: there, two joints couple that some third couples.
    ///
    /// Cost O(N · depth), no allocation.
    ///
    /// # Panics
    /// When i or j is not below n.
    pub fn couples(&self, i: usize, j: usize) -> bool {
        assert!(i.max(j) < self.n(), "velocity {} of {}", i.max(j), self.n());
        let base = self.base.velocities();
        i == j || i < base || j < base || self.carries(i, j) || self.carries(j, i)
    }

    /// Does some link that velocity i moves carry one that j moves?
    fn carries(&self, i: usize, j: usize) -> bool {
        let moved = (1..=self.links.len()).filter(|&slot| self.links[slot - 1].j == j);
        moved.into_iter().any(|slot| self.to_base::<C>(slot).any(|(_, link)| link.j == i))
    }
}
