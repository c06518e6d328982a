//! The playground in a real browser: what a visitor does, and its numbers against the library's.

#[allow(dead_code)] // other tests look at reports
use crate::browser;
use crate::common;

use browser::{browser, run, url};
use common::{folder, json, numbers, text};
use mozzi::quantities::{LIST, Query};
use mozzi::testing::state;
use mozzi::{Description, Model};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// The page computes with the library: the same operations in the same order.
const TOLERANCE: f64 = 1e-12;

const SNAKE: &str = include_str!("../../mozzi-report/robots/snake.urdf.xacro");
const CART: &str = include_str!("../../mozzi-report/robots/spherical_pendulum.xml");
const UR5: &str = include_str!("../../mozzi-urdf/models/ur5.urdf");

/// As many rods as the argument says.
const ROW: &str = r#"<robot name="row" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="joints" default="1"/><xacro:include filename="rod.xacro"/>
  <link name="l0"/><xacro:macro name="row" params="k"><xacro:if value="${k &lt;= int('$(arg joints)')}">
  <xacro:rod k="${k}"/><xacro:row k="${k+1}"/></xacro:if></xacro:macro><xacro:row k="1"/></robot>"#;
const ROD: &str = r#"<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="rod" params="k">
  <link name="l${k}"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="j${k}" type="continuous"><parent link="l${k-1}"/><child link="l${k}"/><axis xyz="0 1 0"/></joint>
  </xacro:macro></robot>"#;

fn given(name: &str, [theta, dtheta, ddtheta]: &[Vec<f64>; 3]) -> Vec<f64> {
    match name {
        "theta" => theta.clone(),
        "dtheta" | "x" => dtheta.clone(),
        "w" => vec![0.3, -0.2, 0.5, 1.0, -0.4, 0.7],
        _ => ddtheta.clone(),
    }
}

fn assert_same(what: &str, found: &[f64], expected: &[f64]) {
    let size = expected.iter().fold(f64::MIN_POSITIVE, |most: f64, x| most.max(x.abs()));
    let apart = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert_eq!(found.len(), expected.len(), "{what}");
    assert!(apart <= TOLERANCE * size, "{what}: differs by {apart:e} of {size:e}: is the page's WebAssembly outdated?");
}

/// The numbers of nested lists.
fn flat(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(list) => list.iter().flat_map(flat).collect(),
        one => vec![one.as_f64().unwrap_or_else(|| panic!("no number: {one}"))],
    }
}

/// The page of a robot.
fn page(folder: &Path, name: &str, arguments: &[&str]) -> PathBuf {
    let file = folder.join(format!("{name}.html"));
    let said = text(&[&["play"], arguments, &["--out", file.to_str().expect("text")]].concat());
    assert!(said.starts_with("page: ") && said.contains("written to"), "{said}");
    file
}

fn job(what: &str, page: &Path, more: Value) -> Value {
    let mut job = json!({ "do": what, "url": url(page), "width": 1200, "height": 760 });
    more.as_object().into_iter().flatten().for_each(|(key, value)| job[key] = value.clone());
    job
}

fn assert_quiet(found: &[Value], jobs: &[Value]) {
    for (found, job) in found.iter().zip(jobs) {
        assert_eq!(found["errors"], json!([]), "{}: no error on the console", job["do"]);
        assert_eq!(found["requests"].as_array().map(Vec::len), Some(1), "{}: {}", job["do"], found["requests"]);
        assert!(
            found["wide"].as_f64() <= job["width"].as_f64(),
            "{}: wider than the screen: {}",
            job["do"],
            found["wide"]
        );
    }
}

