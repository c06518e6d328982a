//! Mistakes in logs are reported, and only those.

use crate::common;

use common::{cases, edited, floating_motion, humanoid, simulated};
use core::f64::consts::TAU;
use mozzi::{Environment, Model, SO3, Vec3, Wrench};
use mozzi_identify::judgement::judge;
use mozzi_identify::signals::{Cutoff, Filter, prepare};
use mozzi_identify::{Choice, Error, Finding, Level, Log, Options, Sensor, identify};

const MISTAKES: [&str; 8] = ["swapped_joints", "sign", "unit", "scale", "gravity", "offset", "limits", "wrench"];

fn codes(model: &Model, log: &Log, cutoff: f64) -> Vec<&'static str> {
    findings(model, log, cutoff).into_iter().map(|finding| finding.code).collect()
}

fn texts(model: &Model, log: &Log, cutoff: f64) -> Vec<String> {
    findings(model, log, cutoff).into_iter().map(|finding| finding.text).collect()
}

fn findings(model: &Model, log: &Log, cutoff: f64) -> Vec<Finding> {
    let filter = Filter { cutoff: Cutoff::Hz(cutoff), ..Filter::default() };
    // faults are warnings then
    let options = Options { filter, choice: Choice::all(Sensor::Link), trust_log: true, ..Options::default() };
    let found = identify(model, std::slice::from_ref(log), &options, &|| false).expect("an identification");
    let judged = judge(&found, std::slice::from_ref(log)).expect("a judgement");
    let all = found
        .findings
        .iter()
        .chain(&judged.findings)
        .filter(|finding| MISTAKES.contains(&finding.code) || finding.code == "causal_filter");
    all.cloned().inspect(|finding| eprintln!("{finding}")).collect()
}

#[test]
fn simulated_logs_with_a_mistake_say_which() {
    let (model, log) = simulated();
    let n = model.n();
    assert_eq!(codes(&model, &edited(&log, n, |_, _, _| {}), 8.0), Vec::<&str>::new());
    let swapped = edited(&log, n, |theta, dtheta, tau| [theta, dtheta, tau].into_iter().for_each(|x| x.swap(1, 2)));
    assert!(codes(&model, &swapped, 8.0).contains(&"swapped_joints"));
    assert!(codes(&model, &edited(&log, n, |_, _, tau| tau.swap(2, 3)), 8.0).contains(&"swapped_joints"));
    assert!(codes(&model, &edited(&log, n, |_, dtheta, _| dtheta.swap(0, 4)), 8.0).contains(&"swapped_joints"));
    assert!(codes(&model, &edited(&log, n, |_, _, tau| tau[1] = -tau[1]), 8.0).contains(&"sign"));
    assert!(codes(&model, &edited(&log, n, |_, dtheta, _| dtheta[3] = -dtheta[3]), 8.0).contains(&"sign"));
    assert!(codes(&model, &edited(&log, n, |_, _, tau| tau.iter_mut().for_each(|x| *x *= 1e3)), 8.0).contains(&"unit"));
    let degrees = edited(&log, n, |theta, dtheta, _| theta.iter_mut().chain(dtheta).for_each(|x| *x = x.to_degrees()));
    assert!(codes(&model, &degrees, 8.0).contains(&"unit"));
    let slow = edited(&log, n, |_, dtheta, _| dtheta.iter_mut().for_each(|x| *x = x.to_degrees()));
    assert!(codes(&model, &slow, 8.0).contains(&"unit"));
    let wall = model.with_gravity([0.0, -9.81, 0.0]).expect("finite");
    assert!(codes(&wall, &edited(&log, n, |_, _, _| {}), 8.0).contains(&"gravity"));
    // which no log is fitted with
    let options = Options { choice: Choice::all(Sensor::Link), ..Options::default() };
    let refused = identify(&wall, std::slice::from_ref(&log), &options, &|| false).expect_err("a wall").to_string();
    assert!(refused.contains("gravity seems to be (0.000, 0.000, -9.8"), "{refused}");
    // by half a radian about y
    let tilted = model.with_gravity([9.81 * 0.5_f64.sin(), 0.0, -9.81 * 0.5_f64.cos()]).expect("finite");
    let found = texts(&tilted, &edited(&log, n, |_, _, _| {}), 8.0);
    assert!(found.iter().any(|text| text.contains("gravity seems to be (") && text.contains(", -9.8")), "{found:?}");
}

