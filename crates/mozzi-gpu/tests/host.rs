//! The emitted kernels on the host, compared with the CPU's kernels in 64 bits.
#![allow(missing_docs)]

use crate::common;

use common::host::{Call, exists, run};
use common::{LAYOUTS, PRECISIONS, embedded, error, form, inputs, quantities, robots, transposed};
use mozzi::quantities::{
    ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, InverseDynamicsVjp, MassMatrix, Query,
    TaskSpaceDynamics,
};
use mozzi::testing::{limbs, tree};
use mozzi::{Description, HomeFrames, Model, SE3, ScrewAxis, Screws, SpatialInertia, Sym3, Vec3};
use mozzi_engine::{CudaLayout, Precision};
use mozzi_gpu::{Error, Form, Source};

/// Two whole warps and a part of one.
const STATES: usize = 75;

/// The kernel's results at random states, by rows.
fn results(name: &str, cases: Vec<(&Model, Query, Form)>) -> Vec<Vec<Vec<f64>>> {
    let call = |&(model, query, form): &(&Model, Query, Form)| {
        let source = Source::new(model, query, form).expect("a text");
        let rows = inputs(model, query, STATES);
        let inputs = match form.layout {
            CudaLayout::Rows => rows,
            CudaLayout::Columns => {
                rows.iter().zip(source.inputs()).map(|(x, input)| transposed(x, input.length)).collect()
            }
        };
        Call { source, inputs, states: STATES, rollout: None }
    };
    let calls: Vec<Call> = cases.iter().map(call).collect();
    let mut results = run(name, &calls);
    for (outputs, (_, _, form)) in results.iter_mut().zip(&cases) {
        if form.layout == CudaLayout::Columns {
            outputs.iter_mut().for_each(|output| *output = transposed(output, STATES));
        }
    }
    results
}

/// The same by the CPU's kernels, at the states rounded to the precision.
fn expected(model: &Model, query: Query, precision: Precision) -> Vec<Vec<f64>> {
    let rounded = |x: f64| if precision == Precision::F64 { x } else { f64::from(x as f32) };
    let arrays: Vec<Vec<f64>> =
        inputs(model, query, STATES).into_iter().map(|x| x.into_iter().map(rounded).collect()).collect();
    let lengths: Vec<usize> = query.input_lengths(model).collect();
    let mut outputs: Vec<Vec<f64>> = vec![Vec::new(); query.declaration().outputs.len()];
    for i in 0..STATES {
        let state: Vec<&[f64]> = arrays.iter().zip(&lengths).map(|(x, n)| &x[i * n..(i + 1) * n]).collect();
        let computed = model.compute(query, &state, &model.environment()).expect("regular");
        outputs.iter_mut().zip(computed).for_each(|(all, one)| all.extend(one));
    }
    outputs
}

/// In ε, relative to the largest entry of a state: sums, solves.
fn tolerance(query: Query) -> f64 {
    match query.name() {
        "forward_dynamics" | "forward_dynamics_vjp" => 1000.0,
        _ => 50.0,
    }
}

#[test]
fn every_robot_quantity_precision_and_layout() {
    if !exists() {
        return;
    }
    for model in robots() {
        let name = &model.description().name;
        let forms = PRECISIONS.into_iter().flat_map(|precision| LAYOUTS.map(|layout| form(precision, layout)));
        let cases: Vec<(&Model, Query, Form)> =
            forms.flat_map(|form| quantities().map(|query| (&model, query, form))).collect();
        let found = results(&format!("{name} {}", model.is_floating()), cases.clone());
        for ((_, query, form), found) in cases.into_iter().zip(found) {
            let epsilon = if form.precision == Precision::F64 { f64::EPSILON } else { f32::EPSILON.into() };
            let expected = expected(&model, query, form.precision);
            let lengths: Vec<usize> = query.output_lengths(&model).collect();
            for ((found, expected), &length) in found.iter().zip(&expected).zip(&lengths) {
                let error = error(found, expected, length) / epsilon;
                eprintln!("{name} {} {form:?}: {error:.1} eps", query.name());
                assert!(error < tolerance(query), "{name} {} {form:?}: {error} eps", query.name());
            }
        }
    }
}

/// Results that do not fit into shared memory as they lie; every robot's numbers are compared above.
#[test]
fn long_rows_of_sparse_results_pass_through_slots() {
    let model = robots().pop().expect("the floating quadruped");
    let text = |precision, layout| {
        let source = Source::new(&model, InverseDynamicsDerivatives, form(precision, layout)).expect("a source");
        source.text().to_string()
    };
    let rows = text(Precision::F32, CudaLayout::Rows);
    assert!(rows.contains("_spread<324, ") && rows.contains("_slots[324] = {"), "{rows}");
    let arm = Source::new(&embedded("panda"), InverseDynamicsDerivatives, Form::default()).expect("a source");
    assert!(!arm.text().contains("_slots"));
}

