//! SDFormat: what it means, by Drake and by second ways of writing the same robot.

use mozzi::model::description::JointKind;
use mozzi::random::Random;
use mozzi::{Base, Description, Model, SE3};
use mozzi_urdf::{LoadError, Loaded, Policy, load, load_with, parse, parse_with};
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

fn model_file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/sdf/models").join(name)
}

fn read(text: &str) -> Loaded {
    parse("r.sdf", text).unwrap_or_else(|error| panic!("{error}"))
}

const BODY: &str = "<inertial><pose>0.1 0.2 0.3 0 0 0</pose><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.2</iyy><izz>0.25</izz>\
     <ixy>0.01</ixy><ixz>0.02</ixz><iyz>0.03</iyz></inertia></inertial>";

/// A body on a joint, with more elements in the joint.
fn one(version: &str, kind: &str, more: &str) -> String {
    format!(
        "<sdf version='{version}'><model name='r'><link name='a'>{BODY}</link><link name='b'><pose>0.1 0 0.2 0.1 0.2 0.3</pose>{BODY}\
         </link><joint name='m' type='fixed'><parent>world</parent><child>a</child></joint><joint name='j' type='{kind}'>\
         <parent>a</parent><child>b</child>{more}</joint></model></sdf>"
    )
}

/// The robot with independent mimic joints, and states of its joints of one axis.
fn freed(robot: &Description) -> Model {
    let mut robot = robot.clone();
    robot.joints.iter_mut().for_each(|joint| joint.mimic = None);
    (robot.states, robot.start) = (Vec::new(), None);
    robot.build().unwrap()
}

/// What Drake is asked: the joints by name, model and place in the joint, and 100 states.
fn question(path: &Path, robot: &Description, instance: &str) -> Value {
    let model = freed(robot);
    let joints: Vec<Value> = model
        .joint_names()
        .map(|name| {
            let parts = [(".axis2", 1), (".axis", 0), (".x", 0), (".y", 1), (".theta", 2)];
            let (name, part) = parts
                .into_iter()
                .find_map(|(ending, part)| Some((name.strip_suffix(ending)?, part)))
                .unwrap_or((name, 0));
            let (scope, name) = name
                .rsplit_once("::")
                .map_or((instance.to_string(), name), |(scope, name)| (format!("{instance}::{scope}"), name));
            json!([name, scope, part])
        })
        .collect();
    let mut random = Random(7);
    let n = joints.len();
    let state = |_| json!({ "theta": random.vector(n, 1.0), "dtheta": random.vector(n, 1.0) });
    json!({ "path": path, "joints": joints, "states": (0..100).map(state).collect::<Vec<Value>>() })
}

