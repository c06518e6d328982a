//! Every quantity, on every kind of registers that the machine has, beside mozzi's methods at one state.

#[macro_use]
mod quantities;

use mozzi::simulation::{Method, Options};
use mozzi::testing::{Random, floating_tree, state, tree, wrench};
use mozzi::{Environment, FrameId, Model, Wrench};
use mozzi_batch::{Batch, BatchEnvironment, InstructionSet, Layout, Number};

/// States side by side.
struct States {
    theta: Vec<f64>,
    dtheta: Vec<f64>,
    x: Vec<f64>,
    wrenches: Vec<f64>,
}

impl States {
    fn new(model: &Model, count: usize) -> Self {
        let mut all = States { theta: vec![], dtheta: vec![], x: vec![], wrenches: vec![] };
        for k in 0..count {
            let [theta, dtheta, x] = state(model, k as u64);
            all.theta.extend(theta);
            all.dtheta.extend(dtheta);
            all.x.extend(x);
            all.wrenches.extend(wrench(k as u64).to_array());
        }
        all
    }
}

fn robots() -> Vec<Model> {
    vec![tree(1, 7, 0), tree(2, 9, 2), floating_tree(3, 6, 0), floating_tree(4, 8, 2), tree(5, 1, 0)]
}

fn numbers<T: Number>(list: &[f64]) -> Vec<T> {
    list.iter().map(|&x| T::from_f64(x)).collect()
}

macro_rules! against_one_state {
    ($T:ty, $count:expr, $close:expr) => {
        for model in robots() {
            let (nq, n, count) = (model.nq(), model.n(), $count);
            let (states, tip) = (States::new(&model, count), model.end_effector().unwrap());
            let shared = [(tip, wrench(77))];
            let environment = Environment { applied: &shared, ..model.environment() };
            let [q, v, a, F] = [&states.theta, &states.dtheta, &states.x, &states.wrenches].map(|x| numbers::<$T>(x));
            let wrenches = [(tip, &F[..])];
            let surroundings = BatchEnvironment { environment, wrenches: &wrenches };
            for set in InstructionSet::available() {
                let batch = Batch::<$T>::of(&model).with_instruction_set(set).unwrap().with_threads(1).unwrap();
                for (name, widths, of_batch, at_one) in quantities!($T) {
                    let widths = widths(n);
                    let mut found: Vec<Vec<$T>> = widths.iter().map(|w| vec![<$T>::NAN; w * count]).collect();
                    of_batch(&batch, tip, &[&q, &v, &a], &surroundings, &mut found).expect(name);
                    for k in 0..count {
                        let own = Wrench::from_array(core::array::from_fn(|i| states.wrenches[6 * k + i]));
                        let applied = [shared[0], (tip, own)];
                        let environment = Environment { applied: &applied, ..environment };
                        let part = |x: &[f64], w: usize| x[k * w..(k + 1) * w].to_vec();
                        let (q, v, a) = (part(&states.theta, nq), part(&states.dtheta, n), part(&states.x, n));
                        let expected = at_one(&model, tip, [&q, &v, &a], &environment);
                        for ((found, w), expected) in found.iter().zip(&widths).zip(&expected) {
                            $close(set, name, &found[k * w..(k + 1) * w], &expected[..]);
                        }
                    }
                }
            }
        }
    };
}

#[test]
fn f64_agrees_to_rounding_and_portably_to_the_bit() {
    against_one_state!(f64, 11, |set: InstructionSet, name: &str, found: &[f64], expected: &[f64]| {
        let scale = expected.iter().fold(1e-3_f64, |m, x| m.max(x.abs()));
        for (f, e) in found.iter().zip(expected) {
            if set == InstructionSet::Portable {
                assert!(f.to_bits() == e.to_bits() || f == e, "{name}: {f} {e}");
            } else {
                // forward dynamics and its derivatives lose what M's condition loses
                let bound = if name.starts_with("forward_dynamics") || name.starts_with("task") { 1e-8 } else { 1e-12 };
                assert!((f - e).abs() <= bound * scale, "{name} on {}: {f} {e}", set.name());
            }
        }
    });
}

#[test]
fn f32_agrees_to_its_rounding() {
    against_one_state!(f32, 5, |set: InstructionSet, name: &str, found: &[f32], expected: &[f64]| {
        if name.starts_with("forward_dynamics") || name.starts_with("task") {
            return; // these trees' masses differ by 10⁴: see the test on an arm
        }
        let scale = expected.iter().fold(1e-3_f64, |m, x| m.max(x.abs()));
        for (&f, &e) in found.iter().zip(expected) {
            assert!((f64::from(f) - e).abs() <= 2e-4 * scale, "{name} on {}: {f} {e}", set.name());
        }
    });
}

