//! `<attach>`: names, settings and defaults of the attached model, and what is refused. Its numbers are compared with
//! MuJoCo's by `oracles/test_attach.xml`.

use mozzi_urdf::geometry::geometry;
use mozzi_urdf::load;

const ARM: &str = "<mujoco>\n<compiler angle='degree' meshdir='shapes'/>\n<default><joint armature='0.5'/>\
    <default class='soft'><joint damping='2'/></default></default>\n\
    <asset><mesh file='box.stl'/></asset>\n<worldbody><body name='a' childclass='soft'>\n<joint name='j' range='-90 90'/>\
    <geom size='0.1'/><geom type='mesh' mesh='box' mass='0'/>\n<body name='b'><joint name='k' axis='1 0 0'/>\
    <geom size='0.1'/></body></body></worldbody>\n<equality><joint joint1='k' joint2='j'/></equality>\n\
    <keyframe><key name='home' qpos='1'/></keyframe></mujoco>";

/// Writes files into a folder; their paths.
fn folder(name: &str, files: &[(&str, &str)]) -> Vec<String> {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(folder.join("parts")).unwrap();
    let written = files.iter().map(|(file, text)| {
        std::fs::write(folder.join(file), text).unwrap();
        folder.join(file).to_string_lossy().into_owned()
    });
    written.collect()
}

/// A scene in `main.xml` beside `parts/arm.xml`.
fn scene(name: &str, attach: &str, arm: &str) -> String {
    let main = format!(
        "<mujoco>\n<compiler angle='radian'/><default><joint armature='7' frictionloss='7'/></default>\n\
         <asset><model name='arm' file='parts/arm.xml'/></asset>\n<worldbody>\n{attach}</worldbody></mujoco>"
    );
    folder(&format!("attach_{name}"), &[("main.xml", &main), ("parts/arm.xml", arm)]).remove(0)
}

/// The first error of a scene, without its folder.
fn refused(name: &str, attach: &str, arm: &str) -> String {
    let file = scene(name, attach, arm);
    let folder = file.strip_suffix("/main.xml").expect("a folder").to_string();
    load(&file).expect_err(name).diagnostics()[0].to_string().replace(&folder, ".")
}

#[test]
fn a_part_keeps_its_models_settings() {
    let twice =
        "<attach model='arm' body='a' prefix='l_'/>\n<frame pos='0 0 2'><attach model='arm' prefix='r_'/></frame>";
    let file = scene("twice", twice, ARM);
    let robot = load(&file).unwrap();
    let d = &robot.description;
    assert_eq!(d.joints.iter().map(|joint| &*joint.name).collect::<Vec<_>>(), ["l_j", "l_k", "r_j", "r_k"]);
    assert_eq!(d.links.iter().map(|link| &*link.name).collect::<Vec<_>>(), ["world", "l_a", "l_b", "r_a", "r_b"]);
    for joint in &d.joints {
        assert_eq!((joint.armature, joint.damping, joint.friction), (0.5, 2.0, 0.0), "{}", joint.name);
    }
    let quarter = std::f64::consts::FRAC_PI_2;
    assert_eq!(d.joints[2].limits.position, Some([-quarter, quarter]));
    assert_eq!(d.joints[2].origin.p.0, [0.0, 0.0, 2.0]);
    let source = |k: usize| d.joints[k].mimic.as_ref().map(|mimic| &*mimic.joint);
    assert_eq!([source(1), source(3)], [Some("l_j"), Some("r_j")]);
    let unused: Vec<&str> = robot.unused.iter().map(|one| one.message()).collect();
    assert!(unused.iter().any(|message| message.contains("keyframe")), "{unused:?}");
    let shapes = format!("{:?}", geometry(&file).unwrap().shapes);
    assert_eq!(shapes.matches("parts/shapes/box.stl").count(), 2, "{shapes}");
}

#[test]
fn an_equality_with_what_is_not_attached_is_left_out() {
    let robot = load(scene("part", "<attach model='arm' body='b' prefix='x_'/>", ARM)).unwrap();
    let [joint] = robot.description.joints.as_slice() else { panic!("one joint") };
    assert!(joint.name == "x_k" && joint.mimic.is_none() && joint.damping == 2.0, "{joint:?}");
}

