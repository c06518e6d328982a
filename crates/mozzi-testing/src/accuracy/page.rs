//! The page docs/accuracy.md.

use crate::accuracy::DRAWS;
use crate::accuracy::digits::Digits;
use crate::accuracy::errors::Summary;
use crate::accuracy::measure::Row;
use crate::accuracy::peers::Answer;
use crate::accuracy::ways::Way;
use mozzi::quantities::LIST;
use std::fmt::Write;

/// The measurements of a robot.
pub struct Measured {
    /// Its name.
    pub name: String,
    /// The number of its velocities.
    pub n: usize,
    /// True if it is a hard case by design.
    pub is_hard: bool,
    /// The number of states.
    pub states: usize,
    /// mozzi's errors.
    pub rows: Vec<Row>,
    /// Other libraries'.
    pub peers: Vec<Answer>,
    /// The number of states at which the references were compared, and each quantity's digits.
    pub references: (usize, Vec<(usize, Digits)>),
}

/// The largest error that counts as rounding, in units.
pub const LIMIT: f64 = 30.0;

impl Measured {
    /// Rows above [`LIMIT`].
    pub fn above(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| !(row.errors.whole().max < LIMIT))
    }
}

/// A number with at most three digits.
fn short(x: f64) -> String {
    match x {
        x if x.is_infinite() => "∞".into(),
        0.0 => "0".into(),
        x if x < 0.005 => format!("{x:.0e}"),
        x if x < 0.1 => format!("{x:.2}"),
        x if x < 10.0 => format!("{x:.1}"),
        x if x < 1000.0 => format!("{x:.0}"),
        x => format!("{x:.0e}"),
    }
}

fn cell(Summary { max, most, median }: Summary) -> String {
    format!("{} / {} / {}", short(max), short(most), short(median))
}

fn table(text: &mut String, head: &[String], rows: impl Iterator<Item = Vec<String>>) {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    text.push_str(&line(head));
    text.push_str(&line(&head.iter().map(|_| "---".to_string()).collect::<Vec<_>>()));
    let is_measured = |row: &Vec<String>| row[1..].iter().any(|cell| cell != "–");
    rows.filter(is_measured).for_each(|row| text.push_str(&line(&row)));
    text.push('\n');
}

/// The worst summary of some rows; None if there are none.
fn worst<'r>(rows: impl Iterator<Item = &'r Row>, of: impl Fn(&Row) -> Summary) -> Option<Summary> {
    rows.map(of).reduce(Summary::worse)
}

fn of_ways(first: &str) -> Vec<String> {
    std::iter::once(first).chain(Way::ALL.map(Way::name)).map(str::to_string).collect()
}

fn ways<'r>(rows: impl Fn(&'static str) -> Option<Summary> + 'r) -> impl Iterator<Item = String> + 'r {
    Way::ALL.into_iter().map(move |way| rows(way.name()).map_or("–".into(), cell))
}

