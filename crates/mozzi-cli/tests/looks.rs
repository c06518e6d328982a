//! The pages as a reader sees them: what is shown at first, controls, plots, in light and dark, on a phone.

use crate::browser::{browser, run, url};
use crate::common::{self, folder, numbers, text};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

const TRIANGLE: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0.1 0 0\nvertex 0 0.1 0\n\
                        endloop\nendfacet\nendsolid a\n";

/// The page of a command.
fn page(folder: &Path, name: &str, arguments: &[&str]) -> PathBuf {
    let file = folder.join(format!("{name}.html"));
    text(&[arguments, &["--out", file.to_str().expect("text")]].concat());
    file
}

fn job(what: &str, page: &Path, width: u64, more: Value) -> Value {
    let height = if width < 500 { 844 } else { 760 };
    let mut job = json!({ "do": what, "url": url(page), "width": width, "height": height, "looks": true });
    more.as_object().into_iter().flatten().for_each(|(key, value)| job[key] = value.clone());
    job
}

/// The browser; none, which is said, where there is none.
fn program() -> Option<(PathBuf, PathBuf)> {
    let found = browser();
    if let Err(why) = &found {
        println!("skipped: {why}; cargo xtask test sets it where a Chromium is installed");
    }
    found.ok()
}

/// What a script finds: no message on the console, nothing fetched, no wider than the screen, and text that is read in
/// light and dark.
fn look(program: &(PathBuf, PathBuf), jobs: Vec<Value>) -> Vec<Value> {
    let found = run("looks.py", program, &Value::Array(jobs.clone()));
    for (found, job) in found.iter().zip(&jobs) {
        let what = format!("{} at {}", job["do"], job["width"]);
        assert_eq!(found["errors"], json!([]), "{what}: no message on the console");
        assert_eq!(found["requests"].as_array().map(Vec::len), Some(1), "{what}: {}", found["requests"]);
        assert!(found["wide"].as_f64() <= job["width"].as_f64(), "{what}: wider than the screen: {}", found["wide"]);
        for least in found["contrast"].as_array().into_iter().flatten() {
            assert!(least[0].as_f64() >= Some(4.5), "{what}: contrast {least}");
        }
    }
    found
}

fn words(value: &Value) -> Vec<&str> {
    value.as_array().expect("a list").iter().map(|word| word.as_str().expect("text")).collect()
}

/// An arm of seven meshes and one tiny cube.
fn meshes() -> String {
    let mut robot = String::from(
        "<robot name=\"arm\">\n<link name=\"l0\"><visual><geometry><box size=\"0.01 0.01 0.01\"/></geometry></visual></link>\n",
    );
    for k in 1..8 {
        let _ = write!(
            robot,
            "<link name=\"l{k}\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" \
             iyz=\"0\"/></inertial><visual><geometry><mesh filename=\"package://arm/meshes/m{k}.stl\"/></geometry></visual>\
             </link>\n<joint name=\"j{k}\" type=\"continuous\"><parent link=\"l{}\"/><child link=\"l{k}\"/>\
             <origin xyz=\"0 0 0.2\"/><axis xyz=\"{} {} 0\"/></joint>\n",
            k - 1,
            k % 2,
            1 - k % 2
        );
    }
    robot + "</robot>\n"
}

