//! `mozzi identify` writes the robot in its file's own words, and reads floating robots and bags of rosbag2.

use crate::common;

use common::{complaint, file, folder, json, mozzi, text};
use mozzi::{Environment, Model, Wrench};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

const MJCF: &str = r#"<mujoco model="pendulum">
  <default>
    <joint damping="0.2"/>
  </default>
  <worldbody>
    <body name="rod1">
      <inertial pos="0 0 -0.25" mass="1" diaginertia="0.02 0.02 0.001"/>
      <joint name="joint1" axis="0 -1 0"/>
      <body name="rod2" pos="0 0 -0.5">
        <inertial pos="0 0 -0.25" mass="1" diaginertia="0.02 0.02 0.001"/>
        <joint name="joint2" axis="0 -1 0" frictionloss="0.1"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"#;

const XACRO: &str = r#"<robot name="pendulum" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="first" value="1.0"/>
  <xacro:macro name="rod" params="name mass xx yy zz xz center">
    <link name="${name}">
      <inertial>
        <origin xyz="${center}"/>
        <mass value="${mass}"/>
        <inertia ixx="${xx}" ixy="0" ixz="${xz}" iyy="${yy}" iyz="0" izz="${zz}"/>
      </inertial>
    </link>
  </xacro:macro>
  <link name="base"/>
  <xacro:rod name="rod1" mass="${first}" xx="0.02" yy="0.02" zz="0.001" xz="0" center="0 0 -0.25"/>
  <xacro:rod name="rod2" mass="1.0" xx="0.02" yy="0.02" zz="0.001" xz="0" center="0 0 -0.25"/>
  <joint name="joint1" type="continuous">
    <parent link="base"/>
    <child link="rod1"/>
    <axis xyz="0 -1 0"/>
    <dynamics damping="0.2" friction="0"/>
  </joint>
  <joint name="joint2" type="continuous">
    <parent link="rod1"/>
    <child link="rod2"/>
    <origin xyz="0 0 -0.5"/>
    <axis xyz="0 -1 0"/>
    <dynamics damping="0.2" friction="0.1"/>
  </joint>
</robot>
"#;

fn path(folder: &Path, name: &str) -> String {
    folder.join(name).to_str().expect("a path of text").to_string()
}

/// A motion of a robot with its own torques.
fn motion(folder: &Path, robot: &str) -> String {
    let way = path(folder, "way.csv");
    let limits = ["--max-velocity", "3", "--max-acceleration", "10", "--harmonics", "3"];
    text(&[&["excite", robot, "--duration", "5", "--out", &way], &limits[..]].concat());
    way
}

/// The error of the robot's own predictions, relative to the forces.
fn own_error(robot: &str, log: &str) -> f64 {
    let found = json(&["identify", robot, log, "--only", "friction"]);
    let [force, own] = ["force", "robot"].map(|name| common::numbers(&found["fitted"][name]));
    force.iter().zip(own).map(|(force, own)| own / force).fold(0.0, f64::max)
}

#[test]
fn mjcf_is_written_as_mjcf() {
    let folder = folder("identify_mjcf");
    let robot = file(&folder, "robot.xml", MJCF);
    let other = file(&folder, "other.xml", &MJCF.replace("mass=\"1\"", "mass=\"1.3\"").replace("0.2\"/>", "0.5\"/>"));
    let way = motion(&folder, &other);
    let out = path(&folder, "identified.xml");
    let told = text(&["identify", &robot, &way, "--out", &out, "--old-values"]);
    assert!(told.contains(&format!("{out} is written")), "{told}");
    let written = std::fs::read_to_string(&out).expect("MJCF");
    assert!(written.contains("<joint damping=\"0.2\"/>"), "the class stays: {written}");
    assert!(written.contains("<joint name=\"joint1\" axis=\"0 -1 0\" damping=\"0."), "{written}");
    assert!(written.contains("<!-- before: mass 1.0, centre 0.0 0.0 -0.25"), "{written}");
    let (before, after) = (own_error(&robot, &way), own_error(&out, &way));
    assert!(before > 0.1 && after < 0.04, "{before} and {after}");
    let (_, why) = complaint(&["identify", &robot, &way, "--out", &path(&folder, "x.xacro")]);
    assert!(why.contains("robot.xml is MJCF; expected a name that ends in .xml or .urdf"), "{why}");
    let (_, why) = complaint(&["identify", &robot, &way, "--out", &robot]);
    assert!(why.contains("--out is the file MODEL") && why.contains("expected another name"), "{why}");
}