/// The page's text.
pub fn write(all: &[Measured], refused: &[String], seed: u64, command: &str, versions: &str) -> String {
    let mut text = String::new();
    let states = all.iter().map(|robot| robot.states).max().unwrap_or(0);
    let push = |text: &mut String, part: &str| {
        text.push_str(part);
        text.push_str("\n\n");
    };
    push(&mut text, "# Accuracy");
    push(&mut text, &format!("Written by `{command}`. {versions}. Seed {seed}; up to {states} states of each robot."));
    push(
        &mut text,
        &format!(
            "The reference is the same kernel on double-double numbers (31 digits), on a model built from the \
             file's exact decimals. The reference itself is checked against 71-digit numbers and against a \
             second, independent computation of each quantity: see the last table.\n\n\
             **Unit.** One unit is the largest change of a result when each of the robot's constants and rates changes \
             by ε = 2⁻⁵² of itself, and each angle by ε radians, up or down at random (the largest of {DRAWS} draws); at least ε times the result. So a unit is the error caused by rounding the robot's own \
             numbers, measured without a formula for the terms. For `f32`, ε is 2⁻²³. Errors are those of \
             whole outputs: the largest error over the largest unit of a vector's or matrix's entries.\n\n\
             Each cell is **largest / 99.9 % of the states / median**. – means not available (machine code would be too long, or is not supported on the machine)."
        ),
    );
    let published = || all.iter().filter(|robot| !robot.is_hard);
    let hard = || all.iter().filter(|robot| robot.is_hard);

    push(&mut text, "## Robots");
    push(&mut text, "The quantity with the largest error, for each robot.");
    let of_robot = |robot: &Measured| {
        let row = |way: &'static str| worst(robot.rows.iter().filter(|row| row.way == way), |row| row.errors.whole());
        [format!("{} ({} velocities, {} states)", robot.name, robot.n, robot.states)]
            .into_iter()
            .chain(ways(row))
            .collect()
    };
    table(&mut text, &of_ways("robot"), published().map(of_robot));
    if !refused.is_empty() {
        push(&mut text, "Not measured:");
        push(&mut text, &refused.iter().map(|why| format!("- {why}")).collect::<Vec<_>>().join("\n"));
    }
    if hard().next().is_some() {
        push(&mut text, "## Hard by design");
        table(&mut text, &of_ways("case"), hard().map(of_robot));
    }

    above(&mut text, all);

    push(&mut text, "## Quantities");
    push(&mut text, "The largest error over all robots above that are not hard by design.");
    let of_quantity = |quantity: usize| {
        let rows = |way: &'static str| {
            let rows =
                published().flat_map(|robot| &robot.rows).filter(|row| (row.quantity, row.way) == (quantity, way));
            worst(rows, |row| row.errors.whole())
        };
        [LIST[quantity].name.to_string()].into_iter().chain(ways(rows)).collect()
    };
    table(&mut text, &of_ways("quantity"), (0..LIST.len()).map(of_quantity));

    push(&mut text, "## Entry by entry");
    push(
        &mut text,
        "The largest error of an entry over that entry's own unit. It shows the lost digits of small \
             entries in a matrix with large ones, such as a finger's entry in the mass matrix of an arm.",
    );
    let matrices = ["mass_matrix", "coriolis_matrix", "mass_matrix_rate"];
    let entries = all.iter().flat_map(|robot| {
        matrices.iter().map(move |&name| {
            let of_way = move |way: &'static str| {
                let rows = robot.rows.iter().filter(|row| LIST[row.quantity].name == name && row.way == way);
                worst(rows, |row| row.errors.entries())
            };
            [format!("{}: {name}", robot.name)].into_iter().chain(ways(of_way)).collect()
        })
    });
    table(&mut text, &of_ways("robot and matrix"), entries);

    peers(&mut text, all);
    references(&mut text, all);
    text
}

/// The rows above the limit, and the reasons.
fn above(text: &mut String, all: &[Measured]) {
    writeln!(text, "## Above {LIMIT} units\n").expect("a text grows");
    text.push_str(
        "On published robots, all quantities above this limit divide by the mass matrix M, except Ṁ. **M \
             is rounded entry by entry**: M⁻¹, Λ, η, ∂θ̈ and forward dynamics by M use these rounded entries, \
             and no change of the robot's constants changes M in this way. The inverse amplifies it if a \
             light link follows heavy ones, or if three axes meet in a point. `forward_dynamics`, the \
             articulated-body algorithm, never forms M and keeps the digits: prefer it.\n\n\
         In Ṁ = C + Cᵀ the contribution of the first joints' motion to C cancels; if the outer joints \
             hardly move, that is nearly all of C.\n\n\
         In brackets: the same error in ε times the largest term of the formula, which accounts for both \
             effects: |M⁻¹| |M| |X| for X = M⁻¹B, likewise for Λ and η; |C| + |C|ᵀ for Ṁ.\n\n\
         The largest error of each quantity over all ways, in units:\n\n",
    );
    let mut lines: Vec<String> = Vec::new();
    for robot in all {
        let mut worst: std::collections::BTreeMap<usize, (f64, Option<f64>)> = std::collections::BTreeMap::new();
        for row in robot.above() {
            let (units, terms) = worst.entry(row.quantity).or_default();
            *units = units.max(row.errors.whole().max);
            *terms = row.errors.terms().map(|found| found.max.max(terms.unwrap_or(0.0)));
        }
        if !worst.is_empty() {
            let told: Vec<String> =
                worst.iter().map(|(&quantity, &(units, terms))| told(LIST[quantity].name, units, terms)).collect();
            lines.push(format!("- {}: {}", robot.name, told.join(", ")));
        }
    }
    let none = || vec!["- none".to_string()];
    text.push_str(&if lines.is_empty() { none() } else { lines }.join("\n"));
    text.push_str("\n\n");
}

