//! The indices of a joint's numbers in θ and in θ̇.

use super::{Error, Model, Motion};
use crate::lie::SE3;
use crate::scalar::Scalar;
use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::ops::Range;

/// The manifold on which a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Freedom {
    /// A line or an angle: one position and its rate.
    One,
    /// SO(3): a unit quaternion (w, x, y, z), and the angular velocity in the moving body's axes.
    Ball,
    /// SE(3): a unit quaternion and the origin (x, y, z), and the twist (ω, v) in the moving body's coordinates.
    Free,
}

impl Freedom {
    /// The number of positions: 1, 4 or 7.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn positions(self) -> usize {
        match self {
            Freedom::One => 1,
            Freedom::Ball => 4,
            Freedom::Free => 7,
        }
    }

    /// The number of velocities, accelerations and forces: 1, 3 or 6.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn velocities(self) -> usize {
        match self {
            Freedom::One => 1,
            Freedom::Ball => 3,
            Freedom::Free => 6,
        }
    }
}

/// The indices of an independent joint, or of a floating base, in θ and θ̇.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// The manifold on which it moves.
    pub freedom: Freedom,
    /// Index of its first number in θ.
    pub q: usize,
    /// Index of its first number in θ̇, θ̈ and τ.
    pub j: usize,
}

impl Place {
    /// The range of its numbers in θ.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn positions(&self) -> Range<usize> {
        self.q..self.q + self.freedom.positions()
    }

    /// The range of its numbers in θ̇, θ̈ and τ.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn velocities(&self) -> Range<usize> {
        self.j..self.j + self.freedom.velocities()
    }
}

const POSITIONS: [&str; 7] = ["qw", "qx", "qy", "qz", "x", "y", "z"];
const VELOCITIES: [&str; 6] = ["wx", "wy", "wz", "vx", "vy", "vz"];

impl<C: Scalar> Model<C> {
    /// The indices of each independent joint's numbers, in the order of [`joints`](Self::joints).
    pub fn places(&self) -> &[Place] {
        &self.structure.space.0[usize::from(self.is_floating())..]
    }

    /// The configurations at 0, in {s}, of the links of free joints on a fixed base, by the joint's first index in θ̇.
    pub(crate) fn homes_on_base(&self) -> BTreeMap<usize, SE3<C>> {
        let on_base = self.links.iter().filter(|link| link.motion == Motion::Free && link.parent == 0);
        on_base.filter(|_| !self.is_floating()).map(|link| (link.j, link.M.inverse())).collect()
    }

    /// The names of the nq positions: a joint's own name; for a ball `joint.qw` … `joint.qz`; for a free joint
    /// `joint.qw` … `joint.z`; for a floating base, which comes first, `base.qw` … `base.z`.
    pub fn position_names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.structure.names[0].iter().map(String::as_str)
    }

    /// Whether another model has the same positions by name, in the same order, as the numbers of one need to mean the
    /// other's; `what` names the other one in the error.
    ///
    /// # Errors
    /// [`Error::BadArgument`] with the first that differs.
    pub fn check_same_joints(&self, what: &'static str, other: &Model<C>) -> Result<(), Error> {
        let (mine, theirs) = (self.position_names(), other.position_names());
        let found = if mine.len() != theirs.len() {
            format!("one with {} positions, and the robot has {}", theirs.len(), mine.len())
        } else if let Some((mine, theirs)) = mine.zip(theirs).find(|(mine, theirs)| mine != theirs) {
            format!("one with `{theirs}` where the robot has `{mine}`")
        } else {
            return Ok(());
        };
        Err(Error::BadArgument { what, found, expected: "the same joints in the same order" })
    }

    /// The names of the n velocities and forces: a joint's own name; for a ball `joint.wx`, `joint.wy`, `joint.wz`; for
    /// a free joint `joint.wx` … `joint.vz`; for a floating base `base.wx` … `base.vz`.
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
