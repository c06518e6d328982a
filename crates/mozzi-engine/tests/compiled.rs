//! The compiled robot: same results and errors as the model's methods.
#![allow(missing_docs)]

use crate::common;

use common::{error, inputs, quantities, robots, state, tolerance};
use mozzi::fast;
use mozzi::quantities::{BodyJacobian, ForwardDynamics, InverseDynamics, MassMatrix, Query};
use mozzi_engine::{Compiled, Engine, Refusal, Shape, compile};

fn is_shared<T: Send + Sync>(_: &T) {}

/// The outputs of a quantity, checked.
fn compute(robot: &Compiled, query: Query, inputs: &[&[f64]]) -> Result<Vec<Vec<f64>>, mozzi::Error> {
    let mut found: Vec<Vec<f64>> = query.output_lengths(robot.model()).map(|length| vec![f64::NAN; length]).collect();
    robot.compute(query, inputs, &mut found.iter_mut().map(Vec::as_mut_slice).collect::<Vec<_>>())?;
    Ok(found)
}

#[test]
fn results_are_the_models() {
    for (name, model) in robots() {
        let robot = compile(&model, &quantities(&model)).expect("its own frames");
        is_shared(&robot);
        for query in quantities(&model) {
            for seed in 0..4 {
                let state = state(&model, seed);
                let found = compute(&robot, query, &inputs(query, &state)).expect("regular");
                let expected = common::compute(&model, query, seed).expect("regular");
                for (found, expected) in found.iter().zip(&expected) {
                    let error = error(found, expected);
                    assert!(error < tolerance(query), "{name}, {}: {error:e}", query.name());
                }
                // unchecked, for control loops
                let mut again: Vec<Vec<f64>> = found.iter().map(|x| vec![f64::NAN; x.len()]).collect();
                let mut slices: Vec<&mut [f64]> = again.iter_mut().map(Vec::as_mut_slice).collect();
                let are_clear = robot.evaluate(query, &inputs(query, &state), &mut slices);
                assert!(!are_clear || again == found, "{name}, {}", query.name());
            }
        }
    }
}

fn panda() -> (mozzi::Model, Compiled) {
    let model = mozzi_urdf::open("panda").and_then(|robot| robot.build()).expect("an embedded robot");
    let robot = compile(&model, &[InverseDynamics.into(), ForwardDynamics.into()]).expect("no frames");
    (model, robot)
}

#[test]
fn what_computes_is_told() {
    let (_, robot) = panda();
    assert_eq!(robot.engine(MassMatrix), Engine::Kernels(Refusal::NotAsked));
    assert_eq!(robot.engine(MassMatrix).to_string(), "kernels: machine code was not requested");
    let engine = robot.engine(InverseDynamics);
    let one = Shape::one_f64();
    match one.is_supported() {
        true => assert!(matches!(engine, Engine::MachineCode(shape, 1000..=20_000) if shape == one), "{engine}"),
        false => assert_eq!(engine, Engine::Kernels(Refusal::Processor)),
    }
}

#[test]
fn turns_of_thousands_of_kilometres_and_nan_go_to_the_kernels() {
    let (model, robot) = panda();
    let mut state = state(&model, 3);
    state[0][2] = 1e12;
    let query = Query::from(InverseDynamics);
    let (mut w, mut tau) = (fast::Workspace::new(&model), vec![f64::NAN; model.n()]);
    fast::evaluate(&query, &model, &inputs(query, &state), &model.environment(), &mut w, &mut [&mut tau]);
    assert_eq!(compute(&robot, query, &inputs(query, &state)).expect("lengths"), [tau]);
    state[0][2] = f64::NAN;
    let found = compute(&robot, query, &inputs(query, &state)).expect("lengths");
    assert!(found[0].iter().any(|x| x.is_nan()));
}

