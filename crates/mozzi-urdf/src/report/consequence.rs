//! The consequences of diagnostics for the results, and the order of diagnostics by them.

use crate::report::diagnostic::Diagnostic;
use crate::report::finding::Topic;
use crate::report::spelling::counted;
use std::collections::BTreeMap;

/// The consequence of a diagnostic for the results. Warnings are in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Consequence {
    /// The results omit or replace part of the file, so that the robot may move differently: a force that is not
    /// computed, a property that is ignored, an unknown word.
    Motion,
    /// The numbers of the file are used, but are suspicious.
    Numbers,
    /// The dynamics are those of the file: limits, names, slips of syntax.
    Remark,
    /// Content that mozzi does not use, such as appearance and contact: counted, without a warning.
    Unused,
}

const MOTION: [&str; 7] = [
    "ignored_force",
    "ignored_plugin",
    "ignored_property",
    "ignored_quaternion",
    "repaired_inertia",
    "unknown_attribute",
    "unknown_element",
];

const REMARKS: [&str; 13] = [
    "continuous_limits",
    "contradictory_limits",
    "ignored_limit",
    "ignored_mesh",
    "late_declaration",
    "missing_limit",
    "redundant_attribute",
    "renamed_site",
    "reversed_limits",
    "stray_text",
    "undeclared_prefix",
    "xacro_warning",
    "zero_limits",
];

/// The consequence of a warning of this code for the results.
pub fn consequence(code: &str) -> Consequence {
    let short = code.rsplit("::").next().unwrap_or(code);
    match short {
        _ if MOTION.contains(&short) => Consequence::Motion,
        _ if REMARKS.contains(&short) => Consequence::Remark,
        _ => Consequence::Numbers,
    }
}

/// The number of unused attributes and elements, and what they concern: "17 attributes of looks and contact are not
/// used". None if all are used.
pub fn unused(diagnostics: &[Diagnostic]) -> Option<String> {
    let mut counts: BTreeMap<Topic, [usize; 2]> = BTreeMap::new();
    for (topic, found) in diagnostics.iter().filter_map(|found| Some((found.topic()?, found))) {
        let is_attribute = found.code().ends_with("::ignored_attribute");
        counts.entry(topic).or_default()[usize::from(!is_attribute)] += 1;
    }
    let total: usize = counts.values().flatten().sum();
    let parts: Vec<String> = counts.into_iter().map(|(topic, count)| of_topic(topic, count)).collect();
    let (last, first) = parts.split_last()?;
    let all = if first.is_empty() { last.clone() } else { format!("{} and {last}", first.join(", ")) };
    Some(format!("{all} {} not used", if total == 1 { "is" } else { "are" }))
}

fn of_topic(topic: Topic, [attributes, elements]: [usize; 2]) -> String {
    let count = |n: usize, what: &str| (n > 0).then(|| counted(n, what));
    let counts: Vec<String> = count(attributes, "attribute").into_iter().chain(count(elements, "element")).collect();
    let what = match topic {
        Topic::Looks => "looks and contact",
        Topic::Actuators => "actuators and sensors",
        Topic::Settings => "MuJoCo's settings",
        Topic::Idle => "inactive parts",
    };
    format!("{} of {what}", counts.join(" and "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Policy, codes, mjcf, parse, parse_with, sdf};

    #[test]
    fn every_code_is_known() {
        let known: Vec<&str> = codes().chain(mjcf::codes()).chain(sdf::codes()).collect();
        assert!(MOTION.iter().chain(&REMARKS).all(|code| known.contains(code)));
        assert_eq!(consequence("mozzi::urdf::degrees"), Consequence::Numbers);
    }

    #[test]
    fn what_changes_the_motion_comes_first_and_looks_are_counted() {
        let text = "<mujoco><option timestep='0.1' iterations='3'/><worldbody><light/><body name='b'>\
             <joint axis='1 0 0' range='9 -9' margin='0'/><inertial pos='0 0 0' mass='1' diaginertia='1 1 3'/>\
             <geom size='1' rgba='1 1 1 1' friction='1'/><body gravcomp='0.5'><geom size='1' rgba='0 0 0 1'/></body>\
             </body></worldbody><actuator/></mujoco>";
        let robot = parse("a.xml", text).expect("a model");
        let order: Vec<Consequence> = robot.warnings.iter().map(Diagnostic::consequence).collect();
        assert_eq!(order, [Consequence::Motion, Consequence::Numbers, Consequence::Remark]);
        let count = "3 attributes and 1 element of looks and contact, 1 element of actuators and sensors \
             and 2 attributes of MuJoCo's settings are not used";
        assert_eq!(unused(&robot.unused).as_deref(), Some(count));
        let strict = parse_with("a.xml", text, Policy::Strict).expect_err("warnings");
        let order: Vec<Consequence> = strict.errors().map(Diagnostic::consequence).collect();
        assert_eq!(order, [Consequence::Motion, Consequence::Numbers, Consequence::Remark]);
        let looks = "<mujoco><worldbody><geom size='1' rgba='1 1 1 1'/></worldbody></mujoco>";
        let robot = parse_with("a.xml", looks, Policy::Strict).expect("only looks");
        assert_eq!(unused(&robot.unused).as_deref(), Some("1 attribute of looks and contact is not used"));
        assert_eq!((robot.warnings.len(), unused(&[])), (0, None));
    }
}
