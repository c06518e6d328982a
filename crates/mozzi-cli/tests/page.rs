//! The page of `--report` and `view` in a real browser: the scene agrees with mozzi's results.

use crate::browser;
use crate::common;

use browser::{browser, look, url};
use common::{folder, json, numbers, rows, text};
use mozzi::model::description::JointKind;
use mozzi::nalgebra::DMatrix;
use mozzi::{BodyFrame, FrameId, Freedom, Model, Place, SE3, Vec3};
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// A motion's positions and rates go to the page as 32-bit floats.
const SINGLE: f64 = 2e-6;
/// What the page computes of them is the library's.
const EXACT: f64 = 1e-12;

fn all_frames(model: &Model) -> Vec<(FrameId, String)> {
    model.frames().map(|(id, name)| (id, name.to_string())).collect()
}

fn pose(value: &Value) -> SE3 {
    let x = numbers(value);
    SE3::from_matrix([
        [x[0], x[1], x[2], x[3]],
        [x[4], x[5], x[6], x[7]],
        [x[8], x[9], x[10], x[11]],
        [0.0, 0.0, 0.0, 1.0],
    ])
    .expect("a configuration")
}

fn assert_near(what: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    let size = expected.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
    let apart = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert_eq!(found.len(), expected.len(), "{what}");
    assert!(apart < tolerance * size, "{what}: {found:?} and {expected:?} differ by {apart:e}");
}

/// The page's state equals mozzi's at the same positions: poses, M, and, if rates are given, twists and wrenches.
fn assert_state(model: &Model, found: &Value, theta: &[f64], rates: Option<[&[f64]; 2]>) {
    assert_near("theta", &numbers(&found["theta"]), theta, SINGLE);
    for (name, rate) in ["dtheta", "ddtheta"].into_iter().zip(rates.into_iter().flatten()) {
        assert_near(name, &numbers(&found[name]), rate, SINGLE);
    }
    let rates = rates.map(|_| ["dtheta", "ddtheta"].map(|name| numbers(&found[name])));
    let theta = &numbers(&found["theta"])[..];
    let poses = model.frame_poses(theta).expect("poses");
    for ((_, name), (found, expected)) in
        all_frames(model).iter().zip(found["poses"].as_array().expect("poses").iter().zip(&poses))
    {
        let apart = (pose(found).inverse() * *expected).log().to_array();
        assert_near(name, &apart, &[0.0; 6], EXACT);
    }
    let M = model.mass_matrix(theta).expect("M");
    let found_M = rows(&found["M"]).concat();
    assert_near("M", &found_M, DMatrix::transpose(&M).as_slice(), EXACT);
    let [dtheta, ddtheta] = &rates.unwrap_or_else(|| [vec![0.0; model.n()], vec![0.0; model.n()]]);
    let environment = model.environment();
    let of = |frame| model.newton_euler(theta, dtheta, ddtheta, &environment, frame).expect("a state");
    let (at_link, at_mass) = (of(BodyFrame::Link), of(BodyFrame::CenterOfMass));
    let link = |name: &str| model.forward_kinematics(theta, model.frame(name).expect("a link")).expect("a pose");
    for (k, joint) in model.moving_joints().enumerate() {
        // moments are about the axis or the ball's centre; mozzi's are about the link's origin
        let point = match joint.kind {
            JointKind::Screw(A) => A.twist().w.cross(A.twist().v),
            JointKind::Ball(center) => center,
            JointKind::Free | JointKind::Fixed => Vec3::zero(),
        };
        let R = link(&joint.child).R;
        let vectors = |kind: &str| numbers(&found["vectors"][kind][k + 1]);
        let compare = |kind: &str, expected: Vec3| assert_near(kind, &vectors(kind), &(R * expected).0, EXACT);
        compare("spin", at_link.twists[k].w);
        compare("speed", at_mass.twists[k].v);
        compare("force", at_link.wrenches[k].f);
        compare("moment", at_link.wrenches[k].m - point.cross(at_link.wrenches[k].f));
    }
    let center = model.center_of_mass(theta).expect("a robot that weighs something");
    assert_near("center of mass", &numbers(&found["center"]), &center.0, EXACT);
    let tip = all_frames(model).into_iter().find(|(_, name)| found["tip"] == name.as_str()).expect("a frame").0;
    let J = model.body_jacobian(theta, tip).expect("J");
    // J_v Jᵥᵀ in the frame's own axes has the same trace and determinant
    let places = model.places().iter().filter(|place| place.freedom != Freedom::Free);
    let J_v = DMatrix::from_fn(3, 0, |_, _| 0.0_f64);
    let J_v = places.flat_map(Place::velocities).fold(J_v, |J_v, j| {
        let last = J_v.ncols();
        let mut longer = J_v.insert_column(last, 0.0);
        longer.column_mut(last).copy_from_slice(&J.0[j].v.0);
        longer
    });
    let mut squares: Vec<f64> = (&J_v * J_v.transpose()).symmetric_eigenvalues().iter().copied().collect();
    squares.sort_by(f64::total_cmp);
    let found: Vec<f64> = numbers(&found["semiAxes"]).iter().map(|sigma| sigma * sigma).collect();
    assert_near("manipulability", &found, &squares, EXACT);
}

