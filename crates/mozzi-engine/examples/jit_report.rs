//! Counts the instructions of machine code for x86-64 with AVX2 and for AArch64, robot by robot and quantity by
//! quantity; on any processor, as nothing is run. `cargo xtask jit-report` writes its tables into docs/arm.md.
//!
//! `cargo run --release -p mozzi-engine --example jit_report [ROBOT.urdf …]` prints the page.

mod quantities;

use mozzi::Model;
use mozzi::quantities::Query;
use mozzi_engine::{Arguments, Form, Listing, Program, Refusal, Shape, Tally, pivot_names, record_quantity};
use quantities::quantities;

/// What a core does in a cycle at most.
struct Core {
    name: &'static str,
    instructions: usize,
    vector: usize,
    loads: usize,
    stores: usize,
    /// Loads and stores together.
    accesses: usize,
}

/// From Arm's software optimization guides (issue width, pipes V, L and S) and, for Apple's, from published
/// measurements of its first M core.
const CORES: [Core; 5] = [
    Core { name: "Cortex-A76", instructions: 4, vector: 2, loads: 2, stores: 2, accesses: 2 },
    Core { name: "Cortex-A78AE", instructions: 6, vector: 2, loads: 3, stores: 2, accesses: 3 },
    Core { name: "Neoverse N1", instructions: 4, vector: 2, loads: 2, stores: 2, accesses: 2 },
    Core { name: "Neoverse V2", instructions: 8, vector: 4, loads: 3, stores: 2, accesses: 3 },
    Core { name: "Apple M1", instructions: 8, vector: 4, loads: 3, stores: 2, accesses: 4 },
];

const HEAD: &str = "\
# Machine code on AArch64, counted

Written by `cargo xtask jit-report`. **Not measured on hardware**: nobody has run `mozzi bench` on such a machine yet. If
you do, `mozzi bench --json` prints what can be pasted into an issue.

A robot's program becomes machine code by the same lowering as on x86-64: order, allocation, segments, rows, cache and
guards are shared (`crates/mozzi-engine/src/jit`); a machine is an assembler, a register file and what pays on it. Every
AArch64 has NEON: 32 registers of 128 bits, so two states in `f64` and four in `f32`. SVE is reported by `mozzi --version` and
not used: most processors that have it have registers of 128 bits, too. Linux, Android and macOS run the code; elsewhere
the kernels compute, and `engine()` says why. On macOS a program with the hardened runtime needs the entitlement
`com.apple.security.cs.allow-jit`.

NEON has c + a b and c − a b only. Signs are moved out of the program (`jit/signs.rs`), so that a b − c costs no more;
operands are in registers, so that loads are instructions of their own. There are no groups of registers for latency:
instructions of independent chains are ordered next to each other (`jit/order.rs`).

The tables count one run of the code: for x86-64 with AVX2 and for AArch64 its instructions, arithmetic (a fused
multiply-add is one, a change of sign, too), loads, stores, those of them that are spills, and bytes. An instruction does
its work for every lane, so the ratio of arithmetic is that per lane. At one state sines are computed four at a time by
AVX2 and two at a time by NEON. The last columns are cycles that a state takes at least, by the widths that Arm's software
optimization guides give, and for Apple's first M core published measurements: instructions, operations of the vector
pipes, loads and stores in a cycle. Latencies, quotients' longer times and caches are not in them. Quantities whose code
would be too long on either machine are left out.
";

/// The quantities that are listed.
const SHOWN: [&str; 13] = [
    "inverse_dynamics",
    "forward_dynamics",
    "mass_matrix",
    "coriolis_matrix",
    "gravity_forces",
    "body_jacobian",
    "forward_kinematics",
    "inverse_dynamics_derivatives",
    "forward_dynamics_derivatives",
    "inverse_dynamics_vjp",
    "forward_dynamics_vjp",
    "regressor",
    "kinetic_energy",
];

fn listing(program: &Program, query: Query, shape: Shape) -> Result<Listing, Refusal> {
    let own = program.outputs().len() - pivot_names(&query).len();
    Listing::new(program, shape, if shape.lanes() > 1 { Form::Rows } else { Form::Blocks }, own)
}

