//! The table column → meaning, unit, joint.

use super::{Column, GROUPS, Header, Role, Time, columns};
use crate::tables::samples::Row;
use mozzi::Model;

/// The meaning of a position's column.
pub const POSITION: &str = "position θ";

/// The meaning of every column.
pub fn rows(
    header: &Header,
    model: &Model,
    roles: &[Role],
    groups: &[Option<Vec<Option<Column>>>],
    time: Option<Time>,
) -> Vec<Row> {
    let row = |(k, role): (usize, &Role)| {
        let (meaning, unit, joint) = match role {
            Role::Time => ("time".to_string(), time.map_or("s", Time::unit).to_string(), String::new()),
            Role::Target(entry) => {
                let joint = columns::entries(model, GROUPS[0]).get(*entry).copied().unwrap_or_default();
                ("target position θ*".to_string(), unit(1.0, 0), joint.to_string())
            }
            Role::Wrench => ("wrench".to_string(), "N m, N".to_string(), String::new()),
            Role::Names => ("names of the joints, which give their order".to_string(), String::new(), String::new()),
            Role::Unused(why) => (format!("not used: {why}"), String::new(), String::new()),
            Role::Value(group, entry) => {
                let joint = columns::entries(model, GROUPS[*group]).get(*entry).copied().unwrap_or_default();
                let factor = groups[*group].as_ref().and_then(|list| list[*entry]).map_or(1.0, |(_, factor)| factor);
                let meaning = [POSITION, "velocity θ̇", "acceleration θ̈", "force τ"];
                let meaning = meaning.get(*group).copied().unwrap_or(GROUPS[*group]);
                (meaning.to_string(), unit(factor, *group), joint.to_string())
            }
        };
        Row { column: header.names[k].clone(), meaning, unit, joint }
    };
    roles.iter().enumerate().map(row).collect()
}

/// SI, or the factor that leads to it.
fn unit(factor: f64, group: usize) -> String {
    let own = ["rad, m", "rad/s, m/s", "rad/s², m/s²", "N m, N"].get(group).copied().unwrap_or_default();
    match factor {
        1.0 => own.to_string(),
        _ => format!("× {factor:.6} {own}"),
    }
}

/// A note that names the columns that are not used.
pub fn unused(place: &str, header: &Header, roles: &[Role]) -> Option<String> {
    let names: Vec<&str> = roles
        .iter()
        .enumerate()
        .filter(|(k, role)| **role == Role::Unused("unknown name") && !header.is_unnamed(*k))
        .map(|(k, _)| header.names[k].as_str())
        .collect();
    let more = names.len().saturating_sub(8);
    let list = names.iter().take(8).copied().collect::<Vec<_>>().join("`, `");
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    (!names.is_empty()).then(|| format!("{place}: columns `{list}`{more} are not used"))
}
