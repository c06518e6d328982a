//! Constraints as described: what closes a loop, pins a frame or couples joints (Modern Robotics, section 8.7).

use super::description::Gear;
use crate::lie::SE3;
use crate::scalar::Real;
use alloc::string::String;
use alloc::vec::Vec;

/// A constraint A(θ)θ̇ = 0 on the motion of the robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Constraint<C = f64> {
    /// Unique among constraints.
    pub name: String,
    /// The constrained motion.
    pub kind: ConstraintKind<C>,
}

/// The motion that a constraint restricts.
#[derive(Clone, Debug, PartialEq)]
pub enum ConstraintKind<C = f64> {
    /// The motion of anchor {b} relative to anchor {a}. All rows are in the axes of {a}.
    Frames {
        /// {a}, the one whose axes are used: the ground for a pinned foot.
        a: Anchor<C>,
        /// {b}.
        b: Anchor<C>,
        /// Which part of the relative motion is zero.
        closure: Closure<C>,
    },
    /// A sum of positions of joints of one axis is a polynomial of another such sum: Σ r_j θ_j = Σ_k c_k (Σ r_i θ_i)ᵏ,
    /// most often θ_j = c₀ + c₁θ_i. One row.
    Joint {
        /// The joints j, with r_j.
        joints: Vec<Gear<C>>,
        /// The joints i, with r_i; none means that the sum is c₀.
        source: Vec<Gear<C>>,
        /// c₀ … c₄.
        polynomial: [C; 5],
    },
}

/// The part of the motion of {b} relative to {a} that is zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Closure<C = f64> {
    /// The origins coincide: three rows, v.
    Point,
    /// The frames coincide: six rows, (ω, v).
    Weld,
    /// The frames coincide but for a rotation about their z-axes: five rows, (ω_x, ω_y, v).
    Hinge,
    /// The origins have this distance, m > 0: one row.
    Distance(C),
    /// {b} is the centre of a wheel of this radius, m > 0, which turns about the z-axis of {b} and rolls without
    /// slipping on the plane z = 0 of {a}: three rows, the velocity of the wheel's lowest point. The first two rows
    /// (Pfaffian) do not restrict positions.
    Rolling(C),
}

/// A frame of the robot or of {s}, and a configuration in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Anchor<C = f64> {
    /// The name of a link or frame; `None` means {s}.
    pub frame: Option<String>,
    /// The anchor's configuration in that frame.
    pub T: SE3<C>,
}

impl Anchor {
    /// A frame of the robot.
    pub fn frame(name: impl Into<String>) -> Self {
        Anchor { frame: Some(name.into()), T: SE3::identity() }
    }

    /// A configuration in {s}.
    pub fn world(T: SE3) -> Self {
        Anchor { frame: None, T }
    }

    /// The anchor at `T` relative to this one.
    pub fn at(self, T: SE3) -> Self {
        Anchor { T: self.T * T, ..self }
    }
}

impl From<&str> for Anchor {
    fn from(name: &str) -> Self {
        Anchor::frame(name)
    }
}

impl Constraint {
    /// Between two anchors.
    pub fn new(name: impl Into<String>, a: impl Into<Anchor>, b: impl Into<Anchor>, closure: Closure) -> Self {
        Constraint { name: name.into(), kind: ConstraintKind::Frames { a: a.into(), b: b.into(), closure } }
    }

    /// The origins of two anchors coincide.
    pub fn point(name: impl Into<String>, a: impl Into<Anchor>, b: impl Into<Anchor>) -> Self {
        Self::new(name, a, b, Closure::Point)
    }

    /// Two anchors coincide.
    pub fn weld(name: impl Into<String>, a: impl Into<Anchor>, b: impl Into<Anchor>) -> Self {
        Self::new(name, a, b, Closure::Weld)
    }

    /// Two anchors coincide but for a rotation about their z-axes.
    pub fn hinge(name: impl Into<String>, a: impl Into<Anchor>, b: impl Into<Anchor>) -> Self {
        Self::new(name, a, b, Closure::Hinge)
    }

    /// The origins of two anchors have a distance.
    pub fn distance(name: impl Into<String>, a: impl Into<Anchor>, b: impl Into<Anchor>, distance: f64) -> Self {
        Self::new(name, a, b, Closure::Distance(distance))
    }

    /// A wheel at anchor {b} rolls on the plane z = 0 of anchor {a}.
    pub fn rolling(name: impl Into<String>, a: impl Into<Anchor>, b: impl Into<Anchor>, radius: f64) -> Self {
        Self::new(name, a, b, Closure::Rolling(radius))
    }

    /// The position of a joint is a polynomial of another's.
    pub fn joint(
        name: impl Into<String>,
        joint: impl Into<String>,
        source: impl Into<String>,
        polynomial: [f64; 5],
    ) -> Self {
        let one = |joint: String| alloc::vec![Gear { joint, ratio: 1.0 }];
        let (joints, source) = (one(joint.into()), one(source.into()));
        Constraint { name: name.into(), kind: ConstraintKind::Joint { joints, source, polynomial } }
    }
}

impl<C> Closure<C> {
    /// "point", "weld", "hinge", "distance" or "rolling".
    pub fn name(&self) -> &'static str {
        match self {
            Closure::Point => "point",
            Closure::Weld => "weld",
            Closure::Hinge => "hinge",
            Closure::Distance(_) => "distance",
            Closure::Rolling(_) => "rolling",
        }
    }

    /// The names of its rows.
    pub fn rows(&self) -> &'static [&'static str] {
        match self {
            Closure::Point => &["vx", "vy", "vz"],
            Closure::Weld => &["wx", "wy", "wz", "vx", "vy", "vz"],
            Closure::Hinge => &["wx", "wy", "vx", "vy", "vz"],
            Closure::Distance(_) => &["distance"],
            Closure::Rolling(_) => &["vx", "vy", "vz"],
        }
    }

    /// The length that belongs to it.
    pub fn length(&self) -> Option<&C> {
        match self {
            Closure::Distance(length) | Closure::Rolling(length) => Some(length),
            _ => None,
        }
    }
}

impl<C> Constraint<C> {
    /// The kind's name: that of the closure, or "joint".
    pub fn kind_name(&self) -> &'static str {
        match &self.kind {
            ConstraintKind::Frames { closure, .. } => closure.name(),
            ConstraintKind::Joint { .. } => "joint",
        }
    }

    /// The names of its rows.
    pub fn row_names(&self) -> &'static [&'static str] {
        match &self.kind {
            ConstraintKind::Frames { closure, .. } => closure.rows(),
            ConstraintKind::Joint { .. } => &["joint"],
        }
    }
}

impl<C: Real> Constraint<C> {
    /// A copy with all numbers converted by `f`.
    pub fn map<U>(&self, f: impl Fn(C) -> U + Copy) -> Constraint<U> {
        let anchor = |anchor: &Anchor<C>| Anchor { frame: anchor.frame.clone(), T: anchor.T.map(f) };
        let kind = match &self.kind {
            ConstraintKind::Frames { a, b, closure } => {
                let closure = closure.map(f);
                ConstraintKind::Frames { a: anchor(a), b: anchor(b), closure }
            }
            ConstraintKind::Joint { joints, source, polynomial } => {
                let [joints, source] = [joints, source].map(|sum| sum.iter().map(|gear| gear.map(f)).collect());
                ConstraintKind::Joint { joints, source, polynomial: polynomial.map(f) }
            }
        };
        Constraint { name: self.name.clone(), kind }
    }
}

/// Its name.
impl<C> AsRef<str> for Constraint<C> {
    fn as_ref(&self) -> &str {
        &self.name
    }
}
