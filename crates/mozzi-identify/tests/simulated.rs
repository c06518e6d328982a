//! Robots whose parameters are known, with logs made of them.

use crate::common;

use common::{UNFILTERED, floating_motion, humanoid, motion, normal, robot, truth, with_forces};
use mozzi::random::Random;
use mozzi::{Environment, Model, SpatialInertia, Vec3, Wrench};
use mozzi_identify::signals::{Cutoff, Filter, prepare};
use mozzi_identify::{
    Choice, Columns, Compressed, Equations, Evidence, Kind, Limits, Log, Options, Sensor, Setup, identified, identify,
    predict,
};

fn largest_error(found: &[f64], expected: &[f64], deviations: &[f64]) -> f64 {
    found.iter().zip(expected).zip(deviations).map(|((a, b), d)| (a - b).abs() / d).fold(0.0, f64::max)
}

#[test]
fn without_noise_base_parameters_are_exact() {
    for (name, sensor) in [("ur5", Sensor::Motor), ("double_pendulum", Sensor::Link), ("furuta_pendulum", Sensor::Link)]
    {
        let model = robot(name);
        let choice = Choice { stribeck: Some(0.2), stiffness: name != "ur5", ..Choice::all(sensor) };
        let columns = Columns::new(&model, choice.clone()).expect("columns");
        let x = truth(&columns, 3);
        let log = motion(&model, 8.0, 100.0, 1.0, 3);
        let log = with_forces(&log, &model, &choice, &x, &vec![0.0; model.n()], &mut Random(1));
        let options = Options { choice, filter: UNFILTERED, prior: 1e-9, ..Options::default() };
        let found = identify(&model, &[log], &options, &|| false).expect("an identification");
        let expected = found.setup.base.values(&x);
        let scale = vec![expected.amax(); expected.len()];
        let error = largest_error(&found.estimates.least_squares.values, expected.as_slice(), &scale);
        eprintln!("{name}: {error:e}");
        assert!(error < 1e-8, "{name}: {error:e}");
        // the second way: inverse dynamics of the identified robot instead of the equations
        for x in [&found.estimates.least_squares.x, &found.estimates.consistent.x] {
            let predicted = predict(&found.setup.columns, x, &found.samples[0]).expect("forces");
            let rms = (predicted.iter().map(|x| x * x).sum::<f64>() / predicted.len() as f64).sqrt();
            let error = predicted.iter().zip(&found.samples[0].tau).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-3 * rms, "{name}: {error:e} of {rms}");
        }
    }
}

/// By base parameter, the percentage of runs whose interval of 95 % contains the truth. A run is a log of its own noise
/// in τ, of another size for each joint.
fn shares(name: &str, runs: u64, log: &Log, filter: &Filter) -> Vec<f64> {
    let model = robot(name);
    let choice = Choice::all(Sensor::Motor);
    let setup = Setup::new(&model, choice.clone(), 0.3, &Limits::default()).expect("a setup");
    let x = truth(&setup.columns, 5);
    let noise: Vec<f64> = (0..model.n()).map(|j| 1.0 / (1 + j) as f64).collect();
    let expected = setup.base.values(&x);
    let quiet = with_forces(log, &model, &choice, &x, &vec![0.0; model.n()], &mut Random(1));
    let one = |run: u64| -> Vec<bool> {
        let (mut random, mut log) = (Random(1000 + run), quiet.clone());
        log.tau.iter_mut().enumerate().for_each(|(i, tau)| *tau += noise[i % noise.len()] * normal(&mut random));
        let (samples, _) = prepare(&model, &log, filter).expect("samples");
        let compressed = [Compressed::new(&setup.columns, &setup.pattern, &samples, None).expect("equations")];
        let evidence = Evidence::new(&setup.pattern, setup.columns.count(), &compressed, |_, _| true);
        let found = mozzi_identify::estimate::least_squares::LeastSquares::new(&evidence, &setup.base).expect("values");
        (0..expected.len()).map(|k| (found.values[k] - expected[k]).abs() < 1.96 * found.deviations[k]).collect()
    };
    let mut inside = vec![0; expected.len()];
    std::thread::scope(|scope| {
        let of = |first: u64| (first..runs).step_by(2).map(one).collect::<Vec<_>>();
        let halves = [scope.spawn(move || of(0)), scope.spawn(move || of(1))];
        for half in halves.map(|half| half.join().expect("runs")) {
            half.iter().for_each(|run| run.iter().enumerate().for_each(|(k, is_in)| inside[k] += u64::from(*is_in)));
        }
    });
    let shares: Vec<f64> = inside.iter().map(|&count| 100.0 * count as f64 / runs as f64).collect();
    let (low, high) = shares.iter().fold((100.0_f64, 0.0_f64), |(a, b), &x| (a.min(x), b.max(x)));
    eprintln!(
        "{name}: {} base parameters, each in {low:.1} to {high:.1} % of {runs} runs, mean {:.2} %",
        shares.len(),
        shares.iter().sum::<f64>() / shares.len() as f64
    );
    shares
}

