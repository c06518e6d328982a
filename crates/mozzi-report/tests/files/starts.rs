//! Where robots begin: a free base's pose, starts and named states.

use crate::{flat, is_accounted_for, of_text};
use mozzi_report::compare::files::{FilesComparison, compare_files};

fn compare(a: (&str, &str), b: (&str, &str)) -> FilesComparison {
    compare_files(&of_text(a.0, a.1), &of_text(b.0, b.1), 5, 1, 1e-9).unwrap()
}

/// A body at `pose` that carries an arm: `free` is its joint, `keys` are at the end.
fn mjcf(pose: &str, free: &str, keys: &str) -> String {
    format!(
        "<mujoco model='m'><compiler angle='radian'/><worldbody><body name='base' {pose}>{free}<geom size='0.1' mass='1'/>\
         <body name='arm' pos='0.3 0 0'><joint name='j' axis='0 1 0'/><geom size='0.1' pos='0.1 0 0' mass='1'/></body></body>\
         </worldbody>{keys}</mujoco>"
    )
}

#[test]
fn a_base_that_starts_elsewhere_and_is_free_in_one_file_only() {
    let (fixed, key) =
        (mjcf("pos='0 0 1'", "", ""), "<keyframe><key name='home' qpos='0 0 2 1 0 0 0 0.4'/></keyframe>");
    for keys in ["", key] {
        let free = mjcf("pos='0 0 1'", "<freejoint/>", keys);
        for (a, b) in [(("a.xml", &fixed), ("free.xml", &free)), (("free.xml", &free), ("b.xml", &fixed))] {
            let comparison = compare((a.0, a.1), (b.0, b.1));
            let text = flat(&comparison);
            assert!(text.contains(": another robot: the base is free in one file only"), "{text}");
            assert!(text.contains("the base is free in free.xml only; compared with a fixed base"), "{text}");
            assert!(comparison.causes().next().is_none() && !comparison.agrees(), "{text}");
        }
    }
    // a base that stands turned feels another gravity than one that is held as it is at 0
    let comparison = compare(("a.xml", &mjcf("", "<freejoint/>", "")), ("b.xml", &mjcf("euler='0.3 0 0'", "", "")));
    let text = flat(&comparison);
    assert!(text.contains("the base is at (0, 0, 0) in b.xml, at (0, 0, 0) here, and turned by"), "{text}");
    assert!(is_accounted_for(&comparison), "{text}");
}

/// A model of SDFormat whose joint begins at this position.
fn sdf(position: &str) -> String {
    let link = |name: &str| {
        format!(
            "<link name='{name}'><inertial><mass>1</mass><inertia><ixx>.1</ixx><iyy>.1</iyy><izz>.1</izz></inertia></inertial></link>"
        )
    };
    let joint = format!(
        "<joint name='j' type='revolute'><parent>base</parent><child>arm</child><axis><xyz>0 1 0</xyz>{position}</axis></joint>"
    );
    format!("<sdf version='1.9'><model name='m'>{}{}{joint}</model></sdf>", link("base"), link("arm"))
}

/// The comparison has this one cause of two robots of the same forces.
fn differs(comparison: &FilesComparison, words: &str, kinds: &str) {
    let (text, causes) = (flat(comparison), comparison.causes().collect::<Vec<_>>());
    assert_eq!(causes, [words], "{text}");
    assert!(text.contains(&format!(": the same masses and geometry; {kinds} differ")), "{text}");
    assert!(comparison.forces_agree() && !comparison.agrees(), "{text}");
}

#[test]
fn another_start_is_a_difference() {
    let at = |x: &str| sdf(&format!("<initial_position>{x}</initial_position>"));
    for (a, b, words) in [
        (sdf(""), at("0.7"), "the robot starts elsewhere in b.sdf: `j` 0.7 instead of 0"),
        (at("0.7"), sdf(""), "the robot starts elsewhere in b.sdf: `j` 0 instead of 0.7"),
        (at("0.7"), at("0.8"), "the robot starts elsewhere in b.sdf: `j` 0.8 instead of 0.7"),
    ] {
        differs(&compare(("a.sdf", &a), ("b.sdf", &b)), words, "starts");
    }
    let same = compare(("a.sdf", &at("0.7")), ("b.sdf", &at("0.7")));
    assert!(same.agrees() && !same.text().contains("note"), "{}", same.text());
    let free = |pose: &str| mjcf(pose, "<freejoint/>", "");
    let moved = "the robot starts elsewhere in b.xml: the base by 1 m and turned by 28.6479°";
    let (a, b) = (free("pos='0 0 1'"), free("pos='0 0 2' euler='0 0.5 0'"));
    differs(&compare(("a.xml", &a), ("b.xml", &b)), moved, "starts");
}

#[test]
fn a_start_that_a_format_cannot_have_is_a_note() {
    let urdf = mozzi_urdf::write(of_text("a.sdf", &sdf("")).model.description()).unwrap();
    let start = sdf("<initial_position>0.7</initial_position>");
    for (a, b) in [(("a.sdf", &start), ("b.urdf", &urdf)), (("b.urdf", &urdf), ("a.sdf", &start))] {
        let comparison = compare((a.0, a.1), (b.0, b.1));
        assert!(comparison.agrees(), "{}", comparison.text());
        assert!(flat(&comparison).contains("note: state of a.sdf only: `initial`"), "{}", comparison.text());
    }
}

#[test]
fn named_states() {
    let keys = |keys: &str| mjcf("", "", &format!("<keyframe>{keys}</keyframe>"));
    let home = keys("<key name='home' qpos='0.4'/>");
    let of = |other: &str| compare(("a.xml", &home), ("b.xml", &keys(other)));
    for (other, words) in [
        ("<key name='home' qpos='0.5'/>", "state `home` differs in b.xml: `j` 0.5 instead of 0.4"),
        ("<key name='home' qpos='0.4' time='2'/>", "state `home` differs in b.xml: time 2 instead of 0"),
        ("<key name='home' qpos='0.4' qvel='1'/>", "state `home` differs in b.xml: the velocity of `j` 1 instead of 0"),
    ] {
        differs(&of(other), words, "named states");
    }
    let comparison = of("<key name='rest' qpos='0.4'/>");
    let text = flat(&comparison);
    assert!(comparison.agrees() && comparison.causes().next().is_none(), "{text}");
    assert!(text.contains("note: state of a.xml only: `home` note: state of b.xml only: `rest`"), "{text}");
}
