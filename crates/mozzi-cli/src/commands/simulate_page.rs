//! The output of `mozzi simulate`: a table for a file, JSON, or a page.

use super::outcome::Outcome;
use crate::angles;
use crate::conditions::happened;
use crate::json;
use crate::robot::Units;
use crate::text::{Decimals, Page, about, page_width, rows_of, scalar, table, width};
use mozzi::{Model, SE3, SO3};
use mozzi_motion::controllers::Overload;
use mozzi_report::shown_contacts;
use mozzi_sim::{Closing, ContactEvent, ContactForce, Energy, OneSidedAccount, Stopped};
use mozzi_sim::{Sample, Trajectory};
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
    let shown = shown_contacts(outcome.contacts.len(), motion);
    let forces = |row: Sample| json::vector(&row.forces_of(shown.iter().copied()));
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
                "steps": a.steps,
                "newton_steps": a.newton_steps,
                "sweeps": a.sweeps,
                "admm_iterations": a.admm_iterations,
            })),
            "contacts": shown.iter().map(|&pair| outcome.contacts[pair].as_str()).collect::<Value>(),
            "contact_forces": motion.samples().map(forces).collect::<Value>(),
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

/// Rounding errors, relative to 1 rad or m, or to the largest energy.
const NOISE: f64 = 1e-12;

/// The largest energy of a motion.
fn energy_scale(motion: &Trajectory) -> f64 {
    motion.energy.iter().fold(0.0_f64, |m, e| m.max(e.kinetic.abs()).max(e.potential.abs()))
}

/// Joints with an error of their own.
const TRACKED: usize = 12;

/// Joints whose positions fit into a row.
fn shown_positions() -> usize {
    (page_width().saturating_sub(20) / 9).min(8)
}

/// The columns of positions: those of the joints, or of a floating base its height, its roll, pitch and yaw, and the
/// centre of mass.
fn places(model: &Model, theta: &[f64]) -> Vec<f64> {
    let shown = shown_positions().min(theta.len());
    if !model.is_floating() {
        return angles::shown(&theta[..shown], &angles::of_positions(model)[..shown]);
    }
    let (rpy, z) = match theta.first_chunk::<7>() {
        Some(&pose) => (roll_pitch_yaw(SE3::from_pose(pose).R), pose[6]),
        None => ([0.0; 3], 0.0),
    };
    let com = model.center_of_mass(theta).map_or([f64::NAN; 3], |c| c.0);
    [[z].as_slice(), &angles::shown(&rpy, &[true; 3]), &com].concat()
}

/// R = Rot(z, yaw) Rot(y, pitch) Rot(x, roll).
fn roll_pitch_yaw(R: SO3) -> [f64; 3] {
    let r = R.matrix().rows();
    [r[2][1].atan2(r[2][2]), (-r[2][0]).clamp(-1.0, 1.0).asin(), r[1][0].atan2(r[0][0])]
}

/// A drift above this part of the largest kinetic energy means that the step is too long.
const COARSE: f64 = 0.1;
/// A drift below this part of the energies' scale is no matter of the step.
const SMALL: f64 = 1e-9;