#[test]
fn the_first_look_explains_itself() {
    let Some(program) = program() else { return };
    let folder = folder("looks_first");
    let play = page(&folder, "play", &["play"]);
    let lies = folder.join("arm/meshes");
    std::fs::create_dir_all(&lies).expect("a folder");
    (1..8).for_each(|k| std::fs::write(lies.join(format!("m{k}.stl")), TRIANGLE).expect("written"));
    let robot = folder.join("arm/arm.urdf");
    std::fs::write(&robot, meshes()).expect("written");
    let view = page(&folder, "view", &["view", robot.to_str().expect("text")]);
    let scene =
        common::file(&folder, "scene.xml", "<mujoco><worldbody><include file=\"part.xml\"/></worldbody></mujoco>");
    std::fs::write(
        folder.join("part.xml"),
        "<mujocoinclude><body name=\"arm\"><joint name=\"hinge\" axis=\"0 1 0\"/>\
         <geom type=\"capsule\" fromto=\"0 0 0 0.3 0 0\" size=\"0.02\" mass=\"1\"/></body></mujocoinclude>",
    )
    .expect("written");
    let kept = page(&folder, "kept", &["play", &scene]);

    let lost = json!({ "texts": { "arm.urdf": meshes() }, "folder": folder.join("arm") });
    let found = look(
        &program,
        vec![
            job("first", &play, 1280, json!({})),
            job("first", &play, 390, json!({})),
            job("missing", &play, 1280, lost.clone()),
            job("kept", &kept, 1280, json!({})),
            job("loads", &view, 1280, json!({})),
            job("loads", &view, 390, json!({})),
        ],
    );
    let [robots, phone, missing, kept, view, _] = &found[..] else { panic!("as many as jobs") };

    for robots in [robots, phone] {
        for robot in robots["robots"].as_array().expect("robots") {
            let (lit, name) = (words(&robot["lit"]), robot["name"].as_str().expect("text"));
            assert!(!lit.contains(&"masses"), "{robot}");
            // only the two loops are JSON, which has no shapes
            let is_bare = ["four-bar", "delta"].contains(&name);
            assert_eq!(lit.contains(&"skeleton"), is_bare, "{robot}");
            assert_eq!(robot["shapes"].as_u64() > Some(0), !is_bare, "{robot}");
        }
    }
    let ur5 = &robots["robots"].as_array().expect("robots").iter().find(|robot| robot["name"] == "ur5").expect("a UR5");
    assert!(ur5["shapes"].as_u64() > Some(20), "{ur5}");
    assert_eq!(ur5["about"], "6 joints, 21.0 kg");

    let without = &missing["without"];
    assert!(without["bones"].as_u64() > Some(10) && without["shapes"] == 1, "{without}");
    assert_eq!(without["hint"], "7 meshes were not found");
    assert!(missing["offered"] == true && missing["after"] == false);
    assert_eq!(missing["tag"], "j2, l2", "the joint under the pointer");
    assert_eq!(missing["axes"], 1);
    let with = &missing["with"];
    assert!(with["shapes"] == 8 && with["bones"] == 0 && with["hint"] == "", "{with}");

    assert!(kept["name"] == "scene" || kept["shapes"] == 1, "{kept}");
    assert_eq!(kept["shapes"], 1, "shapes of an included file");
    assert!(view["first"].as_f64().is_some_and(|time| time > 0.0), "{view}");
    assert!(words(&view["hints"]).iter().any(|hint| hint.contains("of 7 meshes")), "{view}");
}

#[test]
fn forces_are_drawn_as_in_textbooks() {
    let Some(program) = program() else { return };
    let folder = folder("looks_forces");
    let (anymal, planar) =
        (page(&folder, "anymal", &["play", "anymal"]), page(&folder, "planar", &["play", "two_link_planar"]));
    // it cannot move along y, where no torque is needed to hold any force
    let stretched = json!({ "theta": [0.3, 0.0] });
    let found = look(
        &program,
        vec![
            job("forces", &anymal, 1280, json!({})),
            job("forces", &anymal, 390, json!({})),
            job("ellipsoids", &planar, 1280, stretched.clone()),
            job("ellipsoids", &planar, 390, stretched),
        ],
    );
    for found in &found[..2] {
        for one in ["contacts", "applied"] {
            assert!(!words(&found["before"]["buttons"]).contains(&one), "nothing to touch: {}", found["before"]);
            assert!(words(&found["after"]["buttons"]).contains(&one), "{}", found["after"]);
        }
        assert!(words(&found["after"]["lit"]).contains(&"contacts"), "{}", found["after"]);
        let (up, down, applied) = (numbers(&found["up"]), numbers(&found["down"]), numbers(&found["applied"]));
        assert!(up.len() > 2 && up.len() == down.len() && applied.len() == up.len(), "{up:?} {down:?} {applied:?}");
        for (k, (up, down)) in up.iter().zip(&down).enumerate() {
            assert!(*up > 0.5 && *down < -0.5 && applied[k] < 0.0, "the ground pushes up: {found}");
        }
        // "5 N = 0.21 m" says the scale of the arrows
        let said = found["scales"].as_str().expect("text");
        let (force, length) =
            said.split_once("contacts: ").and_then(|(_, rest)| rest.split_once(" N = ")).expect("a scale");
        let number = |text: &str| text.split_whitespace().next().and_then(|x| x.parse::<f64>().ok()).expect("a number");
        let metres = found["metres"].as_f64().expect("a number");
        assert!((number(length) / number(force) / metres - 1.0).abs() < 0.06, "{said}, {metres} m");
        assert_eq!(words(&found["groups"]), ["robot", "motion", "forces"]);
        assert_eq!(numbers(&found["pixels"]), [0.0, 255.0], "sky above, an opaque floor below");
    }
    for found in &found[2..] {
        let (reach, axes) = (found["reach"].as_f64().expect("a number"), numbers(&found["axes"]));
        assert!(axes.iter().all(|axis| *axis <= 0.6 * reach + 1e-9), "{found}");
        assert!(axes.iter().any(|axis| (axis / reach - 0.6).abs() < 1e-9), "one is cut: {found}");
        let said = found["scales"].as_str().expect("text");
        for line in ["twists: ", "velocity ellipsoid: ", "force ellipsoid: "] {
            assert!(said.contains(line), "{said}");
        }
        assert!(said.contains("cut at"), "{said}");
        // 1 m/s as long as the drawn axis for each unit of its singular value
        let sigma = numbers(&found["sigma"]).into_iter().fold(0.0, f64::max);
        let drawn = axes[..3].iter().copied().fold(0.0, f64::max) / sigma;
        let said =
            said.split_once("velocity ellipsoid: ").and_then(|(_, rest)| rest.split_once(" m/s = ")).expect("a scale");
        let number = |text: &str| text.split_whitespace().next().and_then(|x| x.parse::<f64>().ok()).expect("a number");
        assert!((number(said.1) / number(said.0) / drawn - 1.0).abs() < 0.06, "{said:?} {drawn}");
        assert!(!words(&found["buttons"]).contains(&"contacts"), "an arm that is bolted down touches nothing");
    }
}

