//! Simulations allocate only what they record, and the cost of long chains grows only with their length. The
//! conformance test of `mozzi-engine` checks that quantities do not allocate.
#![allow(clippy::unwrap_used)]

use mozzi::model::{HomeFrames, Screws};
use mozzi::{Description, Model, SE3, ScrewAxis, SpatialInertia, Sym3, Twist, Vec3, Workspace};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

struct Counting;
thread_local!(static ALLOCATIONS: Cell<usize> = const { Cell::new(0) });

// SAFETY: forwards every call to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        // SAFETY: the caller's contract.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's contract.
        unsafe { System.dealloc(pointer, layout) }
    }
}
#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn chain(n: usize) -> Model {
    let frames: Vec<SE3> =
        (0..=n).map(|i| SE3::exp(Twist::from_array([0.0, 0.3 * (i % 5) as f64, 0.1, 0.2, 0.0, 0.1]))).collect();
    let body = SpatialInertia::new(1.0, Vec3([0.0, 0.1, 0.05]), Sym3::diagonal(0.02, 0.03, 0.04));
    let z = ScrewAxis::new([0.0, 0.0, 1.0], [0.0; 3]).unwrap();
    let robot =
        Description::from_screws("chain", HomeFrames::Relative(&frames), &vec![body; n], Screws::Link(&vec![z; n]));
    robot.unwrap().build().unwrap()
}

#[test]
fn ten_thousand_links() {
    let n = 10_000;
    let model = chain(n);
    let (theta, dtheta, ddtheta) = (vec![1e-3; n], vec![1e-3; n], vec![1e-3; n]);
    let (mut tau, mut found, mut w) = (vec![0.0_f64; n], vec![0.0; n], Workspace::new(&model));
    let environment = model.environment();
    mozzi::inverse_dynamics(&model, &theta, &dtheta, &ddtheta, &environment, &mut w, &mut tau);
    mozzi::forward_dynamics(&model, &theta, &dtheta, &tau, &environment, &mut w, &mut found);
    // such a long chain is ill-conditioned: compare the torques that the found accelerations need
    let mut again = vec![0.0_f64; n];
    mozzi::inverse_dynamics(&model, &theta, &dtheta, &found, &environment, &mut w, &mut again);
    let scale = tau.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert!(again.iter().zip(&tau).all(|(a, b)| (a - b).abs() < 1e-9 * scale));
    assert_eq!(model.screws().expect("one axis a joint").M.len(), n);
}

#[test]
fn a_simulation_allocates_what_it_records() {
    use mozzi::simulation::{GravityCompensation, Method, Options, Table, TorqueTable, applied};
    let model = chain(7);
    let tip = model.end_effector().unwrap();
    let allocations = |method, steps| {
        let table = Table::new(vec![0.0, 1.0], vec![0.5; 14]).unwrap();
        let push = applied(tip, |_, _, _| mozzi::Wrench::from_array([0.1; 6]));
        let input = (GravityCompensation::new(&model), (TorqueTable(table), push));
        let options = Options { method, record_every: steps, ..Options::new(0.1, steps) };
        let before = ALLOCATIONS.get();
        let motion = model.simulate(&[0.3; 7], &[-0.2; 7], input, &options).unwrap();
        assert_eq!(motion.len(), 2);
        ALLOCATIONS.get() - before
    };
    for method in [Method::Euler, Method::SemiImplicitEuler, Method::RungeKutta4] {
        assert_eq!(allocations(method, 10), allocations(method, 1000));
    }
}
