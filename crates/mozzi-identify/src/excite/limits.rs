//! Limits of exciting motions: joints, torques, collisions.

use core::f64::consts::{PI, TAU};
use mozzi::model::Bounds;
use mozzi::{FrameId, Model, Vec3, Wrench};

/// A box in {s} that a frame's origin must not leave.
#[derive(Clone, Debug, PartialEq)]
pub struct Box3 {
    /// The frame.
    pub frame: FrameId,
    /// Lowest and highest corner, m.
    pub corners: [[f64; 3]; 2],
}

/// A sphere about a frame's origin; spheres of two frames must not touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Sphere {
    /// The frame.
    pub frame: FrameId,
    /// Its radius, m.
    pub radius: f64,
}

/// Limits of a motion, one number for each joint; infinite if there is none.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionLimits {
    /// Lowest and highest positions, rad or m.
    pub position: Vec<[f64; 2]>,
    /// rad/s or m/s.
    pub velocity: Vec<f64>,
    /// rad/s² or m/s².
    pub acceleration: Vec<f64>,
    /// N m or N.
    pub torque: Vec<f64>,
    /// Boxes that frames stay in.
    pub boxes: Vec<Box3>,
    /// Pairs of spheres that stay apart.
    pub apart: Vec<(Sphere, Sphere)>,
}

/// The acceleration that reaches the velocity limit in this time is the default limit, s.
const TO_SPEED: f64 = 0.3;
/// The length to which what leaves a box, or comes too near, is relative, m.
const SIZE: f64 = 0.1;
/// Half the range of a joint that does not move, rad or m.
const NARROW: f64 = 1e-6;
/// The share of a limit that tightened limits leave.
const ROOM: f64 = 0.1;

impl MotionLimits {
    /// The robot's own, with those of mimic joints: positions less 2 % at both ends, two turns at most, half a turn or
    /// 0.2 m to both sides of 0 if there is no limit, a turn or 0.4 m from the only one; velocities, 1 rad/s or 0.2 m/s
    /// if there is none; accelerations that reach them in 0.3 s, less if the file has lower limits; effort.
    pub fn of(model: &Model) -> Self {
        let mut limits = MotionLimits {
            position: Vec::new(),
            velocity: Vec::new(),
            acceleration: Vec::new(),
            torque: Vec::new(),
            boxes: Vec::new(),
            apart: Vec::new(),
        };
        let bounds = Bounds::of(model);
        let [velocities, accelerations] = Bounds::of_rates(model);
        for (k, joint) in model.joints().enumerate() {
            let slides = joint.kind.name() == "prismatic";
            let reach = if slides { 0.2 } else { PI };
            let [mut low, mut high] = match bounds.joints[k] {
                [low, high] if low.is_finite() && high.is_finite() => [low, high],
                [low, _] if low.is_finite() => [low, low + 2.0 * reach],
                [_, high] if high.is_finite() => [high - 2.0 * reach, high],
                _ => [-reach, reach],
            };
            if !slides {
                // two turns, as near to 0 as the limits are
                low = low.max((high - 2.0 * TAU).min(-TAU));
                high = high.min(low + 2.0 * TAU);
            }
            let margin = 0.02 * (high - low);
            limits.position.push([low + margin, high - margin]);
            let given = |x: f64, otherwise: f64| if 0.0 < x && x < f64::INFINITY { x } else { otherwise };
            let velocity = given(velocities[k], if slides { 0.2 } else { 1.0 });
            limits.velocity.push(velocity);
            limits.acceleration.push(given(accelerations[k], f64::INFINITY).min(velocity / TO_SPEED));
            limits.torque.push(joint.limits.effort.filter(|t| *t > 0.0).unwrap_or(f64::INFINITY));
        }
        limits
    }

    /// The middle of the positions.
    pub fn middle(&self) -> Vec<f64> {
        self.position.iter().map(|[low, high]| 0.5 * (low + high)).collect()
    }

    /// Limits within these, which leave room for a motion about a state that keeps them.
    pub(super) fn tightened(&self) -> Self {
        let [narrow, wide] = [1.0 - ROOM, 1.0 + ROOM];
        let within = |[low, high]: [f64; 2]| {
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            [middle - narrow * half, middle + narrow * half]
        };
        let mut tight = self.clone();
        tight.position.iter_mut().filter(|[low, high]| low < high).for_each(|range| *range = within(*range));
        tight.torque.iter_mut().for_each(|torque| *torque *= narrow);
        for Box3 { corners: [low, high], .. } in &mut tight.boxes {
            for (low, high) in low.iter_mut().zip(high) {
                [*low, *high] = within([*low, *high]);
            }
        }
        for (a, b) in &mut tight.apart {
            (a.radius, b.radius) = (wide * a.radius, wide * b.radius);
        }
        tight
    }

