//! Real robots: the embedded ones, and, if `MOZZI_ROBOTS` names the folder of the package `example-robot-data`, all of
//! that package.

use crate::files;

use files::urdf_files;
use mozzi_urdf::{LoadError, Policy, Severity, embedded, load, load_with, open};
use std::path::Path;

#[test]
fn the_robots_that_mozzi_brings_along_are_flawless() {
    for (name, n) in [
        ("anymal", 12),
        ("double_pendulum", 2),
        ("furuta_pendulum", 2),
        ("panda", 8),
        ("two_link_planar", 2),
        ("ur5", 6),
    ] {
        let robot = open(name).expect(name);
        assert!(robot.warnings.is_empty(), "{name}: {:#?}", robot.warnings);
        assert_eq!(robot.build().expect(name).n(), n, "{name}");
    }
    assert_eq!(embedded::names().len(), 6);
}

#[test]
fn what_is_not_there_is_said_so() {
    let message = open("ur6").expect_err("no such robot").to_string();
    assert_eq!(
        message,
        "`ur6` is neither a file nor one of the embedded robots `anymal`, `double_pendulum`, `furuta_pendulum`, `panda`, `two_link_planar`, `ur5`; did you mean `ur5`?"
    );
    assert!(matches!(load("no/such/file.urdf"), Err(LoadError::File { .. })));
    assert!(matches!(load("."), Err(LoadError::File { .. })), "a folder");
}

/// Each published robot loads and becomes a model, except three, which are refused for their errors.
#[test]
fn published_robots() {
    let Ok(folder) = std::env::var("MOZZI_ROBOTS") else {
        eprintln!("skipped: MOZZI_ROBOTS does not name the folder of example-robot-data");
        return;
    };
    let mut files = Vec::new();
    urdf_files(Path::new(&folder), &mut files);
    assert!(files.len() > 50, "only {} files under {folder}", files.len());
    let refused = [
        ("alex_psyonic_hands.urdf", "unknown_joint", 8), // fingers follow `index_q1`; the joint is `Left_index_q1`
        ("romeo_laas_small.urdf", "indefinite_inertia", 3), // trunk and hips
        ("ur3.urdf", "no_links", 2),                     // no name and no links: a xacro file's empty result
    ];
    for file in files {
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let expected = refused.iter().find(|(known, ..)| *known == name);
        match (load(&file), expected) {
            (Ok(robot), None) => {
                assert!(robot.warnings.iter().all(|warning| warning.severity() == Severity::Warning));
                let is_flawless = robot.warnings.is_empty();
                assert_eq!(load_with(&file, Policy::Strict).is_ok(), is_flawless, "{name}");
                let model = robot.build().expect(&name);
                assert!(model.n() <= model.moving_links(), "{name}");
            }
            (Err(error), Some(&(_, code, count))) => {
                assert_eq!(error.errors().count(), count, "{error}");
                assert!(error.errors().any(|error| error.code().ends_with(code)), "{error}");
            }
            (Ok(_), Some((_, code, _))) => panic!("{name} loads, expected {code}"),
            (Err(error), None) => panic!("{error}"),
        }
    }
}
