//! The robot's environment: gravity, the motion of its base, and applied wrenches.

use super::{FrameId, Model};
use crate::linalg::Vec3;
use crate::scalar::Scalar;
use crate::spatial::{Twist, Wrench};
use alloc::vec::Vec;

/// Gravity, the base's motion, and the wrenches that the robot applies *to* the environment.
///
/// ```no_run
/// # use mozzi::{Environment, Model, Wrench, Vec3};
/// # fn example(model: &Model) -> Result<(), mozzi::Error> {
/// let tool = model.end_effector()?;
/// let push = [(tool, Wrench { m: Vec3([0.0; 3]), f: Vec3([0.0, 0.0, -20.0]) })];
/// let environment = Environment { applied: &push, ..model.environment() };
/// # Ok(()) }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Environment<'a, S = f64> {
    /// Gravity g in {s} coordinates, m/s². A fixed base's frame is {s}.
    pub gravity: Vec3<S>,
    /// The twist of {s} in its own coordinates. A fixed base moves with {s}; a floating base's configuration is
    /// relative to it.
    pub base_twist: Twist<S>,
    /// The rates (ω̇, v̇) of that twist, gravity not included: not the acceleration of the origin, which is v̇ + ω × v.
    pub base_acceleration: Twist<S>,
    /// Wrenches that the frames apply to the environment, each in its frame's own coordinates: F_tip, and any other.
    pub applied: &'a [(FrameId, Wrench<S>)],
}

impl<S: Scalar> Environment<'_, S> {
    /// {s} at rest, no applied wrenches.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn with_gravity(gravity: Vec3<S>) -> Self {
        Environment { gravity, base_twist: Twist::zero(), base_acceleration: Twist::zero(), applied: &[] }
    }

    /// A copy with all numbers converted by `f`; the wrenches are stored in `applied`, which is cleared first.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn map<'a, U>(
        &self,
        f: impl Fn(S) -> U + Copy,
        applied: &'a mut Vec<(FrameId, Wrench<U>)>,
    ) -> Environment<'a, U> {
        applied.clear();
        applied.extend(self.applied.iter().map(|&(frame, F)| (frame, F.map(f))));
        Environment {
            gravity: self.gravity.map(f),
            base_twist: self.base_twist.map(f),
            base_acceleration: self.base_acceleration.map(f),
            applied,
        }
    }

    /// 𝒱̇₀ of the recursion: gravity acts like a base that accelerates upwards.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn proper_base_acceleration(&self) -> Twist<S> {
        self.base_acceleration - Twist::linear(self.gravity)
    }
}

impl<C: Scalar> Model<C> {
    /// The model's own gravity, the base at rest, no applied wrenches.
    pub fn environment<S: Scalar + From<C>>(&self) -> Environment<'static, S> {
        Environment::with_gravity(self.gravity.map(S::from))
    }
}
