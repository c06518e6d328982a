//! The time of a step of a standing ANYmal: `cargo run --release -p mozzi-motion --example contact_speed`, next to
//! MuJoCo's mj_step by `python crates/mozzi-motion/examples/contact_speed.py`.

use mozzi::{Error, Vec3};
use mozzi_sim::{ContactPoint, Contacts, Input, Options, Plane, Simulation};
use std::time::Instant;

const POSE: [f64; 12] = [0.0, 0.7, -1.0, 0.0, 0.7, -1.0, 0.0, -0.7, 1.0, 0.0, -0.7, 1.0];

struct Springs;

impl Input for Springs {
    fn torque(&mut self, _: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), mozzi_sim::Error> {
        (0..12).for_each(|j| tau[6 + j] += 400.0 * (POSE[j] - theta[7 + j]) - 10.0 * dtheta[6 + j]);
        Ok(())
    }

    fn gains(&self, stiffness: &mut [f64], damping: &mut [f64]) {
        stiffness[6..].iter_mut().for_each(|x| *x += 400.0);
        damping[6..].iter_mut().for_each(|x| *x += 10.0);
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = mozzi_urdf::open("anymal")?.description.floating().build()?;
    let point = |name| Ok(ContactPoint::new(name, model.frame(name)?, Vec3::zero(), 0.7));
    let points =
        ["LF_FOOT", "RF_FOOT", "LH_FOOT", "RH_FOOT"].into_iter().map(point).collect::<Result<Vec<_>, Error>>()?;
    let contacts = Contacts { points, planes: vec![Plane::ground()] };
    let mut theta = model.neutral_configuration::<f64>();
    theta[7..].copy_from_slice(&POSE);
    theta[6] -= contacts.gaps(&model, 0.0, &theta).into_iter().fold(f64::INFINITY, f64::min);
    let still = vec![0.0; model.n()];
    let simulation =
        Simulation { contacts, ..Simulation::new(Options { record_every: 1000, ..Options::new(2.0, 2000) }) };
    let settled = simulation.run(&model, &theta, &still, Springs)?;
    let (theta, dtheta) = (settled.motion.last().theta.to_vec(), settled.motion.last().dtheta.to_vec());
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        let clock = Instant::now();
        simulation.run(&model, &theta, &dtheta, Springs)?;
        best = best.min(clock.elapsed().as_secs_f64() / 2000.0 * 1e6);
    }
    println!("mozzi: {best:.1} µs a step of 1 ms (best of 5 times 2000 steps)");
    Ok(())
}
