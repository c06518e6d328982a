//! Constraints that a file drops, or has with other numbers.

use crate::{flat, of_text};
use mozzi_report::compare::files::{FilesComparison, compare_files};

const BODIES: &str = r#"<mujoco><worldbody>
<body name="a"><joint name="ja" axis="0 1 0"/><geom size=".1" mass="1" pos=".2 0 0"/>
<body name="b" pos=".4 0 0"><joint name="jb" axis="0 1 0"/><geom size=".1" mass="1" pos=".2 0 0"/></body></body>
</worldbody>
<tendon><fixed name="t"><joint joint="ja" coef="1"/><joint joint="jb" coef="-2"/></fixed>
<fixed name="u"><joint joint="ja" coef="1"/><joint joint="jb" coef="-3"/></fixed></tendon>
<equality>"#;

fn compare(a: &str, b: &str) -> FilesComparison {
    let robot = |name: &str, equality: &str| of_text(name, &format!("{BODIES}{equality}</equality></mujoco>"));
    compare_files(&robot("a.xml", a), &robot("b.xml", b), 3, 1, 1e-9).unwrap()
}

#[test]
fn a_constraint_that_is_dropped_or_differs() {
    const TENDON: &str = r#"<tendon name="c" tendon1="t"/>"#;
    const POINT: &str = r#"<connect name="p" body1="b" anchor="0.2 0 0"/>"#;
    const WELD: &str = r#"<weld name="w" body1="b"/>"#;
    let cases = [
        (TENDON, "", "constraint `c` is dropped in b.xml: a coupling of `ja` and `jb`"),
        (POINT, "", "constraint `p` is dropped in b.xml: a point of `b` and the world"),
        ("", WELD, "constraint `w` appears in b.xml, a.xml lacks it: a weld of `b` and the world"),
        (TENDON, r#"<tendon name="c" tendon1="u"/>"#, "ratios of constraint `c` differ in b.xml"),
        (TENDON, r#"<tendon name="other" tendon1="u"/>"#, "ratios of constraint `c` differ in b.xml"),
        (
            POINT,
            r#"<connect name="p" body1="b" anchor="0.1 0 0"/>"#,
            "anchors of constraint `p` are elsewhere in b.xml",
        ),
        (POINT, r#"<weld name="p" body1="b"/>"#, "constraint `p` is a weld of `b` and the world in b.xml, a point of"),
        (
            r#"<joint name="q" joint1="jb" joint2="ja" polycoef="0 1 0.5 0 0"/>"#,
            r#"<joint name="q" joint1="jb" joint2="ja" polycoef="0 1 -0.5 0 0"/>"#,
            "coefficient 2 of constraint `q` has the other sign in b.xml: -0.5 instead of 0.5",
        ),
    ];
    for (a, b, words) in cases {
        let comparison = compare(a, b);
        let causes: Vec<&str> = comparison.causes().collect();
        assert!(causes.len() == 1 && causes[0].contains(words), "{words}: {}", comparison.text());
        assert!(comparison.forces_agree() && !comparison.agrees(), "{}", comparison.text());
        assert!(
            flat(&comparison).contains("the same masses and geometry; constraints differ"),
            "{}",
            comparison.text()
        );
    }
}

#[test]
fn the_same_constraint_of_another_name_or_order() {
    let cases = [
        (r#"<tendon name="c" tendon1="t"/>"#, r#"<tendon name="d" tendon1="t"/>"#),
        (
            r#"<connect name="p" body1="b" body2="a" anchor="0.2 0 0"/>"#,
            r#"<connect body1="a" body2="b" anchor="0.6 0 0"/>"#,
        ),
        (r#"<weld name="p" body1="b"/>"#, r#"<weld name="p" body1="b"/>"#),
    ];
    for (a, b) in cases {
        let comparison = compare(a, b);
        assert!(comparison.agrees() && comparison.causes().next().is_none(), "{}", comparison.text());
    }
}

#[test]
fn a_hinge_as_two_points_of_its_axis() {
    let robot = |name: &str, constraints: &str| {
        let links = r#"<link name="base"/><link name="a"/><link name="b"/>"#;
        let joint = |name: &str, parent: &str, child: &str| {
            format!(
                "<joint name='{name}' type='continuous'><parent link='{parent}'/><child link='{child}'/>\
                 <origin xyz='0.3 0 0'/><axis xyz='0 0 1'/></joint>"
            )
        };
        let joints = joint("j", "base", "a") + &joint("k", "a", "b");
        let heavy = links.replace(
            "<link name=\"b\"/>",
            "<link name='b'><inertial><mass value='1'/><origin xyz='0.1 0 0'/>\
             <inertia ixx='0.1' iyy='0.1' izz='0.1' ixy='0' ixz='0' iyz='0'/></inertial></link>",
        );
        let mut robot = of_text(name, &format!("<robot name='r'>{heavy}{joints}</robot>"));
        let mut description = robot.model.description().clone();
        let at = |height: f64| mozzi::SE3::new(mozzi::SO3::identity(), mozzi::Vec3([0.1, 0.0, height]));
        let home = mozzi::SE3::new(mozzi::SO3::identity(), mozzi::Vec3([0.6, 0.0, 0.0]));
        use mozzi::model::description::{Anchor, Constraint};
        for (k, kind) in constraints.chars().enumerate() {
            let height = 0.2 * k as f64;
            let (world, b) = (Anchor::world(home * at(height)), Anchor::frame("b").at(at(height)));
            let name = format!("c{k}");
            description.constraints.push(match kind {
                'h' => Constraint::hinge(name, world, b),
                _ => Constraint::point(name, world, b),
            });
        }
        robot.model = description.build().unwrap();
        robot
    };
    let agrees = |a: &str, b: &str| {
        let comparison = compare_files(&robot("a.urdf", a), &robot("b.urdf", b), 3, 1, 1e-9).unwrap();
        (comparison.agrees(), comparison.causes().count())
    };
    assert_eq!(agrees("h", "pp"), (true, 0));
    assert_eq!(agrees("pp", "h"), (true, 0));
    assert_eq!(agrees("h", "p"), (false, 1), "one point is a ball");
}
