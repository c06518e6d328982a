//! Which column of a log is what: by its name, in the ways in which logs are written.

use crate::failure::{Failure, Result};
use crate::places::{whole_wrenches, wrench_of, wrench_place};
use mozzi::{FrameId, Model};

/// A group of columns, one for each entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    Theta,
    Dtheta,
    Ddtheta,
    Tau,
}

/// Names of groups, longest first where one begins another.
const WORDS: [(&str, Group); 31] = [
    ("joint_position", Group::Theta),
    ("position", Group::Theta),
    ("actual_qd", Group::Dtheta),
    ("actual_q", Group::Theta),
    ("theta", Group::Theta),
    ("pos", Group::Theta),
    ("joint_velocity", Group::Dtheta),
    ("velocity", Group::Dtheta),
    ("dtheta", Group::Dtheta),
    ("vel", Group::Dtheta),
    ("ddtheta", Group::Ddtheta),
    ("acceleration", Group::Ddtheta),
    ("acc", Group::Ddtheta),
    ("qdd", Group::Ddtheta),
    ("ddq", Group::Ddtheta),
    ("qd", Group::Dtheta),
    ("dq", Group::Dtheta),
    ("q", Group::Theta),
    ("joint_torque", Group::Tau),
    ("torque", Group::Tau),
    ("joint_effort", Group::Tau),
    ("effort", Group::Tau),
    ("eff", Group::Tau),
    ("tau", Group::Tau),
    ("actual_current", Group::Tau),
    ("current", Group::Tau),
    ("force", Group::Tau),
    ("trq", Group::Tau),
    ("amp", Group::Tau),
    ("cur", Group::Tau),
    ("i", Group::Tau),
];

/// Names of time, and their seconds.
const TIMES: [(&str, f64); 14] = [
    ("t", 1.0),
    ("time", 1.0),
    ("timestamp", 1.0),
    ("stamp", 1.0),
    ("time_s", 1.0),
    ("t_s", 1.0),
    ("time_ms", 1e-3),
    ("t_ms", 1e-3),
    ("timestamp_ms", 1e-3),
    ("time_us", 1e-6),
    ("timestamp_us", 1e-6),
    ("time_ns", 1e-9),
    ("timestamp_ns", 1e-9),
    ("t_ns", 1e-9),
];

/// Endings that name a unit, and the unit in SI.
const UNITS: [(&str, f64); 10] = [
    ("_deg/s", core::f64::consts::PI / 180.0),
    ("_deg_s", core::f64::consts::PI / 180.0),
    ("_deg", core::f64::consts::PI / 180.0),
    ("_rad/s", 1.0),
    ("_rad_s", 1.0),
    ("_rad", 1.0),
    ("_mnm", 1e-3),
    ("_nm", 1.0),
    ("_mm", 1e-3),
    ("_ma", 1e-3),
];

/// A column and the factor that makes it SI.
pub type Column = (usize, f64);

/// The columns of a log.
#[derive(Debug)]
pub struct Assigned {
    pub t: Column,
    pub theta: Vec<Column>,
    pub dtheta: Option<Vec<Column>>,
    pub ddtheta: Option<Vec<Column>>,
    /// None for a floating base's six, which no motor drives.
    pub tau: Vec<Option<Column>>,
    /// The wrenches that frames apply to the environment.
    pub wrenches: Vec<(FrameId, [usize; 6])>,
    pub notes: Vec<String>,
}

/// A name in the log's and the robot's common spelling.
fn spelled(name: &str) -> String {
    name.trim().to_lowercase().replace([' ', '.', '/', '[', '('], "_").replace([']', ')'], "")
}

