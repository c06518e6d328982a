//! The tables, as Markdown.

use crate::machine;
use crate::motion::{BRAKE, STEP, STEPS};
use crate::peak::Width;
use crate::peer::Peer;
use crate::quantity;
use crate::race::{Row, Table, Time};
use crate::simulation::{METHODS, Simulated};
use mozzi::quantities::Query;
use std::fmt::Write;

/// The whole report, with the conditions of the measurement.
pub fn text(
    tables: &[Table],
    simulated: &[Simulated],
    peers: &[Peer],
    missing: &[(String, String)],
    peaks: &[(Width, Option<f64>)],
) -> Result<String, String> {
    let mut text = format!("# One core, beside the peers\n\n{}", how());
    for peer in peers {
        line(&mut text, &format!("- {}.", peer.version()?));
    }
    for (name, why) in missing {
        line(&mut text, &format!("- {name}: missing, {why}."));
    }
    let peak = |&(width, peak): &(Width, Option<f64>)| match peak {
        Some(peak) => format!("{}: {peak:.1}", width.name()),
        None => format!("{}: none", width.name()),
    };
    let peaks_text = peaks.iter().map(peak).collect::<Vec<_>>().join("; ");
    line(&mut text, &format!("- Peak, measured, in flops a nanosecond, a fused multiply-add being two: {peaks_text}."));
    text += "\n![Times of the peers over mozzi's](results.svg)\n";
    for (title, is_generated) in
        [("The fastest library's time", false), ("The time of C generated for the one robot", true)]
    {
        line(&mut text, &format!("\n## {title} over mozzi's"));
        for (column, way) in WAYS {
            line(&mut text, &format!("\n{way}:"));
            fastest_peers(&mut text, tables, is_generated, column);
        }
    }
    first_results(&mut text, tables);
    simulations(&mut text, simulated);
    for table in tables {
        robot(&mut text, table, peaks);
    }
    operations(&mut text, tables);
    functions(&mut text, tables);
    Ok(text)
}

fn line(text: &mut String, line: &str) {
    text.push_str(line);
    text.push('\n');
}

fn how() -> String {
    let (processor, date, rustc) = (machine::processor(), machine::date(), machine::rustc());
    format!(
        "\
`cargo xtask bench`, {date}, {processor}.

- Every library gets the robot by numbers, fixed links merged, no friction, no armature, gravity 9.80665 m/s², and the same random states.
  Every result at every state was compared with mozzi's before anything was timed.
- One process on one processor; in each round everything runs over all states, in turn, for half a millisecond untimed, then once timed.
  Where a library has several algorithms for a quantity, the fastest is quoted.
- Nanoseconds for one state: least of all rounds / median. In bold the time over mozzi's, least over least; behind it median over median.
- mozzi: {rustc}, release profile, no flags: `mozzi::fast` finds FMA when it runs; portable is the same source
  without them; compiled is machine code made for the one robot when the program runs; arrays are what a call with
  many states gives by default, on one thread: machine code for 4 (AVX2) or 8 (AVX-512) states in a register.
"
    )
}

/// The peer whose code is generated for each robot, instead of a library for any robot.
const GENERATED: &str = "CasADi";

/// mozzi's columns with which the peers are compared.
const WAYS: [(&str, &str); 4] = [
    ("mozzi", "One state a call"),
    ("compiled", "One state a call, compiled"),
    ("arrays avx2", "Many states, AVX2"),
    ("arrays avx512", "Many states, AVX-512"),
];

/// Those of any table: a robot with constraints has its own.
fn quantities(tables: &[Table]) -> impl Iterator<Item = Query<'static>> {
    quantity::all().filter(|&query| tables.iter().any(|table| row_of(table, query).is_some()))
}

fn row_of<'t>(table: &'t Table, quantity: Query<'static>) -> Option<&'t Row> {
    table.rows.iter().find(|row| row.quantity == quantity)
}

