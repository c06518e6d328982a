//! A spring and a damper between a point of the robot and the mouse.

use super::entry::{text, three};
use mozzi::{Error, FrameId, Model, Vec3, Wrench};
use mozzi_sim::Input;
use serde_json::Value;

/// The rate of the spring with the robot's mass, rad/s, and the largest force as a multiple of its weight.
const RATE: f64 = 9.0;
const MOST: f64 = 3.0;

/// f = k(goal − p) − d ṗ acts on the robot at p, k = m ω², d = m ω, limited to three times its weight.
#[derive(Clone, Debug)]
pub struct Push<'m> {
    model: &'m Model,
    frame: FrameId,
    /// In the frame.
    point: Vec3,
    /// In {s}.
    goal: Vec3,
}

impl<'m> Push<'m> {
    /// Reads a command's `push`; `None` if there is none.
    pub fn parse(model: &'m Model, command: &Value) -> Result<Option<Self>, String> {
        let push = &command["push"];
        if push.is_null() {
            return Ok(None);
        }
        let frame = model.frame(text(push, "frame")?).map_err(|error| error.to_string())?;
        Ok(Some(Push { model, frame, point: Vec3(three(push, "point")?), goal: Vec3(three(push, "goal")?) }))
    }

    /// The point and the force on the robot, in {s}.
    pub fn force(&self, theta: &[f64], dtheta: &[f64]) -> Result<(Vec3, Vec3), Error> {
        let T = self.model.forward_kinematics(theta, self.frame)?;
        let V = &self.model.body_jacobian(theta, self.frame)? * dtheta;
        let p = T * self.point;
        let v = T.R * (V.v + V.w.cross(self.point));
        let m = self.model.mass();
        let f = (self.goal - p) * (m * RATE * RATE) - v * (m * RATE);
        let most = MOST * m * 9.81;
        Ok((p, if f.norm() > most { f * (most / f.norm()) } else { f }))
    }
}

impl Input for Push<'_> {
    fn applied(
        &mut self,
        _: f64,
        theta: &[f64],
        dtheta: &[f64],
        wrenches: &mut Vec<(FrameId, Wrench)>,
    ) -> Result<(), mozzi_sim::Error> {
        let (_, f) = self.force(theta, dtheta)?;
        // what the robot applies to the mouse
        let f = self.model.forward_kinematics(theta, self.frame)?.R.inverse_mul(-f);
        wrenches.push((self.frame, Wrench { m: self.point.cross(f), f }));
        Ok(())
    }
}
