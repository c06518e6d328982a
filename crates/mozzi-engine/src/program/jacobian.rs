//! The Jacobian of a program, which is a program again.

use crate::program::derivative::{Derivative, Product, before_pivots, derivative};
use crate::program::record::record;
use crate::program::too_long::TooLong;
use crate::program::{Program, Traced};
use mozzi::{Dual, Model};

/// The program of all blocks ∂y/∂x of a program: for each output y but pivots and, within it, for each input x one
/// output `jac_y_x`, column after column; x are the inputs' own numbers. After the program's inputs there is one more,
/// `out_y`, for each of these outputs, which no step reads: so CasADi calls Jacobians.
///
/// Columns `d_x` that the program `known` of the same inputs computes, by rows, are taken from it. The rest is
/// differentiated forward, a column at a time, or backward, a row at a time, if there are few rows.
///
/// # Errors
/// [`TooLong`].
pub(crate) fn jacobian(program: &Program, known: Option<&Program>, model: &Model) -> Result<Program, TooLong> {
    let own = &program.outputs()[..before_pivots(program)];
    let rows: usize = own.iter().map(|output| output.values.len()).sum();
    let columns: usize = program.inputs().iter().map(|input| input.length).sum();
    let is_backward = known.is_none() && 4 * rows < columns;
    let gradient = match is_backward {
        true => {
            let all = Product { gradient: u32::MAX, ..Product::default() };
            Some(derivative(program.clone(), model, Derivative::Product(all))?)
        }
        false => None,
    };
    let nominal: Vec<(String, usize)> =
        own.iter().map(|output| (format!("out_{}", output.name), output.values.len())).collect();
    let inputs = program.inputs().iter().map(|input| (input.name.as_str(), input.length));
    let inputs: Vec<(&str, usize)> = inputs.chain(nominal.iter().map(|(name, n)| (name.as_str(), *n))).collect();
    let names: Vec<String> =
        own.iter().flat_map(|y| program.inputs().iter().map(move |x| format!("jac_{}_{}", y.name, x.name))).collect();
    record(&format!("jac_{}", program.name()), &inputs, |arrays| {
        let x: Vec<&[Traced]> = arrays[..program.inputs().len()].iter().map(Vec::as_slice).collect();
        let matrix = match &gradient {
            Some(gradient) => by_rows(gradient, &x, rows),
            None => by_columns(program, known, &x, own.len()),
        };
        let (mut blocks, mut first) = (Vec::new(), 0);
        for output in own {
            let of_output = first..first + output.values.len();
            first = of_output.end;
            let mut column = 0;
            for input in &x {
                let block = &matrix[column..column + input.len()];
                column += input.len();
                blocks.push(block.iter().flat_map(|entries| entries[of_output.clone()].iter().copied()).collect());
            }
        }
        names.iter().map(String::as_str).zip(blocks).collect()
    })
}

/// The columns of the whole matrix, by a gradient for each row.
fn by_rows(gradient: &Program, x: &[&[Traced]], rows: usize) -> Vec<Vec<Traced>> {
    let unit = |row: usize| (0..rows).map(move |k| Traced::from(f64::from(u8::from(k == row)))).collect();
    let row = |row: usize| {
        let weights: Vec<Traced> = unit(row);
        gradient.evaluate(&[x, &[&weights]].concat()).swap_remove(0)
    };
    let matrix: Vec<Vec<Traced>> = (0..rows).map(row).collect();
    let columns = x.iter().map(|input| input.len()).sum();
    (0..columns).map(|column| matrix.iter().map(|row| row[column]).collect()).collect()
}

/// The columns of the whole matrix, those of known inputs by their program.
fn by_columns(program: &Program, known: Option<&Program>, x: &[&[Traced]], outputs: usize) -> Vec<Vec<Traced>> {
    let found = known.map(|known| known.evaluate(x));
    let mut matrix = Vec::new();
    for (i, array) in program.inputs().iter().enumerate() {
        let name = format!("d_{}", array.name);
        let place = known.and_then(|known| known.outputs().iter().position(|output| output.name == name));
        if let (Some(found), Some(place)) = (&found, place) {
            let rows = found[place].chunks(array.length.max(1));
            matrix.extend((0..array.length).map(|column| rows.clone().map(|row| row[column]).collect::<Vec<_>>()));
            continue;
        }
        for k in 0..array.length {
            let direction: Vec<Traced> =
                (0..array.length).map(|entry| Traced::from(f64::from(u8::from(entry == k)))).collect();
            let seeded = x.iter().enumerate();
            let seeded: Vec<Vec<Dual<Traced>>> =
                seeded.map(|(j, x)| if j == i { Dual::list(x, &direction) } else { Dual::constants(x) }).collect();
            let mut found = program.evaluate(&seeded.iter().map(Vec::as_slice).collect::<Vec<_>>());
            found.truncate(outputs);
            matrix.push(found.into_iter().flatten().map(|y| y.derivative).collect());
        }
    }
    matrix
}
