//! Every number that the page computes is the library's: its WebAssembly against the library, in a real browser, for
//! every quantity. An outdated WebAssembly fails here.

use crate::browser;
use crate::common;

use browser::{browser, look, url};
use common::{file, folder, numbers, text};
use mozzi::Model;
use mozzi::quantities::{LIST, Query};
use mozzi::testing::{four_bar, state};
use serde_json::{Value, json};
use std::path::PathBuf;

/// The same operations in the same order: only the standard library's functions may differ.
const TOLERANCE: f64 = 1e-12;

struct Case {
    model: Model,
    job: Value,
    state: [Vec<f64>; 3],
    frame: String,
}

/// All quantities of a robot on its page, at one state.
fn case(page: &std::path::Path, arguments: &[&str], model: Model) -> Case {
    text(&[&["view"], arguments, &["--out", page.to_str().expect("text")]].concat());
    let state = state(&model, 11);
    let frame = model.frames().last().map(|(_, name)| name.to_string()).expect("a frame");
    let request = |quantity: &mozzi::quantities::Declaration| {
        let frame = quantity.needs_frame().then(|| frame.clone());
        let inputs = quantity.inputs.iter().map(|input| (input.name.to_string(), json!(given(input.name, &state))));
        json!({ "request": { "quantity": quantity.name, "frame": frame }, "inputs": inputs.collect::<serde_json::Map<_, _>>() })
    };
    let requests: Value = LIST.iter().map(request).collect();
    let job = json!({ "url": url(page), "width": 600, "height": 400, "theta": [state[0]], "frames": [frame], "requests": requests });
    Case { model, job, state, frame }
}

fn given(name: &str, [theta, dtheta, ddtheta]: &[Vec<f64>; 3]) -> Vec<f64> {
    match name {
        "theta" => theta.clone(),
        "dtheta" | "x" => dtheta.clone(),
        "w" => vec![0.3, -0.2, 0.5, 1.0, -0.4, 0.7],
        _ => ddtheta.clone(),
    }
}

#[test]
fn every_quantity_of_the_page_is_the_librarys() {
    let program = match browser() {
        Ok(program) => program,
        Err(why) => return println!("skipped: {why}; cargo xtask test sets it where a Chromium is installed"),
    };
    let folder = folder("page_numbers");
    let load = |name: &str| mozzi_urdf::open(name).expect("a robot").description;
    let built = |description: mozzi::Description| description.build().expect("sound");
    let page = |name: &str| folder.join(format!("{name}.html"));
    let balls = concat!(env!("CARGO_MANIFEST_DIR"), "/../mozzi-report/tests/balls.xml");
    let closed = file(&folder, "four_bar.json", &mozzi_urdf::json::write(&four_bar()));
    let mut cases = vec![
        case(&page("panda"), &["panda"], built(load("panda"))),
        case(&page("anymal"), &["anymal", "--floating"], built(load("anymal").floating())),
        case(&page("four_bar"), &[&closed], four_bar()),
        case(&page("balls"), &[balls], built(load(balls))),
    ];
    let humanoid = std::env::var_os("MOZZI_ROBOTS")
        .map(|robots| PathBuf::from(robots).join("talos_data/robots/talos_reduced.urdf"));
    match humanoid.filter(|file| file.is_file()) {
        Some(file) => {
            let file = file.to_string_lossy().into_owned();
            cases.push(case(&page("talos"), &[&file, "--meshes", "none"], built(load(&file))));
        }
        None => println!("skipped: a humanoid; MOZZI_ROBOTS names no folder with talos_data"),
    }
    let found = look(&program, &cases.iter().map(|case| case.job.clone()).collect());
    for (Case { model, state, frame, .. }, found) in cases.iter().zip(&found) {
        let name = &model.description().name;
        assert_eq!(found["errors"], json!([]), "{name}: no error on the console");
        assert_eq!(found["requests"].as_array().map(Vec::len), Some(1), "{name}: the page loads nothing but itself");
        let frame = model.frame(frame).expect("a frame");
        for (place, (quantity, found)) in LIST.iter().zip(found["computed"].as_array().expect("a list")).enumerate() {
            let inputs: Vec<Vec<f64>> = quantity.inputs.iter().map(|input| given(input.name, state)).collect();
            let inputs: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
            let what = format!("{name}: {}", quantity.name);
            match model.compute(Query::at(place).of(frame), &inputs, &model.environment()) {
                Err(error) => assert_eq!(found["error"], error.to_string(), "{what}"),
                Ok(expected) => {
                    for (output, expected) in quantity.outputs.iter().zip(&expected) {
                        assert_same(&format!("{what}: {}", output.name), &numbers(&found[output.name]), expected);
                    }
                }
            }
        }
    }
}

fn assert_same(what: &str, found: &[f64], expected: &[f64]) {
    let size = expected.iter().fold(f64::MIN_POSITIVE, |most: f64, x| most.max(x.abs()));
    let apart = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert_eq!(found.len(), expected.len(), "{what}");
    assert!(apart <= TOLERANCE * size, "{what}: differs by {apart:e} of {size:e}: is the page's WebAssembly outdated?");
}
