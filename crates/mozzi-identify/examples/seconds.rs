//! How long identifications take: `cargo run --release -p mozzi-identify --example seconds`. A humanoid of 30 joints
//! with a floating base and 10⁵ samples; and, if they are at hand, the real logs of a Panda and of a UR10.

#[path = "../tests/common/mod.rs"]
mod common;

use mozzi::random::Random;
use mozzi_identify::judgement::judge;
use mozzi_identify::signals::{Cutoff, Filter};
use mozzi_identify::{Choice, Columns, Options, Sensor, identify};
use std::time::Instant;

fn main() -> Result<(), mozzi_identify::Error> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    for case in common::cases() {
        let start = Instant::now();
        let options = Options { choice: Choice::all(Sensor::Link), ..Options::default() };
        let found = identify(&case.model, std::slice::from_ref(&case.log), &options, &|| false)?;
        let fitted = start.elapsed();
        let judged = judge(&found, std::slice::from_ref(&case.log))?;
        let (rows, all) = (case.log.rows(), start.elapsed());
        println!(
            "{}: {rows} rows: fit and five blocks {fitted:.2?}, with the judgement {all:.2?}, {cores} cores",
            case.name
        );
        println!("   {} findings", judged.findings.len() + found.findings.len());
    }
    let model = common::humanoid();
    let choice = Choice::all(Sensor::Link);
    let columns = Columns::new(&model, choice.clone())?;
    let log = common::floating_motion(&model, 1000.0, 100.0, 4);
    let log = common::with_forces(&log, &model, &choice, &columns.prior(), &vec![0.1; model.n()], &mut Random(1));
    let start = Instant::now();
    let filter = Filter { cutoff: Cutoff::Hz(20.0), ..Filter::default() };
    let found = identify(&model, &[log], &Options { choice, filter, ..Options::default() }, &|| false)?;
    println!(
        "humanoid: n = {}, {} samples, {} unknowns, {} base: {:.2?}, {cores} cores",
        model.n(),
        found.samples[0].count(),
        found.setup.columns.count(),
        found.setup.base.count(),
        start.elapsed()
    );
    Ok(())
}