#[test]
fn errors_are_the_models() {
    let (model, robot) = panda();
    let [theta, dtheta, x] = state(&model, 3);
    let short = [&theta[1..], &dtheta, &x];
    let found = compute(&robot, InverseDynamics.into(), &short).expect_err("short");
    let expected = model.compute(InverseDynamics, &short, &model.environment()).expect_err("short");
    assert_eq!(found.to_string(), expected.to_string());
    let other = common::tree(1, 3, 0).build().expect("sound");
    let frame = model.frames().last().expect("a frame").0;
    let error = compile(&other, &[Query::from(BodyJacobian).of(frame)]).expect_err("another's");
    assert!(error.to_string().contains("another model"), "{error}");
    // a massless tip that turns freely
    let mut robot = common::tree(2, 3, 0);
    let joint = robot.joints.last_mut().expect("one");
    (joint.armature, joint.damping, joint.friction) = (0.0, 0.0, 0.0);
    robot.links.last_mut().expect("one").inertia = mozzi::SpatialInertia::zero();
    let massless = robot.build().expect("sound");
    let compiled = compile(&massless, &[ForwardDynamics.into()]).expect("no frames");
    let [theta, dtheta, tau] = state(&massless, 1);
    let error = compute(&compiled, ForwardDynamics.into(), &[&theta, &dtheta, &tau]).expect_err("singular");
    assert!(error.to_string().contains("singular at joint `joint3`"), "{error}");
}

/// A planar arm whose tool's axes went through rotations that cancel: what it cannot do is 10⁻¹⁷ instead of 0.
const PLANAR: &str = r#"<robot name="planar">
  <link name="base"/>
  <link name="upper"><inertial><origin xyz="0.3 0 0"/><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="fore"><inertial><origin xyz="0.2 0 0"/><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="a"/><link name="b"/><link name="c"/><link name="tool"/>
  <joint name="j1" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/></joint>
  <joint name="j2" type="continuous"><parent link="upper"/><child link="fore"/><origin xyz="0.6 0 0"/><axis xyz="0 0 1"/></joint>
  <joint name="f1" type="fixed"><parent link="fore"/><child link="a"/><origin xyz="0.4 0 0" rpy="0.7 0 0"/></joint>
  <joint name="f2" type="fixed"><parent link="a"/><child link="b"/><origin rpy="0 0.3 0"/></joint>
  <joint name="f3" type="fixed"><parent link="b"/><child link="c"/><origin rpy="0 -0.3 0"/></joint>
  <joint name="f4" type="fixed"><parent link="c"/><child link="tool"/><origin rpy="-0.7 0 0"/></joint>
</robot>"#;

#[test]
fn a_row_that_only_rounding_moves_is_singular() {
    let model = mozzi_urdf::parse("planar.urdf", PLANAR).expect("a robot").build().expect("a model");
    let frame = model.frame("tool").expect("named");
    let (theta, dtheta) = ([0.3, 0.5], [0.1, 0.2]);
    let inputs = [&theta[..], &dtheta];
    for (rows, is_singular) in [(&[5][..], true), (&[0, 5], true), (&[5, 3], true), (&[2], false), (&[3, 4], false)] {
        let task = mozzi::Task { frame, coordinates: mozzi::TaskFrame::Body, rows };
        let query = Query::from(mozzi::quantities::TaskSpaceDynamics).of_task(task);
        let plain = model.compute(query, &inputs, &model.environment());
        let compiled = compute(&compile(&model, &[query]).expect("its own frame"), query, &inputs);
        for found in [plain.map(|_| ()), compiled.map(|_| ())] {
            let is_error = matches!(found, Err(mozzi::Error::SingularTask { .. }));
            assert_eq!(is_error, is_singular, "rows {rows:?}: {found:?}");
        }
        let mut outputs: Vec<Vec<f64>> = query.output_lengths(&model).map(|length| vec![0.0; length]).collect();
        let mut slices: Vec<&mut [f64]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
        let mut workspace = fast::Workspace::new(&model);
        fast::evaluate(&query, &model, &inputs, &model.environment(), &mut workspace, &mut slices);
        let found = workspace.singular(&query, &model, &theta, &mut [0.0; 4]);
        assert_eq!(found.is_some(), is_singular, "rows {rows:?}, fast");
    }
}
