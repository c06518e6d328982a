//! The output of `mozzi simulate`: a table for a file, JSON, or a page.

use super::outcome::Outcome;
use crate::conditions::happened;
use crate::json;
use crate::robot::Units;
use crate::text::{Decimals, Page, about, scalar, table};
use mozzi::Model;
use mozzi_motion::controllers::Overload;
use mozzi_sim::Trajectory;
use mozzi_sim::{Closing, ContactEvent, Energy, OneSidedAccount, Stopped};
use serde_json::{Value, json};

/// Rows of the table on the screen.
const SHOWN: usize = 20;

fn energies(motion: &Trajectory) -> [Vec<f64>; 5] {
    let of = |pick: fn(&Energy) -> f64| motion.energy.iter().map(pick).collect();
    [of(|e| e.kinetic), of(|e| e.potential), of(|e| e.motor_work), of(|e| e.friction_loss), of(|e| e.applied_work)]
}

pub fn object(model: &Model, outcome: &Outcome) -> Value {
    let motion = &outcome.motion;
    let lists = |values: &[f64], n: usize| values.chunks(n.max(1)).map(json::vector).collect::<Value>();
    let [kinetic, potential, motor, friction, applied] = energies(motion).map(|list| json::vector(&list));
    json::of_robot(
        model,
        json!({
            "method": outcome.method.name(),
            "step": outcome.step(),
            "steps": motion.steps,
            "t": json::vector(&motion.t),
            "theta": lists(&motion.theta, motion.nq),
            "dtheta": lists(&motion.dtheta, motion.n),
            "ddtheta": lists(&motion.ddtheta, motion.n),
            "tau": lists(&motion.tau, motion.n),
            "kinetic_energy": kinetic,
            "potential_energy": potential,
            "motor_work": motor,
            "friction_loss": friction,
            "applied_work": applied,
            "largest_drift": outcome.account.largest_drift,
            "constraints": outcome.closing.map(|c| json!({ "corrected": c.corrected, "residual": c.residual })),
            "one_sided": outcome.one_sided.map(|a| json!({
                "largest_residual": a.largest_residual,
                "last_residual": a.last_residual,
                "unsolved": a.unsolved,
                "halvings": a.halvings,
                "unsettled": a.unsettled,
                "lifted": a.lifted,
                "most_rows": a.most_rows,
            })),
            "contacts": outcome.contacts,
            "contact_forces": lists(&motion.contact_forces, motion.forces),
            "contact_events": outcome.contact_events.iter().map(|e| json!({
                "t": e.t, "contact": e.contact, "change": e.change.name(),
            })).collect::<Value>(),
            "complete": motion.complete,
            "events": outcome.events.iter().map(|e| json!({
                "condition": e.name, "t": e.t, "theta": json::vector(&e.theta), "dtheta": json::vector(&e.dtheta), "end": e.stop,
            })).collect::<Value>(),
            "missed": outcome.missed,
            "tracking_error": outcome.tracking.as_ref().map(|e| json!({
                "rms": json::vector(&e.rms),
                "largest": json::vector(&e.largest),
            })),
            "effort_limits": outcome.overloads.iter().map(|o| json!({
                "joint": o.joint, "limit": o.limit, "asked": o.largest, "first": o.first, "last": o.last,
            })).collect::<Value>(),
            "joint_limits": outcome.stops.iter().map(|s| json!({
                "joint": s.joint, "limit": s.limit, "beyond": s.beyond, "first": s.first, "times": s.times,
            })).collect::<Value>(),
        }),
    )
}

/// Positions that fit into a row: eight, or a floating base's seven.
fn shown_positions(model: &Model) -> usize {
    match model.is_floating() {
        true => 7,
        false => 8,
    }
}

/// Some rows of a motion: t, θ, 𝒦, 𝒫, drift.
pub fn rows(model: &Model, motion: &Trajectory, shown: usize) -> Vec<String> {
    let (last, n) = (motion.len() - 1, motion.nq.min(shown_positions(model)));
    let picked: Vec<usize> = (0..=shown).map(|k| k * last / shown.max(1)).collect();
    let mut picked = picked;
    picked.dedup();
    let positions: Vec<String> = match !model.configuration_space().is_flat() {
        true => model.position_names().take(n).map(str::to_string).collect(),
        false => (1..=n).map(|j| format!("θ_{j}")).collect(),
    };
    let heads = positions.into_iter().chain(["K [J]", "P [J]", "drift [J]"].map(str::to_string));
    let mut cells = vec![std::iter::once("t [s]".to_string()).chain(heads).collect::<Vec<_>>()];
    let decimals = |pick: &dyn Fn(usize) -> f64| Decimals::of(&picked.iter().map(|&k| pick(k)).collect::<Vec<_>>());
    let theta = Decimals::of(picked.iter().flat_map(|&k| &motion.sample(k).theta[..n]));
    let [time, kinetic, potential] = [
        decimals(&|k| motion.t[k]),
        decimals(&|k| motion.energy[k].kinetic),
        decimals(&|k| motion.energy[k].potential),
    ];
    for &k in &picked {
        let sample = motion.sample(k);
        let mut row = vec![time.show(sample.t)];
        row.extend(sample.theta.iter().take(n).map(|&x| theta.show(x)));
        row.extend([kinetic.show(sample.energy.kinetic), potential.show(sample.energy.potential)]);
        row.push(about(motion.drift(k)));
        cells.push(row);
    }
    table(&cells, "r")
}