fn assert_usable(found: &Value, width: u64) {
    assert_eq!(found["errors"], json!([]), "no error on the console");
    assert_eq!(
        found["requests"].as_array().map(Vec::len),
        Some(1),
        "nothing but the page is asked for: {}",
        found["requests"]
    );
    for (kind, states) in found["toggles"].as_object().expect("toggles") {
        let [before, after, again] = [0, 1, 2].map(|k| states[k].as_str().expect("true or false"));
        assert!(before != after && before == again, "{kind}: {states}");
    }
    assert!(found["toggles"].as_object().is_some_and(|all| all.len() >= 9), "{}", found["toggles"]);
    assert_ne!(found["themes"][0], found["themes"][1]);
    assert!(found["painted"].as_u64().expect("a count") > 5, "the scene is empty");
    assert_eq!(found["covered"].as_f64(), Some(0.0), "M(θ) is shown, and covers nothing of the scene");
    assert!(found["width"].as_u64().expect("a width") <= width, "wider than the screen: {}", found["width"]);
}

/// A robot of example-robot-data, with meshes.
fn robot(path: &str) -> Option<String> {
    let file = PathBuf::from(std::env::var_os("MOZZI_ROBOTS")?).join(path);
    file.is_file().then(|| file.to_string_lossy().into_owned())
}

