//! C99 with the interface of CasADi's external functions: what `casadi.external` loads.

use super::c::{C, comment, helpers};
use super::dialect::{Emitted, Source};
use super::{EmitError, Precision, SourceFile, body, describe, names, refuse, written};
use crate::program::{Arguments, Derivative, Program, Step, Value, jacobian, pivot_names, record_quantity};
use mozzi::Model;
use mozzi::quantities::{
    ForwardDynamics, ForwardDynamicsDerivatives, InverseDynamics, InverseDynamicsDerivatives, Query,
};
use std::collections::BTreeSet;

/// An external function and the sparsities of its outputs, which are stored by columns.
struct External {
    name: String,
    program: Program,
    /// Without pivots.
    outputs: Vec<Sparsity>,
    about: Vec<String>,
    query: Option<usize>,
}

/// The shape of a matrix and the places of its structural nonzeros.
struct Sparsity {
    shape: [usize; 2],
    /// Column after column the rows; `None` if the matrix is dense.
    rows: Option<Vec<Vec<usize>>>,
}

/// The source text of a robot's quantities for `casadi.external`: one file of C99, `ROBOT_casadi.c`, with a function
/// `ROBOT_QUANTITY` and its Jacobian `jac_ROBOT_QUANTITY` for each quantity, and the functions by which CasADi queries
/// their names, sizes and sparsities. Vectors are columns; entries that are zero for every state are not stored. The
/// function returns 1, CasADi's failed evaluation, if a pivot of a matrix that it divides by is not positive.
///
/// ∂τ and ∂θ̈ by the state are those of [`InverseDynamicsDerivatives`] and [`ForwardDynamicsDerivatives`], if θ has no
/// quaternions; all other derivatives are recorded with dual numbers or, if there are few outputs, backward.
/// Derivatives with respect to θ are those by its own numbers, of a quaternion all four. With `arguments.derivative`
/// there are no Jacobians. The integers are `casadi_int`, `long long int` unless the compiler defines another type:
/// acados needs `-Dcasadi_int=int`.
///
/// ```
/// use mozzi::quantities::InverseDynamics;
/// use mozzi_engine::{Arguments, emit_casadi};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let model = mozzi_urdf::open("ur5")?.build()?;
/// let files = emit_casadi(&model, &[InverseDynamics.into()], Arguments::default())?;
/// assert!(files[0].name == "ur5_casadi.c" && files[0].text.contains("int jac_ur5_inverse_dynamics("));
/// # Ok(()) }
/// ```
///
/// # Errors
/// [`EmitError`].
pub fn emit_casadi(model: &Model, quantities: &[Query], arguments: Arguments) -> Result<Vec<SourceFile>, EmitError> {
    if quantities.is_empty() {
        return Err(EmitError::Nothing);
    }
    let robot = names::identifier(&model.description().name, "robot");
    let (mut externals, mut taken) = (Vec::new(), BTreeSet::new());
    for (k, &query) in quantities.iter().enumerate() {
        let program = record_quantity(model, query, arguments).map_err(EmitError::Frame)?;
        let shapes = shapes(model, query, arguments, &program);
        let program = by_columns(program, &shapes);
        let frame = query.subject.frame.map(|frame| format!("_{}", model.frame_name(frame))).unwrap_or_default();
        let name = names::unique(&names::identifier(&format!("{robot}_{}{frame}", program.name()), "f"), &mut taken);
        let about = describe::quantity(model, query, &program);
        if arguments.derivative == Derivative::None {
            let jacobian = of_jacobian(model, query, arguments, &program)?;
            let lengths = |program: &Program| -> Vec<usize> { program.inputs.iter().map(|x| x.length).collect() };
            let rows = shapes.iter().map(|[r, c]| r * c);
            let blocks =
                rows.flat_map(|rows| lengths(&program).into_iter().map(move |columns| [rows, columns])).collect();
            externals.push(External::new(name.clone(), program, shapes, about, Some(k)));
            let about = vec![format!("The Jacobian of {name}.")];
            externals.push(External::new(format!("jac_{name}"), jacobian, blocks, about, None));
        } else {
            externals.push(External::new(name, program, shapes, about, Some(k)));
        }
    }
    let functions = externals.iter().map(|external| {
        let mut function = written(&format!("{}_core", external.name), &external.program, &mut BTreeSet::new());
        function.about.clone_from(&external.about);
        let query = external.query.map(|k| quantities[k]);
        if let Some(query) = query {
            function.describe_arrays(|name| describe::array(model, query, arguments, name));
        }
        function
    });
    let functions: Vec<Emitted> = functions.collect();
    functions.iter().try_for_each(|function| refuse(function, Precision::F64, None))?;
    let about = describe::robot(model, arguments, Precision::F64, RULES);
    let source = Source { name: robot, about, functions, precision: Precision::F64 };
    Ok(vec![file(&source, &externals)])
}

