//! Columns of a joint that follows another.

use super::common::{complaint, file, folder, json, mozzi};
use serde_json::Value;
use std::fmt::Write;

/// `b` turns by 3a + 0.2, within ±1 rad and 2 rad/s.
const ROBOT: &str = r#"<robot name="coupled"><link name="base"/>
<link name="one"><inertial><origin xyz="0.3 0 0"/><mass value="2"/>
<inertia ixx="0.02" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="two"><inertial><origin xyz="0.2 0.05 0"/><mass value="1"/>
<inertia ixx="0.01" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="a" type="revolute"><parent link="base"/><child link="one"/><axis xyz="0 1 0"/>
<limit lower="-2" upper="2" effort="99" velocity="3"/></joint>
<joint name="b" type="revolute"><parent link="one"/><child link="two"/><origin xyz="0.5 0 0"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="1" effort="99" velocity="2"/><mimic joint="a" multiplier="3" offset="0.2"/></joint></robot>"#;

/// 10 s at 100 Hz; b's positions by `follow`, and its part of the force, of which a has the rest.
fn table(follow: impl Fn(f64) -> f64, share: f64) -> String {
    let model = mozzi_urdf::parse("coupled.urdf", ROBOT).expect("a robot").description.build().expect("sound");
    let mut text = String::from("t,theta_a,theta_b,tau_a,tau_b\n");
    for k in 0..1000 {
        let t = 0.01 * f64::from(k);
        let wave = |w: f64, size: f64| {
            let (s, c) = (w * t).sin_cos();
            [size * s, size * w * c, -size * w * w * s]
        };
        let [q, v, a] = core::array::from_fn(|i| wave(2.1, 0.25)[i] + wave(4.7, 0.1)[i] + wave(7.3, 0.05)[i]);
        let tau = model.inverse_dynamics(&[q], &[v], &[a], &model.environment()).expect("a torque")[0];
        let of_b = share * tau / 3.0;
        writeln!(text, "{t:.2},{q:.9},{:.9},{:.9},{of_b:.9}", follow(q), tau - 3.0 * of_b).expect("text");
    }
    text
}

#[test]
fn a_joint_that_follows_adds_its_force_and_must_follow() {
    let folder = folder("mimic_log");
    let robot = file(&folder, "coupled.urdf", ROBOT);
    let law = |a: f64| 3.0 * a + 0.2;
    let found = |name: &str, text: String| -> Vec<f64> {
        let found: Value = json(&["identify", &robot, &file(&folder, name, &text)]);
        found["base_parameters"].as_array().expect("a list").iter().filter_map(|one| one["value"].as_f64()).collect()
    };
    let whole = found("whole.csv", table(law, 0.0));
    let halves = found("halves.csv", table(law, 0.5));
    assert!(
        whole.len() > 2 && whole.iter().zip(&halves).all(|(a, b)| (a - b).abs() < 1e-6 * (1.0 + a.abs())),
        "{halves:?}"
    );
    // drop-outs and wrapped angles are no other law; columns without forces are none
    let cells = |edit: &dyn Fn(usize, &mut Vec<String>)| -> String {
        let rows = table(law, 0.0);
        let edited = rows.lines().enumerate().map(|(k, row)| {
            let mut cells: Vec<String> = row.split(',').map(String::from).collect();
            if k > 0 {
                edit(k, &mut cells);
            }
            cells.join(",") + "\n"
        });
        edited.collect()
    };
    let turn = |x: &str| (x.parse::<f64>().expect("a number") + core::f64::consts::TAU).to_string();
    for (name, text) in [
        (
            "gap.csv",
            cells(&|k, row| {
                if k == 300 {
                    row[2] = String::new()
                }
            }),
        ),
        (
            "spike.csv",
            cells(&|k, row| {
                if k == 300 {
                    row[2] = "500".into()
                }
            }),
        ),
        (
            "wrapped.csv",
            cells(&|k, row| {
                if k > 600 {
                    row[2] = turn(&row[2])
                }
            }),
        ),
        ("without.csv", cells(&|_, row| row[4] = "nan".into())),
    ] {
        let values = found(name, text);
        assert!(whole.iter().zip(&values).all(|(a, b)| (a - b).abs() < 1e-6 * (1.0 + a.abs())), "{name}: {values:?}");
    }
    for (name, text, words) in [
        ("apart.csv", table(|a| -a, 0.0), ["of `b` (`theta_b`) differs", "from 3 · a + 0.2"]),
        (
            "one.csv",
            cells(&|k, row| {
                if k == 300 {
                    row[4] = "nan".into()
                }
            }),
            ["of `b` (`tau_b`)", "missing in 1 of 1000 rows"],
        ),
    ] {
        let (code, why) = complaint(&["identify", &robot, &file(&folder, name, &text)]);
        assert!(code == 1 && words.iter().all(|word| why.contains(word)), "{why}");
    }
}

#[test]
fn an_exciting_motion_keeps_the_limits_of_joints_that_follow() {
    let folder = folder("mimic_excite");
    let robot = file(&folder, "coupled.urdf", ROBOT);
    let out = folder.join("motion.csv");
    let out = out.to_str().expect("text");
    assert!(mozzi(&["excite", &robot, "--duration", "5", "--out", out]).status.success());
    let text = std::fs::read_to_string(out).expect("a table");
    let mut rows = text.lines();
    let names: Vec<&str> = rows.next().expect("a header").split(',').collect();
    let column = |name: &str| names.iter().position(|known| *known == name).expect("a column");
    let (theta, dtheta) = (column("theta_1"), column("dtheta_1"));
    let mut fastest = 0.0_f64;
    for row in rows {
        let x: Vec<f64> = row.split(',').map(|x| x.parse().expect("a number")).collect();
        assert!(-0.4 <= x[theta] && 3.0 * x[theta] + 0.2 <= 1.0 && x[dtheta].abs() <= 2.0 / 3.0 + 1e-9, "{row}");
        fastest = fastest.max(x[dtheta].abs());
    }
    assert!(fastest > 0.3, "{fastest}");
}
