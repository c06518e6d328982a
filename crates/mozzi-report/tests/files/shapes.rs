//! Shapes: as reasons of an inertia, and as differences of their own.

use crate::{compare_edited, flat, has_cause};

const CUBE: &str = r#"<collision><geometry><mesh filename="cube.obj" scale="0.2 0.15 0.1"/></geometry></collision>"#;

/// A link of the given inertial, with a cube of 0.2 × 0.15 × 0.1 m between its frame's origin and (0.2, 0.15, 0.1).
fn arm() -> String {
    format!(
        "<robot name='r'><link name='base'/><link name='a'><inertial><mass value='2'/><origin xyz='0.12 0.03 -0.02'/>\
         <inertia ixx='0.03' ixy='0.002' ixz='0' iyy='0.045' iyz='0' izz='0.05'/></inertial>{CUBE}</link>\
         <joint name='j' type='continuous'><parent link='base'/><child link='a'/><axis xyz='0 1 0'/></joint></robot>"
    )
}

#[test]
fn an_inertia_of_a_mesh() {
    let text = arm();
    let (start, end) = (text.find("<inertial>").unwrap(), text.find(CUBE).unwrap());
    // 0.003 m³ of 1000 kg/m³
    let (x, y, z) = (0.04 / 4.0, 0.0225 / 4.0, 0.01 / 4.0);
    let filled = format!(
        "<inertial><mass value='3'/><origin xyz='0.1 0.075 0.05'/>\
         <inertia ixx='{}' ixy='0' ixz='0' iyy='{}' iyz='0' izz='{}'/></inertial>",
        y + z,
        x + z,
        x + y
    );
    has_cause(
        &compare_edited(&text, &[(&text[start..end], &filled)]),
        "b.urdf computes the inertia of `a` from its shapes, of 1000 kg/m³: 3 kg instead of the given 2 kg",
        true,
    );
}

#[test]
fn shapes_that_differ_do_not_change_the_verdict() {
    let scale = r#"scale="0.2 0.15 0.1""#;
    let sphere = "<collision><geometry><sphere radius='0.1'/></geometry></collision>";
    let moved = CUBE.replace("<collision>", "<collision><origin xyz='0 0 0.3'/>");
    let cases = [
        (
            scale,
            r#"scale="200 150 100""#,
            "mesh `cube` of scale 200 150 100 in b.urdf instead of mesh `cube` of scale 0.2",
        ),
        (scale, r#"scale="200 150 100""#, "0.2 0.15 0.1, by 1e3 (mm)"),
        (CUBE, moved.as_str(), "shapes of `a` differ: the mesh is elsewhere in b.urdf"),
        (CUBE, sphere, "shapes of `a` differ: sphere 0.1 in b.urdf instead of mesh `cube`"),
        (CUBE, "", "b.urdf has no shapes, a.urdf has 1 shape of 1 link"),
    ];
    for (from, to, words) in cases {
        let comparison = compare_edited(&arm(), &[(from, to)]);
        assert!(comparison.agrees() && comparison.causes().next().is_none(), "{}", comparison.text());
        let json = comparison.json();
        let notes: Vec<&str> = json["notes"].as_array().unwrap().iter().map(|note| note.as_str().unwrap()).collect();
        assert!(notes.len() == 1 && notes[0].contains(words), "{words}: {}", comparison.text());
    }
    let dropped = compare_edited(&arm().replace(CUBE, &format!("{CUBE}{sphere}")), &[(sphere, "")]);
    assert!(
        flat(&dropped).contains("note: shapes of `a` differ: sphere 0.1 is dropped in b.urdf"),
        "{}",
        dropped.text()
    );
}