#[test]
fn the_page_shows_what_mozzi_computes() {
    let program = match browser() {
        Ok(program) => program,
        Err(why) => return println!("skipped: {why}; cargo xtask test sets it where a Chromium is installed"),
    };
    let folder = folder("page");
    let load = |name: &str| mozzi_urdf::open(name).and_then(mozzi_urdf::Loaded::build).expect("a robot");
    let (ur5, anymal) = (load("ur5"), load("anymal"));

    let report = folder.join("ur5.html");
    let report_name = report.to_str().expect("text");
    let start =
        ["--theta", "0,-1.2,1.5,0.3,1.1,0", "--time", "0.5", "--step", "0.01", "--torque", "gravity-compensation"];
    let simulate = [&["simulate", "ur5", "--dtheta", "1,0.2,-0.5,0.4,0.3,1"], &start[..]].concat();
    let motion = json(&simulate);
    assert!(text(&[&simulate[..], &["--report", report_name]].concat()).contains("page: 51 of 51 rows, "));
    let names = |model: &Model| all_frames(model).into_iter().map(|(_, name)| name).collect::<Vec<_>>();
    let times = numbers(&motion["t"]);
    let looked = [0, 17, 50];

    let still = folder.join("anymal.html");
    text(&["view", "anymal", "--floating", "--out", still.to_str().expect("text")]);
    let mut stand = vec![1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    stand.extend((0..12).map(|k| 0.1 * f64::from(k) - 0.5));
    let anymal = mozzi_urdf::open("anymal").expect("embedded").description.floating().build().unwrap_or(anymal);

    // balls and free bodies, thrown, and at rest
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../mozzi-report/tests/balls.xml");
    let balls = load(file);
    let (thrown_page, rest_page) = (folder.join("thrown.html"), folder.join("rest.html"));
    let rates: Vec<String> = (0..balls.n()).map(|k| format!("{}", 0.5 - 0.07 * k as f64)).collect();
    let throw = ["simulate", file, "--dtheta", &rates.join(","), "--time", "0.5", "--step", "0.01"];
    let thrown = json(&throw);
    text(&[&throw[..], &["--report", thrown_page.to_str().expect("text")]].concat());
    text(&["view", file, "--out", rest_page.to_str().expect("text")]);
    let mut posed: Vec<f64> = balls.neutral_configuration();
    for (k, place) in balls.places().iter().enumerate() {
        if place.freedom == Freedom::One {
            posed[place.q] = 0.2 + 0.1 * k as f64;
        } else {
            posed[place.q..place.q + 4].copy_from_slice(&[0.5, -0.1, 0.7, 0.5]);
        }
        posed[place.positions()].iter_mut().skip(4).for_each(|x| *x = 0.3 - 0.2 * k as f64);
    }

    // a table in which the sign of a ball's quaternion changes from row to row: the motion between rows stays
    // continuous, 0.2 rad about x per row
    let shoulder = balls.places()[1].q;
    let turned = |half: f64, sign: f64| {
        let mut theta: Vec<f64> = balls.neutral_configuration();
        (theta[shoulder], theta[shoulder + 1]) = (sign * half.cos(), sign * half.sin());
        theta
    };
    let mut table: String = (1..=balls.nq()).fold("t".into(), |line, k| format!("{line},theta_{k}"));
    for k in 0..5_i32 {
        let theta = turned(0.1 * f64::from(k), f64::from(1 - 2 * (k % 2)));
        let line = theta.iter().fold(format!("\n{}", 0.25 * f64::from(k)), |line, x| format!("{line},{x}"));
        table.push_str(&line);
    }
    let (table, signs_page) = (common::file(&folder, "signs.csv", &table), folder.join("signs.html"));
    text(&["view", file, &table, "--out", signs_page.to_str().expect("text")]);

    let mut jobs = vec![
        json!({ "url": url(&report), "width": 800, "height": 400, "times": looked.map(|k| times[k]), "frames": names(&ur5) }),
        json!({ "url": url(&still), "width": 390, "height": 844, "theta": [stand], "frames": names(&anymal) }),
        json!({ "url": url(&thrown_page), "width": 800, "height": 400, "times": looked.map(|k| times[k]), "frames": names(&balls) }),
        json!({ "url": url(&rest_page), "width": 800, "height": 600, "theta": [posed], "frames": names(&balls), "tip": "load" }),
        json!({ "url": url(&signs_page), "width": 800, "height": 400, "times": [0.125], "frames": names(&balls) }),
    ];
    // with meshes: Collada of a quadruped, STL of a humanoid
    let quadruped = robot("hyq_description/robots/hyq_no_sensors.urdf").map(|file| (load(&file), file, "visual"));
    let humanoid = robot("talos_data/robots/talos_reduced.urdf").map(|file| (load(&file), file, "collision"));
    let meshed: Vec<_> = quadruped.into_iter().chain(humanoid).collect();
    for (model, file, meshes) in &meshed {
        let page = folder.join(format!("{meshes}.html"));
        text(&["view", file, "--meshes", meshes, "--out", page.to_str().expect("text")]);
        let theta: Vec<f64> = (0..model.n()).map(|k| 0.3 - 0.05 * k as f64).collect();
        jobs.push(json!({ "url": url(&page), "width": 500, "height": 300, "theta": [theta], "frames": names(model) }));
    }
    let found = look(&program, &Value::Array(jobs.clone()));

    for (model, motion, found) in [(&ur5, &motion, &found[0]), (&balls, &thrown, &found[2])] {
        for (k, state) in looked.iter().zip(found["states"].as_array().expect("states")) {
            let row = |name: &str| numbers(&motion[name][*k]);
            let (dtheta, ddtheta) = (row("dtheta"), row("ddtheta"));
            assert_state(model, state, &row("theta"), Some([&dtheta, &ddtheta]));
            assert_eq!(state["clock"], format!("{:.3} s", times[*k]));
        }
    }
    let scrubbed = numbers(&found[0]["scrubbed"]);
    assert!(scrubbed[0] == 0.0 && (scrubbed[1] - 0.25).abs() < 0.01, "{scrubbed:?}");
    let row_on = scrubbed[2] - scrubbed[1];
    assert!(row_on > 0.0 && row_on <= 0.0101 && scrubbed[3] > scrubbed[2] + 0.001, "{scrubbed:?}");
    assert!((scrubbed[4] - 0.5).abs() < 0.01, "{scrubbed:?}");
    assert_state(&anymal, &found[1]["states"][0], &stand, None);
    assert_state(&balls, &found[3]["states"][0], &posed, None);
    assert_state(&balls, &found[4]["states"][0], &turned(0.05, 1.0), None);
    for (((model, _, name), found), job) in meshed.iter().zip(&found[5..]).zip(&jobs[5..]) {
        assert_state(model, &found["states"][0], &numbers(&job["theta"][0]), None);
        assert!(found["toggles"].get("shapes").is_some(), "{name} meshes are shapes");
    }
    let of_meshes = meshed.iter().zip(&found[5..]).map(|((model, ..), found)| (model, found));
    for (model, found) in [(&anymal, &found[1]), (&balls, &found[3])].into_iter().chain(of_meshes) {
        assert_ne!(found["slid"][0], found["slid"][1], "a slider moves its joint");
        let free = model.places().iter().map(|place| place.freedom.velocities()).sum::<usize>();
        assert_eq!(found["sliders"], free, "a slider for each velocity of a joint");
        for theta in ["slid", "random"].map(|key| numbers(&found[key][1])) {
            assert!(model.frame_poses(&theta).is_ok(), "quaternions are unit: {theta:?}");
        }
    }
    for (found, job) in found.iter().zip(&jobs) {
        assert_usable(found, job["width"].as_u64().expect("a width"));
    }
}

#[test]
fn view_serves_the_page_on_this_machine_alone() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_mozzi"))
        .args(["view", "double_pendulum"])
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut line = String::new();
    BufReader::new(child.stderr.take().expect("a pipe")).read_line(&mut line).expect("a line");
    let address = line.split("http://").nth(1).and_then(|rest| rest.split('/').next()).expect("an address").to_string();
    assert!(address.starts_with("127.0.0.1:"), "{line}");
    let mut stream = std::net::TcpStream::connect(&address).expect("it listens");
    write!(stream, "GET / HTTP/1.1\r\nHost: {address}\r\n\r\n").expect("asked");
    let mut page = String::new();
    std::io::Read::read_to_string(&mut stream, &mut page).expect("answered");
    child.kill().and_then(|()| child.wait()).expect("ended");
    assert!(page.starts_with("HTTP/1.1 200 OK") && page.contains("<title>double_pendulum</title>"), "{:.200}", page);
}

#[test]
fn a_table_becomes_a_page_and_a_wrong_one_is_refused() {
    let folder = folder("page_tables");
    let path = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let (table, page) = (path("swing.csv"), path("swing.html"));
    text(&["simulate", "double_pendulum", "--theta", "1.5,0", "--time", "0.1", "--out", &table]);
    let said = text(&["view", "double_pendulum", &table, "--out", &page]);
    assert!(said.starts_with("page: 101 of 101 rows, ") && said.ends_with(&format!("written to {page}\n")), "{said}");
    let html = std::fs::read_to_string(&page).expect("a page");
    assert!(html.starts_with("<!doctype html>") && html.contains("\"potential_energy\":\""));
    let backwards = common::file(&folder, "back.csv", "t,theta_1,theta_2\n1,0,0\n0,0,0\n");
    let (code, said) = common::complaint(&["view", "double_pendulum", &backwards, "--out", &page]);
    assert_eq!(code, 1);
    assert!(said.contains("back.csv:3: t is 0 after 1, expected increasing times: the clock was set back"), "{said}");
}
