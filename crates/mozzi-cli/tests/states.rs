//! Named states: listed, used by name, kept in JSON, and the default start.

use crate::common;

use common::{complaint, file, folder, json, mozzi, numbers, text};
use serde_json::Value;

const KEYS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../oracles/test_keys.xml");

/// θ and θ̇ of a state, as `mozzi info` has them.
fn state(robot: &str, name: &str) -> [Vec<f64>; 2] {
    let info = json(&["info", robot]);
    let all = info["states"].as_array().expect("a list");
    let found = all.iter().find(|state| state["name"] == name).expect("named");
    ["theta", "dtheta"].map(|key| numbers(&found[key]))
}

fn list(values: &[f64]) -> String {
    values.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(",")
}

#[test]
fn states_are_listed() {
    let page = text(&["info", KEYS]);
    let rows: Vec<&str> = page.lines().filter(|line| line.contains("θ = (")).map(str::trim).collect();
    assert_eq!(rows.len(), 4);
    assert!(rows[0].starts_with("qpos0  the start  t = 0 s    at rest  θ = ("), "{}", rows[0]);
    assert!(rows[1].starts_with("home              t = 0.5 s  moving"), "{}", rows[1]);
    assert!(rows[2].starts_with("key1 ") && rows[2].ends_with("… 13 in all"), "{}", rows[2]);
    assert_eq!(json(&["info", KEYS])["start"], "qpos0");
    assert!(!text(&["info", "ur5"]).contains("states"));
}

#[test]
fn a_name_stands_for_its_numbers() {
    let [theta, dtheta] = state(KEYS, "home");
    let (theta, dtheta) = (list(&theta), list(&dtheta));
    let by_numbers = ["--theta", &theta, "--dtheta", &dtheta];
    for command in [&["compute", KEYS, "bias-forces"][..], &["terms", KEYS, "--end-effector", "hand"]] {
        let named = json(&[command, &["--state", "home"]].concat());
        assert_eq!(named, json(&[command, &by_numbers].concat()));
        assert_ne!(named, json(&[command, &["--state", "still"]].concat()));
        // positions alone, with other velocities
        let rest = json(&[command, &["--theta", "home"]].concat());
        assert_eq!(rest, json(&[command, &["--theta", &theta]].concat()));
    }
    let first = |arguments: &[&str]| {
        let motion = json(&[&["simulate", KEYS, "--time", "0.01"], arguments].concat());
        [numbers(&motion["theta"][0]), numbers(&motion["dtheta"][0])]
    };
    assert_eq!(first(&["--state", "home"]), state(KEYS, "home"));
    // MuJoCo does not start at `home` either
    assert_eq!(first(&[]), state(KEYS, "qpos0"));
    assert_eq!(first(&["--dtheta", &dtheta])[0], state(KEYS, "qpos0")[0]);
}

#[test]
fn what_is_no_state_is_told() {
    for arguments in [
        &["compute", KEYS, "mass-matrix", "--state", "hone"][..],
        &["compute", KEYS, "mass-matrix", "--theta", "hone"],
        &["simulate", KEYS, "--state", "hone"],
        &["view", KEYS, "--state", "hone", "--out", "page.html"],
    ] {
        let (code, message) = complaint(arguments);
        assert_eq!(code, 1, "{message}");
        assert!(
            message.contains("there is no state `hone`; this robot has `qpos0`, `home`, `key1`, `still`"),
            "{message}"
        );
    }
    let (code, message) = complaint(&["compute", "ur5", "mass-matrix", "--theta", "home"]);
    assert!(code == 1 && message.contains("--theta: entry 1 is `home`, expected a number"), "{message}");
    let (_, message) = complaint(&["compute", "ur5", "mass-matrix", "--state", "home"]);
    assert!(message.contains("there is no state `home`; this robot has none"), "{message}");
    for command in [&["terms", KEYS][..], &["compute", KEYS, "bias-forces"]] {
        for flag in ["--theta", "--dtheta"] {
            let (code, message) = complaint(&[command, &["--state", "home", flag, "0"]].concat());
            assert!(code == 2 && message.contains("cannot be used with"), "{message}");
        }
    }
}

