//! `cargo xtask accuracy` and `cargo xtask campaign`.

use clap::Parser;
use mozzi::quantities::LIST;
use mozzi_testing::accuracy::page::{LIMIT, Measured};
use mozzi_testing::accuracy::robot::Robot;
use mozzi_testing::accuracy::states::States;
use mozzi_testing::accuracy::{digits, hard, measure, mixed, page, peers};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Measures the errors of every quantity in every way, and of other libraries, against wide numbers.
#[derive(Parser)]
#[command(args_conflicts_with_subcommands = true)]
struct Options {
    #[command(subcommand)]
    command: Option<Command>,
    /// States of each robot, up to a million.
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    states: u32,
    /// States at which 71 digits and the second way check the reference; 0 for none.
    #[arg(long, default_value_t = 2)]
    references: usize,
    /// Names of embedded robots and paths of URDF files, `:floating` behind a free base; `mixed` is a tree with a ball
    /// and a free joint. By default the embedded ones and `mixed`.
    #[arg(long, value_delimiter = ',')]
    robots: Vec<String>,
    /// Also measures every URDF file below this folder; the page lists the files that are refused.
    #[arg(long)]
    published: Option<PathBuf>,
    /// Without the cases that are hard by design.
    #[arg(long)]
    no_hard: bool,
    /// Only these quantities.
    #[arg(long, value_delimiter = ',')]
    quantities: Vec<String>,
    /// Seed of the random states.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Python interpreter with `pin` and `mujoco`; without it other libraries are not measured.
    #[arg(long)]
    python: Option<PathBuf>,
    /// File for the page; standard output by default.
    #[arg(long)]
    page: Option<PathBuf>,
}

#[derive(clap::Subcommand)]
enum Command {
    /// Compares every quantity of random robots in two ways.
    Campaign(mozzi_testing::campaign::command::Options),
}

/// Largest number of states for other libraries.
const ASKED: usize = 1000;
/// Robots with more velocities are not sent to other libraries: their output would be too long.
const LARGEST_ASKED: usize = 200;
/// Largest number of moving links for the second way on 71 digits, which takes too long above it.
const LARGEST_SECOND: usize = 13;

fn main() -> ExitCode {
    let options = Options::parse();
    if let Some(Command::Campaign(options)) = &options.command {
        return match mozzi_testing::campaign::command::run(options) {
            Ok(true) => ExitCode::SUCCESS,
            Ok(false) => ExitCode::FAILURE,
            Err(why) => {
                eprintln!("campaign: {why}");
                ExitCode::from(2)
            }
        };
    }
    match run(&options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("accuracy: {why}");
            ExitCode::from(2)
        }
    }
}

/// Measures, writes the page, and prints errors above the limit.
fn run(options: &Options) -> Result<(), String> {
    let quantities: Vec<usize> = if options.quantities.is_empty() {
        (0..LIST.len()).collect()
    } else {
        let place = |name: &String| mozzi::quantities::Query::named(name).map(|query| query.index());
        options.quantities.iter().map(place).collect::<Result<_, _>>().map_err(|error| error.to_string())?
    };
    let given: Vec<String> = match options.robots.is_empty() {
        true => {
            let more = ["anymal:floating", mixed::NAME, "mixed:floating"];
            mozzi_urdf::embedded::names().chain(more).map(String::from).collect()
        }
        false => options.robots.clone(),
    };
    let mut all = Vec::new();
    let count = options.states as usize;
    for name in &given {
        all.push(measured(options, &quantities, &Robot::open(name)?, count, false)?);
    }
    let files = options.published.as_deref().map_or(Ok(Vec::new()), files)?;
    let mut refused = Vec::new();
    for path in &files {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        match Robot::open(&path.to_string_lossy()) {
            Ok(robot) => all.push(measured(options, &quantities, &robot, count, false)?),
            Err(why) => refused.push(format!("{name}: {}", why.lines().next().unwrap_or_default())),
        }
    }
    for (name, most) in hard::NAMES.into_iter().filter(|_| !options.no_hard) {
        all.push(measured(options, &quantities, &hard::robot(name)?, count.min(most), true)?);
    }
    let text = page::write(&all, &refused, options.seed, &command(), &versions());
    match &options.page {
        Some(path) => std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))?,
        None => println!("{text}"),
    }
    let above: Vec<String> = (all.iter().filter(|robot| !robot.is_hard))
        .flat_map(|robot| robot.above().map(move |row| (robot, row)))
        .map(|(robot, row)| {
            format!("{}, {}, {}: {:.0} units", robot.name, LIST[row.quantity].name, row.way, row.errors.whole().max)
        })
        .collect();
    for line in &above {
        eprintln!("above {LIMIT} units: {line}");
    }
    Ok(())
}

fn measured(
    options: &Options,
    quantities: &[usize],
    robot: &Robot,
    count: usize,
    is_hard: bool,
) -> Result<Measured, String> {
    let states = States::new(&robot.model, robot.kind, count, options.seed);
    eprintln!("{}: {} states", robot.name, states.len());
    let rows = quantities.iter().flat_map(|&quantity| measure::one(robot, &states, options.seed, quantity)).collect();
    let references = if robot.model.moving_links() > LARGEST_SECOND { 0 } else { options.references.min(count) };
    let of = |&quantity: &usize| Some((quantity, digits::of(robot, &states, references, quantity)?));
    let digits = if references > 0 { quantities.iter().filter_map(of).collect() } else { Vec::new() };
    let peers = match &options.python {
        Some(python) if robot.model.n() <= LARGEST_ASKED => peers::ask(python, robot, &states, ASKED, options.seed),
        _ => Vec::new(),
    };
    Ok(Measured {
        name: robot.name.clone(),
        n: robot.model.n(),
        is_hard,
        states: count,
        rows,
        peers,
        references: (references, digits),
    })
}

/// The URDF files below a folder, in the order of their paths.
fn files(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let said = |error: std::io::Error| format!("{}: {error}", folder.display());
    let (mut found, mut folders) = (Vec::new(), vec![folder.to_path_buf()]);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).map_err(said)? {
            let path = entry.map_err(said)?.path();
            match path.is_dir() {
                true => folders.push(path),
                false if path.extension().is_some_and(|extension| extension == "urdf") => found.push(path),
                false => {}
            }
        }
    }
    found.sort();
    Ok(found)
}

fn command() -> String {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut shown = Vec::new();
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        match argument.as_str() {
            "--page" | "--python" | "--published" => drop(rest.next()), // set by the command itself
            other => shown.push(other.to_string()),
        }
    }
    ["cargo xtask accuracy".to_string()].into_iter().chain(shown).collect::<Vec<_>>().join(" ")
}

fn versions() -> String {
    let arrays = <f64 as mozzi_engine::Number>::shape().map_or("kernels", |shape| shape.instruction_set());
    format!("mozzi {}, arrays by {arrays}", env!("CARGO_PKG_VERSION"))
}