#[test]
fn controls_say_what_they_do() {
    let Some(program) = program() else { return };
    let folder = folder("looks_controls");
    let (ur5, snake) = (page(&folder, "ur5", &["play", "ur5"]), page(&folder, "panda", &["play", "panda"]));
    let found = look(
        &program,
        vec![
            job("controls", &ur5, 1280, json!({})),
            job("controls", &ur5, 390, json!({})),
            job("controls", &snake, 1280, json!({})),
        ],
    );
    for (k, found) in found.iter().enumerate() {
        assert_eq!(
            words(&found["stiffness"]),
            ["", "", "stiffness ω 8 rad/s", "stiffness ω 8.5 rad/s"],
            "only where it acts"
        );
        assert!(found["nudges"].as_str().is_some_and(|said| said.starts_with("tool, 1 cm")), "{}", found["nudges"]);
        let torques = words(&found["torque"]);
        for name in ["inverse_dynamics", "gravity_forces", "bias_forces", "tip_forces"] {
            assert!(torques.contains(&name), "{torques:?}");
        }
        assert!(!torques.contains(&"center_of_mass") && found["torque said"] == "", "{found}");
        assert_eq!(found["zebra"], json!([]));
        assert!(found["zebra said"].as_str().is_some_and(|said| said.contains("“zebra”")), "{found}");
        let help = numbers(&found["help"]);
        assert!(help[0] == 0.0 && help[1] < 120.0, "the help opens at its beginning: {help:?}");
        let units = &found["units"];
        let is_arm = k < 2;
        assert_eq!(units["mass_matrix"], json!([if is_arm { "M, kg m²" } else { "M, kg m², kg m or kg" }]));
        assert_eq!(units["gravity_forces"], json!([if is_arm { "g, N m" } else { "g, N m or N" }]));
        assert_eq!(units["body_jacobian"], json!([if is_arm { "J, 1 for ω, m for v" } else { "J, 1 or m" }]));
        assert_eq!(units["momentum"], json!(["h, kg m²/s, kg m/s"]));
        assert_eq!(words(&found["rows"]), ["ω_x", "ω_y", "ω_z", "v_x", "v_y", "v_z"]);
    }
    let [wide, phone, _] = &found[..] else { panic!("as many as jobs") };
    assert_eq!(wide["about"], "6 joints, 21.0 kg");
    let row = numbers(&wide["row"]);
    let (low, high) = row.iter().fold((f64::MAX, f64::MIN), |(low, high), y| (low.min(*y), high.max(*y)));
    assert!(row.len() >= 9 && high - low < 8.0, "one row: {row:?}");
    assert_eq!(wide["sheet"], json!([true, true, true]));
    assert_eq!(phone["sheet"], json!([false, true, false]), "on a phone they are a sheet");
    let stage = numbers(&phone["stage"]);
    assert!(stage[0] == 0.0 && stage[1] > 300.0, "the scene stays: {stage:?}");
}

