//! A xacro file is expanded when it is read. The result is the same robot as from PyPI's xacro 2.1.1 (`arm.urdf`, next
//! to it). Errors in the robot are reported in the xacro file, with the calls of macros.

use mozzi::model::Severity;
use mozzi_urdf::{Settings, XacroArguments, expanded, load, load_with, model, open, parse};
use std::path::Path;

fn file(name: &str) -> String {
    Path::new("tests/xacro").join(name).to_string_lossy().replace('\\', "/")
}

#[test]
fn the_expansion_is_the_robot() {
    let robot = open(&file("arm.urdf.xacro")).expect("a robot");
    assert!(robot.warnings.is_empty(), "{:?}", robot.warnings);
    let reference = open(&file("arm.urdf")).expect("expanded");
    assert_eq!(robot.description, reference.description);
    assert_eq!(model(file("arm.urdf.xacro")).expect("a robot").n(), 2);
    assert_eq!(robot.description.links[1].inertia.mass, 2.5);
}

const ARM: &str = "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'>
  <xacro:arg name='mass' default='1'/>
  <xacro:macro name='limb' params='name mass'>
    <link name='${name}'>
      <inertial><mass value='${mass}'/>
        <inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>
    </link>
  </xacro:macro>
  <xacro:limb name='base' mass='$(arg mass)'/>
</robot>";

#[test]
fn places_are_in_the_xacro_file_with_the_calls() {
    assert_eq!(parse("arm.xacro", ARM).expect("a robot").description.links[0].inertia.mass, 1.0);
    // also without the ending, by the namespace
    assert!(parse("arm.urdf", ARM).is_ok());
    let values = vec![("mass".to_string(), "-2".to_string())];
    let settings = Settings { xacro: XacroArguments { values, ..XacroArguments::default() }, ..Settings::default() };
    let error = mozzi_urdf::parse_with("arm.xacro", ARM, settings.clone()).expect_err("a negative mass");
    let [found] = error.diagnostics() else { panic!("{error}") };
    assert_eq!(
        found.to_string(),
        "arm.xacro:5:30, from arm.xacro:9 (name = \"base\", mass = -2): error: link `base`: mass: is -2 kg, expected at \
         least 0"
    );
    assert_eq!(found.excerpt(), "${mass}");
    assert!(expanded("arm.xacro", ARM, settings).expect("expanded").is_some_and(|text| text.contains("value=\"-2\"")));
    assert_eq!(expanded("arm.urdf", "<robot/>", Settings::default()).expect("read"), None);
}

#[test]
fn errors_of_the_language_have_a_place() {
    let error = |text: &str| {
        let error = parse("arm.xacro", text).expect_err("refused");
        let [found] = error.diagnostics() else { panic!("{error}") };
        assert_eq!((found.severity(), found.code()), (Severity::Error, "mozzi::urdf::xacro"));
        found.to_string()
    };
    let text = ARM.replace("'${mass}'", "'${maas}'");
    assert_eq!(
        error(&text),
        "arm.xacro:5:32, from arm.xacro:9 (name = \"base\", mass = 1): error: the name `maas` is not defined"
    );
    let unclosed = parse("arm.xacro", ARM.replace("</robot>", "")).expect_err("not XML");
    assert!(unclosed.to_string().contains("mozzi") || unclosed.to_string().contains("<robot> is closed"), "{unclosed}");
    let missing = load_with("tests/xacro/nope.urdf.xacro", Settings::default()).expect_err("missing");
    assert!(missing.to_string().contains("cannot be read"), "{missing}");
    assert!(load(file("arm.urdf.xacro")).is_ok());
}

#[test]
fn words_without_effect_are_warned_of() {
    let text = ARM.replace("default='1'", "default='1' defualt='2'");
    let robot = parse("arm.xacro", text).expect("a robot");
    let [found] = &robot.warnings[..] else { panic!("{:?}", robot.warnings) };
    assert_eq!(found.code(), "mozzi::urdf::xacro_warning");
    assert!(found.to_string().starts_with("arm.xacro:2:4: warning: <xacro:arg> has an attribute `defualt`"), "{found}");
}