/// Cycles a state takes at least.
fn bound(core: &Core, tally: &Tally, lanes: usize) -> f64 {
    let vector = tally.arithmetic + tally.bits + tally.moves;
    let per = |count: usize, most: usize| count as f64 / most as f64;
    let bounds = [
        per(tally.instructions, core.instructions),
        per(vector, core.vector),
        per(tally.loads, core.loads),
        per(tally.stores, core.stores),
        per(tally.loads + tally.stores, core.accesses),
    ];
    bounds.into_iter().fold(0.0, f64::max) / lanes as f64
}

fn cells(code: &Listing) -> String {
    let Tally { instructions, arithmetic, loads, stores, spills, .. } = code.tally;
    format!("{instructions} | {arithmetic} | {loads} | {stores} | {spills} | {}", code.code.len())
}

/// Of all quantities of a robot: the largest ratio of arithmetic, the largest part of spills, quantities.
#[derive(Default)]
struct Worst {
    ratio: (f64, String),
    spills: (f64, String),
    count: usize,
}

impl Worst {
    fn add(&mut self, what: &str, ratio: f64, spills: f64) {
        self.count += 1;
        if ratio > self.ratio.0 {
            self.ratio = (ratio, what.to_string());
        }
        if spills > self.spills.0 {
            self.spills = (spills, what.to_string());
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut names: Vec<String> = std::env::args().skip(1).collect();
    if names.is_empty() {
        names = mozzi_urdf::embedded::names().map(String::from).collect();
    }
    let pairs =
        [(Shape::OneF64, Shape::OneF64Neon), (Shape::FourF64, Shape::TwoF64), (Shape::EightF32, Shape::FourF32)];
    let titles = ["one state, `f64`", "many states, `f64`", "many states, `f32`"];
    print!("{HEAD}");
    let mut summary = Vec::new();
    for name in &names {
        let model: Model = mozzi_urdf::open(name)?.build()?;
        let frame = model.frames().last().ok_or("a robot without frames")?.0;
        println!("\n## {name}, {} joints\n", model.n());
        let mut rows = [const { Vec::new() }; 3];
        let mut worst: [Worst; 3] = std::array::from_fn(|_| Worst::default());
        for query in quantities(frame) {
            let program = record_quantity(&model, query, Arguments::default())?;
            for (k, (x86, arm)) in pairs.into_iter().enumerate() {
                let (Ok(x86), Ok(code)) = (listing(&program, query, x86), listing(&program, query, arm)) else {
                    continue;
                };
                if x86.tally.arithmetic == 0 {
                    continue;
                }
                let ratio = code.tally.arithmetic as f64 / x86.tally.arithmetic as f64;
                let spills = code.tally.spills as f64 / code.tally.instructions as f64;
                worst[k].add(query.name(), ratio, spills);
                if SHOWN.contains(&query.name()) {
                    let bounds = CORES.map(|core| format!("{:.0}", bound(&core, &code.tally, arm.lanes())));
                    let both = format!("{} | {}", cells(&x86), cells(&code));
                    let ends = format!("{ratio:.2} | {:.1} | {}", 100.0 * spills, bounds.join(" | "));
                    rows[k].push(format!("| {} | {both} | {ends} |", query.name()));
                }
            }
        }
        for (k, ((title, rows), worst)) in titles.iter().zip(&rows).zip(worst).enumerate() {
            println!("### {title}\n");
            let columns = ["instructions", "arithmetic", "loads", "stores", "spills", "bytes"];
            let machine = |name: &str| columns.map(|column| format!("{name} {column}")).join(" | ");
            let cores = CORES.map(|core| core.name).join(" | ");
            println!("| | {} | {} | arithmetic, of x86's | spills, % | {cores} |", machine("x86"), machine("ARM"));
            println!("|---|{}", "--:|".repeat(2 * columns.len() + 2 + CORES.len()));
            println!("{}{}", rows.join("\n"), if k + 1 < titles.len() { "\n" } else { "" });
            summary.push((name.clone(), *title, worst));
        }
    }
    println!(
        "\n## The largest of all quantities of a robot\n\n| robot | code | quantities | arithmetic, of x86's | spills, of all |"
    );
    println!("|---|---|--:|--:|--:|");
    for (name, title, Worst { ratio, spills, count }) in summary {
        let (ratio, of_ratio, spills, of_spills) = (ratio.0, ratio.1, 100.0 * spills.0, spills.1);
        println!("| {name} | {title} | {count} | {ratio:.2} ({of_ratio}) | {spills:.1} % ({of_spills}) |");
    }
    Ok(())
}
