//! Kernels allocate nothing, and long chains cost no more than their length.
#![allow(clippy::unwrap_used)]

use mozzi::model::{HomeFrames, Screws};
use mozzi::{Description, Model, SE3, ScrewAxis, SpatialInertia, Sym3, Twist, Vec3, Workspace, fast};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

struct Counting;
thread_local!(static ALLOCATIONS: Cell<usize> = const { Cell::new(0) });

// SAFETY: hands every call on to the system's allocator.
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
fn kernels_allocate_nothing() {
    let mut robot = chain(7).description().clone();
    robot.joints[6].mimic = Some(mozzi::model::description::Mimic { joint: "joint3".into(), ratio: -0.5, offset: 0.1 });
    for model in [chain(7), robot.build().unwrap()] {
        let n = model.n();
        let (theta, dtheta, ddtheta) = (vec![0.3; n], vec![-0.2; n], vec![0.7; n]);
        let (mut tau, mut M, mut J) = (vec![0.0; n], vec![0.0; n * n], vec![Twist::zero(); n]);
        let mut H = vec![Twist::zero(); n * n];
        let mut by = [vec![0.0; n * n], vec![0.0; n * n], vec![0.0; n * n]];
        let tip = model.end_effector().unwrap();
        let push = [(tip, mozzi::Wrench::from_array([1.0; 6]))];
        let environment = mozzi::Environment { applied: &push, ..model.environment() };
        let (mut w, mut fast) = (Workspace::new(&model), fast::Workspace::new(&model));
        let mut poses = vec![SE3::identity(); model.frames().len()];

        let before = ALLOCATIONS.get();
        mozzi::inverse_dynamics(&model, &theta, &dtheta, &ddtheta, &environment, &mut w, &mut tau);
        mozzi::forward_dynamics(&model, &theta, &dtheta, &ddtheta, &environment, &mut w, &mut tau);
        mozzi::forward_dynamics_by_mass_matrix(
            &model,
            &theta,
            &dtheta,
            &ddtheta,
            &environment,
            &mut w,
            &mut M,
            &mut tau,
        );
        mozzi::mass_matrix(&model, &theta, &mut w, &mut M);
        mozzi::mass_matrix_rate(&model, &theta, &dtheta, &mut w, &mut M);
        mozzi::coriolis_matrix(&model, &theta, &dtheta, &mut w, &mut M);
        mozzi::bias_forces(&model, &theta, &dtheta, &environment, &mut w, &mut tau);
        mozzi::velocity_product(&model, &theta, &dtheta, &mut w, &mut tau);
        mozzi::gravity_forces(&model, &theta, model.gravity(), &mut w, &mut tau);
        mozzi::tip_forces(&model, &theta, &push, &mut w, &mut tau);
        mozzi::kinetic_energy(&model, &theta, &dtheta, Twist::zero(), &mut w);
        mozzi::potential_energy(&model, &theta, model.gravity(), &mut w);
        mozzi::forward_kinematics(&model, &theta, tip);
        mozzi::frame_poses(&model, &theta, &mut w, &mut poses);
        mozzi::space_jacobian(&model, &theta, tip, &mut J);
        mozzi::body_jacobian(&model, &theta, tip, &mut J);
        mozzi::space_jacobian_rate(&model, &theta, &dtheta, tip, &mut w, &mut J);
        mozzi::body_jacobian_rate(&model, &theta, &dtheta, tip, &mut J);
        mozzi::space_jacobian_derivative(&model, &theta, tip, &mut w, &mut H);
        fast::inverse_dynamics(&model, &theta, &dtheta, &ddtheta, &environment, &mut fast, &mut tau);
        fast::forward_dynamics(&model, &theta, &dtheta, &ddtheta, &environment, &mut fast, &mut tau);
        fast::mass_matrix(&model, &theta, &mut fast, &mut M);
        fast::coriolis_matrix(&model, &theta, &dtheta, &mut fast, &mut M);
        let x = &ddtheta;
        mozzi::gravity_forces_derivative(&model, &theta, model.gravity(), &mut w, &mut M);
        mozzi::tip_forces_derivative(&model, &theta, &push, &mut w, &mut M);
        mozzi::mass_matrix_product_derivative(&model, &theta, x, &mut w, &mut M);
        let three = by.each_mut().map(|matrix| &mut matrix[..]);
        mozzi::inverse_dynamics_derivatives(&model, &theta, &dtheta, x, &environment, &mut w, three);
        let three = by.each_mut().map(|matrix| &mut matrix[..]);
        mozzi::forward_dynamics_derivatives(&model, &theta, &dtheta, x, &environment, &mut w, &mut tau, three);
        let three = by.each_mut().map(|matrix| &mut matrix[..]);
        fast::inverse_dynamics_derivatives(&model, &theta, &dtheta, x, &environment, &mut fast, three);
        let three = by.each_mut().map(|matrix| &mut matrix[..]);
        fast::forward_dynamics_derivatives(&model, &theta, &dtheta, x, &environment, &mut fast, &mut tau, three);
        assert_eq!(ALLOCATIONS.get() - before, 0);
        assert!(tau.iter().chain(&M).chain(by.iter().flatten()).all(|x| x.is_finite()));
    }
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
    // so long a chain is badly conditioned: compare the torques that the accelerations found need
    let mut again = vec![0.0_f64; n];
    mozzi::inverse_dynamics(&model, &theta, &dtheta, &found, &environment, &mut w, &mut again);
    let scale = tau.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert!(again.iter().zip(&tau).all(|(a, b)| (a - b).abs() < 1e-9 * scale));
    assert_eq!(model.screws().M.len(), n);
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
