//! Springs, and the refinement on rollouts.

use crate::common;

use common::{UNFILTERED, motion, robot, truth, with_forces};
use mozzi::random::Random;
use mozzi::{Description, Environment, Model, SpatialInertia, Sym3, Vec3, Wrench};
use mozzi_identify::{Choice, Columns, Kind, Log, Options, RefineOptions, Sensor, describe, identify, refine};

#[test]
fn rollouts_refine_what_forces_left_wrong() {
    let model = robot("double_pendulum");
    let choice = Choice::all(Sensor::Motor);
    let columns = Columns::new(&model, choice.clone()).expect("columns");
    let x = truth(&columns, 3);
    let log = motion(&model, 10.0, 200.0, 1.0, 3);
    let log = with_forces(&log, &model, &choice, &x, &[0.03, 0.01], &mut Random(1));
    let options = Options { choice, filter: UNFILTERED, ..Options::default() };
    let mut found = identify(&model, &[log], &options, &|| false).expect("an identification");
    // links that are 5 % too heavy
    let exact = found.estimates.consistent.x.clone();
    for first in found.setup.columns.bodies() {
        found.estimates.consistent.x[first..first + 10].iter_mut().for_each(|x| *x *= 1.05);
    }
    let refined = refine(&found, &RefineOptions::default(), &|| false).expect("a refinement");
    eprintln!("errors {:?} become {:?}", refined.before, refined.after);
    let sum = |errors: &[Vec<f64>; 2]| errors.iter().flatten().sum::<f64>();
    assert!(sum(&refined.after) < 0.3 * sum(&refined.before));
    let far = |x: &[f64]| {
        let (a, b) = (found.setup.base.values(x), found.setup.base.values(&exact));
        (a - b).norm()
    };
    assert!(far(&refined.x) < 0.3 * far(&found.estimates.consistent.x));
}

/// A double pendulum whose first joint has a spring at rest at 2 N m / k.
fn with_spring(k: f64) -> Description {
    let mut pendulum = mozzi_urdf::open("double_pendulum").expect("embedded").description;
    (pendulum.joints[0].stiffness, pendulum.joints[0].spring_reference) = (k, 2.0 / k);
    pendulum
}

/// A motion with the exact forces of a robot.
fn exact(model: &Model, seed: u64, applied: &[(mozzi::FrameId, Wrench)]) -> Log {
    let (n, mut log) = (model.n(), motion(model, 10.0, 200.0, 1.0, seed));
    let environment = Environment { applied, ..model.environment() };
    for row in (0..log.rows()).map(|k| k * n..(k + 1) * n) {
        let [dtheta, ddtheta] = [&log.dtheta, &log.ddtheta].map(|table| &table.as_ref().expect("a table")[row.clone()]);
        log.tau
            .extend(&model.inverse_dynamics(&log.theta[row.clone()], dtheta, ddtheta, &environment).expect("forces"));
    }
    log
}

#[test]
fn the_rest_of_a_spring_stays_where_the_file_has_it() {
    let model = with_spring(5.0).build().expect("sound");
    let choice = Choice { stiffness: true, ..Choice::all(Sensor::Link) };
    for (log, choice) in [
        (exact(&model, 3, &[]), Choice::all(Sensor::Link)),
        (exact(&with_spring(7.0).build().expect("sound"), 3, &[]), choice),
    ] {
        let options = Options { choice, filter: UNFILTERED, trust_log: true, ..Options::default() };
        let found = identify(&model, std::slice::from_ref(&log), &options, &|| false).expect("an identification");
        let (columns, x) = (&found.setup.columns, &found.estimates.consistent.x);
        let is_same_spring = !columns.choice.stiffness;
        assert!(!is_same_spring || found.fitted.robot[0] < 1e-9, "{:?}", found.fitted.robot);
        let offset = x[columns.index(Kind::Offset(0)).expect("an offset")];
        assert!(offset.abs() < 0.05, "{offset}");
        let (written, _) = describe(columns, x, model.description()).expect("a robot");
        let [k, rest] = [written.joints[0].stiffness, written.joints[0].spring_reference];
        assert!(
            (k * rest - 2.0).abs() < 1e-9 && (k - if is_same_spring { 5.0 } else { 7.0 }).abs() < 0.1,
            "{k} {rest}"
        );
    }
}

/// A spring's preload, a known payload, measured wrenches, saturated forces, and a part that is held out.
#[test]
fn rollouts_are_those_of_the_robot_of_each_log() {
    let model = with_spring(5.0).build().expect("sound");
    let tip = model.frame("tip").expect("a frame");
    let body = SpatialInertia::new(2.0, Vec3::zero(), Sym3::diagonal(0.01, 0.01, 0.01));
    let applied = [(tip, Wrench::from_array([0.0, 1.0, 0.0, 5.0, 0.0, 9.0]))];
    let loaded =
        Log { payload: Some((tip, body)), ..exact(&model.with_payload(tip, body).expect("a payload"), 4, &[]) };
    let mut pushed = exact(&model, 5, &applied);
    pushed.wrenches = vec![(tip, applied[0].1.to_array().repeat(pushed.rows()))];
    let mut logs = [exact(&model, 3, &[]), loaded, pushed];
    let rows = logs[0].rows();
    let most = logs[0].tau.iter().copied().fold(0.0, f64::max);
    logs[0].tau[rows + 2..].iter_mut().for_each(|tau| *tau = (*tau + 1.0).min(most));
    (rows / 4..rows / 4 + 40).for_each(|row| logs[0].tau[2 * row] = most);
    let options = Options {
        choice: Choice::all(Sensor::Link),
        filter: UNFILTERED,
        trust_log: true,
        tenths: 5,
        ..Options::default()
    };
    let found = identify(&model, &logs, &options, &|| false).expect("an identification");
    let refined = refine(&found, &RefineOptions { iterations: 1, ..RefineOptions::default() }, &|| false);
    let [theta, _] = refined.expect("a refinement").before;
    assert!(theta.iter().all(|error| *error < 5e-3), "{theta:?}");
}
