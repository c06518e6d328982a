//! The interface of CasADi's external functions: names, sizes, sparsities, values and Jacobians.
#![allow(missing_docs)]

use crate::common;
use crate::harness;

use common::state;
use harness::{compile, exists};
use libloading::Library;
use mozzi::quantities::{
    BodyJacobian, ForwardDynamics, ForwardKinematics, InverseDynamics, InverseDynamicsDerivatives, MassMatrix,
    PotentialEnergy, Query,
};
use mozzi::{Base, Model};
use mozzi_engine::{Arguments, Derivative, Program, emit_casadi, record_quantity};
use std::ffi::{CStr, c_char, c_int, c_longlong};
use std::path::{Path, PathBuf};
use std::process::Command;

type Text = extern "C" fn(c_longlong) -> *const c_char;
type Pattern = extern "C" fn(c_longlong) -> *const c_longlong;
type Count = extern "C" fn() -> c_longlong;
type Work = extern "C" fn(*mut c_longlong, *mut c_longlong, *mut c_longlong, *mut c_longlong) -> c_int;
type Evaluate = extern "C" fn(*mut *const f64, *mut *mut f64, *mut c_longlong, *mut f64, c_int) -> c_int;

/// A function of a library, called as CasADi calls it.
struct External<'l> {
    library: &'l Library,
    name: String,
}

impl External<'_> {
    /// The function of this ending; `F` is its type.
    fn symbol<F: Copy>(&self, ending: &str) -> F {
        // SAFETY: each caller gives the type that CasADi's interface has for this ending
        unsafe { *self.library.get::<F>(format!("{}{ending}", self.name).as_bytes()).expect("a function") }
    }

    fn count(&self, side: &str) -> usize {
        self.symbol::<Count>(&format!("_n_{side}"))() as usize
    }

    fn names(&self, side: &str) -> Vec<String> {
        let get: Text = self.symbol(&format!("_name_{side}"));
        // SAFETY: a name is a literal of the library
        let text = |k| unsafe { CStr::from_ptr(get(k)) }.to_str().expect("ASCII").to_string();
        (0..self.count(side) as c_longlong).map(text).collect()
    }

    /// Rows, columns, and the place of each entry in a full matrix by columns.
    fn pattern(&self, side: &str, k: usize) -> (usize, usize, Vec<usize>) {
        let numbers = self.symbol::<Pattern>(&format!("_sparsity_{side}"))(k as c_longlong);
        // SAFETY: a sparsity has at least three numbers, and those that its column counts announce
        let at = |k: usize| unsafe { *numbers.add(k) as usize };
        let (rows, columns) = (at(0), at(1));
        if at(2) == 1 {
            return (rows, columns, (0..rows * columns).collect());
        }
        let row = |entry: usize| at(3 + columns + entry);
        let column = |c: usize| (at(2 + c)..at(3 + c)).map(move |entry| c * rows + row(entry));
        (rows, columns, (0..columns).flat_map(column).collect())
    }

    /// Full outputs by columns, NaN before; 0 if the evaluation succeeded. `is_wanted` outputs alone are filled.
    fn evaluate(&self, inputs: &[Option<&[f64]>], is_wanted: impl Fn(usize) -> bool) -> (Vec<Vec<f64>>, c_int) {
        let mut sizes = [0; 4];
        let [arg, res, iw, w] = &mut sizes;
        assert_eq!(self.symbol::<Work>("_work")(arg, res, iw, w), 0);
        assert_eq!((sizes[0] as usize, sizes[1] as usize), (self.count("in"), self.count("out")));
        let patterns: Vec<_> = (0..self.count("out")).map(|k| self.pattern("out", k)).collect();
        let mut filled: Vec<Vec<f64>> = patterns.iter().map(|(.., places)| vec![f64::NAN; places.len()]).collect();
        let mut arg: Vec<*const f64> = inputs.iter().map(|x| x.map_or(std::ptr::null(), <[f64]>::as_ptr)).collect();
        arg.resize(sizes[0] as usize, std::ptr::null());
        let pointer = |(k, x): (usize, &mut Vec<f64>)| if is_wanted(k) { x.as_mut_ptr() } else { std::ptr::null_mut() };
        let mut res: Vec<*mut f64> = filled.iter_mut().enumerate().map(pointer).collect();
        let (mut iw, mut w) = (vec![0; sizes[2] as usize + 1], vec![f64::NAN; sizes[3] as usize + 1]);
        let run: Evaluate = self.symbol("");
        let failed = run(arg.as_mut_ptr(), res.as_mut_ptr(), iw.as_mut_ptr(), w.as_mut_ptr(), 0);
        assert!(w.last().is_some_and(|x| x.is_nan()), "it stays within its work space");
        let full = |((rows, columns, places), entries): (&(usize, usize, Vec<usize>), Vec<f64>)| {
            let mut full = vec![0.0; rows * columns];
            places.iter().zip(entries).for_each(|(&place, x)| full[place] = x);
            full
        };
        (patterns.iter().zip(filled).map(full).collect(), failed)
    }
}

