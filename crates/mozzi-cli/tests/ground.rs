//! `mozzi simulate --ground`, and dry friction that sticks.

use crate::common;

use common::{complaint, file, folder, json, mozzi, rows, text};
use mozzi::Model;
use mozzi_sim::{Method, Options, Simulation, Zero};

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
fn dry_friction_holds_an_arm_and_smooth_methods_refuse_it() {
    let arm = file(&folder("dry_friction"), "stuck.urdf", ARM);
    for method in ["euler", "semi-implicit-euler", "rk4", "dopri", "midpoint"] {
        let flags = ["simulate", &*arm, "--theta", "0.3", "--time", "0.1", "--method", method];
        let (_, said) = complaint(&flags);
        assert!(said.contains("dry friction of `hinge`") && said.contains("`moreau`"), "{said}");
        json(&[&flags[..], &["--slip-speed", "0.1"]].concat());
    }
    for method in ["auto", "moreau"] {
        let found = json(&["simulate", &arm, "--theta", "0.3", "--time", "2", "--method", method]);
        let moved = rows(&found["theta"]).iter().map(|row| (row[0] - 0.3).abs()).fold(0.0, f64::max);
        println!("{method}: {} moves {moved:.1e} rad", found["method"]);
        assert!(moved < 1e-12);
    }
}

