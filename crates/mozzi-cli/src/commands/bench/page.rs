//! The times as text and as JSON.

use super::timing::{Report, Timing, Way};
use crate::json;
use crate::text::{Page, about, digits, table};
use mozzi::Model;
use serde_json::{Value, json};

pub fn object(model: &Model, report: &Report) -> String {
    let entry = |timing: &Timing| {
        json!({
            "quantity": timing.name,
            "engine": timing.engine,
            "one_state": timing.way.is_one,
            "precision": timing.way.precision,
            "threads": timing.way.threads,
            "ns_least": timing.least,
            "ns_median": timing.median,
            "states_per_second": 1e9 / timing.median,
            "difference": timing.difference,
        })
    };
    json::print(&json::of_robot(
        model,
        json!({
            "processor": report.processor, "states": report.states,
            "rounds": report.rounds, "complete": report.complete, "timings": report.timings.iter().map(entry).collect::<Value>(),
        }),
    ))
}

pub fn page(model: &Model, report: &Report, is_long: bool) -> String {
    let Report { processor, states, rounds, threads, timings, .. } = report;
    let mut page = Page::default();
    page.line(format!("{}: {} positions, {} velocities", model.description().name, model.nq(), model.n()));
    page.line(format!("{processor}; at most {threads} threads"));
    page.line(format!("{states} states per batch; median of {rounds} alternating rounds"));
    let time = |timing: &Timing| digits(timing.median, 3);
    let rate = |timing: &Timing| digits(1e3 / timing.median, 3);
    let one_thread = |way: Way| way.threads == 1;
    page.title("nanoseconds per state, on one thread").lines(&grid(timings, one_thread, time));
    if *threads > 1 {
        let title = format!("millions of states per second, on {threads} threads");
        page.title(&title).lines(&grid(timings, |way| way.threads > 1, rate));
    }
    if !is_long {
        let most = timings.iter().filter(|timing| timing.way.precision == "f64").map(|timing| timing.difference);
        let most = about(most.fold(0.0, f64::max));
        page.blank().line(format!("largest difference of arrays from one state, f64: {most} of the largest entry"));
        page.line("--all times every quantity, and prints engines and differences; --json every number");
        return page.end();
    }
    let engine = |timing: &Timing| timing.engine.clone();
    page.title("computed by").lines(&grid(timings, one_thread, engine));
    let error = |timing: &Timing| about(timing.difference);
    page.title("largest difference from one state, relative to the largest entry")
        .lines(&grid(timings, one_thread, error));
    page.end()
}

/// A row for each quantity, a column for each way.
fn grid(timings: &[Timing], which: impl Fn(Way) -> bool, cell: impl Fn(&Timing) -> String) -> Vec<String> {
    let mut rows: Vec<Vec<String>> = Vec::new();
    let mut head = vec![String::new()];
    for timing in timings.iter().filter(|timing| which(timing.way)) {
        let (way, name) = (timing.way, timing.name.clone());
        let title = way.title();
        if !head.contains(&title) {
            head.push(title);
        }
        match rows.last_mut().filter(|row| row[0] == name) {
            Some(row) => row.push(cell(timing)),
            None => rows.push(vec![name, cell(timing)]),
        }
    }
    table(&[vec![head], rows].concat(), "lr")
}