/// Drake's answers; None, with a note, if there is no Drake.
fn drake(questions: &[Value]) -> Option<Vec<Value>> {
    let Some(python) = std::env::var_os("MOZZI_PYTHON") else {
        println!("skipped: MOZZI_PYTHON names no Python");
        return None;
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/sdf/by_drake.py");
    let mut child = Command::new(python)
        .arg(script)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // without Drake it does not read
    let _ = child.stdin.take().unwrap().write_all(json!(questions).to_string().as_bytes());
    let output = child.wait_with_output().unwrap();
    if output.status.success() {
        return Some(serde_json::from_slice(&output.stdout).unwrap());
    }
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(message.contains("No module named 'pydrake'"), "{message}");
    println!("skipped: MOZZI_PYTHON has no Drake (`pip install drake`)");
    None
}

fn list(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

/// The largest difference of masses, M and h, as a part of the largest number.
fn error(robot: &Description, question: &Value, answer: &Value) -> f64 {
    let model = freed(robot);
    let base = if model.is_floating() { 6 } else { 0 };
    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let gap = |a: &[f64], b: &[f64]| {
        assert_eq!(a.len(), b.len());
        let differences: Vec<f64> = a.iter().zip(b).map(|(x, y)| x - y).collect();
        if largest(b) == 0.0 { largest(&differences) } else { largest(&differences) / largest(b) }
    };
    let mut masses: Vec<f64> = robot.links.iter().map(|link| link.inertia.mass).filter(|mass| *mass != 0.0).collect();
    masses.sort_by(f64::total_cmp);
    let theirs: Vec<f64> = list(&answer["masses"]).into_iter().filter(|mass| *mass != 0.0).collect();
    let mut worst = gap(&masses, &theirs);
    for (k, state) in question["states"].as_array().unwrap().iter().enumerate() {
        let mut theta = model.neutral_configuration::<f64>();
        let start = theta.len() - list(&state["theta"]).len();
        theta[start..].copy_from_slice(&list(&state["theta"]));
        let dtheta = [vec![0.0; base], list(&state["dtheta"])].concat();
        let M = model.mass_matrix(&theta).unwrap();
        let h = model.bias_forces(&theta, &dtheta, &model.environment()).unwrap();
        let n = M.nrows() - base;
        let own = M.view((base, base), (n, n)).transpose();
        worst = worst.max(gap(own.as_slice(), &list(&answer["M"][k])));
        worst = worst.max(gap(&h.as_slice()[base..], &list(&answer["h"][k])));
    }
    worst
}

#[test]
fn models_have_the_masses_and_dynamics_of_drake() {
    let names = ["frames", "model_axes", "joint_axes", "nested", "several_axes", "free"];
    let robots: Vec<(PathBuf, Description)> = (names.iter().map(|name| model_file(&format!("{name}.sdf"))))
        .map(|path| {
            (path.clone(), load_with(&path, Policy::Strict).unwrap_or_else(|error| panic!("{error}")).description)
        })
        .collect();
    let questions: Vec<Value> = robots.iter().map(|(path, robot)| question(path, robot, &robot.name)).collect();
    let Some(answers) = drake(&questions) else { return };
    for (((path, robot), question), answer) in robots.iter().zip(&questions).zip(&answers) {
        let error = error(robot, question, answer);
        println!("{}: {error:.1e}", path.display());
        assert!(error < 1e-12, "{}: {error:e}", path.display());
    }
}

/// Robots of example-robot-data as SDFormat, read by Drake: those whose inertias Drake accepts.
#[test]
fn converted_robots_have_the_masses_and_dynamics_of_drake() {
    let Some(robots) = std::env::var_os("MOZZI_ROBOTS") else {
        return println!("skipped: MOZZI_ROBOTS does not name the folder of example-robot-data");
    };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("sdf");
    std::fs::create_dir_all(&folder).unwrap();
    let (mut asked, mut questions, mut paths) = (Vec::new(), Vec::new(), Vec::new());
    crate::files::urdf_files(Path::new(&robots), &mut paths);
    paths.sort();
    for (i, path) in paths.into_iter().enumerate() {
        let Ok(loaded) = load(&path) else { continue };
        // Drake replaces inertias that no body can have
        let is_sound = |link: &mozzi::model::description::Link| {
            let [a, b, c] = link.inertia.verdict().principal_moments;
            link.inertia == mozzi::SpatialInertia::zero()
                || link.inertia.mass > 0.0 && a > 0.0 && a + b >= c * (1.0 - 1e-6)
        };
        if !loaded.description.links.iter().all(is_sound) || freed(&loaded.description).n() == 0 {
            continue;
        }
        let written = mozzi_urdf::sdf::write(&loaded.description).unwrap_or_else(|error| panic!("{error}"));
        let file = folder.join(format!("{i}.sdf"));
        std::fs::write(&file, written.text).unwrap();
        let robot = load(&file).unwrap_or_else(|error| panic!("{}: {error}", path.display())).description;
        questions.push(question(&file, &robot, &robot.name));
        asked.push((path, robot));
    }
    let Some(answers) = drake(&questions) else { return };
    let errors: Vec<f64> =
        asked.iter().zip(&questions).zip(&answers).map(|(((_, robot), q), answer)| error(robot, q, answer)).collect();
    for ((path, _), error) in asked.iter().zip(&errors) {
        assert!(*error < 1e-12, "{}: {error:e}", path.display());
    }
    println!("{} robots, worst {:.1e}", errors.len(), errors.iter().fold(0.0_f64, |m, x| m.max(*x)));
    assert!(errors.len() >= 20, "{}", errors.len());
}

#[test]
fn both_pitches_are_the_travel_per_turn_of_the_same_screw() {
    let axis = "<axis><xyz>0 0.6 0.8</xyz></axis>";
    let new = read(&one("1.10", "screw", &format!("{axis}<screw_thread_pitch>0.05</screw_thread_pitch>")));
    let turns = -std::f64::consts::TAU / 0.05;
    let old = read(&one("1.9", "screw", &format!("{axis}<thread_pitch>{turns:?}</thread_pitch>")));
    let [new, old] = [new, old].map(|robot| robot.description.joints[1].kind);
    let (JointKind::Screw(new), JointKind::Screw(old)) = (new, old) else { panic!("two screws") };
    assert!((new.pitch() - 0.05 / std::f64::consts::TAU).abs() < 1e-15 && (new.pitch() - old.pitch()).abs() < 1e-15);
    // a right-handed thread: a positive turn moves along the axis
    let moved = SE3::exp(new.twist() * std::f64::consts::TAU).p;
    assert!((moved - mozzi::Vec3([0.0, 0.03, 0.04])).norm() < 1e-15, "{moved:?}");
}

#[test]
fn mimic_limits_friction_and_springs_are_read() {
    let text = one(
        "1.11",
        "revolute",
        "<axis><xyz>0 0 1</xyz><limit><lower>-1e16</lower><upper>1.5</upper><effort>-1</effort><velocity>2</velocity></limit>\
         <dynamics><damping>0.1</damping><friction>0.2</friction><spring_reference>0.3</spring_reference>\
         <spring_stiffness>4</spring_stiffness></dynamics></axis>",
    );
    let follower = "<link name='c'><pose relative_to='b'/><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz>\
         </inertia></inertial></link><joint name='k' type='prismatic'><parent>b</parent><child>c</child><axis><xyz>0 0 1</xyz>\
         <mimic joint='j' axis='axis'><multiplier>2</multiplier><offset>0.5</offset><reference>0.1</reference></mimic></axis>\
         </joint></model>";
    let robot = read(&text.replace("</model>", follower)).description;
    let joint = &robot.joints[1];
    assert_eq!(
        (joint.limits.position, joint.limits.effort, joint.limits.velocity),
        (Some([-f64::MAX, 1.5]), None, Some(2.0))
    );
    assert_eq!((joint.damping, joint.friction, joint.spring_reference, joint.stiffness), (0.1, 0.2, 0.3, 4.0));
    let mimic = robot.joints[2].mimic.as_ref().unwrap();
    // 2 (θ − 0.1) + 0.5
    assert_eq!((mimic.joint.as_str(), mimic.ratio, mimic.offset), ("j", 2.0, 0.3));
    // Drake reads no <mimic>
    let written = mozzi_urdf::sdf::write(&robot).unwrap().text;
    let (before, after) = (written.find("<mimic").unwrap(), written.find("</mimic>").unwrap());
    let of_drake = read(&format!("{}{}", &written[..before], &written[after + "</mimic>".len()..]));
    assert_eq!(of_drake.description.joints[2].mimic, robot.joints[2].mimic);
}

#[test]
fn a_ball_has_drakes_damping_and_the_center_of_its_pose() {
    let more = "<pose>0.1 0.2 0.3 0 0 0</pose><axis><xyz>0 0 1</xyz><dynamics><damping>0.7</damping></dynamics></axis>";
    let joint = read(&one("1.9", "ball", more)).description.joints.remove(1);
    assert_eq!((joint.kind, joint.damping), (JointKind::Ball(mozzi::Vec3([0.1, 0.2, 0.3])), 0.7));
}

#[test]
fn worlds_bases_and_starts() {
    let model = |name: &str, more: &str| {
        format!("<model name='{name}'>{more}<link name='l'><pose>0 0 1 0 0 0</pose>{BODY}</link></model>")
    };
    let world = |inside: String| format!("<sdf version='1.9'><world name='w'>{inside}</world></sdf>");
    let floor = model("floor", "<static>true</static>");
    // one free model: a floating base, where the file places it
    let one = read(&world(format!("<gravity>0 0 -1.62</gravity>{floor}{}", model("r", "<pose>1 0 0 0 0 0</pose>"))));
    assert_eq!((one.description.base, one.description.gravity), (Base::Floating, [0.0, 0.0, -1.62]));
    assert_eq!(one.description.states[0].base.unwrap().pose, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0]);
    assert_eq!(one.unused.len(), 1, "the floor");
    // two: free joints of the world, whose names have the models' names
    let two = read(&world(format!("{}{}", model("r", ""), model("s", "<pose>0 2 0 0 0 0</pose>")))).description;
    assert_eq!(two.joints.iter().map(|joint| joint.name.as_str()).collect::<Vec<_>>(), ["r::l:free", "s::l:free"]);
    assert_eq!(two.states[0].joints[1].positions, [1.0, 0.0, 0.0, 0.0, 0.0, 2.0, 1.0]);
    assert_eq!(two.gravity, [0.0, 0.0, -9.8], "SDFormat's");
    // a world's joint fixes a model
    let fixed = "<joint name='weld' type='fixed'><parent>world</parent><child>r::l</child></joint>";
    let fixed = read(&world(format!("{}{fixed}", model("r", "")))).description;
    assert_eq!(
        (fixed.base, fixed.links[0].name.as_str(), fixed.joints[0].parent.as_str()),
        (Base::Fixed, "world", "world")
    );
}

#[test]
fn what_a_link_does_not_give_is_sdformats_with_a_warning() {
    let robot = read(&one("1.9", "revolute", "<axis><xyz>0 0 1</xyz></axis>").replacen(BODY, "", 1));
    assert_eq!(robot.warnings[0].code(), "mozzi::sdf::default_inertia");
    assert_eq!(robot.description.links[1].inertia.mass, 1.0);
    assert!(parse_with("r.sdf", one("1.9", "revolute", "<axis><xyz>0 0 1</xyz></axis>"), Policy::Strict).is_ok());
}

#[test]
fn files_that_include_themselves_end() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("sdf_loop");
    std::fs::create_dir_all(&folder).unwrap();
    let text = "<sdf version='1.9'><model name='m'><link name='l'/><include><uri>loop.sdf</uri><name>n</name></include>\
         <include><uri>loop.sdf</uri><name>k</name></include></model></sdf>";
    std::fs::write(folder.join("loop.sdf"), text).unwrap();
    let error = load(folder.join("loop.sdf")).unwrap_err();
    assert!(error.errors().any(|error| error.code() == "mozzi::sdf::too_large"), "{error}");
}