#[test]
fn intervals_of_95_percent_contain_the_truth_in_95_percent_of_runs() {
    for (name, runs, duration) in [("double_pendulum", 1000, 4.0), ("ur5", 500, 3.0)] {
        let shares = shares(name, runs, &motion(&robot(name), duration, 50.0, 1.5, 11), &UNFILTERED);
        // a share of so many runs is within three of its own deviations, and some room for the largest of all
        let room = 100.0 * 3.2 * (0.95 * 0.05 / runs as f64).sqrt();
        assert!(shares.iter().all(|share| (share - 95.0).abs() <= room), "{name}: {shares:?}");
    }
}

/// A filter leaves few independent samples of the noise, of which the parameters fit a part: a quarter in the arm's.
#[test]
fn intervals_hold_for_filtered_noise_and_short_logs() {
    for (name, runs, duration, cutoff) in
        [("double_pendulum", 300, 20.0, 5.0), ("double_pendulum", 300, 5.0, 3.0), ("ur5", 60, 8.0, 3.0)]
    {
        let filter = Filter { cutoff: Cutoff::Hz(cutoff), ..Filter::default() };
        let shares = shares(name, runs, &motion(&robot(name), duration, 100.0, 0.7, 11), &filter);
        let mean = shares.iter().sum::<f64>() / shares.len() as f64;
        assert!((mean - 95.0).abs() < 2.0, "{name}, {duration} s: {shares:?}");
    }
}

/// Light and heavy, on the last joint's axis and beside it, with much noise and with hardly any, where the data's cost
/// at the start is 10⁷ times the prior's; with rotors that the file lacks.
#[test]
fn a_payload_is_weighed() {
    let model = robot("ur5");
    let tool = model.end_effector().expect("a tool");
    let choice = Choice::only_payload(tool, Sensor::Motor);
    let of_robot = Choice { links: false, payload: None, ..Choice::only_friction(Sensor::Motor) };
    for (mass, center, noise) in [
        (2.5, [0.02, -0.01, 0.06], 0.2),
        (3.0, [0.0, 0.1, 0.15], 0.02),
        (5.0, [0.0, 0.0, 0.1], 0.02),
        (3.0, [0.05, 0.0, 0.15], 1e-4),
    ] {
        let body = SpatialInertia::new(mass, Vec3(center), mozzi::Sym3::diagonal(0.01, 0.012, 0.006));
        let loaded = model.with_payload(tool, body).expect("a payload");
        let log = motion(&model, 10.0, 100.0, 1.0, 2);
        let columns = Columns::new(&loaded, of_robot.clone()).expect("columns");
        let log = with_forces(&log, &loaded, &of_robot, &vec![0.4; columns.count()], &[noise; 6], &mut Random(9));
        let options = Options { choice: choice.clone(), filter: UNFILTERED, ..Options::default() };
        let found = identify(&model, &[log], &options, &|| false).expect("an identification");
        let first = found.setup.columns.index(Kind::Payload(0)).expect("a payload");
        let optimum = &found.estimates.consistent;
        let payload = &optimum.x[first..first + 10];
        eprintln!("payload {payload:.4?}, {} steps", optimum.steps);
        assert!(!optimum.is_astray && found.left_out.is_some(), "{:?}", found.findings);
        assert!((payload[0] - mass).abs() < 0.03, "{payload:?}");
        for i in 0..3 {
            assert!((payload[1 + i] / payload[0] - center[i]).abs() < 0.01, "{payload:?}");
        }
        let robot = identified(&found.setup.columns, &optimum.x).expect("a robot");
        assert!((robot.mass() - loaded.mass()).abs() < 0.03);
    }
}

