//! `--until` and `--report-event`: their times, against Runge-Kutta's steps that end there, and their messages.

use crate::common;

use common::{assert_close, complaint, file, folder, json, mozzi, numbers, text};
use mozzi_sim::{Options, Zero};

const SWING: [&str; 6] = ["simulate", "double_pendulum", "--theta", "2,1", "--time", "3"];

/// The time near a guess at which g of (θ, θ̇) is 0, by the secant method. Each motion has 3000 steps of Runge-Kutta 4
/// that end at the time.
fn root(guess: f64, g: impl Fn(&[f64], &[f64]) -> f64) -> f64 {
    let model = mozzi_urdf::open("double_pendulum").expect("embedded").build().expect("sound");
    let at = |t: f64| {
        let motion = mozzi_sim::simulate(
            &model,
            &[2.0, 1.0],
            &[0.0; 2],
            Zero,
            &Options { record_every: 3000, ..Options::new(t, 3000) },
        )
        .expect("a motion");
        g(motion.last().theta, motion.last().dtheta)
    };
    let (mut a, mut b) = ((guess - 1e-4, at(guess - 1e-4)), (guess + 1e-4, at(guess + 1e-4)));
    for _ in 0..3 {
        let t = b.0 - b.1 * (b.0 - a.0) / (b.1 - a.1);
        (a, b) = (b, (t, at(t)));
    }
    b.0
}

#[test]
fn conditions_become_true_on_time() {
    let flags = ["--report-event", "joint1 = 0", "--report-event", "dtheta_2 < -1", "--until", " tip.z>0.4 "];
    let height = |theta: &[f64], _: &[f64]| -0.5 * (theta[0].cos() + (theta[0] + theta[1]).cos()) - 0.4;
    let expected = [
        ("joint1 = 0", root(0.6112, |theta, _| theta[0])),
        ("dtheta_2 < -1", root(0.3326, |_, dtheta| dtheta[1] + 1.0)),
        ("tip.z>0.4", root(1.3059, height)),
    ];
    for (method, tolerance) in [
        (&["--method", "dopri"][..], 1e-8),
        (&["--method", "rk4"], 1e-7),
        (&["--method", "dopri", "--joint-limits", "respect"], 1e-8),
    ] {
        let found = json(&[&SWING[..], &flags, method].concat());
        let events = found["events"].as_array().expect("a list");
        for (name, expected) in &expected {
            let event = events.iter().find(|event| event["condition"] == *name).expect("it happens");
            let t = event["t"].as_f64().expect("a number");
            assert!((t - expected).abs() < tolerance, "{name} {method:?}: {t} {expected}");
        }
        // the motion ends there, in the state of the last event
        let last = events.last().expect("one");
        assert!(last["end"] == true && last["condition"] == "tip.z>0.4" && found["complete"] == false);
        assert_eq!(numbers(&found["t"]).last(), last["t"].as_f64().as_ref());
        assert_close(common::rows(&found["theta"]).last().expect("rows"), &numbers(&last["theta"]), 0.0);
        assert!(height(&numbers(&last["theta"]), &[]).abs() < 1e-12);
    }
}

#[test]
fn limits_of_joints_are_conditions() {
    let fall = ["simulate", "panda", "--theta=0,0,0,-1.5,0,1.5,0,0.02", "--time", "1"];
    let found = json(&[&fall[..], &["--method", "dopri", "--until", "joint-limit"]].concat());
    let (event, theta) = (&found["events"][0], numbers(&found["events"][0]["theta"]));
    assert_eq!(event["condition"], "joint-limit: upper limit of panda_joint2");
    assert!((theta[1] - 1.7628).abs() < 1e-12 && found["joint_limits"][0]["joint"] == "panda_joint2");
    // joints that rest at their limits are each reported on arrival
    let page = text(&[&fall[..], &["--report-event", "joint-limit", "--joint-limits", "respect"]].concat());
    assert!(page.contains("event: `joint-limit: upper limit of panda_finger_joint1` at t = 0.54"), "{page}");
}

#[test]
fn what_happened_is_told_everywhere() {
    let folder = folder("events");
    let page = folder.join("swing.html").to_string_lossy().into_owned();
    let said = text(
        &[&SWING[..], &["--report-event", "joint1 = 0", "--report-event", "joint1 = 9", "--report", &page]].concat(),
    );
    assert!(said.contains("event: `joint1 = 0` at t = 0.6111928 s\n"), "{said}");
    assert!(said.contains("event: `joint1 = 9` did not happen up to t = 3 s\n"), "{said}");
    assert!(std::fs::read_to_string(page).expect("a page").contains("event: `joint1 = 0` at t = 0.6111928 s"));
    let output = mozzi(&[&SWING[..], &["--until", "joint1 < 0", "--out", "-"]].concat());
    let rows = String::from_utf8(output.stdout).expect("text");
    assert!(output.status.success() && rows.lines().last().expect("a row").starts_with("0.6111"), "{rows}");
    let noted = String::from_utf8(output.stderr).expect("text");
    assert_eq!(noted, "note: event: `joint1 < 0` at t = 0.6111928 s, where the motion ends\n");
    // a floating base by name; a condition that is already true counts the next time it becomes true
    let output = mozzi(&["simulate", "ur5", "--floating", "--time", "0.5", "--until", "base.z < -0.5"]);
    assert!(String::from_utf8_lossy(&output.stdout).contains("`base.z < -0.5` at t = 0.319275"), "√(2 · 0.5/9.81)");
    let output = mozzi(&[&SWING[..], &["--report-event", "joint1 > 1"]].concat());
    assert!(String::from_utf8_lossy(&output.stderr).contains("`joint1 > 1` is already true at the start"));
}

#[test]
fn wrong_conditions() {
    for (condition, words) in [
        ("elbow > 1", "--until `elbow > 1`: there is no `elbow`, expected one of `joint1`, `joint2`"),
        ("theta_3 = 1", "there is no `theta_3`"),
        ("tip.w > 1", "there is no `tip.w`"),
        ("joint1", "--until `joint1` is no condition, expected a joint, =, < or >, and a number"),
        ("joint1 > fast", "the value after > is `fast`, expected a finite number"),
        ("joint1 > inf", "expected a finite number"),
        ("> 1", "there is no ``"),
        ("joint-limit", "no joint of `double_pendulum` has a limit of position"),
        ("tip.z > 5deg", "5deg is an angle, and `tip.z` is a length"),
    ] {
        let (code, said) = complaint(&[&SWING[..], &["--until", condition]].concat());
        assert!(code == 1 && said.contains(words), "{said}");
    }
    let table = file(&folder("wrong_conditions"), "t.csv", "t,theta_1\n");
    assert_eq!(mozzi(&["compute", "ur5", "inverse-dynamics", "--in", &table, "--until", "x"]).status.code(), Some(2));
}
