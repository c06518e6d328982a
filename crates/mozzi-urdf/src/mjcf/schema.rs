//! Every word of MuJoCo's schema is computed, refused by name, or listed as ignored.

use super::vocabulary;
use crate::urdf::vocabulary::Vocabulary;
use crate::{Diagnostic, parse};

/// Made by `oracles/make_schema.py`: a path and its attributes on each line.
const SCHEMA: &str = include_str!("../../../../oracles/mjcf_schema.txt");

/// The known words at a path, if the elements there are read.
fn vocabulary(path: &str) -> Option<&'static Vocabulary> {
    Some(match path {
        "mujoco" => &vocabulary::MUJOCO,
        "mujoco/compiler" => &vocabulary::COMPILER,
        "mujoco/option" => &vocabulary::OPTION,
        "mujoco/option/flag" => &vocabulary::FLAG,
        "mujoco/default" => &vocabulary::DEFAULT,
        "mujoco/body" => &vocabulary::BODY,
        "mujoco/body/inertial" => &vocabulary::INERTIAL,
        "mujoco/body/attach" => &vocabulary::ATTACH,
        "mujoco/body/freejoint" => &vocabulary::FREE_JOINT,
        "mujoco/body/joint" | "mujoco/default/joint" => &vocabulary::JOINT,
        "mujoco/body/geom" | "mujoco/default/geom" => &vocabulary::GEOM,
        "mujoco/body/site" | "mujoco/default/site" => &vocabulary::SITE,
        "mujoco/equality/joint" | "mujoco/default/equality" => &vocabulary::COUPLING,
        "mujoco/equality/tendon" => &vocabulary::TENDON_COUPLING,
        "mujoco/equality/connect" => &vocabulary::CONNECT,
        "mujoco/equality/weld" => &vocabulary::WELD,
        "mujoco/keyframe" => &vocabulary::KEYFRAME,
        "mujoco/keyframe/key" => &vocabulary::KEY,
        "mujoco/tendon/spatial" | "mujoco/tendon/fixed" | "mujoco/default/tendon" => &vocabulary::TENDON,
        _ => return None,
    })
}

/// Elements that are reported with all their contents: the path, an example, and the code.
const TOLD: [(&str, &str, &str); 20] = [
    ("mujoco/compiler/lengthrange", "<compiler><§/></compiler>", "ignored_attribute"),
    ("mujoco/size", "<§/>", "ignored_element"),
    ("mujoco/statistic", "<§/>", "ignored_element"),
    ("mujoco/visual", "<§/>", "ignored_element"),
    ("mujoco/default/", "<default><§/></default>", "ignored_attribute"),
    ("mujoco/extension", "<§/>", "ignored_element"),
    ("mujoco/asset", "<§/>", "ignored_element"),
    ("mujoco/body/geom/plugin", "<worldbody><body><geom size='1'><§/></geom></body></worldbody>", "ignored_element"),
    ("mujoco/body/camera", "<worldbody><body><§/></body></worldbody>", "ignored_element"),
    ("mujoco/body/light", "<worldbody><body><§/></body></worldbody>", "ignored_element"),
    ("mujoco/body/plugin", "<worldbody><body><§/></body></worldbody>", "ignored_force"),
    ("mujoco/body/flexcomp", "<worldbody><body><§/></body></worldbody>", "unsupported_element"),
    ("mujoco/deformable/flex", "<deformable><§/></deformable>", "unsupported_element"),
    ("mujoco/deformable", "<§/>", "ignored_element"),
    ("mujoco/contact", "<§/>", "ignored_element"),
    ("mujoco/tendon/", "<tendon><§/></tendon>", "ignored_element"),
    ("mujoco/equality/", "<equality><§/></equality>", "unsupported_equality"),
    ("mujoco/actuator", "<§/>", "ignored_element"),
    ("mujoco/sensor", "<§/>", "ignored_element"),
    ("mujoco/custom", "<§/>", "ignored_element"),
];

/// Errors or warnings of a model.
fn said(inside: &str) -> Vec<Diagnostic> {
    match parse("a.xml", format!("<mujoco>{inside}</mujoco>")) {
        Ok(robot) => [robot.warnings, robot.unused].concat(),
        Err(error) => error.diagnostics().to_vec(),
    }
}

