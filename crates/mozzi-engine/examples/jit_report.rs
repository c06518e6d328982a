//! Counts the instructions of machine code for x86-64 with AVX2 and for AArch64, robot by robot and quantity by
//! quantity; on any processor, as nothing is run. `cargo xtask jit-report` writes its tables into docs/arm.md.
//!
//! `cargo run --release -p mozzi-engine --example jit_report [ROBOT.urdf …]`

use mozzi::Model;
use mozzi::quantities::{LIST, Of, Query};
use mozzi_engine::{Arguments, Form, Listing, Program, Refusal, Shape, Tally, pivot_names, record_quantity};

/// What a core does in a cycle at most, and how many cycles a quotient of two `f64` keeps its pipe busy at least.
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
    Core { name: "Cortex-A78AE", instructions: 4, vector: 2, loads: 3, stores: 2, accesses: 3 },
    Core { name: "Neoverse N1", instructions: 4, vector: 2, loads: 2, stores: 2, accesses: 2 },
    Core { name: "Neoverse V2", instructions: 6, vector: 4, loads: 3, stores: 2, accesses: 3 },
    Core { name: "Apple M1", instructions: 8, vector: 4, loads: 3, stores: 2, accesses: 4 },
];

/// The columns of a machine.
const SHOWN: [&str; 13] = [
    "inverse_dynamics",
    "forward_dynamics",
    "mass_matrix",
    "coriolis_matrix",
    "gravity_torques",
    "body_jacobian",
    "forward_kinematics",
    "inverse_dynamics_derivatives",
    "forward_dynamics_derivatives",
    "inverse_dynamics_vjp",
    "forward_dynamics_vjp",
    "torque_regressor",
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
    let mut summary = Vec::new();
    for name in &names {
        let model: Model = mozzi_urdf::open(name)?.build()?;
        let frame = model.frames().last().ok_or("a robot without frames")?.0;
        println!("\n## {name}, {} joints\n", model.n());
        let mut rows = [const { Vec::new() }; 3];
        let mut worst: [Worst; 3] = std::array::from_fn(|_| Worst::default());
        for query in (0..LIST.len()).map(Query::at) {
            let query = match query.declaration().of {
                Of::Robot => query,
                Of::Frame => query.of(frame),
                Of::Point | Of::Task => continue,
            };
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
        for ((title, rows), worst) in titles.iter().zip(&rows).zip(worst) {
            println!("### {title}\n");
            let columns = ["i", "a", "l", "s", "sp", "B"];
            let machine = |name: &str| columns.map(|column| format!("{name} {column}")).join(" | ");
            let cores = CORES.map(|core| core.name).join(" | ");
            println!("| | {} | {} | a ratio | sp % | {cores} |", machine("x86"), machine("arm"));
            println!("|---|{}", "--:|".repeat(2 * columns.len() + 2 + CORES.len()));
            println!("{}\n", rows.join("\n"));
            summary.push((name.clone(), *title, worst));
        }
    }
    println!(
        "\n## The largest of all quantities\n\n| robot | code | quantities | arithmetic, of x86's | spills, of all |"
    );
    println!("|---|---|--:|--:|--:|");
    for (name, title, Worst { ratio, spills, count }) in summary {
        let (ratio, of_ratio, spills, of_spills) = (ratio.0, ratio.1, 100.0 * spills.0, spills.1);
        println!("| {name} | {title} | {count} | {ratio:.2} ({of_ratio}) | {spills:.1} % ({of_spills}) |");
    }
    Ok(())
}
