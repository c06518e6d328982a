//! Contacts on the page of `mozzi simulate --ground --report`, in a real browser: what the scene draws agrees with
//! mozzi's results.

use crate::browser;
use crate::common;

use browser::{browser, look, url};
use common::{file, folder, json, numbers, text};
use mozzi::{Model, Vec3};
use serde_json::{Value, json};

const CUBE: &str = r#"<robot name="cube"><link name="cube">
  <inertial><mass value="2"/><inertia ixx="0.003" iyy="0.003" izz="0.003" ixy="0" ixz="0" iyz="0"/></inertial>
  <visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>
</link></robot>"#;

/// A slope of 20° about y, which holds friction angles of at least 20°; and a belt 1 m to its side.
const SLOPE: [f64; 4] = [0.984_807_753_012_208, 0.0, 0.173_648_177_666_930_33, 0.0];

fn assert_near(what: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    let apart = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(found.len() == expected.len() && apart < tolerance, "{what}: {found:?} and {expected:?}");
}

/// The drawn contacts of a state are mozzi's at the same row: points by forward kinematics, forces of the simulation,
/// cones about the plane's normal with half-angle atan μ; on the side of the robot (1) or of the plane (−1).
fn assert_contacts(
    model: &Model,
    motion: &Value,
    row: usize,
    shown: &Value,
    points: &[(&str, Vec3, f64)],
    normal: Vec3,
    side: f64,
) {
    let theta = numbers(&motion["theta"][row]);
    let forces = numbers(&motion["contact_forces"][row]);
    let drawn = shown["contacts"].as_array().expect("contacts");
    assert_eq!(drawn.len(), points.len());
    let largest = forces.iter().fold(1.0_f64, |most, f| most.max(f.abs()));
    for (k, (contact, &(frame, at, mu))) in drawn.iter().zip(points).enumerate() {
        let T = model.forward_kinematics(&theta, model.frame(frame).expect("a frame")).expect("a pose");
        assert_near("the point", &numbers(&contact["at"]), &(T * at).0, 1e-5);
        let force = Vec3([forces[3 * k], forces[3 * k + 1], forces[3 * k + 2]]);
        if force.norm() > 0.02 * largest {
            assert_near("the force", &numbers(&contact["force"]), &(force * side).0, 2e-5 * largest);
        }
        let pressed = -force.dot(normal);
        assert_eq!(contact["cone"].is_object(), pressed > 0.0, "a cone where the contact carries: {contact}");
        if pressed > 0.0 {
            let cone = &contact["cone"];
            assert_near("the cone's tip", &numbers(&cone["tip"]), &(T * at).0, 1e-5);
            assert_near("the cone's axis", &numbers(&cone["axis"]), &(normal * -side).0, 1e-4);
            let angles = numbers(&cone["halfAngles"]);
            assert!(angles.len() > 40);
            assert_near("the half-angle", &angles, &vec![f64::atan(mu); angles.len()], 1e-4);
            let tangential = (force + normal * pressed).norm();
            assert!(tangential <= mu * pressed * (1.0 + 1e-6) + 1e-9, "Coulomb");
            assert_eq!(contact["slides"], tangential > mu * pressed * (1.0 - 1e-4), "{contact}");
        }
    }
}