/// For each robot and quantity, the time of the fastest peer, library or generated code, over that of one of mozzi's
/// columns.
fn fastest_peers(text: &mut String, tables: &[Table], is_generated: bool, ours: &str) {
    let head = tables.iter().map(|table| table.robot.as_str()).collect::<Vec<_>>();
    line(text, &format!("\n| | {} |", head.join(" | ")));
    line(text, &format!("|---|{}", "---|".repeat(tables.len())));
    for quantity in quantities(tables) {
        let cells = tables.iter().map(|table| {
            let Some(row) = row_of(table, quantity) else { return "–".into() };
            let columns = table.columns.iter().zip(&row.times);
            let peers = columns.filter(|(c, _)| c.width.is_none() && (c.name == GENERATED) == is_generated);
            let timed = peers.filter_map(|(column, time)| Some((&column.name, time.as_ref()?)));
            let unit = table.columns.iter().position(|column| column.name == ours).and_then(|k| row.times[k].as_ref());
            match (timed.min_by(|a, b| a.1.least.total_cmp(&b.1.least)), unit) {
                (Some((_, time)), Some(unit)) if is_generated => ratio(time, unit),
                (Some((name, time)), Some(unit)) => format!("{} {name}", ratio(time, unit)),
                _ => "–".into(),
            }
        });
        line(text, &format!("| {} | {} |", quantity.name(), cells.collect::<Vec<_>>().join(" | ")));
    }
}

/// The ratio of times: of the least / of the medians.
fn ratio(time: &Time, unit: &Time) -> String {
    format!("**{:.2}** / {:.2}", time.least / unit.least, time.median / unit.median)
}

/// The time from the model to the first result by machine code.
fn first_results(text: &mut String, tables: &[Table]) {
    *text += "\nFrom the model to its first inverse dynamics by machine code, the least of a few: ";
    let of = |table: &Table| Some(format!("{} {:.2} ms", table.robot, table.to_first_result?));
    line(text, &format!("{}.", tables.iter().filter_map(of).collect::<Vec<_>>().join(", ")));
}

/// A step of a simulation, of each library.
fn simulations(text: &mut String, simulated: &[Simulated]) {
    let _ = writeln!(
        text,
        "
## Simulation

A step of {STEP} s, motors braking by {BRAKE} N m s, of {STEPS} steps from rest: mozzi's and its machine code's `simulate`; of the others
forward dynamics in a loop of C++ (benches/peers/peer.hpp). Every step waits for the one before it. All end in the same state. Nanoseconds,
and their ratio to mozzi's, as above.
"
    );
    for Simulated { robot, columns } in simulated {
        let names = columns.iter().filter(|(_, times)| times[0].is_some()).map(|(name, _)| name.as_str());
        let names: Vec<&str> = names.collect();
        line(text, &format!("| {robot} | {} |\n|---|{}", names.join(" | "), "---|".repeat(names.len())));
        for (k, method) in METHODS.iter().enumerate() {
            let times: Vec<&Time> = columns.iter().filter_map(|(_, times)| times[k].as_ref()).collect();
            let cells = times.iter().enumerate().map(|(column, time)| match column {
                0 => of_rounds(time),
                _ => format!("{}, {}", of_rounds(time), ratio(time, times[0])),
            });
            line(text, &format!("| {} | {} |", method.name(), cells.collect::<Vec<_>>().join(" | ")));
        }
        text.push('\n');
    }
}

/// The least / the median.
fn of_rounds(time: &Time) -> String {
    format!("{} / {}", nanoseconds(time.least), nanoseconds(time.median))
}

