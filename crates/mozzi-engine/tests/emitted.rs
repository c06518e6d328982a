//! Emitted text, compiled and run, compared with the interpreter.
#![allow(missing_docs)]

use crate::common;
use crate::harness;

use common::{compute, error, inputs, published, state, tree};
use harness::{Call, Module, build, exists, rounded, run};
use mozzi::quantities::{
    BodyJacobian, CenterOfMassJacobian, ForwardDynamics, ForwardKinematics, GravityForces, InverseDynamics,
    InverseDynamicsDerivatives, JointFriction, MassMatrix, MassMatrixProductDerivative, Momentum, PotentialEnergy,
    Query, Regressor, SpaceJacobian, SpringForces, TaskSpaceDynamics,
};
use mozzi::random::Random;
use mozzi::{Base, Model, Scalar, Task, TaskFrame, Vec3};
use mozzi_engine::{
    Arguments, Derivative, EmitError, Language, Precision, Program, SourceFile, Traced, emit, emit_programs, record,
    record_quantity,
};
use std::process::Command;

fn embedded(name: &str) -> Model {
    mozzi_urdf::open(name).and_then(|robot| robot.build()).expect("an embedded robot")
}

/// The same robot under another name.
fn named(model: &Model, name: &str) -> Model {
    let mut robot = model.description().clone();
    robot.name = name.to_string();
    robot.build().expect("sound")
}

/// States of a robot: random, at rest at zero, with a NaN angle, with an angle that is too large.
fn states(model: &Model, program: &Program, angle: usize, precision: Precision) -> Vec<Vec<Vec<f64>>> {
    let filled = |[theta, dtheta, x]: [Vec<f64>; 3]| -> Vec<Vec<f64>> {
        let array = |name: &str| match name {
            "theta" => theta.clone(),
            "dtheta" => dtheta.clone(),
            "ddtheta" | "tau" | "x" => x.clone(),
            "theta_rate" | "tau_rate" => dtheta.clone(),
            "dtheta_rate" | "ddtheta_rate" => x.clone(),
            "parameters" => model.parameters(),
            "gravity" => vec![1.0, 2.0, -9.0],
            "about" => vec![0.3, -0.2, 0.1],
            six => Random(six.bytes().map(u64::from).sum()).vector(6, 5.0), // a twist or a wrench
        };
        let arrays = program.inputs().iter().map(|input| array(&input.name));
        arrays.map(|x| x.into_iter().map(|x| rounded(x, precision)).collect()).collect()
    };
    let mut zero = [vec![0.0; model.nq()], vec![0.0; model.n()], vec![0.0; model.n()]];
    if model.is_floating() {
        zero[0][0] = 1.0;
    }
    let mut states = vec![filled(state(model, 1)), filled(state(model, 2)), filled(zero)];
    for wrong in [f64::NAN, 1.1 * precision.largest_angle(), -f64::INFINITY] {
        let mut of_wrong = state(model, 3);
        of_wrong[0][angle] = wrong;
        states.push(filled(of_wrong));
    }
    states
}

/// Only sine, cosine, square root and sign, at many numbers.
fn basics(language: Language, precision: Precision) -> Module {
    let program = record("basics", &[("x", 2)], |x| {
        let ((sin, cos), y) = (x[0][0].sin_cos(), x[0][1]);
        vec![("sin_cos", vec![sin, cos]), ("rest", vec![y.sqrt(), y.sgn()])]
    })
    .expect("short");
    let mut random = Random(7);
    let small = if precision == Precision::F64 { 1e-310 } else { 1e-40 };
    let largest = precision.largest_angle();
    let mut ys = vec![0.0, -0.0, 1.0, -1.0, small, 1e38, 1e-38, f64::INFINITY, f64::NAN];
    ys.extend((0..300).map(|k| random.next() * 2.0_f64.powi(k % 60 - 40)));
    let state = |y: f64| {
        let x = (random.next() * 10.0_f64.powi(random.below(7) as i32)).clamp(-largest, largest);
        vec![vec![rounded(x, precision), rounded(y, precision)]]
    };
    let mut states: Vec<Vec<Vec<f64>>> = ys.into_iter().map(state).collect();
    states.push(vec![vec![largest, 4.0]]);
    let files = emit_programs("alone", std::slice::from_ref(&program), language, precision).expect("text");
    Module { files, calls: vec![Call { function: "basics".to_string(), program, states }] }
}