#[test]
fn xacro_is_written_as_xacro() {
    let folder = folder("identify_xacro");
    let robot = file(&folder, "robot.urdf.xacro", XACRO);
    let changed = XACRO.replace("value=\"1.0\"", "value=\"1.3\"").replace("damping=\"0.2\"", "damping=\"0.5\"");
    let other = file(&folder, "other.urdf.xacro", &changed);
    let way = motion(&folder, &other);
    let out = path(&folder, "identified.urdf.xacro");
    text(&["identify", &robot, &way, "--out", &out]);
    let written = std::fs::read_to_string(&out).expect("xacro");
    assert!(written.contains("mass=\"${first}\"") && !written.contains("name=\"first\" value=\"1.0\""), "{written}");
    let (before, after) = (own_error(&robot, &way), own_error(&out, &way));
    assert!(before > 0.1 && after < 0.04, "{before} and {after}");
    // a mass that is computed is named, with the remedy
    let computed = file(&folder, "computed.urdf.xacro", &XACRO.replace("mass=\"1.0\"", "mass=\"${2 * first - 1}\""));
    let (_, why) = complaint(&["identify", &computed, &way, "--out", &out]);
    assert!(why.contains("the value of <mass> of link `rod2` is computed, `${mass}` at"), "{why}");
    assert!(why.contains("--out NAME.urdf writes all numbers as URDF"), "{why}");
    text(&["identify", &computed, &way, "--out", &path(&folder, "computed.urdf")]);
    let (_, why) = complaint(&["identify", &robot, &way, "--out", &path(&folder, "x.yaml")]);
    assert!(why.contains("expected a name that ends in .xacro, or a folder"), "{why}");
    let all = path(&folder, "all/");
    let told = text(&["identify", &robot, &way, "--out", &all]);
    assert!(told.contains("robot.urdf.xacro is written") && folder.join("all/robot.urdf.xacro").exists(), "{told}");
}

/// A floating double pendulum that is heavier than its file, held at its tip: the wrench there is measured.
fn held(folder: &Path) -> (Model, String) {
    let file = mozzi_urdf::open("double_pendulum").expect("embedded").description.floating().build().expect("sound");
    let parameters: Vec<f64> = file
        .parameters()
        .iter()
        .zip(file.parameter_names())
        .map(|(x, name)| if name.starts_with("rod") || name.starts_with("base") { 1.2 * x } else { *x })
        .collect();
    let truth = file.with_parameters(&parameters);
    let (n, foot) = (truth.n(), truth.frame("tip").expect("a frame"));
    let mut table = String::from("t");
    let header = |table: &mut String, group: &str, names: &mut dyn Iterator<Item = &str>| {
        names.for_each(|name| write!(table, ",{group}_{name}").expect("text"));
    };
    header(&mut table, "theta", &mut truth.position_names());
    header(&mut table, "dtheta", &mut truth.velocity_names());
    header(&mut table, "ddtheta", &mut truth.velocity_names());
    header(&mut table, "tau", &mut truth.velocity_names().skip(6));
    header(&mut table, "wrench_tip", &mut ["m_x", "m_y", "m_z", "f_x", "f_y", "f_z"].into_iter());
    table.push('\n');
    let (rate, mut theta) = (200.0, truth.neutral_configuration::<f64>());
    let wave = |j: usize, t: f64| {
        let (a, w, p) = (0.6 + 0.05 * j as f64, 2.0 + 0.37 * j as f64, 0.9 * j as f64);
        (a * (w * t + p).cos(), -a * w * (w * t + p).sin())
    };
    for k in 0..1200 {
        let t = k as f64 / rate;
        let (dtheta, ddtheta): (Vec<f64>, Vec<f64>) = (0..n).map(|j| wave(j, t)).unzip();
        let free = truth.inverse_dynamics(&theta, &dtheta, &ddtheta, &truth.environment()).expect("lengths");
        // the wrench at the tip is all that holds the base: τ_base = 0
        let J = truth.body_jacobian(&theta, foot).expect("a Jacobian");
        let of_base = J.matrix().columns(0, 6).transpose();
        let F = of_base.lu().solve(&-nalgebra::DVector::from_iterator(6, (0..6).map(|j| free[j]))).expect("regular");
        let F: [f64; 6] = core::array::from_fn(|i| F[i]);
        let applied = [(foot, Wrench::from_array(F))];
        let environment = Environment { applied: &applied, ..truth.environment() };
        let tau = truth.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment).expect("lengths");
        assert!((0..6).all(|j| tau[j].abs() < 1e-9));
        write!(table, "{t:?}").expect("text");
        let tau = tau.iter().copied().skip(6);
        let row = theta.iter().copied().chain(dtheta).chain(ddtheta).chain(tau).chain(F);
        row.for_each(|x| write!(table, ",{x:?}").expect("text"));
        table.push('\n');
        let half: Vec<f64> = (0..n).map(|j| wave(j, t + 0.5 / rate).0).collect();
        mozzi::model::integrate(&truth, &mut theta, &half, 1.0 / rate);
    }
    (truth, common::file(folder, "held.csv", &table))
}

