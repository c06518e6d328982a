//! Round trips: a robot that is written and read again is the same robot.

use crate::common;

use common::{assert_close, complaint, file, folder, json, rows, text};

const TREE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../oracles/test_tree.urdf");

#[test]
fn from_urdf_to_json_to_urdf_the_dynamics_stay() {
    let folder = folder("convert");
    for (name, input) in [("ur5", "ur5"), ("panda", "panda"), ("tree", TREE)] {
        let path = |suffix: &str| folder.join(format!("{name}.{suffix}")).to_str().expect("text").to_string();
        let (first, second) = (path("json"), path("urdf"));
        assert!(text(&["convert", input, &first]).contains(" kg"));
        text(&["convert", &first, &second]);
        let n = json(&["info", input])["n"].as_u64().expect("n") as usize;
        let state = |from: f64| (0..n).map(|j| (from + 0.7 * j as f64).sin().to_string()).collect::<Vec<_>>().join(",");
        let at = |robot: &str| json(&["terms", robot, "--theta", &state(0.3), "--dtheta", &state(1.1)]);
        let expected = at(input);
        for robot in [&first, &second] {
            let found = at(robot);
            assert_eq!(found["joints"], expected["joints"]);
            assert_close(&rows(&found["mass_matrix"]).concat(), &rows(&expected["mass_matrix"]).concat(), 1e-12);
            let forces = |terms: &serde_json::Value| common::numbers(&terms["bias_forces"]);
            let scale = forces(&expected).iter().fold(1.0_f64, |m, x| m.max(x.abs()));
            assert_close(&forces(&found), &forces(&expected), 1e-12 * scale);
        }
        let again = path("again.json");
        text(&["convert", &first, &again]);
        let read = |path: &str| std::fs::read_to_string(path).expect("a file");
        assert_eq!(read(&first), read(&again), "JSON reads back bit by bit");
    }
}

#[test]
fn python_and_what_cannot_be_converted() {
    let folder = folder("not_converted");
    let path = |name: &str| folder.join(name).to_str().expect("text").to_string();
    text(&["convert", "ur5", &path("ur5.py")]);
    assert_eq!(std::fs::read_to_string(path("ur5.py")).expect("a file"), text(&["screws", "ur5", "--python"]));
    let says = |arguments: &[&str], words: &str| {
        let (code, message) = complaint(arguments);
        assert!(code == 1 && message.contains(words), "{message}");
    };
    says(&["convert", "ur5", &path("ur5.txt")], "expected a name that ends in .urdf, .sdf, .xml (MJCF), .json or .py");
    says(&["convert", "ur5", "-"], "OUT is `-`, expected --as FORMAT for standard output");
    says(&["convert", "ur5", &path("ur5.usd")], "`urdf-usd-converter` (PyPI) makes it of a URDF");
    says(&["convert", "panda", &path("panda.py")], "serial chains");
    let lost = "the limits of 6 joints (`shoulder_pan_joint`, ";
    says(&["convert", "ur5", &path("strict.py"), "--strict"], &format!("--strict, and it cannot express {lost}"));
    assert!(!std::path::Path::new(&path("strict.py")).exists());
    let told =
        String::from_utf8(common::mozzi(&["convert", "ur5", &path("ur5.py"), "--in-place"]).stderr).expect("text");
    assert!(told.contains(lost), "{told}");
    let pendulum =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../mozzi-urdf/tests/convert/offset.xml"));
    let model = file(&folder, "offset.xml", &pendulum.expect("a file"));
    let told = String::from_utf8(common::mozzi(&["convert", &model, &path("offset.py")]).stderr).expect("text");
    assert!(told.contains("cannot express the armature of `shoulder`"), "{told}");
    let robot = path("ur5.json");
    text(&["convert", "ur5", &robot]);
    let good: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(&robot).expect("it")).expect("JSON");
    let broken = |edit: &dyn Fn(&mut serde_json::Value)| {
        let mut value = good.clone();
        edit(&mut value);
        file(&folder, "broken.json", &value.to_string())
    };
    says(
        &["info", &broken(&|v| v["joints"][1]["damping"] = "x".into())],
        "joints[1].damping is \"x\", expected a number",
    );
    says(&["info", &broken(&|v| v["links"][1]["G"][3][3] = 99.into())], "links[1].G is ");
    says(&["info", &broken(&|v| v["lists"]["S"][1][4] = 7.into())], "lists.S disagrees with links and joints");
    says(&["info", &broken(&|v| v["gravity"] = serde_json::json!([0, 1]))], "gravity is [0,1], expected 3 numbers");
    says(&["info", &file(&folder, "no.json", "{")], "is not valid JSON");
}

