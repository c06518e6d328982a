//! Robots, states, and kernels that run on the host.
#![allow(dead_code, missing_docs)] // each test uses a part

pub mod host;

use mozzi::quantities::{
    ForwardDynamics, ForwardDynamicsVjp, InverseDynamics, InverseDynamicsDerivatives, InverseDynamicsVjp, MassMatrix,
    Query,
};
use mozzi::{Base, Model};
use mozzi_engine::{CudaLayout, Precision};
use mozzi_gpu::{Form, Nvrtc};
use std::path::{Path, PathBuf};

pub const PRECISIONS: [Precision; 2] = [Precision::F32, Precision::F64];
pub const LAYOUTS: [CudaLayout; 2] = [CudaLayout::Rows, CudaLayout::Columns];

/// The quantities that docs/gpu.md lists.
pub fn quantities() -> [Query<'static>; 6] {
    [
        InverseDynamics.into(),
        ForwardDynamics.into(),
        MassMatrix.into(),
        InverseDynamicsDerivatives.into(),
        InverseDynamicsVjp.into(),
        ForwardDynamicsVjp.into(),
    ]
}

pub fn embedded(name: &str) -> Model {
    mozzi_urdf::open(name).and_then(|robot| robot.build()).expect("an embedded robot")
}

/// The embedded robots, and a floating quadruped.
pub fn robots() -> Vec<Model> {
    let mut robots: Vec<Model> = mozzi_urdf::embedded::names().map(embedded).collect();
    robots.push(embedded("anymal").with_base(Base::Floating).expect("sound"));
    robots
}

pub fn form(precision: Precision, layout: CudaLayout) -> Form {
    Form { precision, layout, is_packed: false }
}

/// The compiler in `MOZZI_NVRTC`, in the environment, or in the wheels of `cargo xtask gpu-report`.
pub fn nvrtc() -> Option<Nvrtc> {
    let folders = ["../../target/nvidia", "../../target/venv"].map(|x| Path::new(env!("CARGO_MANIFEST_DIR")).join(x));
    let libraries = folders.iter().filter_map(|folder| std::fs::read_dir(folder.join("lib")).ok()).flatten();
    let packages: Vec<PathBuf> =
        libraries.filter_map(|version| Some(version.ok()?.path().join("site-packages"))).collect();
    let found = Nvrtc::find().or_else(|_| Nvrtc::in_packages(&packages)).ok();
    if found.is_none() {
        eprintln!("skipped: no NVRTC here; `cargo xtask gpu-report` installs one, or set MOZZI_NVRTC");
    }
    found
}

/// The inputs of a quantity at these many random states, each array by rows.
pub fn inputs(model: &Model, query: Query, states: usize) -> Vec<Vec<f64>> {
    let names = query.declaration().inputs.iter().map(|input| input.name);
    let of_state = |seed: usize| mozzi::testing::state(model, seed as u64 + 1);
    let array = |name: &str| -> Vec<f64> {
        let entries = |k: usize| match name {
            "theta" => of_state(k)[0].clone(),
            "dtheta" => of_state(k)[1].clone(),
            "x" => of_state(k + states)[2].clone(),
            _ => of_state(k)[2].clone(),
        };
        (0..states).flat_map(entries).collect()
    };
    names.map(array).collect()
}

/// Entry k of state i from i · length + k to k · states + i, or back if `length` is the number of states.
pub fn transposed(x: &[f64], length: usize) -> Vec<f64> {
    let states = x.len() / length.max(1);
    (0..length).flat_map(|k| (0..states).map(move |i| x[i * length + k])).collect()
}

/// The largest difference in a state, relative to the state's largest entry.
pub fn error(found: &[f64], expected: &[f64], length: usize) -> f64 {
    assert_eq!(found.len(), expected.len());
    let of_state = |(found, expected): (&[f64], &[f64])| {
        let size = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        // a NaN stays
        let worst = found.iter().zip(expected).map(|(x, y)| (x - y).abs()).fold(0.0, |m, x| if x <= m { m } else { x });
        if worst == 0.0 { 0.0 } else { worst / size }
    };
    let states = found.chunks(length.max(1)).zip(expected.chunks(length.max(1)));
    states.map(of_state).fold(0.0, |m, x| if x <= m { m } else { x })
}
