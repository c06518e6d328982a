//! A million inverse dynamics of the UR5: one row for each state, as in NumPy, by machine code and on all cores.
//!
//! `cargo run --release -p mozzi-examples --example 17_million_states` computes a million states; a number after `--`
//! sets another count. Without optimisation the default is a thousand.

use mozzi::Environment;
use mozzi::quantities::InverseDynamics;
use mozzi_engine::Batch;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let ur5 = mozzi_urdf::open("ur5")?.build()?;
    let n = ur5.n();
    let states = match std::env::args().nth(1) {
        Some(count) => count.parse()?,
        None if cfg!(debug_assertions) => 1000,
        None => 1_000_000,
    };
    let number = |k: usize, speed: f64| (k as f64 * speed).sin();
    let theta: Vec<f64> = (0..states * n).map(|k| 3.0 * number(k, 0.7)).collect(); // (N, 6), by rows
    let dtheta: Vec<f64> = (0..states * n).map(|k| number(k, 1.1)).collect();
    let ddtheta: Vec<f64> = (0..states * n).map(|k| number(k, 1.3)).collect();
    let environment: Environment = ur5.environment();

    let batch = Batch::new(&ur5);
    let mut tau = vec![0.0; states * n];
    let mut seconds = f64::INFINITY;
    for _ in 0..3 {
        let start = Instant::now();
        batch.compute(InverseDynamics, &[&theta, &dtheta, &ddtheta], &environment.into(), &mut [&mut tau])?;
        seconds = seconds.min(start.elapsed().as_secs_f64());
    }
    let rate = states as f64 / seconds;
    println!("f64, {}: {states} states in {seconds:.4} s, {rate:.3e} states/s", batch.engine(InverseDynamics));

    // half the bits, and twice as many states in a register
    let [theta32, dtheta32, ddtheta32] =
        [&theta, &dtheta, &ddtheta].map(|table| table.iter().map(|&x| x as f32).collect::<Vec<f32>>());
    let single = Batch::<f32>::of(&ur5);
    let mut tau32 = vec![0.0; states * n];
    let mut seconds = f64::INFINITY;
    for _ in 0..3 {
        let start = Instant::now();
        single.compute(InverseDynamics, &[&theta32, &dtheta32, &ddtheta32], &environment.into(), &mut [&mut tau32])?;
        seconds = seconds.min(start.elapsed().as_secs_f64());
    }
    let rate = states as f64 / seconds;
    println!("f32, {}: {states} states in {seconds:.4} s, {rate:.3e} states/s", single.engine(InverseDynamics));

    let largest = tau.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let (mut apart, mut apart32) = (0.0_f64, 0.0_f64);
    for state in (0..states).step_by((states / 100).max(1)) {
        let row = state * n..(state + 1) * n;
        let one =
            ur5.inverse_dynamics(&theta[row.clone()], &dtheta[row.clone()], &ddtheta[row.clone()], &environment)?;
        for (j, k) in row.enumerate() {
            apart = apart.max((one[j] - tau[k]).abs());
            apart32 = apart32.max((one[j] - f64::from(tau32[k])).abs());
        }
    }
    println!("from one state, of the largest torque: f64 {:.1e}, f32 {:.1e}", apart / largest, apart32 / largest);
    assert!(apart < 1e-12 * largest && apart32 < 1e-4 * largest);
    Ok(())
}
