//! Named frames that are elsewhere, or in one file only.

use crate::{flat, is_accounted_for, of_text};
use mozzi_report::compare::files::{FilesComparison, RobotFile, compare_files};

/// An arm on a base, with sites at the ends of its two bodies.
fn mjcf(name: &str, sites: [&str; 2], edit: (&str, &str)) -> RobotFile {
    let text = format!(
        "<mujoco model='m'><compiler angle='radian'/><worldbody><body name='base' pos='0 0 1'><body name='upper' pos='0.1 0 0.2'>\
         <joint name='j' axis='0 1 0'/><inertial pos='0.2 0.1 0' mass='2' diaginertia='0.01 0.02 0.03'/>{}\
         <body name='lower' pos='0.3 0 0'><joint name='k' axis='0 0 1'/>\
         <inertial pos='0.1 0 0' mass='1' diaginertia='0.01 0.02 0.03'/>{}</body></body></body></worldbody></mujoco>",
        sites[0], sites[1]
    );
    of_text(name, &text.replace(edit.0, edit.1))
}

const NONE: (&str, &str) = ("", "");
const TCP: &str = "<site name='tcp' pos='0.1 0 0.1'/>";

fn compare(a: &RobotFile, b: &RobotFile) -> FilesComparison {
    compare_files(a, b, 5, 1, 1e-9).unwrap()
}

/// The only cause of the comparison with a robot whose tip's site is this one.
fn is_named(site: &str, words: &str) {
    let comparison = compare(&mjcf("a.xml", ["", TCP], NONE), &mjcf("b.xml", ["", site], NONE));
    let (text, causes) = (flat(&comparison), comparison.causes().collect::<Vec<_>>());
    assert_eq!(causes, [words], "{text}");
    assert!(text.contains(": the same forces of another robot; the causes below name the differences"), "{text}");
    assert!(comparison.forces_agree() && !comparison.agrees(), "{text}");
}

#[test]
fn a_frame_that_is_elsewhere() {
    is_named("<site name='tcp' pos='0.1 0 0.9'/>", "frame `tcp` is elsewhere in b.xml, by 0.8 m");
    is_named(
        "<site name='tcp' pos='0.1 0 0.1' euler='0.5 0 0'/>",
        "frame `tcp` is elsewhere in b.xml, turned by 28.6479°",
    );
    let both = "frame `tcp` is elsewhere in b.xml, by 0.1 m and turned by 28.6479°";
    is_named("<site name='tcp' pos='0.2 0 0.1' euler='0.5 0 0'/>", both);
    is_named("<site name='tcp' pos='100 0 100'/>", "frame `tcp` has its origin in mm in b.xml");
    is_named("<site name='tcp' pos='0.1000001 0 0.1'/>", "frame `tcp` is rounded in b.xml: its place differs by 4e-8");
    // within the tolerance it is the same
    let moved = mjcf("b.xml", ["", "<site name='tcp' pos='0.101 0 0.1'/>"], NONE);
    let comparison = compare_files(&mjcf("a.xml", ["", TCP], NONE), &moved, 5, 1, 0.01).unwrap();
    assert!(comparison.agrees(), "{}", comparison.text());
}

#[test]
fn a_frame_on_another_body() {
    // where it is, too, at home
    let (on_lower, on_upper) = (["", TCP], ["<site name='tcp' pos='0.4 0 0.1'/>", ""]);
    let comparison = compare(&mjcf("a.xml", on_lower, NONE), &mjcf("b.xml", on_upper, NONE));
    let words = "frame `tcp` is on `upper` in b.xml, on `lower` here";
    assert_eq!(comparison.causes().collect::<Vec<_>>(), [words]);
    assert!(!comparison.agrees());
}

