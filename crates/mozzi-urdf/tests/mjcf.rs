//! MuJoCo models: joints, names, couplings and included files.
#![allow(clippy::unwrap_used)]

use mozzi::model::description::JointKind;
use mozzi_urdf::{LoadError, Loaded, Style, load, open, parse};
use std::path::{Path, PathBuf};

fn model(text: &str) -> Loaded {
    parse("a.xml", text).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn joints_of_one_body_act_one_after_the_other() {
    let robot = model(
        "<mujoco model='two'><worldbody><body name='b' pos='0 0 1'><joint name='x' type='slide' axis='2 0 0' range='-1 1'/>\
         <joint axis='0 1 0' pos='0 0 0.5' ref='90' range='0 180' armature='0.1' damping='0.2' frictionloss='0.3'/>\
         <geom size='0.1'/><site name='tip'/><site/></body></worldbody></mujoco>",
    );
    assert!(robot.warnings.is_empty());
    let d = robot.description;
    let names = |list: &[&str]| list.iter().map(ToString::to_string).collect::<Vec<_>>();
    assert_eq!(d.name, "two");
    assert_eq!(d.links.iter().map(|link| link.name.clone()).collect::<Vec<_>>(), names(&["world", "b:x", "b"]));
    assert_eq!(d.joints.iter().map(|joint| joint.name.clone()).collect::<Vec<_>>(), names(&["x", "joint1"]));
    assert_eq!(d.frames.iter().map(|frame| frame.name.clone()).collect::<Vec<_>>(), names(&["tip"]));
    let [x, turn] = d.joints.as_slice() else { panic!("two joints") };
    assert_eq!((x.parent.as_str(), x.child.as_str(), x.kind.name()), ("world", "b:x", "prismatic"));
    assert_eq!((turn.parent.as_str(), turn.child.as_str(), turn.kind.name()), ("b:x", "b", "revolute"));
    assert_eq!(x.limits.position, Some([-1.0, 1.0]));
    assert_eq!(turn.limits.position, Some([0.0, std::f64::consts::PI]));
    assert_eq!((turn.armature, turn.damping, turn.friction), (0.1, 0.2, 0.3));
    // at the position `ref` the body's pose is the one in the file
    let robot = d.build().unwrap();
    let T = robot.forward_kinematics(&[0.0, std::f64::consts::FRAC_PI_2], robot.frame("tip").unwrap()).unwrap();
    assert!((T.p - mozzi::Vec3([0.0, 0.0, 1.0])).norm() < 1e-15, "{T:?}");
}

#[test]
fn what_is_switched_off_is_off() {
    let text = "<mujoco><option gravity='0 0 -1'><flag gravity='disable' passive='disable' constraint='disable'/></option>\
                <worldbody><body><joint name='a' damping='1' stiffness='2' frictionloss='3'/><joint name='b'/><geom size='1'/>\
                </body></worldbody><equality><joint joint1='a' joint2='b'/></equality></mujoco>";
    let robot = model(text);
    assert_eq!((robot.warnings.len(), robot.unused.len()), (0, 1));
    assert_eq!(robot.description.gravity, [0.0; 3]);
    let a = &robot.description.joints[0];
    assert_eq!((a.damping, a.friction, a.stiffness, &a.mimic), (0.0, 0.0, 0.0, &None));
}

#[test]
fn springs_are_read() {
    let text = |spring: &str, flag: &str| {
        format!(
            "<mujoco><compiler angle='degree'/><option><flag {flag}/></option><worldbody><body><joint name='a' axis='0 1 0' \
             stiffness='3' {spring} springref='20' ref='10' damping='0.1' armature='0.02'/><geom size='0.1' pos='0.2 0 0.3'/><body \
             pos='0 0 0.4'><joint name='b' type='slide' axis='1 0 1' stiffness='50' springref='0.1'/><geom size='0.1' pos='0.1 0.1 0'/>\
             </body></body></worldbody></mujoco>"
        )
    };
    let robot = model(&text("", ""));
    assert!(robot.warnings.is_empty(), "{:?}", robot.warnings);
    let springs: Vec<[f64; 2]> =
        robot.description.joints.iter().map(|joint| [joint.stiffness, joint.spring_reference]).collect();
    assert_eq!(springs, [[3.0, 20_f64.to_radians()], [50.0, 0.1]]);
    // mj_inverse, qfrc_spring and energy of MuJoCo 4.0.0 at this state
    let (robot, close) =
        (robot.description.build().unwrap(), |a: f64, b: f64| assert!((a - b).abs() < 1e-8, "{a} {b}"));
    let tau = robot.inverse_dynamics(&[0.5, 0.3], &[0.7, -0.2], &[1.0, 2.0], &robot.environment()).unwrap();
    let f = robot.spring_forces(&[0.5, 0.3]).unwrap();
    for j in 0..2 {
        close(tau[j], [-27.81531112, 36.16492633][j]);
        close(f[j], [0.45280245, 10.0][j]);
    }
    close(robot.potential_energy(&[0.5, 0.3]).unwrap(), 29.81879207);
    // jnt_stiffness and dof_damping that MuJoCo 4.0.0 chooses
    for (given, [k, d]) in [("0.1 1", [112.16518239, 22.43303648]), ("0.3 0.5", [49.85119217, 7.47767883])] {
        let tuned = |flag: &str| model(&text(&format!("springdamper='{given}'"), flag)).description.joints.remove(0);
        close(tuned("").stiffness, k);
        close(tuned("").damping, d);
        assert_eq!((tuned("spring='disable'").stiffness, tuned("damper='disable'").damping), (0.0, 0.0));
    }
}

#[test]
fn couplings_in_a_circle() {
    let text = "<mujoco><worldbody><body><joint name='a'/><joint name='b'/><geom size='1'/></body></worldbody><equality>\
                <joint joint1='a' joint2='b'/><joint joint1='b' joint2='a'/><joint joint1='b' joint2='a'/></equality></mujoco>";
    let code = parse("a.xml", text).unwrap_err().diagnostics()[0].code().to_string();
    assert_eq!(code, "mozzi::mjcf::circular_mimic");
    assert_eq!(
        parse("a.xml", text).unwrap_err().to_string(),
        "a.xml is refused: 2 errors\n\
         a.xml:1:131: error: joint `a`: mimic: following `b` leads back in a circle, expected an independent joint at the end\n\
         a.xml:1:161: error: joint `b`: mimic: following `a` leads back in a circle, expected an independent joint at the end"
    );
}

#[test]
fn deep_trees() {
    let nested =
        |n: usize| format!("<mujoco><worldbody>{}{}</worldbody></mujoco>", "<body>".repeat(n), "</body>".repeat(n));
    assert_eq!(model(&nested(254)).description.links.len(), 255);
    assert_eq!(parse("a.xml", nested(255)).unwrap_err().diagnostics()[0].code(), "mozzi::mjcf::too_deep");
}

/// A folder of this test's own.
fn folder(name: &str, files: &[(&str, &str)]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(folder.join("parts")).unwrap();
    for (file, text) in files {
        std::fs::write(folder.join(file), text).unwrap();
    }
    folder
}

/// Loads the main file of a folder; diagnostics are shown without the folder.
fn main_of(folder: &Path) -> Result<Loaded, String> {
    let tell = |error: LoadError| error.to_string().replace(&*folder.to_string_lossy(), ".");
    load(folder.join("main.xml")).map_err(tell)
}

#[test]
fn included_files_stand_where_they_are_named() {
    let part = "<mujocoinclude><body name='b'><include file='parts/geom.xml'/></body><body name='c'/><include file='near.xml'/></mujocoinclude>";
    let files = [
        (
            "main.xml",
            "<mujoco><worldbody><body name='a'/><include file='parts/b.xml'/><body name='d'/></worldbody></mujoco>",
        ),
        ("parts/b.xml", part),
        ("parts/geom.xml", "<any><geom size='1' mass='2'/><light/></any>"),
        // next to the file that includes it, and not in the main file's folder
        ("parts/near.xml", "<any><body name='e'/></any>"),
    ];
    let folder = folder("included", &files);
    let robot = main_of(&folder).unwrap();
    let names: Vec<&str> = robot.description.links.iter().map(|link| link.name.as_str()).collect();
    assert_eq!(names, ["world", "a", "b", "c", "e", "d"]);
    assert_eq!(robot.description.links[2].inertia.mass, 2.0);
    assert!(robot.description.joints.iter().all(|joint| joint.kind == JointKind::Fixed));
    let [light] = robot.unused.as_slice() else { panic!("{:?}", robot.unused) };
    assert!(light.file().ends_with("geom.xml") && light.line() == 1 && light.column() == 32, "{light}");
    assert!(open(&folder.join("main.xml").to_string_lossy()).is_ok());
}

#[test]
fn wrong_includes() {
    let main = "<mujoco>\n<include file='parts/a.xml'/></mujoco>";
    let cases = [
        (
            "missing",
            "<x><include file='no.xml'/></x>",
            "./parts/a.xml:1:19: error: include: `no.xml` cannot be read: No such file or directory (os error 2)",
        ),
        (
            "cycle",
            "<x><include file='parts/../parts/a.xml'/></x>",
            "./parts/a.xml:1:19: error: include: `parts/../parts/a.xml` is already included, expected at most once",
        ),
        (
            "main_again",
            "<x><include file='main.xml'/></x>",
            "./parts/a.xml:1:19: error: include: `main.xml` is already included, expected at most once",
        ),
        (
            "folder",
            "<x><include file='parts'/></x>",
            "./parts/a.xml:1:19: error: include: `parts` cannot be read: it is not a file",
        ),
        (
            "network",
            "<x><include file='https://x.org/a.xml'/></x>",
            "./parts/a.xml:1:19: error: include: `https://x.org/a.xml` is not on this machine, expected a file",
        ),
        ("syntax", "<mujoco>\n<body", "./parts/a.xml:2:1: error: the file ends inside a tag that opens here"),
        ("empty", "", "./parts/a.xml:1:1: error: the file is empty, expected a <mujoco>"),
        (
            "content",
            "<mujoco>\n <worldbody><bodi/></worldbody></mujoco>",
            "./parts/a.xml:2:14: error: worldbody: has an element <bodi>, which MJCF does not define here",
        ),
    ];
    for (name, part, message) in cases {
        let folder = folder(name, &[("main.xml", main), ("parts/a.xml", part)]);
        let code = load(folder.join("main.xml")).unwrap_err().diagnostics()[0].code().to_string();
        if message.contains("already") {
            assert_eq!(code, "mozzi::mjcf::repeated_include");
        }
        assert_eq!(main_of(&folder).unwrap_err(), format!("./main.xml is refused: 1 error\n{message}"));
    }
    let folder = folder("not_utf8", &[("main.xml", main)]);
    std::fs::write(folder.join("parts/a.xml"), b"<x>\n\xff</x>").unwrap();
    assert_eq!(
        main_of(&folder).unwrap_err(),
        "./main.xml is refused: 1 error\n./parts/a.xml:2:1: error: byte 4 of the file is 0xff, which is not UTF-8"
    );
}

#[test]
fn an_include_shows_no_lines_of_other_files() {
    let main = "<mujoco>\n<include file='secret'/></mujoco>";
    let secrets: [&[u8]; 6] = [
        b"root:x:0:0:hunter2:/root:/bin/sh\nalice:x:1000:hunter2\n",
        b"<config>\n  <password>hunter2</password>\n</config>",
        b"<config user='hunter2'>\n  <joint name='hunter2' <</config>",
        b"key = hunter2\n<!-- hunter2 -->\n<login password='hunter2'/>",
        b"hunter2 \xff hunter2",
        b"<x>\n<worldbody><body name='hunter2'><joint type='hunter2' axis='hunter2'/></body></worldbody></x>",
    ];
    for secret in secrets {
        let folder = folder("secret", &[("main.xml", main)]);
        std::fs::write(folder.join("secret"), secret).unwrap();
        // an unknown element is a warning, everything else an error
        let diagnostics = match load(folder.join("main.xml")) {
            Ok(loaded) => loaded.warnings,
            Err(error) => error.diagnostics().to_vec(),
        };
        assert!(!diagnostics.is_empty());
        for diagnostic in diagnostics {
            let found = format!("{diagnostic}\n{}{:?}", diagnostic.pretty(Style::Unicode), diagnostic.help());
            assert!(!found.contains("hunter2") && found.contains("secret:"), "{found}");
            assert!(!diagnostic.excerpt().contains("hunter2"));
        }
    }
    // lines of an included model are shown
    let part = "<mujocoinclude>\n<worldbody><bodi/></worldbody></mujocoinclude>";
    let folder = folder("own", &[("main.xml", main), ("secret", part)]);
    assert!(load(folder.join("main.xml")).unwrap_err().pretty(Style::Unicode).contains("<worldbody><bodi/>"));
}