#[test]
fn a_floating_robot_is_identified_from_a_file() {
    let folder = folder("identify_floating");
    let (truth, log) = held(&folder);
    let out = path(&folder, "identified.json");
    let run = |log: &str| {
        json(&["identify", "double_pendulum", "--floating", log, "--cutoff", "none", "--torque", "link", "--out", &out])
    };
    let found = run(&log);
    for (error, force) in [("consistent", "force"), ("least_squares", "force")] {
        let [error, force] = [error, force].map(|name| common::numbers(&found["fitted"][name]));
        // the base's six forces are 0, and are predicted as 0
        let largest = force.iter().fold(0.0_f64, |most, x| most.max(*x));
        assert!(error.iter().all(|e| *e < 2e-3 * largest), "{error:?} of {force:?}");
    }
    let entries = found["parameters"].as_array().expect("a list");
    let is_mass = |entry: &&serde_json::Value| entry["name"].as_str().is_some_and(|name| name.ends_with(".m"));
    let mass: f64 = entries.iter().filter(is_mass).map(|entry| entry["value"].as_f64().expect("a number")).sum();
    assert!((mass / truth.mass() - 1.0).abs() < 0.01, "{mass} kg instead of {}", truth.mass());
    // other formats hold the same columns
    if let Some(python) = python("numpy, pyarrow") {
        let script = "import sys, numpy, pyarrow, pyarrow.feather, csv\n\
                      rows = list(csv.reader(open(sys.argv[1])))\n\
                      names, data = rows[0], numpy.array(rows[1:], float)\n\
                      table = pyarrow.table(dict(zip(names, data.T)))\n\
                      pyarrow.feather.write_feather(table, sys.argv[2], compression='uncompressed')\n\
                      of = lambda g: data[:, [k for k, n in enumerate(names) if n.startswith(g + '_')]]\n\
                      tau = numpy.hstack([numpy.zeros((len(data), 6)), of('tau')])\n\
                      groups = {g: of(g) for g in ['theta', 'dtheta', 'ddtheta', 'wrench_tip']}\n\
                      numpy.savez(sys.argv[3], t=data[:, 0], tau=tau, **groups)\n";
        let [arrow, npz] = ["held.arrow", "held.npz"].map(|name| path(&folder, name));
        let output = Command::new(python).args(["-c", script, &log, &arrow, &npz]).output().expect("Python starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        for other in [arrow, npz] {
            assert_eq!(run(&other)["fitted"]["consistent"], found["fitted"]["consistent"], "{other}");
        }
    }
    // without the wrench the base's equations cannot hold, and the robot has no weight
    let rows = std::fs::read_to_string(&log).expect("rows");
    let cut = file(&folder, "cut.csv", &rows.replace("wrench_tip_f_z", "other_f_z"));
    let (_, why) = complaint(&["identify", "double_pendulum", "--floating", &cut]);
    assert!(why.contains("column wrench_tip_f_z is missing; the file has 5 of the 6"), "{why}");
    let toe = file(&folder, "toe.csv", &rows.replace("wrench_tip", "wrench_toe"));
    let (_, why) = complaint(&["identify", "double_pendulum", "--floating", &toe]);
    assert!(why.contains("`wrench_toe`"), "{why}");
}

/// Python with these modules.
fn python(modules: &str) -> Option<PathBuf> {
    let python = std::env::var_os("MOZZI_PYTHON").map(PathBuf::from);
    let found = python.filter(|python| {
        let probe = Command::new(python).args(["-c", &format!("import {modules}")]).output();
        probe.is_ok_and(|output| output.status.success())
    });
    if found.is_none() {
        println!("skipped: MOZZI_PYTHON has not all of {modules}");
    }
    found
}