#[test]
fn a_model_without_name_has_the_name_in_its_file() {
    let part = |model: &str, joint: &str| {
        let body = format!("<body name='b'><joint name='{joint}'/><geom size='0.1'/></body>");
        format!("<mujoco{model}><worldbody>{body}</worldbody></mujoco>")
    };
    let main = |name: &str| {
        let models = "<model file='parts/x.xml'/><model file='parts/y.xml'/><model name='z' file='parts/z.xml'/>";
        let attach = format!("<attach model='{name}' body='b' prefix='p_'/>");
        format!("<mujoco><asset>{models}</asset><worldbody>{attach}</worldbody></mujoco>")
    };
    let open = |name: &str| {
        let parts = [part(" model='y'", "in_x"), part("", "in_y"), part(" model='w'", "in_z")];
        let [x, y, z] = parts.each_ref().map(String::as_str);
        let files = [("main.xml", &*main(name)), ("parts/x.xml", x), ("parts/y.xml", y), ("parts/z.xml", z)];
        load(&folder("attach_names", &files)[0]).map(|robot| robot.description.joints[0].name.clone())
    };
    for (name, joint) in [("y", "p_in_x"), ("MuJoCo Model", "p_in_y"), ("z", "p_in_z")] {
        assert_eq!(open(name).expect(name), joint, "{name}");
    }
    for name in ["x", "w"] {
        let why = open(name).expect_err(name);
        assert!(why.to_string().contains(&format!("there is no model `{name}` in <asset>")), "{why}");
    }
    let why = open("parts").expect_err("unknown");
    let help = why.diagnostics()[0].help();
    assert!(help.is_some_and(|help| help.ends_with("the models are `MuJoCo Model`, `y`, `z`")), "{help:?}");
}

#[test]
fn a_frame_is_attached_with_its_pose_and_its_contents() {
    let framed = ARM
        .replace("<body name='b'>", "<frame name='f' pos='0 0 3'><body name='b'>")
        .replace("</body></body>", "</body></frame></body>");
    let robot = load(scene("frame", "<attach model='arm' frame='f' prefix='x_'/>", &framed)).unwrap();
    let [joint] = robot.description.joints.as_slice() else { panic!("one joint") };
    assert_eq!((&*joint.name, joint.damping, joint.origin.p.0), ("x_k", 2.0, [0.0, 0.0, 3.0]));
}

#[test]
fn what_cannot_be_attached_is_named() {
    let body = "<attach model='arm' body='a' prefix='x_'/>";
    let cases = [
        (
            "model",
            "<attach model='arn' prefix='x_'/>",
            ARM,
            "5:2: error: attach: model: there is no model `arn` in <asset>",
        ),
        ("body", "<attach model='arm' body='c'/>", ARM, "5:2: error: attach: body: its model has no body `c`"),
        (
            "frame",
            "<attach model='arm' frame='world'/>",
            ARM,
            "5:2: error: attach: frame: its model has no frame `world`",
        ),
        (
            "both",
            "<attach model='arm' body='a' frame='f'/>",
            ARM,
            "attach: has a `body` and a `frame`, expected at most one",
        ),
        (
            "word",
            "<attach model='arm' prefx='x_'/>",
            ARM,
            "5:21: error: attach: has an attribute `prefx`, expected one of",
        ),
        ("twice", "<attach model='arm'/><attach model='arm'/>", ARM, "the name is used twice"),
        ("root", body, "<robot name='r'/>", "the root element of its model is <robot>, expected <mujoco>"),
        ("nested", body, "<mujoco><worldbody><include file='x.xml'/></worldbody></mujoco>", "its model has <include>"),
    ];
    for (name, attach, arm, expected) in cases {
        let found = refused(name, attach, arm);
        assert!(found.contains(expected), "{name}: {found}");
    }
    let number = refused("number", body, &ARM.replace("-90 90", "-90 x"));
    assert!(number.starts_with("./parts/arm.xml:6:") && number.contains("range: is `x`"), "{number}");
}

#[test]
fn an_attached_file_is_not_edited() {
    let file = scene("edited", "<attach model='arm' body='a' prefix='x_'/>", ARM);
    let mut robot = load(&file).unwrap().description;
    robot.joints[0].damping = 5.0;
    let text = std::fs::read_to_string(&file).unwrap();
    let why = mozzi_urdf::edit_files(&file, &text, &robot, false, &mozzi_urdf::Settings::default())
        .expect_err("refused")
        .to_string();
    assert!(why.contains("a part of") && why.contains("is attached"), "{why}");
}
