//! Compares mozzi with its peers: the same robots, states, process, clock and core, in turn.
//!
//! `cargo xtask bench` builds the peers and calls this.

mod arguments;
mod batch;
mod chart;
mod compiled;
mod contestant;
mod convention;
mod count;
mod machine;
mod motion;
mod mozzi_ways;
mod peak;
mod peer;
mod quantity;
mod race;
mod report;
mod robots;
mod simulation;
mod states;

use arguments::Arguments;
use mozzi::Model;
use peer::Peer;
use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;

fn main() -> ExitCode {
    let result = Arguments::parse(std::env::args().skip(1)).and_then(|arguments| match &arguments.describe {
        Some(folder) => describe(&arguments, Path::new(folder)),
        None => compare(&arguments),
    });
    result.map_or_else(
        |why| {
            eprintln!("{why}");
            ExitCode::FAILURE
        },
        |()| ExitCode::SUCCESS,
    )
}

/// A robot: title, short name, and the model that every library gets.
type Robot = (&'static str, &'static str, Model);

/// The requested robots.
fn chosen(arguments: &Arguments) -> Result<Vec<Robot>, String> {
    let mut list = vec![
        ("UR5", "ur5", robots::ur5()),
        ("Panda", "panda", robots::panda()),
        ("tree of 32", "tree", robots::tree()),
        ("chain of 100", "chain", robots::chain()),
    ];
    if let Some(folder) = &arguments.models {
        let [(anymal, a), (talos, t)] = robots::legged(folder.as_ref())?;
        let standing = robots::on_four_feet(&a)?;
        list.splice(2..2, [(anymal, "anymal", a), (talos, "talos", t)]);
        list.push(("ANYmal on four feet", "feet", standing));
    }
    if let Some(names) = &arguments.robots {
        let known: Vec<_> = list.iter().map(|&(_, slug, _)| slug).collect();
        if let Some(name) = names.iter().find(|name| !known.contains(&name.as_str())) {
            return Err(format!("robot `{name}`, expected of {}", known.join(", ")));
        }
        list.retain(|(_, slug, _)| names.iter().any(|name| name == slug));
    }
    let merged = list.into_iter().map(|(title, slug, model)| {
        if model.constraint_rows() > 0 {
            return Ok((title, slug, model)); // merged already
        }
        let model = robots::merged(&model).build().map_err(|error| format!("{title}: {error}"))?;
        Ok((title, slug, model))
    });
    merged.collect()
}

fn compare(arguments: &Arguments) -> Result<(), String> {
    machine::stay_on_one_processor();
    let peers = arguments.peers.iter().map(|(name, path)| Peer::load(name, path)).collect::<Result<Vec<_>, _>>()?;
    let time = Duration::from_secs_f64(arguments.seconds.unwrap_or(15.0));
    let peaks = peak::Width::ALL.map(|width| (width, peak::measure(width)));
    let (mut tables, mut simulated) = (Vec::new(), Vec::new());
    for (title, slug, model) in chosen(arguments)? {
        tables.push(race::race(title, slug, &model, &peers, time)?);
        println!("{title}: {} rounds", tables.last().map_or(0, |table| table.rounds));
        if ["ur5", "panda"].contains(&slug) {
            simulated.push(simulation::simulate(title, slug, &model, &peers, time)?);
        }
    }
    let text = report::text(&tables, &simulated, &peers, &arguments.missing, &peaks)?;
    println!("{text}");
    let Some(folder) = &arguments.write else { return Ok(()) };
    for (name, text) in [("RESULTS.md", text), ("results.svg", chart::svg(&tables))] {
        let path = Path::new(folder).join(name);
        std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    Ok(())
}

/// Each robot's numbers for code generators: gravity, whether the base floats, then the bodies, one on each line.
fn describe(arguments: &Arguments, folder: &Path) -> Result<(), String> {
    for (_, slug, model) in chosen(arguments)? {
        let words = |numbers: &[f64]| numbers.iter().map(|x| format!("{x:e}")).collect::<Vec<_>>().join(" ");
        let description = model.description();
        let mut text = format!("{} {}\n", words(&description.gravity), u8::from(model.is_floating()));
        for body in peer::bodies(description) {
            text += &(words(&body) + "\n");
        }
        let path = folder.join(slug).with_extension("txt");
        std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    Ok(())
}
