//! `mozzi simulate --ground`, and dry friction that sticks.

mod common;

use common::{complaint, file, folder, json, rows, text};

const ARM: &str = r#"<robot name="stuck">
  <link name="base"/>
  <link name="arm"><inertial><origin xyz="0.5 0 0"/><mass value="1"/>
    <inertia ixx="0.001" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="hinge" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
    <dynamics damping="0" friction="8"/></joint>
</robot>"#;

const CUBE: &str = r#"<robot name="cube"><link name="cube">
  <inertial><mass value="2"/><inertia ixx="0.003" iyy="0.003" izz="0.003" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
</link></robot>"#;

#[test]
fn dry_friction_holds_an_arm_by_every_method() {
    let arm = file(&folder("dry_friction"), "stuck.urdf", ARM);
    for method in ["auto", "moreau", "euler", "semi-implicit-euler", "rk4", "dopri", "midpoint"] {
        let found = json(&["simulate", &arm, "--theta", "0.3", "--time", "2", "--method", method]);
        let moved = rows(&found["theta"]).iter().map(|row| (row[0] - 0.3).abs()).fold(0.0, f64::max);
        println!("{method}: {} moves {moved:.1e} rad", found["method"]);
        assert!(moved < 1e-12);
    }
}

#[test]
fn a_cube_falls_on_the_ground() {
    let cube = file(&folder("ground"), "cube.urdf", CUBE);
    let found = json(&["simulate", &cube, "--floating", "--ground", "--theta", "1,0,0,0,0,0,0.1", "--time", "1"]);
    let last = rows(&found["theta"]).pop().expect("rows");
    assert!((last[6] - 0.05).abs() < 1e-12 && found["method"] == "Moreau-Jean", "{last:?}");
    let force = rows(&found["contact_forces"]).pop().expect("rows");
    let down: f64 = force.chunks(3).map(|f| f[2]).sum();
    assert!((down + 2.0 * 9.81).abs() < 1e-6, "{force:?}");
    assert_eq!(found["contact_events"][0]["change"], "touches down");
    assert_eq!(found["one_sided"]["unsolved"], 0);
    // a slope and a coefficient from a file
    let slope = r#"{"points": [{"frame": "cube", "at": [0.05, 0.05, -0.05], "friction": 0.1},
        {"frame": "cube", "at": [0.05, -0.05, -0.05], "friction": 0.1}, {"frame": "cube", "at": [-0.05, 0, -0.05]}],
        "planes": [{"name": "belt", "velocity": [0.5, 0, 0]}]}"#;
    let slope = file(&folder("ground_file"), "contacts.json", slope);
    let said = text(&["simulate", &cube, "--floating", "--contacts", &slope, "--time", "1"]);
    assert!(said.contains("contacts: 3 of 3 carry at the end") && said.contains("Moreau-Jean"), "{said}");
}

#[test]
fn what_is_wrong_with_contacts_is_said() {
    let cube = file(&folder("ground_wrong"), "cube.urdf", CUBE);
    for (flags, expected) in [
        (&["--contact", "cube"][..], "--contact needs --ground or --contacts"),
        (&["--ground", "--contact", "foot"], "foot"),
        (&["--ground", "--theta", "1,0,0,0,0,0,0"], "within its plane"),
        (&["--ground", "--restitution", "2"], "coefficient of restitution"),
    ] {
        let arguments = [&["simulate", &*cube, "--floating"][..], flags].concat();
        let (_, said) = complaint(&arguments);
        assert!(said.contains(expected), "{flags:?}: {said}");
    }
}

#[test]
fn anymal_is_put_on_its_feet() {
    let said = text(&["simulate", "anymal", "--floating", "--ground", "--time", "0.05"]);
    assert!(said.contains("contacts: ") && said.contains("touches down"), "{said}");
}
