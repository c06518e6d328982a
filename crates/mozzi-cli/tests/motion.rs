//! `mozzi trajectory`, and `mozzi simulate` with its tables: controllers, methods, limits, Ctrl-C.

use crate::common;

use common::{assert_close, complaint, file, folder, json, numbers, rows, text};

const WAY: [&str; 6] = ["trajectory", "ur5", "--from", "0,-1.2,1.5,0.3,1.1,0", "--to", "0.8,-0.8,1,0,0.6,0.5"];

#[test]
fn a_motion_is_made_and_followed() {
    let folder = folder("follow");
    let way = folder.join("way.csv");
    let way = way.to_str().expect("text");
    let flags = ["--profile", "fastest", "--max-acceleration", "10", "--out", way];
    assert!(text(&[&WAY[..], &flags].concat()).contains("rows written"));
    let found = json(&[&WAY[..], &["--profile", "quintic", "--time", "0.5"]].concat());
    let (theta, dtheta) = (rows(&found["theta"]), rows(&found["dtheta"]));
    assert_close(&theta[0], &[0.0, -1.2, 1.5, 0.3, 1.1, 0.0], 0.0);
    assert_close(&theta[25], &[0.4, -1.0, 1.25, 0.15, 0.85, 0.25], 1e-12); // halfway in time, and in space
    assert_close(&dtheta[25], &[1.875 * 1.6, 1.875 * 0.8, -1.875, -1.875 * 0.6, -1.875, 1.875], 1e-12);
    // each controller follows it; a controller with another robot's model is off
    let follow = |json_text: &str, more: &[&str]| {
        let controller = file(&folder, "controller.json", json_text);
        json(&[&["simulate", "ur5", "--follow", way, "--controller", &controller][..], more].concat())
    };
    let worst =
        |found: &serde_json::Value| numbers(&found["tracking_error"]["largest"]).into_iter().fold(0.0, f64::max);
    let computed = follow(r#"{"controller": "computed-torque", "p": 100, "d": 20}"#, &[]);
    assert!(worst(&computed) < 1e-4 && computed["effort_limits"].as_array().expect("a list").is_empty());
    assert_eq!(computed["complete"], true);
    let task = r#"{"controller": "task-space", "frame": "tool0", "p": 100, "d": 20, "posture_p": 25, "posture_d": 10}"#;
    assert!(worst(&follow(task, &[])) < 1e-2);
    let lagging = follow(r#"{"controller": "pd-gravity", "p": [900, 900, 900, 90, 90, 90], "d": 20}"#, &[]);
    assert!(worst(&lagging) > 1e-2 && worst(&lagging) < 0.5);
    let urdf =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../mozzi-urdf/models/ur5.urdf")).expect("there");
    assert!(urdf.contains("8.393"));
    let name = file(&folder, "other.urdf", &urdf.replace("8.393", "6.0")).replace('\\', "/");
    let wrong = follow(&format!(r#"{{"controller": "computed-torque", "p": 100, "d": 20, "model": "{name}"}}"#), &[]);
    assert!(worst(&wrong) > 1e-3, "{}", worst(&wrong));
    // a motor that is too weak is reported, and limited
    let strong = r#"{"controller": "pd-gravity", "p": [3000, 3000, 3000, 50, 50, 50], "d": [200, 200, 200, 2, 2, 2]}"#;
    for (policy, held) in [("report", false), ("respect", true)] {
        let found =
            follow(strong, &["--effort-limits", policy, "--theta", "0.3,-1.2,1.5,0.3,1.1,0", "--step", "0.0005"]);
        let asked = &found["effort_limits"][0];
        assert_eq!((&asked["joint"], &asked["limit"]), (&"shoulder_pan_joint".into(), &150.0.into()));
        let most = rows(&found["tau"]).iter().fold(0.0_f64, |m, tau| m.max(tau[0].abs()));
        assert_eq!(most <= 150.0, held, "{most}");
    }
}

#[test]
fn joints_are_followed_while_the_base_falls() {
    let folder = folder("follow_free");
    let (way, fall) = (folder.join("way.csv"), folder.join("fall.csv"));
    let (way, fall) = (way.to_str().expect("text"), fall.to_str().expect("text"));
    text(&[&WAY[..], &["--time", "0.2", "--out", way]].concat());
    let pd = file(
        &folder,
        "pd.json",
        r#"{"controller": "pd-gravity", "p": [900, 900, 900, 60, 60, 20], "d": [20, 20, 20, 1, 1, 0.1]}"#,
    );
    let follow = |table: &str| {
        let flags = [
            "simulate",
            "ur5",
            "--floating",
            "--method",
            "dopri",
            "--tolerance",
            "1e-6",
            "--step",
            "0.01",
            "--follow",
            table,
            "--controller",
            &pd,
        ];
        text(&[&flags[..], &["--out", fall]].concat()); // a table with the base
        json(&flags)
    };
    // the table with the base is followed as well as that of the joints alone
    let found = follow(way);
    let before = file(&folder, "before.csv", &std::fs::read_to_string(fall).expect("a table"));
    let again = follow(&before);
    for found in [&found, &again] {
        let worst = numbers(&found["tracking_error"]["largest"]);
        assert!(worst.len() == 6 && worst.iter().all(|&e| e < 0.5), "{worst:?}");
        let start = &rows(&found["theta"])[0];
        assert_close(start, &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.2, 1.5, 0.3, 1.1, 0.0], 0.0);
        // whatever the motors do, the centre of mass falls by ½gt²
        let model = mozzi_urdf::open("ur5").expect("embedded").build().expect("sound");
        let mass: f64 = model.description().links.iter().map(|link| link.inertia.mass).sum();
        let energy = numbers(&found["potential_energy"]);
        let (fallen, expected) = (energy[0] - energy[energy.len() - 1], mass * 9.81 * 0.5 * 9.81 * 0.2 * 0.2);
        assert!((fallen / expected - 1.0).abs() < 1e-4, "{fallen} {expected}");
    }
    let computed = file(&folder, "ct.json", r#"{"controller": "computed-torque", "p": 100, "d": 20}"#);
    let (_, said) = complaint(&["simulate", "ur5", "--floating", "--follow", way, "--controller", &computed]);
    assert!(
        said.contains("joints are followed; nothing drives the base, which begins where the robot starts"),
        "{said}"
    );
    assert!(said.contains("a robot under computed torque is on a free base, expected a fixed base"), "{said}");
}

#[test]
fn ways_of_the_end_effector_and_through_points() {
    let start = ["trajectory", "ur5", "--from", "0,-1.2,1.5,0.3,1.1,0"];
    let line =
        json(&[&start[..], &["--path", "line", "--position", "0.5,0.1,0.5", "--time", "1", "--step", "0.5"]].concat());
    let pose = |theta: &[f64]| {
        let list: Vec<String> = theta.iter().map(|x| format!("{x:?}")).collect();
        rows(&json(&["terms", "ur5", &format!("--theta={}", list.join(","))])["forward_kinematics"])
    };
    let T: Vec<Vec<Vec<f64>>> = rows(&line["theta"]).iter().map(|theta| pose(theta)).collect();
    for k in 0..3 {
        assert!((T[1][k][3] - 0.5 * (T[0][k][3] + T[2][k][3])).abs() < 1e-5);
        assert_close(&T[1][k][..3], &T[0][k][..3], 1e-5);
    }
    assert!((T[2][0][3] - 0.5).abs() < 1e-5);
    let folder = folder("via");
    let points =
        "theta_1,theta_2,theta_3,theta_4,theta_5,theta_6\n0,-1.5,1.5,0,0.5,0\n0.5,-1,0.8,0.5,1,0.7\n1,-0.6,0.4,0,0,0\n";
    let via = file(&folder, "via.csv", points);
    let page = text(&["trajectory", "ur5", "--via", &via, "--profile", "trapezoidal"]);
    assert!(page.contains("% of its limit"), "{page}");
    let timed = file(
        &folder,
        "timed.csv",
        &points
            .replace("theta_1,", "t,theta_1,")
            .replace("\n0,", "\n0,0,")
            .replace("\n0.5,", "\n0.4,0.5,")
            .replace("\n1,", "\n1,1,"),
    );
    let found = json(&["trajectory", "ur5", "--via", &timed, "--step", "0.2"]);
    assert_close(&rows(&found["theta"])[2], &[0.5, -1.0, 0.8, 0.5, 1.0, 0.7], 1e-12);
    assert_close(&rows(&found["dtheta"])[5], &[0.0; 6], 1e-12);
}

/// The largest values do not depend on the rows that are written; steps are kept, and the last row is the end.
#[test]
fn limits_are_judged_between_the_rows() {
    let to = ["trajectory", "ur5", "--to", "1,-1,1,0,0.5,0"];
    let with = |more: &[&str]| common::mozzi(&[&to[..], more].concat());
    for step in ["0.01", "0.3", "1e9"] {
        let output = with(&["--time", "0.3", "--step", step]);
        let (page, said) = (String::from_utf8(output.stdout), String::from_utf8(output.stderr));
        let (page, said) = (page.expect("text"), said.expect("text"));
        assert!(page.contains("largest velocity: 6.25 rad/s, 1") && page.contains("182"), "{step}: {page}");
        assert!(said.contains("velocity limit: `shoulder_pan_joint` reaches 6.25, beyond its limit 3.14"), "{said}");
    }
    let found = json(&[&to[..], &["--step", "0.008", "--time", "0.5"]].concat());
    let t = numbers(&found["t"]);
    assert_eq!((t.len(), t[1], t[62], t[63]), (64, 0.008, 62.0 * 0.008, 0.5));
    assert_close(&rows(&found["dtheta"])[63], &[0.0; 6], 1e-12);
    // joints that are not named stay where they are
    let from = ["--from", "1,1,1,1,1,1", "--to", "shoulder_pan_joint=90deg", "--time", "2"];
    let found = rows(&json(&[&["trajectory", "ur5"], &from[..]].concat())["theta"]);
    assert_close(&found[found.len() - 1], &[std::f64::consts::FRAC_PI_2, 1.0, 1.0, 1.0, 1.0, 1.0], 1e-12);
}

#[test]
fn doubtful_motions_are_questioned() {
    let folder = folder("doubtful");
    let said = |arguments: &[&str]| String::from_utf8(common::mozzi(arguments).stderr).expect("text");
    let via = file(&folder, "via.csv", "t,theta_1,theta_2\n5,0,0\n6,1,1\n8,2,0\n");
    let told = said(&["trajectory", "two_link_planar", "--via", &via, "--time", "5", "--deg"]);
    for words in ["begins at t = 5 s, the motion at 0", "--time makes the 3 s of", "is read in radians"] {
        assert!(told.contains(words), "{told}");
    }
    let told = said(&[&WAY[..], &["--max-velocity", "180", "--max-acceleration", "inf"]].concat());
    assert!(told.contains("--max-velocity is 180 for `shoulder_pan_joint`, above the limit 3.14"), "{told}");
    let some = ["--max-velocity", "elbow_joint=0.5", "--max-acceleration", "1"];
    let dtheta = rows(&json(&[&WAY[..], &some].concat())["dtheta"]);
    let largest = |j: usize| dtheta.iter().map(|row| row[j].abs()).fold(0.0, f64::max);
    assert!(largest(2) <= 0.5 + 1e-9 && largest(0) > 0.5, "{} {}", largest(2), largest(0));
    let (_, why) = complaint(&[&WAY[..], &["--max-velocity", "elbow=0.5"]].concat());
    assert!(why.contains("--max-velocity: there is no joint `elbow`") && why.contains("elbow_joint"), "{why}");
    let told = said(&["compute", "ur5", "g", "--lock", "elbow_joint=90", "--payload", "5,100,0,0"]);
    assert!(told.contains("--lock elbow_joint is in radians, and 90 rad are 14.3 turns"), "{told}");
    assert!(told.contains("has its centre of mass 100.00 m away"), "{told}");
    let goals = file(&folder, "goals.csv", "x,y,z,roll,pitch,yaw\n0.5,0.2,0.4,180,0,0\n");
    let told = said(&["ik", "ur5", "--in", &goals, "--deg"]);
    assert!(told.contains("is read in radians"), "{told}");
    let (_, why) = complaint(&["trajectory", "two_link_planar", "--to", "1e300,1", "--time", "1"]);
    assert!(why.contains("at t = ") && why.contains("is not a finite number"), "{why}");
    let (_, why) = complaint(&[&WAY[..], &["--out", "o.json"]].concat());
    assert!(why.contains("o.json: only CSV is written here"), "{why}");
    let line = ["trajectory", "ur5", "--to", "1,-1,1,0,0.5,0", "--path", "line", "--time", "3"];
    let (_, why) = complaint(&line);
    assert!(why.contains("a singular position, a joint's limit or the arm's reach"), "{why}");
}

#[test]
fn methods_and_limits() {
    let swing = ["simulate", "double_pendulum", "--theta", "2,1", "--time", "1"];
    let end = |method: &str| {
        let found = json(&[&swing[..], &["--method", method]].concat());
        assert!(found["largest_drift"].as_f64().expect("a number") < if method == "midpoint" { 1e-3 } else { 1e-6 });
        rows(&found["theta"]).pop().expect("a row")
    };
    let rk4 = end("rk4");
    assert_close(&end("dopri"), &rk4, 1e-7);
    assert_close(&end("midpoint"), &rk4, 1e-4);
    // the slide of a Panda's finger falls onto its stop
    let start = "--theta=0,0,0,-1.5,0,1.5,0,0.02";
    for (policy, word) in [("report", "beyond"), ("respect", "came to rest")] {
        let flags = ["simulate", "panda", start, "--time", "0.8", "--step", "0.002", "--joint-limits", policy];
        let page = text(&flags);
        assert!(page.contains("joint limit: `panda_") && page.contains(word), "{page}");
    }
    let flags = ["simulate", "panda", start, "--time", "0.8", "--step", "0.002", "--joint-limits", "ignore"];
    assert!(!text(&flags).contains("joint limit"));
}

/// A rod on a ball that turns by 0.7 rad at most, in a file.
fn cone(name: &str) -> String {
    let robot = "<mujoco><compiler angle='radian'/><worldbody><body name='rod'>\
                 <joint name='pivot' type='ball' range='0 0.7'/>\
                 <geom type='capsule' fromto='0 0 0 0 0 -0.8' size='0.05' mass='2'/></body></worldbody></mujoco>";
    file(&folder(name), "cone.xml", robot)
}

#[test]
fn a_ball_comes_to_rest_at_its_limit() {
    let robot = cone("cone_limits");
    let angle = |q: &[f64]| 2.0 * q[1].hypot(q[2]).hypot(q[3]).atan2(q[0].abs());
    for (policy, word) in [("report", "beyond"), ("respect", "came to rest")] {
        let flags = ["simulate", &robot, "--dtheta=2,3.5,0.4", "--time", "1", "--joint-limits", policy];
        let page = text(&flags);
        assert!(page.contains("joint limit: `pivot`") && page.contains(word), "{page}");
        let most = rows(&json(&flags)["theta"]).iter().map(|q| angle(q)).fold(0.0, f64::max);
        assert_eq!(most <= 0.7 + 1e-15, policy == "respect", "{most}");
    }
}

#[test]
fn balls_go_through_points_to_the_end() {
    let robot = cone("cone_motions");
    let turned = |x: f64| [(0.5 * x).cos(), (0.5 * x).sin(), 0.0, 0.0];
    let list = |q: [f64; 4]| q.map(|x| format!("{x:?}")).join(",");
    let [from, to] = [list(turned(-0.3)), list(turned(0.9))];
    let flags = ["trajectory", &robot, "--from", &from, "--to", &to, "--time", "1", "--step", "0.25"];
    let found = json(&flags);
    assert_close(&rows(&found["theta"])[0], &turned(-0.3), 1e-15);
    assert_close(&rows(&found["theta"])[4], &turned(0.9), 1e-15);
    assert_close(&rows(&found["dtheta"])[2], &[1.875 * 1.2, 0.0, 0.0], 1e-12); // the quintic's largest rate
    let said = String::from_utf8_lossy(&common::mozzi(&flags).stderr).into_owned();
    assert!(said.contains("joint limit: `pivot` reaches 0.9, beyond its limit 0.7"), "{said}");
    // at rest at both ends: about one axis the cubic spline of the angle
    let mut table = String::from("t,theta_1,theta_2,theta_3,theta_4\n");
    for (t, x) in [(0.0, 0.0), (1.0, 0.5), (2.0, 0.0)] {
        table += &format!("{t},{}\n", list(turned(x)));
    }
    let via = file(&folder("cone_via"), "via.csv", &table);
    let found = json(&["trajectory", &robot, "--via", &via, "--step", "0.5"]);
    assert_close(&rows(&found["theta"])[1], &turned(0.25), 1e-12); // 3x² − 2x³ at ½
    assert_close(&rows(&found["dtheta"])[1], &[0.75, 0.0, 0.0], 1e-12);
}

#[test]
fn wrong_motions() {
    let folder = folder("wrong_motions");
    let wrong = |arguments: &[&str], words: &[&str]| {
        let (code, message) = complaint(arguments);
        assert!(code == 1 && words.iter().all(|word| message.contains(word)), "{arguments:?}: {message}");
    };
    wrong(&["trajectory", "ur5"], &["the final position is missing, expected --to or --via"]);
    wrong(&["trajectory", "ur5", "--to", "1,2"], &["2 entries, expected 6"]);
    wrong(&[&WAY[..], &["--max-torque", "1"]].concat(), &["the motor of", "too weak at s = 0"]);
    wrong(&[&WAY[..], &["--max-velocity", "1,2"]].concat(), &["--max-velocity has 2 entries, expected 6"]);
    wrong(&["trajectory", "ur5", "--path", "line", "--position", "3,0,0"], &["`tool0` did not reach its goal"]);
    let points = "theta_1,theta_2,theta_3,theta_4,theta_5,theta_6\n0,-1.5,1.5,0,0.5,0\n0,-1.5,1.5,0,0.5,0\n";
    wrong(
        &["trajectory", "ur5", "--via", &file(&folder, "same.csv", points)],
        &["same.csv", "in row 2, as in the one before"],
    );
    let timed = file(&folder, "timed.csv", &points.replace("theta_1,", "t,theta_1,").replace("\n0,", "\n0,0,"));
    wrong(&["trajectory", "ur5", "--via", &timed], &["timed.csv:3: t is 0 after 0"]);
    let timed = file(
        &folder,
        "timed.csv",
        &points.replace("theta_1,", "t,theta_1,").replacen("\n0,", "\n0,0,", 1).replacen("\n0,-", "\n1,0,-", 1),
    );
    wrong(
        &["trajectory", "ur5", "--via", &timed, "--profile", "cubic"],
        &["--profile and the column t", "both define the timing"],
    );
    wrong(&["trajectory", "ur5", "--to", "0,0,0,0,0,0"], &["expected a path along which something moves"]);
    // motions beyond the given limits, or beyond the robot's, are reported
    let output = common::mozzi(&["trajectory", "ur5", "--to", "9,-1,1,0,0.5,0", "--time", "1", "--out", "-"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.contains("velocity limit: `shoulder_pan_joint` reaches 16.87"), "{said}");
    assert!(
        said.contains("joint limit: `shoulder_pan_joint` reaches 9, beyond its limit 6.2831853, at t = 1 s"),
        "{said}"
    );
    let strict = ["trajectory", "ur5", "--to", "9,-1,1,0,0.5,0", "--time", "9", "--strict"];
    assert_eq!(common::mozzi(&strict).status.code(), Some(1));
    let within = strict.map(|word| if word.starts_with('9') && word.len() > 1 { "1,-1,1,0,0.5,0" } else { word });
    assert!(common::mozzi(&within).status.success());
    for (text, words) in [
        ("{", "is not valid JSON"),
        ("{}", "`controller` is missing"),
        (r#"{"controller": "pid"}"#, "bad.json:1:2: controller is \"pid\", expected one of `pd-gravity`"),
        (r#"{"controller": 3}"#, "controller is 3, expected one of `pd-gravity`"),
        (
            r#"{"controller": "pd-gravity", "p": 1, "d": 1, "model": "no.urdf"}"#,
            "bad.json:1:46: model: `no.urdf` is neither a file",
        ),
        (
            r#"{"controller": "task-space", "frame": "no", "p": 1, "d": 1, "posture_p": 1, "posture_d": 1}"#,
            "bad.json:1:30: frame: there is no frame `no`",
        ),
        (r#"{"controller": "pd-gravity", "p": 1}"#, "`d` is missing"),
        (
            r#"{"controller": "pd-gravity", "p": 1, "d": 1, "i": 1}"#,
            "bad.json:1:46: `i` is not an entry of the controller's file",
        ),
        (
            "{\"controller\": \"pd-gravity\", \"p\": 1,\n \"D\": 1}",
            "bad.json:2:2: `D` is not an entry of the controller's file, did",
        ),
        (r#"{"controller": "pd-gravity", "p": [1, 2], "d": 1}"#, "expected a number, or a list of 6"),
        (r#"{"controller": "pd-gravity", "p": -1, "d": 1}"#, "K_p"),
        (
            r#"{"controller": "pd-gravity", "p": 1, "d": 1, "model": "panda"}"#,
            "one with 8 positions, and the robot has 6",
        ),
    ] {
        let controller = file(&folder, "bad.json", text);
        wrong(&["simulate", "ur5", "--controller", &controller], &["bad.json", words]);
    }
    let way = file(&folder, "way.csv", "t,theta_1\n0,1\n");
    wrong(
        &["simulate", "ur5", "--follow", &way, "--controller", &file(&folder, "c.json", "{}")],
        &["theta_2", "missing"],
    );
    wrong(&["simulate", "ur5", "--method", "dopri", "--tolerance", "0"], &["tolerance is 0"]);
}

#[test]
fn machine_code_makes_the_same_motion() {
    let simulate = |more: &[&str]| {
        json(&[&["simulate", "ur5", "--theta", "0,-1.2,1.5,0.3,1.1,0", "--time", "0.2"][..], more].concat())
    };
    for method in ["euler", "rk4", "dopri", "midpoint"] {
        let (plain, compiled) = (simulate(&["--method", method]), simulate(&["--method", method, "--compiled"]));
        let end = |motion: &serde_json::Value| rows(&motion["theta"]).pop().expect("rows");
        assert_close(&end(&compiled), &end(&plain), 1e-9);
    }
}

#[test]
fn the_midpoint_rule_halves_a_step_that_is_too_long() {
    // its iteration diverges at 50 ms: θ of 10⁸ once had no regular M
    let motion = json(&[
        "simulate",
        "panda",
        "--theta=0,1,0,-1,0,1,0,0",
        "--dtheta=3,-3,3,3,-4,2,4,0",
        "--method",
        "midpoint",
        "--step",
        "0.05",
        "--time",
        "2",
    ]);
    let column =
        |name: &str| -> Vec<f64> { motion[name].as_array().unwrap().iter().filter_map(|x| x.as_f64()).collect() };
    let [kinetic, potential, lost] = ["kinetic_energy", "potential_energy", "friction_loss"].map(column);
    let all: Vec<f64> = (0..kinetic.len()).map(|k| kinetic[k] + potential[k] + lost[k]).collect();
    let [low, high] = [f64::min, f64::max].map(|pick| all.iter().copied().reduce(pick).unwrap());
    let most = kinetic.iter().copied().fold(0.0, f64::max);
    assert!(kinetic.len() == 41 && high - low < 0.2 * most, "{low} to {high}, {most}");
}

#[test]
fn tables_without_rows_are_refused() {
    let path = folder("motion_no_rows").join("empty.npy");
    let columns: String = (1..=6).map(|k| format!("('theta_{k}', '<f8'), ")).collect();
    let header = format!("{{'descr': [('t', '<f8'), {columns}], 'fortran_order': False, 'shape': (0,)}}\n");
    let length = u16::try_from(header.len()).expect("short").to_le_bytes();
    std::fs::write(&path, [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes()].concat()).expect("a file");
    let path = path.to_str().expect("text");
    let follow = ["simulate", "ur5", "--controller", "computed-torque", "--time", "0.1", "--follow", path];
    for line in [&["trajectory", "ur5", "--via", path][..], &follow] {
        let (code, said) = complaint(line);
        assert!(code == 1 && said.contains("empty.npy has no rows"), "{said}");
    }
}