/// A column's group, the name of its entry, and its factor.
fn parts(name: &str) -> Option<(Group, String, f64)> {
    let name = spelled(name);
    let name = name.replace("_deg_s", "_deg/s").replace("_rad_s", "_rad/s");
    let (name, factor) = UNITS
        .iter()
        .find_map(|(unit, factor)| Some((name.strip_suffix(unit)?.to_string(), *factor)))
        .unwrap_or((name.clone(), 1.0));
    let by_prefix = WORDS.iter().find_map(|(word, group)| {
        let rest = name.strip_prefix(word)?;
        let entry = rest.strip_prefix('_').or_else(|| rest.chars().all(|c| c.is_ascii_digit()).then_some(rest))?;
        (!entry.is_empty()).then(|| (*group, entry.to_string()))
    });
    let by_suffix = || {
        WORDS.iter().find_map(|(word, group)| {
            let entry = name.strip_suffix(word)?.strip_suffix('_')?;
            (!entry.is_empty()).then(|| (*group, entry.to_string()))
        })
    };
    let (group, entry) = by_prefix.or_else(by_suffix)?;
    Some((group, entry, factor))
}

/// Assigns columns. Entries are named by the robot's joints, by numbers from 0 or 1, or, if as many other names are
/// there as joints, by their order; `order` gives the log's names in the robot's order.
pub fn assign(file: &str, header: &[String], model: &Model, order: &[String]) -> Result<Assigned> {
    let wrong = |what: String| Failure::wrong(format!("{file}: {what}"));
    let t = header.iter().enumerate().find_map(|(column, name)| {
        let name = name.trim().to_lowercase();
        TIMES.iter().find(|(known, _)| *known == name).map(|(_, factor)| (column, *factor))
    });
    let t = t.ok_or_else(|| {
        wrong(format!("no column is the time, expected one called t or time; there are {}", header.join(", ")))
    })?;
    let wrenches = wrenches(file, header, model)?;
    let is_wrench = |column: &usize| wrenches.iter().any(|(_, columns)| columns.contains(column));
    let columns: Vec<(usize, (Group, String, f64))> = (0..header.len())
        .filter(|column| !is_wrench(column))
        .filter_map(|column| Some((column, parts(&header[column])?)))
        .collect();
    let mut notes = Vec::new();
    let mut entries: Vec<String> = Vec::new();
    for (_, (group, entry, _)) in &columns {
        if *group == Group::Theta && !entries.contains(entry) {
            entries.push(entry.clone());
        }
    }
    let names: Vec<String> = model.position_names().map(spelled).collect();
    let velocities: Vec<String> = model.velocity_names().map(spelled).collect();
    let is_flat = model.configuration_space().is_flat();
    let number = |entry: &str| entry.parse::<usize>().ok();
    // the log's name of each of the robot's entries
    let known = |names: &[String]| names.iter().all(|name| entries.contains(name));
    let own: Vec<String> = if !order.is_empty() {
        if order.len() != names.len() || !is_flat {
            return Err(Failure::wrong(format!("--order has {} names, expected {}", order.len(), names.len())));
        }
        order.iter().map(|name| spelled(name)).collect()
    } else if known(&names) {
        names.clone()
    } else if entries.iter().any(|entry| number(entry).is_some()) {
        let first = entries.iter().filter_map(|entry| number(entry)).min().unwrap_or(1).min(1);
        (0..names.len()).map(|k| (k + first).to_string()).collect()
    } else if names.iter().any(|name| entries.contains(name)) || entries.len() != names.len() || !is_flat {
        let missing = names.iter().find(|name| !entries.contains(name)).cloned().unwrap_or_default();
        return Err(wrong(format!(
            "no position of `{missing}`; the log has {}, the robot {}; --lock {missing}=POSITION locks a joint, \
             --order gives the log's names in the robot's order",
            if entries.is_empty() { "none".to_string() } else { entries.join(", ") },
            names.join(", ")
        )));
    } else {
        notes.push(format!(
            "{file}: joints are assigned by their order, since their names are not the robot's: {}",
            entries.iter().zip(&names).map(|(a, b)| format!("{a} is {b}")).collect::<Vec<_>>().join(", ")
        ));
        entries.clone()
    };
    let find = |group: Group, entry: &str| {
        columns.iter().find(|(_, (g, e, _))| *g == group && e == entry).map(|(column, (.., factor))| (*column, *factor))
    };
    let others: Vec<&String> = entries.iter().filter(|entry| !own.contains(entry)).collect();
    if !others.is_empty() {
        let names: Vec<&str> = others.into_iter().map(String::as_str).collect();
        notes.push(format!("{file}: columns of {} are not used: the robot has no such joint", names.join(", ")));
    }
    let own_velocities = if is_flat { own.clone() } else { velocities.clone() };
    let group = |group: Group, names: &[String], word: &str, optional: usize| -> Result<Option<Vec<Option<Column>>>> {
        let found: Vec<Option<Column>> = names.iter().map(|entry| find(group, entry)).collect();
        let count = found.iter().flatten().count();
        if count == 0 {
            return Ok(None);
        }
        match found.iter().skip(optional).position(Option::is_none) {
            Some(k) => Err(wrong(format!(
                "no {word} of `{}`; the log has {count} of {} of them",
                names[k + optional],
                names.len()
            ))),
            None => Ok(Some(found)),
        }
    };
    let whole = |found: Option<Vec<Option<Column>>>| found.map(|all| all.into_iter().flatten().collect::<Vec<_>>());
    let base = model.base().velocities();
    let need = |what: &str| wrong(format!("no {what}; expected columns such as tau_JOINT, effort_JOINT or current_1"));
    Ok(Assigned {
        t,
        theta: whole(group(Group::Theta, &own, "position", 0)?).ok_or_else(|| need("positions"))?,
        dtheta: whole(group(Group::Dtheta, &own_velocities, "velocity", 0)?),
        ddtheta: whole(group(Group::Ddtheta, &own_velocities, "acceleration", 0)?),
        tau: group(Group::Tau, &own_velocities, "force", base)?.ok_or_else(|| need("forces"))?,
        wrenches,
        notes,
    })
}