#[test]
fn drive_gains_follow_from_a_known_payload() {
    let model = robot("ur5");
    let tool = model.end_effector().expect("a tool");
    let known = SpatialInertia::new(4.0, Vec3([0.0, 0.03, 0.1]), mozzi::Sym3::diagonal(0.02, 0.02, 0.01));
    let choice = Choice { gains: true, ..Choice::all(Sensor::Motor) };
    let without = Choice { gains: false, ..choice.clone() };
    let x = truth(&Columns::new(&model, without.clone()).expect("columns"), 8);
    let gains = [12.0, 11.0, 9.0, 5.0, 4.0, 3.0];
    let mut logs = Vec::new();
    for (seed, payload) in [(2, None), (3, Some((tool, known)))] {
        let mut log = motion(&model, 10.0, 100.0, 1.0, seed);
        log.payload = payload;
        let columns = Columns::new(&model, without.clone()).expect("columns");
        let mut forces = with_forces(&log, &model, &without, &x, &[0.0; 6], &mut Random(1));
        if payload.is_some() {
            let (samples, _) = mozzi_identify::signals::prepare(&model, &forces, &UNFILTERED).expect("samples");
            forces.tau = predict(&columns, &x, &samples).expect("forces");
        }
        let mut random = Random(seed);
        forces.tau.iter_mut().enumerate().for_each(|(k, tau)| *tau = *tau / gains[k % 6] + 0.001 * normal(&mut random));
        forces.payload = payload;
        logs.push(forces);
    }
    let options = Options { choice, filter: UNFILTERED, prior: 1e-3, ..Options::default() };
    let found = identify(&model, &logs, &options, &|| false).expect("an identification");
    for (j, gain) in gains.iter().enumerate() {
        let k = found.setup.columns.index(Kind::Gain(j)).expect("a gain");
        let (a, b) = (found.estimates.least_squares.x[k], found.estimates.consistent.x[k]);
        eprintln!("gain {} of {gain}: least squares {a:.3}, consistent {b:.3}", j + 1);
        assert!((b / gain - 1.0).abs() < 0.03, "{b} instead of {gain}");
    }
    let error = identify(&model, &logs[..1], &options, &|| false).expect_err("no payload").to_string();
    assert!(error.contains("known mass"), "{error}");
}

#[test]
fn mimic_joints_count_with_their_source() {
    let model = robot("panda"); // its second finger follows the first
    assert!(model.has_mimic_joints());
    let choice = Choice::all(Sensor::Motor);
    let columns = Columns::new(&model, choice.clone()).expect("columns");
    let x = truth(&columns, 4);
    let log = motion(&model, 10.0, 60.0, 1.0, 5);
    let log = with_forces(&log, &model, &choice, &x, &vec![0.0; model.n()], &mut Random(1));
    let options = Options { choice, filter: UNFILTERED, ..Options::default() };
    let found = identify(&model, &[log], &options, &|| false).expect("an identification");
    let expected = found.setup.base.values(&x);
    let scale = vec![expected.amax(); expected.len()];
    let error = largest_error(&found.estimates.least_squares.values, expected.as_slice(), &scale);
    assert!(error < 1e-8, "{error:e}");
}

