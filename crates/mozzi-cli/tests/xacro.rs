//! `mozzi xacro`, and robots that are xacro files in every command.

use crate::common;

use common::{assert_close, complaint, file, folder, json, mozzi, rows, text};
use std::path::Path;

const ROBOT: &str = include_str!("../../mozzi-xacro/tests/arm/arm.urdf.xacro");
const ROD: &str = include_str!("../../mozzi-xacro/tests/arm/rod.xacro");

/// The robot's file, and the flag with its package.
fn arm(folder: &Path) -> (String, String) {
    std::fs::create_dir_all(folder.join("of rods")).expect("a folder");
    file(&folder.join("of rods"), "rod.xacro", ROD);
    (file(folder, "arm.urdf.xacro", ROBOT), format!("--package=rods={}", folder.join("of rods").display()))
}

#[test]
fn an_expansion_is_the_robot_that_every_command_opens() {
    let folder = folder("xacro-expansion");
    let (robot, package) = arm(&folder);
    let printed = text(&["xacro", &robot, "length:=0.9", &package]);
    assert!(printed.contains("<joint name=\"rod_pivot\" type=\"continuous\">"), "{printed}");
    assert!(printed.contains("xyz=\"0 0 -0.45\""), "{printed}");
    let out = folder.join("out.urdf").display().to_string();
    assert_eq!(text(&["xacro", &robot, "length:=0.9", &package, "-o", &out]), "");
    assert_eq!(std::fs::read_to_string(&out).expect("written"), printed);
    for (model, flags) in [(&out, &[][..]), (&robot, &["--xacro-arg", "length:=0.9", &package])] {
        let compute = [&["compute", model, "mass-matrix", "--theta", "0.3"], flags].concat();
        let M = rows(&json(&compute)["M"]);
        assert_close(&M[0], &[2.0 * 0.9 * 0.9 / 3.0], 1e-14);
        text(&[&["info", model], flags].concat());
        text(&[&["check", model], flags].concat());
        text(&[&["simulate", model, "--theta", "0.3", "--time", "0.1", "--step", "0.01"], flags].concat());
    }
}

#[test]
fn arguments_that_no_file_reads_are_told() {
    let folder = folder("xacro-arguments");
    let (robot, package) = arm(&folder);
    let said = String::from_utf8(mozzi(&["xacro", &robot, "bogus:=1", &package]).stderr).expect("text");
    assert!(said.contains("the argument `bogus` is given and not used"), "{said}");
}

#[test]
fn packages_of_one_name_are_told() {
    let folder = folder("xacro-packages");
    let make = |at: &str, mass: &str| {
        let package = folder.join(at);
        std::fs::create_dir_all(&package).expect("a folder");
        file(&package, "package.xml", "<package><name>rods_of_two</name></package>");
        file(
            &package,
            "mass.xacro",
            &format!("<robot xmlns:xacro='http://ros.org/xacro'><xacro:property name='m' value='{mass}'/></robot>"),
        );
    };
    make("a/rods_of_two", "1");
    let robot = file(
        &folder,
        "arm.xacro",
        "<robot name='arm' xmlns:xacro='http://ros.org/xacro'><xacro:include filename='$(find rods_of_two)/mass.xacro'/>\
         <link name='l'><inertial><mass value='${m}'/></inertial></link></robot>",
    );
    let run = |more: &[&str]| {
        let output = mozzi(&[&["xacro", &robot][..], more].concat());
        [output.stdout, output.stderr].map(|text| String::from_utf8(text).expect("text"))
    };
    let [text, said] = run(&[]);
    assert!(text.contains("value=\"1\"") && !said.contains("rods_of_two"), "{text} {said}");
    make("b/rods_of_two", "22");
    let [text, said] = run(&[]);
    assert!(text.contains("value=\"1\"") && said.contains("the package `rods_of_two` is in "), "{text} {said}");
    let [text, said] = run(&[&format!("--package=rods_of_two={}", folder.join("b/rods_of_two").display())]);
    assert!(text.contains("value=\"22\"") && !said.contains("the package"), "{text} {said}");
}

#[test]
fn errors_point_into_the_files_that_the_user_wrote() {
    let folder = folder("xacro-errors");
    let (robot, package) = arm(&folder);
    let (code, why) = complaint(&["info", &robot]);
    assert!(code != 0 && why.contains("arm.urdf.xacro:4:") && why.contains("rods"), "{why}");
    let (code, why) = complaint(&["xacro", &robot, "length=0.9", &package]);
    assert!(code != 0 && why.contains("length=0.9") && why.contains(":="), "{why}");
    let said = mozzi(&["info", &robot, "--xacro-arg", "lenght:=0.9", &package]);
    let said = String::from_utf8_lossy(&said.stderr).into_owned();
    assert!(said.contains("the argument `lenght` is given and not used, expected some of: length"), "{said}");
    let plain = file(&folder, "plain.urdf", include_str!("../../mozzi-urdf/models/ur5.urdf"));
    let said = String::from_utf8(mozzi(&["info", &plain, "--xacro-arg", "length:=3"]).stderr).expect("text");
    assert!(said.contains("the argument `length` is given and not used: the file is no xacro"), "{said}");
    file(&folder.join("of rods"), "rod.xacro", &ROD.replace("value=\"${mass}\"", "value=\"${-mass}\""));
    let (code, why) = complaint(&["info", &robot, &package]);
    assert!(code != 0 && why.contains("rod.xacro:6:"), "{why}");
    let line: Vec<&str> = why.split_whitespace().filter(|word| *word != "│").collect(); // paths are long, lines are not
    let line = line.join(" ");
    assert!(line.contains(", from ") && line.contains("arm.urdf.xacro:6 (name = \"rod\""), "{why}");
    file(&folder.join("of rods"), "rod.xacro", &ROD.replace("${mass}", "${9**9**9}"));
    let (code, why) = complaint(&["xacro", &robot, &package]);
    assert!(code != 0 && why.contains("rod.xacro:6:"), "{why}");
}