/// A model with an attribute on an element at a path.
fn model(path: &str, attribute: &str) -> String {
    let body = |inside: &str, behind: &str| format!("<worldbody><body>{inside}</body></worldbody>{behind}");
    match path {
        "mujoco/compiler" => format!("<compiler {attribute}/>"),
        "mujoco/option" => format!("<option {attribute}/>"),
        "mujoco/option/flag" => format!("<option><flag {attribute}/></option>"),
        "mujoco/body" => format!("<worldbody><body {attribute}/></worldbody>"),
        "mujoco/body/inertial" => {
            let rest = if attribute.starts_with("mass") { "" } else { "mass='1'" };
            body(&format!("<joint/><inertial {rest} {attribute}/>"), "")
        }
        "mujoco/body/freejoint" => body(&format!("<freejoint {attribute}/><geom size='1'/>"), ""),
        "mujoco/body/joint" => body(&format!("<joint {attribute}/><geom size='1'/>"), ""),
        "mujoco/body/geom" => {
            let rest = if attribute.starts_with("type") { "" } else { "type='capsule'" };
            body(&format!("<joint/><geom {rest} {attribute}/>"), "")
        }
        "mujoco/body/site" => body(&format!("<site {attribute}/>"), ""),
        "mujoco/equality/joint" => body(
            "<joint name='a'/><joint name='b'/><geom size='1'/>",
            &format!("<equality><joint joint1='a' joint2='b' {attribute}/></equality>"),
        ),
        "mujoco/equality/tendon" => body(
            "<joint name='a'/><geom size='1'/>",
            &format!(
                "<tendon><fixed name='t'><joint joint='a' coef='1'/></fixed></tendon>\
                 <equality><tendon tendon1='t' {attribute}/></equality>"
            ),
        ),
        "mujoco/equality/connect" | "mujoco/equality/weld" => {
            let tag = path.rsplit('/').next().unwrap_or_default();
            let rest = if attribute.starts_with("anchor") { "" } else { "anchor='1 0 0'" };
            body(
                "<joint/><geom size='1'/></body><body name='b'><joint/><geom size='1'/>",
                &format!("<equality><{tag} body1='b' {rest} {attribute}/></equality>"),
            )
        }
        "mujoco/keyframe/key" => format!("<keyframe><key {attribute}/></keyframe>"),
        _ => String::new(),
    }
}

/// Attributes whose values are names.
const NAMES: [&str; 15] = [
    "name",
    "class",
    "childclass",
    "body1",
    "body2",
    "joint1",
    "joint2",
    "site1",
    "site2",
    "tendon1",
    "tendon2",
    "model",
    "mesh",
    "assetdir",
    "meshdir",
];

#[test]
fn every_word_is_in_a_class() {
    let (mut words, mut listed, mut read) = (0, 0, 0);
    for line in SCHEMA.lines().filter(|line| !line.starts_with('#')) {
        let mut parts = line.split(' ');
        let path = parts.next().expect("a path");
        let (parent, name) = path.rsplit_once('/').unwrap_or(("", path));
        if let Some(parent) = vocabulary(parent) {
            // a top-level body is in `<worldbody>`
            let name = if path == "mujoco/body" { "worldbody" } else { name };
            let is_known = [parent.once, parent.many, parent.silent].iter().any(|known| known.contains(&name));
            assert!(is_known, "{path}: the element is not known");
        }
        let Some(known) = vocabulary(path) else {
            // an element reported as a whole covers its descendants; the relevant defaults of actuators are read
            let is_actuator =
                path.strip_prefix("mujoco/default/").is_some_and(|tag| vocabulary::ACTUATORS.contains(&tag));
            let told = TOLD.iter().any(|(start, ..)| path.starts_with(start));
            let is_section = ["mujoco/tendon", "mujoco/equality"].contains(&path);
            assert!(told || is_actuator || is_section, "{path} is in no class");
            continue;
        };
        for attribute in parts {
            words += 1;
            let is_whole = known.silent.contains(&attribute);
            assert!(
                known.attributes.contains(&attribute) || known.listed.contains(&attribute) || is_whole,
                "{path}: {attribute} is in no class"
            );
            if known.listed.contains(&attribute) {
                listed += 1;
                let quoted = format!("`{attribute}`");
                let found = said(&model(path, &format!("{attribute}='0'")));
                let is_listed =
                    |d: &Diagnostic| d.code() == "mozzi::mjcf::ignored_attribute" && d.message().contains(&quoted);
                assert!(path.contains("/default") || found.iter().any(is_listed), "{path}: {attribute}: {found:?}");
            } else if known.attributes.contains(&attribute)
                && !NAMES.contains(&attribute)
                && !model(path, "").is_empty()
            {
                // an attribute that is read is reported if it is invalid
                read += 1;
                let found = said(&model(path, &format!("{attribute}='?'")));
                assert!(found.iter().any(|d| d.excerpt() == "?"), "{path}: {attribute} is not read: {found:?}");
            }
        }
    }
    assert!(words > 300 && listed > 100 && read > 60, "{words} {listed} {read}");
}

#[test]
fn what_is_told_as_a_whole_is_told() {
    for (path, model, code) in TOLD {
        let line = |line: &&str| line.split(' ').next().is_some_and(|known| known.starts_with(path));
        let mut lines = SCHEMA.lines().filter(line).peekable();
        assert!(lines.peek().is_some(), "{path} is not in the schema");
        for line in lines {
            let known = line.split(' ').next().unwrap_or_default();
            let is_child = known.matches('/').count() == path.matches('/').count();
            let is_told_before =
                TOLD.iter().find(|(start, ..)| known.starts_with(start)).map(|told| told.0) != Some(path);
            let tag = known.rsplit('/').next().unwrap_or_default();
            let is_read = vocabulary(known).is_some() && !known.starts_with("mujoco/tendon/")
                || vocabulary::ACTUATORS.contains(&tag);
            if !is_child || is_told_before || is_read && path != "mujoco/actuator" {
                continue;
            }
            let found = said(&model.replace('§', tag));
            let full = format!("mozzi::mjcf::{code}");
            assert!(found.iter().any(|d| d.code() == full), "{known}: expected {code}, found {found:?}");
        }
    }
}