#[test]
fn a_frame_that_is_a_link_of_the_other() {
    let urdf = |at: &str| {
        let link = |name: &str, m: f64, c: &str| {
            format!(
                "<link name='{name}'><inertial><origin xyz='{c}'/><mass value='{m}'/>\
                 <inertia ixx='0.01' iyy='0.02' izz='0.03' ixy='0' ixz='0' iyz='0'/></inertial></link>"
            )
        };
        let joint = |name: &str, kind: &str, [parent, child]: [&str; 2], at: &str, axis: &str| {
            format!(
                "<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>\
                 <origin xyz='{at}'/><axis xyz='{axis}'/></joint>"
            )
        };
        let tree = [
            link("upper", 2.0, "0.2 0.1 0") + &link("lower", 1.0, "0.1 0 0"),
            joint("fixed", "fixed", ["world", "base"], "0 0 1", "1 0 0"),
            joint("j", "continuous", ["base", "upper"], "0.1 0 0.2", "0 1 0"),
            joint("k", "continuous", ["upper", "lower"], "0.3 0 0", "0 0 1"),
            joint("t", "fixed", ["lower", "tcp"], at, "1 0 0"),
        ];
        let text = format!(
            "<robot name='m'><link name='world'/><link name='base'/><link name='tcp'/>{}</robot>",
            tree.concat()
        );
        of_text("b.urdf", &text)
    };
    let site = mjcf("a.xml", ["", TCP], NONE);
    for [a, b] in [[&site, &urdf("0.1 0 0.1")], [&urdf("0.1 0 0.1"), &site]] {
        let comparison = compare(a, b);
        assert!(comparison.agrees() && comparison.causes().next().is_none(), "{}", comparison.text());
    }
    let comparison = compare(&site, &urdf("0.1 0 0.9"));
    assert_eq!(comparison.causes().collect::<Vec<_>>(), ["frame `tcp` is elsewhere in b.urdf, by 0.8 m"]);
}

#[test]
fn a_frame_that_its_link_carries_is_no_cause_of_its_own() {
    for (edit, words) in [
        (("pos='0.3 0 0'", "pos='0.35 0 0'"), "`k` is elsewhere in b.xml: (0.35, 0, 0) instead of (0.3, 0, 0)"),
        (("pos='0 0 1'", "pos='0 0 2'"), "`base:fixed` is elsewhere in b.xml: (0, 0, 2) instead of (0, 0, 1)"),
    ] {
        let comparison = compare(&mjcf("a.xml", ["", TCP], NONE), &mjcf("b.xml", ["", TCP], edit));
        assert_eq!(comparison.causes().collect::<Vec<_>>(), [words], "{}", comparison.text());
        assert!(is_accounted_for(&comparison), "{}", comparison.text());
    }
}

#[test]
fn free_robots_whose_roots_are_other_links() {
    let robot = |name: &str, stand: &str| {
        let inertia = "<inertia ixx='0.1' iyy='0.1' izz='0.1' ixy='0' ixz='0' iyz='0'/>";
        let link = |name: &str| format!("<link name='{name}'><inertial><mass value='1'/>{inertia}</inertial></link>");
        let mut file = of_text(
            name,
            &format!(
                "<robot name='r'>{stand}{}{}<joint name='j' type='continuous'><parent link='body'/><child link='arm'/>\
                 <axis xyz='0 1 0'/></joint></robot>",
                link("body"),
                link("arm")
            ),
        );
        let robot = file.model.description().clone().floating();
        file.model = robot.frame("tcp", "arm", mozzi::SE3::translation([0.1, 0.0, 0.0])).build().unwrap();
        file
    };
    let stand = "<link name='stand'/><joint name='s' type='fixed'><parent link='stand'/><child link='body'/>\
                 <origin xyz='0 0 0.5'/></joint>";
    let comparison = compare(&robot("a.urdf", stand), &robot("b.urdf", ""));
    assert!(!comparison.causes().any(|cause| cause.contains("frame")), "{}", comparison.text());
}

#[test]
fn a_frame_of_one_file_is_a_note() {
    let (with, without) = (mjcf("a.xml", ["<site name='eye'/>", TCP], NONE), mjcf("b.xml", ["", ""], NONE));
    for [a, b] in [[&with, &without], [&without, &with]] {
        let comparison = compare(a, b);
        assert!(comparison.agrees(), "{}", comparison.text());
        assert!(flat(&comparison).contains("note: frames of a.xml only: `eye`, `tcp`"), "{}", comparison.text());
    }
    // the anchors of a constraint are compared with it
    let connect = "<equality><connect name='c' body1='lower' anchor='0.1 0 0'/></equality></mujoco>";
    let sites = "<equality><connect name='c' site1='c.a' site2='c.b'/></equality></mujoco>";
    let body = mjcf("a.xml", ["", ""], ("</mujoco>", connect));
    let ends =
        ("</body></worldbody></mujoco>", format!("</body><site name='c.b' pos='0.5 0 1.2'/></worldbody>{sites}"));
    let site = mjcf("b.xml", ["", "<site name='c.a' pos='0.1 0 0'/>"], (ends.0, &ends.1));
    let comparison = compare(&body, &site);
    assert!(comparison.agrees() && !comparison.text().contains("note"), "{}", comparison.text());
}