fn embedded(name: &str) -> Model {
    mozzi_urdf::open(name).and_then(|robot| robot.build()).expect("an embedded robot")
}

fn library(folder: &Path, model: &Model, queries: &[Query], arguments: Arguments) -> Library {
    let files = emit_casadi(model, queries, arguments).expect("text");
    let path = files[0].write(folder).expect("a file");
    let (source, shared) = (path.to_str().expect("a path"), path.with_extension("so"));
    let flags = ["-std=c99", "-O0", "-Wall", "-Wextra", "-Werror", "-pedantic", "-shared", "-fPIC", source, "-o"];
    compile(folder, "cc", &[&flags[..], &[shared.to_str().expect("a path"), "-lm"]].concat());
    // SAFETY: the library has no initializers
    unsafe { Library::new(shared) }.expect("a library")
}

fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn inputs_of(model: &Model, program: &Program) -> Vec<Vec<f64>> {
    let [theta, dtheta, x] = state(model, 5);
    let array = |name: &str| match name {
        "theta" => theta.clone(),
        "dtheta" => dtheta.clone(),
        "gravity" => vec![1.0, 2.0, -9.0],
        "wrench" => vec![0.1, -0.2, 0.3, 4.0, 5.0, -6.0],
        _ => x.clone(),
    };
    program.inputs().iter().map(|input| array(&input.name)).collect()
}

/// By rows, from full columns.
fn rows(columns: &[f64], rows: usize) -> Vec<f64> {
    let count = columns.len() / rows.max(1);
    (0..rows).flat_map(|r| (0..count).map(move |c| columns[c * rows + r])).collect()
}

fn assert_near(a: &[f64], b: &[f64], tolerance: f64, what: &str) {
    assert_eq!(a.len(), b.len(), "{what}");
    let size = b.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart <= tolerance * size, "{what}: {apart:e} of {size:e}");
}

/// Values against the program's interpretation, Jacobians against central differences of it.
fn check(external: &External, jacobian: &External, model: &Model, query: Query, arguments: Arguments) {
    let program = record_quantity(model, query, arguments).expect("a program");
    let x = inputs_of(model, &program);
    let own = external.count("out");
    assert_eq!(external.names("in"), program.inputs().iter().map(|x| x.name.clone()).collect::<Vec<_>>());
    assert_eq!(external.names("out"), program.outputs()[..own].iter().map(|y| y.name.clone()).collect::<Vec<_>>());
    let values =
        |x: &[Vec<f64>]| -> Vec<Vec<f64>> { program.evaluate(&x.iter().map(Vec::as_slice).collect::<Vec<_>>()) };
    let given: Vec<Option<&[f64]>> = x.iter().map(|x| Some(x.as_slice())).collect();
    let (found, failed) = external.evaluate(&given, |_| true);
    assert_eq!(failed, 0);
    let (blocks, failed) = jacobian.evaluate(&given, |_| true);
    assert_eq!(failed, 0);
    let outputs = jacobian.names("out");
    let names: Vec<String> =
        [&external.names("in")[..], &external.names("out").iter().map(|y| format!("out_{y}")).collect::<Vec<_>>()]
            .concat();
    assert_eq!(jacobian.names("in"), names);
    for (y, expected) in values(&x)[..own].iter().enumerate() {
        let (r, ..) = external.pattern("out", y);
        let what = format!("{} {y}", external.name);
        assert_near(&rows(&found[y], r), expected, 1e-12, &what);
        for i in 0..x.len() {
            let block = y * x.len() + i;
            assert_eq!(outputs[block], format!("jac_{}_{}", program.outputs()[y].name, program.inputs()[i].name));
            let (size, columns, _) = jacobian.pattern("out", block);
            assert_eq!((size, columns), (expected.len(), x[i].len()), "{what}");
            for c in 0..columns {
                let at = |step: f64| {
                    let mut moved = x.clone();
                    moved[i][c] += step;
                    values(&moved).swap_remove(y)
                };
                let h = 1e-6;
                let slope: Vec<f64> = at(h).iter().zip(at(-h)).map(|(a, b)| (a - b) / (2.0 * h)).collect();
                // rows of the Jacobian are in the order of the output's columns
                let column = rows(&blocks[block][c * size..][..size], r);
                assert_near(&column, &slope, 2e-7, &format!("{what} by {} {c}", program.inputs()[i].name));
            }
        }
    }
}