#[test]
fn long_chains_of_frames_are_followed() {
    let frames: String = (1..20_000)
        .map(|k| format!("<frame name='f{k}'><pose relative_to='f{}'>0 0 0.001 0 0 0</pose></frame>", k - 1))
        .collect();
    let text = format!(
        "<sdf version='1.9'><model name='m'><link name='l'>{BODY}</link><frame name='f0'/>{frames}</model></sdf>"
    );
    let robot = read(&text).description;
    assert!((robot.frames.last().unwrap().T.p.0[2] - 19.999).abs() < 1e-9);
}

#[test]
fn a_folder_is_the_model_in_it() {
    let text = std::fs::read_to_string(model_file("nested.sdf")).unwrap();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("sdf_folder");
    std::fs::create_dir_all(folder.join("part")).unwrap();
    std::fs::copy(model_file("part/model.sdf"), folder.join("part/model-1.7.sdf")).unwrap();
    // the newest, wherever it stands
    let config =
        "<model><name>part</name><sdf version='1.7'>model-1.7.sdf</sdf><sdf version='1.4'>old.sdf</sdf></model>";
    std::fs::write(folder.join("part/old.sdf"), one("1.4", "fixed", "")).unwrap();
    std::fs::write(folder.join("part/model.config"), config).unwrap();
    for uri in ["model://part", "part", "part/model-1.7.sdf"] {
        std::fs::write(folder.join("nested.sdf"), text.replace("model://part/model.sdf", uri)).unwrap();
        let read = [model_file("nested.sdf"), folder.join("nested.sdf")].map(|path| load(path).unwrap().description);
        assert_eq!(read[0], read[1], "{uri}");
    }
}