#[test]
fn json_keeps_states_and_urdf_says_that_it_does_not() {
    let folder = folder("states");
    let path = |name: &str| folder.join(name).to_str().expect("text").to_string();
    let (robot, again) = (path("keys.json"), path("again.json"));
    text(&["convert", KEYS, &robot]);
    text(&["convert", &robot, &again]);
    let read = |path: &str| std::fs::read_to_string(path).expect("a file");
    assert_eq!(read(&robot), read(&again));
    for name in ["qpos0", "home", "key1", "still"] {
        assert_eq!(state(&robot, name), state(KEYS, name));
    }
    let good: Value = serde_json::from_str(&read(&robot)).expect("JSON");
    let says = |edit: &dyn Fn(&mut Value), words: &str| {
        let mut value = good.clone();
        edit(&mut value);
        let (code, message) = complaint(&["info", &file(&folder, "broken.json", &value.to_string())]);
        assert!(code == 1 && message.contains(words), "{message}");
    };
    says(
        &|v| v["states"][1]["joints"][0]["positions"] = "x".into(),
        "states[1].joints[0].positions is \"x\", expected a list",
    );
    says(&|v| v["states"][1]["joints"][1]["name"] = "knee".into(), "state `home`: joints: there is no joint `knee`");
    says(&|v| v["start"] = "away".into(), "start: there is no state `away`, expected one of `qpos0`, `home`");
    says(&|v| v["states"][1]["joints"][0]["positions"][0] = 3.into(), "expected a unit quaternion");
    // a robot that URDF can express, except for its state
    let model = "<mujoco><worldbody><body name='b'><joint name='j' ref='90' axis='0 0 1'/><geom size='1'/></body></worldbody></mujoco>";
    let output = mozzi(&["convert", &file(&folder, "turned.xml", model), &path("turned.urdf")]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    assert!(said.contains("turned.urdf cannot express the named states `qpos0`"), "{said}");
}

#[test]
fn the_page_starts_in_a_state() {
    let page = folder("states_page").join("page.html").to_str().expect("text").to_string();
    let start = |arguments: &[&str]| {
        text(&[&["view", KEYS, "--out", &page], arguments].concat());
        let html = std::fs::read_to_string(&page).expect("a page");
        let (_, after) = html.split_once("id=\"data\">").expect("its data");
        let data: Value = serde_json::from_str(after.split_once("</script>").expect("an end").0).expect("JSON");
        let file = mozzi_urdf::json::File::parse("robot.json", data["robot"].to_string()).expect("JSON");
        let robot = mozzi_urdf::json::read(&file).expect("a robot");
        let model: mozzi::Model = robot.build().expect("sound");
        model.start().theta
    };
    assert_eq!(start(&[]), state(KEYS, "qpos0")[0]);
    assert_eq!(start(&["--state", "still"]), state(KEYS, "still")[0]);
}

/// An actuator that explicit methods cannot follow at a millisecond.
#[test]
fn stiff_actuators_are_taken_implicitly() {
    let text = "<mujoco><worldbody><body><joint name='hinge' axis='0 1 0'/>\
                <geom type='capsule' size='.02' fromto='0 0 0 0 0 -.2' mass='0.1'/></body></worldbody>\
                <actuator><position joint='hinge' kp='2000' kv='20'/></actuator></mujoco>";
    let robot = file(&folder("stiff"), "stiff.xml", text);
    let run = mozzi(&["simulate", &robot, "--theta", "0.3", "--time", "0.5", "--json"]);
    let notes = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success() && notes.contains("`hinge` is stiff") && notes.contains("moreau"), "{notes}");
    let found: serde_json::Value = serde_json::from_slice(&run.stdout).expect("JSON");
    let last = found["theta"].as_array().and_then(|rows| rows.last()?[0].as_f64()).expect("a number");
    assert!(last.abs() < 1e-3, "{last}");
}
