//! `examples/panda_controller`, as its build script and the compilers make it: its Rust and its C compared with the
//! same loop on the library's own kernels.

#[path = "../../../examples/panda_controller/build.rs"]
#[allow(dead_code)]
mod build_script;

use mozzi::{Environment, Model, Solid, Workspace, dynamics};
use std::f64::consts::PI;
use std::path::{Path, PathBuf};
use std::process::Command;

const STEP: f64 = 1e-3;
const HOME: [f64; 7] = [0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8];
const LIMITS: [f64; 7] = [87.0, 87.0, 87.0, 87.0, 12.0, 12.0, 12.0];

/// The error that both programs print, computed by `mozzi` itself.
fn error_of(arm: &Model, plant: &Model) -> f64 {
    let gravity = arm.environment();
    let (mut for_arm, mut for_plant) = (Workspace::new(arm), Workspace::new(plant));
    let mut acceleration = |theta: &[f64], dtheta: &[f64], tau: &[f64], environment: &Environment| {
        let mut ddtheta = [0.0; 7];
        dynamics::forward_dynamics(plant, theta, dtheta, tau, environment, &mut for_plant, &mut ddtheta);
        ddtheta
    };
    let along = |x: &[f64; 7], h: f64, dx: &[f64; 7]| -> [f64; 7] { std::array::from_fn(|j| x[j] + h * dx[j]) };
    let (mut q, mut v, mut squares) = (HOME.map(|q| q + 0.05), [0.0; 7], 0.0);
    for k in 0..4000 {
        let (s, c) = (PI * f64::from(k) * STEP).sin_cos();
        let wanted: [f64; 7] = std::array::from_fn(|j| {
            -0.3 * PI * PI * s + 40.0 * (0.3 * PI * c - v[j]) + 400.0 * (HOME[j] + 0.3 * s - q[j])
        });
        let mut tau = [0.0; 7];
        dynamics::inverse_dynamics(arm, &q, &v, &wanted, &gravity, &mut for_arm, &mut tau);
        tau.iter_mut().zip(LIMITS).for_each(|(tau, limit)| *tau = tau.clamp(-limit, limit));
        if k >= 2000 {
            squares += q.iter().zip(HOME).map(|(q, home)| (q - home - 0.3 * s).powi(2)).sum::<f64>();
        }
        let half = STEP / 2.0;
        let a1 = acceleration(&q, &v, &tau, &gravity);
        let v2 = along(&v, half, &a1);
        let a2 = acceleration(&along(&q, half, &v), &v2, &tau, &gravity);
        let v3 = along(&v, half, &a2);
        let a3 = acceleration(&along(&q, half, &v2), &v3, &tau, &gravity);
        let v4 = along(&v, STEP, &a3);
        let a4 = acceleration(&along(&q, STEP, &v3), &v4, &tau, &gravity);
        let mean =
            |x: [[f64; 7]; 4]| std::array::from_fn(|j| (x[0][j] + 2.0 * x[1][j] + 2.0 * x[2][j] + x[3][j]) / 6.0);
        (q, v) = (along(&q, STEP, &mean([v, v2, v3, v4])), along(&v, STEP, &mean([a1, a2, a3, a4])));
    }
    (squares / (2000.0 * 7.0)).sqrt()
}

/// The output of a program: the error of each plant.
fn printed(program: &Path) -> Vec<(String, f64)> {
    let output = Command::new(program).output().expect("what was compiled");
    assert!(output.status.success(), "{}", output.status);
    let text = String::from_utf8(output.stdout).expect("text");
    let line = |line: &str| {
        let (name, rest) = line.split_once(": ").expect("a name");
        (name.to_string(), rest.split(' ').next().and_then(|x| x.parse().ok()).expect("a number"))
    };
    text.lines().map(line).collect()
}

fn compile(compiler: &str, arguments: &[&str], folder: &Path) {
    let output =
        Command::new(compiler).args(arguments).current_dir(folder).env("OUT_DIR", folder).output().expect("runs");
    assert!(output.status.success(), "{compiler} {arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn the_controllers_in_rust_and_c_do_as_the_library_does() {
    let project = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../examples/panda_controller");
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("controller");
    build_script::write(&folder).expect("texts");

    let arm = mozzi_urdf::open("panda").expect("embedded").build().expect("a robot");
    let arm = arm.with_locked_joints(&[("panda_finger_joint1", 0.04)]).expect("a joint");
    let load = Solid::Sphere { radius: 0.04 }.inertia(0.5);
    let loaded = arm.with_payload(arm.frame("panda_hand_tcp").expect("a frame"), load).expect("a load");
    let expected = [("known arm", error_of(&arm, &arm)), ("0.5 kg more", error_of(&arm, &loaded))];
    assert!(expected[0].1 < 1e-3 && expected[1].1 > 10.0 * expected[0].1, "{expected:?}");

    let path = |file: &str| project.join(file).display().to_string();
    let library = ["--edition=2024", "--crate-name=panda_controller", "--crate-type=rlib", "-O", &path("src/lib.rs")];
    compile("rustc", &[&library[..], &["-Dwarnings", "-Cpanic=abort"]].concat(), &folder);
    let main =
        ["--edition=2024", "-O", "-Cpanic=abort", "--extern=panda_controller=libpanda_controller.rlib", "-Dwarnings"];
    compile("rustc", &[&main[..], &["-oin_rust", &path("src/main.rs")]].concat(), &folder);
    let mut programs = vec!["in_rust"];
    if Command::new("gcc").arg("--version").output().is_ok() {
        let (controller, main, include) = (path("c/controller.c"), path("c/main.c"), format!("-I{}", path("c")));
        let words = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Werror", "-I.", &include, "-oin_c"];
        compile("gcc", &[&words[..], &[&main, &controller, "panda.c", "panda_loaded.c", "-lm"]].concat(), &folder);
        programs.push("in_c");
    } else {
        eprintln!("skipped in C: no gcc here");
    }
    for program in programs {
        for ((name, found), (expected_name, expected)) in printed(&folder.join(program)).iter().zip(&expected) {
            assert_eq!(name, expected_name);
            // to the printed digits
            assert!((found - expected).abs() < 2e-6 * expected, "{program}, {name}: {found:e}, expected {expected:e}");
        }
    }
}