/// The robots' texts and the calls: fixed and floating base, friction, further arguments; and a pose, named by its
/// frame.
fn modules(language: Language, precision: Precision) -> Vec<Module> {
    let last = |model: &Model| model.frames().last().expect("a frame").0;
    let (panda, ur5) = (embedded("panda"), embedded("ur5"));
    let anymal = embedded("anymal").with_base(Base::Floating).expect("sound");
    let hand = Query::from(ForwardKinematics).of(last(&panda));
    let tools = [last(&ur5), ur5.frame("forearm_link").expect("a frame")];
    let fixed = Arguments::default();
    let open = Arguments { parameters: true, gravity: true, wrenches: &tools[..1], ..fixed };
    let carried =
        Arguments { gravity: true, base_twist: true, base_acceleration: true, about: true, wrenches: &tools, ..fixed };
    let rubbing = tree(3, 9, 0).build().expect("sound");
    let turning = rubbing.joint_names().position(|name| name == "joint2").expect("a joint that only turns");
    let dynamics = || vec![InverseDynamics.into(), MassMatrix.into(), ForwardDynamics.into()];
    let momentum = Query::from(Momentum).about(Vec3([0.5, -0.25, 1.0]));
    let of_masses = [momentum, PotentialEnergy.into(), CenterOfMassJacobian.into(), MassMatrixProductDerivative.into()];
    let task = Task { frame: tools[0], coordinates: TaskFrame::Body, rows: &[2, 3, 4] };
    let task = Query::from(TaskSpaceDynamics).of_task(task);
    let moved = [&of_masses[..], &[InverseDynamics.into(), Regressor.into(), task]].concat();
    let mut robots = vec![
        (panda, [&dynamics()[..], &[hand], &of_masses].concat(), fixed, 3),
        (anymal, vec![InverseDynamics.into(), ForwardDynamics.into()], fixed, 9),
        (rubbing, vec![InverseDynamics.into(), JointFriction.into(), SpringForces.into()], fixed, turning),
        (named(&ur5, "moved"), moved, carried, 3),
        (
            named(&ur5, "along"),
            vec![InverseDynamics.into(), ForwardDynamics.into()],
            Arguments { derivative: Derivative::RATES, ..fixed },
            3,
        ),
        (ur5, vec![InverseDynamics.into()], open, 3),
    ];
    if precision == Precision::F64 {
        let ur5 = embedded("ur5");
        let loaded = ur5.with_payload(tools[0], mozzi::Solid::Sphere { radius: 0.05 }.inertia(1.0)).expect("a load");
        let frames = [BodyJacobian.into(), SpaceJacobian.into()].map(|query: Query| query.of(tools[0]));
        let all = [MassMatrix.into(), InverseDynamicsDerivatives.into(), GravityForces.into(), Regressor.into()];
        robots.push((named(&loaded, "loaded"), [&all[..], &frames].concat(), fixed, 1));
        let pendulums = ["double_pendulum", "furuta_pendulum", "two_link_planar"].map(embedded);
        robots.extend(pendulums.into_iter().map(|robot| (robot, dynamics(), fixed, 1)));
        let arms = published().into_iter().map(|(_, robot)| robot).filter(|robot| (6..8).contains(&robot.n()));
        robots.extend(arms.map(|robot| (robot, dynamics(), fixed, 1)));
    }
    let of_robot = |(model, queries, open, angle): (Model, Vec<Query>, Arguments, usize)| {
        let call = |&query: &Query| {
            let program = record_quantity(&model, query, open).expect("its own frames");
            let frame = query.subject.frame.map(|frame| format!("_{}", model.frame_name(frame)));
            let states = states(&model, &program, angle, precision);
            Call { function: format!("{}{}", program.name(), frame.unwrap_or_default()), program, states }
        };
        let files = emit(&model, &queries, open, language, precision).expect("text");
        Module { files, calls: queries.iter().map(call).collect() }
    };
    robots.into_iter().map(of_robot).chain([basics(language, precision)]).collect()
}

/// The tolerance in units of the precision's ε relative to the largest entry: a few for sums, more for solves.
fn tolerance(function: &str) -> f64 {
    match function {
        "forward_dynamics" | "forward_dynamics_jvp" => 100.0,
        "basics" => 2.0,
        _ => 20.0,
    }
}