#[test]
fn f32_forward_dynamics_undoes_inverse_dynamics() {
    let model = tree(6, 3, 0);
    let (states, surroundings) = (States::new(&model, 21), model.environment().into());
    let [q, v, a] = [&states.theta, &states.dtheta, &states.x].map(|x| numbers::<f32>(x));
    for set in InstructionSet::available() {
        let batch = Batch::<f32>::of(&model).with_instruction_set(set).unwrap();
        let (mut tau, mut again) = (vec![0.0; a.len()], vec![0.0; a.len()]);
        batch.inverse_dynamics(&q, &v, &a, &surroundings, &mut tau).unwrap();
        batch.forward_dynamics(&q, &v, &tau, &surroundings, &mut again).unwrap();
        for (x, y) in a.iter().zip(&again) {
            assert!((x - y).abs() < 2e-2, "{x} {y} on {}", set.name());
        }
    }
}

#[test]
fn threads_and_layouts_change_no_bit() {
    for model in [tree(1, 7, 0), floating_tree(3, 6, 0)] {
        let (count, nq, n) = (5003, model.nq(), model.n());
        let (states, surroundings) = (States::new(&model, count), BatchEnvironment::from(model.environment()));
        for set in InstructionSet::available() {
            let batch = Batch::new(&model).with_instruction_set(set).unwrap();
            let run = |batch: &Batch, wide: bool| {
                let [q, v, a] = [(&states.theta, nq), (&states.dtheta, n), (&states.x, n)]
                    .map(|(x, w)| if wide { batch.to_blocks(x, w) } else { x.clone() });
                let mut tau = vec![f64::NAN; v.len()];
                batch.inverse_dynamics(&q, &v, &a, &surroundings, &mut tau).unwrap();
                let mut M = vec![f64::NAN; v.len() * n];
                batch.mass_matrix(&q, &mut M).unwrap();
                if wide { (batch.to_rows(&tau, n, count), batch.to_rows(&M, n * n, count)) } else { (tau, M) }
            };
            let one = run(&batch.clone().with_threads(1).unwrap(), false);
            assert!(one == run(&batch, false));
            assert!(one == run(&batch.clone().with_threads(3).unwrap(), false));
            assert!(one == run(&batch.clone().with_layout(Layout::Blocks), true));
        }
    }
}

#[test]
fn a_state_that_is_no_number_spoils_no_other() {
    let model = tree(1, 7, 0);
    let n = model.n();
    let (mut states, surroundings) = (States::new(&model, 40), BatchEnvironment::from(model.environment()));
    for set in InstructionSet::available() {
        let batch = Batch::new(&model).with_instruction_set(set).unwrap();
        let run = |states: &States| {
            let mut x = vec![0.0; 40 * n];
            batch.forward_dynamics(&states.theta, &states.dtheta, &states.x, &surroundings, &mut x).unwrap();
            x
        };
        let clean = run(&states);
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let before = std::mem::replace(&mut states.theta[13 * n + 2], bad);
            for (k, (a, b)) in run(&states).chunks(n).zip(clean.chunks(n)).enumerate() {
                if k == 13 { assert!(a.iter().any(|x| x.is_nan())) } else { assert_eq!(a, b) }
            }
            states.theta[13 * n + 2] = before;
        }
    }
}

#[test]
fn many_turns_are_reduced_exactly() {
    let model = tree(1, 7, 0);
    let mut states = States::new(&model, 9);
    let mut random = Random(5);
    for x in &mut states.theta {
        *x += 1e3 * (random.next() * 12.0).exp2() * 1e5;
    }
    let (n, environment) = (model.n(), model.environment());
    for set in InstructionSet::available() {
        let batch = Batch::new(&model).with_instruction_set(set).unwrap();
        let mut g = vec![0.0; 9 * n];
        batch.gravity_forces(&states.theta, &environment.into(), &mut g).unwrap();
        for (theta, g) in states.theta.chunks(n).zip(g.chunks(n)) {
            let expected = model.gravity_forces(theta).unwrap();
            for (a, b) in g.iter().zip(expected.iter()) {
                assert!((a - b).abs() <= 1e-12 * expected.amax(), "{a} {b} on {}", set.name());
            }
        }
    }
}