/// A joint whose own forces are small, an encoder's zero, a sensor's offset: the file alone hardly shows them.
#[test]
fn another_fit_reveals_mistakes() {
    let (model, log) = simulated();
    let n = model.n();
    let turned = edited(&log, n, |theta, dtheta, tau| [theta, dtheta, tau].into_iter().for_each(|x| x[4] = -x[4]));
    assert!(codes(&model, &turned, 8.0).contains(&"sign"));
    let zero = edited(&log, n, |theta, _, _| theta[2] += 0.5);
    assert!(codes(&model, &zero, 8.0).contains(&"offset"));
    let in_mN_m = edited(&log, n, |_, _, tau| tau[5] *= 1e3);
    assert!(codes(&model, &in_mN_m, 8.0).contains(&"limits"));
    let degrees =
        edited(&log, n, |theta, dtheta, _| [theta, dtheta].into_iter().for_each(|x| x[4] = x[4].to_degrees()));
    assert!(codes(&model, &degrees, 8.0).iter().any(|code| ["unit", "limits"].contains(code)));
    let mut biased = edited(&log, n, |_, _, _| {});
    let frame = model.end_effector().expect("one end");
    biased.wrenches = vec![(frame, [0.0, 1.0, 0.0, 20.0, 0.0, -10.0].repeat(log.rows()))];
    assert!(codes(&model, &biased, 8.0).contains(&"wrench"));
    let mut opposite = edited(&log, n, |_, _, _| {});
    let nothing = model.with_parameters(&vec![0.0; model.parameter_count()]);
    let (zeros, mut table) = (vec![0.0; n], Vec::new());
    for k in 0..log.rows() {
        let x = log.t[k];
        let F = [2.0 * (3.0 * x).sin(), 1.0, (2.0 * x).cos(), 20.0, 30.0 * x.sin(), -25.0 * (1.5 * x).cos()];
        let applied = [(frame, Wrench::from_array(F))];
        let around = Environment { applied: &applied, ..Environment::with_gravity(Vec3::zero()) };
        let theta = &log.theta[k * n..][..n];
        let JtF = nothing.inverse_dynamics(theta, &zeros, &zeros, &around).expect("lengths");
        (0..n).for_each(|j| opposite.tau[k * n + j] += JtF[j]);
        table.extend(F.map(|f| -f));
    }
    opposite.wrenches = vec![(frame, table)];
    assert!(texts(&model, &opposite, 8.0).iter().any(|text| text.contains("wrenches seem to have the opposite sign")));
}

#[test]
fn accelerations_of_drivers_are_not_believed() {
    let (model, log) = simulated();
    let mut random = mozzi::random::Random(9);
    let zeros = vec![0.0; log.tau.len()];
    let noisy = log.ddtheta.iter().flatten().map(|x| x + 40.0 * random.next()).collect();
    for (ddtheta, is_used) in [(zeros, false), (noisy, false), (log.ddtheta.clone().unwrap_or_default(), true)] {
        let log = Log { ddtheta: Some(ddtheta), ..log.clone() };
        let found = identify(&model, &[log], &Options::default(), &|| false).expect("an identification");
        let is_left_out = found.findings.iter().any(|finding| finding.code == "acceleration");
        assert_eq!(is_left_out, !is_used, "{:?}", found.findings);
        let errors = found.left_out.as_ref().expect("blocks");
        assert!(errors.normalized(&errors.consistent) < 0.05, "{errors:?}");
    }
}

#[test]
fn a_causal_filter_is_noticed() {
    let (model, log) = simulated();
    let n = model.n();
    // first order, 5 Hz: 32 ms
    let filtered = |table: &mut [f64]| {
        for j in 0..n {
            let share = 1.0 - (-core::f64::consts::TAU * 5.0 / 100.0_f64).exp();
            let mut y = table[j];
            for k in 0..table.len() / n {
                y += share * (table[k * n + j] - y);
                table[k * n + j] = y;
            }
        }
    };
    let mut late = edited(&log, n, |_, _, _| {});
    filtered(&mut late.tau);
    assert!(codes(&model, &late, 8.0).contains(&"causal_filter"));
    let mut late = edited(&log, n, |_, _, _| {});
    late.dtheta.as_deref_mut().map(filtered);
    assert!(codes(&model, &late, 8.0).contains(&"causal_filter"));
}

#[test]
fn real_logs_have_no_mistakes_until_columns_are_swapped() {
    for case in cases() {
        let n = case.model.n();
        let found = codes(&case.model, &case.log, case.cutoff);
        assert!(!found.iter().any(|code| MISTAKES.contains(code)), "{found:?}");
        let (mut all, mut noticed) = (0, 0);
        for a in 0..n {
            for b in a + 1..n {
                let swapped = edited(&case.log, n, |theta, dtheta, tau| {
                    [theta, dtheta, tau].into_iter().for_each(|x| x.swap(a, b))
                });
                all += 1;
                noticed += usize::from(codes(&case.model, &swapped, case.cutoff).contains(&"swapped_joints"));
            }
        }
        eprintln!("{}: {noticed} of {all} swaps of two joints are noticed", case.name);
        assert!(noticed * 10 >= all * 7, "{}: {noticed} of {all}", case.name);
    }
}

