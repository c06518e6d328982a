//! Event conditions as text: `elbow > 1.2`.

use crate::Error;
use crate::{Direction, Event};
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;
use mozzi::kinematics::forward_kinematics;
use mozzi::model::{FrameId, Model};

/// The word for any limit of any joint.
const LIMIT: &str = "joint-limit";
/// A message lists at most this many of a robot's names.
const LISTED: usize = 12;

/// The quantity that a condition compares with a number.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Measured {
    Position(usize),
    Velocity(usize),
    /// x, y or z of a frame's origin.
    Origin(FrameId, usize),
}

impl Measured {
    fn of(self, model: &Model, theta: &[f64], dtheta: &[f64]) -> f64 {
        match self {
            Measured::Position(k) => theta[k],
            Measured::Velocity(k) => dtheta[k],
            Measured::Origin(frame, k) => forward_kinematics(model, theta, frame).p.0[k],
        }
    }
}

impl<'m> Event<'m> {
    /// Events from a condition as text: a joint's position, `>` (rising), `<` (falling) or `=` (either), and a number,
    /// as in `elbow > 1.2`. The joint can be replaced by `theta_2`, `dtheta_2`, `dtheta_elbow` or `tool0.z` (a frame's
    /// origin in {s}). `joint-limit` gives an event for each position limit.
    ///
    /// # Errors
    /// [`Error::Condition`].
    pub fn condition(model: &'m Model, text: &str) -> Result<Vec<Self>, Error> {
        let text = text.trim();
        let wrong = |problem: String| Error::Condition { text: text.to_string(), problem };
        if text == LIMIT {
            let events = Event::joint_limits(model);
            if events.is_empty() {
                let robot = &model.description().name;
                return Err(wrong(format!(": no joint of `{robot}` has a limit of position")));
            }
            let named = |event: Event<'m>| Event { name: format!("{LIMIT}: {}", event.name), ..event };
            return Ok(events.into_iter().map(named).collect());
        }
        let Some((at, sign)) = text.char_indices().find(|(_, c)| "=<>".contains(*c)) else {
            let last = model.position_names().last().unwrap_or("elbow");
            return Err(wrong(format!(
                " is no condition, expected a joint, =, < or >, and a number, as in `{last} > 0.5`; or {LIMIT}"
            )));
        };
        let direction = match sign {
            '>' => Direction::Rising,
            '<' => Direction::Falling,
            _ => Direction::Any,
        };
        // ">=" and "==" mean the same as ">" and "=": numbers do not stay at a value
        let right = text[at + 1..].strip_prefix('=').unwrap_or(&text[at + 1..]).trim();
        let value = match right.replace('−', "-").parse::<f64>() {
            Ok(value) if value.is_finite() => value,
            _ => return Err(wrong(format!(": the value after {sign} is `{right}`, expected a finite number"))),
        };
        let measured = measured(model, text[..at].trim()).map_err(wrong)?;
        let function = move |_: f64, theta: &[f64], dtheta: &[f64]| measured.of(model, theta, dtheta) - value;
        Ok(vec![Event { direction, ..Event::new(text, function) }])
    }

    /// True if a rising or falling event is already beyond its zero at (θ, θ̇). It then counts only when it becomes
    /// true again.
    pub fn is_true_at(&self, theta: &[f64], dtheta: &[f64]) -> bool {
        let now = (self.function)(0.0, theta, dtheta);
        self.direction == Direction::Rising && now > 0.0 || self.direction == Direction::Falling && now < 0.0
    }

    /// True if an event of this name comes from this condition.
    pub fn is_of(name: &str, condition: &str) -> bool {
        let condition = condition.trim();
        if condition == LIMIT { name.starts_with(LIMIT) } else { name == condition }
    }
}

fn measured(model: &Model, name: &str) -> Result<Measured, String> {
    let positions: Vec<&str> = model.position_names().collect();
    let velocities: Vec<&str> = model.velocity_names().collect();
    let entry = |names: &[&str], name: &str| {
        let by_number = name.parse::<usize>().ok().and_then(|k| k.checked_sub(1)).filter(|k| *k < names.len());
        names.iter().position(|known| *known == name).or(by_number)
    };
    let whole = |names: &[&str]| names.iter().position(|known| *known == name);
    if let Some(found) = whole(&positions).map(Measured::Position).or(whole(&velocities).map(Measured::Velocity)) {
        return Ok(found);
    }
    let theta = name.strip_prefix("theta_").and_then(|name| entry(&positions, name)).map(Measured::Position);
    let dtheta = name.strip_prefix("dtheta_").and_then(|name| entry(&velocities, name)).map(Measured::Velocity);
    let origin = name.rsplit_once('.').and_then(|(frame, axis)| {
        let k = ["x", "y", "z"].iter().position(|known| *known == axis)?;
        Some(Measured::Origin(model.frame(frame).ok()?, k))
    });
    theta.or(dtheta).or(origin).ok_or_else(|| {
        let mut names: Vec<String> = positions.iter().take(LISTED).map(|name| format!("`{name}`")).collect();
        if positions.len() > LISTED {
            names.push("…".into());
        }
        format!(
            ": there is no `{name}`, expected one of {}; dtheta_ and one of them for its rate; or FRAME.x, .y or .z",
            names.join(", ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::robots::double_pendulum;

    #[test]
    fn conditions_are_functions_of_the_state() {
        let model = double_pendulum();
        let (theta, dtheta) = ([0.3, -0.5], [1.0, 2.0]);
        let tip = forward_kinematics(&model, &theta, model.frame("rod2").expect("there")).p.0[2];
        for (text, value, direction) in [
            ("joint1 > 0.1", 0.2, Direction::Rising),
            ("theta_2<=-1", 0.5, Direction::Falling),
            ("dtheta_joint2 == 0.5", 1.5, Direction::Any),
            (" dtheta_1 = 0 ", 1.0, Direction::Any),
            ("rod2.z < -0.25", tip + 0.25, Direction::Falling),
        ] {
            let events = Event::condition(&model, text).expect("a condition");
            let [event] = &events[..] else { panic!("{text}") };
            assert!(((event.function)(0.0, &theta, &dtheta) - value).abs() < 1e-15, "{text}");
            assert!(event.direction == direction && Event::is_of(&event.name, text));
            let is_true = direction != Direction::Any && (value > 0.0) == (direction == Direction::Rising);
            assert_eq!(event.is_true_at(&theta, &dtheta), is_true, "{text}");
        }
        for (text, words) in [
            ("joint1", "`joint1` is no condition, expected a joint, =, < or >, and a number, as in `joint2 > 0.5`"),
            ("joint1 > x", "`joint1 > x`: the value after > is `x`, expected a finite number"),
            ("joint3 > 1", "there is no `joint3`, expected one of `joint1`, `joint2`; dtheta_"),
            ("joint-limit", "`joint-limit`: no joint of `double_pendulum` has a limit of position"),
        ] {
            let error = Event::condition(&model, text).map(|_| ()).expect_err("wrong").to_string();
            assert!(error.contains(words), "{error}");
        }
    }
}