#[test]
fn the_page_shows_contacts_forces_and_cones() {
    let program = match browser() {
        Ok(program) => program,
        Err(why) => return println!("skipped: {why}; cargo xtask test sets it where a Chromium is installed"),
    };
    let folder = folder("page_contacts");
    let load = |name: &str| mozzi_urdf::open(name).expect("a robot").description.floating().build().expect("sound");
    let path = |name: &str| folder.join(name).to_str().expect("text").to_string();

    // a box that slides down a slope on two corners of low friction, and sticks on two others
    let cube = file(&folder, "cube.urdf", CUBE);
    let corners: Vec<(&str, Vec3, f64)> = [(-1.0, -1.0, 0.2), (-1.0, 1.0, 0.2), (1.0, -1.0, 0.3), (1.0, 1.0, 0.3)]
        .map(|(x, y, mu)| ("cube", Vec3([0.05 * x, 0.05 * y, -0.05]), mu))
        .to_vec();
    let points = corners.iter().map(|(frame, at, mu)| json!({ "frame": frame, "at": at.0, "friction": mu }));
    let pose = [&SLOPE[..], &[0.0; 3]].concat();
    let planes = json!([{ "name": "slope", "pose": pose }]);
    let contacts = json!({ "points": points.collect::<Value>(), "planes": planes }).to_string();
    let contacts = file(&folder, "slope.json", &contacts);
    let (s, c) = (f64::to_radians(20.0).sin(), f64::to_radians(20.0).cos());
    let start = [SLOPE[0], 0.0, SLOPE[2], 0.0, 0.06 * s, 0.0, 0.06 * c].map(|x| x.to_string()).join(",");
    let slide = ["simulate", &cube, "--floating", "--contacts", &contacts, "--theta", &start, "--time", "0.3"];
    let sliding = json(&slide);
    text(&[&slide[..], &["--report", &path("slope.html")]].concat());

    // ANYmal on its feet
    let gains = |x: f64| vec![x; 12];
    let controller = json!({ "controller": "pd-gravity", "p": gains(400.0), "d": gains(10.0) }).to_string();
    let controller = file(&folder, "pd.json", &controller);
    let feet = ["LF_FOOT", "LH_FOOT", "RF_FOOT", "RH_FOOT"];
    let mut stand = vec!["simulate", "anymal", "--floating", "--ground", "--controller", &controller, "--time", "0.6"];
    stand.extend(["--step", "0.002"]);
    stand.extend(feet.iter().flat_map(|foot| ["--contact", foot]));
    let standing = json(&stand);
    text(&[&stand[..], &["--report", &path("stand.html")]].concat());

    let looked = [0, 40, 300];
    // the first as the plane pushes the robot, as it is at first; the second from the robot's side
    let job = |name: &str, motion: &Value, frame: &str, applied: bool| {
        let times = looked.map(|k| motion["t"][k].clone());
        json!({ "url": url(&folder.join(name)), "width": 900, "height": 600, "times": times, "frames": [frame],
                "applied": applied })
    };
    let jobs = [job("slope.html", &sliding, "cube", false), job("stand.html", &standing, "LF_FOOT", true)];
    let found = look(&program, &json!(jobs));
    for page in &found {
        assert_eq!(page["errors"], json!([]), "no error on the console");
        assert!(page["toggles"].get("contacts").is_some(), "{}", page["toggles"]);
    }

    let normal = Vec3([s, 0.0, c]);
    let (box_model, anymal) = (load(&cube), load("anymal"));
    for (k, shown) in looked.iter().zip(found[0]["states"].as_array().expect("states")) {
        assert_contacts(&box_model, &sliding, *k, shown, &corners, normal, -1.0);
        assert_near("the slope", &numbers(&shown["planes"][0]["z"]), &normal.0, 1e-6);
        let origin = numbers(&shown["planes"][0]["origin"]);
        let above = normal.dot(Vec3([origin[0], origin[1], origin[2]]));
        assert!(above.abs() < 1e-3, "the grid lies on the slope: {above}");
    }
    let slid = &found[0]["states"][2]["contacts"];
    assert!(slid.as_array().expect("four").iter().any(|contact| contact["slides"] == true), "{slid}");
    assert!(
        found[0]["states"][2]["hint"].as_str().is_some_and(|said| said.contains("touch down")),
        "{}",
        found[0]["states"][2]["hint"]
    );

    let feet: Vec<_> = feet.iter().map(|foot| (*foot, Vec3::zero(), 0.7)).collect();
    for (k, shown) in looked.iter().zip(found[1]["states"].as_array().expect("states")) {
        assert_contacts(&anymal, &standing, *k, shown, &feet, Vec3([0.0, 0.0, 1.0]), 1.0);
        // the wrench that drives the base is none: feet, weight and inertia agree
        let base = numbers(&shown["vectors"]["force"][0]);
        let weight = 9.81 * anymal.mass();
        if *k == 300 {
            assert_near("the force on the base", &base, &[0.0; 3], 1e-3 * weight);
            let forces: Vec<Vec<f64>> =
                shown["contacts"].as_array().expect("four").iter().map(|c| numbers(&c["force"])).collect();
            let down: f64 = forces.iter().map(|f| -f[2]).sum();
            assert!((down / weight - 1.0).abs() < 0.02, "{down} {weight}");
        }
    }
    println!("{} corners and {} feet at {} times each", corners.len(), feet.len(), looked.len());
}