/// The test program's results agree with the interpreter's in 64 bits, and are NaN if an angle is NaN or too large.
fn check(what: &str, precision: Precision, modules: &[Module], results: &[Vec<Vec<Vec<f64>>>]) {
    let epsilon = if precision == Precision::F64 { f64::EPSILON } else { f32::EPSILON.into() };
    let calls = modules.iter().flat_map(|module| module.calls.iter().map(move |call| (module.name(), call)));
    for ((robot, call), found) in calls.zip(results) {
        let mut worst = 0.0_f64;
        let is_wrong = |x: &f64| x.is_nan() || x.abs() > precision.largest_angle();
        for (k, (inputs, found)) in call.states.iter().zip(found).enumerate() {
            let given = inputs;
            let mut inputs = inputs.clone();
            if call.program.inputs()[0].name == "theta" {
                inputs[0].iter_mut().filter(|x| is_wrong(x)).for_each(|x| *x = f64::NAN);
            }
            let slices: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
            let expected = call.program.evaluate(&slices);
            for (found, expected) in found.iter().zip(&expected) {
                let place = format!("{what}, {robot} {} at state {k}: {found:?}, expected {expected:?}", call.function);
                let pairs: Vec<(f64, f64)> = found.iter().copied().zip(expected.iter().copied()).collect();
                // the regressor contains the angle itself, for a spring: an entry that is finite even if the angle is
                // too large for a sine
                let is_given = |x: f64, y: f64| y.is_nan() && call.function == "regressor" && given[0].contains(&x);
                let pairs: Vec<_> = pairs.into_iter().filter(|&(x, y)| !is_given(x, y)).collect();
                assert!(pairs.iter().all(|(x, y)| x.is_nan() == y.is_nan()), "{place}");
                if call.function == "basics" {
                    // relative to each result itself; a sine near 0 relative to 1
                    for (x, y) in pairs.iter().filter(|(x, y)| !x.is_nan() && x != y) {
                        let size = if y.abs() < f64::from(f32::MIN_POSITIVE) { 1.0 } else { y.abs() };
                        worst = worst.max((x - y).abs() / size);
                        assert!((x - y).abs() / size < tolerance("basics") * epsilon, "{place}");
                    }
                    continue;
                }
                let (found, expected): (Vec<f64>, Vec<f64>) =
                    pairs.iter().copied().filter(|(x, _)| !x.is_nan()).unzip();
                let error = error(&found, &expected);
                assert!(error < tolerance(&call.function) * epsilon, "{error:e}, {place}");
                worst = worst.max(error);
            }
        }
        eprintln!("{what}, {robot} {}: {:.1} eps", call.function, worst / epsilon);
    }
}

#[test]
fn rust() {
    for precision in [Precision::F64, Precision::F32] {
        if !exists("rustc") {
            return;
        }
        let modules = modules(Language::Rust, precision);
        let flags = ["-Copt-level=1", "-Cpanic=abort", "-Coverflow-checks=on"];
        let folder = build(Language::Rust, precision, &modules, &format!("rust {precision:?}"), "rustc", &flags);
        check(&format!("Rust {precision:?}"), precision, &modules, &run(&folder, precision, &modules));
        let assembly = std::fs::read_to_string(folder.join("emitted.s")).expect("assembly");
        assert!(assembly.contains("inverse_dynamics") && !assembly.contains("panic"));
    }
}

#[test]
fn c() {
    let strict = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror"];
    let ways: [(&str, Precision, &[&str]); 4] = [
        ("gcc", Precision::F64, &["-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]),
        ("gcc", Precision::F32, &["-O1", "-Wdouble-promotion"]),
        ("clang", Precision::F64, &["-O1"]),
        ("clang", Precision::F32, &["-O1", "-Wdouble-promotion"]),
    ];
    for (compiler, precision, flags) in ways {
        if !exists(compiler) {
            continue;
        }
        let modules = modules(Language::C, precision);
        let name = format!("{compiler} {precision:?}");
        let folder = build(Language::C, precision, &modules, &name, compiler, &[&strict, flags].concat());
        check(&name, precision, &modules, &run(&folder, precision, &modules));
        // a compiler option that reorders sums is refused
        let fast = ["-ffast-math", "-fsyntax-only", "panda.c"];
        let output = Command::new(compiler).args(fast).current_dir(&folder).output().expect("a compiler");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && said.contains("-ffast-math"), "{said}");
        // C++ reads the header
        std::fs::write(folder.join("header.cpp"), "#include \"panda.h\"\n#include \"panda.h\"\n").expect("a file");
        harness::compile(&folder, compiler, &["-fsyntax-only", "-Wall", "-Wextra", "-Werror", "header.cpp"]);
    }
}

#[test]
fn cuda_on_the_host() {
    for precision in [Precision::F64, Precision::F32] {
        if !exists("g++") {
            return;
        }
        let modules = modules(Language::Cuda, precision);
        let flags = ["-std=c++20", "-pthread", "-O0", "-Wall", "-Wextra", "-Werror", "-Wno-unknown-pragmas"];
        let folder = build(Language::Cuda, precision, &modules, &format!("cuda {precision:?}"), "g++", &flags);
        check(&format!("CUDA {precision:?}"), precision, &modules, &run(&folder, precision, &modules));
    }
}

#[test]
fn cuda_keeps_its_numbers_in_registers() {
    if !exists("nvcc") {
        return;
    }
    let folder = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("nvcc");
    std::fs::create_dir_all(&folder).expect("a folder");
    for precision in [Precision::F64, Precision::F32] {
        let queries = [InverseDynamics.into(), ForwardDynamics.into()];
        let files = emit(&embedded("panda"), &queries, Arguments::default(), Language::Cuda, precision);
        files.expect("text")[0].write(&folder).expect("a file");
        let arguments = ["-arch=sm_90", "-Xptxas", "-v", "-cubin", "-o", "panda.cubin", "panda.cu"];
        let output = Command::new("nvcc").args(arguments).current_dir(&folder).output().expect("a compiler");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && !said.contains("warning"), "{said}");
        // two quantities on two layouts
        assert_eq!(said.matches("0 bytes stack frame, 0 bytes spill stores, 0 bytes spill loads").count(), 4, "{said}");
        let registers = said.lines().filter(|line| line.contains("Used "));
        registers.for_each(|line| eprintln!("{precision:?}: {line}"));
    }
}