/// The columns of wrenches: `m_x` … `f_z` of the end effector's, `wrench_FRAME_m_x` … of a frame's.
fn wrenches(file: &str, header: &[String], model: &Model) -> Result<Vec<(FrameId, [usize; 6])>> {
    let mut found = Vec::new();
    for (column, name) in header.iter().enumerate() {
        let Some(entry) = wrench_of(name.trim()) else { continue };
        if let Some(first) = wrench_place(&mut found, entry).and_then(|place| place.replace(column)) {
            let (first, second) = (first + 1, column + 1);
            return Err(Failure::wrong(format!("{file}: columns {first} and {second} both give `{}`", name.trim())));
        }
    }
    let missing = |column: &str, count: usize| {
        Failure::wrong(format!(
            "{file}: column {column} is missing; the log has {count} of the 6 columns of its wrench"
        ))
    };
    let whole = whole_wrenches(found, missing)?;
    whole.into_iter().map(|(table, columns)| Ok((frame_of(file, &table, model)?, columns))).collect()
}

/// The frame of a table `wrench` or `wrench_FRAME`.
pub fn frame_of(file: &str, table: &str, model: &Model) -> Result<FrameId> {
    let frame = match table.strip_prefix("wrench_") {
        Some(frame) => model.frame(frame),
        None => model.end_effector(),
    };
    frame.map_err(|error| Failure::wrong(format!("{file}: `{table}`: {error}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_in_many_ways() {
        let expected = |group, entry: &str, factor: f64| Some((group, entry.to_string(), factor));
        let degree = core::f64::consts::PI / 180.0;
        assert_eq!(parts("theta_elbow_joint"), expected(Group::Theta, "elbow_joint", 1.0));
        assert_eq!(parts("q1"), expected(Group::Theta, "1", 1.0));
        assert_eq!(parts("qd_3"), expected(Group::Dtheta, "3", 1.0));
        assert_eq!(parts("position[elbow]_deg"), expected(Group::Theta, "elbow", degree));
        assert_eq!(parts("elbow.velocity"), expected(Group::Dtheta, "elbow", 1.0));
        assert_eq!(parts("vel_elbow_deg/s"), expected(Group::Dtheta, "elbow", degree));
        assert_eq!(parts("effort_elbow"), expected(Group::Tau, "elbow", 1.0));
        assert_eq!(parts("tau_1_mNm"), expected(Group::Tau, "1", 1e-3));
        assert_eq!(parts("actual_current_0"), expected(Group::Tau, "0", 1.0));
        assert_eq!(parts("i2"), expected(Group::Tau, "2", 1.0));
        assert_eq!(parts("temperature"), None);
        assert_eq!(parts("ddtheta_2"), expected(Group::Ddtheta, "2", 1.0));
    }

    #[test]
    fn floating_bases_and_wrenches_have_columns() {
        let arm = mozzi_urdf::open("two_link_planar").expect("embedded").description;
        let link = arm.links.last().expect("a link").name.clone();
        let model = arm.floating().build().expect("sound");
        let names: Vec<String> = ["t".to_string()]
            .into_iter()
            .chain(model.position_names().map(|name| format!("theta_{name}")))
            .chain(model.velocity_names().map(|name| format!("dtheta_{name}")))
            .chain(model.velocity_names().skip(6).map(|name| format!("tau_{name}")))
            .chain(["m_x", "m_y", "m_z", "f_x", "f_y", "f_z"].map(|entry| format!("wrench_{link}_{entry}")))
            .collect();
        let found = assign("log", &names, &model, &[]).expect("columns");
        assert_eq!(found.theta.len(), model.nq());
        assert_eq!(found.tau.iter().flatten().count(), model.n() - 6);
        assert_eq!(found.wrenches.len(), 1);
        assert_eq!(found.wrenches[0].1[0], names.len() - 6);
        let error = |names: &[String]| format!("{:?}", assign("log", names, &model, &[]).expect_err("wrong"));
        assert!(error(&names[..names.len() - 1]).contains(&format!("column wrench_{link}_f_z is missing")));
        let other: Vec<String> =
            names.iter().map(|name| name.replace(&format!("wrench_{link}"), "wrench_toe")).collect();
        assert!(error(&other).contains("`wrench_toe`"), "{}", error(&other));
    }

    #[test]
    fn joints_are_found_by_name_number_or_order() {
        let model = mozzi_urdf::open("double_pendulum").expect("embedded").description.build().expect("sound");
        let header = |text: &str| text.split(',').map(str::to_string).collect::<Vec<_>>();
        let found = assign("log", &header("time_ms,q0,q1,tau0,tau1"), &model, &[]).expect("columns");
        assert_eq!((found.t, found.theta, found.dtheta), ((0, 1e-3), vec![(1, 1.0), (2, 1.0)], None));
        let found = assign("log", &header("t,pos_b,pos_a,effort_a,effort_b"), &model, &[]).expect("columns");
        assert_eq!((found.theta, found.tau), (vec![(1, 1.0), (2, 1.0)], vec![Some((4, 1.0)), Some((3, 1.0))]));
        assert!(found.notes[0].contains("by their order"));
        let order = ["a".to_string(), "b".to_string()];
        let found = assign("log", &header("t,pos_b,pos_a,effort_a,effort_b"), &model, &order).expect("columns");
        assert_eq!(found.theta, vec![(2, 1.0), (1, 1.0)]);
        let error = |text: &str| format!("{:?}", assign("log", &header(text), &model, &[]).expect_err("wrong"));
        assert!(error("q1,q2,tau1,tau2").contains("no column is the time"));
        assert!(error("t,q1,q2").contains("no forces"));
        assert!(error("t,q1,q2,tau1").contains("no force of `2`"));
        assert!(error("t,pos_a,tau_a").contains("--lock joint1=POSITION"));
    }
}
