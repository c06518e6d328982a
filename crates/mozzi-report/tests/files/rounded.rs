//! Numbers of six digits, and what a format does not hold, fail no loose tolerance.

use crate::bodies::merge;
use crate::{compare_description, flat, has_cause, robot};
use mozzi_report::compare::files::{FilesComparison, RobotFile, compare_files};

fn compare(edit: impl Fn(&mut mozzi::Description), has_rates: bool, tolerance: f64) -> FilesComparison {
    let before = robot("before.urdf");
    let mut description = before.model.description().clone();
    edit(&mut description);
    let model = description.build().unwrap();
    let after = RobotFile { name: "b.xml".into(), model, has_rates, ..before.clone() };
    compare_files(&before, &after, 10, 1, tolerance).unwrap()
}

#[test]
fn a_merged_link_that_is_rounded() {
    let comparison = compare_description(|robot| {
        merge(robot, |T, G| G.transformed(T) * (1.0 + 2e-6));
        robot.links.retain(|link| link.name != "tool");
        robot.joints.retain(|joint| joint.name != "mount");
    });
    has_cause(&comparison, "b.urdf merges `tool` into `lower`, rounded: its numbers differ by up to", true);
}

#[test]
fn limits_that_are_rounded() {
    let round = |robot: &mut mozzi::Description| robot.joints[1].limits.position = Some([-1.0, 1.5000005]);
    assert!(!compare(round, true, 1e-9).agrees());
    let loose = compare(round, true, 1e-3);
    assert!(loose.agrees() && loose.causes().count() == 1, "{}", loose.text());
    let lost = compare(|robot| robot.joints[1].limits.position = None, true, 1e-3);
    assert!(!lost.agrees(), "{}", lost.text());
}

#[test]
fn limits_that_a_format_does_not_hold() {
    let drop = |robot: &mut mozzi::Description| robot.joints.iter_mut().for_each(|joint| joint.limits.velocity = None);
    assert!(!compare(drop, true, 1e-9).agrees());
    let unheld = compare(drop, false, 1e-9);
    let text = flat(&unheld);
    assert!(unheld.agrees() && unheld.causes().next().is_none(), "{text}");
    assert!(text.contains("note: not held by the format of b.xml: velocity limit of `shoulder`"), "{text}");
}

#[test]
fn limits_of_a_reversed_axis() {
    let negated = compare(|robot| robot.joints[1].limits.position = Some([-1.5, 1.0]), true, 1e-9);
    has_cause(&negated, "limits of position of `elbow` are negated and exchanged", true);
}