#[test]
fn bags_of_rosbag2_are_read() {
    let Some(python) = python("sqlite3") else { return };
    let folder = folder("identify_bag");
    let robot = file(&folder, "robot.xml", MJCF);
    let way = motion(&folder, &robot);
    let rows = std::fs::read_to_string(&way).expect("rows");
    let (header, rest) = rows.split_once('\n').expect("a header");
    let named = header.replace("_1", "_joint1").replace("_2", "_joint2");
    std::fs::write(&way, format!("{named}\n{rest}")).expect("a file");
    let bag = path(&folder, "bag");
    std::fs::create_dir(&bag).expect("a folder");
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/logs/bag.py");
    let output = Command::new(python).args([script, &way, &bag]).output().expect("Python starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let error = |log: &str| {
        let found = json(&["identify", &robot, log]);
        found["left_out"]["nrms"].as_f64().expect("a number")
    };
    let (of_bag, of_csv) = (error(&bag), error(&way));
    // the bag has no accelerations
    assert!(of_bag < 0.01 && of_csv < 0.01, "{of_bag} and {of_csv}");
    let part = path(&folder, "bag/bag_0.db3");
    assert!(error(&part) < 0.02);
    // damaged files give errors, never a panic
    let sound = std::fs::read(&part).expect("bytes");
    let damaged = path(&folder, "damaged.db3");
    let mut random = mozzi::random::Random(1);
    for k in 0..60 {
        let mut bytes = sound.clone();
        match k % 3 {
            0 => bytes.truncate((0.5 * (random.next() + 1.0) * sound.len() as f64) as usize),
            _ => {
                for _ in 0..1 + 20 * (k % 3) {
                    let at = (0.5 * (random.next() + 1.0) * (sound.len() - 1) as f64) as usize;
                    bytes[at] = (random.next() * 128.0) as i8 as u8;
                }
            }
        }
        std::fs::write(&damaged, &bytes).expect("a file");
        let code = mozzi(&["identify", &robot, &damaged]).status.code();
        assert!(matches!(code, Some(0 | 1)), "{code:?} after damage {k}");
    }
    let mut bytes = sound.clone();
    bytes[100] = 7;
    std::fs::write(&damaged, &bytes).expect("a file");
    let (_, why) = complaint(&["identify", &robot, &damaged]);
    assert!(why.contains("damaged.db3") && why.contains("page 1 is no page of a table"), "{why}");
    std::fs::write(&damaged, "t,q1\n").expect("a file");
    let (_, why) = complaint(&["identify", &robot, &damaged]);
    assert!(why.contains("it is no SQLite file"), "{why}");
    std::fs::write(&damaged, &sound).expect("a file");
    std::fs::write(format!("{damaged}-wal"), "more").expect("a file");
    let (_, why) = complaint(&["identify", &robot, &damaged]);
    assert!(why.contains("wal_checkpoint"), "{why}");
    let empty = path(&folder, "empty");
    std::fs::create_dir(&empty).expect("a folder");
    let (_, why) = complaint(&["identify", &robot, &empty]);
    assert!(why.contains("is a folder without .db3 or .mcap"), "{why}");
}

#[test]
fn a_robot_of_too_many_parameters_is_refused_before_its_logs_are_read() {
    let mut robot = String::from("<robot name=\"fan\"><link name=\"base\"/>\n");
    for k in 0..800 {
        let _ = writeln!(
            robot,
            "<joint name=\"j{k}\" type=\"continuous\"><parent link=\"base\"/><child link=\"l{k}\"/></joint><link \
             name=\"l{k}\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" \
             iyz=\"0\"/></inertial></link>"
        );
    }
    let fan = file(&folder("fan"), "fan.urdf", &(robot + "</robot>"));
    for command in [&["identify", &fan, "no_such_log.csv"][..], &["excite", &fan]] {
        let (code, message) = complaint(command);
        assert_eq!(code, 1, "{message}");
        assert!(message.contains("the robot has 12000 parameters, and a matrix n × n takes"), "{message}");
    }
    // locked joints have none
    let mut locked = vec!["identify", &fan, "no_such_log.csv"];
    let locks: Vec<String> = (200..800).map(|k| format!("j{k}=0")).collect();
    locks.iter().for_each(|lock| locked.extend(["--lock", lock]));
    let (code, message) = complaint(&locked);
    assert!(code == 1 && message.contains("no_such_log.csv"), "{message}");
}
