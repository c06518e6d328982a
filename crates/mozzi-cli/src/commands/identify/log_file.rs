//! A log of any format.

use crate::failure::{self, Failure, Result};
use crate::recogniser::{Force, IS_CURRENT, Request, TARGET};
use crate::tables::join::join;
use crate::tables::samples::{Followed, Following, LockedRange, Row, Samples};
use crate::tables::{How, read};
use mozzi::{FrameId, Model};
use mozzi_identify::{Log, order};

/// Options of the command line for reading logs.
#[derive(Clone, Copy, Debug)]
pub struct Given<'g> {
    pub order: &'g [String],
    pub force: Force,
    pub topic: Option<&'g str>,
    /// Names of locked joints.
    pub locked: &'g [String],
}

/// A locked joint may move by this, rad or m, or at this speed.
const STILL: f64 = 1e-3;
/// A mimic joint may be this far, rad or m, and this part of its motion, from where its source joint puts it.
const PLAY: f64 = 0.01;
const FOLLOWS: f64 = 0.2;

/// The table of a log, as its columns are recognised: of any format, MCAP and rosbag2 with `JointState` messages.
pub fn read_table(file: &str, model: &Model, given: &Given) -> Result<Samples> {
    let Given { order, force, topic, locked } = *given;
    let request = Request { order, locked, force, topic, has_flags: true, targets: true };
    read::read_as(file, model, &How { request, may_miss: true })
}

/// Reads a log, and the meaning of its columns.
pub fn read_log(file: &str, model: &Model, given: &Given) -> Result<(Log, Vec<Row>)> {
    let mut samples = read_table(file, model, given)?;
    check_followers(&samples)?;
    join(&mut samples, model, "; --columns shows how each is read")?;
    check_locked(&samples)?;
    let Samples { file: name, columns, is_time_certain, .. } = &samples;
    let (name, columns, is_time_certain) = (name.clone(), columns.clone(), *is_time_certain);
    let wrong = |what: String| Failure::wrong(format!("{name}: {what}"));
    let t = samples.t.take().ok_or_else(|| {
        let names: Vec<&str> = columns.iter().map(|row| row.column.as_str()).take(20).collect();
        wrong(format!(
            "no column is the time, expected one called t, time or timestamp; there are {}; rows at an even rate need \
             one, too",
            names.join(", ")
        ))
    })?;
    let need = |what: &str, columns: &str| wrong(format!("no {what}, expected columns such as {columns}"));
    if t.len() > 1 && t.iter().all(|time| *time == t[0]) {
        return Err(wrong(format!("t is {} s: {}", t[0], order::explain(&t, 1))));
    }
    let theta =
        samples.tables.remove("theta").ok_or_else(|| need("positions", "theta_JOINT, q_1 or position_JOINT"))?;
    let tau = samples.tables.remove("tau").ok_or_else(|| {
        let currents: Vec<&str> =
            columns.iter().filter(|row| row.meaning.contains(IS_CURRENT)).map(|row| row.column.as_str()).collect();
        match currents.first() {
            Some(first) => wrong(format!(
                "the forces are motor currents (`{first}` …, in A), expected torques in N m; `--torque current \
                 --known-payload N:FRAME=m,cx,cy,cz` estimates the drive gains, or multiply each current by its motor's \
                 torque constant and gear ratio"
            )),
            None => need("forces", "tau_JOINT, effort_JOINT or torque_1"),
        }
    })?;
    let is_flat = model.configuration_space().is_flat();
    let target = samples.tables.remove(TARGET).filter(|_| is_flat);
    let (dtheta, ddtheta) = (samples.tables.remove("dtheta"), samples.tables.remove("ddtheta"));
    let wrenches = samples.tables.into_iter().filter(|(name, _)| name == "wrench" || name.starts_with("wrench_"));
    let wrenches: Vec<_> =
        wrenches.map(|(table, rows)| Ok((frame_of(&name, &table, model)?, rows))).collect::<Result<_>>()?;
    for (frame, _) in &wrenches {
        let frame = model.frame_name(*frame);
        failure::note(&format!("{name}: the columns m_x … f_z are the wrench that {frame} applies to its environment"));
    }
    Ok((Log { name, t, theta, dtheta, ddtheta, tau, target, wrenches, is_time_certain, ..Log::default() }, columns))
}

/// A joint that is locked must stand still in the log.
fn check_locked(samples: &Samples) -> Result<()> {
    match samples.locked.iter().find(|range| range.high - range.low > STILL) {
        None => Ok(()),
        Some(LockedRange { joint, meaning, column, low, high }) => Err(Failure::wrong(format!(
            "{}: --lock {joint}: its {meaning} (`{column}`) is between {low:.4} and {high:.4}, expected a joint that \
             does not move; without --lock its columns of positions and forces are needed",
            samples.file
        ))),
    }
}

/// A mimic joint must follow its source joint, except for play, and have a force where that has one.
fn check_followers(samples: &Samples) -> Result<()> {
    for Following { joint, source, law, column, found } in &samples.followers {
        let why = match found {
            Followed::Differs([error, motion]) if !(*error <= PLAY + FOLLOWS * motion) => format!(
                "the position of `{joint}` (`{column}`) differs by {error:.4} (median) from {law}, \
                 which it follows in the robot's file: the file or the columns are wrong"
            ),
            Followed::Lacks(rows) if *rows > 0 => format!(
                "the force of `{joint}` (`{column}`), which is added to that of `{source}`, is missing in {rows} of {} \
                 rows: fill the column, or delete it",
                samples.count
            ),
            _ => continue,
        };
        return Err(Failure::wrong(format!("{}: {why}", samples.file)));
    }
    Ok(())
}

/// The frame of a table `wrench` or `wrench_FRAME`.
fn frame_of(file: &str, table: &str, model: &Model) -> Result<FrameId> {
    let frame = match table.strip_prefix("wrench_") {
        Some(frame) => model.frame(frame),
        None => model.end_effector(),
    };
    frame.map_err(|error| Failure::wrong(format!("{file}: `{table}`: {error}")))
}