/// Programs of many joints, by columns, of which each thread takes several states.
#[test]
fn long_programs_are_in_parts() {
    if !exists() {
        return;
    }
    let model = limbs(&tree(3, 28, 0), 7);
    let query = Query::from(InverseDynamicsVjp);
    for precision in PRECISIONS {
        let form = form(precision, CudaLayout::Columns);
        let source = Source::new(&model, query, form).expect("a text");
        assert!(source.states_of_thread() > 1 && source.text().contains(" kept_["), "{}", model.n());
        let found = results(&format!("parts {precision:?}"), vec![(&model, query, form)]);
        let epsilon = if precision == Precision::F64 { f64::EPSILON } else { f32::EPSILON.into() };
        for (found, expected) in found[0].iter().zip(expected(&model, query, precision)) {
            let error = error(found, &expected, model.n()) / epsilon;
            assert!(error < tolerance(query), "{precision:?}: {error} eps");
        }
    }
    let arm = Source::new(&embedded("panda"), query, form(Precision::F32, CudaLayout::Columns)).expect("a text");
    assert!(arm.states_of_thread() == 1 && !arm.text().contains("kept_"));
}

#[test]
fn packed_matrices_are_the_lower_triangle_by_rows() {
    let (model, query) = (embedded("panda"), Query::from(MassMatrix));
    let n = model.n();
    let packed = Form { is_packed: true, ..form(Precision::F64, CudaLayout::Rows) };
    let source = Source::new(&model, query, packed).expect("a symmetric matrix");
    assert_eq!(source.outputs()[0].length, n * (n + 1) / 2);
    let refused = Source::new(&model, InverseDynamics, packed).expect_err("no matrix").to_string();
    assert!(refused.contains("inverse_dynamics") && refused.contains("symmetric"), "{refused}");
    if !exists() {
        return;
    }
    let found = results("packed", vec![(&model, query, packed)]);
    let expected = expected(&model, query, Precision::F64);
    let triangle = |M: &[f64]| (0..n).flat_map(|i| M[i * n..=i * n + i].to_vec()).collect::<Vec<f64>>();
    let expected: Vec<f64> = expected[0].chunks(n * n).flat_map(triangle).collect();
    assert!(error(&found[0][0], &expected, n * (n + 1) / 2) < 1e-14);
}

/// Two revolute joints and a point mass at the end, which a straight arm cannot move outward.
fn massless_arm() -> Model {
    let home = [1.0, 2.0, 2.0].map(|x| SE3::translation([x, 0.0, 0.0]));
    let screws = [0.0, 1.0].map(|x| ScrewAxis::from_line([0.0, -1.0, 0.0], [x, 0.0, 0.0], 0.0).expect("unit"));
    let point = SpatialInertia::new(1.0, Vec3::zero(), Sym3::diagonal(0.0, 0.0, 0.0));
    let bodies = [SpatialInertia::zero(), point];
    let robot = Description::from_screws("arm", HomeFrames::Base(&home), &bodies, Screws::Space(&screws));
    robot.expect("sound").build().expect("sound")
}

#[test]
fn a_singular_mass_matrix_gives_nan_and_tasks_are_refused() {
    let model = massless_arm();
    let task = Query::from(TaskSpaceDynamics).of(model.end_effector().expect("an end"));
    assert!(matches!(Source::new(&model, task, Form::default()), Err(Error::Unsupported { .. })));
    let (straight, bent) = ([0.3, 0.0], [0.3, 1.0]);
    let compute = |theta: &[f64]| model.forward_dynamics(theta, &[0.1, 0.2], &[1.0, -1.0], &model.environment());
    assert!(compute(&straight).is_err());
    let expected = compute(&bent).expect("regular");
    if !exists() {
        return;
    }
    let calls = PRECISIONS.map(|precision| {
        let source = Source::new(&model, ForwardDynamics, form(precision, CudaLayout::Rows)).expect("a text");
        let inputs = vec![[straight, bent].concat(), [0.1, 0.2].repeat(2), [1.0, -1.0].repeat(2)];
        Call { source, inputs, states: 2, rollout: None }
    });
    for outputs in run("singular", &calls) {
        assert!(outputs[0][..2].iter().all(|x| x.is_nan()), "{:?}", outputs[0]);
        assert!(error(&outputs[0][2..], expected.as_slice(), 2) < 1e-5, "{:?}", outputs[0]);
    }
}
