//! `mozzi compute` with tables, and `mozzi bench`: every quantity against the library at one state, every kind of file,
//! and errors in files.
#![allow(non_snake_case)]

mod by_python;
use crate::common;
mod environment;
mod files;
mod flags;
mod list;
mod states;

use arrow_array::{ArrayRef, Float64Array, Int64Array};
use common::{assert_close, complaint, file, folder, json, mozzi};
use files::{npy, npz, parse, read_arrow, read_npz, save, to_columns, write_arrow};
use mozzi::quantities::{LIST, Of, Query};
use mozzi::{Environment, Model, Wrench};
use serde_json::Value;
use states::States;
use std::path::Path;
use std::sync::Arc;

/// Arrays by name.
type Arrays = Vec<(&'static str, Vec<f64>)>;

/// Quantities of the robot or its tip, computed by the library at one state: name, then each array.
fn at_one(model: &Model, [theta, dtheta, x, F]: [&[f64]; 4]) -> Vec<(String, Arrays)> {
    let tip = model.end_effector().expect("a tip");
    let applied = [(tip, Wrench::from_array(std::array::from_fn(|k| F[k])))];
    let environment = Environment { applied: &applied, ..model.environment() };
    let input = |name: &str| match name {
        "theta" => theta,
        "dtheta" => dtheta,
        _ => x,
    };
    let known = |input: &&mozzi::quantities::Input| !["x", "w"].contains(&input.name);
    (0..LIST.len())
        .map(Query::at)
        .filter(|query| query.declaration().inputs.iter().all(|input| known(&input)))
        .filter(|query| query.declaration().of != Of::Task)
        .map(|query| {
            let declaration = query.declaration();
            let inputs: Vec<&[f64]> = declaration.inputs.iter().map(|i| input(i.name)).collect();
            let found = model.compute(query.of(tip), &inputs, &environment).expect("regular");
            let names = declaration.outputs.iter().map(|output| output.name);
            (query.name().replace('_', "-"), names.zip(found).collect())
        })
        .collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(1e-9, |m: f64, x| m.max(x.abs()))
}

/// The UR5 whose wrist hangs on a rod, and the file with the rod.
fn tied(folder: &Path) -> (Model, String) {
    let rod = r#"{"constraints": [{"name": "rod", "kind": "distance", "length": 0.5,
                  "a": {"frame": null}, "b": {"frame": "wrist_3_link"}}]}"#;
    let file = file(folder, "rod.json", rod);
    let ur5 = mozzi_urdf::open("ur5").expect("a robot");
    (mozzi_urdf::constraints::read(&file, ur5.description).expect("a rod").build().expect("a model"), file)
}

#[test]
fn every_quantity_is_that_of_one_state() {
    let folder = folder("compute_quantities");
    let (ur5, rod) = tied(&folder);
    let shapes = [("tau", "(11, 6)"), ("M", "(11, 6, 6)"), ("J", "(11, 6, 6)"), ("T", "(11, 4, 4)")];
    let shapes = shapes.into_iter().chain([("energy", "(11,)"), ("d_theta", "(11, 6, 6)")]);
    let shapes: std::collections::BTreeMap<&str, &str> = shapes.collect();
    let states = States::new(&ur5, 11);
    let input = states.npz(&folder, "states.npz");
    let one: Vec<_> = (0..11).map(|s| at_one(&ur5, [0, 1, 2, 3].map(|k| states.at(k, s)))).collect();
    for (k, (name, arrays)) in one[0].iter().enumerate() {
        let out = folder.join(format!("{name}.npz")).to_str().expect("text").to_string();
        let output = mozzi(&["compute", "ur5", name, "--constraints", &rod, "--in", &input, "--out", &out]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && said.contains("11 states in ") && said.contains("states/s"), "{said}");
        let found = read_npz(&out);
        assert_eq!(found.len(), arrays.len(), "{name}");
        for (a, (array, shape, values)) in found.iter().enumerate() {
            assert_eq!(array, arrays[a].0);
            let is_other = *name == "frame-poses" || *name == "center-of-mass-jacobian"; // T of all frames, J of three rows
            let known = shapes.get(array.as_str()).filter(|_| !is_other);
            assert!(known.is_none_or(|expected| expected == shape), "{array} {shape}");
            let expected: Vec<f64> = one.iter().flat_map(|state| state[k].1[a].1.clone()).collect();
            assert_close(values, &expected, 1e-11 * largest(&expected));
        }
    }
}

