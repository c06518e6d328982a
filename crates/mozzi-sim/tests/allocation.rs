//! Simulations allocate only what they record.

use mozzi::model::{HomeFrames, Screws};
use mozzi::{Description, Model, SE3, ScrewAxis, SpatialInertia, Sym3, Twist, Vec3};
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
fn a_simulation_allocates_what_it_records() {
    use mozzi_sim::{GravityCompensation, Method, Options, Table, TorqueTable, applied, simulate};
    let model = chain(7);
    let tip = model.end_effector().unwrap();
    let allocations = |method, steps| {
        let table = Table::new(vec![0.0, 1.0], vec![0.5; 14]).unwrap();
        let push = applied(tip, |_, _, _| mozzi::Wrench::from_array([0.1; 6]));
        let input = (GravityCompensation::new(&model), (TorqueTable(table), push));
        let options = Options { method, record_every: steps, ..Options::new(0.1, steps) };
        let before = ALLOCATIONS.get();
        let motion = simulate(&model, &[0.3; 7], &[-0.2; 7], input, &options).unwrap();
        assert_eq!(motion.len(), 2);
        ALLOCATIONS.get() - before
    };
    for method in [Method::Euler, Method::SemiImplicitEuler, Method::RungeKutta4] {
        assert_eq!(allocations(method, 10), allocations(method, 1000));
    }
}
