//! Invalid numbers, and numbers out of range.

use super::{refused, warned};
use mozzi_urdf::{Policy, parse_with};

/// A robot of one moving link with this inertial.
fn inertial(text: &str) -> &'static str {
    format!(
        "<robot name='r'>\n<link name='a'/>\n<link name='b'>\n <inertial>{text}</inertial>\n</link>\n\
         <joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint></robot>"
    )
    .leak()
}

const SOUND: &str = "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>";

#[test]
fn no_numbers() {
    let mass = |value: &str| inertial(&format!("<mass value='{value}'/>{SOUND}"));
    let origin = |value: &str| inertial(&format!("<origin xyz='{value}'/><mass value='1'/>{SOUND}"));
    refused(&[
        (mass("§1.0abc"), "not_a_number", "link `b`: inertial: mass: value: is `1.0abc`, expected a number"),
        (mass("§one"), "not_a_number", "link `b`: inertial: mass: value: is `one`, expected a number"),
        (mass("§"), "not_a_number", "link `b`: inertial: mass: value: is empty, expected a number"),
        (mass("  §0x10"), "not_a_number", "link `b`: inertial: mass: value: is `0x10`, expected a number"),
        (
            origin("0\n0.1\t§x"), // read as spaces
            "not_a_number",
            "link `b`: inertial: origin: xyz: is `x`, expected a number",
        ),
        (mass("§NaN"), "not_finite", "link `b`: inertial: mass: value: is `NaN`, expected a finite number"),
        (mass("§-inf"), "not_finite", "link `b`: inertial: mass: value: is `-inf`, expected a finite number"),
        (
            mass("§1e999"),
            "too_large_number",
            "link `b`: inertial: mass: value: is `1e999`, expected a number below 1.8e308",
        ),
        (mass("§1,5"), "decimal_comma", "link `b`: inertial: mass: value: is `1,5`, expected a number"),
        (mass("§${m}"), "xacro", "mass: value: is `${m}`, a xacro expression, expected a file that xacro has expanded"),
        (mass("§1 2"), "wrong_count", "link `b`: inertial: mass: value: `1 2` has 2 numbers, expected 1"),
        (mass("§-1"), "negative_mass", "link `b`: mass: is -1 kg, expected at least 0"),
        (origin("0 0 §0,5"), "decimal_comma", "link `b`: inertial: origin: xyz: is `0,5`, expected a number"),
        (origin("§0 0"), "wrong_count", "link `b`: inertial: origin: xyz: `0 0` has 2 numbers, expected 3"),
        (origin("§0 0 0 0"), "wrong_count", "link `b`: inertial: origin: xyz: `0 0 0 0` has 4 numbers, expected 3"),
        (origin("§"), "wrong_count", "link `b`: inertial: origin: xyz: `` has 0 numbers, expected 3"),
        (origin("0 §nan 0"), "not_finite", "link `b`: inertial: origin: xyz: is `nan`, expected a finite number"),
    ]);
}

#[test]
fn inertias() {
    let inertia = |xx: &str, rest: &str| {
        inertial(&format!("<mass value='1'/><§inertia ixx='{xx}' ixy='0' ixz='0' iyy='1' iyz='0' {rest}/>"))
    };
    refused(&[
        (
            inertia("-1", "izz='1'"),
            "indefinite_inertia",
            "link `b`: inertia: the smallest principal moment about the centre of mass is -1 kg m², expected at least 0",
        ),
        (inertia("1", ""), "missing_attribute", "link `b`: inertial: inertia: has no attribute `izz`"),
    ]);
    let overflow = inertial(&format!("<origin xyz='1e200 0 0'/><mass value='1'/>{}", SOUND.replacen('<', "<§", 1)));
    refused(&[(
        overflow,
        "not_finite",
        "link `b`: inertia: is not finite: mass, centre of mass or a moment is infinite, NaN or too large",
    )]);
    warned(&[
        (
            inertia("1", "izz='3'"),
            "unphysical_inertia",
            "link `b`: inertia: the principal moments about the centre of mass, 1, 1 and 3 kg m², break the triangle inequality: the largest exceeds the sum of the others by 1",
        ),
        (
            inertial(&format!("<mass value='§0'/>{}", SOUND.replace('1', "0"))),
            "massless_leaf",
            "link `b`: mass: joint `j` moves it, but it has no inertia: forward dynamics is undefined",
        ),
    ]);
}

