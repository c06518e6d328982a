//! `--until` and `--report-event`: what is looked for along a motion.

use crate::csv::GROUPS;
use crate::failure::{self, Failure, Result};
use crate::numbers::number;
use crate::text::scalar;
use clap::Args;
use mozzi::{FrameId, Model, forward_kinematics};
use mozzi_motion::integrators::{Direction, Event, Occurrence};

/// The word for any limit of any joint.
const LIMIT: &str = "joint-limit";
/// As many names of a robot's are listed in a message.
const LISTED: usize = 12;

#[derive(Args, Debug)]
pub struct EventArguments {
    /// End the motion where this becomes true; may be repeated. A joint's position against a number: `elbow > 1.2` (as it rises through it),
    /// `<` (falls), `=` (either); or `theta_2`, `dtheta_2`, `dtheta_elbow`, `tool0.z` (a frame's origin in {s}); or joint-limit, any joint's
    #[arg(long, value_name = "CONDITION", allow_hyphen_values = true)]
    until: Vec<String>,
    /// Tell when this becomes true, and go on; may be repeated
    #[arg(long, value_name = "CONDITION", allow_hyphen_values = true)]
    report_event: Vec<String>,
}

/// What a condition compares with a number.
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

impl EventArguments {
    /// For a motion from (θ, θ̇).
    pub fn events<'m>(&self, model: &'m Model, [theta, dtheta]: [&[f64]; 2]) -> Result<Vec<Event<'m>>> {
        let mut events = Vec::new();
        for (flag, list, stop) in [("--until", &self.until, true), ("--report-event", &self.report_event, false)] {
            for text in list {
                let these = read(&format!("{flag} `{text}`"), text.trim(), model)?;
                events.extend(these.into_iter().map(|event| Event { stop, ..event }));
            }
        }
        for event in &events {
            let now = (event.function)(0.0, theta, dtheta);
            if event.direction == Direction::Rising && now > 0.0 || event.direction == Direction::Falling && now < 0.0 {
                failure::note(&format!(
                    "`{}` is so at the start already: it counts when it becomes so again",
                    event.name
                ));
            }
        }
        Ok(events)
    }

    /// Conditions that did not become true.
    pub fn missed(&self, events: &[Occurrence]) -> Vec<String> {
        let of = |text: &str, event: &Occurrence| match text {
            LIMIT => event.name.starts_with(LIMIT),
            _ => event.name == text,
        };
        let all = self.until.iter().chain(&self.report_event).map(|text| text.trim());
        all.filter(|text| !events.iter().any(|event| of(text, event))).map(str::to_string).collect()
    }
}

fn read<'m>(place: &str, text: &str, model: &'m Model) -> Result<Vec<Event<'m>>> {
    if text == LIMIT {
        let events = Event::joint_limits(model);
        let robot = &model.description().name;
        return match events.is_empty() {
            true => Err(Failure::wrong(format!("{place}: no joint of `{robot}` has a limit of position"))),
            false => Ok(events
                .into_iter()
                .map(|event| Event { name: format!("{LIMIT}: {}", event.name), ..event })
                .collect()),
        };
    }
    let Some((at, sign)) = text.char_indices().find(|(_, c)| "=<>".contains(*c)) else {
        return Err(Failure::wrong(format!(
            "{place} is no condition, expected a joint, =, < or >, and a number, as in `{} > 0.5`; or {LIMIT}",
            model.position_names().last().unwrap_or("elbow")
        )));
    };
    let direction = match sign {
        '>' => Direction::Rising,
        '<' => Direction::Falling,
        _ => Direction::Any,
    };
    // ">=" and "==" mean no more than ">" and "=": numbers do not stay at a value
    let right = text[at + 1..].strip_prefix('=').unwrap_or(&text[at + 1..]);
    let value = number(format_args!("{place}: what stands behind {sign}"), right)?;
    let measured = measured(place, text[..at].trim(), model)?;
    let function = move |_: f64, theta: &[f64], dtheta: &[f64]| measured.of(model, theta, dtheta) - value;
    Ok(vec![Event { direction, ..Event::new(text, function) }])
}

fn measured(place: &str, name: &str, model: &Model) -> Result<Measured> {
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
    let [theta, dtheta] = [GROUPS[0], GROUPS[1]].map(|group| name.strip_prefix(group)?.strip_prefix('_'));
    let theta = theta.and_then(|name| entry(&positions, name)).map(Measured::Position);
    let dtheta = dtheta.and_then(|name| entry(&velocities, name)).map(Measured::Velocity);
    let origin = name.rsplit_once('.').and_then(|(frame, axis)| {
        let k = ["x", "y", "z"].iter().position(|known| *known == axis)?;
        Some(Measured::Origin(model.frame(frame).ok()?, k))
    });
    theta.or(dtheta).or(origin).ok_or_else(|| {
        let mut names: Vec<String> = positions.iter().take(LISTED).map(|name| format!("`{name}`")).collect();
        if positions.len() > LISTED {
            names.push("…".into());
        }
        Failure::wrong(format!(
            "{place}: there is no `{name}`, expected one of {}; dtheta_ and one of them for its rate; or FRAME.x, .y or .z",
            names.join(", ")
        ))
    })
}

/// A sentence for each of the first events, and one for all others.
pub fn happened(events: &[Occurrence]) -> Vec<String> {
    let about = |event: &Occurrence| {
        let end = if event.stop { ", where the motion ends" } else { "" };
        format!("`{}` at t = {} s{end}", event.name, scalar(event.t))
    };
    let mut lines: Vec<String> = events.iter().take(LISTED).map(|event| format!("event: {}", about(event))).collect();
    if let [.., last] = events
        && events.len() > LISTED
    {
        lines.push(format!("{} events in all, the last: {}", events.len(), about(last)));
    }
    lines
}
