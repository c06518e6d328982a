//! Where the numbers of a joint stand in θ and in θ̇.

use super::Model;
use crate::lie::SE3;
use crate::scalar::Scalar;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::ops::Range;

/// On what a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Freedom {
    /// A line, or an angle: one position, its rate.
    One,
    /// SO(3): a unit quaternion (w, x, y, z), and the angular velocity in the axes of what moves.
    Ball,
    /// SE(3): a unit quaternion and the origin (x, y, z), and the twist (ω, v) in the coordinates of what moves.
    Free,
}

impl Freedom {
    /// How many numbers of θ: 1, 4 or 7.
    #[inline(always)]
    pub fn positions(self) -> usize {
        match self {
            Freedom::One => 1,
            Freedom::Ball => 4,
            Freedom::Free => 7,
        }
    }

    /// How many numbers of θ̇, θ̈ and τ: 1, 3 or 6.
    #[inline(always)]
    pub fn velocities(self) -> usize {
        match self {
            Freedom::One => 1,
            Freedom::Ball => 3,
            Freedom::Free => 6,
        }
    }
}

/// An independent joint's place, or a floating base's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// On what it moves.
    pub freedom: Freedom,
    /// Its first number in θ.
    pub q: usize,
    /// Its first number in θ̇, θ̈ and τ.
    pub j: usize,
}

impl Place {
    /// Its numbers in θ.
    #[inline(always)]
    pub fn positions(&self) -> Range<usize> {
        self.q..self.q + self.freedom.positions()
    }

    /// Its numbers in θ̇, θ̈ and τ.
    #[inline(always)]
    pub fn velocities(&self) -> Range<usize> {
        self.j..self.j + self.freedom.velocities()
    }
}

const POSITIONS: [&str; 7] = ["qw", "qx", "qy", "qz", "x", "y", "z"];
const VELOCITIES: [&str; 6] = ["wx", "wy", "wz", "vx", "vy", "vz"];

impl<C: Scalar> Model<C> {
    /// Where the numbers of each independent joint stand, in the order of [`joints`](Self::joints).
    pub fn places(&self) -> &[Place] {
        &self.structure.space.0[usize::from(self.is_floating())..]
    }

    /// The configuration of a free joint's link at 0, seen from {s}: of a joint on a fixed base.
    pub(crate) fn home_on_base(&self, place: &Place) -> Option<SE3<C>> {
        let first = self.links.iter().find(|link| link.j == place.j && link.parent == 0 && !self.is_floating())?;
        Some(first.M.inverse())
    }

    /// The names of the nq positions: a joint's own name, or of a ball `joint.qw` … `joint.qz`, of a free joint `joint.qw` … `joint.z`; of a
    /// floating base, which comes first, `base.qw` … `base.z`.
    pub fn position_names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.structure.names[0].iter().map(String::as_str)
    }

    /// The names of the n velocities and forces: a joint's own name, or of a ball `joint.wx`, `joint.wy`, `joint.wz`, of a free joint `joint.wx` …
    /// `joint.vz`; of a floating base `base.wx` … `base.vz`.
    pub fn velocity_names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.structure.names[1].iter().map(String::as_str)
    }
}

/// The names of all positions and velocities, from those of the places.
pub(super) fn names_of<'n>(places: impl Iterator<Item = (&'n str, Freedom)> + Clone) -> [Vec<String>; 2] {
    let named = |parts: fn(Freedom) -> &'static [&'static str]| {
        let of_joint = |(joint, freedom): (&str, Freedom)| match freedom {
            Freedom::One => alloc::vec![joint.to_string()],
            _ => parts(freedom).iter().map(|part| format!("{joint}.{part}")).collect(),
        };
        places.clone().flat_map(of_joint).collect()
    };
    [named(|freedom| &POSITIONS[..freedom.positions()]), named(|freedom| &VELOCITIES[..freedom.velocities()])]
}