#[test]
fn mjcf_is_read_by_every_command() {
    let folder = folder("mjcf");
    let robot = concat!(env!("CARGO_MANIFEST_DIR"), "/../mozzi-report/tests/peers/springs.xml");
    let path = |name: &str| folder.join(name).to_str().expect("text").to_string();
    assert!(text(&["convert", robot, &path("springs.json")]).contains("2 independent joints"));
    let read: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(path("springs.json")).expect("a file")).expect("JSON");
    assert_eq!(
        (read["joints"][0]["stiffness"].as_f64(), read["joints"][0]["spring_reference"].as_f64()),
        (Some(3.0), Some(0.0))
    );
    text(&["convert", robot, &path("springs.py")]);
    let output = common::mozzi(&["convert", robot, &path("springs.urdf")]);
    let said = String::from_utf8(output.stderr).expect("text");
    assert!(output.status.success() && said.contains("springs.urdf: warning: `armature` of `"), "{said}");
    let at = ["--theta", "0.3,0.1", "--dtheta", "1,2"];
    for (command, quantity) in
        [("terms", None), ("compute", Some("inverse-dynamics")), ("compute", Some("forward-dynamics"))]
    {
        let run = |robot: &str| json(&[&[command, robot], quantity.as_slice(), &at].concat());
        assert_eq!(run(robot), run(&path("springs.json")), "{command} {quantity:?}");
    }
    assert_eq!(json(&["info", robot])["n"], 2);
    assert_eq!(json(&["screws", robot]), json(&["screws", &path("springs.json")]));
    text(&["check", robot]);
    text(&["simulate", robot, "--time", "0.01"]);
}

#[test]
fn json_is_checked() {
    let folder = folder("check_json");
    let robot = folder.join("tree.json").to_str().expect("text").to_string();
    text(&["convert", TREE, &robot]);
    text(&["check", &robot]);
    let odd = concat!(env!("CARGO_MANIFEST_DIR"), "/../mozzi-report/tests/peers/doctor.urdf");
    let path = folder.join("odd.json").to_str().expect("text").to_string();
    text(&["convert", odd, &path]);
    let lines = text(&["check", &path, "--json"]);
    let first: serde_json::Value = serde_json::from_str(lines.lines().next().expect("a line")).expect("JSON");
    assert_eq!((&first["severity"], &first["code"]), (&"warning".into(), &"mozzi::urdf::unphysical_inertia".into()));
    assert!(first["line"].is_null() && first["help"].is_string(), "{first}");
    let output = common::mozzi(&["check", &path]);
    let said = String::from_utf8_lossy(&output.stderr).to_string();
    assert!(said.contains("odd.json: warning: link `plate`: inertia") && said.contains("3 warnings"), "{said}");
    let (code, message) = complaint(&["check", &path, "--strict"]);
    assert!(code == 1 && message.contains("is refused: 3 errors"), "{message}");
    assert_eq!(complaint(&["info", &path, "--strict"]).0, 1);
    assert_eq!(complaint(&["check", &file(&folder, "no.json", "{")]).0, 1);
}

#[test]
fn info_tells_what_was_folded_into_what() {
    let panda = json(&["info", "panda"]);
    let bodies = panda["bodies"].as_array().expect("a list");
    let count: usize = bodies.iter().map(|body| body["links"].as_array().expect("links").len()).sum();
    assert_eq!(count, panda["links"].as_array().expect("links").len());
    let wrist = bodies.iter().find(|body| body["joint"] == "panda_joint7").expect("it");
    assert_eq!(wrist["links"][0], "panda_link7");
    assert!(wrist["links"].as_array().expect("links").iter().any(|link| link == "panda_hand"), "{wrist}");
    assert!(text(&["info", "panda"]).contains("+ panda_hand"));
}

const JSON: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/robots/two_joints.json");