pub fn page(model: &Model, outcome: &Outcome, file: Option<&str>) -> String {
    let (motion, mut page) = (&outcome.motion, Page::default());
    page.line(format!(
        "{} for {} s by {}, {} steps {} {}{}, motors: {}",
        model.description().name,
        scalar(motion.last().t),
        outcome.method.name(),
        motion.steps,
        if outcome.method.is_adaptive() { "to a tolerance of" } else { "of" },
        if outcome.method.is_adaptive() { format!("{:e}", outcome.step()) } else { scalar(outcome.step()) },
        if outcome.method.is_adaptive() { "" } else { " s" },
        outcome.motors
    ));
    page.blank().lines(&rows(model, motion, SHOWN));
    let shown = shown_positions(model);
    if model.nq() > shown {
        let what = if model.is_floating() { "positions" } else { "joints" };
        page.lines(&[format!("… the first {shown} of {} {what}; --out FILE.csv or --json gives all", model.nq())]);
    }
    let (account, end) = (&outcome.account, outcome.account.last);
    page.blank().line(format!("θ in {}; K kinetic, P potential energy", Units::of(model).input(0)));
    page.line(format!(
        "work since the start: motors {} J, lost in friction {} J, given to the environment {} J",
        scalar(end.motor_work),
        scalar(end.friction_loss),
        scalar(end.applied_work)
    ));
    page.line(format!(
        "drift: energy error of the method, at most {} J; largest kinetic energy {} J",
        about(account.largest_drift),
        scalar(account.largest_kinetic_energy)
    ));
    if let Some(error) = &outcome.tracking {
        page.line(format!(
            "tracking error θ_d ⊖ θ: at most {}, root mean square at most {} ({})",
            about(error.worst()),
            about(error.worst_rms()),
            Units::of(model).input(0)
        ));
    }
    told(outcome).iter().for_each(|line| {
        page.line(line);
    });
    if let Some(file) = file {
        page.line(format!("{} rows written to {file}", account.rows));
    }
    page.end()
}

/// A sentence for each event that happened or did not, each joint that reached its limit, and each motor with a
/// demanded effort above its limit.
pub fn told(outcome: &Outcome) -> Vec<String> {
    let missed = |condition: &String| {
        format!("event: `{condition}` did not happen up to t = {} s", scalar(outcome.motion.last().t))
    };
    let events = happened(&outcome.events).into_iter().chain(outcome.missed.iter().map(missed));
    let stop = |stop: &Stopped| {
        let (joint, limit, first) = (&stop.joint, scalar(stop.limit), scalar(stop.first));
        match stop.beyond {
            0.0 => {
                let times = if stop.times == 1 { String::new() } else { format!("first of {} times ", stop.times) };
                format!("joint limit: `{joint}` came to rest at {limit}, {times}at t = {first} s")
            }
            beyond => format!("joint limit: `{joint}` went {} beyond {limit}, first at t = {first} s", about(beyond)),
        }
    };
    let overload = |overload: &Overload| {
        let (asked, limit, first) = (scalar(overload.largest), scalar(overload.limit), scalar(overload.first));
        format!("effort limit: `{}` needed up to {asked} of its {limit}, first at t = {first} s", overload.joint)
    };
    let closing = |closing: &Closing| {
        let (corrected, residual) = (about(closing.corrected), about(closing.residual));
        format!("constraints: violated by at most {corrected} after a step, {residual} once corrected (rad, m)")
    };
    let account = |a: &OneSidedAccount| {
        let unsolved = match a.unsolved {
            0 => String::new(),
            count => format!("; {count} steps above 1e-6: their problem may have no solution"),
        };
        let halved = match a.halvings {
            0 => String::new(),
            count => format!("; steps halved {count} times, where they did not settle"),
        };
        let unsettled = match a.unsettled {
            0 => String::new(),
            count => format!("; {count} of the shortest steps did not settle: a smaller --step may help"),
        };
        let residual = about(a.largest_residual);
        format!("dry friction, stops, contacts: solved to {residual} m/s or rad/s{unsolved}{halved}{unsettled}")
    };
    let events = events.chain(contact_lines(outcome)).chain(outcome.one_sided.iter().map(account));
    let events = events.chain(outcome.closing.iter().map(closing));
    events.chain(outcome.stops.iter().map(stop)).chain(outcome.overloads.iter().map(overload)).collect()
}

/// The contacts at the end, and their events.
fn contact_lines(outcome: &Outcome) -> Vec<String> {
    let last = outcome.motion.last();
    let carries = last.contact_forces.chunks(3).filter(|force| force.iter().any(|x| *x != 0.0)).count();
    let mut lines = Vec::new();
    if !outcome.contacts.is_empty() {
        let sum = |k: usize| last.contact_forces.chunks(3).map(|force| force[k]).sum::<f64>();
        let [x, y, z] = [0, 1, 2].map(|k| scalar(sum(k)));
        let all = outcome.contacts.len();
        lines.push(format!("contacts: {carries} of {all} carry at the end, force on the planes {x}, {y}, {z} N"));
    }
    let event = |e: &ContactEvent| format!("contact: `{}` {} at t = {} s", e.contact, e.change.name(), scalar(e.t));
    lines.extend(outcome.contact_events.iter().take(SHOWN).map(event));
    if let (true, Some(last)) = (outcome.contact_events.len() > SHOWN, outcome.contact_events.last()) {
        lines.push(format!("{} changes of contacts in all, the last: {}", outcome.contact_events.len(), event(last)));
    }
    lines
}