#[test]
fn what_is_computed_with_is_chosen() {
    let folder = folder("compute_ways");
    let ur5 = mozzi_urdf::open("ur5").expect("a robot").build().expect("a model");
    let states = States::new(&ur5, 300);
    let input = save(&folder, "states.npy", &npy(&[300, 18], &states.beside(&[0, 1, 2]), false));
    let out = folder.join("tau.npy").to_str().expect("text").to_string();
    let run = |more: &[&str]| {
        let fixed = ["compute", "ur5", "inverse-dynamics", "--in", &input, "--out", &out];
        let summary = json(&[&fixed, more].concat());
        (summary, parse(&std::fs::read(&out).expect("a file")))
    };
    let (summary, (shape, kernels)) = run(&["--kernels-only", "--threads", "1"]);
    assert_eq!(
        (shape.as_str(), summary["states"].as_u64(), summary["threads"].as_u64()),
        ("(300, 6)", Some(300), Some(1))
    );
    let engine = "kernels: machine code was not requested";
    assert_eq!((&summary["engine"], &summary["arrays"][0]["name"]), (&engine.into(), &"tau".into()));
    let bytes = std::fs::read(&out).expect("a file");
    assert_eq!(run(&["--kernels-only", "--threads", "2"]).1.1, kernels);
    let mut workspace = mozzi::fast::Workspace::new(&ur5);
    for state in 0..300 {
        let (inputs, mut tau) = ([0, 1, 2].map(|k| states.at(k, state)), [0.0; 6]);
        let (query, own) = (mozzi::quantities::InverseDynamics.into(), ur5.environment());
        mozzi::fast::evaluate(&query, &ur5, &inputs, &own, &mut workspace, &mut [&mut tau]);
        assert_eq!(tau, kernels[state * 6..][..6], "bit for bit");
    }
    let (summary, (_, single)) = run(&["--precision", "f32"]);
    assert_eq!((&summary["precision"], summary["states_with_nan"].as_u64()), (&"f32".into(), Some(0)));
    assert!(std::fs::read(&out).expect("a file").len() < bytes.len());
    assert_close(&single, &kernels, 1e-4 * largest(&kernels));
    let (_, (_, floating)) = run(&["--gravity", "0,0,0"]);
    assert!(floating != kernels);
}

#[test]
fn every_kind_of_file_is_read_and_written() {
    let folder = folder("compute_files");
    let model = mozzi_urdf::open("two_link_planar").expect("a robot").build().expect("a model");
    let states = States::new(&model, 5);
    let beside = states.beside(&[0, 1, 2, 3]);
    let mut by_columns = Vec::new();
    (0..12).for_each(|c| by_columns.extend(beside.iter().skip(c).step_by(12)));
    let head = "theta_1,theta_2,dtheta_1,dtheta_2,tau_1,tau_2,m_x,m_y,m_z,f_x,f_y,f_z";
    let lines: Vec<String> =
        beside.chunks(12).map(|row| row.iter().map(f64::to_string).collect::<Vec<_>>().join(",")).collect();
    let columns = head.split(',').enumerate().map(|(c, name)| {
        let values: Vec<f64> = beside.iter().skip(c).step_by(12).copied().collect();
        (name, Arc::new(Float64Array::from(values)) as ArrayRef)
    });
    let arrow = write_arrow(&folder, "states.feather", columns.collect());
    let inputs = [
        save(&folder, "rows.npy", &npy(&[5, 12], &beside, false)),
        save(&folder, "columns.npy", &npy(&[5, 12], &by_columns, true)),
        states.npz(&folder, "states.npz"),
        arrow,
        file(&folder, "states.csv", &format!("{head}\n{}\n", lines.join("\n"))),
    ];
    let mut all = Vec::new();
    for input in &inputs {
        for ending in ["npz", "arrow", "csv"] {
            let out = folder.join(format!("out.{ending}")).to_str().expect("text").to_string();
            let quantity = "forward-dynamics-derivatives";
            let said = mozzi(&["compute", "two_link_planar", quantity, "--in", input, "--out", &out]);
            assert!(said.status.success(), "{input}: {}", String::from_utf8_lossy(&said.stderr));
            all.push(match ending {
                "npz" => {
                    read_npz(&out).into_iter().flat_map(|(_, shape, values)| to_columns(&shape, &values)).collect()
                }
                "arrow" => read_arrow(&out).into_iter().map(|(_, values)| values).collect::<Vec<_>>(),
                _ => {
                    let text = std::fs::read_to_string(&out).expect("a table");
                    let names = "ddtheta_1,ddtheta_2,d_theta_1_1,d_theta_1_2,d_theta_2_1,d_theta_2_2,d_dtheta_1_1";
                    assert!(text.starts_with(names), "{text}");
                    let row = |line: &str| line.split(',').map(|x| x.parse().expect("a number")).collect::<Vec<f64>>();
                    let rows: Vec<Vec<f64>> = text.lines().skip(1).map(row).collect();
                    (0..14).map(|c| rows.iter().map(|row| row[c]).collect()).collect()
                }
            });
        }
    }
    assert!(all[0].len() == 14 && all[0][0].len() == 5);
    assert!(all.iter().all(|one| *one == all[0]), "{all:?}");
    let names: Vec<String> =
        read_arrow(folder.join("out.arrow").to_str().expect("text")).into_iter().map(|(n, _)| n).collect();
    assert_eq!(names[12..], ["d_tau_2_1", "d_tau_2_2"]);
    let text = common::text(&["compute", "two_link_planar", "kinetic-energy", "--in", &inputs[4], "--out", "-"]);
    assert!(text.starts_with("energy\n") && text.lines().count() == 6, "{text}");
}