/// The errors with their remedies.
fn said(text: &str) -> String {
    let Err(LoadError::Refused { diagnostics, .. }) = parse("r.sdf", text) else { panic!("accepted: {text}") };
    diagnostics.iter().map(|found| format!("{found} {:?}\n", found.help())).collect()
}

/// Link b at 0.5 m on link a, by an attribute of its pose, and an axis along z in the attributes of `xyz`.
fn placed(version: &str, attribute: &str, axis: &str) -> String {
    format!(
        "<sdf version='{version}'><model name='r'><link name='a'><pose>1 0 0 0 0 0</pose>{BODY}</link><link name='b'>\
         <pose {attribute}>0.5 0 0 1.5707963267948966 0 0</pose>{BODY}</link><joint name='j' type='revolute'>\
         <parent>a</parent><child>b</child><axis>{axis}</axis></joint></model></sdf>"
    )
}

#[test]
fn words_of_other_versions_are_read_or_refused() {
    const Z: &str = "<xyz>0 0 1</xyz>";
    for (version, attribute) in [("1.6", "relative_to='a'"), ("1.6", "frame='a'"), ("1.9", "relative_to='a'")] {
        let robot = read(&placed(version, attribute, Z)).description;
        let joint = robot.joints.iter().find(|joint| joint.name == "j").unwrap();
        assert!((joint.origin.p.0[0] - 0.5).abs() < 1e-12, "{version} {attribute}: {:?}", joint.origin);
    }
    let axis_of = |version: &str, axis: &str| {
        let robot = read(&placed(version, "", axis)).description;
        let joint = robot.joints.into_iter().find(|joint| joint.name == "j").unwrap();
        let JointKind::Screw(axis) = joint.kind else { panic!("{:?}", joint.kind) };
        axis.twist().w.0
    };
    let in_model = "<xyz expressed_in='__model__'>0 0 1</xyz>";
    for version in ["1.6", "1.8"] {
        assert!((axis_of(version, in_model)[1] - 1.0).abs() < 1e-12, "{version}: {:?}", axis_of(version, in_model));
        assert!((axis_of(version, Z)[2] - 1.0).abs() < 1e-12);
    }
    let words = said(&placed("1.9", "frame='a'", Z));
    assert!(words.contains("frame=\"a\" is of versions before 1.7") && words.contains("relative_to"), "{words}");
    let words = said(&placed("1.8", "", &format!("{Z}<use_parent_model_frame>1</use_parent_model_frame>")));
    assert!(words.contains("use_parent_model_frame is of versions before 1.7"), "{words}");
}

