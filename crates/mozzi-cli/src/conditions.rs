//! `--until` and `--report-event`: conditions along a motion.

use crate::angles;
use crate::failure::{self, Failure, Result};
use crate::numbers::angle;
use crate::text::scalar;
use clap::Args;
use mozzi::Model;
use mozzi_sim::{Event, Occurrence};

/// At most this many events are listed individually.
const LISTED: usize = 12;

#[derive(Args, Debug)]
pub struct EventArguments {
    /// End the motion when this becomes true; may be repeated. Compares with a number: `elbow > 1.2` (rising through
    /// it), `<` (falling), `=` (either). On the left a joint's position, `theta_2`, `dtheta_2`, `dtheta_elbow`, or
    /// `tool0.z` (a frame's origin in {s}); or `joint-limit` alone: any joint's limit. Angles may be 90deg or pi/2
    #[arg(long, value_name = "CONDITION", allow_hyphen_values = true)]
    until: Vec<String>,
    /// Report when this becomes true, and continue; may be repeated
    #[arg(long, value_name = "CONDITION", allow_hyphen_values = true)]
    report_event: Vec<String>,
}

impl EventArguments {
    /// For a motion from (θ, θ̇).
    pub fn events<'m>(&self, model: &'m Model, [theta, dtheta]: [&[f64]; 2]) -> Result<Vec<Event<'m>>> {
        let mut events = Vec::new();
        if angles::are_degrees() && !(self.until.is_empty() && self.report_event.is_empty()) {
            return Err(Failure::wrong(
                "--deg: conditions of --until and --report-event are in radians, expected no --deg",
            ));
        }
        self.until.iter().try_for_each(|text| check_unit("--until", text, model))?;
        self.report_event.iter().try_for_each(|text| check_unit("--report-event", text, model))?;
        for (flag, list, stop) in [("--until", self.until(), true), ("--report-event", self.report_event(), false)] {
            for text in &list {
                let wrong = |error| Failure::wrong(format!("{flag} {error}"));
                let these = Event::condition(model, text).map_err(wrong)?;
                events.extend(these.into_iter().map(|event| Event { stop, ..event }));
            }
        }
        for event in &events {
            if event.is_true_at(theta, dtheta) {
                failure::note(&format!(
                    "`{}` is already true at the start; the next time it becomes true counts",
                    event.name
                ));
            }
        }
        Ok(events)
    }

    /// Conditions that did not become true.
    pub fn missed(&self, events: &[Occurrence]) -> Vec<String> {
        let all = self.until().into_iter().chain(self.report_event());
        all.filter(|text| !events.iter().any(|event| Event::is_of(&event.name, text))).collect()
    }

    fn until(&self) -> Vec<String> {
        self.until.iter().map(|text| in_radians(text)).collect()
    }

    fn report_event(&self) -> Vec<String> {
        self.report_event.iter().map(|text| in_radians(text)).collect()
    }
}

/// `rail > 0.1deg` of a joint that slides has no meaning, nor has `tool0.z > 5deg`.
fn check_unit(flag: &str, text: &str, model: &Model) -> Result<()> {
    let Some((name, number)) = text.rsplit_once(['=', '<', '>']).map(|(before, number)| (before, number.trim())) else {
        return Ok(());
    };
    if !["deg", "rad"].iter().any(|unit| number.ends_with(unit)) {
        return Ok(());
    }
    let name = name.trim_end_matches(['=', '<', '>']).trim();
    let index = |entry: &str, names: &[&str]| {
        let by_number = entry.parse::<usize>().ok().and_then(|k| k.checked_sub(1));
        names.iter().position(|known| *known == entry).or(by_number)
    };
    let (positions, velocities): (Vec<_>, Vec<_>) =
        (model.position_names().collect(), model.velocity_names().collect());
    let turns = match (name.strip_prefix("dtheta_"), name.strip_prefix("theta_").unwrap_or(name)) {
        (Some(entry), _) => index(entry, &velocities).and_then(|k| angles::of_velocities(model).get(k).copied()),
        (None, entry) => index(entry, &positions).and_then(|k| angles::of_positions(model).get(k).copied()),
    };
    // what is no joint's is a frame's coordinate, or unknown
    if turns.unwrap_or(!name.contains('.')) {
        return Ok(());
    }
    Err(Failure::wrong(format!("{flag} `{text}`: {number} is an angle, and `{name}` is a length, expected it in m")))
}

/// `elbow > 90deg` with its number in radians.
fn in_radians(text: &str) -> String {
    let text = text.trim();
    let number = text.rfind(['=', '<', '>']).map(|at| text.split_at(at + 1));
    match number.map(|(before, number)| (before, number.trim(), angle("--until", number.trim()))) {
        Some((before, number, Ok(angle))) if number.parse::<f64>().is_err() => format!("{before} {angle}"),
        _ => text.to_string(),
    }
}

/// A sentence for each of the first events, and one for the rest.
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
