//! Signals that stick, jump, or never moved, and logs that are too short.

use crate::common;

use common::{cases, edited, simulated};
use mozzi::Model;
use mozzi_identify::signals::{Cutoff, Filter};
use mozzi_identify::{Choice, Error, Identification, Log, Options, Sensor, identify};

fn options(cutoff: f64) -> Options {
    let filter = Filter { cutoff: Cutoff::Hz(cutoff), ..Filter::default() };
    Options { filter, choice: Choice::all(Sensor::Link), ..Options::default() }
}

/// The only fault of a log that is refused.
fn fault(model: &Model, log: &Log) -> String {
    let error = identify(model, std::slice::from_ref(log), &options(8.0), &|| false).expect_err("a fault");
    let Error::Fault { mut faults } = error else { panic!("{error}") };
    assert_eq!(faults.len(), 1, "{faults:?}");
    faults.remove(0)
}

fn accepted<'m>(model: &'m Model, log: &Log, cutoff: f64) -> Identification<'m> {
    identify(model, std::slice::from_ref(log), &options(cutoff), &|| false).expect("an identification")
}

fn warning(found: &Identification<'_>, code: &str) -> Option<String> {
    found.findings.iter().find(|finding| finding.code == code).map(|finding| finding.text.clone())
}

fn without_velocities(mut log: Log) -> Log {
    log.dtheta = None;
    log
}

/// From row 1000, or within some rows, a column keeps its number.
fn hold(table: &mut [f64], n: usize, j: usize, rows: std::ops::Range<usize>) {
    let value = table[rows.start * n + j];
    rows.for_each(|row| table[row * n + j] = value);
}

#[test]
fn an_encoder_that_is_not_read_is_named_with_its_time() {
    let (model, log) = simulated();
    let n = model.n();
    let mut half = edited(&log, n, |_, _, _| {});
    hold(&mut half.theta, n, 2, 1000..2000);
    for log in [half.clone(), without_velocities(half)] {
        let text = fault(&model, &log);
        assert!(text.contains("the position of elbow_joint is constant") && text.contains("from t = 10 s to the end"));
    }
    let mut middle = edited(&log, n, |_, _, _| {});
    hold(&mut middle.theta, n, 1, 500..700);
    assert!(fault(&model, &middle).contains("position of shoulder_lift_joint"));
}

#[test]
fn velocities_that_were_not_measured_are_named() {
    let (model, log) = simulated();
    let n = model.n();
    let mut half = edited(&log, n, |_, _, _| {});
    half.dtheta.as_deref_mut().into_iter().for_each(|table| hold(table, n, 3, 1000..2000));
    let text = fault(&model, &half);
    assert!(
        text.contains("the velocity of wrist_1_joint is constant") && text.contains("leave velocities out"),
        "{text}"
    );
    let zero = edited(&log, n, |_, dtheta, _| dtheta.fill(-0.0));
    let text = fault(&model, &zero);
    assert!(text.contains("the velocity of every joint is constant, 0, in all rows"), "{text}");
    assert!(warning(&accepted(&model, &without_velocities(zero), 8.0), "stuck").is_none());
}

#[test]
fn forces_that_stick_are_left_out() {
    let (model, log) = simulated();
    let n = model.n();
    let clean = edited(&log, n, |_, _, _| {});
    let of = |log: &Log| accepted(&model, log, 8.0).validate(&clean, &options(8.0).filter).expect("a log").0.consistent;
    let mut held = clean.clone();
    hold(&mut held.tau, n, 3, 1200..1900);
    let found = accepted(&model, &held, 8.0);
    let text = warning(&found, "stuck").expect("a warning");
    assert!(text.contains("the force of wrist_1_joint") && text.contains("from t = 12 s to 18.99 s"), "{text}");
    assert!(found.samples[0].t.iter().all(|t| *t < 12.0 || *t > 18.99));
    assert!(of(&held)[3] < 1.1 * of(&clean)[3]);
    let mut most = clean.clone();
    hold(&mut most.tau, n, 3, 500..1900);
    assert!(fault(&model, &most).contains("in most of the log"));
    // coarse numbers repeat; so do those of a joint at rest, and rows that a driver repeats
    let coarse = edited(&log, n, |theta, dtheta, tau| {
        theta.iter_mut().for_each(|x| *x = (*x * 500.0).round() / 500.0);
        dtheta.iter_mut().for_each(|x| *x = (*x * 20.0).round() / 20.0);
        tau.iter_mut().for_each(|x| *x = x.round());
    });
    let mut repeated = clean.clone();
    [&mut repeated.theta, &mut repeated.tau].into_iter().chain(repeated.dtheta.as_mut()).for_each(|table| {
        (700..850).for_each(|row| table.copy_within(699 * n..700 * n, row * n));
    });
    for log in [&coarse, &repeated, &without_velocities(coarse.clone())] {
        let trusted = Options { trust_log: true, ..options(8.0) };
        let found = identify(&model, std::slice::from_ref(log), &trusted, &|| false).expect("an identification");
        assert_eq!(warning(&found, "stuck"), None);
    }
}

