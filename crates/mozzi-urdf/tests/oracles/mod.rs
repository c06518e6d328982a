//! mozzi against Pinocchio and MuJoCo on real robots: the committed numbers of `oracles/`, and, if the environment
//! variable MOZZI_ORACLES names a folder made by `oracles/make.py`, a hundred states of every robot in it.
//!
//! Errors are normalised: |x − reference| over ε times the size of the terms that x is the sum of.
#![allow(clippy::unwrap_used)]

use crate::common;
pub(crate) mod models;

use common::{BOUND, Worst, column, derivatives, largest_square, matrix, repository, vector};
use mozzi::accuracy::TermSizes;
use mozzi::{Environment, FrameId, Model, Wrench};
use nalgebra::{DMatrix, DVector};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Accepted reasons to refuse a model of MJCF: it is more than a tree, a part of it is in another model, or its
/// numbers are in meshes that cannot be read.
const CLOSURES: [&str; 6] = [
    "unsupported_tendon",
    "unsupported_equality",
    "unsupported_element",
    "mesh_inertia",
    "actuator_armature",
    "unsupported_attribute",
];

/// The robot of a file of oracles, without friction and springs, and without armature if the oracle has none. The
/// reason, if mozzi refuses the model for good reason.
fn model(oracle: &Value) -> Result<Model, String> {
    let text = |key: &str| oracle.get(key).and_then(Value::as_str);
    let path = match text("urdf_path") {
        Some(path) => PathBuf::from(path),
        None => repository().join(text("mjcf").or(text("urdf")).unwrap()),
    };
    let mut robot = match mozzi_urdf::load(&path) {
        Ok(loaded) => loaded.description,
        Err(error) => {
            let is_closure =
                |code: &str| code.strip_prefix("mozzi::mjcf::").is_some_and(|code| CLOSURES.contains(&code));
            assert!(error.errors().next().is_some() && error.errors().all(|error| is_closure(error.code())), "{error}");
            let found = error.errors().next().unwrap();
            return Err(format!("{} ({})", found.message(), found.code()));
        }
    };
    let has_armature = oracle.get("armature").is_some();
    for joint in &mut robot.joints {
        (joint.damping, joint.friction, joint.stiffness) = (0.0, 0.0, 0.0);
        joint.armature *= f64::from(u8::from(has_armature));
    }
    assert_eq!(vector(&oracle["gravity"]), robot.gravity, "{}", path.display());
    robot.end_effector = Some(oracle["tip_frame"].as_str().unwrap().into());
    Ok(robot.build().unwrap())
}