/// Some rows of a motion: t, θ, 𝒦, 𝒫, drift.
pub fn rows(model: &Model, motion: &Trajectory, shown: usize) -> Vec<String> {
    let last = motion.len() - 1;
    let mut picked: Vec<usize> = (0..=shown).map(|k| k * last / shown.max(1)).collect();
    picked.dedup();
    let at: Vec<Vec<f64>> = picked.iter().map(|&k| places(model, motion.sample(k).theta)).collect();
    let n = at.first().map_or(0, Vec::len);
    let heads: Vec<String> = match (model.is_floating(), model.configuration_space().is_flat()) {
        (true, _) => ["z [m]", "roll", "pitch", "yaw", "com x", "y", "z"].map(str::to_string).to_vec(),
        (_, false) => model.position_names().take(n).map(str::to_string).collect(),
        (_, true) => (1..=n).map(|j| format!("θ_{j}")).collect(),
    };
    // rounding errors: of angles and lengths of about 1, and of the energies
    let scale = energy_scale(motion);
    let (places_noise, energy_noise) = (NOISE, NOISE * scale);
    let column = |c: usize| at.iter().map(|row| row[c]).collect::<Vec<_>>();
    let format =
        |columns: &[usize]| Decimals::above(places_noise, &columns.iter().flat_map(|&c| column(c)).collect::<Vec<_>>());
    let formats: Vec<Decimals> = match model.is_floating() {
        true if angles::are_degrees() => {
            (0..n).map(|c| format(if (1..=3).contains(&c) { &[1, 2, 3] } else { &[0, 4, 5, 6] })).collect()
        }
        _ => vec![format(&(0..n).collect::<Vec<_>>()); n],
    };
    let of_energy = |pick: fn(&Energy) -> f64| {
        let values: Vec<f64> = picked.iter().map(|&k| pick(&motion.energy[k])).collect();
        let decimals = Decimals::above(energy_noise, &values);
        values.into_iter().map(|x| decimals.show(x)).collect::<Vec<_>>()
    };
    let drift = |&k: &usize| {
        Some(motion.drift(k)).filter(|drift| drift.abs() > f64::EPSILON * scale).map_or("0".to_string(), about)
    };
    let ends = [
        ("K [J]", of_energy(|energy| energy.kinetic)),
        ("P [J]", of_energy(|energy| energy.potential)),
        ("drift", picked.iter().map(drift).collect()),
    ];
    let time = Decimals::of(&picked.iter().map(|&k| motion.t[k]).collect::<Vec<_>>());
    let mut columns =
        vec![[vec!["t [s]".to_string()], picked.iter().map(|&k| time.show(motion.t[k])).collect()].concat()];
    for (c, head) in heads.into_iter().enumerate() {
        columns.push([vec![head], at.iter().map(|row| formats[c].show(row[c])).collect()].concat());
    }
    // as many of the energies as fit
    for (head, cells) in ends {
        let more = [&columns[..], &[[vec![head.to_string()], cells].concat()]].concat();
        let wide: usize = more.iter().map(|cells| 2 + cells.iter().map(|cell| width(cell)).max().unwrap_or(0)).sum();
        if wide > page_width() - 4 {
            break;
        }
        columns = more;
    }
    table(&rows_of(columns), "r")
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
    let shown = shown_positions();
    if model.is_floating() {
        let unit = angles::unit("rad");
        let what = "z of the base, its roll, pitch, yaw";
        page.lines(&[format!("{what} [{unit}], centre of mass [m]; --out FILE.csv or --json gives all of θ")]);
    } else if model.nq() > shown {
        page.lines(&[format!("… the first {shown} of {} joints; --out FILE.csv or --json gives all", model.nq())]);
    }
    let (account, end) = (&outcome.account, outcome.account.last);
    page.blank().line(format!("θ in {}; K kinetic, P potential energy", Units::of(model).input(0)));
    // rounding errors of energies are 0
    let scale = energy_scale(motion);
    let energy = |x: f64| scalar(if x.abs() <= NOISE * scale { 0.0 } else { x });
    page.line(format!(
        "work since the start: motors {} J, lost in friction {} J, given to the environment {} J",
        energy(end.motor_work),
        energy(end.friction_loss),
        energy(end.applied_work)
    ));
    let drift = if account.largest_drift <= f64::EPSILON * scale { 0.0 } else { account.largest_drift };
    // a robot that stands still has no kinetic energy to compare with
    let is_coarse = drift > COARSE * account.largest_kinetic_energy && drift > SMALL * scale;
    page.line(format!(
        "drift: energy error of the method, at most {} J; largest kinetic energy {} J{}",
        about(drift),
        energy(account.largest_kinetic_energy),
        if is_coarse { "; the step is too long, or another --method fits" } else { "" }
    ));
    if let Some(error) = &outcome.tracking {
        let unit = Units::of(model).input(0);
        let are_angles: Vec<bool> = angles::of_velocities(model).split_off(model.base().velocities());
        let [largest, rms] = [&error.largest, &error.rms].map(|list| angles::shown(list, &are_angles));
        page.line(format!("tracking error e = θ_d ⊖ θ [{unit}]:"));
        let names = model.velocity_names().skip(model.base().velocities());
        let mut cells = vec![["", "largest", "rms"].map(str::to_string).to_vec()];
        for ((name, &largest), &rms) in names.zip(&largest).zip(&rms).take(TRACKED) {
            let cell = |x: f64| about(if x.abs() <= NOISE { 0.0 } else { x });
            cells.push(vec![name.to_string(), cell(largest), cell(rms)]);
        }
        page.lines(&table(&cells, "lr"));
        if largest.len() > TRACKED {
            let worst = about(largest.iter().fold(0.0, |m, &x| x.max(m)));
            page.lines(&[format!("… of {} velocities, of which the largest error is {worst}", largest.len())]);
        }
    }
    told(model, outcome).iter().for_each(|line| {
        page.line(line);
    });
    if let Some(file) = file {
        page.line(format!("{} rows written to {file}", account.rows));
    }
    page.end()
}

