//! `docs/quantities.md`: every quantity of the list, with its formula, inputs and outputs.
#![allow(missing_docs)]

use mozzi::quantities::{Declaration, Input, LIST, Of, Output, Query, Uses};
use std::fmt::Write;
use std::path::Path;

const HEAD: &str = "\
# Quantities

Every quantity is declared once, at the foot of its kernel's file in `crates/mozzi/src/`, and listed once, in
`crates/mozzi/src/quantities/mod.rs`. `cargo xtask docs` writes this page from that list; a test checks that it is current.

n is the number of velocities, nq of positions (one more on a floating base), p of inertial parameters, k of a task's rows. Units are
those of revolute joints, then of prismatic ones; six-vectors are angular first; matrices are by rows. \"Environment\" lists what
else a quantity depends on: gravity g, wrenches F that frames apply, the twist 𝒱_s and the acceleration 𝒱̇_s of {s}. What is not listed has
no effect on it. The point of a momentum is set by `query.about(…)` in Rust, `about=` in Python, `--about` on the command line.

## Ways

Each quantity works in each of these ways:

| way | call |
|---|---|
| one state, checked | `model.compute(query, inputs, &environment)`, or the typed methods of `Model` |
| one state, no allocation | `mozzi::fast::evaluate`, `mozzi::fast::compute` |
| any number type: `f32`, dual numbers, your own | `query.evaluate(…)`, or the kernel itself |
| many states, `f64` and `f32`, all cores; wrenches, gravity and inertial parameters of each state | `mozzi_engine::Batch::compute` |
| a recorded program, printed, parsed and counted | `mozzi_engine::record_quantity` |
| machine code at one state and at many (x86-64 with AVX2 and FMA, or AVX-512; AArch64) | `mozzi_engine::compile` |
| Rust, C and CUDA source text | `mozzi_engine::emit`, `mozzi codegen` |
| arrays on an NVIDIA GPU, but for quantities of tasks | `mozzi_gpu::Source::new`, `mozzi compute … --gpu`, `model.to_gpu()` in Python |
| the command line | `mozzi compute MODEL QUANTITY` |
| Python, one state and arrays | `model.quantity(…)`, `model.compile(\"quantity\")` |
| C and C++, one state and many | `mozzi_quantity(model, workspace, …)`, `workspace.quantity(…)`, `mozzi_batch_compute` |

Arrays are computed by machine code made of the recorded program as soon as that pays (after about a thousand states of a quantity), else,
and where there is none (other processors than x86-64 with AVX2 and AArch64, code longer than 512 kB, or 2 MB with AVX-512), by the
kernel state after state, on all cores. `engine` reports which; `compile` makes code at once, `kernels_only` never.
Source text does not check pivots: its functions return them as further outputs.
";

fn inputs(list: &[Input]) -> String {
    list.iter().map(|input| format!("{} ({})", input.symbol, input.dim)).collect::<Vec<_>>().join(", ")
}

fn outputs(list: &[Output]) -> String {
    let shown = |output: &Output| {
        let dims: Vec<String> = output.dims.iter().map(ToString::to_string).collect();
        let shape = if dims.is_empty() { "1".to_string() } else { dims.join(" × ") };
        format!("`{}` ({shape}), {}", output.name, output.unit)
    };
    list.iter().map(shown).collect::<Vec<_>>().join("; ")
}

fn of(declaration: &Declaration) -> &'static str {
    match declaration.of {
        Of::Robot => "",
        Of::Frame => "frame",
        Of::Task => "frame, rows, coordinates",
        Of::Point => "point",
    }
}

fn environment(uses: Uses) -> String {
    let parts =
        [(Uses::GRAVITY, "g"), (Uses::WRENCHES, "F"), (Uses::BASE_TWIST, "𝒱_s"), (Uses::BASE_ACCELERATION, "𝒱̇_s")];
    parts.into_iter().filter(|(part, _)| uses.has(*part)).map(|(_, name)| name).collect::<Vec<_>>().join(", ")
}

#[test]
fn page_of_quantities() {
    let mut page = String::from(HEAD);
    let fused = (0..LIST.len()).map(Query::at).filter(mozzi::fast::has_fused_kernel);
    let fused: Vec<String> = fused.map(|query| format!("`{}`", query.name())).collect();
    let fused = fused.join(", ");
    writeln!(
        page,
        "\nAt one state these have fused multiply-add: {fused}. The others run on plain `f64`, at about 1.3 times the time."
    )
    .expect("a string");
    page.push_str("\n## The list\n\n");
    page.push_str("| name | formula | inputs | of | environment | outputs |\n|---|---|---|---|---|---|\n");
    for declaration in LIST {
        let Declaration { name, formula, .. } = declaration;
        writeln!(
            page,
            "| `{name}` | {formula} | {} | {} | {} | {} |",
            inputs(declaration.inputs),
            of(declaration),
            environment(declaration.uses),
            outputs(declaration.outputs)
        )
        .expect("a string");
    }
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/quantities.md");
    if std::env::var_os("MOZZI_BLESS").is_some() {
        std::fs::write(&file, &page).expect("a page");
    }
    let written = std::fs::read_to_string(&file).unwrap_or_default();
    assert!(written == page, "docs/quantities.md is not current: run `cargo xtask docs`");
}
