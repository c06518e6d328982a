//! Fixed and floating bases.

use super::Model;
use crate::scalar::Scalar;
use crate::spatial::SpatialInertia;

/// Whether the base link is fixed or floating.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Base {
    /// Fixed: the base link's frame is the space frame {s}.
    #[default]
    Fixed,
    /// Floating: free in SE(3). The first seven positions are its configuration `T_sb` in the format of
    /// [`SE3::to_pose`](crate::SE3::to_pose): the quaternion (w, x, y, z) and the origin (x, y, z). The first six
    /// velocities are its twist 𝒱_b = (ω, v), and the first six forces the wrench (m, f) on it, both in the base link's
    /// own coordinates.
    Floating,
}

impl Base {
    /// The number of its positions in θ: 0 or 7.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn positions(self) -> usize {
        match self {
            Base::Fixed => 0,
            Base::Floating => 7,
        }
    }

    /// The number of its velocities in θ̇: 0 or 6.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn velocities(self) -> usize {
        match self {
            Base::Fixed => 0,
            Base::Floating => 6,
        }
    }
}

impl<C: Scalar> Model<C> {
    /// Whether the base link is fixed or floating.
    pub fn base(&self) -> Base {
        self.base
    }

    /// True if the base is floating.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn is_floating(&self) -> bool {
        self.base == Base::Floating
    }

    /// 𝒢_b of the base link and all links fixed to it, in its frame. The dynamics use it only for a floating base.
    pub fn base_inertia(&self) -> SpatialInertia<C> {
        self.base_inertia
    }
}
