//! docs/gpu.md.

use super::card::{Bounds, CARDS};
use super::{Count, cases};
use mozzi_gpu::Arch;

const HEAD: &str = "\
# GPU kernels, counted

Written by `cargo xtask gpu-report`. **Nothing on this page was measured**: every number is counted in machine code, and
the bounds are what the code would reach if one part of the card were always busy and everything else free. Real speeds
are lower. `cargo xtask gpu-bench` measures on a machine with a GPU. How to use the kernels: [gpu-guide.md](gpu-guide.md).

- **registers**, **spilled**: of a thread; bytes stored to and loaded from local memory because registers ran out, as
  reported by the assembler. A multiprocessor has 65536 registers: 64 a thread allow 1024 threads, 128 allow 512, 255
  allow 256.
- **instructions** of one state: fused multiply-adds, other sums and products, the special unit (reciprocals, square
  roots), global, shared and local memory, all others. Rare paths, such as those of divisions by tiny numbers, are
  included. The loop that spreads a long, sparse result from shared memory is counted once.
- **bytes**: what a state reads and writes in device memory.
- **bounds**, 10⁹ states a second: *memory* is the bandwidth over the bytes; *arithmetic* the card's multiply-adds a
  second over the instructions of its arithmetic units; *issue* one instruction of a warp in each cycle of each
  scheduler. The smallest is in the last column, with its name.

Each of Talos's ∂τ takes about a minute to compile.
";

/// The page.
pub fn text(counts: &[Count], arch: Arch, (major, minor): (u32, u32)) -> String {
    let mut text = HEAD.to_string();
    text += &format!("\nCompiled by NVRTC {major}.{minor} for {arch}. Cards (NVIDIA's data sheets, SXM): ");
    let cards: Vec<String> = CARDS
        .iter()
        .map(|card| {
            format!(
                "{}, {} TB/s, {} and {} TFLOPS in f32 and f64",
                card.name,
                card.bandwidth / 1e12,
                card.flops_f32 / 1e12,
                card.flops_f64 / 1e12
            )
        })
        .collect();
    text += &format!("{}.\n", cards.join("; "));
    let mut robot = "";
    for count in counts {
        if count.robot != robot {
            robot = &count.robot;
            text += &format!("\n## {robot}, n = {}\n\n", count.n);
            text += "| quantity | | registers | spilled | fma | add, mul | special | global | shared | local | other | bytes \
                     | memory H100, H200 | arithmetic | issue | bound on an H200 |\n";
            text += "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
        }
        text += &row(count);
    }
    text
}

fn row(count: &Count) -> String {
    let [h100, h200] = CARDS.each_ref().map(|card| Bounds::of(card, count));
    let giga = |x: f64| format!("{:.*}", usize::from(x < 99.5e9) * if x < 9.95e9 { 2 } else { 1 }, x / 1e9);
    let (least, by) = h200.least();
    let (resources, i) = (count.resources, count.instructions);
    format!(
        "| {} | {} | {} | {} + {} | {} | {} | {} | {} | {} | {} | {} | {} | {}, {} | {} | {} | {} {by} |\n",
        cases::title(count.quantity, count.form),
        cases::name(count.form),
        resources.registers,
        resources.spill_stores,
        resources.spill_loads,
        i.fma,
        i.add_mul,
        i.special,
        i.global,
        i.shared,
        i.local,
        i.other,
        count.bytes,
        giga(h100.memory),
        giga(h200.memory),
        giga(h200.arithmetic),
        giga(h200.issue),
        giga(least),
    )
}