/// A humanoid on one foot: no motor drives its base, the wrench at the foot is measured.
fn standing(model: &Model, log: &mut Log, x: &[f64], choice: &Choice, noise: f64) {
    let (n, nq) = (model.n(), model.nq());
    let foot = model.frame("left_leg6").expect("a foot");
    let quiet = with_forces(log, model, choice, x, &vec![0.0; n], &mut Random(1));
    let (mut random, mut wrench) = (Random(3), Vec::new());
    log.tau.clear();
    for k in 0..log.rows() {
        let theta = &quiet.theta[k * nq..(k + 1) * nq];
        let tau = &quiet.tau[k * n..(k + 1) * n];
        // JᵀF cancels the base's six rows
        let J = model.body_jacobian(theta, foot).expect("a Jacobian");
        let base = J.matrix().columns(0, 6).transpose();
        let F = base.lu().solve(&-nalgebra::DVector::from_column_slice(&tau[..6])).expect("regular");
        let applied = [(foot, Wrench::from_array(core::array::from_fn(|i| F[i])))];
        let environment = Environment { applied: &applied, ..Environment::with_gravity(Vec3::zero()) };
        let zeros = vec![0.0; n];
        let without = model.with_parameters(&vec![0.0; model.parameter_count()]);
        let JtF = without.inverse_dynamics(theta, &zeros, &zeros, &environment).expect("lengths");
        log.tau.extend((0..n).map(|j| tau[j] + JtF[j] + if j < 6 { 0.0 } else { noise * normal(&mut random) }));
        wrench.extend(F.iter().map(|f| f + noise * normal(&mut random)));
    }
    log.wrenches = vec![(foot, wrench)];
}

#[test]
fn a_floating_base_is_identified_by_its_contact_wrench() {
    let model = humanoid();
    assert_eq!(model.n(), 26);
    let choice = Choice::all(Sensor::Link);
    let columns = Columns::new(&model, choice.clone()).expect("columns");
    let x = truth(&columns, 6);
    let mut log = floating_motion(&model, 6.0, 50.0, 4);
    standing(&model, &mut log, &x, &choice, 1e-9);
    let options = Options { choice, filter: UNFILTERED, ..Options::default() };
    let found = identify(&model, &[log], &options, &|| false).expect("an identification");
    let expected = found.setup.base.values(&x);
    let scale = vec![expected.amax(); expected.len()];
    let error = largest_error(&found.estimates.least_squares.values, expected.as_slice(), &scale);
    eprintln!("humanoid: {} unknowns, {} base, error {error:e}", found.setup.columns.count(), expected.len());
    assert!(error < 1e-6, "{error:e}");
    let robot = identified(&found.setup.columns, &found.estimates.consistent.x).expect("a robot");
    let mass: f64 = columns.bodies().iter().map(|&k| x[k]).sum();
    assert!((robot.mass() / mass - 1.0).abs() < 0.01, "{} kg instead of {mass}", robot.mass());
}

#[test]
fn limits_hold_and_contradictions_are_named() {
    let model = robot("ur5");
    let choice = Choice::all(Sensor::Link);
    let columns = Columns::new(&model, choice.clone()).expect("columns");
    let x = truth(&columns, 3);
    let log = motion(&model, 8.0, 100.0, 1.0, 3);
    let log = with_forces(&log, &model, &choice, &x, &[0.5; 6], &mut Random(1));
    let name = columns.unknowns[10].name.clone();
    let link = name.trim_end_matches(".m").to_string();
    let run = |limits: Limits| {
        let options = Options { choice: choice.clone(), filter: UNFILTERED, limits, ..Options::default() };
        identify(&model, std::slice::from_ref(&log), &options, &|| false)
    };
    let found =
        run(Limits { between: vec![(name.clone(), [1.0, 2.0])], ..Limits::default() }).expect("an identification");
    let mass = found.estimates.consistent.x[10];
    assert!(mass > 1.0 && mass < 2.0, "{mass}");
    let found = run(Limits { total_mass: Some([17.0, 1e-3]), ..Limits::default() }).expect("an identification");
    let total: f64 = found.setup.columns.bodies().iter().map(|&k| found.estimates.consistent.x[k]).sum();
    assert!((total - 17.0).abs() < 0.01, "{total}");
    let bounds = vec![(link, [[-0.5, -0.1, -0.05], [0.0, 0.1, 0.05]])];
    let found = run(Limits { center_of_mass: bounds, ..Limits::default() });
    match found {
        Ok(found) => {
            let x = &found.estimates.consistent.x;
            assert!((1..4).all(|k| x[10 + k].abs() <= 0.5 * x[10]), "{:?}", &x[10..14]);
        }
        Err(error) => panic!("{error}"),
    }
    let twice = vec![(name.clone(), [1.0, 2.0]), (name, [3.0, 4.0])];
    let error = run(Limits { between: twice, ..Limits::default() }).expect_err("a contradiction").to_string();
    assert!(error.contains("contradict"), "{error}");
}

