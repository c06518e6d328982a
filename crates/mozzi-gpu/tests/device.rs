//! Kernels on a GPU, compared with the CPU. Skipped without one.
#![allow(missing_docs)]

use crate::common;

use common::{LAYOUTS, PRECISIONS, embedded, error, form, inputs, quantities, robots, transposed};
use mozzi::quantities::{InverseDynamics, Query};
use mozzi_engine::{CudaLayout, Precision};
use mozzi_gpu::{Device, DeviceArray, Error, Kernel, Number, Source};

fn device() -> Option<Device> {
    match Device::first() {
        Ok(device) => Some(device),
        Err(error) => {
            eprintln!("skipped: {error}");
            None
        }
    }
}

/// The kernel's results by rows.
fn compute<T: Number + Into<f64>>(
    kernel: &Kernel,
    rows: &[Vec<f64>],
    states: usize,
    number: fn(f64) -> T,
) -> Vec<Vec<f64>> {
    let is_columns = kernel.layout() == CudaLayout::Columns;
    let inputs = rows.iter().zip(kernel.source().inputs());
    let inputs: Vec<Vec<T>> = inputs
        .map(|(x, input)| if is_columns { transposed(x, input.length) } else { x.clone() })
        .map(|x| x.into_iter().map(number).collect())
        .collect();
    let outputs = kernel.compute(&inputs.iter().map(Vec::as_slice).collect::<Vec<_>>()).expect("a device");
    let wide = outputs.into_iter().map(|x| x.into_iter().map(Into::into).collect::<Vec<f64>>());
    wide.map(|x| if is_columns { transposed(&x, states) } else { x }).collect()
}

#[test]
fn every_robot_quantity_precision_and_layout() {
    let Some(device) = device() else { return };
    const STATES: usize = 1000;
    for model in robots() {
        for query in quantities() {
            let rows = inputs(&model, query, STATES);
            let lengths: Vec<usize> = query.input_lengths(&model).collect();
            for (precision, layout) in PRECISIONS.into_iter().flat_map(|x| LAYOUTS.map(|layout| (x, layout))) {
                let kernel = device.kernel(&Source::new(&model, query, form(precision, layout)).expect("a text"));
                let kernel = kernel.expect("a kernel");
                let (found, rounded): (_, fn(f64) -> f64) = match precision {
                    Precision::F64 => (compute(&kernel, &rows, STATES, |x| x), |x| x),
                    Precision::F32 => (compute(&kernel, &rows, STATES, |x| x as f32), |x| f64::from(x as f32)),
                };
                for i in [0, 1, 31, 32, 500, 999] {
                    let state: Vec<Vec<f64>> = rows
                        .iter()
                        .zip(&lengths)
                        .map(|(x, n)| x[i * n..(i + 1) * n].iter().map(|&x| rounded(x)).collect())
                        .collect();
                    let state: Vec<&[f64]> = state.iter().map(Vec::as_slice).collect();
                    let expected = model.compute(query, &state, &model.environment()).expect("regular");
                    for (found, expected) in found.iter().zip(expected) {
                        let n = expected.len();
                        let error = error(&found[i * n..(i + 1) * n], &expected, n);
                        let epsilon = if precision == Precision::F64 { f64::EPSILON } else { f32::EPSILON.into() };
                        let what = format!("{} {precision:?} {layout:?}, state {i}", kernel.source().entry());
                        assert!(error < 1000.0 * epsilon, "{what}: {} eps", error / epsilon);
                    }
                }
            }
        }
    }
}

#[test]
fn wrong_arrays_are_named() {
    let Some(device) = device() else { return };
    let source = Source::new(&embedded("ur5"), Query::from(InverseDynamics), form(Precision::F32, CudaLayout::Rows));
    let kernel = device.kernel(&source.expect("a text")).expect("a kernel");
    let refused = |inputs: &[&[f32]]| kernel.compute(inputs).expect_err("wrong arrays").to_string();
    let text = refused(&[&[0.0; 12], &[0.0; 12], &[0.0; 6]]);
    assert!(text.contains("ddtheta has 6 numbers, expected 12"), "{text}");
    assert!(refused(&[&[0.0; 12]]).contains("3 inputs, found 1"));
    assert!(matches!(kernel.compute(&[&[0.0_f64; 6][..]; 3]), Err(Error::WrongPrecision { .. })));
    let array: DeviceArray<f32> = device.copy(&[1.0, 2.0]).expect("memory");
    assert_eq!(array.to_vec().expect("a copy"), [1.0, 2.0]);
    assert!(kernel.compute::<f32>(&[&[][..]; 3]).expect("no states")[0].is_empty());
}