#[test]
fn all_unknown_keys_of_json_are_reported() {
    let text = std::fs::read_to_string(JSON).expect("a file").replace("gravity", "gravitty").replace("effort", "efort");
    let (code, message) = complaint(&["info", &file(&folder("json_unknown"), "bad.json", &text)]);
    assert!(code == 1 && message.matches("error: ").count() == 6, "{message}");
    assert!(message.contains("gravitty") && message.matches("did you mean `effort`?").count() == 2, "{message}");
}

#[test]
fn keys_of_json_are_known_and_complete() {
    let folder = folder("json_keys");
    let good = std::fs::read_to_string(JSON).expect("a file");
    text(&["info", &file(&folder, "bom.json", &format!("\u{feff}{good}"))]);
    for (from, to, words) in [
        (
            "\"friction\": 25",
            "\"frition\": 25",
            ":17:38: `frition` is not an entry of joints[0], did you mean `friction`?",
        ),
        (", \"friction\": 25", "", ":14:5: `friction` is missing in joints[0]"),
        ("\"A\": [0, 0, 1, 0, 0, 0], ", "", ":14:5: `A` is missing in joints[0]; null is the axis of a fixed joint"),
        (
            "\"A\": [0, 0, 1, 0, 0, 0]",
            "\"A\": [0, 0, 1, 0, 0, 0],\n\"free\": true",
            ":17:1: joints[0] has several of A, ball and free",
        ),
        ("\"G\"", "\"g\"", ":7:23: `g` is not an entry of links[0], did you mean `G`?"),
        ("\"ratio\": 2, ", "", ":22:7: `ratio` is missing in joints[1].mimic"),
        ("\"gravity\"", "\"gravitty\"", ":4:3: `gravitty` is not an entry of the robot, did you mean `gravity`?"),
        (
            "\"fixed\",",
            "\"fixed\", \"free_joint\": {\"name\": \"f\", \"parent\": \"w\"},",
            ":3:20: free_joint is given, but the base is fixed",
        ),
        ("\"damping\": 0.5", "\"damping\": 0.5, \"damping\": 0.6", "`damping` is given twice"),
        (
            "\"frames\": []",
            "\"frames\": [{\"name\": \"tip\", \"link\": \"b\", \"t\": 1}]",
            ":25:43: `t` is not an entry of frames[0], did you mean `T`?",
        ),
        ("\"frames\": []", "\"lists\": {\"SS\": []}", ":25:13: `SS` is not an entry of lists"),
    ] {
        assert!(good.contains(from), "{from}");
        let path = file(&folder, "bad.json", &good.replacen(from, to, 1));
        let (code, message) = complaint(&["info", &path]);
        assert!(code == 1 && message.contains("bad.json:") && message.contains(words), "{words} in {message}");
        let output = common::mozzi(&["check", &path, "--json"]);
        assert_eq!(output.status.code(), Some(1));
        for line in String::from_utf8(output.stdout).expect("text").lines() {
            let error: serde_json::Value = serde_json::from_str(line).expect("JSON");
            let (row, column) = (&error["line"], &error["column"]);
            let place = format!("bad.json:{row}:{column}: {}", error["message"].as_str().expect("text"));
            assert!(message.contains(&place), "{place} in {message}");
        }
    }
}

const ARM: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../mozzi-urdf/tests/convert/arm.urdf");

