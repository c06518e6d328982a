//! One robot: checks that all values agree, then times all algorithms in turn, repeatedly.

use crate::compiled;
use crate::contestant::Entry;
use crate::count::{Count, count};
use crate::mozzi_ways;
use crate::peak::Width;
use crate::peer::Peer;
use crate::quantity;
use crate::states::States;
use mozzi::Model;
use mozzi::quantities::Query;
use std::time::{Duration, Instant};

/// The tolerance, relative to the largest entry, above which two libraries do not compute the same. The longest chain
/// needs it: its M is so badly conditioned that accelerations keep ten digits.
pub const LARGEST_DIFFERENCE: f64 = 1e-8;

/// Warm-up time. Code that ran before leaves its own caches and branch history, and the wide vector units powered down:
/// after their first use they are several times slower for hundreds of microseconds.
const WARMING: Duration = Duration::from_micros(500);

/// The times of one algorithm, in nanoseconds for one evaluation.
#[derive(Clone, Debug)]
pub struct Time {
    /// The library's name for it.
    pub algorithm: String,
    pub least: f64,
    pub median: f64,
    /// The flops of the column's own program, if it has one.
    pub flops: Option<usize>,
}

/// One quantity of one robot.
pub struct Row {
    pub quantity: Query<'static>,
    pub count: Count,
    /// The fastest algorithm of each column, if it has any.
    pub times: Vec<Option<Time>>,
}

/// One library, or one of mozzi's ways.
pub struct Column {
    pub name: String,
    pub width: Option<Width>,
    /// The largest difference from the first column.
    pub difference: f64,
}

/// One robot.
pub struct Table {
    pub robot: String,
    pub n: usize,
    pub states: usize,
    pub rounds: usize,
    /// Milliseconds from the model to the first inverse dynamics by machine code.
    pub to_first_result: Option<f64>,
    pub columns: Vec<Column>,
    pub rows: Vec<Row>,
}

/// One algorithm of one entry.
struct Runner {
    entry: usize,
    algorithm: usize,
    quantity: Query<'static>,
    name: String,
    flops: Option<usize>,
    times: Vec<f64>,
}

/// Measures all contestants on one robot.
pub fn race(title: &str, slug: &str, model: &Model, peers: &[Peer], time: Duration) -> Result<Table, String> {
    let states = States::new(model, if model.n() > 50 { States::COUNT / 8 } else { States::COUNT });
    let mut entries = all(slug, model, &states, peers)?;
    let columns = checked(title, model, &states, &mut entries)?;
    let mut runners = Vec::new();
    for (entry, Entry { contestant, .. }) in entries.iter().enumerate() {
        for (algorithm, (quantity, name)) in contestant.algorithms().into_iter().enumerate() {
            let flops = contestant.flops(algorithm);
            runners.push(Runner { entry, algorithm, quantity, name, flops, times: Vec::new() });
        }
    }
    runners.sort_by_key(|runner| quantity::all().position(|query| query == runner.quantity));
    let (start, mut rounds) = (Instant::now(), 0);
    while start.elapsed() < time || rounds < 20 {
        rounds += 1;
        for Runner { entry, algorithm, times, .. } in &mut runners {
            let contestant = &mut entries[*entry].contestant;
            let warm = Instant::now();
            while warm.elapsed() < WARMING {
                contestant.run(*algorithm);
            }
            let start = Instant::now();
            contestant.run(*algorithm);
            times.push(start.elapsed().as_secs_f64() * 1e9 / states.count() as f64);
        }
    }
    let state = states.iter().next().ok_or("no states")?;
    let rows = quantity::of(model).map(|quantity| Row {
        quantity,
        count: count(quantity, model, state),
        times: (0..entries.len()).map(|entry| fastest(&runners, entry, quantity)).collect(),
    });
    let rows = rows.collect();
    let to_first_result = compiled::to_first_result(model, &states);
    Ok(Table { robot: title.into(), n: model.n(), states: states.count(), rounds, to_first_result, columns, rows })
}

/// The columns, after checking that every algorithm agrees with the first one at every state.
fn checked(title: &str, model: &Model, states: &States, entries: &mut [Entry]) -> Result<Vec<Column>, String> {
    let mut differences = vec![0.0_f64; entries.len()];
    for query in quantity::of(model) {
        for state in 0..states.count() {
            let reference = entries[0].contestant.result(of(&entries[0], query)[0], state)?;
            for (entry, worst) in entries.iter_mut().zip(&mut differences) {
                for algorithm in of(entry, query) {
                    let found = entry.contestant.result(algorithm, state)?;
                    let difference = quantity::difference(query, &found, &reference);
                    if !(difference <= LARGEST_DIFFERENCE) {
                        let (name, what) = (&entry.name, query.name());
                        return Err(format!(
                            "{title} of {} velocities: {what} by {name} ({}) differs from mozzi's by {difference:.1e} at state {state}",
                            model.n(),
                            entry.contestant.algorithms()[algorithm].1
                        ));
                    }
                    *worst = worst.max(difference);
                }
            }
        }
    }
    let columns = entries.iter().zip(differences).map(|(entry, difference)| Column {
        name: entry.name.clone(),
        width: entry.width,
        difference,
    });
    Ok(columns.collect())
}

/// The algorithms that an entry has for a quantity.
fn of(entry: &Entry, query: Query) -> Vec<usize> {
    let algorithms = entry.contestant.algorithms();
    (0..algorithms.len()).filter(|&k| algorithms[k].0 == query).collect()
}

fn fastest(runners: &[Runner], entry: usize, query: Query) -> Option<Time> {
    let mine = runners.iter().filter(|runner| runner.entry == entry && runner.quantity == query);
    let times = mine.filter_map(|runner| of_runs(&runner.name, runner.flops, runner.times.clone()));
    times.min_by(|a, b| a.least.total_cmp(&b.least))
}

/// Statistics of all rounds; none if it did not run.
pub fn of_runs(algorithm: &str, flops: Option<usize>, mut times: Vec<f64>) -> Option<Time> {
    times.sort_by(f64::total_cmp);
    Some(Time { algorithm: algorithm.into(), least: *times.first()?, median: times[times.len() / 2], flops })
}

/// All contestants that support this robot; the first is mozzi at one state, which gives the reference and the unit.
fn all<'a>(name: &str, model: &'a Model, states: &'a States, peers: &'a [Peer]) -> Result<Vec<Entry<'a>>, String> {
    let mut entries = mozzi_ways::all(model, states)?;
    for peer in peers {
        if let Some(robot) = peer.robot(name, model, states)? {
            entries.push(Entry { name: peer.name.clone(), width: None, contestant: Box::new(robot) });
        }
    }
    Ok(entries)
}
