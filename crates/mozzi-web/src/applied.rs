//! The wrenches that the robot applies to the environment.

use mozzi::{Error, FrameId, Model, SE3, Vec3, Wrench};
use serde_json::Value;

/// Frames and numbers, six for each.
#[derive(Debug, Default)]
pub struct Applied {
    list: Vec<(FrameId, As)>,
    pub numbers: Vec<f64>,
}

/// The meaning of the six numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
enum As {
    /// (m, f) in the frame's own coordinates.
    Body,
    /// (m, f) in {s}, about its origin.
    Space,
    /// (p, f) in {s}.
    Point,
}

impl Applied {
    pub fn parse(text: &str, model: &Model) -> Result<Self, String> {
        let list: Vec<Value> = serde_json::from_str(text).map_err(|error| format!("the wrenches: {error}"))?;
        let entry = |entry: &Value| {
            let frame = entry["frame"].as_str().ok_or_else(|| format!("{entry} has no `frame`"))?;
            let frame = model.frame(frame).map_err(|error| error.to_string())?;
            match entry["as"].as_str() {
                Some("body") => Ok((frame, As::Body)),
                Some("space") => Ok((frame, As::Space)),
                Some("point") => Ok((frame, As::Point)),
                _ => Err(format!("`as` of {entry} is unknown, expected \"body\", \"space\" or \"point\"")),
            }
        };
        let list: Vec<_> = list.iter().map(entry).collect::<Result<_, String>>()?;
        Ok(Applied { numbers: vec![0.0; 6 * list.len()], list })
    }

    /// The wrenches at θ in their frames' coordinates; those that are 0 are left out.
    pub fn wrenches(&self, model: &Model, theta: &[f64], found: &mut Vec<(FrameId, Wrench)>) -> Result<(), Error> {
        found.clear();
        for (&(frame, given), &numbers) in self.list.iter().zip(self.numbers.as_chunks::<6>().0) {
            let F = Wrench::from_array(numbers);
            if F.f == Vec3::zero() && (F.m == Vec3::zero() || given == As::Point) {
                continue;
            }
            let F = match given {
                As::Body => F,
                As::Space => model.forward_kinematics(theta, frame)?.Ad().transpose() * F,
                As::Point => {
                    let F = SE3::translation(F.m.0).inverse().Ad().transpose() * Wrench { m: Vec3::zero(), f: F.f };
                    model.forward_kinematics(theta, frame)?.Ad().transpose() * F
                }
            };
            found.push((frame, F));
        }
        Ok(())
    }
}
