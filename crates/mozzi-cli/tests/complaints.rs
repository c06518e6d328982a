//! Errors are reported in a sentence with the found and the expected value, and by the exit code.

use crate::common;

use common::{complaint, file, folder, mozzi};

/// Exit code 1, and a sentence with these words.
fn wrong(arguments: &[&str], words: &[&str]) {
    let (code, message) = complaint(arguments);
    assert_eq!(code, 1, "{arguments:?}: {message}");
    for word in words {
        assert!(message.contains(word), "{word} in {message}");
    }
    assert!(!message.contains("panicked"), "{message}");
}

#[test]
fn wrong_robots() {
    wrong(&["info", "ur6"], &["`ur6`", "ur5", "panda"]);
    let folder = folder("wrong_robots");
    let robot = file(&folder, "arm.urdf", "<robot name='arm'>\n<link name='a'><intertial/></link></robot>");
    wrong(&["info", &robot], &["arm.urdf", "intertial", "2:"]);
    wrong(&["check", &robot], &["arm.urdf", "intertial"]);
    for flags in [&["--json"][..], &["--format", "json"]] {
        let output = mozzi(&[&["check", &robot], flags].concat());
        assert_eq!(output.status.code(), Some(1));
        let lines = String::from_utf8(output.stdout).expect("text");
        let found: serde_json::Value = serde_json::from_str(lines.lines().next().expect("a line")).expect("JSON");
        let keys: Vec<&String> = found.as_object().expect("an object").keys().collect();
        assert_eq!(keys, ["severity", "code", "message", "file", "line", "column", "help"]);
        assert_eq!((&found["severity"], &found["line"], &found["column"]), (&"error".into(), &2.into(), &17.into()));
        assert_eq!(found["code"], "mozzi::urdf::misspelled_element");
    }
    let sarif = |robot: &str| -> (Option<i32>, serde_json::Value) {
        let output = mozzi(&["check", robot, "--format", "sarif"]);
        (output.status.code(), serde_json::from_slice(&output.stdout).expect("JSON"))
    };
    let (code, found) = sarif(&robot);
    let result = &found["runs"][0]["results"][0];
    assert_eq!((code, &found["version"], &result["level"]), (Some(1), &"2.1.0".into(), &"error".into()), "{found}");
    // the requirements of the schema of SARIF 2.1.0
    let driver = &found["runs"][0]["tool"]["driver"];
    assert!(driver["name"] == "mozzi" && driver["rules"][0]["id"].is_string(), "{driver}");
    assert!(result["message"]["text"].as_str().is_some_and(|text| text.contains("intertial")), "{result}");
    let place = &result["locations"][0]["physicalLocation"];
    assert_eq!((&place["region"]["startLine"], &place["region"]["startColumn"]), (&2.into(), &17.into()));
    assert!(place["artifactLocation"]["uri"].as_str().expect("a reference").ends_with("/arm.urdf"));
    assert_eq!(result["ruleId"], "mozzi::urdf::misspelled_element");
    assert_eq!(found["runs"][0]["tool"]["driver"]["rules"][0]["id"], result["ruleId"]);
    let (code, found) = sarif("ur5");
    assert_eq!((code, found["runs"][0]["results"].as_array().map(Vec::len)), (Some(0), Some(0)), "{found}");
    let (code, found) = sarif("nowhere.urdf");
    let place = &found["runs"][0]["results"][0]["locations"][0]["physicalLocation"];
    assert_eq!((code, &place["artifactLocation"]["uri"]), (Some(1), &"nowhere.urdf".into()), "{found}");
    assert!(place["region"].is_null());
    let nowhere = mozzi(&["check", "nowhere.urdf", "--json"]);
    let found: serde_json::Value = serde_json::from_slice(&nowhere.stdout).expect("one line of JSON");
    assert_eq!(
        (nowhere.status.code(), &found["file"], found["line"].is_null()),
        (Some(1), &"nowhere.urdf".into(), true)
    );
}