/// A wrist whose last motor turns with the joint before it, too: its rotor's friction and inertia act on both.
#[test]
fn the_rotor_of_a_coupled_wrist_is_identified() {
    use mozzi::model::description::{Gear, Rotor};
    let mut description = mozzi_urdf::open("ur5").expect("embedded").description;
    let joints: Vec<String> = description.joints.iter().map(|joint| joint.name.clone()).collect();
    let of = |name: &str| joints.iter().find(|joint| joint.contains(name)).expect("a joint").clone();
    let gears = [of("wrist_2"), of("wrist_3")].map(|joint| Gear { joint, ratio: 1.0 }).to_vec();
    let alone = description.clone().build().expect("sound");
    description.rotors.push(Rotor { name: "motor6".into(), armature: 0.0, gears });
    let model = description.build().expect("sound");
    let choice = Choice::all(Sensor::Motor);
    let columns = Columns::new(&model, choice.clone()).expect("columns");
    let mut x = columns.prior();
    let index = |name: &str| columns.unknowns.iter().position(|unknown| unknown.name == name).expect(name);
    (0..x.len()).filter(|&k| columns.unknowns[k].name.ends_with("_joint.friction")).for_each(|k| x[k] = 1.0);
    let truth = [("motor6.armature", 0.15), ("motor6.damping", 0.8), ("motor6.friction", 1.2)];
    truth.iter().for_each(|(name, value)| x[index(name)] = *value);
    let log = motion(&model, 10.0, 100.0, 1.0, 4);
    let log = with_forces(&log, &model, &choice, &x, &[0.05; 6], &mut Random(2));
    let options = Options { choice: choice.clone(), filter: UNFILTERED, ..Options::default() };
    let found = identify(&model, std::slice::from_ref(&log), &options, &|| false).expect("an identification");
    for (name, value) in truth {
        let identified = found.estimates.consistent.x[index(name)];
        eprintln!("{name}: {identified:.4} of {value}");
        assert!((identified / value - 1.0).abs() < 0.05, "{name}: {identified} of {value}");
    }
    // the second way: inverse dynamics instead of the equations; and the robot without the rotor explains less
    let rms = |tau: &[f64]| (tau.iter().map(|x| x * x).sum::<f64>() / tau.len() as f64).sqrt();
    let predicted = predict(&found.setup.columns, &found.estimates.consistent.predicting(), &found.samples[0]);
    let rest: Vec<f64> = predicted.expect("forces").iter().zip(&found.samples[0].tau).map(|(a, b)| a - b).collect();
    assert!(rms(&rest) < 0.06, "{}", rms(&rest));
    // also where dry friction passes a filter
    let filter = Filter { cutoff: Cutoff::Hz(10.0), ..UNFILTERED };
    let (samples, _) = prepare(&model, &log, &filter).expect("samples");
    let (n, P) = (model.n(), columns.count());
    let mut equations = Equations::new(&columns, &samples).expect("equations");
    let (mut A, mut b, found_there) =
        (vec![0.0; n * P], vec![0.0; n], predict(&columns, &x, &samples).expect("forces"));
    for k in 0..samples.count() {
        equations.fill(&samples, k, &mut A, &mut b);
        for j in 0..n {
            let force: f64 = (0..P).map(|c| A[j * P + c] * x[c]).sum();
            let fixed = samples.tau[k * n + j] - b[j];
            assert!((force + fixed - found_there[k * n + j]).abs() < 1e-9, "{k} {j}");
        }
    }
    let without = identify(&alone, &[log], &options, &|| false).expect("an identification");
    assert!(without.fitted.consistent[4] > 5.0 * found.fitted.consistent[4]);
}