#[test]
fn bad_input_is_refused_by_name() {
    let (model, log) = simulated();
    let n = model.n();
    let error = |log: &Log, options: &Options| {
        identify(&model, std::slice::from_ref(log), options, &|| false).expect_err("wrong")
    };
    let options = Options::default();
    let mut short = log.clone();
    short.t.truncate(15);
    for table in [Some(&mut short.theta), Some(&mut short.tau), short.dtheta.as_mut(), short.ddtheta.as_mut()]
        .into_iter()
        .flatten()
    {
        table.truncate(15 * n);
    }
    assert!(matches!(error(&short, &options), Error::TooShort { found: 15, .. }));
    let mut back = log.clone();
    back.t[700] = back.t[600];
    assert!(matches!(error(&back, &options), Error::NotMonotonic { row: 700, .. }));
    let mut nan = log.clone();
    (0..200).for_each(|k| nan.tau[k * n + 2] = f64::NAN);
    let text = error(&nan, &options).to_string();
    assert!(text.contains("`tau 3` at row 0") && text.contains("200 of 2000"), "{text}");
    let mut narrow = log.clone();
    narrow.tau.pop();
    assert!(error(&narrow, &options).to_string().contains("tau has 11999 numbers, expected 2000 rows of 6"));
    let mut still = log.clone();
    still.theta.fill(0.5);
    let zeros = vec![0.0; still.tau.len()];
    (still.dtheta, still.ddtheta, still.tau) = (Some(zeros.clone()), Some(zeros.clone()), zeros);
    still.t.iter().enumerate().for_each(|_| {});
    assert!(matches!(error(&still, &options), Error::TooShort { .. } | Error::NotExciting { .. }));
    let mut falls = log.clone();
    falls.tau.fill(0.0);
    let unfiltered = Options { filter: Filter { cutoff: Cutoff::None, ..Filter::default() }, ..Options::default() };
    let text = error(&falls, &unfiltered).to_string();
    assert!(text.contains("is constant, 0 in all rows, while the joint moves"), "{text}");
    let trusted = Options { trust_log: true, ..unfiltered };
    assert!(error(&falls, &trusted).to_string().contains("all forces are 0"));
    let wrong = Options { prior: -1.0, ..Options::default() };
    assert!(error(&log, &wrong).to_string().contains("the prior's weight is -1"));
    let wrong = Options { tenths: 11, ..Options::default() };
    assert!(error(&log, &wrong).to_string().contains("1 to 10"));
    let wrong = Options { filter: Filter { cutoff: Cutoff::Hz(80.0), ..Filter::default() }, ..Options::default() };
    assert!(error(&log, &wrong).to_string().contains("half of the sampling rate"));
}

#[test]
fn gaps_repetitions_and_saturation_are_reported() {
    let (model, log) = simulated();
    let n = model.n();
    let mut log = edited(&log, n, |_, _, tau| tau[1] = tau[1].clamp(-40.0, 40.0));
    (700..log.rows()).for_each(|k| log.t[k] += 0.7);
    log.tau[300 * n] = f64::NAN;
    for table in [&mut log.theta, &mut log.tau] {
        table.copy_within(100 * n..101 * n, 101 * n);
    }
    if let Some(table) = &mut log.dtheta {
        table.copy_within(100 * n..101 * n, 101 * n);
    }
    let found =
        identify(&model, std::slice::from_ref(&log), &Options::default(), &|| false).expect("an identification");
    let codes: Vec<&str> = found.findings.iter().map(|finding| finding.code).collect();
    for code in ["not_finite", "repeated_rows", "gap", "saturation", "cutoff"] {
        assert!(codes.contains(&code), "{code} is not in {codes:?}");
    }
    assert!(found.samples[0].is_valid.iter().any(|is_valid| !is_valid));
}

#[test]
fn a_stopped_search_keeps_the_best_so_far() {
    let (model, log) = simulated();
    let asked = std::sync::atomic::AtomicUsize::new(0);
    let stop = || asked.fetch_add(1, std::sync::atomic::Ordering::Relaxed) > 5;
    let found = identify(&model, &[log], &Options::default(), &stop).expect("an identification");
    assert!(found.estimates.consistent.is_stopped && found.findings.iter().any(|finding| finding.code == "stopped"));
    assert!(found.estimates.consistent.x.iter().all(|x| x.is_finite()));
}

