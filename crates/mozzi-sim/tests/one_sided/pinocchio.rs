//! The solver next to Pinocchio's ADMM on the same (G, b): `oracles/make_contacts.py`.

use mozzi::nalgebra::{DMatrix, DVector};
use mozzi_sim::one_sided::{Law, Problem, solve};
use serde_json::Value;

#[test]
fn pinocchio_finds_the_same_velocities() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../oracles/contacts.json");
    let text = std::fs::read_to_string(file).expect("there");
    let oracle: Value = serde_json::from_str(&text).expect("JSON");
    let list = |of: &Value| -> Vec<f64> { of.as_array().expect("a list").iter().filter_map(Value::as_f64).collect() };
    let mut worst = std::collections::BTreeMap::<String, [f64; 3]>::new();
    for problem in oracle["problems"].as_array().expect("a list") {
        let b = list(&problem["b"]);
        let (m, mu) = (b.len(), problem["mu"].as_f64().expect("a number"));
        let G = DMatrix::from_row_slice(m, m, &list(&problem["G"]));
        let theirs = DVector::from_vec(list(&problem["p"]));
        let problem_ = Problem { G, b: DVector::from_vec(b), laws: vec![Law::Contact { mu }; m / 3] };
        let ours = solve(&problem_, &DVector::zeros(m), [1e-13, 1e-9]);
        // single forces of redundant feet are not unique: their sum and the velocities are
        let u = (problem_.velocity(&ours.p) - problem_.velocity(&theirs)).amax();
        let sum = |p: &DVector<f64>, k: usize| (0..m / 3).map(|c| p[3 * c + k]).sum::<f64>();
        let size = theirs.amax().max(1e-300);
        let sums = (0..3).map(|k| (sum(&ours.p, k) - sum(&theirs, k)).abs() / size).fold(0.0, f64::max);
        let entry = worst.entry(problem["name"].as_str().expect("a name").into()).or_default();
        *entry = [entry[0].max(u), entry[1].max(sums), entry[2] + 1.0];
    }
    for (name, [u, sums, count]) in &worst {
        println!("{name}, {count} problems: velocities {u:.1e} m/s apart, sums of impulses {sums:.1e} of the largest");
        assert!(*u < 1e-7 && *sums < 1e-7);
    }
    assert!(worst.len() == 3);
}