#[test]
fn without_shapes_the_last_links_that_move_touch() {
    let said = mozzi(&["simulate", "anymal", "--floating", "--ground", "--time", "0.01"]);
    let said = String::from_utf8_lossy(&said.stderr).to_string();
    assert!(said.contains("its last links touch: LF_FOOT, RF_FOOT, LH_FOOT, RH_FOOT\n"), "{said}");
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
fn of_many_points_those_that_carry_are_written() {
    let folder = folder("ground_many");
    let cube = file(&folder, "cube.urdf", CUBE);
    let point = |k: usize| {
        let side = |bit: usize| if k & bit == 0 { -0.05 } else { 0.05 };
        let z = if k < 4 { -0.05 } else { 0.05 };
        format!(r#"{{"frame": "cube", "at": [{}, {}, {z}], "name": "{k}"}}"#, side(1), side(2))
    };
    for (count, written) in [(100, 100), (101, 4)] {
        let points = (0..count).map(point).collect::<Vec<_>>().join(", ");
        let contacts = file(&folder, "many.json", &format!(r#"{{"points": [{points}]}}"#));
        let page = folder.join("page.html").display().to_string();
        let flags = ["--contacts", &contacts, "--theta", "1,0,0,0,0,0,0.06", "--time", "0.2", "--report", &page];
        let found = json(&[&["simulate", &cube, "--floating"], &flags[..]].concat());
        let names = found["contacts"].as_array().expect("names");
        let forces = rows(&found["contact_forces"]).pop().expect("rows");
        assert_eq!((names.len(), forces.len()), (written, 3 * written));
        assert_eq!((&names[3], forces[2] < 0.0), (&"3".into(), true));
    }
}

#[test]
fn tables_have_normal_and_tangential_forces() {
    // a box on a slope of 0.2 rad holds by friction: m g cos α along the normal, m g sin α across
    let folder = folder("ground_forces");
    let cube = file(&folder, "cube.urdf", CUBE);
    let (sin, cos) = (0.1_f64.sin(), 0.1_f64.cos());
    let slope = format!(
        r#"{{"points": [{}], "planes": [{{"pose": [{cos}, 0, {sin}, 0, 0, 0, 0]}}]}}"#,
        [[1, 1], [1, -1], [-1, 1], [-1, -1]]
            .map(|[x, y]| format!(
                r#"{{"frame": "cube", "at": [{}, {}, -0.05], "name": "{x}{y}"}}"#,
                0.05 * f64::from(x),
                0.05 * f64::from(y)
            ))
            .join(", ")
    );
    let slope = file(&folder, "slope.json", &slope);
    let theta = format!("{cos},0,{sin},0,{},0,{}", 0.05 * (2.0 * sin * cos), 0.05 * (cos * cos - sin * sin));
    for ending in ["csv", "npz", "npy"] {
        let out = folder.join(format!("slide.{ending}")).display().to_string();
        let flags = ["--contacts", &slope, "--contact-forces", "--time", "0.5", "--out", &out];
        text(&[&["simulate", &cube, "--floating", "--theta", &theta], &flags[..]].concat());
        // what is written is read again
        text(&["compute", &cube, "gravity-forces", "--floating", "--in", &out]);
        if ending == "csv" {
            let table = std::fs::read_to_string(&out).expect("written");
            let header: Vec<&str> = table.lines().next().expect("a header").split(',').collect();
            let last: Vec<f64> = table.lines().last().expect("rows").split(',').map(|x| x.parse().expect(x)).collect();
            let sum = |force: &str| {
                let of = header.iter().zip(&last).filter(|(name, _)| name.starts_with(force));
                of.map(|(_, x)| *x).fold((0, 0.0), |(count, sum), x| (count + 1, sum + x))
            };
            let weight = 2.0 * 9.81;
            let ((normals, f_n), (tangents, f_t)) = (sum("f_n_"), sum("f_t_"));
            assert_eq!((normals, tangents), (4, 4), "{header:?}");
            assert!(
                (f_n - weight * 0.2_f64.cos()).abs() < 1e-6 && (f_t - weight * 0.2_f64.sin()).abs() < 1e-6,
                "{f_n} {f_t}"
            );
        }
    }
}

#[test]
fn attributes_of_soft_contacts_are_named_and_ellipsoids_touch() {
    let egg = r#"<mujoco><worldbody><geom type="plane" size="1 1 1"/>
      <body pos="0 0 0.1"><freejoint/><geom type="ellipsoid" size="0.3 0.2 0.1" solref="0.01 1" margin="0.001"/></body>
      </worldbody></mujoco>"#;
    let egg = file(&folder("ground_soft"), "egg.xml", egg);
    let run = common::mozzi(&["simulate", &egg, "--ground", "--time", "0.2", "--json"]);
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(said.contains("--ground: not used by rigid contacts: margin (1 geom), solref (1 geom)"), "{said}");
    assert!(said.contains("--ground: 1 contact point, 1 plane"), "{said}");
    let found: serde_json::Value = serde_json::from_slice(&run.stdout).expect("JSON");
    let last = rows(&found["theta"]).pop().expect("rows");
    assert!((last[6] - 0.1).abs() < 1e-12, "{last:?}");
}

#[test]
fn a_start_in_the_ground_is_lifted_and_a_deep_one_is_refused() {
    let cube = file(&folder("ground_start"), "cube.urdf", CUBE);
    let start = |z: f64| format!("1,0,0,0,0,0,{z}");
    let at = start(0.03);
    let flags = ["simulate", &*cube, "--ground", "--time", "0.1", "--json", "--floating", "--theta", &at];
    let run = common::mozzi(&flags);
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(said.contains("the base starts at z = 0.050000 m, 0.020000 m higher than given"), "{said}");
    assert!(said.contains("8 contact points, 1 plane"), "{said}");
}

/// Two rods whose tips are tied: they close beyond the limits of the first.
#[test]
fn a_loop_that_limits_keep_open_names_other_starts() {
    let rod = |name: &str, x: f64, range: &str| {
        format!(
            "<body name='{name}' pos='{x} 0 1'><joint name='j{name}' axis='0 1 0' range='{range}'/>\
             <geom type='capsule' fromto='0 0 0 0 0 0.5' size='0.02'/>\
             <site name='{name}' pos='0 0 0.5'/></body>"
        )
    };
    let tie = "<equality><connect site1='a' site2='b'/></equality>";
    let (a, b) = (rod("a", 0.0, "0.5 2"), rod("b", 0.4, "-3 3"));
    let key = "<keyframe><key name='home' qpos='2.73007580752231 -2.73007580752231'/></keyframe>";
    let world = format!("<worldbody><geom type='plane' size='1 1 1'/>{a}{b}</worldbody>");
    let robot = format!("<mujoco><compiler angle='radian'/>{world}{tie}{key}</mujoco>");
    let robot = file(&folder("kept_open"), "rods.xml", &robot);
    let (_, said) = complaint(&["simulate", &robot, "--ground", "--time", "0.01"]);
    assert!(
        said.contains("near the guess; `--state home` starts there; `--joint-limits ignore` starts beyond limits"),
        "{said}"
    );
    json(&["simulate", &robot, "--ground", "--time", "0.01", "--joint-limits", "ignore"]);
}

/// A pinned foot is where it stands on the ground, and loops are closed before the robot is put there.
#[test]
fn pinned_and_closed_robots_start_on_the_ground() {
    let common = ["simulate", "anymal", "--floating", "--ground", "--time", "0.01"];
    let found = json(&[&common[..], &["--pin", "LF_FOOT=point"]].concat());
    let start = rows(&found["theta"]).remove(0);
    assert!((start[6] - 0.57125).abs() < 1e-4, "{start:?}");
    // two legs of unequal length that a rod keeps at their distance: closing the loop turns them
    let leg = |name: &str, y: f64, length: f64| {
        format!(
            "<link name='{name}'><inertial><mass value='1'/><inertia ixx='0.01' iyy='0.01' izz='0.01' ixy='0' ixz='0' \
             iyz='0'/></inertial><collision><origin xyz='0 0 {at}'/><geometry><box size='0.05 0.05 {length}'/></geometry>\
             </collision></link><joint name='{name}_hip' type='continuous'><parent link='body'/><child link='{name}'/>\
             <origin xyz='0 {y} 0'/><axis xyz='1 0 0'/></joint>",
            at = -0.5 * length
        )
    };
    let body = "<link name='body'><inertial><mass value='3'/><inertia ixx='0.1' iyy='0.1' izz='0.1' ixy='0' ixz='0' \
                iyz='0'/></inertial></link>";
    let robot = format!("<robot name='biped'>{body}{}{}</robot>", leg("left", 0.2, 0.5), leg("right", -0.2, 0.4));
    let folder = folder("ground_loop");
    let robot = file(&folder, "biped.urdf", &robot);
    let rod = r#"{"constraints": [{"name": "rod", "kind": "distance", "length": 0.3, "a": {"frame": "left", "xyz":
      [0, 0, -0.2]}, "b": {"frame": "right", "xyz": [0, 0, -0.2]}}]}"#;
    let rod = file(&folder, "rod.json", rod);
    let flags = ["simulate", &*robot, "--constraints", &rod, "--floating", "--ground", "--time", "0.01"];
    let found = json(&flags);
    let start = rows(&found["theta"]).remove(0);
    let legs = [(start[7], 0.5), (start[8], 0.4)]; // the lowest corner of each touches, or is above
    let low = legs.map(|(angle, length)| start[6] - length * angle.cos() - 0.025 * angle.sin().abs());
    assert!(start[7].abs() > 0.05 && low[0].min(low[1]).abs() < 1e-3, "{start:?} {low:?}");
}

