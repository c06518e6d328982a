//! MJCF and xacro are edited in place, in the files that hold the numbers.

use mozzi::linalg::Sym3;
use mozzi::{Description, SpatialInertia, Vec3};
use mozzi_urdf::{EditedFile, Settings, edit_files, load_with, parse};
use std::path::PathBuf;

const MJCF: &str = r#"<mujoco model="arm">
  <default>
    <joint damping="0.5" armature="0.01"/>
    <default class="stiff"><joint damping="2 0.1" frictionloss="0.3"/></default>
  </default>
  <worldbody>
    <!-- the arm -->
    <body name="upper">
      <inertial pos="0 0 0.1" mass="2" diaginertia="0.02 0.03 0.01" quat="0.8 0.6 0 0"/>
      <joint name="shoulder" axis="0 1 0"/>
      <body name="lower" pos="0 0 0.2">
        <inertial pos="0 0.1 0" mass="1" fullinertia="0.02 0.03 0.01 0 0.001 0"/>
        <joint name="elbow" axis="0 1 0" class="stiff"/>
        <body name="hand" pos="0 0 0.2">
          <joint name="wrist" axis="0 0 1" armature="0.02"/>
          <geom type="sphere" size="0.05" density="1000"/>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor joint="wrist" gear="10" armature="0.001"/>
  </actuator>
</mujoco>
"#;

/// A fresh folder with files; their paths.
fn folder(name: &str, files: &[(&str, &str)]) -> Vec<String> {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = |(name, text): &(&str, &str)| {
        let path = folder.join(name);
        std::fs::write(&path, text).expect("a file");
        path.to_str().expect("text").to_string()
    };
    files.iter().map(path).collect()
}

fn description(file: &str) -> Description {
    load_with(file, Settings::default()).unwrap_or_else(|why| panic!("{why}")).description
}

fn edited(file: &str, robot: &Description, keeps_old: bool) -> Result<Vec<EditedFile>, String> {
    let text = std::fs::read_to_string(file).expect("a file");
    edit_files(file, &text, robot, keeps_old, &Settings::default()).map_err(|why| why.to_string())
}

/// The lines that one text has and another lacks.
fn lacking(a: &str, b: &str) -> Vec<String> {
    a.lines().filter(|line| !b.lines().any(|other| other == *line)).map(|line| line.trim().to_string()).collect()
}

fn link<'r>(robot: &'r mut Description, name: &str) -> &'r mut SpatialInertia {
    &mut robot.links.iter_mut().find(|link| link.name == name).expect("a link").inertia
}

fn joint<'r>(robot: &'r mut Description, name: &str) -> &'r mut mozzi::model::description::Joint {
    robot.joints.iter_mut().find(|joint| joint.name == name).expect("a joint")
}

/// Both robots have the same numbers, up to rounding.
fn assert_same(a: &Description, b: &Description) {
    let numbers = |robot: &Description| -> Vec<f64> {
        let of_link = robot.links.iter().flat_map(|link| link.inertia.to_parameters());
        let of_joint = robot.joints.iter().flat_map(|one| [one.damping, one.friction, one.armature, one.stiffness]);
        of_link.chain(of_joint).collect()
    };
    for (a, b) in numbers(a).into_iter().zip(numbers(b)) {
        assert!((a - b).abs() <= 1e-14 + 1e-13 * b.abs(), "{a:?} instead of {b:?}");
    }
}

/// A text of numbers, up to rounding.
fn assert_numbers(text: &str, expected: &[f64]) {
    let found: Vec<f64> = text.split([' ', ',']).filter_map(|word| word.parse().ok()).collect();
    assert_eq!(found.len(), expected.len(), "{text}");
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{text}: expected {expected:?}");
}

fn turned(mass: f64) -> SpatialInertia {
    SpatialInertia::new(
        mass,
        Vec3([0.01, -0.02, 0.12]),
        Sym3 { xx: 0.02, xy: 0.003, xz: -0.002, yy: 0.035, yz: 0.001, zz: 0.018 },
    )
}

