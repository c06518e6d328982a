//! Duration of a simulation by each method: 10 s of the Panda's seven joints at 1 ms, released from the start with a
//! brake of 0.5 N m s/rad; the fastest of some runs.
//!
//! `cargo run --release -p mozzi-motion --example integration_speed [RUNS]`

use mozzi_sim::{Method, Options, torque};
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let runs: usize = std::env::args().nth(1).map_or(Ok(10), |text| text.parse())?;
    // the fingers are locked: their slide has no stop, and its position would overflow
    let panda = mozzi_urdf::open("panda")?.build()?.with_locked_joints(&[("panda_finger_joint1", 0.02)])?;
    let (start, still) = ([0.0, -0.5, 0.0, -2.0, 0.0, 1.6, 0.8], [0.0; 7]);
    // a little friction: without it the fall is too wild for the first-order methods
    let brake = || torque(|_, _, dtheta, tau| tau.iter_mut().zip(dtheta).for_each(|(tau, rate)| *tau -= 0.5 * rate));
    let least = |run: &dyn Fn() -> Result<f64, Box<dyn std::error::Error>>| {
        let mut best = (f64::INFINITY, 0.0);
        for _ in 0..runs {
            let begin = Instant::now();
            let drift = run()?;
            best = (begin.elapsed().as_secs_f64().min(best.0), drift);
        }
        Ok::<_, Box<dyn std::error::Error>>(best)
    };
    println!("{:40} {:>8} {:>18}", "Panda, 10 s", "ms", "largest drift, J");
    let adaptive = Method::DormandPrince { tolerance: 1e-6 };
    for method in [Method::Euler, Method::SemiImplicitEuler, Method::RungeKutta4, Method::Midpoint, adaptive] {
        // rows are recorded every 100 steps, energies with them
        let options = Options { method, record_every: 100, ..Options::new(10.0, 10_000) };
        let (seconds, drift) =
            least(&|| Ok(mozzi_sim::simulate(&panda, &start, &still, brake(), &options)?.largest_drift()))?;
        let by = if method.is_adaptive() { "to 1e-6" } else { "1 ms" };
        println!("{:40} {:8.2} {:18.1e}", format!("{}, {by}", method.name()), 1e3 * seconds, drift);
    }
    Ok(())
}