#[test]
fn many_robots_move_as_each_alone() {
    for model in [tree(5, 3, 0), floating_tree(3, 3, 0)] {
        let (count, nq, n) = (601, model.nq(), model.n()); // more than a piece
        let mut states = States::new(&model, count);
        states.dtheta.iter_mut().for_each(|x| *x *= 0.1);
        let surroundings = BatchEnvironment::from(model.environment());
        let (duration, steps) = (0.02, 4);
        for method in [Method::Euler, Method::SemiImplicitEuler, Method::RungeKutta4] {
            for set in InstructionSet::available() {
                let batch = Batch::new(&model).with_instruction_set(set).unwrap();
                let (mut q, mut v) = (states.theta.clone(), states.dtheta.clone());
                batch.simulate(&mut q, &mut v, &states.x, &surroundings, method, duration, steps).unwrap();
                for k in [0, 17, 600] {
                    let tau = states.x[k * n..][..n].to_vec();
                    let input = mozzi::simulation::torque(|_t, _q, _v, out| out.copy_from_slice(&tau));
                    let options = Options { method, ..Options::new(duration, steps) };
                    let (q0, v0) = (&states.theta[k * nq..][..nq], &states.dtheta[k * n..][..n]);
                    let alone = model.simulate(q0, v0, input, &options).unwrap();
                    let end = alone.last();
                    for (a, b) in
                        q[k * nq..][..nq].iter().chain(&v[k * n..][..n]).zip(end.theta.iter().chain(end.dtheta.iter()))
                    {
                        assert!((a - b).abs() <= 1e-9 * (1.0 + b.abs()), "{a} {b} on {}", set.name());
                    }
                }
                // in blocks, and on other threads, to the bit
                let blocks = batch.clone().with_layout(Layout::Blocks).with_threads(2).unwrap();
                let (mut q2, mut v2) = (blocks.to_blocks(&states.theta, nq), blocks.to_blocks(&states.dtheta, n));
                let tau = blocks.to_blocks(&states.x, n);
                blocks.simulate(&mut q2, &mut v2, &tau, &surroundings, method, duration, steps).unwrap();
                assert!(q == blocks.to_rows(&q2, nq, count) && v == blocks.to_rows(&v2, n, count));
            }
        }
    }
}

#[test]
fn a_task_of_six_rows_and_one_that_cannot_be() {
    let model = (0..1000).map(|seed| tree(seed, 9, 0)).find(|m| {
        let [q, v, _] = state(m, 1);
        let task = mozzi::Task::all(m.end_effector().unwrap(), mozzi::TaskFrame::Body);
        m.task_space_dynamics(&q, &v, task, &m.environment()).is_ok()
    });
    let model = model.expect("one of a thousand trees reaches in all directions");
    let (n, task) = (model.n(), mozzi::Task::all(model.end_effector().unwrap(), mozzi::TaskFrame::Body));
    let (states, surroundings) = (States::new(&model, 13), BatchEnvironment::from(model.environment()));
    for set in InstructionSet::available() {
        let batch = Batch::new(&model).with_instruction_set(set).unwrap();
        let (mut Lambda, mut eta) = (vec![0.0; 13 * 36], vec![0.0; 13 * 6]);
        batch.task_space_dynamics(task, &states.theta, &states.dtheta, &surroundings, &mut Lambda, &mut eta).unwrap();
        for k in 0..13 {
            let (q, v) = (&states.theta[k * n..][..n], &states.dtheta[k * n..][..n]);
            let one = model.task_space_dynamics(q, v, task, &model.environment()).unwrap();
            for (a, b) in Lambda[k * 36..][..36].iter().zip(one.Lambda.iter()) {
                assert!((a - b).abs() <= 1e-6 * one.Lambda.amax(), "{a} {b} on {}", set.name());
            }
            for (a, b) in eta[k * 6..][..6].iter().zip(one.eta.iter()) {
                assert!((a - b).abs() <= 1e-6 * (one.eta.amax() + one.Lambda.amax()), "{a} {b} on {}", set.name());
            }
        }
        // three joints cannot move a frame in six directions
        let short = tree(1, 3, 0);
        let (states, task) =
            (States::new(&short, 2), mozzi::Task::all(short.end_effector().unwrap(), mozzi::TaskFrame::Body));
        let batch = Batch::new(&short).with_instruction_set(set).unwrap();
        let (mut Lambda, mut eta) = (vec![0.0; 72], vec![0.0; 12]);
        let error = batch
            .task_space_dynamics(
                task,
                &states.theta,
                &states.dtheta,
                &short.environment().into(),
                &mut Lambda,
                &mut eta,
            )
            .expect_err("singular")
            .to_string();
        assert!(error.starts_with("state 0 (counted from 0): the task is singular at θ = "), "{error}");
    }
}
