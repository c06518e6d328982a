//! How long 10,000 links take from text to model: `cargo run --release -p mozzi-urdf --example large`.

#[path = "../tests/large/mod.rs"]
mod large;

use std::time::Instant;

fn main() -> Result<(), mozzi_urdf::LoadError> {
    for (name, robot) in large::ROBOTS {
        let text = robot(10_000);
        let mut times = Vec::new();
        for _ in 0..5 {
            let start = Instant::now();
            let loaded = mozzi_urdf::parse("large", &text)?;
            let read = start.elapsed();
            let model = loaded.build()?;
            times.push((start.elapsed(), read, model.n()));
        }
        let Some((all, read, n)) = times.into_iter().min() else { continue };
        println!("{name:<20} {n} joints: read in {:.3} s, built after {:.3} s", read.as_secs_f64(), all.as_secs_f64());
    }
    Ok(())
}
