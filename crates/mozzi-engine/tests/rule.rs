//! When machine code is made: by the sizes of a batch's calls alone.

use mozzi::quantities::{InverseDynamics, MassMatrix};
use mozzi::testing::{state, tree};
use mozzi::{FrameId, Model, Vec3};
use mozzi_engine::{Batch, BatchEnvironment, Engine, Number, Refusal};

fn has_code() -> bool {
    <f64 as Number>::shape().is_some()
}

/// Computes M at so many equal states.
fn call(batch: &Batch, states: usize, environment: &BatchEnvironment) -> Vec<f64> {
    let n = batch.model().n();
    let (theta, mut M) = (state(batch.model(), 1)[0].repeat(states), vec![0.0; states * n * n]);
    batch.compute(MassMatrix, &[&theta], environment, &mut [&mut M]).expect("lengths");
    M
}

fn is_code(engine: Engine) -> bool {
    matches!(engine, Engine::MachineCode(..))
}

fn robot() -> Model {
    tree(1, 7, 0)
}

#[test]
fn a_large_call_makes_code_and_small_ones_together() {
    let (model, batch) = (robot(), Batch::new(&robot()));
    let environment = model.environment().into();
    assert_eq!(
        batch.engine(MassMatrix),
        Engine::Kernels(if has_code() { Refusal::NotYet } else { Refusal::Processor })
    );
    call(&batch, 1000, &environment);
    assert_eq!(is_code(batch.engine(MassMatrix)), has_code());
    // calls of another quantity, and of another batch of the same robot, do not count
    assert!(!is_code(batch.engine(InverseDynamics)) && !is_code(Batch::new(&model).engine(MassMatrix)));
    let small = Batch::new(&model);
    let clone = small.clone().with_threads(1).expect("one");
    for calls in 1..=10 {
        assert!(!is_code(small.engine(MassMatrix)), "{calls}");
        call(if calls % 2 == 0 { &small } else { &clone }, 100, &environment);
    }
    assert_eq!(is_code(small.engine(MassMatrix)), has_code());
}

#[test]
fn each_environment_has_its_own_code() {
    let (model, batch) = (robot(), Batch::new(&robot()));
    let (tip, n): (FrameId, usize) = (model.end_effector().expect("named"), model.n());
    let theta = state(&model, 1)[0].repeat(1000);
    let wrenches = [1.0; 6].repeat(1000);
    let of_tip = [(tip, &wrenches[..])];
    let with_wrench = BatchEnvironment::from(model.environment()).with_wrenches(&of_tip);
    let (zero, mut tau) = (vec![0.0; n * 1000], vec![0.0; n * 1000]);
    batch.compute(InverseDynamics, &[&theta, &zero, &zero], &with_wrench, &mut [&mut tau]).expect("lengths");
    assert_eq!(is_code(batch.engine_in(InverseDynamics, &with_wrench)), has_code());
    let mut other = model.environment();
    other.gravity = Vec3([0.0, 1.0, 2.0]);
    assert!(!is_code(batch.engine(InverseDynamics)) && !is_code(batch.engine_in(InverseDynamics, &other.into())));
}

#[test]
fn kernels_only_is_for_ever() {
    let (model, batch) = (robot(), Batch::new(&robot()).kernels_only());
    let environment = model.environment().into();
    let M = call(&batch, 5000, &environment);
    assert_eq!(batch.engine(MassMatrix), Engine::Kernels(Refusal::NotAsked));
    let batch = batch.compile(&[MassMatrix.into()]).expect("no frame");
    assert_eq!(batch.engine(MassMatrix), Engine::Kernels(Refusal::NotAsked));
    let theta = &state(&model, 1)[0];
    let (mut workspace, mut one) = (mozzi::fast::Workspace::new(&model), vec![0.0; 49]);
    let query = MassMatrix.into();
    mozzi::fast::evaluate(&query, &model, &[theta], &model.environment(), &mut workspace, &mut [&mut one]);
    assert!(M.chunks_exact(49).all(|M| M == one), "to the bit");
}

#[test]
fn a_job_has_one_engine() {
    let (model, batch) = (robot(), Batch::new(&robot()));
    let environment: BatchEnvironment = model.environment().into();
    let (few, many) = [10, 2000].map(|states| batch.for_job_of(&[MassMatrix.into()], &environment, states)).into();
    let (few, many) = (few.expect("no frame"), many.expect("no frame"));
    assert_eq!(is_code(many.engine(MassMatrix)), has_code());
    call(&few, 5000, &environment);
    assert!(!is_code(few.engine(MassMatrix)), "as decided");
    call(&many, 5000, &environment);
    assert!(!is_code(many.engine(InverseDynamics)));
}

#[test]
fn many_threads_make_it_once_and_agree() {
    let model = robot();
    let batch = Batch::new(&model).with_threads(1).expect("one");
    let environment: BatchEnvironment = model.environment().into();
    let found: Vec<Vec<f64>> = std::thread::scope(|scope| {
        let calls: Vec<_> = (0..8).map(|_| scope.spawn(|| call(&batch, 1500, &environment))).collect();
        calls.into_iter().map(|call| call.join().expect("no panic")).collect()
    });
    assert!(found.iter().all(|M| *M == found[0]));
}