/// Compares every quantity that the state carries; vectors and matrices in the order of the oracle's velocities.
fn compare(model: &Model, order: &[usize], oracle: &Value, state: &Value, worst: &mut Worst) {
    let n = model.n();
    let mine = |key: &str| {
        let theirs = vector(&state[key]);
        let mut list = vec![0.0; n];
        order.iter().enumerate().for_each(|(k, &j)| list[j] = theirs[k]);
        list
    };
    let theirs = |v: DVector<f64>| column(&order.iter().map(|&j| v[j]).collect::<Vec<_>>());
    let both = |M: DMatrix<f64>| DMatrix::from_fn(n, n, |i, j| M[(order[i], order[j])]);
    let columns = |J: mozzi::Jacobian| J.matrix().select_columns(order);
    let mut theta = vector(&state["theta"]);
    if !order.iter().copied().eq(0..n) {
        // joints of one axis only
        let (base, joints) = (model.base().positions(), model.base().velocities());
        let theirs_of_joints = theta.split_off(base);
        theta.resize(model.nq(), 0.0);
        order[joints..].iter().zip(theirs_of_joints).for_each(|(&j, x)| theta[base + j - joints] = x);
    }
    let (dtheta, ddtheta, tau) = (mine("dtheta"), mine("ddtheta"), mine("tau"));
    let (environment, tip) = (model.environment(), model.end_effector().unwrap());
    let list = |key: &str| column(&vector(&state[key]));
    let has = |key: &str| state.get(key).is_some();

    let M = matrix(&state["mass_matrix"]);
    let g = model.gravity_forces(&theta).unwrap().amax();
    let sizes = TermSizes::new(M.amax(), g, &dtheta, &ddtheta);
    let (quadratic, bias, total) = (sizes.velocity_product, sizes.bias_forces, sizes.inverse_dynamics);
    worst.add("M", &both(model.mass_matrix(&theta).unwrap()), &M, 0.0);
    let found = model.bias_forces(&theta, &dtheta, &environment).unwrap();
    worst.add("h", &theirs(found), &list("bias_forces"), bias);
    let found = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment).unwrap();
    worst.add("τ", &theirs(found), &list("inverse_dynamics"), total);
    if has("velocity_product") {
        worst.add("c", &theirs(model.velocity_product(&theta, &dtheta).unwrap()), &list("velocity_product"), quadratic);
        worst.add("g", &theirs(model.gravity_forces(&theta).unwrap()), &list("gravity_forces"), 0.0);
    }
    if has("coriolis_matrix") {
        let C = model.coriolis_matrix(&theta, &dtheta).unwrap();
        worst.add("C", &both(C), &matrix(&state["coriolis_matrix"]), quadratic.max(M.amax()));
        let dM = model.mass_matrix_rate(&theta, &dtheta).unwrap();
        worst.add("Ṁ", &both(dM), &matrix(&state["mass_matrix_rate"]), quadratic.max(M.amax()));
    }
    if has("forward_dynamics") {
        // backward: the torque that mozzi's accelerations need by the oracle's M and h, against the torque given
        let found = theirs(model.forward_dynamics(&theta, &dtheta, &tau, &environment).unwrap());
        let needed = &M * &found + list("bias_forces");
        worst.add("θ̈", &needed, &list("tau"), M.amax() * found.amax() + bias);
    }
    let pose = model.forward_kinematics(&theta, tip).unwrap().to_matrix();
    worst.add("T", &DMatrix::from_fn(4, 4, |i, j| pose[i][j]), &matrix(&state["pose"]), 0.0);
    for (body, pose) in state.get("poses").and_then(Value::as_object).into_iter().flatten() {
        let found = model.forward_kinematics(&theta, model.frame(body).unwrap()).unwrap().to_matrix();
        worst.add("T, all", &DMatrix::from_fn(4, 4, |i, j| found[i][j]), &matrix(pose), 0.0);
    }
    let J = matrix(&state["space_jacobian"]);
    worst.add("J_s", &columns(model.space_jacobian(&theta, tip).unwrap()), &J, 0.0);
    worst.add("J_b", &columns(model.body_jacobian(&theta, tip).unwrap()), &matrix(&state["body_jacobian"]), J.amax());
    if has("space_jacobian_rate") {
        let rate = J.amax() * J.amax() * largest_square(&dtheta).sqrt();
        let found = columns(model.space_jacobian_rate(&theta, &dtheta, tip).unwrap());
        worst.add("J̇_s", &found, &matrix(&state["space_jacobian_rate"]), rate);
        let found = columns(model.body_jacobian_rate(&theta, &dtheta, tip).unwrap());
        worst.add("J̇_b", &found, &matrix(&state["body_jacobian_rate"]), rate);
    }
    if has("F_tip") {
        let F: [f64; 6] = vector(&state["F_tip"]).try_into().unwrap();
        let applied: [(FrameId, Wrench); 1] = [(tip, Wrench::from_array(F))];
        let size = J.amax() * largest_square(&F).sqrt();
        worst.add("JᵀF", &theirs(model.tip_forces(&theta, &applied).unwrap()), &list("tip_forces"), size);
        let pushing = Environment { applied: &applied, ..environment };
        let found = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &pushing).unwrap();
        worst.add("τ, F", &theirs(found), &list("inverse_dynamics_with_tip"), total + size);
    }
    derivatives::compare(model, order, [&theta, &dtheta, &ddtheta, &tau], oracle, state, worst);
    let number = |key: &str| column(&[state[key].as_f64().unwrap()]);
    let kinetic = model.kinetic_energy(&theta, &dtheta).unwrap();
    worst.add("K", &column(&[kinetic]), &number("kinetic_energy"), 0.0);
    if has("potential_energy") {
        // m g times the reach, of which the energies are differences
        let mass: f64 = model.description().links.iter().map(|link| link.inertia.mass).sum();
        let potential = column(&[model.potential_energy(&theta).unwrap()]);
        worst.add("P", &potential, &number("potential_energy"), 9.81 * mass * (1.0 + J.amax()));
    }
}

