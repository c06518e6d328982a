//! Seconds of rollouts.

use super::cases::Robot;
use mozzi_engine::{CudaLayout, Precision};
use mozzi_gpu::{Device, Rollout, RolloutArrays, Source, Steps, Stream};
use std::error::Error;
use std::time::Instant;

/// A rollout of a robot: its name, robots, steps, seconds.
pub struct Seconds {
    pub robot: String,
    pub robots: usize,
    pub steps: usize,
    pub seconds: f64,
}

const ROBOTS: usize = 1_000_000;
const STEPS: usize = 1000;
/// Joints of the largest robot: a humanoid's would take most of a minute.
const LARGEST: usize = 18;

/// Of the robots without Talos, in `f32`, structure of arrays, without torques, final states only.
pub fn seconds(device: &Device, robots: &[Robot]) -> Result<Vec<Seconds>, Box<dyn Error>> {
    let mut all = Vec::new();
    for Robot { name, model } in robots.iter().filter(|robot| robot.model.n() <= LARGEST) {
        let rollout = Rollout::new(device, &Source::rollout(model, Precision::F32, CudaLayout::Columns)?)?;
        let [theta_length, length] = [model.nq(), model.n()].map(|length| ROBOTS * length);
        let start: Vec<f32> = (0..theta_length).map(|k| (k as f32).sin()).collect(); // quaternions of any length
        let (theta, dtheta) = (device.copy(&start)?, device.zeros::<f32>(length)?);
        let (theta_table, dtheta_table) = (device.zeros::<f32>(theta_length)?, device.zeros::<f32>(length)?);
        let arrays = RolloutArrays {
            theta: theta.pointer(),
            dtheta: dtheta.pointer(),
            tau: None,
            feedback: None,
            theta_table: theta_table.pointer(),
            dtheta_table: dtheta_table.pointer(),
        };
        let steps = Steps { step: 1e-3, steps: STEPS, every: STEPS };
        let mut best = f64::INFINITY;
        for _ in 0..3 {
            device.synchronize()?;
            let begin = Instant::now();
            // SAFETY: living arrays of n numbers a robot; the default stream
            unsafe { rollout.launch(&arrays, &steps, ROBOTS, Stream::default()) }?;
            device.synchronize()?;
            best = best.min(begin.elapsed().as_secs_f64());
        }
        all.push(Seconds { robot: name.clone(), robots: ROBOTS, steps: STEPS, seconds: best });
    }
    Ok(all)
}
