//! A robot, a state and an environment, stored by names, so that a smaller robot has the same numbers.

use mozzi::quantities::{Of, Query};
use mozzi::{Description, Environment, FrameId, Freedom, Model, Task, TaskFrame, Twist, Vec3, Wrench};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// The motion of a joint or of a floating base. A joint uses the numbers that it needs.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// The position of a joint of one axis.
    pub angle: f64,
    /// The unit quaternion (w, x, y, z) and origin of a ball, a free joint or a base.
    pub pose: [f64; 7],
    /// θ̇, θ̈ (also τ) and x.
    pub rates: [[f64; 6]; 3],
}

/// A robot at one state in an environment.
#[derive(Clone, Debug)]
pub struct Case {
    /// The robot.
    pub robot: Description,
    /// The motion of each joint, by name; that of a floating base has the empty name.
    pub motions: BTreeMap<String, Motion>,
    /// The frame of quantities that have one.
    pub frame: String,
    /// The task's coordinates.
    pub coordinates: TaskFrame,
    /// The task's rows.
    pub rows: Vec<usize>,
    /// The point of quantities that have one.
    pub point: Vec3,
    /// Gravity instead of the robot's.
    pub gravity: Option<[f64; 3]>,
    /// The twist of {s}.
    pub base_twist: [f64; 6],
    /// The acceleration of {s}.
    pub base_acceleration: [f64; 6],
    /// Applied wrenches, each on a frame of its own.
    pub applied: Vec<(String, [f64; 6])>,
    /// The input `w`.
    pub w: [f64; 6],
}

/// The numbers of a case in the order of its model.
#[derive(Clone, Debug)]
pub struct Numbers {
    /// θ, θ̇, θ̈ (also τ), x and w.
    pub state: [Vec<f64>; 5],
    /// The frame of quantities that have one.
    pub frame: FrameId,
    /// Applied wrenches.
    pub applied: Vec<(FrameId, Wrench)>,
}

impl Case {
    /// The numbers in the order of the model; None if a frame is missing.
    pub fn numbers(&self, model: &Model) -> Option<Numbers> {
        let frame = |name: &str| model.frame(name).ok();
        let [mut theta, mut rates] = [vec![0.0; model.nq()], vec![0.0; 3 * model.n()]];
        let n = model.n();
        let mut put = |name: &str, freedom: Freedom, q: usize, j: usize| {
            let motion = self.motions.get(name)?;
            match freedom {
                Freedom::One => theta[q] = motion.angle,
                _ => theta[q..q + freedom.positions()].copy_from_slice(&motion.pose[..freedom.positions()]),
            }
            for (k, rate) in motion.rates.iter().enumerate() {
                let count = freedom.velocities();
                rates[k * n + j..][..count].copy_from_slice(&rate[..count]);
            }
            Some(())
        };
        if model.is_floating() {
            put("", Freedom::Free, 0, 0)?;
        }
        for (name, place) in model.joint_names().zip(model.places()) {
            put(name, place.freedom, place.q, place.j)?;
        }
        let applied = self.applied.iter().map(|(name, F)| Some((frame(name)?, Wrench::from_array(*F))));
        let [dtheta, ddtheta, x] = [0, 1, 2].map(|k| rates[k * n..][..n].to_vec());
        Some(Numbers {
            state: [theta, dtheta, ddtheta, x, self.w.to_vec()],
            frame: frame(&self.frame)?,
            applied: applied.collect::<Option<_>>()?,
        })
    }

    /// A quantity of the list with this case's frame, task or point.
    pub fn query(&self, index: usize, numbers: &Numbers) -> Query<'_> {
        let query = Query::at(index);
        match query.declaration().of {
            Of::Robot => query,
            Of::Frame => query.of(numbers.frame),
            Of::Task => query.of_task(Task { frame: numbers.frame, coordinates: self.coordinates, rows: &self.rows }),
            Of::Point => query.about(self.point),
        }
    }

    /// The environment.
    pub fn environment<'n>(&self, numbers: &'n Numbers) -> Environment<'n> {
        Environment {
            gravity: Vec3(self.gravity.unwrap_or(self.robot.gravity)),
            base_twist: Twist::from_array(self.base_twist),
            base_acceleration: Twist::from_array(self.base_acceleration),
            applied: &numbers.applied,
        }
    }

    /// True if the environment is the robot's own: its gravity, {s} at rest, no wrenches.
    pub fn is_alone(&self) -> bool {
        let is_still = self.base_twist == [0.0; 6] && self.base_acceleration == [0.0; 6];
        self.gravity.is_none() && is_still && self.applied.is_empty()
    }

    /// The robot in the format of `mozzi convert`, and the state.
    pub fn to_json(&self) -> Value {
        let motion = |motion: &Motion| json!({ "angle": motion.angle, "pose": motion.pose, "rates": motion.rates });
        let motions: BTreeMap<&str, Value> =
            self.motions.iter().map(|(name, of)| (name.as_str(), motion(of))).collect();
        json!({
            "robot": mozzi_urdf::json::to_value(&self.robot),
            "motions": motions, "frame": self.frame, "rows": self.rows,
            "coordinates": format!("{:?}", self.coordinates), "point": self.point.0,
            "gravity": self.gravity, "base_twist": self.base_twist, "base_acceleration": self.base_acceleration,
            "applied": self.applied, "w": self.w,
        })
    }
}

impl Numbers {
    /// A quantity's inputs.
    pub fn inputs(&self, query: &Query) -> Vec<&[f64]> {
        let which = |name: &str| match name {
            "theta" => 0,
            "dtheta" => 1,
            "x" => 3,
            "w" => 4,
            _ => 2,
        };
        query.declaration().inputs.iter().map(|input| &self.state[which(input.name)][..]).collect()
    }
}