#[test]
fn mjcf_is_edited_in_its_own_words() {
    let file = folder("mjcf", &[("arm.xml", MJCF)]).remove(0);
    let original = description(&file);
    assert_eq!(edited(&file, &original, false), Ok(Vec::new()));
    let mut robot = original.clone();
    *link(&mut robot, "upper") = turned(2.5);
    *link(&mut robot, "lower") = turned(1.5);
    *link(&mut robot, "hand") = turned(0.7);
    joint(&mut robot, "shoulder").damping = 0.75;
    joint(&mut robot, "shoulder").friction = 0.1;
    joint(&mut robot, "elbow").damping = 3.0;
    joint(&mut robot, "wrist").armature = 0.5; // 0.1 of it is the actuator's
    let files = edited(&file, &robot, false).expect("edited");
    assert_eq!((files.len(), files[0].name.as_str()), (1, file.as_str()));
    let text = &files[0].text;
    let (new, old) = (lacking(text, MJCF), lacking(MJCF, text));
    assert_eq!((new.len(), old.len()), (6, 5), "{new:#?}");
    assert!(new[0].starts_with("<inertial pos=\"0.01 -0.02 0.12\" mass=\"2.5\" diaginertia="), "{}", new[0]);
    assert_eq!(new[1], "<joint name=\"shoulder\" axis=\"0 1 0\" damping=\"0.75\" frictionloss=\"0.1\"/>");
    let (start, rest) = new[2].split_once("fullinertia=\"").expect("moments");
    assert!(start.ends_with("mass=\"1.5\" "), "{}", new[2]);
    assert_numbers(rest.trim_end_matches("\"/>"), &[0.02, 0.035, 0.018, 0.003, -0.002, 0.001]);
    assert_eq!(new[3], "<joint name=\"elbow\" axis=\"0 1 0\" class=\"stiff\" damping=\"3.0\"/>");
    assert!(new[4].starts_with("<inertial pos=\"0.01 -0.02 0.12\" mass=\"0.7\" quat="), "{}", new[4]);
    assert!(new[5].starts_with("<joint name=\"wrist\" axis=\"0 0 1\" armature=\"0.4"), "{}", new[5]);
    assert_same(&parse(&file, text).expect("sound").description, &robot);
    // only a mass: only a number
    let mut robot = original.clone();
    let before = *link(&mut robot, "upper");
    *link(&mut robot, "upper") = SpatialInertia::new(2.25, before.center_of_mass(), before.about_center_of_mass());
    let files = edited(&file, &robot, true).expect("edited");
    let new = lacking(&files[0].text, MJCF);
    assert_eq!(new[1], "<inertial pos=\"0 0 0.1\" mass=\"2.25\" diaginertia=\"0.02 0.03 0.01\" quat=\"0.8 0.6 0 0\"/>");
    assert!(new[0].starts_with("<!-- before: mass 2.0, centre 0.0 0.0 0.1"), "{}", new[0]);
    assert_eq!(new.len(), 2);
}

#[test]
fn what_mjcf_cannot_say_is_refused() {
    let file = folder(
        "mjcf_refused",
        &[("arm.xml", &MJCF.replace("<default>\n", "<compiler settotalmass=\"5\"/>\n  <default>\n"))],
    )
    .remove(0);
    let mut robot = description(&file);
    *link(&mut robot, "upper") = turned(2.5);
    let why = edited(&file, &robot, false).expect_err("scaled");
    assert!(why.contains("link `upper`: the mass of the edited text would be"), "{why}");
    let file = folder("mjcf_refused", &[("less.xml", MJCF)]).remove(0);
    let mut robot = description(&file);
    joint(&mut robot, "wrist").armature = 0.05; // the actuator's is 0.1
    let why = edited(&file, &robot, false).expect_err("too small");
    assert!(why.contains("joint `wrist`: actuators and tendons have an armature of 0.1"), "{why}");
    let mut robot = description(&file);
    robot.gravity = [0.0, 0.0, -1.0];
    assert!(edited(&file, &robot, false).expect_err("gravity").contains("gravity is"));
}