#[test]
fn a_free_base_has_its_columns_by_name() {
    let folder = folder("compute_floating");
    let robot = mozzi_urdf::open("two_link_planar").expect("a robot").description;
    let model = robot.floating().build().expect("a model");
    let states = States::new(&model, 9);
    let input = save(&folder, "states.npy", &npy(&[9, 25], &states.beside(&[0, 1, 2]), false));
    let out = folder.join("tau.arrow").to_str().expect("text").to_string();
    common::text(&["compute", "two_link_planar", "--floating", "inverse-dynamics", "--in", &input, "--out", &out]);
    let columns = read_arrow(&out);
    assert_eq!((columns.len(), columns[0].0.as_str(), columns[5].0.as_str()), (8, "tau_base.wx", "tau_base.vz"));
    for state in 0..9 {
        let [theta, dtheta, x] = [0, 1, 2].map(|k| states.at(k, state));
        let tau = model.inverse_dynamics(theta, dtheta, x, &model.environment()).expect("τ");
        let found: Vec<f64> = columns.iter().map(|(_, values)| values[state]).collect();
        assert_close(&found, tau.as_slice(), 1e-11);
    }
    let mut zero = states.beside(&[0, 1, 2]);
    zero[25 * 4..][..4].fill(0.0);
    let input = save(&folder, "zero.npy", &npy(&[9, 25], &zero, false));
    let (code, said) =
        complaint(&["compute", "two_link_planar", "--floating", "inverse-dynamics", "--in", &input, "--out", &out]);
    assert!(
        code == 1 && said.contains("zero.npy: state 4 (counted from 0): ") && said.contains("quaternion"),
        "{said}"
    );
}

#[test]
fn a_nan_stays_in_its_state_and_is_told() {
    let folder = folder("compute_nan");
    let model = mozzi_urdf::open("ur5").expect("a robot").build().expect("a model");
    let states = States::new(&model, 10);
    let mut numbers = states.beside(&[0, 1, 2]);
    numbers[18 * 3 + 1] = f64::NAN;
    let input = save(&folder, "states.npy", &npy(&[10, 18], &numbers, false));
    let out = folder.join("tau.npy").to_str().expect("text").to_string();
    let output = mozzi(&["compute", "ur5", "inverse-dynamics", "--in", &input, "--out", &out]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.contains("note: 1 of 10 states gave NaN\n"), "{said}");
    let (_, tau) = parse(&std::fs::read(&out).expect("a file"));
    let with_nan: Vec<usize> = (0..10).filter(|s| tau[s * 6..][..6].iter().any(|x| x.is_nan())).collect();
    assert_eq!(with_nan, [3]);
}