#[test]
fn functions_and_jacobians_are_those_of_the_kernels() {
    if !exists("cc") || cfg!(windows) {
        return;
    }
    let ur5 = embedded("ur5");
    let tool = ur5.end_effector().expect("a tool");
    let queries: Vec<Query> = vec![
        InverseDynamics.into(),
        ForwardDynamics.into(),
        MassMatrix.into(),
        PotentialEnergy.into(),
        Query::from(ForwardKinematics).of(tool),
        Query::from(BodyJacobian).of(tool),
    ];
    let frames = [tool];
    let open = Arguments { gravity: true, wrenches: &frames, ..Arguments::default() };
    let anymal = embedded("anymal").with_base(Base::Floating).expect("sound");
    let dynamics: Vec<Query> = vec![InverseDynamics.into(), MassMatrix.into()];
    for (name, model, queries, arguments) in [
        ("casadi_ur5", &ur5, &queries, Arguments::default()),
        ("casadi_open", &ur5, &queries[..2].to_vec(), open),
        ("casadi_anymal", &anymal, &dynamics, Arguments::default()),
    ] {
        let folder = folder(name);
        let library = library(&folder, model, queries, arguments);
        for &query in queries {
            let frame = query.subject.frame.map(|frame| format!("_{}", model.frame_name(frame))).unwrap_or_default();
            let name = format!("{}_{}{frame}", model.description().name, query.name());
            let jacobian = External { library: &library, name: format!("jac_{name}") };
            check(&External { library: &library, name }, &jacobian, model, query, arguments);
        }
    }
}

#[test]
fn missing_inputs_are_zero_and_a_singular_matrix_is_a_failed_evaluation() {
    if !exists("cc") || cfg!(windows) {
        return;
    }
    let ur5 = embedded("ur5");
    let library = library(&folder("casadi_null"), &ur5, &[ForwardDynamics.into()], Arguments::default());
    let external = External { library: &library, name: "ur5_forward_dynamics".into() };
    let theta = [0.1, -0.2, 0.3, -0.4, 0.5, -0.6];
    let (found, failed) = external.evaluate(&[Some(&theta), None, None], |_| true);
    let zero = [0.0; 6];
    let expected = ur5.forward_dynamics(&theta, &zero, &zero, &ur5.environment()).expect("regular");
    assert_eq!(failed, 0);
    assert_near(&found[0], expected.as_slice(), 1e-12, "at rest");
    let (found, failed) = external.evaluate(&[Some(&theta), None, None], |_| false);
    assert!(failed == 0 && found[0].iter().all(|x| x.is_nan()), "nothing is wanted");
    assert_eq!(external.evaluate(&[Some(&[f64::NAN; 6]), None, None], |_| true).1, 1);
}