fn robot(text: &mut String, table: &Table, peaks: &[(Width, Option<f64>)]) {
    let (n, states, rounds) = (table.n, table.states, table.rounds);
    line(text, &format!("\n## {}, n = {n}\n\n{rounds} rounds of {states} states.", table.robot));
    let others = table.columns[1..].iter().map(|column| format!("{} {:.0e}", column.name, column.difference));
    line(
        text,
        &format!("Largest difference from mozzi, over the largest entry: {}.\n", others.collect::<Vec<_>>().join(", ")),
    );
    let names = table.columns.iter().map(|column| column.name.as_str()).collect::<Vec<_>>();
    line(text, &format!("| ns | {} | flops | of the peak |", names.join(" | ")));
    line(text, &format!("|---|{}---|---|", "---|".repeat(names.len())));
    for row in &table.rows {
        let mut cells = String::new();
        for (k, time) in row.times.iter().enumerate() {
            let _ = match (time, &row.times[0]) {
                (None, _) => write!(cells, " – |"),
                (Some(time), Some(unit)) if k > 0 => {
                    write!(cells, " {}, {} |", of_rounds(time), ratio(time, unit))
                }
                (Some(time), _) => write!(cells, " {} |", of_rounds(time)),
            };
        }
        let flops = row.count.flops();
        line(text, &format!("| {} |{cells} {flops} | {} |", row.quantity.name(), shares(table, row, peaks)));
    }
}

/// At least three digits.
fn nanoseconds(x: f64) -> String {
    if x < 100.0 { format!("{x:.1}") } else { format!("{x:.0}") }
}

/// The fraction of its instructions' peak that each of mozzi's ways reaches, in the columns' order.
fn shares(table: &Table, row: &Row, peaks: &[(Width, Option<f64>)]) -> String {
    let ours = table.columns.iter().zip(&row.times).filter_map(|(column, time)| {
        let peak = peaks.iter().find(|(width, _)| Some(*width) == column.width)?.1?;
        let time = time.as_ref()?;
        let flops = time.flops.unwrap_or(row.count.flops() as usize);
        Some(format!("{:.0} %", 100.0 * flops as f64 / time.least / peak))
    });
    ours.collect::<Vec<_>>().join(", ")
}

fn operations(text: &mut String, tables: &[Table]) {
    *text += "
## Operations

What the kernels' source asks for at one state, counted by running it on a number that counts: sums + products + fused multiply-adds +
divisions and roots, (sines and cosines). Flops are all of them, a fused one twice, sines and cosines not at all. A compiler fuses no
more and leaves out what multiplies by a constant 0 or 1. Of the peak: flops over time over the peak of the
instructions that a way runs on, for each of mozzi's columns; of compiled ones the flops of the robot's own program, with its sines.

";
    let head = tables.iter().map(|table| table.robot.as_str()).collect::<Vec<_>>();
    line(text, &format!("| | {} |\n|---|{}", head.join(" | "), "---|".repeat(tables.len())));
    for quantity in quantities(tables) {
        let cells = tables.iter().map(|table| {
            let Some(Row { count: c, .. }) = row_of(table, quantity) else { return "–".into() };
            format!("{} + {} + {} + {}, ({})", c.sums, c.products, c.fused, c.divisions, c.sin_cos)
        });
        line(text, &format!("| {} | {} |", quantity.name(), cells.collect::<Vec<_>>().join(" | ")));
    }
}

/// The name of each peer's fastest function.
fn functions(text: &mut String, tables: &[Table]) {
    *text += "\n## What was called\n\n";
    let mut peers: Vec<&str> = Vec::new();
    for column in tables.iter().flat_map(|table| &table.columns).filter(|column| column.width.is_none()) {
        if !peers.contains(&column.name.as_str()) {
            peers.push(&column.name);
        }
    }
    if peers.is_empty() {
        return line(text, "No peer.");
    }
    line(text, &format!("| | {} |\n|---|{}", peers.join(" | "), "---|".repeat(peers.len())));
    for quantity in quantities(tables) {
        let cells = peers.iter().map(|peer| {
            let mut names: Vec<&str> = Vec::new();
            for table in tables {
                let Some(row) = row_of(table, quantity) else { continue };
                let columns = table.columns.iter().zip(&row.times);
                for (_, time) in columns.filter(|(column, _)| column.name == *peer) {
                    names.extend(time.iter().map(|time| time.algorithm.as_str()));
                }
            }
            names.sort_unstable();
            names.dedup();
            if names.is_empty() { "–".into() } else { names.join("; ") }
        });
        line(text, &format!("| {} | {} |", quantity.name(), cells.collect::<Vec<_>>().join(" | ")));
    }
}
