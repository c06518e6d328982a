//! Rollouts on the host, compared with the CPU's.
#![allow(missing_docs)]

use crate::common;

use common::host::{self, Call, exists, run};
use common::{LAYOUTS, PRECISIONS, embedded, error, nvrtc, transposed};
use mozzi::testing::{Random, four_bar, state};
use mozzi::{Base, Model};
use mozzi_engine::{CudaLayout, Precision};
use mozzi_gpu::{Arch, Source};
use mozzi_sim::{Method, Rollout};

const ROBOTS: usize = 37;
const STEPS: usize = 12;
const EVERY: usize = 4;
const H: f64 = 0.01;

/// Starts, torques, gains and desired states, by rows.
struct Case {
    theta: Vec<f64>,
    dtheta: Vec<f64>,
    tau: Vec<f64>,
    gains: Vec<f64>,
    target: Vec<f64>,
}

fn case(model: &Model, precision: Precision) -> Case {
    let (n, mut random) = (model.n(), Random(5));
    // the first robot is where it should be
    let target = |seed: usize| {
        let at = if seed == 0 { 0 } else { seed as u64 + 100 };
        [state(model, at)[0].clone(), state(model, seed as u64)[2].clone()].concat()
    };
    let rounded = |x: Vec<f64>| -> Vec<f64> {
        x.into_iter().map(|x| if precision == Precision::F64 { x } else { f64::from(x as f32) }).collect()
    };
    let all = |k: usize| rounded((0..ROBOTS).flat_map(|seed| state(model, seed as u64)[k].clone()).collect());
    let mut dtheta = all(1);
    dtheta[..n].fill(0.0); // the first robot is at rest
    Case {
        theta: all(0),
        dtheta,
        tau: rounded(random.vector(ROBOTS * STEPS * n, 5.0)),
        gains: rounded(random.vector(2 * n * n, 0.02)),
        target: rounded((0..ROBOTS).flat_map(target).collect()),
    }
}

/// The states after each `EVERY` steps by the CPU, with feedback held over each step.
fn expected(model: &Model, case: &Case, has_feedback: bool) -> [Vec<f64>; 2] {
    let (nq, n) = (model.nq(), model.n());
    let mut rollout = Rollout::new(model, H, Method::RungeKutta4).expect("valid");
    let (mut thetas, mut dthetas) = (Vec::new(), Vec::new());
    for i in 0..ROBOTS {
        let mut x = [&case.theta[i * nq..(i + 1) * nq], &case.dtheta[i * n..(i + 1) * n]].map(<[f64]>::to_vec);
        let (theta_d, dtheta_d) = case.target[i * (nq + n)..(i + 1) * (nq + n)].split_at(nq);
        for step in 0..STEPS {
            let mut tau = case.tau[(i * STEPS + step) * n..][..n].to_vec();
            if has_feedback {
                let mut difference = vec![0.0; n];
                mozzi::model::difference(model, &x[0], theta_d, &mut difference);
                difference.extend(x[1].iter().zip(dtheta_d).map(|(x, target)| target - x));
                for (j, tau) in tau.iter_mut().enumerate() {
                    *tau += case.gains[j * 2 * n..].iter().zip(&difference).map(|(g, d)| g * d).sum::<f64>();
                }
            }
            let states = rollout.states(&x[0], &x[1], &tau).expect("regular");
            x = [&states.theta[nq..], &states.dtheta[n..]].map(<[f64]>::to_vec);
            if (step + 1) % EVERY == 0 {
                thetas.extend(&x[0]);
                dthetas.extend(&x[1]);
            }
        }
    }
    [thetas, dthetas]
}

#[test]
fn steps_under_tables_and_feedback_are_the_cpus() {
    if !exists() {
        return;
    }
    let models = ["double_pendulum", "ur5"].map(embedded);
    for model in models.into_iter().chain([floating("anymal"), ball()]) {
        let (nq, n) = (model.nq(), model.n());
        let mut calls = Vec::new();
        for (precision, layout) in PRECISIONS.into_iter().flat_map(|x| LAYOUTS.map(|layout| (x, layout))) {
            for has_feedback in [false, true] {
                let case = case(&model, precision);
                let by = |x: Vec<f64>, width: usize| if layout == CudaLayout::Rows { x } else { transposed(&x, width) };
                let (gains, target) = if has_feedback { (case.gains, case.target) } else { (Vec::new(), Vec::new()) };
                let target = if has_feedback { by(target, nq + n) } else { target };
                let rollout = host::Rollout {
                    arrays: vec![by(case.tau, STEPS * n), gains, target],
                    rows: STEPS / EVERY,
                    arguments: format!("{H}, {STEPS}, {EVERY}, "),
                };
                calls.push(Call {
                    source: Source::rollout(&model, precision, layout).expect("a text"),
                    inputs: vec![by(case.theta, nq), by(case.dtheta, n)],
                    states: ROBOTS,
                    rollout: Some(rollout),
                });
            }
        }
        let name = format!("rollout {}", model.description().name);
        for (k, (found, call)) in run(&name, &calls).into_iter().zip(&calls).enumerate() {
            let form = call.source.form();
            let epsilon = if form.precision == Precision::F64 { f64::EPSILON } else { f32::EPSILON.into() };
            let expected = expected(&model, &case(&model, form.precision), k % 2 == 1);
            for ((found, expected), width) in found.into_iter().zip(expected).zip([nq, n]) {
                let found = if form.layout == CudaLayout::Rows { found } else { transposed(&found, ROBOTS) };
                let error = error(&found, &expected, STEPS / EVERY * width) / epsilon;
                eprintln!("{name} {form:?}: {error:.1} eps");
                assert!(error < 100.0, "{name} {form:?}: {error} eps");
            }
        }
    }
}

fn floating(name: &str) -> Model {
    embedded(name).with_base(Base::Floating).expect("sound")
}

/// An arm whose shoulder is a ball.
fn ball() -> Model {
    let text = r#"<mujoco model="ball"><worldbody><body name="upper"><joint name="shoulder" type="ball"/>
        <inertial pos="0 0.02 -0.4" mass="2" diaginertia="0.12 0.1 0.01"/>
        <body name="lower" pos="0 0 -0.8"><joint name="elbow" axis="0 1 0"/>
        <inertial pos="0.01 0 -0.3" mass="1" diaginertia="0.03 0.03 0.002"/></body></body></worldbody></mujoco>"#;
    mozzi_urdf::parse("ball.xml", text).and_then(|robot| robot.build()).expect("sound")
}

#[test]
fn rollouts_compile_and_loops_are_refused() {
    let error = Source::rollout(&four_bar(), Precision::F32, CudaLayout::Rows).expect_err("a loop").to_string();
    assert!(error.contains("rollout") && error.contains("constraints"), "{error}");
    let Some(nvrtc) = nvrtc() else { return };
    let source = Source::rollout(&floating("anymal"), Precision::F32, CudaLayout::Rows).expect("a text");
    let resources = source.compile(&nvrtc, Arch::SM_90).expect("a binary").resources().expect("counts");
    eprintln!("{}: {resources:?}", source.entry());
    assert!(resources.spill_stores <= 200, "{resources:?}");
    for layout in LAYOUTS {
        let source = Source::rollout(&embedded("ur5"), Precision::F32, layout).expect("a text");
        let resources = source.compile(&nvrtc, Arch::SM_90).expect("a binary").resources().expect("counts");
        eprintln!("{}: {resources:?}", source.entry());
        assert!(resources.registers <= 168 && resources.spill_stores == 0, "{resources:?}");
    }
}