#[test]
fn degrees_and_static_models_are_named() {
    let degrees = placed("1.9", "", "<xyz>0 0 1</xyz>").replace("1.5707963267948966", "90");
    let warnings: Vec<String> = read(&degrees).warnings.iter().map(ToString::to_string).collect();
    assert!(warnings.iter().any(|text| text.contains("an angle of 90 radians: in degrees?")), "{warnings:?}");
    let table = "<model name='table'><static>true</static><link name='top'/></model>";
    let arm = |part: &str| {
        format!(
            "<sdf version='1.9'><world name='w'>{table}<model name='arm'>{part}<link name='a'>{BODY}</link><link name='b'>\
             {BODY}</link><joint name='j' type='revolute'><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis>\
             </joint></model></world></sdf>"
        )
    };
    read(&arm(""));
    let words = said(&arm("<pose relative_to='table::top'/>"));
    assert!(words.contains("`table` is static, and static models are not read"), "{words}");
    let words = said(&format!("<sdf version='1.9'>{table}</sdf>"));
    assert!(words.contains("`table` is static, fixed in the world: delete its <static>"), "{words}");
}

#[test]
fn written_names_are_not_sdformats_own() {
    let moon = Description {
        name: "world".into(),
        ..read(&one("1.9", "revolute", "<axis><xyz>0 0 1</xyz></axis>")).description
    };
    let written = mozzi_urdf::sdf::write(&moon.with_gravity([0.0, 0.0, -1.62])).unwrap();
    assert!(written.text.contains("<world name=\"default\">") && written.text.contains("<model name=\"robot\">"));
    assert!(written.losses.iter().any(|loss| loss.contains("`world` → `robot`")), "{:?}", written.losses);
    assert_eq!(written.remarks, ["Drake ignores the gravity of a file: set [0.0, 0.0, -1.62] in the program"]);
}
