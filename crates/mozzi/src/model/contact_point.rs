//! Points of a robot that planes can touch.

use super::FrameId;
use crate::lie::SO3;
use crate::linalg::Vec3;
use crate::scalar::Scalar;
use alloc::string::String;

/// The sine of an angle at which a disc lies flat.
const FLAT: f64 = 1e-12;
/// The squared cosine of an angle at which it cannot pass the plane's direction soon.
const STEEP: f64 = 0.75;

/// A point, or a rounded end, of a robot that planes stop.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactPoint {
    /// The name in results.
    pub name: String,
    /// The frame that carries it.
    pub frame: FrameId,
    /// The point, or the centre of the rounding, in the frame, m.
    pub center: Vec3,
    /// The shape around the centre.
    pub support: Support,
    /// The coefficient of friction μ, at least 0.
    pub mu: f64,
    /// The coefficient of restitution e, 0 to 1: u_n⁺ = −e u_n⁻.
    pub restitution: f64,
}

/// The shape around the centre of a contact point; the point that is nearest to a plane touches it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Support {
    /// The point itself.
    Point,
    /// A sphere, for example an end of a capsule. A sphere rolls.
    Sphere {
        /// m
        radius: f64,
    },
    /// A point of a thin disc's edge, for example of a wheel or the rim of a cylinder: that which is nearest to the
    /// plane, or one beside it. A disc that may lie flat needs several.
    Disc {
        /// The axis of the disc in the frame; its length does not matter.
        axis: Vec3,
        /// m
        radius: f64,
        /// The angle about the axis from the nearest point, rad.
        turn: f64,
    },
    /// An ellipsoid.
    Ellipsoid {
        /// Its axes in the frame.
        axes: SO3,
        /// The half axes, m.
        radii: [f64; 3],
    },
}

impl ContactPoint {
    /// A sharp point, without restitution.
    pub fn new(name: impl Into<String>, frame: FrameId, center: Vec3, mu: f64) -> Self {
        ContactPoint { name: name.into(), frame, center, support: Support::Point, mu, restitution: 0.0 }
    }

    /// How far what is around the centre reaches from it, m.
    pub fn radius(&self) -> f64 {
        match self.support {
            Support::Point => 0.0,
            Support::Sphere { radius } | Support::Disc { radius, .. } => radius,
            Support::Ellipsoid { radii: [a, b, c], .. } => a.max(b).max(c),
        }
    }

    /// The point that is farthest in a direction of unit length, in the frame.
    pub fn farthest(&self, direction: Vec3) -> Vec3 {
        match self.support {
            Support::Point => self.center,
            Support::Sphere { radius } => self.center + direction * radius,
            Support::Disc { axis, radius, turn } => {
                let axis = axis * (1.0 / axis.norm());
                let across = |direction: Vec3| direction - axis * axis.dot(direction);
                let mut within = across(direction);
                if within.norm() < FLAT {
                    // a disc that lies flat: all points of its edge are as near
                    let least = (0..3).min_by(|&a, &b| axis.0[a].abs().total_cmp(&axis.0[b].abs())).unwrap_or(0);
                    within = across(Vec3(core::array::from_fn(|k| if k == least { 1.0 } else { 0.0 })));
                }
                let within = within * (radius / within.norm());
                let (sin, cos) = Scalar::sin_cos(turn);
                self.center + within * cos + axis.cross(within) * sin
            }
            Support::Ellipsoid { axes, radii } => {
                // R D² Rᵀd / ‖D Rᵀd‖ with D = diag(radii)
                let scaled = |d: Vec3| Vec3(core::array::from_fn(|k| radii[k] * d.0[k]));
                let within = scaled(axes.inverse_mul(direction));
                let size = within.norm();
                if size > 0.0 { self.center + axes * scaled(within * (1.0 / size)) } else { self.center }
            }
        }
    }

    /// As [`farthest`](Self::farthest) a little later than there it was `like`: where a disc passes the plane's
    /// direction, its lowest point jumps to the other side; this one stays.
    pub fn farthest_like(&self, direction: Vec3, like: Vec3) -> Vec3 {
        let point = self.farthest(direction);
        let Support::Disc { axis, .. } = self.support else { return point };
        let (along, way) = (axis.dot(direction) / axis.norm(), point - self.center);
        let is_steep = along * along < STEEP; // a wheel turns under its lowest point
        if is_steep || way.dot(like - self.center) >= 0.0 { point } else { self.center - way }
    }
}