/// The twist of a base in other axes, in another order, in other units, with another sign, and without a mistake.
#[test]
fn a_base_has_its_velocity_in_its_own_axes() {
    let model = humanoid();
    let (n, nq) = (model.n(), model.nq());
    let mut log = floating_motion(&model, 8.0, 200.0, 4);
    (log.tau, log.ddtheta) = (log.ddtheta.take().expect("accelerations"), None);
    let filter = Filter { cutoff: Cutoff::Hz(20.0), ..Filter::default() };
    let faults = |log: &Log| -> Vec<String> {
        let found = prepare(&model, log, &filter).expect("samples").1;
        let of_velocities = |one: &&Finding| one.level == Level::Fault && ["velocity", "unit"].contains(&one.code);
        found.iter().filter(of_velocities).map(ToString::to_string).collect()
    };
    let with = |change: &dyn Fn(SO3, [Vec3; 2]) -> [Vec3; 2]| {
        let mut log = log.clone();
        let (theta, dtheta) = (&log.theta, log.dtheta.as_mut().expect("velocities"));
        for (row, theta) in dtheta.chunks_mut(n).zip(theta.chunks(nq)) {
            let R = SO3::from_quaternion(theta[0], Vec3([theta[1], theta[2], theta[3]]));
            let [w, v] = change(R, [Vec3([row[0], row[1], row[2]]), Vec3([row[3], row[4], row[5]])]);
            row[..3].copy_from_slice(&w.0);
            row[3..6].copy_from_slice(&v.0);
        }
        faults(&log)
    };
    assert_eq!(with(&|_, V| V), Vec::<String>::new());
    for (change, expected) in [
        (&(|R: SO3, [w, v]: [Vec3; 2]| [w, R * v]) as &dyn Fn(SO3, [Vec3; 2]) -> [Vec3; 2], "its v is along the axes"),
        (&|R, [w, v]| [R * w, R * v], "all of it is"),
        (&|_, [w, v]| [v, w], "it is (v, ω);"),
        (&|R, [w, v]| [R * v, w], "as MuJoCo has it"),
        (&|_, [w, v]| [w, Vec3([-v.0[0], v.0[1], v.0[2]])], "its v_x has the opposite sign"),
        (&|_, [w, v]| [w * 57.29578, v], "its ω is in deg/s"),
    ] {
        let found = with(change);
        assert!(found.len() == 1 && found[0].contains(expected), "{expected}: {found:?}");
    }
    // a base that only translates
    let mut cart = log.clone();
    for (k, row) in cart.theta.chunks_mut(nq).enumerate() {
        row[..7].copy_from_slice(&[1.0, 0.0, 0.0, 0.0, (0.01 * k as f64).sin(), 0.0, 0.0]);
    }
    for (k, row) in cart.dtheta.as_mut().expect("velocities").chunks_mut(n).enumerate() {
        row[..6].copy_from_slice(&[2.0 * (0.01 * k as f64).cos(), 0.0, 0.0, 0.0, 0.0, 0.0]);
    }
    assert!(faults(&cart)[0].contains("it is (v, ω);"), "{:?}", faults(&cart));
    // one at rest, whose pose is noisy
    let mut still = log.clone();
    let mut random = mozzi::random::Random(5);
    for row in still.theta.chunks_mut(nq) {
        let [x, y, z] = random.array::<3>().map(|x| 1e-3 * x);
        row[..7].copy_from_slice(&[(1.0 - x * x - y * y - z * z).sqrt(), x, y, z, 0.0, 0.0, 0.0]);
    }
    still.dtheta.as_mut().expect("velocities").chunks_mut(n).for_each(|row| row[..6].fill(0.0));
    assert_eq!(faults(&still), Vec::<String>::new());
    // the joints of a floating robot, too
    let mut slow = log.clone();
    let dtheta = slow.dtheta.as_mut().expect("velocities");
    dtheta.chunks_mut(n).for_each(|row| row[6..].iter_mut().for_each(|x| *x = x.to_degrees()));
    assert!(faults(&slow).iter().any(|text| text.contains("deg/s")), "{:?}", faults(&slow));
}

#[test]
fn targets_of_a_floating_robot_are_unwrapped_with_their_joints() {
    let model = humanoid();
    let (n, nq) = (model.n(), model.nq());
    let mut log = floating_motion(&model, 6.0, 100.0, 3);
    log.target = Some(vec![0.0; log.rows() * n]);
    let target = log.target.as_mut().expect("targets");
    for k in 0..target.len() / n {
        let angle = 0.02 * k as f64;
        let wrapped = angle - TAU * (angle / TAU).round();
        (log.theta[(k + 1) * nq - 1], target[(k + 1) * n - 1]) = (wrapped, wrapped);
    }
    let (mended, _) = log.with_clock_and_turns(&model).expect("a wrap");
    let last = |table: &[f64], width: usize| table.chunks(width).map(|row| row[width - 1]).collect::<Vec<f64>>();
    assert!((last(&mended.theta, nq).last().expect("a row") - 0.02 * 599.0).abs() < 1e-9);
    let (theta, target) = (last(&mended.theta, nq), last(mended.target.as_ref().expect("targets"), n));
    assert!(theta.iter().zip(&target).all(|(a, b)| (a - b).abs() < 1e-9));
}