    /// In words, the limit that a state and its torques break most; `None` if they keep all.
    ///
    /// # Errors
    /// [`mozzi::Error`] for a frame of another model.
    pub(super) fn broken(
        &self,
        model: &Model,
        [theta, dtheta, ddtheta]: &[Vec<f64>; 3],
        tau: &[f64],
    ) -> Result<Option<String>, mozzi::Error> {
        let mut all: Vec<(f64, String)> = Vec::new();
        for (j, joint) in model.joint_names().enumerate() {
            let [low, high] = self.position[j];
            let off = (theta[j] - 0.5 * (low + high)).abs() / (0.5 * (high - low)).max(NARROW) - 1.0;
            all.push((off, format!("`{joint}` at {:.4}, beyond {low:.4} … {high:.4}", theta[j])));
            for (what, x, limit) in [
                ("velocity", dtheta[j], self.velocity[j]),
                ("acceleration", ddtheta[j], self.acceleration[j]),
                ("torque", tau[j], self.torque[j]),
            ] {
                let words = format!("the {what} of `{joint}` of {x:.4}, beyond its limit {limit:.4}");
                all.push((x.abs() / limit - 1.0, words));
            }
        }
        for Box3 { frame, corners: [low, high] } in &self.boxes {
            let p = model.forward_kinematics(theta, *frame)?.p.0;
            let off = (0..3).map(|axis| (low[axis] - p[axis]).max(p[axis] - high[axis])).fold(f64::MIN, f64::max);
            let ([x, y, z], name) = (p, model.frame_name(*frame));
            let words = format!("`{name}` at ({x:.3}, {y:.3}, {z:.3}) m, outside its box by {off:.3} m");
            all.push((off / SIZE, words));
        }
        for (a, b) in &self.apart {
            let [p, q] = [a, b].map(|sphere| model.forward_kinematics(theta, sphere.frame).map(|T| T.p));
            let (distance, least) = ((p? - q?).norm(), a.radius + b.radius);
            let names = [a, b].map(|sphere| model.frame_name(sphere.frame));
            let words = format!("`{}` and `{}` {distance:.3} m apart, of {least:.3} m", names[0], names[1]);
            all.push(((least - distance) / SIZE, words));
        }
        let worst = all.into_iter().max_by(|(a, _), (b, _)| a.total_cmp(b));
        Ok(worst.filter(|(over, _)| *over > 0.0).map(|(_, words)| words))
    }

    /// By how much the motion exceeds each limit, relative to it, squared and summed; adds the gradient. θ, θ̇ and θ̈
    /// have one gradient each.
    pub fn excess(&self, state: &[Vec<f64>; 3], gradient: &mut [Vec<f64>; 3]) -> f64 {
        let mut sum = 0.0;
        for j in 0..self.velocity.len() {
            let [low, high] = self.position[j];
            let half = (0.5 * (high - low)).max(NARROW);
            let cases = [
                (0, state[0][j] - 0.5 * (low + high), half),
                (1, state[1][j], self.velocity[j]),
                (2, state[2][j], self.acceleration[j]),
            ];
            for (order, x, limit) in cases {
                let over = x.abs() / limit - 1.0;
                if over > 0.0 {
                    sum += over * over;
                    gradient[order][j] += 2.0 * over * x.signum() / limit;
                }
            }
        }
        sum
    }

    /// The penalty of boxes and spheres; distances are relative to 10 cm.
    ///
    /// # Errors
    /// [`mozzi::Error`] for a frame of another model.
    pub fn collisions(&self, model: &Model, theta: &[f64], gradient: &mut [f64]) -> Result<f64, mozzi::Error> {
        let mut sum = 0.0;
        let push = |frame: FrameId, slope: Vec3, gradient: &mut [f64]| -> Result<(), mozzi::Error> {
            let R = model.forward_kinematics(theta, frame)?.R;
            let wrench = Wrench { m: Vec3::zero(), f: R.inverse() * slope };
            let of_joints = model.body_jacobian(theta, frame)?.transpose_mul(wrench);
            gradient.iter_mut().zip(of_joints.iter()).for_each(|(g, x)| *g += x);
            Ok(())
        };
        for Box3 { frame, corners: [low, high] } in &self.boxes {
            let p = model.forward_kinematics(theta, *frame)?.p.0;
            for axis in 0..3 {
                for (over, sign) in [(low[axis] - p[axis], -1.0), (p[axis] - high[axis], 1.0)] {
                    if over > 0.0 {
                        sum += (over / SIZE).powi(2);
                        let mut slope = [0.0; 3];
                        slope[axis] = 2.0 * over / (SIZE * SIZE) * sign;
                        push(*frame, Vec3(slope), gradient)?;
                    }
                }
            }
        }
        for (a, b) in &self.apart {
            let (p, q) = (model.forward_kinematics(theta, a.frame)?.p, model.forward_kinematics(theta, b.frame)?.p);
            let apart = p - q;
            let distance = apart.norm().max(1e-9);
            let over = a.radius + b.radius - distance;
            if over > 0.0 {
                sum += (over / SIZE).powi(2);
                let slope = apart * (-2.0 * over / (SIZE * SIZE * distance));
                push(a.frame, slope, gradient)?;
                push(b.frame, -slope, gradient)?;
            }
        }
        Ok(sum)
    }
}