#[test]
fn mjcf_touches_by_its_bits_and_stands_on_its_own_planes() {
    // the drawn box collides, the one of group 3 does not; the floor is 0.2 m up
    let world = r#"<mujoco><worldbody><geom name="floor" type="plane" size="1 1 1" pos="0 0 0.2"/>
      <body pos="0 0 1"><freejoint/><geom type="box" size="0.1 0.1 0.1" friction="0.3"/>
      <geom type="box" size="0.2 0.2 0.2" group="3" contype="0" conaffinity="0" mass="0"/></body>
    </worldbody></mujoco>"#;
    let world = file(&folder("ground_mjcf"), "world.xml", world);
    let found = json(&["simulate", &world, "--ground", "--time", "1"]);
    let last = rows(&found["theta"]).pop().expect("rows");
    assert!((last[6] - 0.3).abs() < 1e-9, "{last:?}");
    assert_eq!(found["contacts"].as_array().expect("a list").len(), 8);
}

#[test]
fn what_is_wrong_with_contacts_is_said() {
    let cube = file(&folder("ground_wrong"), "cube.urdf", CUBE);
    let folder = folder("ground_wrong_files");
    for (k, (contacts, expected)) in [
        (
            r#"{"points": [{"frame": "cube", "frictoin": 0.0}]}"#,
            "0.json:1:31: `frictoin` is not an entry of points[0], did you mean `friction`?",
        ),
        (r#"{"points": {"frame": "cube"}}"#, "1.json:1:2: points is {\"frame\":\"cube\"}, expected a list"),
        (r#"{"points": [{"frame": "cube"}], "planes": "floor"}"#, "2.json:1:33: planes is \"floor\", expected a list"),
        (
            r#"{"points": [{"frame": "cube", "at": [0, null, 0, "x", -0.5]}]}"#,
            "points[0].at[1] is null, expected a number",
        ),
        (r#"{"points": [7]}"#, "points[0] is 7, expected an object"),
        (r#"{"points": [{"frame": "cube", "frame": "cube"}]}"#, "`frame` is given twice"),
        (r#"{"points": [{"frame": "cub"}]}"#, "6.json:1:14: there is no frame `cub`; this robot has `cube`"),
        (r#"{"planes": [{"pose": [1, 1, 0, 0, 0, 0, 0]}]}"#, "with a unit quaternion"),
        (r#"{"points": [{"frame": "cube", "friction": 1e300}]}"#, "1e300 of contact point `cube`, expected 0 to 1e6"),
    ]
    .into_iter()
    .enumerate()
    {
        let contacts = file(&folder, &format!("{k}.json"), contacts);
        let (_, said) = complaint(&["simulate", &*cube, "--floating", "--contacts", &contacts]);
        assert!(said.contains(expected), "{said}");
    }
    for (flags, expected) in [
        (&["--contact", "cube"][..], "--contact has no effect without --ground or --contacts"),
        (&["--ground", "--contact", "foot"], "foot"),
        (&["--ground", "--theta", "1,0,0,0,0,0,-0.1"], "link `cube` starts 0.150000 m within the ground"),
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

/// Talos with dry friction in every joint: of its file, or else 1 N m.
fn talos() -> Option<Model> {
    let folder = std::path::PathBuf::from(std::env::var_os("MOZZI_ROBOTS")?);
    let file = folder.join("talos_data/robots/talos_reduced.urdf");
    let mut robot = mozzi_urdf::open(file.to_str().filter(|_| file.is_file())?).expect("Talos").description.floating();
    robot.joints.iter_mut().filter(|joint| joint.friction == 0.0).for_each(|joint| joint.friction = 1.0);
    Some(robot.build().expect("sound"))
}

#[test]
fn dry_friction_holds_talos_in_free_fall() {
    let Some(model) = talos() else {
        return println!("skipped: MOZZI_ROBOTS is not set or has no Talos; cargo xtask test sets it");
    };
    let (nq, n) = (model.nq(), model.n());
    let start: Vec<f64> = model.neutral_configuration();
    // at rest, and tumbling: then friction carries what keeps the limbs on their circles
    let mut tumbling = vec![0.0; n];
    tumbling[..3].copy_from_slice(&[0.3, -0.2, 0.25]);
    {
        let method = Method::Automatic;
        for dtheta in [vec![0.0; n], tumbling.clone()] {
            let options = Options { method, record_every: 10, ..Options::new(1.0, 500) };
            let run = Simulation::new(options).run(&model, &start, &dtheta, Zero).expect("a motion");
            let joints = |row: &[f64], from: usize, first: &[f64]| -> f64 {
                row[from..].iter().zip(&first[from..]).map(|(x, x0)| (x - x0).abs()).fold(0.0, f64::max)
            };
            let moved = run.motion.theta.chunks(nq).map(|row| joints(row, 7, &start)).fold(0.0, f64::max);
            let fastest = run.motion.dtheta.chunks(n).map(|row| joints(row, 6, &vec![0.0; n])).fold(0.0, f64::max);
            let fallen = start[6] - run.motion.last().theta[6];
            let (name, spins) = (run.method.name(), dtheta[0] != 0.0);
            println!("{name}, spinning {spins}: {} joints move {moved:.1e} rad, {fastest:.1e} rad/s", n - 6);
            assert!(moved <= 1e-12 && fastest <= 1e-12);
            assert!(spins || (fallen - 0.5 * 9.81).abs() < 0.02, "it falls: {fallen}");
        }
    }
}

/// The head of example-robot-data's iCub has hardly any inertia about its neck: no correction may turn it by anything.
#[test]
fn a_head_without_inertia_stays_on() {
    let Ok(robots) = std::env::var("MOZZI_ROBOTS") else {
        eprintln!("skipped: MOZZI_ROBOTS does not name the folder of example-robot-data");
        return;
    };
    let icub = format!("{robots}/icub_description/robots/icub.urdf");
    let mut start =
        "0.9988948728277206,0.02845483687467218,-0.002800124035531484,0.03730301063337171,0,0,0.8975002688521863"
            .to_string();
    (0..32).for_each(|k| start += if [18, 28].contains(&k) { ",0.0959931" } else { ",0" });
    let table = folder("icub").join("fall.csv");
    let out = table.to_str().expect("text");
    let output = mozzi(&[
        "simulate",
        &icub,
        "--floating",
        "--ground",
        "--theta",
        &start,
        "--time",
        "1",
        "--torque",
        "zero",
        "--out",
        out,
    ]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = std::fs::read_to_string(&table).expect("a table");
    let names: Vec<&str> = text.lines().next().expect("a header").split(',').collect();
    for row in text.lines().skip(1) {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().expect("a number")).collect();
        let positions = names.iter().zip(&cells).filter(|(name, _)| name.starts_with("theta_"));
        assert!(positions.clone().all(|(_, x)| x.abs() < 10.0), "{:?}", positions.collect::<Vec<_>>());
    }
}