/// All quantities of a robot at a state: the job, the model, the state and a frame.
fn case(page: &Path, model: Model) -> (Value, Model, [Vec<f64>; 3], String) {
    let state = state(&model, 11);
    let frame = model.frames().last().map(|(_, name)| name.to_string()).expect("a frame");
    let request = |quantity: &mozzi::quantities::Declaration| {
        let frame = quantity.needs_frame().then(|| frame.clone());
        let inputs = quantity.inputs.iter().map(|input| (input.name.to_string(), json!(given(input.name, &state))));
        json!({ "request": { "quantity": quantity.name, "frame": frame }, "inputs": inputs.collect::<serde_json::Map<_, _>>() })
    };
    let requests: Value = LIST.iter().map(request).collect();
    (job("numbers", page, json!({ "requests": requests })), model, state, frame)
}

#[test]
fn every_number_of_the_playground_is_the_librarys() {
    let program = match browser() {
        Ok(program) => program,
        Err(why) => return println!("skipped: {why}; cargo xtask test sets it where a Chromium is installed"),
    };
    let folder = folder("play_numbers");
    let load = |name: &str| mozzi_urdf::open(name).expect("a robot").description;
    let built = |description: Description| description.build().expect("sound");
    let delta = common::file(&folder, "delta.json", include_str!("../../mozzi-report/robots/delta.json"));
    let closed =
        mozzi_urdf::json::File::parse(&delta, include_str!("../../mozzi-report/robots/delta.json")).expect("JSON");
    let closed = mozzi_urdf::json::read(&closed).expect("sound");
    let mut cases = vec![
        case(&page(&folder, "panda", &[]), built(load("panda"))),
        case(&page(&folder, "anymal", &["anymal", "--floating"]), built(load("anymal").floating())),
        case(&page(&folder, "delta", &[&delta]), built(closed)),
    ];
    let humanoid = std::env::var_os("MOZZI_ROBOTS")
        .map(|robots| PathBuf::from(robots).join("talos_data/robots/talos_reduced.urdf"));
    match humanoid.filter(|file| file.is_file()) {
        Some(file) => {
            let file = file.to_string_lossy().into_owned();
            let page = page(&folder, "talos", &[&file, "--floating", "--meshes", "none"]);
            cases.push(case(&page, built(load(&file).floating())));
        }
        None => println!("skipped: a humanoid; MOZZI_ROBOTS names no folder with talos_data"),
    }
    let jobs: Vec<Value> = cases.iter().map(|(job, ..)| job.clone()).collect();
    let found = run("play.py", &program, &Value::Array(jobs.clone()));
    assert_quiet(&found, &jobs);
    for ((_, model, state, frame), found) in cases.iter().zip(&found) {
        let name = &model.description().name;
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

#[test]
fn a_visitor_drops_plays_drags_edits_and_shares() {
    let program = match browser() {
        Ok(program) => program,
        Err(why) => return println!("skipped: {why}; cargo xtask test sets it where a Chromium is installed"),
    };
    let folder = folder("play_visit");
    let panda = page(&folder, "panda", &[]);
    let ur5 = page(&folder, "ur5", &["ur5"]);
    let anymal = page(&folder, "anymal", &["anymal"]);
    let wrong = UR5.replace("mass value=\"8.393\"", "mass value=\"8,393\"");
    let parts = json!({ "snake.urdf.xacro": SNAKE, "readme.txt": "not a robot" });
    let posed = [0.3, -1.1, 1.2, 0.4, 0.7, -0.2];
    let mass = json!({ "what": "link", "name": "forearm_link", "entry": "mass", "value": 5.5, "scale": true });
    let jobs = vec![
        job("drop_and_play", &panda, json!({ "texts": parts, "name": "snake" })),
        job(
            "drop_and_play",
            &panda,
            json!({ "texts": { "spherical_pendulum.xml": CART }, "name": "spherical_pendulum" }),
        ),
        job("argument", &panda, json!({ "texts": { "row.xacro": ROW, "rod.xacro": ROD }, "name": "row" })),
        job("wrong_file", &panda, json!({ "texts": { "ur5.urdf": wrong } })),
        job("drag", &ur5, json!({ "body": 3 })),
        job("share", &ur5, json!({ "theta": posed, "edit": mass })),
        job("edit", &ur5, json!({})),
        job("panels", &ur5, json!({ "quantity": "body_jacobian", "theta": posed })),
        job("keyboard", &ur5, json!({ "width": 390, "height": 844 })),
        job("stand", &anymal, json!({ "legs": legs(), "width": 900, "height": 600 })),
        job("robots", &panda, json!({ "width": 700, "height": 500 })),
    ];
    let found = run("play.py", &program, &Value::Array(jobs.clone()));
    assert_quiet(&found, &jobs);
    let [dropped, mjcf, argument, wrong, drag, share, edit, panels, keyboard, stand, robots] = &found[..] else {
        panic!("as many as jobs")
    };

    for (found, name) in [(dropped, "snake"), (mjcf, "spherical_pendulum")] {
        assert_eq!(found["after"]["name"], name);
        assert!(found["after"]["time"].as_f64() > Some(0.2), "{}", found["after"]);
    }
    assert_eq!(dropped["menu"][0], "snake.urdf.xacro");
    assert_ne!(mjcf["before"]["theta"], mjcf["after"]["theta"], "two actions, and it moves");

    let said = wrong["said"].as_str().expect("text");
    assert!(said.contains("ur5.urdf:") && said.contains("8,393") && said.contains('━'), "{said}");
    assert!(wrong["before"] == wrong["after"] && wrong["hidden"] == true, "the last robot stays");

    let theta = |k: usize| numbers(&drag["states"][k]["theta"]);
    let moved = |a: usize, b: usize| theta(a).iter().zip(theta(b)).filter(|(a, b)| (*a - b).abs() > 1e-4).count();
    assert_eq!(moved(0, 1), 1, "one joint is dragged: {}", drag["states"]);
    assert!(moved(1, 2) > 1, "the end effector moves several joints: {}", drag["states"]);
    assert_eq!(theta(3), theta(1), "undo takes the second drag back");
    assert!(drag["pushed"]["shown"] == true, "{}", drag["pushed"]);
    assert!(numbers(&drag["pushed"]["push"]["f"]).iter().any(|x| x.abs() > 1.0), "{}", drag["pushed"]);

    assert_eq!(numbers(&share["after"]["theta"]), posed);
    assert_eq!(share["M"][0], share["M"][1], "edits are in the link");
    assert!(share["link"].as_u64() < Some(8000), "{}", share["link"]);

    assert!(edit["M"][0] != edit["M"][1] && edit["M"][0] == edit["M"][2] && edit["M"][1] == edit["M"][3]);
    let csv = edit["Motion as CSV"].as_str().expect("text");
    assert!(csv.starts_with("t,theta_1,") && csv.lines().count() >= 2, "{csv}");
    let urdf = edit["Robot as URDF"].as_str().expect("text");
    let read = mozzi_urdf::parse("ur5.urdf", urdf).expect("URDF").description;
    let link = read.links.iter().find(|link| edit["link"] == link.name.as_str()).expect("the edited link");
    assert!((link.inertia.mass - 7.5).abs() < 1e-12, "{}", link.inertia.mass);
    assert!(edit["Robot as JSON"].as_str().expect("text").contains("\"robot\": \"ur5"), "JSON");

    assert_eq!((&argument["n"], &argument["value"], &argument["after"]), (&json!([1]), &json!("1"), &json!(3)));
    let said = argument["said"].as_str().expect("text");
    assert!(said.contains("many") && said.contains("row.xacro:"), "{said}");

    assert_eq!(panels["empty"], json!([]), "every quantity is shown or says why not");
    let entry = panels["entry"].as_str().expect("text");
    assert!(entry.starts_with("M (shoulder_pan_joint, shoulder_lift_joint) = "), "{entry}");
    assert_eq!(panels["axes"], 2, "both joints are shown in the scene");
    let shown: f64 = entry
        .split(" = ")
        .nth(1)
        .and_then(|rest| rest.split(',').next())
        .and_then(|x| x.parse().ok())
        .expect("a number");
    assert_eq!(shown, panels["value"].as_f64().expect("a number"));
    // the programs of the book, which its own test runs
    let book = include_str!("../../../book/src/use/play.md");
    for (language, block) in [("python", "python"), ("rust", "rust"), ("cpp", "cpp"), ("shell", "sh")] {
        let program = panels["code"][language].as_str().expect("text");
        let block = format!("```{block}\n{program}\n```");
        assert!(book.contains(&block), "book/src/use/play.md has not the page's lines:\n{block}");
    }
    let lines = panels["lines"].as_array().expect("a list");
    assert!(lines.len() >= 50, "{}", lines.len());
    let mut agree = 0;
    for line in lines {
        let (name, words) = (&line["name"], line["line"].as_str().expect("text").replace("\\\n", " "));
        let words: Vec<&str> = words.split_whitespace().skip(1).collect();
        let answer = common::mozzi(&[&words[..], &["--json"]].concat());
        let said = String::from_utf8(answer.stderr).expect("text");
        match (answer.status.success(), line["shown"]["error"].as_str()) {
            (true, None) => {
                let computed: Value = serde_json::from_slice(&answer.stdout).expect("JSON");
                for (output, shown) in line["shown"].as_object().expect("outputs") {
                    assert_same(&format!("{words:?}: {output}"), &flat(&computed[output]), &flat(shown));
                }
                agree += 1;
            }
            // the command line does not compute with a robot's constraints where it has none
            (false, None) => assert!(said.contains("ur5 has no constraints"), "{words:?}: {said}"),
            (succeeded, Some(error)) => assert!(!succeeded && said.contains(error), "{name}: {said}, not {error}"),
        }
    }
    assert!(agree >= 45, "{agree} lines");

    assert_eq!(keyboard["nameless"], json!([]), "every control has a name");
    let seen = keyboard["seen"].to_string();
    for name in ["robot", "open", "folder", "share", "play", "motors", "ground", "tab-joints", "skeleton"] {
        assert!(seen.contains(&format!("\"{name}\"")), "Tab does not reach {name}: {seen}");
    }
    assert_eq!(keyboard["tab"], "tab-numbers");
    let [above, below] = numbers(&keyboard["tabs"])[..] else { panic!("two edges") };
    assert!((above - below).abs() < 1.5, "on a phone the tabs stay below the controls: {above}, not {below}");
    let theta = |k: usize| numbers(&keyboard["states"][k]["theta"]);
    assert!(theta(0) != theta(1) && theta(1) != theta(2), "arrows and buttons move the robot");
    assert_ne!(keyboard["themes"][0], keyboard["themes"][1]);
    for least in keyboard["contrast"].as_array().expect("two themes") {
        assert!(least[0].as_f64() >= Some(4.5), "contrast {least}");
    }

    let height = numbers(&stand["height"]);
    assert!(height[1] > 0.8 * height[0], "it stands: {height:?}");
    assert!(stand["touches"].as_u64() >= Some(3), "{}", stand["touches"]);
    let pinned = numbers(&stand["pinned"]);
    assert!((pinned[0] - height[0]).abs() < 0.02 && pinned[1] < 0.1, "{pinned:?} {height:?}");

    let robots = robots["robots"].as_array().expect("robots");
    assert_eq!(robots.len(), 10);
    for robot in robots {
        assert!(robot["trouble"] == false && robot["time"].as_f64() > Some(0.1), "{robot}");
        assert!(robot["residual"].as_f64().is_some_and(|x| x < 1e-9), "{robot}");
        // an impact against a stop is located to a step
        assert!(robot["drift"].as_f64().is_some_and(|x| x.abs() < 2e-2), "{robot}");
    }
}

/// URDF has neither gravity nor closed loops, and a menu's robot is no file that its reader has.
#[test]
fn programs_compute_what_the_page_shows() {
    let program = match browser() {
        Ok(program) => program,
        Err(why) => return println!("skipped: {why}; cargo xtask test sets it where a Chromium is installed"),
    };
    let folder = folder("play_programs");
    let moon = page(&folder, "moon", &["ur5", "--gravity", "moon"]);
    let ur5 = page(&folder, "ur5", &["ur5"]);
    let edit = json!({ "what": "gravity", "gravity": [0.0, 0.0, -1.62] });
    let jobs = vec![
        job("programs", &moon, json!({ "quantity": "gravity_forces" })),
        job("programs", &ur5, json!({ "quantity": "gravity_forces", "edit": edit })),
        job("programs", &ur5, json!({ "quantity": "constrained_forward_dynamics", "robot": "four-bar linkage" })),
        job("fields", &ur5, json!({})),
    ];
    let found = run("play.py", &program, &Value::Array(jobs.clone()));
    assert_quiet(&found, &jobs);
    for (found, name) in found.iter().zip(["ur5.json", "ur5.json", "four-bar.json"]) {
        assert_eq!(found["saved"]["name"], name);
        let python = found["code"]["python"].as_str().expect("text");
        assert!(python.contains(&format!("mozzi.Model.load(\"{name}\")")), "{python}");
        let file = common::file(&folder, name, found["saved"]["text"].as_str().expect("text"));
        let shell = found["code"]["shell"].as_str().expect("text");
        let (comment, line) = shell.split_once('\n').expect("two lines");
        assert!(comment.starts_with(&format!("# save {name} first")), "{shell}");
        let line = line.replace("\\\n", " ").replace(name, &file);
        let words: Vec<&str> = line.split_whitespace().skip(1).collect();
        let computed = json(&words);
        for (output, shown) in found["shown"].as_object().expect("outputs") {
            assert_same(&format!("{words:?}: {output}"), &flat(&computed[output]), &flat(shown));
        }
    }
    assert_eq!(found[2]["carried"], json!([true]), "the pin's force has an arrow");
    let fields = &found[3];
    assert_eq!(fields["typed"], json!(["-1.25", -1.25]));
    assert_eq!(fields["emptied"], json!(["-1.25", -1.25]), "a field shows the value in effect");
    assert_eq!(fields["refused"][0], fields["refused"][1], "a mass below 0 goes");
}

/// ANYmal's legs with bent knees, in the order of its joints.
fn legs() -> Vec<f64> {
    let model = mozzi_urdf::open("anymal").expect("embedded").build().expect("sound");
    let bend = |name: &str| match (&name[..2], &name[3..]) {
        (leg, "HFE") => {
            if leg.ends_with('F') {
                0.4
            } else {
                -0.4
            }
        }
        (leg, "KFE") => {
            if leg.ends_with('F') {
                -0.8
            } else {
                0.8
            }
        }
        _ => 0.0,
    };
    model.joint_names().map(bend).collect()
}

#[test]
fn a_playground_is_a_file_or_served() {
    let folder = folder("play_file");
    let own = folder.join("own.urdf");
    std::fs::write(&own, UR5).expect("written");
    let own = own.to_str().expect("text").to_string();
    let page = std::fs::read_to_string(page(&folder, "own", &[&own])).expect("a page");
    assert!(
        page.starts_with("<!doctype html>") && page.contains("\"name\":\"own.urdf\"") && page.contains("\"first\":0")
    );
    assert!(page.contains("\"isAsFile\":true"), "programs open the file itself");
    let said = json(&["play", "ur5", "--out", folder.join("ur5.html").to_str().expect("text")]);
    assert_eq!(said["robot"], "ur5");
    let (code, said) = common::complaint(&["play", "nowhere.urdf", "--out", "never.html"]);
    assert!(code == 1 && said.contains("neither a file nor one of the embedded robots"), "{said}");
}
