//! Wrenches, gravity and parameters: by flags, and different in each state.

use super::files::{npy, npz, read_npz, save};
use super::largest;
use super::states::States;
use crate::common::{assert_close, folder, json, numbers, rows, text};
use mozzi::{Environment, Model, Vec3, Wrench};

const THETA: [&str; 2] = ["--theta", "0.2,-1.2,1.5,0.3,1.1,0.4"];

fn ur5() -> Model {
    mozzi_urdf::open("ur5").expect("a robot").build().expect("a model")
}

/// JᵀF.
fn transposed(J: &[Vec<f64>], F: &[f64]) -> Vec<f64> {
    (0..J[0].len()).map(|j| J.iter().zip(F).map(|(row, f)| row[j] * f).sum()).collect()
}

#[test]
fn several_wrenches_add_their_joint_forces() {
    let pushes = [("tool0", [0.1, -0.2, 0.5, 3.0, -4.0, 20.0]), ("forearm_link", [1.0, 0.0, -2.0, 0.0, 5.0, 0.5])];
    let flags = pushes.map(|(frame, F)| format!("{frame}={}", F.map(|x| x.to_string()).join(",")));
    let tau =
        |more: &[&str]| numbers(&json(&[&["compute", "ur5", "inverse-dynamics"], &THETA[..], more].concat())["tau"]);
    let (free, both) = (tau(&[]), tau(&["--wrench", &flags[0], "--wrench", &flags[1]]));
    let mut expected = free.clone();
    for (frame, F) in &pushes {
        let J = json(&[&["compute", "ur5", "body-jacobian", "--frame", frame], &THETA[..]].concat());
        expected = expected.iter().zip(transposed(&rows(&J["J"]), F)).map(|(a, b)| a + b).collect();
    }
    assert_close(&both, &expected, 1e-12);
    assert!(largest(&expected) > 0.0 && free != both);
    // the end effector's wrench by its own flag
    let (name, F) = flags[0].split_once('=').expect("a name");
    assert_eq!(tau(&["--wrench", &flags[0]]), tau(&["--tip-wrench", F]));
    assert_eq!(
        tau(&["--wrench", &flags[1]]),
        tau(&["--tip-wrench", flags[1].split_once('=').expect("F").1, "--frame", "forearm_link"])
    );
    let found = json(&[&["compute", "ur5", "tip-forces", "--wrench", &flags[0]], &THETA[..]].concat());
    assert_eq!(numbers(&found["wrenches"][name]), pushes[0].1);
    assert_close(
        &numbers(&found["tau"]),
        &both.iter().zip(tau(&["--wrench", &flags[1]])).map(|(a, b)| a - b).collect::<Vec<_>>(),
        1e-12,
    );
}

#[test]
fn gravity_is_that_of_the_flag() {
    let g = |more: &[&str]| numbers(&json(&[&["compute", "ur5", "gravity-forces"], &THETA[..], more].concat())["g"]);
    let (earth, moon) = (g(&[]), g(&["--gravity", "0,0,-1.62"]));
    assert_close(&moon, &earth.iter().map(|x| x * 1.62 / 9.81).collect::<Vec<_>>(), 1e-13);
    assert_close(&g(&["--gravity", "0,0,0"]), &[0.0; 6], 0.0);
}

#[test]
fn gravity_parameters_and_wrenches_differ_from_state_to_state() {
    let folder = folder("compute_environment");
    let (model, count) = (ur5(), 5);
    let states = States::new(&model, count);
    let p = model.parameter_count();
    let gravity: Vec<f64> = (0..count * 3).map(|k| (k as f64).cos() * 9.0).collect();
    let pushes: Vec<f64> = (0..count * 6).map(|k| (k as f64 * 0.3).sin() * 4.0).collect();
    let parameters: Vec<f64> =
        (0..count).flat_map(|k| model.parameters().into_iter().map(move |x| x * (1.0 + 0.1 * k as f64))).collect();
    let arrays: [(&str, &[usize], &[f64]); 7] = [
        ("theta", &[count, 6], &states.tables[0]),
        ("dtheta", &[count, 6], &states.tables[1]),
        ("ddtheta", &[count, 6], &states.tables[2]),
        ("wrench", &[count, 6], &states.tables[3]),
        ("gravity", &[count, 3], &gravity),
        ("parameters", &[count, p], &parameters),
        ("wrench_forearm_link", &[count, 6], &pushes),
    ];
    let input = npz(&folder, "states.npz", &arrays);
    let out = folder.join("tau.npz").to_str().expect("text").to_string();
    text(&["compute", "ur5", "inverse-dynamics", "--in", &input, "--out", &out]);
    let (_, _, found) = read_npz(&out).remove(0);
    let frames = [model.end_effector().expect("a tip"), model.frame("forearm_link").expect("a frame")];
    for state in 0..count {
        let wrench = |table: &[f64]| Wrench::from_array(std::array::from_fn(|k| table[state * 6 + k]));
        let applied = [(frames[0], wrench(&states.tables[3])), (frames[1], wrench(&pushes))];
        let robot = model.with_parameters(&parameters[state * p..][..p]);
        let environment = Environment {
            applied: &applied,
            gravity: Vec3(std::array::from_fn(|k| gravity[state * 3 + k])),
            ..model.environment()
        };
        let [theta, dtheta, ddtheta] = [0, 1, 2].map(|k| states.at(k, state));
        let tau = robot.inverse_dynamics(theta, dtheta, ddtheta, &environment).expect("τ");
        assert_close(&found[state * 6..][..6], tau.as_slice(), 1e-11 * largest(tau.as_slice()));
    }
    // without --out, JSON has states and results
    let all = json(&["compute", "ur5", "inverse-dynamics", "--in", &input]);
    assert_close(&rows(&all["tau"]).concat(), &found, 0.0);
    assert_eq!(rows(&all["wrenches"]["forearm_link"]).concat(), pushes);
    assert_eq!(rows(&all["theta"]).concat(), states.tables[0]);
}

#[test]
fn wrenches_of_flags_are_the_same_in_all_states() {
    let folder = folder("compute_constant_wrenches");
    let model = ur5();
    let states = States::new(&model, 3);
    let theta = npz(&folder, "theta.npz", &[("theta", &[3, 6], &states.tables[0])]);
    let push = ["--wrench", "forearm_link=1,2,3,4,5,6"];
    let found = json(&[&["compute", "ur5", "tip-forces", "--in", &theta], &push[..]].concat());
    let array = save(&folder, "theta.npy", &npy(&[3, 6], &states.tables[0], false));
    assert_eq!(json(&[&["compute", "ur5", "tip-forces", "--in", &array], &push[..]].concat()), found);
    let applied = [(model.frame("forearm_link").expect("it"), Wrench::from_array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]))];
    for (state, tau) in rows(&found["tau"]).iter().enumerate() {
        assert_close(tau, model.tip_forces(states.at(0, state), &applied).expect("JᵀF").as_slice(), 1e-13);
    }
}

#[test]
fn a_simulation_in_npz_is_a_table_of_states() {
    let folder = folder("compute_simulated");
    let file = folder.join("fall.npz").to_str().expect("text").to_string();
    text(&["simulate", "two_link_planar", "--time", "0.01", "--out", &file]);
    let found = json(&["compute", "two_link_planar", "inverse-dynamics", "--in", &file]);
    assert_eq!(numbers(&found["t"]).len(), 11);
    assert_close(&rows(&found["tau"]).concat(), &[0.0; 22], 1e-12);
}
