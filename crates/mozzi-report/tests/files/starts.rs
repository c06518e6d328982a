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
