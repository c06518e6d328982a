//! The goal of a frame, and the error from it.

use mozzi::{SE3, SO3, Twist, Vec3};
use std::fmt;
use std::ops::Range;

/// The goal of a frame {b}, in {s}.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// `T_sb`: six rows.
    Pose(SE3),
    /// The origin of {b}, at any orientation: three rows.
    Position(Vec3),
    /// The orientation of {b}, at any position: three rows.
    Orientation(SO3),
}

impl Goal {
    /// The body twist that leads from T to the goal in one second, and 0 in the rows that the goal leaves free:
    /// log(T⁻¹T_d) for a pose, (0, Rᵀ(p_d − p)) for a position, (log(RᵀR_d), 0) for an orientation. If the error is 0,
    /// its derivative along θ is −`J_b`.
    pub fn error(&self, T: SE3) -> Twist {
        match *self {
            Goal::Pose(goal) => (T.inverse() * goal).log(),
            Goal::Position(p) => Twist::linear(T.R.inverse_mul(p - T.p)),
            Goal::Orientation(R) => Twist {
                w: (SE3::new(T.R.inverse(), Vec3::zero()) * SE3::new(R, Vec3::zero())).log().w,
                v: Vec3::zero(),
            },
        }
    }

    /// The rows of (ω, v) that the goal fixes.
    pub fn rows(&self) -> Range<usize> {
        match self {
            Goal::Pose(_) => 0..6,
            Goal::Position(_) => 3..6,
            Goal::Orientation(_) => 0..3,
        }
    }

    /// The angle and the distance from T, each `None` if the goal leaves it free.
    pub(super) fn residual(&self, T: SE3) -> Residual {
        let angle = |R: SO3| (T.R.inverse() * R).log().norm();
        let distance = |p: Vec3| (p - T.p).norm();
        match *self {
            Goal::Pose(goal) => Residual { angle: Some(angle(goal.R)), distance: Some(distance(goal.p)) },
            Goal::Position(p) => Residual { angle: None, distance: Some(distance(p)) },
            Goal::Orientation(R) => Residual { angle: Some(angle(R)), distance: None },
        }
    }

    pub(super) fn is_finite(&self) -> bool {
        let [position, rotation] = match self {
            Goal::Pose(T) => [T.p, T.R.log()],
            Goal::Position(p) => [*p, Vec3::zero()],
            Goal::Orientation(R) => [Vec3::zero(), R.log()],
        };
        position.0.iter().chain(&rotation.0).all(|x| x.is_finite())
    }
}

/// The error of a frame's goal; `None` if the goal leaves it free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// ‖log(RᵀR_d)‖, rad.
    pub angle: Option<f64>,
    /// ‖p_d − p‖, m.
    pub distance: Option<f64>,
}

/// "1.51", "0.00151", "1.51e-6".
fn three_digits(x: f64) -> String {
    if (1e-3..1e3).contains(&x) {
        let places = (2.0 - x.log10().floor()).max(0.0);
        format!("{x:.*}", places as usize)
    } else {
        format!("{x:.2e}")
    }
}

impl fmt::Display for Residual {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [angle, distance] = [self.angle, self.distance].map(|x| x.map(three_digits));
        match (angle, distance) {
            (Some(angle), Some(distance)) => write!(f, "{angle} rad and {distance} m"),
            (Some(angle), None) => write!(f, "{angle} rad"),
            (None, Some(distance)) => write!(f, "{distance} m"),
            (None, None) => Ok(()),
        }
    }
}
