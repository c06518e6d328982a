//! A ball that holds every position of a frame, by the robot's lengths.

use mozzi::model::{Bounds, Freedom};
use mozzi::{FrameId, Model, Vec3};

/// Its centre, and its radius: a frame is never outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ball {
    pub center: Vec3,
    pub radius: f64,
}

impl Ball {
    /// Around a point of the first axis. From each axis to the nearest point of the next one the distance is constant,
    /// since a link holds both; a slide adds its travel. `None` where a joint of the chain is of another kind, or moves
    /// several.
    pub fn of(model: &Model, frame: FrameId, bounds: &Bounds) -> Option<Ball> {
        let is_simple = model.places().iter().all(|place| place.freedom == Freedom::One);
        if !is_simple || model.description().joints.iter().any(|joint| joint.mimic.is_some()) {
            return None;
        }
        let theta = model.neutral_configuration::<f64>();
        let tip = model.forward_kinematics(&theta, frame).ok()?.p;
        let (mut at, mut ball) = (None, Ball { center: tip, radius: 0.0 });
        for (j, column) in model.space_jacobian(&theta, frame).ok()?.0.iter().enumerate() {
            let (w, v) = (column.w, column.v);
            let [low, high] = *bounds.joints.get(j)?;
            match (w.norm() > 0.5, v.norm() > 0.5) {
                (true, _) if w.dot(v).abs() > 1e-9 => return None, // a screw
                (true, _) => {
                    // p nearest to the last point, on the axis through w × v
                    let axis = w.cross(v);
                    let from = at.unwrap_or(axis);
                    let p = axis + w * w.dot(from - axis);
                    if at.is_none() {
                        ball.center = p;
                    }
                    ball.radius += (p - from).norm();
                    at = Some(p);
                }
                (false, true) => ball.radius += low.abs().max(high.abs()),
                (false, false) => {} // another branch's
            }
        }
        ball.radius += at.map_or(0.0, |at| (tip - at).norm());
        ball.radius.is_finite().then_some(ball)
    }

    /// How far a point is outside, m; negative inside.
    pub fn outside(&self, p: Vec3) -> f64 {
        (p - self.center).norm() - self.radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi::random::Random;

    #[test]
    fn no_configuration_is_outside() {
        for (robot, most) in
            [("ur5", 1.3), ("two_link_planar", 1.0), ("furuta_pendulum", 1.5), ("double_pendulum", 3.0)]
        {
            let model = mozzi_urdf::open(robot).expect("embedded").build().expect("sound");
            let frame = model.end_effector().expect("one");
            let ball = Ball::of(&model, frame, &Bounds::of(&model)).expect("a chain of simple joints");
            let mut random = Random(1);
            let mut nearest = f64::NEG_INFINITY;
            for _ in 0..500 {
                let theta = random.vector(model.n(), 3.2);
                let p = model.forward_kinematics(&theta, frame).expect("a pose").p;
                nearest = nearest.max(ball.outside(p));
            }
            println!("{robot}: {ball:?}, {nearest:.3} m outside");
            assert!(nearest < 1e-12 && ball.radius < most, "{robot}: {ball:?}, {nearest:e}");
        }
    }
}
