//! Wrong inputs are named, read once, bounded; no file that was read is overwritten.

use super::common::{self, complaint, file, folder, json, numbers, rows, text};
use std::io::Write;
use std::process::{Command, Stdio};

const ARM: &str = r#"<robot name="arm"><link name="base"/><link name="rod"><inertial><mass value="2"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="hinge" type="revolute">
<parent link="base"/><child link="rod"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="9" velocity="3"/></joint>
</robot>"#;

/// A servo of 300 N m/rad with the weight of its arm, in MJCF.
const SERVO: &str = r#"<mujoco model="servo"><worldbody><body name="arm"><joint name="j" axis="0 1 0" damping="0.5"/>
<inertial pos="0.3 0 0" mass="1" diaginertia="0.01 0.02 0.02"/></body></worldbody>
<actuator><position joint="j" kp="300" kv="20"/></actuator>
<keyframe><key name="up" qpos="-0.7" ctrl="-0.7"/></keyframe></mujoco>"#;

#[test]
fn actuators_of_mjcf_hold_their_pose_unless_they_are_left_out() {
    let robot = file(&folder("servo"), "servo.xml", SERVO);
    let flags = ["simulate", &robot, "--state", "up", "--time", "1"];
    let end = |more: &[&str]| rows(&json(&[&flags[..], more].concat())["theta"]).pop().expect("rows")[0];
    let sag = 9.81 * 0.3 * f64::cos(0.7) / 300.0;
    for more in [&[][..], &["--torque", "actuators"]] {
        assert!((end(more) - (-0.7 + sag)).abs() < 1e-3, "{more:?}: {}", end(more));
    }
    assert!(end(&["--torque", "zero"]) > 0.5, "it falls");
    let said = String::from_utf8(common::mozzi(&flags).stderr).expect("text");
    assert!(said.contains("actuators (1) drive the robot with the controls of state `up`"), "{said}");
    let (_, said) = complaint(&["simulate", "ur5", "--torque", "actuators"]);
    assert!(said.contains("ur5 has no actuators that are computed, expected MJCF with <actuator>"), "{said}");
}

#[test]
fn standard_output_has_rows_or_json() {
    for command in [
        &["simulate", "double_pendulum"][..],
        &["trajectory", "double_pendulum", "--to", "1,1"],
        &["excite", "double_pendulum"],
        &["ik", "ur5", "--in", "goals.csv"],
    ] {
        let (code, said) = complaint(&[command, &["--out", "-", "--json"]].concat());
        assert!(code == 1 && said.contains("--json and --out - both write to standard output"), "{said}");
    }
    for (flag, value) in [("--rate", "0"), ("--rate", "-5"), ("--apart", "tip,link1=-1,0.1"), ("--duration", "2rad")] {
        let (code, said) = complaint(&["excite", "double_pendulum", &format!("{flag}={value}")]);
        assert!(code == 1 && said.lines().count() == 1, "{flag}: {said}");
    }
}

#[test]
fn velocities_of_via_points_are_met() {
    let folder = folder("via_velocities");
    let via =
        file(&folder, "via.csv", "t,theta_1,theta_2,dtheta_1,dtheta_2\n1,0,0,0.5,0\n2,0.3,0.1,0.4,0\n4,1,0,0,-1\n");
    let found = json(&["trajectory", "double_pendulum", "--via", &via, "--step", "1"]);
    assert_eq!(numbers(&found["t"]), [0.0, 1.0, 2.0, 3.0]);
    let dtheta = rows(&found["dtheta"]);
    common::assert_close(&[dtheta[0][0], dtheta[1][0], dtheta[3][1]], &[0.5, 0.4, -1.0], 1e-12);
    let (_, said) = complaint(&["trajectory", "double_pendulum", "--via", &via, "--time", "5"]);
    assert!(said.contains("has velocities at times over 3 s"), "{said}");
    let untimed = file(&folder, "untimed.csv", "theta_1,theta_2,dtheta_1,dtheta_2\n0,0,1,0\n0.3,0.1,1,0\n");
    let output = common::mozzi(&["trajectory", "double_pendulum", "--via", &untimed, "--time", "2"]);
    let said = String::from_utf8(output.stderr).expect("text");
    assert!(output.status.success() && said.contains("dtheta_… have no effect without a column t"), "{said}");
}

