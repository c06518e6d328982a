//! mozzi with a floating base against Pinocchio's free flyer and MuJoCo's free joint, by way of `mozzi::conventions`:
//! the committed numbers of `oracles/floating/`, and, if the folder named by the environment variable MOZZI_ORACLES has
//! a folder `floating` made by `oracles/make_floating.py`, a hundred states of every robot in it.
#![allow(clippy::unwrap_used)]

use crate::common;

use common::{BOUND, Worst, column, derivatives, largest_square, matrix, repository, vector};
use mozzi::conventions::{MuJoCo, Pinocchio};
use mozzi::{Base, Model, SE3, Wrench};
use nalgebra::{DMatrix, DVector};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The robot of a file of oracles, with a floating base: without rotors, and with those of the file. No friction.
fn models(oracle: &Value) -> Result<[Model; 2], String> {
    let path = match oracle.get("urdf_path").and_then(Value::as_str) {
        Some(path) => PathBuf::from(path),
        None => repository().join(oracle["urdf"].as_str().unwrap()),
    };
    let mut robot = mozzi_urdf::load(&path).map_err(|error| error.to_string())?.description;
    robot.base = Base::Floating;
    robot.end_effector = Some(oracle["tip_frame"].as_str().unwrap().into());
    assert_eq!(vector(&oracle["gravity"]), robot.gravity, "{}", path.display());
    let mut build = |rotors: &[f64]| {
        for joint in &mut robot.joints {
            (joint.damping, joint.friction, joint.armature) = (0.0, 0.0, 0.0);
        }
        for (name, inertia) in names(oracle).into_iter().zip(rotors) {
            robot.joints.iter_mut().find(|joint| joint.name == name).unwrap().armature = *inertia;
        }
        robot.clone().build().unwrap()
    };
    Ok([build(&[]), build(&vector(&oracle["rotors"]))])
}

