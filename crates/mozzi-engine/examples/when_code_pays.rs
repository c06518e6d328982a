//! After how many states machine code pays: the time to record and to make it, over that of the kernel of one state.
//! `PAYS` of mozzi-engine/src/programs.rs is chosen from it.
//!
//! `cargo run --release -p mozzi-engine --example when_code_pays [ROBOT.urdf …]`

use mozzi::Model;
use mozzi::quantities::{
    CoriolisMatrix, ForwardDynamics, ForwardDynamicsDerivatives, InverseDynamics, InverseDynamicsDerivatives,
    InverseDynamicsVjp, MassMatrix, Query,
};
use mozzi::random::Random;
use mozzi_engine::Batch;
use std::hint::black_box;
use std::time::Instant;

const STATES: usize = 256;
const ROUNDS: usize = 7;

/// Seconds for a state, the least of a few rounds.
fn of_a_state(batch: &Batch, query: Query, tables: [&[f64]; 4]) -> Result<f64, mozzi_engine::Error> {
    let (model, mut least) = (batch.model(), f64::INFINITY);
    let place = |name| ["theta", "dtheta", "ddtheta"].iter().position(|known| *known == name).unwrap_or(3);
    let inputs: Vec<&[f64]> = query.declaration().inputs.iter().map(|input| tables[place(input.name)]).collect();
    let mut outputs: Vec<Vec<f64>> = query.output_lengths(model).map(|length| vec![0.0; length * STATES]).collect();
    for _ in 0..ROUNDS {
        let mut slices: Vec<&mut [f64]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
        let start = Instant::now();
        batch.compute(query, black_box(&inputs), &model.environment().into(), &mut slices)?;
        least = least.min(start.elapsed().as_secs_f64() / STATES as f64);
    }
    Ok(least)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut names: Vec<String> = std::env::args().skip(1).collect();
    if names.is_empty() {
        names = ["double_pendulum", "ur5", "panda", "anymal"].map(String::from).to_vec();
    }
    println!("robot, quantity: kernel, machine code (ns a state); made in ms, which is so many states of the kernel");
    for name in names {
        let model: Model = mozzi_urdf::open(&name)?.build()?;
        let (n, mut random) = (model.n(), Random(1));
        let mut theta = Vec::new();
        for _ in 0..STATES {
            let mut at = model.neutral_configuration();
            mozzi::model::integrate(&model, &mut at, &random.vector(n, 1.0), 1.0);
            theta.extend(at);
        }
        let [dtheta, ddtheta, x] = [1.0, 1.0, 5.0].map(|size| random.vector(STATES * n, size));
        let tables = [&theta[..], &dtheta, &ddtheta, &x];
        let queries: [Query; 7] = [
            InverseDynamics.into(),
            ForwardDynamics.into(),
            MassMatrix.into(),
            CoriolisMatrix.into(),
            InverseDynamicsDerivatives.into(),
            ForwardDynamicsDerivatives.into(),
            InverseDynamicsVjp.into(),
        ];
        for query in queries {
            let kernels = Batch::new(&model).kernels_only().with_threads(1)?;
            let kernel = of_a_state(&kernels, query, tables)?;
            let start = Instant::now();
            let compiled = Batch::new(&model).with_threads(1)?.compile(&[query])?;
            let made = start.elapsed().as_secs_f64();
            let code = of_a_state(&compiled, query, tables)?;
            println!(
                "{name}, {}: {:.0}, {:.0}; {:.2}, {:.0} ({})",
                query.name(),
                kernel * 1e9,
                code * 1e9,
                made * 1e3,
                made / kernel,
                compiled.engine(query)
            );
        }
    }
    Ok(())
}
