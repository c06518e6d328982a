//! Every quantity of the list: at one state, and from a table.

use super::files::read_npz;
use super::states::States;
use super::{largest, tied};
use crate::common::{assert_close, folder, json, mozzi, numbers, text, words};
use mozzi::quantities::{LIST, Of, Uses};
use serde_json::Value;

fn comma(numbers: &[f64]) -> String {
    numbers.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(",")
}

fn flat(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(list) => list.iter().flat_map(flat).collect(),
        number => vec![number.as_f64().expect("a number")],
    }
}

#[test]
fn every_quantity_is_the_same_at_one_state_and_in_a_table() {
    let folder = folder("compute_list");
    let (model, rod) = tied(&folder);
    let states = States::new(&model, 3);
    let input = states.npz(&folder, "states.npz");
    for declaration in LIST {
        let name = declaration.name.replace('_', "-");
        let subject: &[&str] = match declaration.of {
            Of::Robot => &[],
            Of::Frame => &["--frame", "wrist_1_link"],
            Of::Task => &["--task", "vx,vz", "--task-frame", "space"],
            Of::Point => &["--about", "0.1,-0.2,0.3"],
        };
        let out = folder.join(format!("{name}.npz")).to_str().expect("text").to_string();
        text(&[&["compute", "ur5", &name, "--constraints", &rod, "--in", &input, "--out", &out], subject].concat());
        let table = read_npz(&out);
        let names: Vec<&str> = table.iter().map(|(name, ..)| name.as_str()).collect();
        assert_eq!(names, declaration.outputs.iter().map(|output| output.name).collect::<Vec<_>>());
        for state in 0..3 {
            let place = |name: &str| match name {
                "theta" => 0,
                "dtheta" => 1,
                "w" => 3,
                _ => 2,
            };
            let mut flags: Vec<String> = Vec::new();
            for input in declaration.inputs {
                flags.extend([format!("--{}", input.name), comma(states.at(place(input.name), state))]);
            }
            if declaration.uses.has(Uses::WRENCHES) {
                flags.extend(["--tip-wrench".to_string(), comma(states.at(3, state))]);
            }
            let flags: Vec<&str> = flags.iter().map(String::as_str).collect();
            // the name with underscores
            let found = json(&[&["compute", "ur5", declaration.name, "--constraints", &rod], subject, &flags].concat());
            for input in declaration.inputs {
                assert_eq!(numbers(&found[input.name]), states.at(place(input.name), state), "{name}");
            }
            for (output, shape, values) in &table {
                let one = flat(&found[output.as_str()]);
                let width = values.len() / 3;
                assert_eq!(one.len(), width, "{name}: {output} {shape}");
                assert_close(&one, &values[state * width..][..width], 1e-11 * largest(values));
            }
            let page = text(&[&["compute", "ur5", &name, "--constraints", &rod], subject, &flags].concat());
            assert!(words(&page).contains(declaration.formula), "{page}");
        }
    }
}

#[test]
fn names_of_outputs_are_those_of_no_other_key() {
    for declaration in LIST {
        let inputs = declaration.inputs.iter().map(|input| input.name);
        let keys = inputs.chain(["robot", "joints", "base", "positions", "velocities", "quantity", "frame", "rows"]);
        let keys: Vec<&str> = keys.chain(["coordinates", "about", "gravity", "wrenches", "t"]).collect();
        assert!(declaration.outputs.iter().all(|output| !keys.contains(&output.name)), "{}", declaration.name);
    }
}

#[test]
fn the_list_has_formulas_flags_and_shapes() {
    let page = text(&["compute", "--list"]);
    assert_eq!(text(&["compute", "ur5", "--list"]), page);
    let help = text(&["compute", "--help"]);
    for declaration in LIST {
        let name = declaration.name.replace('_', "-");
        assert!(words(&page).contains(&format!("{name}: {} takes", declaration.formula)), "{name} in {page}");
        assert!(help.contains(&name), "{name} in {help}");
    }
    for line in ["takes --theta, --dtheta, --frame, --state\n", "--gravity, --state\n", "gives M (n, n)\n"] {
        assert!(page.contains(line), "{line} in {page}");
    }
    assert_eq!(mozzi(&["compute"]).status.code(), Some(2));
}

#[test]
fn units_are_those_of_the_robots_joints() {
    let page = text(&["compute", "ur5", "inverse-dynamics-derivatives", "-v"]);
    for title in ["d_theta [N m, each per unit of its column]", "velocities", "rad/s  "] {
        assert!(page.contains(title), "{title} in {page}");
    }
    assert!(text(&["compute", "panda", "gravity-forces"]).contains("N m or N"));
    assert!(text(&["compute", "ur5", "mass-matrix"]).contains("M [kg m²]\n"));
    assert!(text(&["compute", "ur5", "body-jacobian"]).contains("J [1 or m]\n"));
    let page = text(&["compute", "ur5", "frame-poses"]);
    assert!(page.contains("T, forearm_link [m]") && page.contains("T, tool0 [m]"), "{page}");
}