fn names(oracle: &Value) -> Vec<&str> {
    oracle["joint_names"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect()
}

fn pose_matrix(T: SE3) -> DMatrix<f64> {
    let rows = T.to_matrix();
    DMatrix::from_fn(4, 4, |i, j| rows[i][j])
}

/// M g times the reach, of which potential energies are differences.
fn potential_size(model: &Model, reach: f64) -> f64 {
    9.81 * model.mass() * (1.0 + reach)
}

/// M_ij over √(M_ii M_jj), which no entry exceeds, so that a finger's inertia counts next to the robot's mass.
fn balanced(M: &DMatrix<f64>, reference: &DMatrix<f64>) -> DMatrix<f64> {
    let size = |i: usize, j: usize| (reference[(i, i)] * reference[(j, j)]).sqrt();
    DMatrix::from_fn(M.nrows(), M.ncols(), |i, j| if size(i, j) > 0.0 { M[(i, j)] / size(i, j) } else { M[(i, j)] })
}

/// Compares in Pinocchio's convention.
fn compare_pinocchio(model: &Model, theirs: &Pinocchio, oracle: &Value, state: &Value, worst: &mut Worst) {
    let list = |key: &str| vector(&state[key]);
    let theta = theirs.from_configuration(&list("q")).unwrap();
    let [dtheta, ddtheta] = ["v", "a"].map(|key| theirs.from_velocity(&list(key)).unwrap());
    let tau = theirs.from_force(&list("tau")).unwrap();
    let (theta, dtheta, ddtheta, tau) = (theta.as_slice(), dtheta.as_slice(), ddtheta.as_slice(), tau.as_slice());
    let (environment, tip) = (model.environment(), model.end_effector().unwrap());
    let force = |mine: DVector<f64>| theirs.force(mine.as_slice()).unwrap();

    let M = matrix(&state["M"]);
    let quadratic = M.amax() * largest_square(dtheta);
    let g = model.gravity_forces(theta).unwrap();
    let bias = quadratic + g.amax();
    let found = theirs.mass_matrix(&model.mass_matrix(theta).unwrap()).unwrap();
    worst.add("M", &found, &M, 0.0);
    worst.add("M_ij", &balanced(&found, &M), &balanced(&M, &M), 1.0);
    worst.add_list("g", force(g).as_slice(), &state["gravity"], 0.0);
    let h = force(model.bias_forces(theta, dtheta, &environment).unwrap());
    worst.add_list("h", h.as_slice(), &state["nle"], bias);
    let found = force(model.inverse_dynamics(theta, dtheta, ddtheta, &environment).unwrap());
    let size = M.amax() * largest_square(ddtheta).sqrt() + bias;
    worst.add_list("τ", found.as_slice(), &state["rnea"], size);
    let C = theirs.mass_matrix(&model.coriolis_matrix(theta, dtheta).unwrap()).unwrap();
    worst.add("C", &C, &matrix(&state["C"]), quadratic.max(M.amax()));
    let v = theirs.velocity(dtheta).unwrap();
    let Cv = matrix(&state["C"]) * &v;
    worst.add("Cθ̇", &column((C * v).as_slice()), &column(Cv.as_slice()), quadratic);
    if state.get("forward_dynamics").is_some() {
        // backward: the forces that mozzi's accelerations need by the oracle's M and h, against the forces given
        let found = model.forward_dynamics(theta, dtheta, tau, &environment).unwrap();
        let found = theirs.acceleration(found.as_slice()).unwrap();
        let needed = &M * &found + DVector::from_vec(list("nle"));
        worst.add_list("θ̈", needed.as_slice(), &state["tau"], M.amax() * found.amax() + bias);
    }

    worst.add("T", &pose_matrix(model.forward_kinematics(theta, tip).unwrap()), &matrix(&state["pose"]), 0.0);
    let J = matrix(&state["space_jacobian"]);
    let rate = J.amax() * J.amax() * largest_square(dtheta).sqrt();
    let mut jacobian = |what, mine: mozzi::Jacobian, key: &str, size| {
        worst.add(what, &theirs.jacobian(&mine).unwrap(), &matrix(&state[key]), size);
    };
    jacobian("J_s", model.space_jacobian(theta, tip).unwrap(), "space_jacobian", 0.0);
    jacobian("J_b", model.body_jacobian(theta, tip).unwrap(), "body_jacobian", J.amax());
    jacobian("J̇_s", model.space_jacobian_rate(theta, dtheta, tip).unwrap(), "space_jacobian_rate", rate);
    jacobian("J̇_b", model.body_jacobian_rate(theta, dtheta, tip).unwrap(), "body_jacobian_rate", rate);
    let F: [f64; 6] = list("force").try_into().unwrap();
    let pushed = force(model.tip_forces(theta, &[(tip, Wrench::from_linear_first(F))]).unwrap());
    worst.add_list("JᵀF", pushed.as_slice(), &state["tip_forces"], J.amax() * largest_square(&F).sqrt());

    worst.add_list("K", &[model.kinetic_energy(theta, dtheta).unwrap()], &state["kinetic_energy"], 0.0);
    let potential = model.potential_energy(theta).unwrap();
    worst.add_list("P", &[potential], &state["potential_energy"], potential_size(model, J.amax()));
    compare_centroidal(model, theirs, [theta, dtheta, ddtheta], state, worst);
    let velocities: Vec<usize> = [3, 4, 5, 0, 1, 2].into_iter().chain(theirs.joints().iter().map(|&j| 6 + j)).collect();
    derivatives::compare(model, &velocities, [theta, dtheta, ddtheta, tau], oracle, state, worst);
}

/// Pinocchio's centroidal quantities are linear first, in world axes.
fn compare_centroidal(model: &Model, theirs: &Pinocchio, state: [&[f64]; 3], record: &Value, worst: &mut Worst) {
    let ([theta, dtheta, ddtheta], A) = (state, matrix(&record["Ag"]));
    let fast = largest_square(dtheta);
    let momentum = A.amax() * fast.sqrt();
    let accelerated = A.amax() * (largest_square(ddtheta).sqrt() + fast);
    let c = model.center_of_mass(theta).unwrap();
    worst.add_list("c", &c.0, &record["com"], 0.0);
    let found = model.center_of_mass_velocity(theta, dtheta).unwrap();
    worst.add_list("ċ", &found.0, &record["vcom"], momentum / model.mass());
    let found = model.center_of_mass_acceleration(theta, dtheta, ddtheta).unwrap();
    worst.add_list("c̈", &found.0, &record["acom"], accelerated / model.mass());
    let mine = model.centroidal_momentum_matrix(theta).unwrap();
    let rows: Vec<DVector<f64>> =
        [3, 4, 5, 0, 1, 2].iter().map(|&row| theirs.force(mine.row(row).transpose().as_slice()).unwrap()).collect();
    worst.add("A_G", &DMatrix::from_fn(6, model.n(), |i, k| rows[i][k]), &A, 0.0);
    let found = model.momentum(theta, dtheta, c).unwrap().to_linear_first();
    worst.add_list("h_G", &found, &record["hg"], momentum);
    let found = model.centroidal_momentum_bias(theta, dtheta).unwrap();
    let found = Wrench::from_array(found.as_slice().try_into().unwrap()).to_linear_first();
    worst.add_list("Ȧ_Gθ̇", &found, &record["dAg_v"], A.amax() * fast);
}

/// Compares in MuJoCo's convention.
fn compare_mujoco(model: &Model, theirs: &MuJoCo, state: &Value, worst: &mut Worst) {
    let list = |key: &str| vector(&state[key]);
    let [qpos, qvel, qacc, qfrc] = ["qpos", "qvel", "qacc", "qfrc_applied"].map(list);
    let theta = theirs.from_configuration(&qpos).unwrap();
    let dtheta = theirs.from_velocity(&qpos, &qvel).unwrap();
    let ddtheta = theirs.from_acceleration(&qpos, &qvel, &qacc).unwrap();
    let tau = theirs.from_force(&qpos, &qfrc).unwrap();
    let (theta, dtheta, ddtheta, tau) = (theta.as_slice(), dtheta.as_slice(), ddtheta.as_slice(), tau.as_slice());
    let (environment, tip) = (model.environment(), model.end_effector().unwrap());

    let (mine, M) = (model.mass_matrix(theta).unwrap(), matrix(&state["M"]));
    let found = theirs.mass_matrix(theta, &mine).unwrap();
    worst.add("M", &found, &M, 0.0);
    worst.add("M_ij", &balanced(&found, &M), &balanced(&M, &M), 1.0);
    let back = theirs.from_mass_matrix(&qpos, &M).unwrap();
    worst.add("M, back", &back, &mine, 0.0);
    let bias = M.amax() * largest_square(dtheta) + model.gravity_forces(theta).unwrap().amax();
    let h = model.bias_forces(theta, dtheta, &environment).unwrap();
    let found = theirs.bias_forces(theta, dtheta, &mine, h.as_slice()).unwrap();
    worst.add_list("h", found.as_slice(), &state["qfrc_bias"], bias);
    let back = theirs.from_bias_forces(&qpos, &qvel, &mine, &list("qfrc_bias")).unwrap();

    worst.add("h, back", &column(back.as_slice()), &column(h.as_slice()), bias);
    let found = model.inverse_dynamics(theta, dtheta, ddtheta, &environment).unwrap();
    let found = theirs.force(theta, found.as_slice()).unwrap();
    let size = M.amax() * largest_square(&qacc).sqrt() + bias;
    worst.add_list("τ", found.as_slice(), &state["qfrc_inverse"], size);
    let found = model.forward_dynamics(theta, dtheta, tau, &environment).unwrap();
    let found = theirs.acceleration(theta, dtheta, found.as_slice()).unwrap();
    let needed = &M * &found + DVector::from_vec(list("qfrc_bias"));
    worst.add_list("θ̈", needed.as_slice(), &state["qfrc_applied"], M.amax() * found.amax() + bias);

    worst.add("T", &pose_matrix(model.forward_kinematics(theta, tip).unwrap()), &matrix(&state["pose"]), 0.0);
    let J = model.body_jacobian(theta, tip).unwrap();
    let size = J.matrix().amax() * largest_square(dtheta).sqrt();
    worst.add_list("𝒱_b", &(&J * dtheta).to_array(), &state["tip_velocity"], size);
    worst.add_list("K", &[model.kinetic_energy(theta, dtheta).unwrap()], &state["kinetic_energy"], 0.0);
    let potential = model.potential_energy(theta).unwrap();
    worst.add_list("P", &[potential], &state["potential_energy"], potential_size(model, J.matrix().amax()));

    let (c, A) = (model.center_of_mass(theta).unwrap(), model.centroidal_momentum_matrix(theta).unwrap().amax());
    let size = A * largest_square(dtheta).sqrt();
    worst.add_list("c", &c.0, &state["subtree_com"], 0.0);
    let found = model.center_of_mass_velocity(theta, dtheta).unwrap();
    worst.add_list("ċ", &found.0, &state["subtree_linvel"], size / model.mass());
    let found = model.momentum(theta, dtheta, c).unwrap();
    worst.add_list("h_G", &found.m.0, &state["subtree_angmom"], size);
}

/// The worst errors of a robot, over all its states.
fn compare(oracle: &Value, models: &[Model; 2]) -> Worst {
    let (names, mut worst) = (names(oracle), Worst::default());
    let each = |compare: &mut dyn FnMut(&Model, &Value)| {
        for state in oracle["states"].as_array().unwrap() {
            compare(&models[usize::from(state["has_rotors"].as_bool().unwrap())], state);
        }
    };
    if oracle["library"].as_str().unwrap().starts_with("mujoco") {
        let theirs = MuJoCo::with_joints(&models[0], &names).unwrap();
        each(&mut |model, state| compare_mujoco(model, &theirs, state, &mut worst));
    } else {
        let nqs: Vec<usize> = vector(&oracle["nqs"]).iter().map(|&nq| nq as usize).collect();
        let theirs = Pinocchio::with_joints(&models[0], &names, &nqs).unwrap();
        // Pinocchio's reading of the file is predicted without it
        let guessed = Pinocchio::new(&models[0]).unwrap();
        assert_eq!(guessed.joints(), theirs.joints(), "{}", oracle["robot"]);
        // four wheels of Centauro are `revolute` with limits that hold no bound: continuous here, one position there
        let unlike = if oracle["robot"] == "centauro" { 4 } else { 0 };
        assert_eq!(guessed.nq(), theirs.nq() + unlike, "{}", oracle["robot"]);
        each(&mut |model, state| compare_pinocchio(model, &theirs, oracle, state, &mut worst));
    }
    worst
}

/// Every file of a folder; a line for each robot, and the worst of all.
fn compare_folder(folder: &Path) {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|ending| ending == "json"));
    files.sort();
    assert!(!files.is_empty(), "no oracles in {}", folder.display());
    let mut failed = Vec::new();
    for path in files {
        let oracle: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        match models(&oracle) {
            Ok(models) => {
                let worst = compare(&oracle, &models);
                let (n, states) = (models[0].n(), oracle["states"].as_array().unwrap().len());
                println!("{name:<28} n {n:>3}, {states:>3} states: {}", worst.line());
                failed.extend(worst.failed().then_some(name));
            }
            Err(reason) => {
                println!("{name:<28} refused: {reason}");
                failed.push(name);
            }
        }
    }
    assert!(failed.is_empty(), "normalised errors above {BOUND} (or NaN), or refused: {failed:?}");
}

#[test]
fn committed_numbers() {
    println!("floating base, worst normalised errors, in ε:");
    compare_folder(&repository().join("oracles/floating"));
}

#[test]
fn a_hundred_states_of_legged_and_flying_robots() {
    let folder = std::env::var_os("MOZZI_ORACLES").map(|folder| Path::new(&folder).join("floating"));
    match folder.filter(|folder| folder.is_dir()) {
        Some(folder) => compare_folder(&folder),
        None => println!("skipped: MOZZI_ORACLES names no folder with one called floating (cargo xtask test makes it)"),
    }
}
