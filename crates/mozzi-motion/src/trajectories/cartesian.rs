//! Paths of a frame through space, and the joints' along them (Modern Robotics, section 9.2.1).

use super::path::Path;
use super::spline::{Ends, Spline};
use crate::inverse_kinematics::{Goal, InverseKinematics, Options};
use crate::{Error, error};
use mozzi::kinematics::forward_kinematics;
use mozzi::{FrameId, Model, SE3, SO3, Twist, Vec3};

/// A frame's path from T₀ to T₁.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// T₀ e^{`[ξ]`s} with ξ = log(T₀⁻¹T₁): one screw motion.
    Screw,
    /// The origin along a straight line, the orientation R₀ e^{`[ω]`s} with ω = log(R₀ᵀR₁): about one axis.
    Straight,
}

impl Shape {
    /// The pose at s.
    pub fn at(self, T0: SE3, T1: SE3, s: f64) -> SE3 {
        match self {
            Shape::Screw => T0 * SE3::exp((T0.inverse() * T1).log() * s),
            Shape::Straight => {
                let turn = |R: SO3| SE3::new(R, Vec3::zero());
                let way = (turn(T0.R.inverse()) * turn(T1.R)).log().w;
                let R = (turn(T0.R) * SE3::exp(Twist { w: way * s, v: Vec3::zero() })).R;
                SE3::new(R, T0.p + (T1.p - T0.p) * s)
            }
        }
    }
}

/// The joint path along a frame's path: a spline through solutions of inverse kinematics.
#[derive(Clone, Debug)]
pub struct Cartesian {
    spline: Spline,
    /// The largest ‖log(T(s)⁻¹T_d(s))‖ halfway between knots, where a spline is farthest off: rad and m.
    pub deviation: f64,
    /// Solutions that the spline goes through.
    pub knots: usize,
}

/// Intervals at first, and at most.
const INTERVALS: [usize; 2] = [8, 4096];

impl Cartesian {
    /// Moves a frame from its pose at θ₀ to the goal, off its path by at most a tolerance (of ‖(ω, v)‖, rad and m),
    /// with as many knots as that takes. The search for each knot starts from the one before it, so that a redundant
    /// robot takes the shortest steps.
    ///
    /// # Errors
    /// [`Error::OffPath`] if the path leaves the robot's reach; [`Error::PathBroken`] if the solutions jump (at
    /// singular positions, or at a joint's limit); [`Error::Model`].
    pub fn new(
        model: &Model,
        frame: FrameId,
        from: &[f64],
        goal: SE3,
        shape: Shape,
        tolerance: f64,
    ) -> Result<Self, Error> {
        error::check(tolerance > 0.0, "the tolerance of a path", tolerance, "a positive number")?;
        error::check_driven(model, "a robot on a Cartesian path")?;
        let start = model.forward_kinematics(from, frame)?;
        let pose = |s: f64| shape.at(start, goal, s);
        let options = Options { starts: 1, angle: 1e-10, distance: 1e-10, ..Options::default() };
        let mut solver = InverseKinematics::with_options(model, frame, options)?;
        let mut intervals = INTERVALS[0];
        loop {
            let s: Vec<f64> = (0..=intervals).map(|k| k as f64 / intervals as f64).collect();
            let mut points = vec![from.to_vec()];
            for &s in &s[1..] {
                let next = solver.solve(Goal::Pose(pose(s)), &points[points.len() - 1]);
                points.push(next.map_err(|error| off_path(&solver, s, pose(s), error))?.theta);
            }
            let spline = Spline::new(model, &s, &points, Ends::Natural)?;
            let off = |k: usize| {
                let s = (k as f64 + 0.5) / intervals as f64;
                (s, (forward_kinematics(model, &spline.at(s).theta, frame).inverse() * pose(s)).log().norm())
            };
            let (s, deviation) = (0..intervals).map(off).fold((0.0, 0.0), |a, b| if b.1 <= a.1 { a } else { b });
            if deviation <= tolerance {
                return Ok(Cartesian { spline, deviation, knots: intervals + 1 });
            }
            intervals *= 2;
            if intervals > INTERVALS[1] {
                let frame = model.frame_name(frame).to_string();
                return Err(Error::PathBroken { frame, s, deviation, tolerance });
            }
        }
    }
}

/// Why a path is left: beyond the robot's reach, or where its frame cannot move as the path does.
fn off_path(solver: &InverseKinematics, s: f64, goal: SE3, error: Error) -> Error {
    let why = match &error {
        Error::NotReached { theta, .. } => solver.why_not(Goal::Pose(goal), theta),
        _ => None,
    };
    let why = why.unwrap_or_else(|| "a singular position, a joint's limit or the arm's reach is in the way".into());
    Error::OffPath { s, why, source: Box::new(error) }
}

impl Path for Cartesian {
    fn at(&self, s: f64) -> super::Point {
        self.spline.at(s)
    }

    fn knots(&self) -> Vec<f64> {
        self.spline.knots()
    }
}