#[test]
fn from_urdf_to_urdf_the_text_stays() {
    let folder = folder("in_place");
    let arm = file(&folder, "arm.urdf", &std::fs::read_to_string(ARM).expect("a file"));
    let read = |file: &str| std::fs::read_to_string(file).expect("a file");
    let out = folder.join("out.urdf").to_str().expect("text").to_string();
    text(&["convert", &arm, &out]);
    assert_eq!(read(&out), read(&arm));
    text(&["convert", &arm, &out, "--payload", "lower=0.5,0,0,0.1", "--lock", "elbow=-0.5"]);
    let (found, before) = (read(&out), read(&arm));
    let changed = before.lines().filter(|line| !found.lines().any(|other| other == *line)).count();
    assert_eq!(changed, 5, "an inertial, two types, an origin, a mimic: {found}");
    assert!(found.contains("<tool:holder for=\"finger\"/>") && found.contains("<!-- measured on 2024-05-01 -->"));
    assert_eq!(json(&["info", &out])["n"], 1);
    let number = "--inertia=upper=3,0,0,0,0.1,0,0,0.1,0,0.1";
    text(&["convert", &arm, &out, number]);
    assert!(read(&out).contains("<mass value=\"3.0\"/>"));
    let says = |arguments: &[&str], words: &str| {
        let (code, message) = complaint(&[&["convert", &arm], arguments].concat());
        assert!(code == 1 && message.contains(words), "{words} in {message}");
        assert_eq!(read(&arm), before);
    };
    says(&[&arm], "OUT is the file IN");
    let spelled = folder.join("../in_place/arm.urdf").to_str().expect("text").to_string();
    says(&[&spelled, "--lock", "elbow=0"], "--in-place overwrites it");
    says(&[&out, "--lock", "elbow"], "--lock is `elbow`, expected JOINT=POSITION");
    says(&[&out, "--payload", "lower=1,2"], "--payload lower has 2 entries, expected m, m and c");
    says(&[&out, "--payload", "lower=-1"], "the mass is -1 kg, expected at least 0");
    says(&[&out, "--payload", "lower=1,0,0,0,0.1,0,0,0.1,0,5"], "--payload lower: the principal moments about the");
    says(&[&out, "--inertia", "hand=1,0,0,0,1,0,0,1,0,1"], "there is no link `hand`");
    text(&["convert", &arm, &arm, "--in-place", "--lock", "elbow=0"]);
    assert_eq!(json(&["info", &arm])["n"], 1);
}

#[test]
fn a_urdf_from_mjcf_is_complete() {
    let folder = folder("from_mjcf");
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/../mozzi-urdf/tests/convert/offset.xml");
    let out = folder.join("offset.urdf").to_str().expect("text").to_string();
    let said = |arguments: &[&str]| {
        let output = common::mozzi(&[&["convert", model, &out], arguments].concat());
        assert!(output.status.success());
        String::from_utf8(output.stderr).expect("text")
    };
    let words = said(&[]);
    assert!(words.contains("offset.urdf: warning: `armature` of `shoulder` is an extension of <dynamics>"), "{words}");
    let at = |robot: &str| rows(&json(&["terms", robot, "--theta", "0.2,-0.3,0.1"])["mass_matrix"]).concat();
    assert_close(&at(&out), &at(model), 1e-14);
    let found = std::fs::read_to_string(&out).expect("a file");
    assert_eq!(found.matches("<limit ").count(), found.matches(" effort=").count());
    assert!(found.contains("<link name=\"tip\"/>") && found.contains("<joint name=\"tip_joint\" type=\"fixed\">"));
    let words = said(&["--leave-out", "armature"]);
    assert!(words.contains("omits the armature of `shoulder`: M differs"), "{words}");
    assert!(!std::fs::read_to_string(&out).expect("a file").contains("armature"));
    let moon = file(
        &folder,
        "moon.xml",
        &std::fs::read_to_string(model)
            .expect("a file")
            .replace("<worldbody>", "<option gravity=\"0 0 -1.62\"/><worldbody>"),
    );
    let (code, message) = complaint(&["convert", &moon, &out, "--strict"]);
    assert!(code == 1 && message.contains("gravity") && message.contains("--leave-out"), "{message}");
    text(&["convert", &moon, &out, "--strict", "--leave-out", "gravity"]);
    let told = String::from_utf8(common::mozzi(&["convert", &moon, &out]).stderr).expect("text");
    assert!(told.contains("omits gravity [0.0, 0.0, -1.62]"), "{told}");
    // no flag helps a ball
    let ball =
        "<mujoco><worldbody><body><joint type=\"ball\"/><geom size=\"0.1\" mass=\"1\"/></body></worldbody></mujoco>";
    let ball = file(&folder, "ball.xml", ball);
    for flags in [&[][..], &["--strict"]] {
        let (code, message) = complaint(&[&["convert", &ball, &out], flags].concat());
        assert!(code == 1 && message.contains("a ball; .json can express all of it"), "{message}");
        assert!(!message.contains("--leave-out"), "{message}");
    }
}