#[test]
fn limits_of_acceleration_in_a_urdf_bound_a_motion() {
    let text = ARM
        .replace("name=\"arm\"", "name=\"arm\" version=\"1.2\"")
        .replace("velocity=\"3\"", "velocity=\"30\" acceleration=\"4\"");
    let robot = file(&folder("accelerations"), "arm.urdf", &text);
    for profile in ["fastest", "quintic", "trapezoidal", "cubic"] {
        let found = json(&["trajectory", &robot, "--from", "-1", "--to", "1", "--profile", profile]);
        let most = rows(&found["ddtheta"]).iter().map(|row| row[0].abs()).fold(0.0, f64::max);
        assert!(most <= 4.0 * (1.0 + 1e-6) && most > 3.9, "{profile}: {most}");
        assert_eq!(found["beyond"].as_array().map(Vec::len), Some(0));
    }
}

#[test]
fn a_robot_of_standard_input_is_converted_and_read_once() {
    let folder = folder("convert_input");
    let out = folder.join("out.urdf").to_str().expect("text").to_string();
    let mut command = Command::new(env!("CARGO_BIN_EXE_mozzi"));
    command.args(["convert", "-", &out]).stdin(Stdio::piped()).stdout(Stdio::null());
    let mut child = command.spawn().expect("the program runs");
    child.stdin.take().expect("a pipe").write_all(ARM.as_bytes()).expect("written");
    assert!(child.wait().expect("an end").success());
    assert_eq!(std::fs::read_to_string(&out).expect("a file"), ARM);
}

