//! The numbers of machine code, bit by bit, a line for each robot, quantity and number type: x86-64 by AVX2 and AArch64
//! print the same, as the order of operations is the same. `cargo xtask nightly` compares them. −0 is printed as 0.
//!
//! `cargo run --release -p mozzi-engine --example machine_code_bits`

mod quantities;

use mozzi::random::Random;
use mozzi_engine::{Arguments, Form, Kernel, Number, Program, Shape, record_quantity};
use quantities::quantities;
use std::error::Error;

/// A register of the widest shape.
const STATES: usize = 8;

/// The outputs' tables at these states, from random ones of the inputs.
fn numbers<T: Number>(kernel: &Kernel, program: &Program) -> Vec<f64> {
    let (mut random, runs) = (Random(5), STATES / kernel.shape().lanes());
    let (given, found) = kernel.extents().split_at(program.inputs().len());
    let table = |(extent, length): (&mozzi_engine::Extent, usize)| -> Vec<T> {
        let mut table: Vec<T> = random.vector(STATES * length, 1.0).into_iter().map(T::from_f64).collect();
        table.resize(extent.of(runs), T::zero()); // what is read beyond the rows
        table
    };
    let tables: Vec<Vec<T>> = given.iter().zip(program.inputs().iter().map(|input| input.length)).map(table).collect();
    let inputs: Vec<&[T]> = tables.iter().map(Vec::as_slice).collect();
    let mut outputs: Vec<Vec<T>> = found.iter().map(|extent| vec![T::zero(); extent.of(runs)]).collect();
    let (squares, own) = outputs.split_last_mut().expect("the squares of the angles");
    kernel.run(runs, &inputs, &mut own.iter_mut().map(Vec::as_mut_slice).collect::<Vec<_>>(), squares);
    let rows = |(table, output): (&Vec<T>, &mozzi_engine::Output)| {
        table[..STATES * output.values.len()].iter().map(|&x| x.into()).collect::<Vec<f64>>()
    };
    own.iter().zip(program.outputs()).flat_map(rows).collect()
}

fn line<T: Number>(program: &Program, shapes: [Shape; 2]) -> Result<String, Box<dyn Error>> {
    let shape = shapes.into_iter().find(|shape| shape.is_supported()).ok_or("no machine code on this processor")?;
    let kernel = match Kernel::condensing(program, shape, Form::Rows, usize::MAX) {
        Ok(kernel) => kernel,
        Err(refusal) => return Ok(refusal.to_string()),
    };
    let hexadecimal = |x: f64| format!("{:016x}", (x + 0.0).to_bits());
    Ok(numbers::<T>(&kernel, program).into_iter().map(hexadecimal).collect::<Vec<_>>().join(" "))
}

fn main() -> Result<(), Box<dyn Error>> {
    for name in ["two_link_planar", "ur5", "panda"] {
        let model = mozzi_urdf::open(name)?.build()?;
        let frame = model.frames().last().ok_or("a robot without frames")?.0;
        for query in quantities(frame) {
            let program = record_quantity(&model, query, Arguments::default())?;
            println!("{name} {} f64: {}", query.name(), line::<f64>(&program, [Shape::FourF64, Shape::TwoF64])?);
            println!("{name} {} f32: {}", query.name(), line::<f32>(&program, [Shape::EightF32, Shape::FourF32])?);
        }
    }
    Ok(())
}