#[test]
fn xacro_is_refused_at_its_place() {
    let folder = folder("xacro");
    let text = "<robot name='arm' xmlns:xacro='http://www.ros.org/wiki/xacro'>\n<xacro:arm mass='1'/></robot>";
    let robot = file(&folder, "arm.xacro", text);
    for command in ["info", "check", "terms"] {
        wrong(&[command, &robot], &["the macro `arm` is not defined", "2:2"]);
    }
    let output = mozzi(&["check", &robot, "--json"]);
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one line of JSON");
    assert_eq!((&found["code"], &found["line"]), (&"mozzi::urdf::xacro".into(), &2.into()));
    let macros = "<robot name='arm' xmlns:xacro='http://www.ros.org/wiki/xacro'>\n<xacro:macro name='arm' params='m'>\n\
        <link name='a'><inertial><mass value='${m}'/></inertial></link></xacro:macro>\n<xacro:arm m='-1'/></robot>";
    let robot = file(&folder, "macro.xacro", macros);
    let output = mozzi(&["check", &robot, "--json"]);
    let lines = String::from_utf8_lossy(&output.stdout).into_owned();
    let line = lines.lines().find(|line| line.contains("mass")).expect("a line about the mass");
    let found: serde_json::Value = serde_json::from_str(line).expect("JSON");
    assert_eq!(found["line"], 3);
    assert!(found["calls"].as_str().is_some_and(|calls| calls.ends_with("macro.xacro:4 (m = -1)")), "{found}");
}

#[test]
fn policies_are_of_every_command() {
    let folder = folder("policies");
    let inertia = "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='3'/></inertial>";
    let joint = "<joint name='j' type='continuous'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint>";
    let text = format!("<robot name='odd'><link name='a'/><link name='b'>{inertia}</link>{joint}</robot>");
    let robot = file(&folder, "odd.urdf", &text);
    for command in ["check", "info", "terms", "compute"] {
        let said = |flag: &str| {
            let quantity = (command == "compute").then_some("inverse-dynamics");
            let output = mozzi(&[&[command, &robot], quantity.as_slice(), &[flag]].concat());
            (output.status.code(), String::from_utf8(output.stderr).expect("text"))
        };
        let (code, message) = said("--strict");
        assert!(code == Some(1) && message.contains("inertia"), "{command}: {message}");
        let (code, message) = said("--lenient");
        assert!(code == Some(0) && message.contains("replaced by the nearest"), "{command}: {message}");
    }
    assert_eq!(complaint(&["info", &robot, "--strict", "--lenient"]).0, 2);
    let repaired = common::json(&["info", &robot, "--lenient"]);
    assert_eq!(repaired["links"][1]["rotational_inertia"][0][0], 1.5);
}

#[test]
fn codes_are_explained() {
    let all = common::text(&["explain"]);
    assert!(all.contains("\n  zero_axis\n") && all.contains("\n  missing_limit\n"), "{all}");
    let page = common::text(&["explain", "zero_axis"]);
    assert!(page.starts_with("mozzi::urdf::zero_axis\n\n") && page.contains("length 0"), "{page}");
    assert!(
        page.contains("\nWhy it matters: A rotation about 0 0 0 is not defined") && page.contains("Severity: error\n")
    );
    let [bad, good] = ["Bad:", "Good:"].map(|start| page.find(&format!("\n{start}\n")).expect("both examples"));
    let at = |line: &str| page.find(&format!("\n    <axis xyz=\"{line}\"/>\n")).expect("a line of both files");
    assert!(bad < at("0 0 0") && at("0 0 0") < good && good < at("0 1 0"), "{page}");
    assert!(page[bad..good].contains("--> arm.urdf:14:16") && page[good..].contains("\nRemedy: the axis of a joint"));
    assert_eq!(common::text(&["explain", "mozzi::urdf::zero_axis"]), page);
    let shared = common::text(&["explain", "mozzi::sdf::unknown_link"]);
    assert!(shared.starts_with("mozzi::sdf::unknown_link\n\n") && shared.contains("link=\"bse\""), "{shared}");
    for code in all.lines().filter_map(|line| line.strip_prefix("  ")) {
        let page = common::text(&["explain", code]);
        let parts = ["\nWhy it matters: ", "\nSeverity: ", "\nBad:\n", "\nGood:\n", "\nRemedy: "];
        let places = parts.map(|part| page.find(part));
        assert!(places.is_sorted() && places[0].is_some(), "{page}");
    }
    let page = common::text(&["explain", "xacro"]).replace('\n', " ");
    assert!(page.contains("`mozzi xacro robot.xacro name:=value -o robot.urdf`"), "{page}");
    let page = common::text(&["explain", "lag"]).replace('\n', " ");
    assert!(page.starts_with("lag (`mozzi identify`)  The force of one joint comes later"), "{page}");
    assert!(all.contains("\nCodes of `mozzi identify`: acceleration, apparent,"), "{all}");
    assert!(common::text(&["explain", "not_finite"]).contains("In `mozzi identify`: Rows with NaN"));
    wrong(&["explain", "zero-axes"], &["`zero-axes` is not the code", "did you mean `zero_axis`?"]);
    wrong(&["explain", "mozzi::urdf::mising_limits"], &["did you mean `missing_limit`?"]);
    wrong(&["explain", "xyz"], &["`mozzi explain` lists them"]);
}

