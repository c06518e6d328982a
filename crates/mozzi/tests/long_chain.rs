//! The cost of long chains grows only with their length.

use mozzi::model::{HomeFrames, Screws};
use mozzi::{Description, Model, SE3, ScrewAxis, SpatialInertia, Sym3, Twist, Vec3, Workspace};
fn chain(n: usize) -> Model {
    let frames: Vec<SE3> =
        (0..=n).map(|i| SE3::exp(Twist::from_array([0.0, 0.3 * (i % 5) as f64, 0.1, 0.2, 0.0, 0.1]))).collect();
    let body = SpatialInertia::new(1.0, Vec3([0.0, 0.1, 0.05]), Sym3::diagonal(0.02, 0.03, 0.04));
    let z = ScrewAxis::new([0.0, 0.0, 1.0], [0.0; 3]).unwrap();
    let robot =
        Description::from_screws("chain", HomeFrames::Relative(&frames), &vec![body; n], Screws::Link(&vec![z; n]));
    robot.unwrap().build().unwrap()
}

#[test]
fn ten_thousand_links() {
    let n = 10_000;
    let model = chain(n);
    let (theta, dtheta, ddtheta) = (vec![1e-3; n], vec![1e-3; n], vec![1e-3; n]);
    let (mut tau, mut found, mut w) = (vec![0.0_f64; n], vec![0.0; n], Workspace::new(&model));
    let environment = model.environment();
    mozzi::dynamics::inverse_dynamics(&model, &theta, &dtheta, &ddtheta, &environment, &mut w, &mut tau);
    mozzi::dynamics::forward_dynamics(&model, &theta, &dtheta, &tau, &environment, &mut w, &mut found);
    // such a long chain is ill-conditioned: compare the torques that the found accelerations need
    let mut again = vec![0.0_f64; n];
    mozzi::dynamics::inverse_dynamics(&model, &theta, &dtheta, &found, &environment, &mut w, &mut again);
    let scale = tau.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert!(again.iter().zip(&tau).all(|(a, b)| (a - b).abs() < 1e-9 * scale));
    assert_eq!(model.screws().expect("one axis a joint").M.len(), n);
}
