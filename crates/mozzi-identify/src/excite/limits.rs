//! Limits of exciting motions: joints, torques, collisions.

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

impl MotionLimits {
    /// The robot's own: positions less 2 % at both ends, half a turn about 0 if there is no limit; velocities, 1 rad/s
    /// or 0.2 m/s if there is none; accelerations that reach them in 0.3 s, less if the
    /// file has lower limits; effort.
    pub fn of(model: &Model) -> Self {
        let mut limits = MotionLimits {
            position: Vec::new(),
            velocity: Vec::new(),
            acceleration: Vec::new(),
            torque: Vec::new(),
            boxes: Vec::new(),
            apart: Vec::new(),
        };
        for joint in model.joints() {
            let slides = joint.kind.name() == "prismatic";
            let half_turn = core::f64::consts::PI;
            let [low, high] =
                joint.limits.position.unwrap_or(if slides { [-0.2, 0.2] } else { [-half_turn, half_turn] });
            let [low, high] = [low.max(-half_turn * 2.0), high.min(half_turn * 2.0)];
            let margin = 0.02 * (high - low);
            limits.position.push([low + margin, high - margin]);
            let velocity = joint.limits.velocity.filter(|v| *v > 0.0).unwrap_or(if slides { 0.2 } else { 1.0 });
            limits.velocity.push(velocity);
            let acceleration = joint.limits.acceleration.filter(|a| *a > 0.0);
            limits.acceleration.push(acceleration.unwrap_or(f64::INFINITY).min(velocity / TO_SPEED));
            limits.torque.push(joint.limits.effort.filter(|t| *t > 0.0).unwrap_or(f64::INFINITY));
        }
        limits
    }

    /// The middle of the positions.
    pub fn middle(&self) -> Vec<f64> {
        self.position.iter().map(|[low, high]| 0.5 * (low + high)).collect()
    }

    /// By how much the motion exceeds each limit, relative to it, squared and summed; adds the gradient. θ, θ̇ and θ̈
    /// have one gradient each.
    pub fn excess(&self, state: &[Vec<f64>; 3], gradient: &mut [Vec<f64>; 3]) -> f64 {
        let mut sum = 0.0;
        for j in 0..self.velocity.len() {
            let [low, high] = self.position[j];
            let half = (0.5 * (high - low)).max(1e-6);
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
        const SIZE: f64 = 0.1;
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
