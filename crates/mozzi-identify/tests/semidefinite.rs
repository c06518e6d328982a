//! The convex estimate by a second, independent way: the semidefinite programs that cvxpy and Clarabel solved, in
//! oracles/identify_sdp.json. `oracles/identify_sdp.py` makes that file from the problems that
//! `cargo test -p mozzi-identify semidefinite -- --ignored` writes.

use crate::common;

use common::{motion, with_forces};
use mozzi::random::Random;
use mozzi_identify::estimate::consistent::Problem;
use mozzi_identify::estimate::pseudo_inertia::Prior;
use mozzi_identify::signals::{Cutoff, Filter, prepare};
use mozzi_identify::{Choice, Compressed, Evidence, Limits, Sensor, Setup, Triangle};
use nalgebra::DMatrix;
use serde_json::{Value, json};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../oracles/identify_sdp.json");

/// Short noisy logs, for which least squares finds bodies that cannot exist.
fn problem(robot: &str, gamma: f64) -> (Problem, Triangle) {
    let model = mozzi_urdf::open(robot).expect("embedded").description.build().expect("sound");
    let choice = Choice::all(Sensor::Motor);
    let mut setup = Setup::new(&model, choice.clone(), gamma, &Limits::default()).expect("a setup");
    let log = motion(&model, 1.0, 60.0, 0.6, 7);
    let mut x = setup.columns.prior();
    for (k, unknown) in setup.columns.unknowns.iter().enumerate().filter(|(_, unknown)| unknown.kind.is_positive()) {
        x[k] = 0.05 + unknown.prior;
    }
    let log = with_forces(&log, &model, &choice, &x, &vec![0.5; model.n()], &mut Random(5));
    let filter = Filter { cutoff: Cutoff::None, ..Filter::default() };
    let (samples, _) = prepare(&model, &log, &filter).expect("samples");
    let compressed = [Compressed::new(&setup.columns, &setup.pattern, &samples, None).expect("equations")];
    let evidence = Evidence::new(&setup.pattern, setup.columns.count(), &compressed, |_, _| true);
    let sigma = vec![0.5; model.n()];
    setup.problem.gamma = gamma;
    (setup.problem.of_robot(), evidence.weighted(&sigma))
}

#[test]
#[ignore = "writes the problems for oracles/identify_sdp.py"]
fn write_problems() {
    let mut all = Vec::new();
    for (robot, gamma) in [("double_pendulum", 0.3), ("double_pendulum", 0.01), ("furuta_pendulum", 0.3), ("ur5", 0.3)]
    {
        let (problem, data) = problem(robot, gamma);
        let P = data.unknowns();
        let sizes: Vec<f64> = problem.positive.iter().map(|&k| 1.0 / data.R.view((0, k), (P, 1)).norm()).collect();
        let rows: Vec<Vec<f64>> = (0..P).map(|i| (i..=P).map(|k| data.R[(i, k)]).collect()).collect();
        let bodies: Vec<Value> = problem
            .bodies
            .iter()
            .map(|(first, prior, _)| json!({ "first": first, "C": prior.C.transpose().as_slice() }))
            .collect();
        all.push(json!({
            "robot": robot, "gamma": gamma, "unknowns": P, "rows": rows, "bodies": bodies,
            "positive": problem.positive, "sizes": sizes,
        }));
    }
    std::fs::write(FILE, serde_json::to_string(&all).expect("numbers") + "\n").expect("a file");
}

#[test]
fn newton_finds_the_optimum_of_the_semidefinite_program() {
    let all: Value = serde_json::from_str(&std::fs::read_to_string(FILE).expect("a file")).expect("JSON");
    let list =
        |value: &Value| -> Vec<f64> { value.as_array().expect("a list").iter().filter_map(Value::as_f64).collect() };
    for one in all.as_array().expect("problems") {
        let P = one["unknowns"].as_u64().expect("a number") as usize;
        let mut data = Triangle::new(P);
        let mut R = DMatrix::zeros(P, P + 1);
        for (i, row) in one["rows"].as_array().expect("rows").iter().enumerate() {
            for (k, x) in list(row).into_iter().enumerate() {
                R[(i, i + k)] = x;
            }
        }
        data.push(R.clone(), P);
        let bodies = one["bodies"].as_array().expect("bodies").iter().map(|body| {
            let C = nalgebra::Matrix4::from_row_slice(&list(&body["C"]));
            (body["first"].as_u64().expect("a number") as usize, Prior { C, is_repaired: false }, 1.0)
        });
        let bodies = bodies.collect();
        let positive: Vec<usize> = list(&one["positive"]).into_iter().map(|k| k as usize).collect();
        let gamma = one["gamma"].as_f64().expect("a number");
        let (split, pinned, bounds, start) = (Vec::new(), Vec::new(), Vec::new(), vec![0.0; P]);
        let problem = Problem { bodies, positive, split, pinned, bounds, gamma, start };
        let found = problem.solve(&data, &|| false).expect("an optimum");
        let expected = list(&one["optimum"]);
        let difference = nalgebra::DVector::from_iterator(P, found.x.iter().zip(&expected).map(|(a, b)| a - b));
        // forces in units of their noise, per sample; and the cost, at its minimum flat
        let error = (R.columns(0, P) * difference).norm();
        let cost = one["cost"].as_f64().expect("a number");
        eprintln!(
            "{} γ {gamma}: {} steps, forces differ by {error:.1e} σ, cost {:.10} and {cost:.10}",
            one["robot"], found.steps, found.cost
        );
        assert!(error < 2e-4, "{error:e}");
        assert!(found.cost < cost + 1e-7 * cost.abs().max(1.0), "{} is above {cost}", found.cost);
        assert!((found.cost - cost).abs() < 1e-5 * cost.abs().max(1.0));
    }
}