#[test]
fn included_mjcf_is_edited_where_it_is() {
    let scene = "<mujoco model=\"scene\">\n  <include file=\"arm.xml\"/>\n</mujoco>\n";
    let files = folder("mjcf_included", &[("scene.xml", scene), ("arm.xml", MJCF)]);
    let mut robot = description(&files[0]);
    joint(&mut robot, "shoulder").damping = 0.75;
    let found = edited(&files[0], &robot, false).expect("edited");
    assert_eq!(found.iter().map(|file| &file.name).collect::<Vec<_>>(), [&files[1]]);
    assert_eq!(lacking(&found[0].text, MJCF), ["<joint name=\"shoulder\" axis=\"0 1 0\" damping=\"0.75\"/>"]);
}

const XACRO: &str = r#"<robot name="two" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="arm.xacro"/>
  <xacro:property name="config" value="${xacro.load_yaml('numbers.yaml')}"/>
  <xacro:property name="hand_mass" value="0.5"/>
  <link name="base"/>
  <xacro:arm side="left" mass="2.0" inertia="${config['moments']}"/>
  <link name="left_hand">
    <inertial>
      <origin xyz="0 0 0.05"/>
      <mass value="${hand_mass}"/>
      <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/>
    </inertial>
  </link>
  <joint name="left_wrist" type="continuous">
    <parent link="left_arm"/>
    <child link="left_hand"/>
    <axis xyz="0 0 1"/>
    <dynamics damping="${config['wrist']['damping']}" friction="${2 * hand_mass}"/>
  </joint>
</robot>
"#;

const ARM: &str = r#"<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="arm" params="side mass inertia center:='0 0 0.2'">
    <link name="${side}_arm">
      <inertial>
        <origin xyz="${center}"/>
        <mass value="${mass}"/>
        <inertia ixx="${inertia[0]}" ixy="0" ixz="0" iyy="${inertia[1]}" iyz="0" izz="${inertia[2]}"/>
      </inertial>
    </link>
    <joint name="${side}_shoulder" type="continuous">
      <parent link="base"/>
      <child link="${side}_arm"/>
      <axis xyz="0 1 0"/>
    </joint>
  </xacro:macro>
</robot>
"#;

const YAML: &str = "moments: [0.02, 0.03, 0.01]\nwrist:\n  damping: 0.4 # N m s\n";

fn xacro(name: &str, main: &str) -> Vec<String> {
    folder(name, &[("two.urdf.xacro", main), ("arm.xacro", ARM), ("numbers.yaml", YAML)])
}

fn changed(mut robot: Description) -> Description {
    let I = Sym3 { xx: 0.025, xy: 0.001, xz: 0.0, yy: 0.031, yz: 0.0, zz: 0.015 };
    *link(&mut robot, "left_arm") = SpatialInertia::new(2.25, Vec3([0.0, 0.01, 0.21]), I);
    joint(&mut robot, "left_shoulder").damping = 0.7;
    joint(&mut robot, "left_wrist").damping = 0.45;
    robot
}

#[test]
fn xacro_is_edited_where_its_numbers_are_written() {
    let files = xacro("xacro", XACRO);
    let original = description(&files[0]);
    assert_eq!(edited(&files[0], &original, false), Ok(Vec::new()));
    let robot = changed(original);
    let found = edited(&files[0], &robot, false).expect("edited");
    assert_eq!(found.iter().map(|file| &file.name).collect::<Vec<_>>(), files.iter().collect::<Vec<_>>());
    let [main, arm, yaml] = [&found[0].text, &found[1].text, &found[2].text];
    assert_eq!(lacking(main, XACRO), ["<xacro:arm side=\"left\" mass=\"2.25\" inertia=\"${config['moments']}\"/>"]);
    assert_eq!(
        lacking(arm, ARM),
        [
            "<xacro:macro name=\"arm\" params=\"side mass inertia center:='0 0.01 0.21'\">",
            "<inertia ixx=\"${inertia[0]}\" ixy=\"0.001\" ixz=\"0\" iyy=\"${inertia[1]}\" iyz=\"0\" izz=\"${inertia[2]}\"/>",
            "<dynamics damping=\"0.7\"/>",
        ]
    );
    let (moments, rest) = yaml.split_once("]\n").expect("a list");
    assert_numbers(moments.trim_start_matches("moments: ["), &[0.025, 0.031, 0.015]);
    assert_eq!(rest, "wrist:\n  damping: 0.45 # N m s\n");
    // the edited files are the robot
    let names = ["two.urdf.xacro", "arm.xacro", "numbers.yaml"];
    let texts: Vec<(&str, &str)> = names.into_iter().zip(found.iter().map(|file| file.text.as_str())).collect();
    assert_same(&description(&folder("xacro_again", &texts)[0]), &robot);
    // old values in comments
    let found = edited(&files[0], &robot, true).expect("edited");
    assert_eq!(lacking(&found[0].text, XACRO)[0], "<!-- before: 2.0 -->");
    assert!(found[2].text.contains("0.015] # before: 0.02, 0.03, 0.01\n"), "{}", found[2].text);
    assert!(found[2].text.contains("0.45 # N m s\n"));
    let texts: Vec<(&str, &str)> = names.into_iter().zip(found.iter().map(|file| file.text.as_str())).collect();
    assert_same(&description(&folder("xacro_comments", &texts)[0]), &robot);
}