/// A quantity's error in units, and relative to the formula's terms.
fn told(name: &str, units: f64, terms: Option<f64>) -> String {
    let terms = terms.map_or(String::new(), |terms| format!(" ({})", short(terms)));
    format!("{name} {}{terms}", short(units))
}

/// mozzi compared with the libraries.
fn peers(text: &mut String, all: &[Measured]) {
    let asked: Vec<&Measured> = all.iter().filter(|robot| !robot.peers.is_empty()).collect();
    if asked.is_empty() {
        text.push_str("Other libraries were not measured: no Python with them was found.\n\n");
        return;
    }
    text.push_str("## Other libraries\n\n");
    let versions: std::collections::BTreeSet<String> = (asked.iter().flat_map(|robot| &robot.peers))
        .filter_map(|answer| Some(format!("{} {}", answer.library, answer.rows.as_ref().ok()?.0)))
        .collect();
    let versions: Vec<String> = versions.into_iter().collect();
    writeln!(
        text,
        "{} at the same states of the same files, without friction and springs, compared with the same \
             reference in the same units. **Bold**: both the library's median and its largest error are \
             smaller than mozzi's by more than a tenth.\n",
        versions.join(" and ")
    )
    .expect("a text grows");
    let head: Vec<String> =
        ["robot and quantity", "mozzi, one state", "mozzi, machine code in arrays", "Pinocchio", "MuJoCo"]
            .map(String::from)
            .to_vec();
    let rows = asked.iter().flat_map(|robot| {
        (0..LIST.len()).filter_map(move |quantity| {
            let own = |way: Way| robot.rows.iter().find(|row| (row.quantity, row.way) == (quantity, way.name()));
            let one = own(Way::Fused).or(own(Way::Plain))?.errors.whole();
            let of_peer = |answer: &Answer| {
                let rows = answer.rows.as_ref().ok()?;
                Some(rows.1.iter().find(|row| row.quantity == quantity)?.errors.whole())
            };
            let found: Vec<Option<Summary>> = robot.peers.iter().map(of_peer).collect();
            found.iter().any(Option::is_some).then(|| {
                let peer = |found: &Option<Summary>| match found {
                    Some(x) if x.median < 0.9 * one.median && x.max < 0.9 * one.max => format!("**{}**", cell(*x)),
                    Some(x) => cell(*x),
                    None => "–".into(),
                };
                let arrays = own(Way::MachineCodeLanes).map_or("–".into(), |row| cell(row.errors.whole()));
                let name = format!("{}: {}", robot.name, LIST[quantity].name);
                [name, cell(one), arrays].into_iter().chain(found.iter().map(peer)).collect()
            })
        })
    });
    table(text, &head, rows);
    for robot in &asked {
        for answer in &robot.peers {
            if let Err(why) = &answer.rows {
                writeln!(text, "- {}, {}: {why}.", robot.name, answer.library).expect("a text grows");
            }
        }
    }
    text.push('\n');
}

/// The agreement of the references.
fn references(text: &mut String, all: &[Measured]) {
    text.push_str("## The references\n\n");
    text.push_str(
        "The number of digits, relative to the size of the terms, to which the references agree; the \
             smallest over all quantities. First column: the kernel and its second way (stacked closed form, \
             sum over links, dual numbers), both with 71 digits. Second column: the kernel with 31 and with \
             71 digits.\n\n",
    );
    let rows = all.iter().filter(|robot| !robot.references.1.is_empty()).map(|robot| {
        let (states, digits) = &robot.references;
        let fewest = |of: fn(&Digits) -> f64| {
            let fewest = digits.iter().min_by(|a, b| of(&a.1).total_cmp(&of(&b.1)));
            fewest.map_or("–".into(), |(quantity, digits)| format!("{:.1} ({})", of(digits), LIST[*quantity].name))
        };
        vec![robot.name.clone(), states.to_string(), fewest(|digits| digits.ways), fewest(|digits| digits.widths)]
    });
    table(text, &["robot", "states", "two ways on 71 digits", "31 and 71 digits"].map(String::from), rows);
}