/// Rows and columns of each output but pivots. Of three or more dimensions the last are one.
fn shapes(model: &Model, query: Query, arguments: Arguments, program: &Program) -> Vec<[usize; 2]> {
    let count = program.outputs.len() - pivot_names(&query).len();
    let own = query.shapes(model);
    let shape = |k: usize| match (&arguments.derivative, &own[k % own.len()][..]) {
        (Derivative::Product(_), _) => [program.outputs[k].values.len(), 1],
        (_, []) => [1, 1],
        (_, [rows, rest @ ..]) => [*rows, rest.iter().product()],
    };
    (0..count).map(shape).collect()
}

/// The program with its outputs by columns instead of rows.
fn by_columns(mut program: Program, shapes: &[[usize; 2]]) -> Program {
    for (output, &[rows, columns]) in program.outputs.iter_mut().zip(shapes) {
        let own = &output.values;
        output.values = (0..columns).flat_map(|c| (0..rows).map(move |r| own[r * columns + c])).collect();
    }
    program
}

/// CasADi's sparse matrices, and what its functions check.
const RULES: describe::Rules = describe::Rules {
    matrices: "Matrices are by columns, without the entries that are always 0.",
    checks: "a singular matrix is a failed evaluation",
};

/// The Jacobian; of inverse and forward dynamics with the derivatives that have a kernel of their own.
fn of_jacobian(model: &Model, query: Query, arguments: Arguments, program: &Program) -> Result<Program, EmitError> {
    let known: Option<Query> = match query {
        _ if !model.configuration_space().is_flat() => None,
        _ if query == InverseDynamics.into() => Some(InverseDynamicsDerivatives.into()),
        _ if query == ForwardDynamics.into() => Some(ForwardDynamicsDerivatives.into()),
        _ => None,
    };
    let known = known.map(|known| record_quantity(model, known, arguments)).transpose().map_err(EmitError::Frame)?;
    jacobian(program, known.as_ref(), model).map_err(EmitError::TooLong)
}

impl External {
    /// Outputs without their structural zeros.
    fn new(
        name: String,
        mut program: Program,
        shapes: Vec<[usize; 2]>,
        about: Vec<String>,
        query: Option<usize>,
    ) -> Self {
        let steps = &program.steps;
        let is_zero = |value: Value| matches!(steps[value as usize], Step::Constant(x) if x == 0.0);
        let mut outputs = Vec::new();
        for (output, shape) in program.outputs.iter_mut().zip(shapes) {
            let [rows, columns] = shape;
            let column = |c: usize| (0..rows).filter(|r| !is_zero(output.values[c * rows + r])).collect();
            let found: Vec<Vec<usize>> = (0..columns).map(column).collect();
            let is_dense = found.iter().all(|column| column.len() == rows);
            output.values.retain(|&value| !is_zero(value));
            outputs.push(Sparsity { shape, rows: (!is_dense).then_some(found) });
        }
        External { name, program, outputs, about, query }
    }
}

impl Sparsity {
    /// Rows, columns, 1; or rows, columns, where each column begins, the row of each entry.
    fn numbers(&self) -> Vec<usize> {
        let Some(rows) = &self.rows else { return [&self.shape[..], &[1]].concat() };
        let mut begins = vec![0];
        for column in rows {
            begins.push(begins[begins.len() - 1] + column.len());
        }
        [&self.shape[..], &begins, &rows.concat()].concat()
    }
}

const HEAD: &str = "
#include <float.h>
#include <math.h>
#include <stdint.h>

#ifndef casadi_int
#define casadi_int long long int
#endif

#ifndef CASADI_SYMBOL_EXPORT
#if defined(_WIN32)
#define CASADI_SYMBOL_EXPORT __declspec(dllexport)
#else
#define CASADI_SYMBOL_EXPORT __attribute__((visibility(\"default\")))
#endif
#endif";