#[test]
fn what_is_odd_is_said_in_a_line_and_shown_by_check() {
    let folder = folder("odd_robots");
    let joint = "<joint name='j' type='revolute'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint>";
    let robot =
        file(&folder, "odd.urdf", &format!("<robot name='odd'><link name='a'/><link name='b'/>{joint}</robot>"));
    let output = mozzi(&["info", &robot, "--json"]);
    let said = String::from_utf8_lossy(&output.stderr).to_string();
    assert!(output.status.success() && said.contains("odd.urdf:1:") && said.contains("limit"), "{said}");
    let output = mozzi(&["check", &robot]);
    assert!(output.status.success() && String::from_utf8_lossy(&output.stderr).contains("2 warnings"), "{output:?}");
    assert_eq!(mozzi(&["check", &robot, "--strict"]).status.code(), Some(1));
    assert!(output.stderr.len() > said.len());
    wrong(&["compute", &robot, "forward-dynamics"], &["the mass matrix is singular at joint `j`"]);
    let output = mozzi(&["terms", &robot, "--json"]);
    let terms: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert!(terms["forward_dynamics"].is_null() && terms["inverse_dynamics"][0] == 0.0, "{terms}");
}

#[test]
fn what_changes_the_motion_is_always_said_and_looks_are_counted() {
    let folder = folder("motion_first");
    let bodies: String = (0..4)
        .map(|i| {
            format!(
                "<body><joint range='9 -9' axis='{} 0 1'/><inertial pos='0 0 0' mass='1' diaginertia='1 1 3'/>",
                i % 2
            )
        })
        .collect();
    let model = format!(
        "<mujoco><option density='1'/><worldbody><light/><geom size='1' rgba='1 0 0 1'/><body gravcomp='1'>\
         <joint damping='1 0 2' stiffness='1 0 2'/><geom size='1'/>{bodies}{}</body></worldbody></mujoco>",
        "</body>".repeat(4)
    );
    let model = file(&folder, "arm.xml", &model);
    let said = String::from_utf8_lossy(&mozzi(&["info", &model]).stderr).to_string();
    for force in ["damping: is `1 0 2`", "stiffness: is `1 0 2`", "gravcomp: is `1`", "density: is `1`"] {
        assert!(said.contains(force), "{force}: {said}");
    }
    assert_eq!(said.matches("warning: ").count(), 4 + 3, "{said}");
    assert!(said.contains("12 warnings in total"), "{said}");
    assert!(said.contains("note: 1 attribute and 1 element of looks and contact are not used"), "{said}");
    let lines = common::text(&["check", &model, "--json"]);
    let severities: Vec<bool> = lines.lines().map(|line| line.contains(r#""severity":"note""#)).collect();
    assert_eq!(severities, [vec![false; 12], vec![true; 2]].concat(), "{lines}");
}

#[test]
fn wrong_numbers() {
    wrong(&["terms", "ur5", "--theta", "1,2,3"], &["--theta has 3 entries, expected 6", "elbow_joint"]);
    wrong(&["terms", "ur5", "--theta", "0,0,abc,0,0,0"], &["--theta: entry 3 is `abc`, expected a number"]);
    wrong(&["terms", "ur5", "--dtheta", "0,0,0,NaN,0,0"], &["--dtheta: entry 4 is `NaN`, expected a finite number"]);
    wrong(&["terms", "ur5", "--theta", "0,0,,0,0,0"], &["--theta: entry 3 is ``, expected a number"]);
    wrong(&["terms", "ur5", "--gravity", "0,-9.81"], &["--gravity has 2 entries, expected 3: x, y, z"]);
    wrong(
        &["compute", "ur5", "inverse-dynamics", "--tip-wrench", "1"],
        &["--tip-wrench has 1 entry, expected 6", "m_x"],
    );
    wrong(&["simulate", "ur5", "--step", "-0.1"], &["step is -0.1", "positive"]);
    for time in ["2s", "2 s", "1.5e3ms"] {
        let expected = format!("--time is `{time}`, expected a number without its unit");
        wrong(&["simulate", "ur5", "--time", time], &[&expected]);
    }
    wrong(&["simulate", "ur5", "--time", "soon"], &["--time is `soon`, expected a number"]);
}

#[test]
fn wrong_frames_and_tasks() {
    wrong(&["terms", "anymal", "--tip-wrench", "0,0,0,0,0,1"], &["must be named", "LF_FOOT"]);
    wrong(&["terms", "ur5", "--end-effector", "hand"], &["no frame `hand`", "`tool0`"]);
    wrong(&["screws", "panda", "--python"], &["serial chains"]);
    wrong(&["screws", "panda", "--python", "--end-effector", "panda_hand_tcp"], &["serial chains"]);
    wrong(&["terms", "ur5", "--task", "vx,vw"], &["no row `vw`", "wx, wy, wz"]);
    // a singular task gives a note; all other terms are there
    let output = mozzi(&["terms", "ur5", "--task", "wx,vx", "--all"]);
    let (page, said) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success() && said.contains("note: Λ and η are omitted: the task is singular"), "{said}");
    assert!(page.contains("left out: the task is singular in this state") && page.contains("∂θ̈/∂τ = M⁻¹"), "{page}");
}

#[test]
fn a_cart_that_dry_friction_stops_is_no_stall() {
    let folder = folder("stuck");
    let slide = "<robot name='slide'><link name='rail'/><link name='cart'><inertial><mass value='2'/>\
        <inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>\
        <joint name='slope' type='prismatic'><parent link='rail'/><child link='cart'/><axis xyz='0.8 0 0.6'/>\
        <limit lower='-9' upper='9' effort='0' velocity='0'/><dynamics damping='0' friction='15'/></joint></robot>";
    let robot = file(&folder, "slide.urdf", slide);
    // the slope pulls with 2 · 9.81 · 0.6 = 11.8 N, friction with 15 N: v²/(2a) = 0.5²/(2 (15 − 11.772)/2) = 0.0775 m
    // down the slope, or up it 0.0093 m, and then it sticks; it made adaptive steps stall
    let start = ["simulate", &robot, "--dtheta", "0.5"];
    let found = mozzi(&start);
    let said = String::from_utf8_lossy(&found.stdout).into_owned();
    assert!(found.status.success() && said.contains("0.009338"), "{said}");
    assert!(mozzi(&[&start[..], &["--method", "dopri", "--slip-speed", "0.01"]].concat()).status.success());
}

#[test]
fn wrong_tables() {
    let folder = folder("wrong_tables");
    let table = |name: &str, text: &str| file(&folder, name, text);
    let with =
        |path: &str, words: &[&str]| wrong(&["compute", "two_link_planar", "inverse-dynamics", "--in", path], words);
    with("no/such/file.csv", &["no/such/file.csv cannot be read"]);
    with(&table("a.csv", "theta_1,theta_2\n0,0\n1,x\n"), &["a.csv:3: column 2 (`theta_2`) is `x`, expected a number"]);
    with(&table("b.csv", "theta_1,theta_2\n0,inf\n"), &["b.csv:2: column 2 (`theta_2`)", "finite"]);
    with(&table("c.csv", "theta_1,theta_2\n0,0\n0\n"), &["c.csv:3: 1 column, expected 2"]);
    with(&table("d.csv", "theta_1\n0\n"), &["d.csv:1: column theta_2 is missing"]);
    with(
        &table("e.csv", "theta_1,theta_2,dthetta_1\n0,0,0\n"),
        &["e.csv:1: column 3 is called `dthetta_1`", "dtheta_1"],
    );
    with(&table("f.csv", "theta_1,theta_2,theta_joint2\n0,0,0\n"), &["f.csv:1", "columns 2 and 3"]);
    with(&table("g.csv", "theta_1,theta_2\n"), &["g.csv has no rows"]);
    with(&table("h.csv", "t\n0\n"), &["h.csv has no columns theta_1 …"]);
    with(&table("i.csv", "theta_1,theta_3\n0,0\n"), &["i.csv:1: column 2 is called `theta_3`"]);
    let torque = table("j.csv", "t,tau_1,tau_2\n0,0,0\n0,1,1\n");
    wrong(&["simulate", "two_link_planar", "--torque", &torque], &["j.csv:3: t is 0 after 0"]);
    let states = table("k.csv", "theta_1,theta_2\n0,0\n");
    wrong(&["compute", "two_link_planar", "forward-dynamics", "--in", &states], &["k.csv has no columns tau_1 …"]);
    let nowhere = folder.join("none").join("x.csv");
    let nowhere = nowhere.to_str().expect("text");
    wrong(
        &["compute", "two_link_planar", "inverse-dynamics", "--in", &states, "--out", nowhere],
        &["cannot be written"],
    );
}

#[test]
fn flags_without_effect_are_wrong_usage() {
    let state = ["--theta", "0,0,0,0,0,0"];
    let way = ["--from", "0,0,0,0,0,0", "--to", "1,0,0,0,0,0"];
    for (command, others, flag, expected) in [
        ("compute", &["mass-matrix", "--theta", "0,0,0,0,0,0"][..], &["--out", "x.csv"][..], "--in"),
        ("compute", &["mass-matrix", "--theta", "0,0,0,0,0,0"], &["--precision", "f32"], "--in"),
        ("compute", &["mass-matrix", "--theta", "0,0,0,0,0,0"], &["--threads", "2"], "--in"),
        ("ik", &["--position", "0.3,0,0.3"], &["--out", "x.csv"], "--in"),
        ("identify", &["log.csv"], &["--payload", "tool0"], "--only payload"),
        ("trajectory", &way, &["--position", "0.3,0,0.3"], "--path screw or --path line"),
        ("trajectory", &way, &["--ramp-fraction", "0.1", "--profile", "cubic"], "--profile trapezoidal"),
        ("simulate", &state, &["--restitution", "0.5"], "--ground or --contacts"),
        ("simulate", &state, &["--tolerance", "1e-6", "--method", "rk4"], "--method dopri"),
        ("simulate", &state, &["--extrapolate", "hold"], "--torque or --tip-wrench"),
        ("simulate", &state, &["--page-rows", "9"], "--report"),
    ] {
        let (code, message) = complaint(&[&[command, "ur5"], others, flag].concat());
        let expected = format!("error: {} has no effect without {expected}\n", flag[0]);
        assert!(code == 2 && message.starts_with(&expected) && message.contains("Usage: mozzi"), "{message}");
    }
}

#[test]
fn wrong_usage_is_told_apart() {
    for arguments in [
        &["inform", "ur5"][..],
        &["terms"],
        &["simulate", "ur5", "--method", "verlet"],
        &["terms", "ur5", "--tau", "0", "--ddtheta", "0"],
        &["compute", "ur5"],
        &["compute", "ur5", "inverse-dynamics", "--in", "a.csv", "--theta", "0"],
        &["compute", "ur5", "inverse-dynamics", "--out", "a.csv"],
        &["compute", "ur5", "inverse-dynamics", "--precision", "f32"],
    ] {
        let (code, message) = complaint(arguments);
        assert_eq!(code, 2, "{arguments:?}: {message}");
    }
}
