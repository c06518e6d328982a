//! What holds the base link: nothing, or the ground.

use super::Model;
use crate::scalar::Scalar;
use crate::spatial::SpatialInertia;

/// How the base link is held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Base {
    /// Fixed: the base link's frame is the space frame {s}.
    #[default]
    Fixed,
    /// Free in SE(3). The first seven positions are its configuration `T_sb`, as [`SE3::to_pose`](crate::SE3::to_pose) has it: the
    /// quaternion (w, x, y, z) and the origin (x, y, z). The first six velocities are its twist 𝒱_b = (ω, v) in the base link's
    /// own coordinates, and the first six forces the wrench (m, f) on it, in the same.
    Floating,
}

impl Base {
    /// The number of positions that it has in θ: 0 or 7.
    #[inline(always)]
    pub fn positions(self) -> usize {
        match self {
            Base::Fixed => 0,
            Base::Floating => 7,
        }
    }

    /// The number of velocities that it has in θ̇: 0 or 6.
    #[inline(always)]
    pub fn velocities(self) -> usize {
        match self {
            Base::Fixed => 0,
            Base::Floating => 6,
        }
    }
}

impl<C: Scalar> Model<C> {
    /// How the base link is held.
    pub fn base(&self) -> Base {
        self.base
    }

    /// Is the base floating?
    #[inline(always)]
    pub fn is_floating(&self) -> bool {
        self.base == Base::Floating
    }

    /// 𝒢_b of the base link with all that is fixed to it, in its frame; it moves, and counts, where the base floats.
    pub fn base_inertia(&self) -> SpatialInertia<C> {
        self.base_inertia
    }
}