/// All states of a file of oracles; how its joints are ordered is looked up by name.
fn compare_all(name: &str, oracle: &Value, model: &Model) -> Worst {
    let names: Vec<&str> =
        oracle["joint_names"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    assert_eq!(oracle.get("floating").is_some(), model.is_floating(), "{name}: is the base floating?");
    let base = model.base().velocities();
    let of = |name: &&str| {
        let place = model.joint_names().position(|mine| mine == *name).unwrap();
        model.places()[place].velocities()
    };
    let order: Vec<usize> = (0..base).chain(names.iter().flat_map(of)).collect();
    assert_eq!(order.len(), model.n(), "{name}");
    if oracle.get("mjcf").is_some() {
        assert!(order.iter().copied().eq(0..model.n()), "{name}: joints are numbered as MuJoCo does");
    }
    let mut worst = Worst::default();
    oracle["states"].as_array().unwrap().iter().for_each(|state| compare(model, &order, oracle, state, &mut worst));
    let starts = oracle.get("starts").and_then(Value::as_array);
    starts.into_iter().flatten().for_each(|start| compare_start(name, model, start));
    worst
}

/// The start of MuJoCo, or one of its keys: the time, and each body's pose and twist.
fn compare_start(name: &str, model: &Model, expected: &Value) {
    let state = match expected["state"].as_str() {
        None => model.start(),
        Some(key) => model.state(key).unwrap(),
    };
    assert_eq!(Some(state.time), expected["time"].as_f64(), "{name}");
    for (body, pose) in expected["poses"].as_object().unwrap() {
        let frame = model.frame(body).unwrap();
        let found = model.forward_kinematics(&state.theta, frame).unwrap().to_matrix();
        let V = &model.body_jacobian(&state.theta, frame).unwrap() * &state.dtheta[..];
        let pose: Vec<f64> = pose.as_array().unwrap().iter().flat_map(vector).collect();
        let twist = vector(&expected["twists"][body]);
        for (found, expected) in [(found.as_flattened(), pose), (&V.to_array(), twist)] {
            let size = expected.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
            let is_close = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-12 * size;
            assert!(found.iter().zip(&expected).all(is_close), "{name}: `{body}`: {found:?}, expected {expected:?}");
        }
    }
}

/// Every file of a folder; a line for each robot, and the worst of all.
fn compare_folder(folder: &Path) {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| {
        let name = path.file_name().unwrap().to_string_lossy();
        name.ends_with(".json") && ["pinocchio_", "mujoco_", "mjcf_"].iter().any(|start| name.starts_with(start))
    });
    files.sort();
    assert!(!files.is_empty(), "no oracles in {}", folder.display());
    let mut failed = Vec::new();
    for path in files {
        let oracle: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let model = match model(&oracle) {
            Ok(model) => model,
            Err(reason) => {
                println!("{name:<34} refused: {reason}");
                continue;
            }
        };
        let worst = compare_all(&name, &oracle, &model);
        let states = oracle["states"].as_array().unwrap();
        println!("{name:<34} n {:>3}, {:>3} states: {}", model.n(), states.len(), worst.line());
        if worst.failed() {
            failed.push(name);
        }
    }
    assert!(failed.is_empty(), "normalised errors above {BOUND} (or NaN): {failed:?}");
}

#[test]
fn committed_numbers() {
    println!("worst normalised errors, in ε:");
    compare_folder(&repository().join("oracles"));
}

#[test]
fn a_hundred_states_of_real_robots() {
    match std::env::var_os("MOZZI_ORACLES") {
        Some(folder) => compare_folder(Path::new(&folder)),
        None => println!("skipped: MOZZI_ORACLES names no folder (cargo xtask test makes one)"),
    }
}
