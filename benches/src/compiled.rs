//! mozzi's machine code for one robot.

use crate::quantity;
use crate::states::{States, inputs};
use mozzi::Model;
use mozzi::quantities::{InverseDynamics, Query};
use mozzi_engine::{Arguments, Engine, Kernel, compile, record_quantity};
use std::hint::black_box;
use std::time::Instant;

/// The quantities that have machine code, with the flops of their programs.
pub fn quantities(model: &Model, engine: impl Fn(Query) -> Engine) -> Vec<(Query<'static>, Option<usize>)> {
    let with_flops = |query| {
        let Engine::MachineCode(shape, _) = engine(query) else { return None };
        let program = record_quantity(model, query, Arguments::default()).ok()?;
        Some((query, Some(Kernel::new(&program, shape).ok()?.flops())))
    };
    quantity::of(model).filter_map(with_flops).collect()
}

/// Milliseconds from a model to its first inverse dynamics by machine code, the least of a few.
pub fn to_first_result(model: &Model, states: &States) -> Option<f64> {
    let query = Query::from(InverseDynamics);
    let (inputs, mut tau) = (inputs(query, states.iter().next()?), vec![0.0; model.n()]);
    let mut once = |_| {
        let start = Instant::now();
        let robot = compile(model, &[query]).ok()?;
        robot.compute(query, &inputs, &mut [&mut tau]).ok()?;
        black_box(&mut tau);
        Some(start.elapsed().as_secs_f64() * 1e3)
    };
    (0..20).filter_map(&mut once).min_by(f64::total_cmp)
}