#[test]
fn numbers_that_xacro_computes_or_shares_are_named() {
    let twice = XACRO.replace(
        "  <link name=\"left_hand\">",
        "  <xacro:arm side=\"right\" mass=\"2.0\" inertia=\"${config['moments']}\"/>\n  <link name=\"left_hand\">",
    );
    let files = xacro("xacro_shared", &twice);
    let mut robot = description(&files[0]);
    joint(&mut robot, "left_wrist").friction = 1.5;
    let why = edited(&files[0], &robot, false).expect_err("computed");
    assert!(
        why.contains("the friction of <dynamics> of joint `left_wrist` is computed, `${2 * hand_mass}` at"),
        "{why}"
    );
    assert!(why.contains("two.urdf.xacro:19:65"), "{why}");
    // the masses are arguments of two calls
    let mut robot = description(&files[0]);
    let scaled = |robot: &mut Description, name: &str, factor: f64| {
        let old = *link(robot, name);
        *link(robot, name) = SpatialInertia::new(factor * old.mass, old.center_of_mass(), old.about_center_of_mass());
    };
    scaled(&mut robot, "left_arm", 1.25);
    scaled(&mut robot, "right_arm", 1.5);
    let found = edited(&files[0], &robot, false).expect("edited");
    assert_eq!(found.len(), 1);
    assert_eq!(lacking(&found[0].text, &twice).len(), 2, "{:?}", lacking(&found[0].text, &twice));
    // the moments are one list for both
    let with_moment = |robot: &mut Description, name: &str, xx: f64| {
        let old = *link(robot, name);
        let I = Sym3 { xx, ..old.about_center_of_mass() };
        *link(robot, name) = SpatialInertia::new(old.mass, old.center_of_mass(), I);
    };
    with_moment(&mut robot, "left_arm", 0.022);
    with_moment(&mut robot, "right_arm", 0.024);
    let why = edited(&files[0], &robot, false).expect_err("shared");
    assert!(why.contains("numbers.yaml:1:11 (`0.02`) would be 0.02"), "{why}");
    assert!(why.contains(" as the ixx of <inertia> of link `left_arm` and 0.024"), "{why}");
    assert!(why.contains(" as the ixx of <inertia> of link `right_arm`"), "{why}");
    // of two that share a number, one alone changes
    with_moment(&mut robot, "right_arm", 0.02);
    let why = edited(&files[0], &robot, false).expect_err("shared");
    assert!(why.contains("link `right_arm`: a moment of the edited text would be"), "{why}");
    assert!(why.contains("it shares a number of the files with one that changes"), "{why}");
    // a macro's joint cannot have two dampings
    let mut robot = description(&files[0]);
    joint(&mut robot, "left_shoulder").damping = 0.1;
    joint(&mut robot, "right_shoulder").damping = 0.2;
    let why = edited(&files[0], &robot, false).expect_err("two dampings");
    assert!(why.contains("would have to differ between joint `left_shoulder` and joint `right_shoulder`"), "{why}");
    joint(&mut robot, "right_shoulder").damping = 0.1;
    assert_eq!(edited(&files[0], &robot, false).expect("edited").len(), 1);
}