#[test]
fn through_sdf_and_mjcf_the_robot_stays() {
    let folder = folder("formats");
    let path = |name: &str| folder.join(name).to_str().expect("text").to_string();
    for (robot, told) in
        [("ur5", "cannot express the velocity limits of `shoulder_pan_joint`, "), ("panda", "the velocity limits of")]
    {
        let (sdf, xml, back) = (path("r.sdf"), path("r.xml"), path("back.urdf"));
        let said = |output: std::process::Output| String::from_utf8(output.stderr).expect("text");
        let words = said(common::mozzi(&["convert", robot, &sdf]));
        assert!(!words.contains("cannot express"), "{words}");
        text(&["convert", &sdf, &back]);
        for file in [&sdf, &back] {
            assert!(text(&["compare", robot, file, "--tolerance", "1e-12"]).contains("the same robot"));
        }
        // MJCF has no limits of velocity, which are no difference then
        assert!(said(common::mozzi(&["convert", robot, &xml])).contains(told));
        let (code, message) = complaint(&["convert", robot, &xml, "--strict"]);
        assert!(code == 1 && message.contains("--strict, and it cannot express"), "{message}");
        let report = common::mozzi(&["compare", robot, &xml, "--tolerance", "1e-12", "--json"]);
        assert_eq!(report.status.code(), Some(0));
        let report: serde_json::Value = serde_json::from_slice(&report.stdout).expect("JSON");
        assert_eq!(report["causes"], serde_json::json!([]), "{report}");
        assert!(
            report["notes"].to_string().contains("not held by the format of r.xml: velocity limit of "),
            "{report}"
        );
        assert!(report["differences"]["inverse_dynamics"]["most"].as_f64().expect("a number") < 1e-12);
    }
    let checked = common::mozzi(&["check", &path("r.sdf")]);
    assert!(String::from_utf8_lossy(&checked.stderr).contains("is valid"), "{checked:?}");
    assert!(text(&["explain", "mozzi::sdf::default_inertia"]).contains("1 kg"));
}

#[test]
fn actuators_and_shapes_are_counted_and_standard_output_has_a_format() {
    let folder = folder("omitted");
    let model = "<mujoco><worldbody><body><joint name='j'/><geom size='1'/></body></worldbody>\
                 <actuator><motor joint='j'/><position joint='j'/></actuator></mujoco>";
    let model = file(&folder, "a.xml", model);
    for ending in ["xml", "json", "urdf", "sdf"] {
        let out = folder.join(format!("out.{ending}")).to_str().expect("text").to_string();
        let said = String::from_utf8(common::mozzi(&["convert", &model, &out]).stderr).expect("text");
        assert!(said.contains(&format!("out.{ending} omits the 2 actuators of ")), "{said}");
        assert!(said.contains(&format!("out.{ending} omits the shape of ")), "{said}");
        let out = folder.join(format!("none.{ending}")).to_str().expect("text").to_string();
        let (code, said) = complaint(&["convert", &model, &out, "--strict"]);
        assert!(code == 1 && said.contains("--strict, and it cannot express the 2 actuators of "), "{said}");
    }
    // neither a section that is called <visual> nor a comment is a shape
    let bare = "<mujoco><visual><headlight ambient='1 1 1'/></visual><worldbody><!-- <geom size='1'/> --><body><joint/>\
                <inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/></body></worldbody></mujoco>";
    let bare = file(&folder, "bare.xml", bare);
    let said = common::mozzi(&["convert", &bare, folder.join("bare.urdf").to_str().expect("text")]).stderr;
    assert!(!String::from_utf8_lossy(&said).contains("omits"), "{}", String::from_utf8_lossy(&said));
    let written = |name: &str| std::fs::read_to_string(folder.join(name)).expect("a file");
    for (format, name) in [("sdf", "r.sdf"), ("json", "r.json")] {
        let out = folder.join(name).to_str().expect("text").to_string();
        text(&["convert", "ur5", &out]);
        assert_eq!(text(&["convert", "ur5", "-", "--as", format]), written(name));
    }
}

#[test]
fn strictly_no_drive_of_a_fixed_joint_is_written() {
    let folder = folder("drive_of_a_fixed_joint");
    let robot = file(
        &folder,
        "robot.urdf",
        "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>\
         <transmission name='t'><type>transmission_interface/SimpleTransmission</type><joint name='j'/><actuator name='m'/>\
         </transmission></robot>",
    );
    let out = folder.join("out.urdf").to_str().expect("text").to_string();
    let (code, message) = complaint(&["convert", &robot, &out, "--strict"]);
    let why = "--strict, and <transmission> `t` drives joint `j`, which is fixed";
    assert!(code == 1 && message.contains(why) && !std::path::Path::new(&out).exists(), "{message}");
    text(&["convert", &robot, &out]);
}