fn file(source: &Source, externals: &[External]) -> SourceFile {
    let (c, name) = (C(source.precision), format!("{}_casadi", source.name));
    let mut lines = comment(&source.about);
    lines.push(format!(
        "\n/* cc -O2 -shared -fPIC {name}.c -o {name}.so -lm; in Python casadi.external(\"{}\", \"./{name}.so\").\n * For \
         acados -Dcasadi_int=int. */",
        externals[0].name
    ));
    lines.push(HEAD.to_string());
    lines.extend(helpers(source, &c));
    let longest = externals.iter().flat_map(|external| &external.program.inputs).map(|input| input.length).max();
    lines.push(format!("\nstatic const double zeros[{}] = {{0}};", longest.unwrap_or(0).max(1)));
    for (external, function) in externals.iter().zip(&source.functions) {
        lines.push(String::new());
        lines.extend(comment(&function.lines()));
        lines.push(format!("static void {}({})\n{{", function.name, c.parameters(function, "restrict ")));
        lines.extend(function.unused().map(|input| format!("    (void) {};", input.name)));
        lines.extend(body::lines(function, &c).iter().map(|line| format!("    {line}")));
        lines.push("}".to_string());
        lines.extend(interface(external, function));
    }
    SourceFile { name: format!("{name}.c"), text: lines.iter().flat_map(|line| [line, "\n"]).collect() }
}

/// The functions that CasADi calls.
fn interface(external: &External, function: &Emitted) -> Vec<String> {
    let name = &external.name;
    let mut lines = Vec::new();
    let (inputs, (outputs, pivots)) = (&function.inputs, function.outputs.split_at(external.outputs.len()));
    let of_input = |length: usize| Sparsity { shape: [length, 1], rows: None };
    let of_inputs: Vec<Sparsity> = inputs.iter().map(|input| of_input(input.length)).collect();
    for (side, list) in [("in", &of_inputs), ("out", &external.outputs)] {
        for (k, sparsity) in list.iter().enumerate() {
            let numbers = sparsity.numbers().iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
            lines.push(format!("static const casadi_int {name}_s_{side}_{k}[] = {{{numbers}}};"));
        }
    }
    let mut offset = 0;
    let mut given: Vec<String> = (0..inputs.len()).map(|k| format!("arg[{k}] ? arg[{k}] : zeros")).collect();
    for (k, output) in outputs.iter().enumerate() {
        given.push(format!("res[{k}] ? res[{k}] : w + {offset}"));
        offset += output.length;
    }
    let mut checks = String::new();
    for list in pivots {
        given.push(format!("w + {offset}"));
        checks +=
            &format!("    for (int k = {offset}; k < {}; ++k) if (!(w[k] > 0)) return 1;\n", offset + list.length);
        offset += list.length;
    }
    let (call, core) = (given.join(",\n        "), &function.name);
    lines.push(format!(
        "\nCASADI_SYMBOL_EXPORT int {name}(const double **arg, double **res, casadi_int *iw, double *w, int mem)\n{{\n    \
         (void) iw; (void) mem; (void) w;\n    {core}(\n        {call});\n{checks}    return 0;\n}}"
    ));
    let mut define = |kind: &str, rest: &str, body: &str| {
        lines.push(format!("CASADI_SYMBOL_EXPORT {kind}{name}_{rest} {{ {body} }}"));
    };
    define("casadi_int ", "n_in(void)", &format!("return {};", inputs.len()));
    define("casadi_int ", "n_out(void)", &format!("return {};", outputs.len()));
    define("double ", "default_in(casadi_int i)", "(void) i; return 0;");
    for (side, list) in [("in", &inputs[..]), ("out", outputs)] {
        let cases = |value: &dyn Fn(usize) -> String| -> String {
            let each = (0..list.len()).map(|k| format!("case {k}: return {}; ", value(k))).collect::<String>();
            format!("switch (i) {{ {each}default: return 0; }}")
        };
        let named = cases(&|k| format!("\"{}\"", list[k].name));
        define("const char *", &format!("name_{side}(casadi_int i)"), &named);
        let sparsities = cases(&|k| format!("{name}_s_{side}_{k}"));
        define("const casadi_int *", &format!("sparsity_{side}(casadi_int i)"), &sparsities);
    }
    let sizes = [("arg", inputs.len()), ("res", outputs.len()), ("iw", 0), ("w", offset)];
    let sizes: String = sizes.map(|(what, size)| format!("if (sz_{what}) *sz_{what} = {size}; ")).concat();
    define(
        "int ",
        "work(casadi_int *sz_arg, casadi_int *sz_res, casadi_int *sz_iw, casadi_int *sz_w)",
        &format!("{sizes}return 0;"),
    );
    for rest in ["incref(void)", "decref(void)"] {
        define("void ", rest, "");
    }
    for rest in ["alloc_mem(void)", "checkout(void)"] {
        define("int ", rest, "return 0;");
    }
    define("int ", "init_mem(int mem)", "(void) mem; return 0;");
    for rest in ["free_mem(int mem)", "release(int mem)"] {
        define("void ", rest, "(void) mem;");
    }
    lines
}