#[test]
fn what_is_wrong_is_named() {
    let folder = folder("compute_wrong");
    let out = folder.join("out.npy").to_str().expect("text").to_string();
    let model = mozzi_urdf::open("ur5").expect("a robot").build().expect("a model");
    let states = States::new(&model, 4);
    let all = states.npz(&folder, "all.npz");
    let flat = save(&folder, "flat.npy", &npy(&[4, 13], &[0.0; 52], false));
    let list = save(&folder, "list.npy", &npy(&[6], &[0.0; 6], false));
    let cut = save(&folder, "cut.npy", &npy(&[4, 18], &[0.0; 71], false));
    let theta = npz(&folder, "theta.npz", &[("theta", &[4, 5], &[0.0; 20])]);
    let odd = npz(&folder, "odd.npz", &[("theta", &[4, 6], &[0.0; 24]), ("thetadot", &[4, 6], &[0.0; 24])]);
    let count = npz(&folder, "count.npz", &[("theta", &[4, 6], &[0.0; 24]), ("dtheta", &[3, 6], &[0.0; 18])]);
    let none = npz(&folder, "none.npz", &[("dtheta", &[4, 6], &[0.0; 24])]);
    let column = |values: Vec<Option<f64>>| Arc::new(Float64Array::from(values)) as ArrayRef;
    let thetas = |first: ArrayRef, name: &'static str| -> Vec<(&'static str, ArrayRef)> {
        let zero = || column(vec![Some(0.0); 2]);
        let others = ["theta_2", "theta_3", "theta_4", "theta_5", "theta_6"].map(|name| (name, zero()));
        [vec![(name, first)], others.to_vec()].concat()
    };
    let null = write_arrow(&folder, "null.arrow", thetas(column(vec![Some(1.0), None]), "theta_1"));
    let text = Arc::new(arrow_array::StringArray::from(vec!["a", "b"])) as ArrayRef;
    let text = write_arrow(&folder, "text.arrow", thetas(text, "theta_1"));
    let name = write_arrow(&folder, "name.arrow", thetas(column(vec![Some(1.0); 2]), "angle"));
    let whole = Arc::new(Int64Array::from(vec![1, 2])) as ArrayRef;
    let whole = write_arrow(&folder, "whole.arrow", thetas(whole, "theta_1"));
    let nothing = file(&folder, "nothing.arrow", "nothing");
    let csv = file(&folder, "states.csv", "theta_1,theta_2,theta_3,theta_4,theta_5,theta_6\n0,0,0,0,0,x\n");
    let said = |quantity: &str, input: &str, more: &[&str]| {
        let (code, said) = complaint(&[&["compute", "ur5", quantity, "--in", input, "--out", &out], more].concat());
        (code, said)
    };
    for (quantity, input, expected) in [
        (
            "inverse-dynamics",
            &flat,
            "flat.npy has shape (4, 13), expected (N, 18): theta 6, dtheta 6, ddtheta 6 of `ur5`; or (N, 24) with the tip's wrench",
        ),
        ("mass-matrix", &list, "list.npy has shape (6,), expected (N, 6): theta 6 of `ur5`"),
        ("tip-forces", &flat, "flat.npy has shape (4, 13), expected (N, 12): theta 6, wrench 6 of `ur5`"),
        (
            "inverse-dynamics",
            &cut,
            "cut.npy cannot be read as .npy: there are 568 bytes of numbers, expected those of shape (4, 18)",
        ),
        ("mass-matrix", &theta, "theta.npz: `theta` has shape (4, 5), expected (N, 6) of `ur5`"),
        (
            "mass-matrix",
            &odd,
            "odd.npz has an array `thetadot`, expected only theta, dtheta, ddtheta, tau, x, w, t, wrench, gravity, parameters, or wrench_FRAME of a frame",
        ),
        ("mass-matrix", &count, "count.npz: `dtheta` has shape (3, 6), expected (4, 6): as many states as `theta`"),
        ("mass-matrix", &none, "none.npz has no array `theta`, which mass-matrix needs"),
        ("tip-forces", &whole, "whole.arrow has no columns m_x m_y m_z f_x f_y f_z, which tip-forces needs"),
        ("forward-dynamics", &whole, "whole.arrow has no columns tau_1 …, which forward-dynamics needs"),
        ("mass-matrix", &null, "null.arrow: column `theta_1`, row 1 (counted from 0) is null, expected a number"),
        (
            "mass-matrix",
            &text,
            "text.arrow: column `theta_1` has type Utf8, expected Float64, Float32, integers or timestamps",
        ),
        (
            "mass-matrix",
            &name,
            "name.arrow: column theta_1 is missing, the position of shoulder_pan_joint; the file has 5 of the 6 columns of positions, and `angle` is not recognised",
        ),
        ("mass-matrix", &nothing, "nothing.arrow cannot be read: "),
        ("mass-matrix", &csv, "states.csv:2: column 6 (`theta_6`) is `x`, expected a number"),
        ("mass-matrix", &"states.txt".to_string(), "states.txt cannot be read: "),
        ("mass-matrix", &"nowhere.npy".to_string(), "nowhere.npy cannot be read: "),
        (
            "inverse-dynamics-derivatives",
            &all,
            "holds one array, and inverse-dynamics-derivatives gives 3: d_theta, d_dtheta, d_ddtheta; expected a name that ends in .npz",
        ),
    ] {
        let (code, said) = said(quantity, input, &[]);
        assert!(code == 1 && said.contains(expected), "{said}");
    }
    let (code, text) = said("mass-matrix", &all, &["--threads", "0"]);
    assert!(code == 1 && text.contains("0 threads could not be started: expected at least one"), "{text}");
    let (code, text) = complaint(&["compute", "ur5", "mass-matrix", "--in", &all, "--out", "-", "--json"]);
    assert!(code == 1 && text.contains("--json and --out - both write to standard output"), "{text}");
    let (code, text) = complaint(&["compute", "anymal", "body-jacobian", "--in", &all, "--out", &out]);
    assert!(code == 1 && text.contains("end effector"), "{text}");
    let output = mozzi(&["compute", "ur5", "mass-matrix", "--in", &whole, "--out", &out]);
    assert!(output.status.success(), "whole numbers are numbers");
}