#[test]
fn a_link_is_judged_by_its_body() {
    let text = "<robot name='r'><link name='a'/><link name='b'><inertial><mass value='1'/>\n\
        <inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>\n\
        <link name='c'><inertial><mass value='0.1'/>\n\
        <§inertia ixx='-0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/></inertial></link>\n\
        <joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint>\n\
        <joint name='k' type='fixed'><parent link='b'/><child link='c'/></joint></robot>";
    let message = "link `c`: inertia: the smallest principal moment about the centre of mass is -0.1 kg m², expected \
                   at least 0";
    let sound = format!("{message}; the body that it is part of is positive definite").leak();
    warned(&[(text, "unphysical_inertia", sound)]);
    let light = text.replace("ixx='1'", "ixx='0.01'").replace("iyy='1'", "iyy='0.01'").replace("izz='1'", "izz='0.01'");
    let broken = format!("{message}; the body that it is part of has a negative moment, too").leak();
    refused(&[(light.leak(), "indefinite_inertia", broken)]);
}

#[test]
fn lenient() {
    let inertia = |zz: &str| format!("<mass value='1'/><§inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='{zz}'/>");
    let load = |zz: &str| parse_with("a.urdf", inertial(&inertia(zz)).replace('§', ""), Policy::Lenient);
    for (zz, moments) in [("3", [1.5, 1.5, 3.0]), ("-1", [0.0, 1.5, 1.5])] {
        let robot = load(zz).expect("repaired");
        let [warning] = robot.warnings.as_slice() else { panic!("{:#?}", robot.warnings) };
        assert_eq!((warning.code(), warning.line(), warning.column()), ("mozzi::urdf::repaired_inertia", 4, 30));
        let found = robot.description.links[1].inertia.verdict().principal_moments;
        assert!(found.iter().zip(moments).all(|(found, expected)| (found - expected).abs() < 1e-14), "{found:?}");
        if zz == "3" {
            assert_eq!(
                warning.to_string(),
                "a.urdf:4:30: warning: link `b`: inertia: the principal moments about the centre of mass, 1, 1 and 3 kg m², break the triangle inequality: the largest exceeds the sum of the others by 1; replaced by the nearest physical inertia, with the moments 1.5, 1.5 and 3 kg \
                 m²"
            );
        }
    }
    assert!(load("1").expect("sound").warnings.is_empty());
    let negative = inertial(&inertia("1").replace("value='1'", "value='-1'")).replace('§', "");
    assert!(parse_with("a.urdf", negative, Policy::Lenient).is_err());
}

#[test]
fn a_negative_mass_is_told_whatever_else_is_wrong() {
    let codes = |text: &str| {
        let error = mozzi_urdf::parse("a.urdf", inertial(text)).expect_err("a negative mass");
        error.errors().map(|error| error.to_string()).collect::<Vec<_>>()
    };
    let mass = "a.urdf:4:48: error: link `b`: mass: is -1 kg, expected at least 0";
    let origin = "a.urdf:4:29: error: link `b`: inertial: origin: xyz: is `0,5`, expected a number";
    assert_eq!(codes(&format!("<origin xyz='0 0 0,5'/><mass value='-1'/>{SOUND}")), [origin, mass]);
    let moments = "a.urdf:4:3: error: link `b`: inertial: has no <inertia>";
    assert_eq!(codes("<mass value='-1'/>"), [moments, &mass.replace(":48", ":25")]);
}