#[test]
fn joints_that_move_one_after_the_other_do_not_stick() {
    let (model, log) = simulated();
    let (n, N) = (model.n(), log.rows());
    let mut turns = edited(&log, n, |_, _, _| {});
    let (theta, mut dtheta) = (&mut turns.theta, vec![0.0; N * n]);
    for row in 0..N {
        for j in 0..n {
            // each joint moves by a smooth step in its own sixth of the log
            let s = ((row as f64 - (j * N / n) as f64) / (N / n) as f64).clamp(0.0, 1.0);
            let turn = core::f64::consts::TAU * s;
            theta[row * n + j] = ((s - turn.sin() / core::f64::consts::TAU) * 1e4).round() / 1e4;
            dtheta[row * n + j] = (1.0 - turn.cos()) / (N / n) as f64 * 100.0;
        }
    }
    turns.dtheta = Some(dtheta);
    for log in [turns.clone(), without_velocities(turns)] {
        let trusted = Options { trust_log: true, ..options(8.0) };
        let found = identify(&model, &[log], &trusted, &|| false).expect("an identification");
        assert_eq!(warning(&found, "stuck"), None);
    }
}

#[test]
fn a_robot_that_does_not_move_is_refused() {
    let (model, log) = simulated();
    let n = model.n();
    let mut random = mozzi::random::Random(2);
    let mut rest = edited(&log, n, |_, _, _| {});
    let first = rest.theta[..n].to_vec();
    rest.theta.iter_mut().enumerate().for_each(|(k, x)| *x = first[k % n] + 2e-5 * random.next());
    rest.dtheta.iter_mut().flatten().for_each(|x| *x = 1e-3 * random.next());
    for log in [rest.clone(), without_velocities(rest)] {
        assert!(fault(&model, &log).contains("the robot does not move"));
    }
    let mut short = edited(&log, n, |_, _, _| {});
    short.t.truncate(45);
    [&mut short.theta, &mut short.tau].into_iter().chain(short.dtheta.as_mut()).for_each(|x| x.truncate(45 * n));
    let unfiltered = Filter { cutoff: Cutoff::None, ..Filter::default() };
    let options = Options { filter: unfiltered, ..options(8.0) };
    let text = identify(&model, &[short], &options, &|| false).expect_err("short").to_string();
    assert!(text.contains("0.44 s of motion do not determine a robot"), "{text}");
}

#[test]
fn spikes_and_drop_outs_are_left_out() {
    let (model, log) = simulated();
    let n = model.n();
    let clean = edited(&log, n, |_, _, _| {});
    let mut spikes = clean.clone();
    [700, 701, 1300].into_iter().for_each(|row| spikes.tau[row * n + 2] = 1e6);
    let found = accepted(&model, &spikes, 8.0);
    let text = warning(&found, "spike").expect("a warning");
    assert!(text.contains("the force jumps") && text.contains("elbow_joint in 3 of 2000 rows"), "{text}");
    assert!(text.contains("row 700"), "{text}");
    let filter = options(8.0).filter;
    let errors = |found: &Identification<'_>| found.validate(&clean, &filter).expect("a log").0.consistent;
    let best = errors(&accepted(&model, &clean, 8.0));
    assert!(errors(&found)[2] < 1.1 * best[2]);
    let mut spikes = clean.clone();
    [300, 800].into_iter().for_each(|row| spikes.theta[row * n + 4] = -9999.0);
    spikes.dtheta.iter_mut().for_each(|table| table[900 * n] = 1e30);
    let found = accepted(&model, &spikes, 8.0);
    for words in ["the position jumps far away for a moment: wrist_2_joint in 2", "the velocity jumps"] {
        assert!(found.findings.iter().any(|finding| finding.text.contains(words)), "{words}: {:?}", found.findings);
    }
    assert!(errors(&found)[2] < 1.1 * best[2]);
    let mut zeros = clean.clone();
    (0..20).for_each(|k| zeros.dtheta.iter_mut().for_each(|table| table[(100 + 90 * k) * n..][..n].fill(0.0)));
    let found = accepted(&model, &zeros, 8.0);
    assert!(
        warning(&found, "drop_out").is_some_and(|text| text.contains("20 of 2000 rows the velocity of every joint"))
    );
    assert!(errors(&found)[0] < 1.1 * best[0]);
}

#[test]
fn real_logs_neither_stick_nor_jump() {
    for case in cases() {
        for log in [case.log.clone(), without_velocities(case.log.clone())] {
            let found = accepted(&case.model, &log, case.cutoff);
            let codes = ["stuck", "spike", "drop_out", "at_rest", "short", "contradiction"];
            assert!(!found.findings.iter().any(|finding| codes.contains(&finding.code)), "{:?}", found.findings);
        }
    }
}