#[test]
fn bench_tells_this_machines_times() {
    let only = ["--quantity", "inverse-dynamics", "--quantity", "body-jacobian", "--quantity", "tip-forces"];
    let small =
        [&["bench", "two_link_planar", "--states", "70", "--rounds", "3", "--threads", "2"], &only[..]].concat();
    let table: Value = json(&small);
    let timings = table["timings"].as_array().expect("a list");
    // one state; all in a call in f64 and f32, on one thread and on two
    assert_eq!(timings.len(), 3 * (1 + 4));
    for timing in timings {
        let number = |key: &str| timing[key].as_f64().expect("a number");
        assert!(0.0 < number("ns_least") && number("ns_least") <= number("ns_median"), "{timing}");
        let most = if timing["precision"] == "f64" { 1e-12 } else { 1e-3 };
        assert!(number("difference") <= most, "{timing}");
    }
    assert!(!table["processor"].as_str().expect("a name").is_empty());
    let page = common::text(&[&small[..], &["--all"]].concat());
    for word in
        ["one state", "arrays f64", "arrays f32", "kernels: ", "body-jacobian", "on 2 threads", "70 states per batch"]
    {
        assert!(page.contains(word), "{word} in {page}");
    }
}

/// Links without mass.
const KINEMATIC: &str = r#"<robot name="kin"><link name="b"/><link name="l1"/><link name="l2"/>
<joint name="j1" type="continuous"><parent link="b"/><child link="l1"/><axis xyz="0 0 1"/></joint>
<joint name="j2" type="continuous"><parent link="l1"/><child link="l2"/><origin xyz="1 0 0"/><axis xyz="0 1 0"/></joint></robot>"#;

#[test]
fn bench_takes_what_a_robot_has_once() {
    let size = ["--rounds", "1", "--states", "10", "--threads", "1"];
    // six numbers beside those of two joints
    for name in ["frame-twist-vjp", "frame-acceleration-vjp", "momentum-vjp", "momentum-rate-vjp", "M,M"] {
        let found: Value = json(&[&["bench", "double_pendulum", "--quantity", name], &size[..]].concat());
        assert_eq!(found["timings"].as_array().map(Vec::len), Some(3), "{name}");
    }
    let robot = file(&folder("kinematic"), "kin.urdf", KINEMATIC);
    for arguments in [[&["bench", &robot], &size[..]].concat(), vec!["codegen", &robot, "--explain"]] {
        let run = mozzi(&arguments);
        let (page, notes) = (String::from_utf8_lossy(&run.stdout), String::from_utf8_lossy(&run.stderr));
        assert!(run.status.success() && page.contains("body-jacobian"), "{page} {notes}");
        assert!(!page.contains("\nforward-dynamics ") && notes.contains("no forward-dynamics"), "{page} {notes}");
    }
    let folder = folder("kinematic_code");
    let (code, why) = complaint(&["codegen", &robot, "aba", "--lang", "c", "--out", &folder.to_string_lossy()]);
    assert!(code == 1 && why.contains("singular in all states"), "{why}");
}