/// How different two colours look, roughly: red, green and blue weighed as the eye does; of a reader without one kind
/// of cones, red and green as one.
fn apart(a: &str, b: &str) -> f64 {
    let part = |text: &str, k: usize| f64::from(u8::from_str_radix(&text[1 + 2 * k..3 + 2 * k], 16).expect("a colour"));
    let weights = [2.0, 4.0, 3.0];
    (0..3).map(|k| weights[k] * (part(a, k) - part(b, k)).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn plots_have_numbers_and_cut_what_hides_the_rest() {
    let Some(program) = program() else { return };
    let folder = folder("looks_plots");
    // twelve joints of a quadruped that never turn, but for one acceleration of an impact
    let mut table = String::from("t");
    (1..13).for_each(|k| table += &format!(",theta_{k}"));
    (1..13).for_each(|k| table += &format!(",ddtheta_{k}"));
    (1..13).for_each(|k| table += &format!(",dtheta_{k}"));
    table += "\n";
    for row in 0..400 {
        let t = 0.01 * f64::from(row);
        let of = |k: u32| (t + f64::from(k.min(10))).sin();
        let cells = (0..12)
            .map(of)
            .chain((0..12).map(|k| if row == 200 && k == 0 { 2e4 } else { of(k) }))
            .chain((0..12).map(of));
        table += &cells.fold(t.to_string(), |line, x| format!("{line},{x}"));
        table += "\n";
    }
    let table = common::file(&folder, "legs.csv", &table);
    let legs = page(&folder, "legs", &["view", "anymal", &table]);
    let found = look(&program, vec![job("plots", &legs, 1280, json!({})), job("plots", &legs, 390, json!({}))]);
    for found in &found {
        let plots = found["plots"].as_array().expect("plots");
        let titles: Vec<_> = plots.iter().map(|plot| (plot["title"].as_str(), plot["unit"].as_str())).collect();
        for wanted in [("θ", "rad"), ("θ̇", "rad/s"), ("θ̈", "rad/s²")] {
            assert!(titles.contains(&(Some(wanted.0), Some(wanted.1))), "{titles:?}");
        }
        for plot in plots {
            for axis in ["up", "along"] {
                assert!(plot["ticks"][axis].as_array().is_some_and(|ticks| ticks.len() > 1), "{axis}: {plot}");
            }
            let is_cut = plot["title"] == "θ̈";
            assert!(plot["cut"][0].is_null() && plot["cut"][1].as_f64() == is_cut.then_some(2e4), "{plot}");
            if plot["title"] == "energy" {
                continue;
            }
            // the eleventh and the twelfth joint move as one
            let on = numbers(&plot["on"]);
            assert_eq!((on[11], on.iter().sum::<f64>()), (1.0, 1.0), "{plot}");
            let colours = words(&plot["colours"]);
            for (k, a) in colours[..10].iter().enumerate() {
                for b in &colours[..k] {
                    assert!(apart(a, b) > 100.0, "{a} and {b}: {}", apart(a, b));
                }
            }
        }
        assert_eq!(found["patterned"], true, "lines change by dashes");
    }
}

#[test]
fn the_fit_report_answers_first() {
    let Some(program) = program() else { return };
    let folder = folder("looks_fit");
    let path = |name: &str| folder.join(name).to_str().expect("text").to_string();
    let (way, log, report) = (path("way.csv"), path("log.csv"), path("fit.html"));
    let limits = ["--max-velocity", "3", "--max-acceleration", "10", "--harmonics", "3"];
    text(&[&["excite", "double_pendulum", "--duration", "5", "--out", &way], &limits[..]].concat());
    // friction that the robot's file does not have
    let rows = std::fs::read_to_string(&way).expect("rows");
    let (head, rest) = rows.split_once('\n').expect("a header");
    let place = |name: &str| head.split(',').position(|known| known == name).expect("a column");
    let mut noisy = format!("{head}\n");
    for row in rest.lines() {
        let mut cells: Vec<f64> = row.split(',').map(|cell| cell.parse().expect("a number")).collect();
        for k in 1..3 {
            let rate = cells[place(&format!("dtheta_{k}"))];
            cells[place(&format!("tau_{k}"))] += 0.3 * rate + 0.4 * (rate / 0.05).tanh();
        }
        noisy += &cells.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
        noisy += "\n";
    }
    std::fs::write(&log, noisy).expect("written");
    text(&["identify", "double_pendulum", &log, "--out", &path("found.urdf"), "--report", &report]);
    let job = |width| json!({ "do": "fit", "url": url(Path::new(&report)), "width": width, "height": 844 });
    let found = look(&program, vec![job(1280), job(390)]);
    for found in &found {
        assert_eq!(found["first"], "verdict good", "the verdict comes first");
        assert!(
            found["answer"].as_str().is_some_and(|said| said.starts_with("Predicts unseen torques to ")),
            "{found}"
        );
        let headings = words(&found["headings"]);
        let order = ["What is not determined", "What was noticed", "Forces, measured and predicted", "Friction"];
        assert_eq!(headings[..4], order, "{headings:?}");
        assert!(
            headings.contains(&"Masses [kg]") && headings.contains(&"Viscous friction [N m s/rad]"),
            "{headings:?}"
        );
        assert!(found["open"] == 0 && found["folded"].as_u64() >= Some(3), "tables are folded: {found}");
        assert!(found["dots"].as_u64() > Some(100) && found["bars"].as_u64() > Some(8), "{found}");
        let [light, dark] = [0, 1].map(|k| &found["grounds"][k]);
        assert!(light[0] == light[1] && dark[0] == dark[1] && light[0] != dark[0] && light[2] != dark[2], "{found}");
        assert_eq!(found["paper"], 1, "one printed page");
        assert!(words(&found["printed"]).contains(&"Forces, measured and predicted"), "{found}");
    }
}

#[test]
fn a_lesson_runs_in_class() {
    let (code, said) = common::complaint(&["play", "--lesson", "9.9", "--out", "never.html"]);
    assert!(code == 1 && said.contains("--lesson is `9.9`, expected one of 8.1, 8.2"), "{said}");
    let (code, said) = common::complaint(&["play", "ur5", "--lesson", "8.1", "--out", "never.html"]);
    assert!(code == 1 && said.contains("has a robot and a start of its own"), "{said}");
    let Some(program) = program() else { return };
    let folder = folder("looks_lesson");
    let theta = [0.4, 1.1];
    let mut jobs = Vec::new();
    for number in ["8.1", "8.2", "8.3", "8.4", "8.5", "8.6", "8.7"] {
        let lesson = page(&folder, number, &["play", "--lesson", number]);
        let more = if number == "8.4" { json!({ "theta": theta }) } else { json!({}) };
        jobs.push(job("lesson", &lesson, 1280, more.clone()));
        if number == "8.4" {
            jobs.push(job("lesson", &lesson, 390, more));
        }
    }
    let found = look(&program, jobs);
    for found in &found {
        assert!(found["tab"] == "Lesson" && found["stays"] == true, "{found}");
        assert!(found["score"].as_str().is_some_and(|said| said.starts_with("All ")), "{found}");
        for said in found["said"].as_array().expect("questions") {
            let said = words(said);
            assert!(said[0] == "Not yet." && said[1].starts_with("Right"), "{said:?}");
        }
    }
    let answers = |k: usize| numbers(&found[k]["answers"]);
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-9, "{found}, by hand {expected}");
    near(answers(0)[0], 9.81 * (2.0 * 0.5 + 0.9));
    near(answers(0)[1], 2.0 * 0.25 + 0.25 + 0.16);
    near(answers(3)[0], 14.0);
    near(answers(3)[1], -2.0 * 9.81 * std::f64::consts::FRAC_PI_4.sin());
    // the ellipse {Mθ̈ : ‖θ̈‖ = 1} has the singular values of M
    let (s, c) = f64::sin_cos(theta[1]);
    let M = mozzi::nalgebra::Matrix2::new(8.0 + 6.0 * s * s, -2.0 * c, -2.0 * c, 6.0);
    let sigma = M.singular_values();
    for found in &found[3..5] {
        let axes = numbers(&found["ellipse"]["axes"]);
        near(axes[0], sigma.max());
        near(axes[1], sigma.min());
        assert_eq!(found["linked"], json!([found["score"], theta]), "the link has state and answers");
    }
}