#[test]
fn the_interpreter_is_the_kernel() {
    let (model, query) = (embedded("panda"), Query::from(InverseDynamics));
    let program = record_quantity(&model, query, Arguments::default()).expect("no frame");
    let found = program.evaluate(&inputs(query, &state(&model, 1)));
    let expected = compute(&model, query, 1).expect("lengths");
    assert!(error(&found[0], &expected[0]) < 2e-14);
}

#[test]
fn what_cannot_be_written_is_refused() {
    let model = embedded("ur5");
    let fixed = Arguments::default();
    let nothing = emit(&model, &[], fixed, Language::C, Precision::F64);
    assert!(matches!(nothing, Err(EmitError::Nothing)));
    let far = embedded("anymal").frames().last().expect("a frame").0;
    let of_other = [Query::from(ForwardKinematics).of(far), ForwardKinematics.into()];
    for query in of_other {
        let refused = emit(&model, &[query], fixed, Language::Rust, Precision::F64);
        assert!(matches!(refused, Err(EmitError::Frame(_))));
    }
    let of = |f: fn(Traced) -> Traced| record("f", &[("x", 1)], |x| vec![("y", vec![f(x[0][0])])]).expect("short");
    let tanh = emit_programs("f", &[of(|x| x.tanh())], Language::Rust, Precision::F64);
    assert!(tanh.is_err_and(|error| error.to_string().contains("tanh")));
    let large = [of(|x| x + Traced::from(1e300))];
    assert!(emit_programs("f", &large, Language::C, Precision::F64).is_ok());
    let error = emit_programs("f", &large, Language::C, Precision::F32).expect_err("no such f32").to_string();
    assert!(error.contains("1e300") && error.contains("F32"), "{error}");
}

#[test]
fn files_are_written_where_they_differ() {
    let folder = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("files are written");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    let files = emit(&embedded("ur5"), &[GravityForces.into()], Arguments::default(), Language::C, Precision::F64);
    let files = files.expect("text");
    let written = || {
        let path = files[0].write(&folder).expect("a folder");
        std::fs::metadata(path).and_then(|file| file.modified()).expect("a file")
    };
    let first = written();
    std::thread::sleep(std::time::Duration::from_millis(20));
    assert_eq!(written(), first);
    std::fs::write(folder.join("ur5.h"), "changed").expect("a file");
    written();
    assert_eq!(std::fs::read_to_string(folder.join("ur5.h")).expect("text"), files[0].text);
}

#[test]
fn threads_write_into_one_folder() {
    let folder = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("threads write");
    let _ = std::fs::remove_dir_all(&folder);
    let write = |k: usize| {
        for text in 0..200 {
            let file = SourceFile { name: format!("{k}.c"), text: format!("{k} {text}") };
            let path = file.write(&folder).expect("written");
            assert_eq!(std::fs::read_to_string(path).expect("a file"), file.text);
        }
    };
    std::thread::scope(|scope| (0..2).for_each(|k| drop(scope.spawn(move || write(k)))));
}

#[test]
fn a_cosine_without_its_sine_is_counted() {
    let of = |f: fn(Traced) -> Traced| record("f", &[("x", 1)], |x| vec![("y", vec![f(x[0][0])])]).expect("short");
    let both = of(|x| x.sin_cos().0 + x.sin_cos().1);
    assert_eq!([of(|x| x.sin_cos().1), both].map(|program| program.count().sin_cos), [1, 1]);
}