/// A sentence for each event that happened or did not, each joint that reached its limit, and each motor with a
/// demanded effort above its limit.
pub fn told(model: &Model, outcome: &Outcome) -> Vec<String> {
    let missed = |condition: &String| {
        format!("event: `{condition}` did not happen up to t = {} s", scalar(outcome.motion.last().t))
    };
    let events = happened(&outcome.events).into_iter().chain(outcome.missed.iter().map(missed));
    let stop = |stop: &Stopped| {
        let (joint, first) = (&stop.joint, scalar(stop.first));
        let kind = model.joints().find(|known| known.name == *joint).map(|known| known.kind);
        let [limit, beyond] = [stop.limit, stop.beyond].map(|x| kind.map_or(x, |kind| angles::of_joint(kind, x)));
        let limit = scalar(limit);
        match beyond {
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
            1 => "; steps halved once, where it did not settle or would lift the robot".to_string(),
            count => format!("; steps halved {count} times, where they did not settle or would lift the robot"),
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

/// Forces of contacts are known to this part of the largest.
const SOLVED: f64 = 1e-9;
/// More forces are shown by their sum alone.
const CARRYING: usize = 8;

/// The contacts at the end, and their events.
fn contact_lines(outcome: &Outcome) -> Vec<String> {
    let last = outcome.motion.last();
    let mut lines = Vec::new();
    if !outcome.contacts.is_empty() {
        let largest = last.contact_forces.iter().map(|force| force.f.norm()).fold(0.0, f64::max);
        let clean = |x: f64| scalar(if x.abs() <= SOLVED * largest { 0.0 } else { x });
        let [x, y, z] = last.total_contact_force().0.map(clean);
        let (carries, all) = (last.contact_forces.len(), outcome.contacts.len());
        lines.push(format!("contacts: {carries} of {all} carry at the end, force on the planes {x}, {y}, {z} N"));
        if (2..=CARRYING).contains(&carries) {
            let one = |force: &ContactForce| {
                let [x, y, z] = force.f.0.map(clean);
                format!("  `{}`: {x}, {y}, {z} N", outcome.contacts[force.pair])
            };
            lines.extend(last.contact_forces.iter().map(one));
        }
    }
    let event = |e: &ContactEvent| format!("contact: `{}` {} at t = {} s", e.contact, e.change.name(), scalar(e.t));
    lines.extend(outcome.contact_events.iter().take(SHOWN).map(event));
    if let (true, Some(last)) = (outcome.contact_events.len() > SHOWN, outcome.contact_events.last()) {
        lines.push(format!("{} changes of contacts in all, the last: {}", outcome.contact_events.len(), event(last)));
    }
    lines
}