#[test]
#[cfg(unix)]
fn pipes_are_read_once_and_never_where_a_file_names_them() {
    let folder = folder("pipes");
    let arm = file(&folder, "arm.urdf", ARM);
    let out = folder.join("out.urdf").to_str().expect("text").to_string();
    let script = format!("exec {} convert <(cat {arm}) {out}", env!("CARGO_BIN_EXE_mozzi"));
    assert!(Command::new("bash").args(["-c", &script]).stdout(Stdio::null()).status().expect("bash").success());
    assert_eq!(std::fs::read_to_string(&out).expect("a file"), ARM);
    // a pipe that nobody writes to would hang
    let pipe = folder.join("pipe.urdf");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo").success());
    let controller =
        format!(r#"{{"controller": "pd-gravity", "p": 1, "d": 1, "model": {:?}}}"#, pipe.display().to_string());
    let controller = file(&folder, "c.json", &controller);
    let (_, said) = complaint(&["simulate", &arm, "--controller", &controller]);
    assert!(said.contains("expected a regular file, or an embedded robot"), "{said}");
    let mesh = ARM.replace(
        "</link><joint",
        "<collision><geometry><mesh filename=\"pipe.stl\"/></geometry></collision></link><joint",
    );
    let arm = file(&folder, "mesh.urdf", &mesh);
    assert!(Command::new("mkfifo").arg(folder.join("pipe.stl")).status().expect("mkfifo").success());
    let output = common::mozzi(&["simulate", &arm, "--ground", "--time", "0.01"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("pipe.stl"), "{output:?}");
    let included =
        r#"<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="pipe.urdf"/></robot>"#;
    let xacro = file(&folder, "r.urdf.xacro", included);
    let (_, said) = complaint(&["info", &xacro]);
    assert!(said.contains("it is not a regular file"), "{said}");
}

#[test]
fn errors_of_a_controllers_model_show_no_words_of_its_file() {
    let folder = folder("secret_model");
    let secret = file(&folder, "secret.txt", "password=hunter2\n");
    let controller = format!(r#"{{"controller": "computed-torque", "p": 1, "d": 1, "model": {secret:?}}}"#);
    let (_, said) = complaint(&["simulate", "ur5", "--controller", &file(&folder, "c.json", &controller)]);
    assert!(said.contains("secret.txt is refused: 1 error, first mozzi::urdf::syntax in line 1"), "{said}");
    assert!(!said.contains("hunter2"), "{said}");
    let typo = r#"{"controller": "computed-torqe", "p": 1, "d": 1}"#;
    let (_, said) = complaint(&["simulate", "ur5", "--controller", &file(&folder, "typo.json", typo)]);
    assert!(
        said.contains("typo.json:1:2: controller is \"computed-torqe\"")
            && said.contains("did you mean `computed-torque`"),
        "{said}"
    );
    let listed = r#"{"controller": "pd-gravity", "p": [1, 2], "d": 1}"#;
    let (_, said) = complaint(&["simulate", "ur5", "--controller", &file(&folder, "list.json", listed)]);
    assert!(said.contains("list.json:1:30: p is [1,2], expected a number, or a list of 6"), "{said}");
}

#[test]
fn what_a_file_includes_is_not_overwritten() {
    let folder = folder("kept");
    let part =
        file(&folder, "part.xacro", r#"<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="a"/></robot>"#);
    let whole =
        r#"<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="part.xacro"/></robot>"#;
    let whole = file(&folder, "whole.urdf.xacro", whole);
    let before = std::fs::read_to_string(&part).expect("a file");
    let (code, said) = complaint(&["xacro", &whole, "-o", &part]);
    assert!(code == 1 && said.contains("was read by this command and would be lost"), "{said}");
    let closing = file(&folder, "closing.json", r#"{"constraints": []}"#);
    let (_, said) = complaint(&["convert", "ur5", &closing, "--constraints", &closing]);
    assert!(said.contains("OUT is the file --constraints"), "{said}");
    assert_eq!(std::fs::read_to_string(&part).expect("a file"), before);
    let log = file(&folder, "log.csv", "t,theta_1,theta_2\n0,0,0\n1,0.1,0\n");
    let (_, said) = complaint(&["view", "double_pendulum", &log, "--out", &log]);
    assert!(said.contains("is a page, expected a name that ends in .html"), "{said}");
    assert!(text(&["view", "double_pendulum", &log, "--out", &format!("{log}.html")]).contains("written to"));
}

#[test]
fn contradictory_flags_are_refused() {
    let arm = file(&folder("flags"), "arm.urdf", &ARM.replace("</robot>", "<link name=\"tip\"/><joint name=\"glue\" type=\"fixed\"><parent link=\"rod\"/><child link=\"tip\"/></joint></robot>"));
    let out = folder("flags_out").join("out.json").to_str().expect("text").to_string();
    for (flags, expected) in [
        (&["--lock", "hinge=0", "--lock", "hinge=1"][..], "--lock hinge is given twice"),
        (&["--lock", "glue=1"], "`glue`, a fixed joint, expected a joint of one axis, which moves"),
        (&["--payload", "rod=1,2,3,4,5,6,7,8,9,10,11,12"], "has 12 entries"),
    ] {
        let (_, said) = complaint(&[&["convert", &arm, &out], flags].concat());
        assert!(said.contains(expected), "{flags:?}: {said}");
    }
    let log = file(&folder("flags_log"), "log.csv", "t,theta_1,tau_1\n0,0,0\n");
    for (flags, expected) in [
        (&["--total-mass", "2,-1"][..], "the total mass is 2 kg with a deviation of -1 kg, expected two positive"),
        (&["--total-mass", "2,0"], "expected two positive"),
        (&["--center-in", "rod=0,0,0.5,1,1,0"], "--center-in rod goes from 0.5 to 0 in z"),
        (&["--between", "mass of rod=2,1"], "is 2 to 1, expected the lower first"),
        (&["--known-payload", "1:rod=1,2,3,4,5,6,7,8,9,10,11,12"], "has 12 entries"),
        (&["--cutoff", "-1"], "1 usable rows"),
    ] {
        let (code, said) = complaint(&[&["identify", &arm, &log], flags].concat());
        assert!(code == 1 && (said.contains(expected) || flags[0] == "--known-payload"), "{flags:?}: {said}");
        assert!(!said.contains("'-- -1'"), "{said}");
    }
    let still = ARM.replace("lower=\"-2\" upper=\"2\"", "lower=\"0\" upper=\"0\"");
    let still = file(&folder("flags_still"), "still.urdf", &still);
    let said = String::from_utf8(common::mozzi(&["excite", &still, "--duration", "2"]).stderr).expect("text");
    assert!(said.contains("joint `hinge` has a range of 0 and does not move"), "{said}");
    let (_, said) = complaint(&["excite", &arm, "--within", "rod=0,0,0,1,-1,1"]);
    assert!(said.contains("--within rod goes from 0 to -1 in y"), "{said}");
}

/// A file with links that turn one on the other.
fn chain(folder: &std::path::Path, links: usize) -> String {
    let mut chain = String::from("<robot name='chain'><link name='l0'/>");
    for k in 1..=links {
        chain += &format!(
            "<link name='l{k}'><inertial><mass value='1'/><inertia ixx='0.1' iyy='0.1' izz='0.1' ixy='0' ixz='0' iyz='0'/></inertial></link><joint name='j{k}' type='continuous'><parent link='l{}'/><child link='l{k}'/></joint>",
            k - 1
        );
    }
    file(folder, &format!("chain{links}.urdf"), &(chain + "</robot>"))
}

#[test]
fn a_robot_whose_matrices_do_not_fit_is_refused_before_the_work() {
    let robot = chain(&folder("chain"), 12_000);
    for flags in [&["simulate", &*robot, "--time", "0.001"][..], &["compute", &*robot, "mass-matrix"]] {
        let (code, said) = complaint(flags);
        assert!(
            code == 1 && said.contains("the robot has 12000 velocities, and a matrix n × n takes 1.2 GB"),
            "{said}"
        );
    }
}

#[test]
fn a_long_chain_is_refused_where_it_would_take_minutes() {
    let folder = folder("long_chain");
    let robot = chain(&folder, 2100);
    let [xml, sdf, svg] = ["c.xml", "c.sdf", "c.svg"].map(|name| folder.join(name).to_str().expect("text").to_string());
    for (words, expected) in [
        (&["convert", &*robot, &*xml][..], "2101 bodies inside each other, expected at most 253"),
        (&["terms", &*robot], "the robot has 2100 velocities, expected at most 1000 for all terms"),
        (&["derive", &*robot, "g"], "the robot has 2100 moving links, expected at most 1000"),
        (
            &["compare", &*robot, &*robot],
            "the robot has 2100 velocities, expected at most 2000 of one that is compared",
        ),
        (&["picture", &*robot, "--out", &*svg], "the number of links is 2101, expected at most 2000 in a picture"),
        (&["bench", &*robot, "--states", "100000"], "expected at most 9 states"),
    ] {
        let (code, said) = complaint(words);
        assert!(code == 1 && said.contains(expected), "{words:?}: {said}");
    }
    assert!(common::mozzi(&["convert", &robot, &sdf]).status.success());
}

#[test]
fn pages_contain_nothing_of_this_machine_unless_it_is_allowed() {
    let (folder, elsewhere) = (folder("host"), folder("host_elsewhere"));
    let secret = file(&elsewhere, "secret.yaml", "length: 0.25\n");
    let page = folder.join("page.html").to_str().expect("text").to_string();
    let robot = |name: &str, inside: &str| {
        let start = r#"<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="a"/>"#;
        file(&folder, name, &format!("{start}{inside}</robot>"))
    };
    let variable = robot(
        "env.urdf.xacro",
        r#"<link name="$(env HOME)"/><joint name="j" type="fixed"><parent link="a"/><child link="$(env HOME)"/></joint>"#,
    );
    let yaml = format!(
        r#"<xacro:property name="p" value="${{xacro.load_yaml('{secret}')}}"/><material name="m${{p['length']}}"/>"#
    );
    let yaml = robot("yaml.urdf.xacro", &yaml);
    for (robot, expected) in [(&variable, "the environment variable `HOME`"), (&yaml, "secret.yaml")] {
        for command in ["view", "play"] {
            let (code, said) = complaint(&[command, robot, "--out", &page]);
            assert!(code == 1 && said.contains(expected) && said.contains("--allow-host allows it"), "{said}");
        }
    }
    text(&["view", &yaml, "--out", &page, "--allow-host"]);
    // files of the robot's own folder, and of packages
    let beside = robot(
        "beside.urdf.xacro",
        r#"<xacro:property name="p" value="${xacro.load_yaml('own.yaml')}"/><material name="m${p['length']}"/>"#,
    );
    file(&folder, "own.yaml", "length: 0.25\n");
    text(&["view", &beside, "--out", &page]);
    file(&elsewhere, "package.xml", "<package><name>elsewhere</name></package>");
    text(&["view", &yaml, "--out", &page]);
}

#[test]
fn many_rows_of_constraints_are_announced_with_their_cost() {
    let folder = folder("rows");
    let arm = file(&folder, "arm.urdf", ARM);
    let weld =
        |k: usize| format!(r#"{{"name": "w{k}", "kind": "weld", "a": {{"frame": null}}, "b": {{"frame": "rod"}}}}"#);
    let welds = (0..40).map(weld).collect::<Vec<_>>().join(", ");
    let welds = file(&folder, "welds.json", &format!("{{\"constraints\": [{welds}]}}"));
    let output = common::mozzi(&["simulate", &arm, "--constraints", &welds, "--time", "0.001"]);
    let said = String::from_utf8(output.stderr).expect("text");
    assert!(said.contains("the robot has 240 rows of constraints: a step takes about 1.4e-2 s"), "{said}");
}