#[test]
fn zeros_of_structure_are_not_stored_and_known_derivatives_are_used() {
    let anymal = embedded("anymal");
    let text = |query: Query, arguments| emit_casadi(&anymal, &[query], arguments).expect("text").swap_remove(0).text;
    // four legs of three joints: M has 4 · 9 entries
    let mass = text(MassMatrix.into(), Arguments::default());
    let sparsity = mass.lines().find(|line| line.contains("anymal_mass_matrix_s_out_0[]")).expect("a sparsity");
    assert!(
        sparsity.contains("{12, 12, 0, 3, 6, 9, 12, 15, 18, 21, 24, 27, 30, 33, 36, 0, 1, 2, 0, 1, 2,"),
        "{sparsity}"
    );
    let ur5 = embedded("ur5");
    let known = record_quantity(&ur5, InverseDynamicsDerivatives, Arguments::default()).expect("a program");
    let text_of_ur5 =
        emit_casadi(&ur5, &[InverseDynamics.into()], Arguments::default()).expect("text").swap_remove(0).text;
    let (_, jacobian) = text_of_ur5.split_once("The Jacobian of ur5_inverse_dynamics.").expect("a Jacobian");
    let flops = jacobian.split_whitespace().nth(1).and_then(|word| word.parse::<usize>().ok()).expect("a count");
    assert!(flops <= known.count().flops() as usize, "{flops}");
    let rates = text(InverseDynamics.into(), Arguments { derivative: Derivative::RATES, ..Arguments::default() });
    assert!(rates.contains("int anymal_inverse_dynamics_jvp(") && !rates.contains("jac_"));
}

const SCRIPT: &str = "
import sys
try:
    import casadi as ca
except ImportError:
    sys.exit(77)
import numpy as np
f = ca.external('ur5_inverse_dynamics', './ur5_casadi.so')
assert f.name_in() == ['theta', 'dtheta', 'ddtheta'] and f.name_out() == ['tau'], f
x = [ca.MX.sym(name, 6) for name in f.name_in()]
J = ca.Function('J', x, [ca.jacobian(f(*x), ca.vertcat(*x))])
state = np.array(sys.argv[1].split(','), float).reshape(3, 6)
print(*np.array(f(*state)).ravel())
print(*np.array(J(*state)).ravel())
opti = ca.Opti()
theta = opti.variable(6)
opti.minimize(ca.sumsqr(f(theta, 0, 0)))
opti.set_initial(theta, state[0])
opti.solver('ipopt', {'print_time': False}, {'print_level': 0, 'sb': 'yes', 'hessian_approximation': 'limited-memory'})
print(opti.solve().value(ca.norm_2(f(theta, 0, 0))))
";

#[test]
fn casadi_itself_calls_them() {
    let python = std::env::var("MOZZI_PYTHON").unwrap_or_else(|_| "python3".into());
    if !exists("cc") || !exists(&python) || cfg!(windows) {
        return;
    }
    let (ur5, folder) = (embedded("ur5"), folder("casadi_python"));
    drop(library(&folder, &ur5, &[InverseDynamics.into()], Arguments::default()));
    let [theta, dtheta, ddtheta] = state(&ur5, 5);
    let numbers: Vec<String> = [&theta, &dtheta, &ddtheta].into_iter().flatten().map(|x| format!("{x:?}")).collect();
    let run =
        Command::new(python).args(["-c", SCRIPT, &numbers.join(",")]).current_dir(&folder).output().expect("Python");
    if run.status.code() == Some(77) {
        eprintln!("skipped: no casadi here");
        return;
    }
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let text = String::from_utf8(run.stdout).expect("text");
    let mut lists = text.lines().map(|line| line.split(' ').filter_map(|x| x.parse().ok()).collect::<Vec<f64>>());
    let environment = ur5.environment();
    let tau = ur5.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment).expect("a force");
    assert_near(&lists.next().expect("τ"), tau.as_slice(), 1e-12, "τ");
    let known = ur5.inverse_dynamics_derivatives(&theta, &dtheta, &ddtheta, &environment).expect("derivatives");
    let blocks = [&known.d_theta, &known.d_dtheta, &known.d_ddtheta];
    let row = |r: usize| blocks.into_iter().flat_map(move |block| (0..6).map(move |c| block[(r, c)]));
    assert_near(&lists.next().expect("∂τ"), &(0..6).flat_map(row).collect::<Vec<f64>>(), 1e-12, "∂τ");
    assert!(
        lists.next().is_some_and(|norm| norm.len() == 1 && norm[0] < 1e-3),
        "ipopt finds a posture without torque: {text}"
    );
}
