//! Each explanation is found from stored results of the real libraries, which [`record`] wrote to `tests/peers/`.
#![allow(clippy::unwrap_used)]

use crate::compare::Source;
use crate::compare::answer::{Answer, Robot, Workaround};
use crate::compare::bodies::Reason;
use crate::compare::cause::Cause;
use crate::compare::python::{self, Peer};
use crate::compare::question::Question;
use crate::compare::verdict::{Verdict, judge};
use mozzi::model::description::{Anchor, Constraint, JointKind};
use mozzi::{Description, SE3};
use std::path::{Path, PathBuf};

/// Model, library, the record.
const RECORDS: [(&str, Peer, &str); 13] = [
    ("doctor.urdf", Peer::Pinocchio, "doctor_pinocchio.json"),
    ("doctor.urdf", Peer::PinocchioMimic, "doctor_pinocchio_mimic.json"),
    ("doctor.urdf", Peer::MuJoCo, "doctor_mujoco.json"),
    ("massless.urdf", Peer::Pinocchio, "massless_pinocchio.json"),
    ("massless.urdf", Peer::MuJoCo, "massless_mujoco.json"),
    ("springs.xml", Peer::Pinocchio, "springs_pinocchio.json"),
    ("springs.xml", Peer::MuJoCo, "springs_mujoco.json"),
    ("floating.urdf", Peer::Pinocchio, "floating_pinocchio.json"),
    ("floating.urdf", Peer::MuJoCo, "floating_mujoco.json"),
    ("balls.xml", Peer::Pinocchio, "balls_pinocchio.json"),
    ("balls.xml", Peer::MuJoCo, "balls_mujoco.json"),
    ("free.xml", Peer::Pinocchio, "free_pinocchio.json"),
    ("free.xml", Peer::MuJoCo, "free_mujoco.json"),
];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers")
}

fn robot(file: &str) -> Description {
    mozzi_urdf::load(folder().join(file)).unwrap().description
}

fn question(file: &str) -> Question {
    let language = if file.ends_with(".xml") { "mjcf" } else { "urdf" };
    let path = folder().join(file).to_str().unwrap().to_string();
    Question::new(Source { name: file.into(), language, path: Some(path), text: None }, &robot(file), 3, 1).unwrap()
}

fn answer(record: &str) -> Answer {
    let text = std::fs::read_to_string(folder().join(record)).unwrap();
    Answer::read(&serde_json::from_str(&text).unwrap()).unwrap()
}

/// The verdict if mozzi read the file slightly differently.
fn judged(record: usize, edit: impl Fn(&mut Description)) -> (Verdict, Answer) {
    let (file, peer, record) = RECORDS[record];
    let (mut robot, answer) = (robot(file), answer(record));
    edit(&mut robot);
    let question = Question { names: question(file).names, ..question(file) };
    let from: &Robot = answer.robot.as_ref().unwrap();
    let verdict = judge(&robot, &question, &answer, from, peer == Peer::PinocchioMimic).unwrap();
    for found in &verdict.causes {
        let structure = matches!(found.cause, Cause::Mimics(_) | Cause::Held(_));
        assert!(structure || !verdict.after.agree() || !found.without.agree(), "{:?} makes no difference", found.cause);
    }
    (verdict, answer)
}

fn kinds(verdict: &Verdict) -> Vec<&'static str> {
    let kind = |cause: &Cause| match cause {
        Cause::Mimics(_) => "mimic joints",
        Cause::Held(_) => "held",
        Cause::Gravity { .. } => "gravity",
        Cause::Armature(_) => "armature",
        Cause::Damping(_) => "damping",
        Cause::Friction(_) => "friction",
        Cause::Stiffness(_) => "stiffness",
        Cause::Constraints(_) => "constraints",
        Cause::Force(name) if name == "spring" => "spring",
        Cause::Force(name) if name == "gravcomp" => "gravcomp",
        Cause::Force(_) => "fluid",
        Cause::Bodies(Reason::Balanced, _) => "balanced",
        Cause::Bodies(Reason::Bounded, _) => "bounded",
        Cause::Bodies(Reason::Dropped, _) => "dropped",
        Cause::Bodies(Reason::Shapes, _) => "shapes",
        Cause::Bodies(Reason::BothShapes, _) => "both shapes",
        Cause::Bodies(Reason::Scaled, _) => "scaled",
        Cause::Bodies(Reason::Unknown, _) => "unknown",
        Cause::Axes(_) => "axes",
    };
    verdict.causes.iter().map(|found| kind(&found.cause)).collect()
}

#[test]
fn every_record_is_explained_by_its_causes() {
    let expected: [&[&str]; 13] = [
        &["mimic joints", "damping", "friction"],
        &["damping", "friction"],
        &["mimic joints", "friction", "constraints", "balanced", "dropped", "shapes"],
        &[],
        &["gravity", "bounded"],
        &["damping", "friction", "stiffness"],
        &["friction", "constraints", "fluid", "gravcomp"],
        &[],
        &[],
        &["damping"],
        &[],
        &["held", "gravity"], // the library's reader takes only the first body of the world, and no <option>
        &[],
    ];
    for (k, expected) in expected.into_iter().enumerate() {
        let (verdict, answer) = judged(k, |_| {});
        assert_eq!(kinds(&verdict), expected, "{:?}", RECORDS[k]);
        assert!(verdict.is_explained() && verdict.after.worst() < 100.0 && verdict.first.is_none(), "{verdict:?}");
        assert_eq!(verdict.agrees(), expected.is_empty());
        for found in &verdict.causes {
            assert!(
                crate::compare::vocabulary::cause(&found.cause, &answer).contains(answer.library),
                "{:?}",
                found.cause
            );
        }
    }
    let workarounds: Vec<Workaround> =
        answer("massless_mujoco.json").attempts.iter().map(|(_, workaround)| *workaround).collect();
    assert_eq!(workarounds, [Workaround::Geometry, Workaround::Fixed, Workaround::Bound]);
    // the library has other springs
    let (verdict, _) = judged(6, |robot| robot.joints.iter_mut().for_each(|joint| joint.stiffness *= 2.0));
    assert!(kinds(&verdict).contains(&"spring") && verdict.is_explained(), "{verdict:?}");
    let (verdict, _) = judged(0, |_| {});
    assert!(verdict.order.is_some(), "Pinocchio sorts siblings by name");
}

#[test]
fn inertias_of_shapes_that_differ_slightly_are_named_with_their_difference() {
    let (mut robot, answer) = (robot("balls.xml"), answer("balls_mujoco.json"));
    let mut from = answer.robot.clone().unwrap();
    from.from_geometry = robot.links.iter().map(|link| link.name.clone()).collect();
    for link in &mut robot.links {
        let moments = (0..10).map(|k| if k < 4 { 1.0 } else { 1.0 + 3e-8 });
        let scaled: Vec<f64> = link.inertia.to_parameters().into_iter().zip(moments).map(|(x, y)| x * y).collect();
        link.inertia = mozzi::SpatialInertia::from_parameters(scaled.try_into().unwrap());
    }
    let causes = crate::compare::bodies::suspects(&robot, &answer, &from).unwrap();
    let [cause @ Cause::Bodies(Reason::BothShapes, _)] = causes.as_slice() else { panic!("{causes:?}") };
    let words = crate::compare::vocabulary::cause(cause, &answer);
    let expected = "both compute inertias from the shapes (inertiafromgeom), with a difference of ";
    let (start, rest) = words.split_once(expected).expect(&words);
    let (size, rest) = rest.split_once(" of the moments of `").expect(&words);
    let size: f64 = size.parse().expect(&words);
    assert!(start == "inertia, here and in MuJoCo: " && (3e-8..3e-6).contains(&size) && rest.contains('`'), "{words}");
}

#[test]
fn a_free_base_is_compared_with_its_own_rows() {
    let heavier = |robot: &mut Description| {
        let body = robot.links.iter_mut().find(|link| link.name == "body").unwrap();
        body.inertia = body.inertia * 1.5;
    };
    for record in [7, 8] {
        let (verdict, _) = judged(record, |_| {});
        assert!(verdict.agrees());
        let (verdict, _) = judged(record, heavier);
        let first = verdict.first.as_ref().unwrap();
        assert_eq!((first.quantity, first.joints[0].as_str()), ("M", "base.vx"), "{first:?}");
    }
}

#[test]
fn balls_and_free_joints_are_compared_number_by_number() {
    for record in [9, 10] {
        let (verdict, _) = judged(record, |robot| {
            let lower = robot.joints.iter_mut().find(|joint| joint.name == "elbow").unwrap();
            lower.origin.p.0[1] += 1e-3;
        });
        let first = verdict.first.as_ref().unwrap();
        assert_eq!((first.quantity, &first.joints[..]), ("M", &["shoulder.wx".to_string(), "shoulder.wx".into()][..]));
    }
    let (verdict, _) = judged(12, |robot| robot.joints.iter_mut().for_each(|joint| joint.damping *= 2.0));
    assert_eq!(kinds(&verdict), ["damping"], "of `fly`");
    assert!(verdict.before.0[..3].iter().all(|error| *error < 10.0) && !verdict.before.agree(), "{verdict:?}");
    let (verdict, answer) = judged(11, |_| {});
    let there: Vec<&str> = verdict
        .causes
        .iter()
        .flat_map(|found| match &found.cause {
            Cause::Held(names) => names.iter().map(String::as_str).collect(),
            _ => Vec::new(),
        })
        .collect();
    assert_eq!(there, ["fly", "hip"]);
    let stone = answer.robot.as_ref().unwrap().constants.joint("stone:free").unwrap();
    assert_eq!((stone.called.as_str(), stone.nv), ("stone_free", 6));
}

#[test]
fn numbers_of_joints_and_of_the_world() {
    let (verdict, answer) = judged(3, |robot| {
        robot.gravity = [0.0, 1.0, -9.0];
        robot.joints[2].armature = 0.25;
    });
    assert_eq!(kinds(&verdict), ["gravity", "armature"]);
    assert!(verdict.is_explained());
    let words = crate::compare::vocabulary::cause(&verdict.causes[1].cause, &answer);
    assert_eq!(words, "armature (rotor inertia), here and in Pinocchio: `tilt` 0.25 / 0");
}

#[test]
fn springs_of_a_urdf_which_neither_library_reads() {
    let stiff = |robot: &mut Description| {
        let joint = robot.joints.iter_mut().find(|joint| joint.name == "tilt").unwrap();
        (joint.stiffness, joint.spring_reference) = (4.0, 0.2);
    };
    for (record, causes, words) in [
        (3, &["stiffness"][..], "Pinocchio has none: `tilt` 4 / 0"),
        (4, &["gravity", "stiffness", "bounded"], "MuJoCo reads none from this file: `tilt` 4 / 0"),
    ] {
        let (verdict, answer) = judged(record, stiff);
        assert_eq!(kinds(&verdict), causes);
        assert!(verdict.is_explained(), "{verdict:?}");
        let springs = verdict.causes.iter().find(|found| matches!(found.cause, Cause::Stiffness(_))).unwrap();
        let said = crate::compare::vocabulary::cause(&springs.cause, &answer);
        assert_eq!(said, format!("springs: τ contains k(θ − θ₀) here, {words}"));
    }
}

#[test]
fn joints_that_move_on_one_side_only() {
    let mut whole = robot("massless.urdf");
    let mut fixed = whole.clone();
    fixed.joints[1].kind = JointKind::Fixed;
    // without the joint it holds nothing
    whole.constraints.push(Constraint::weld("grip", Anchor::world(SE3::identity()), "cross"));
    // the joint is missing on each side in turn; the library's numbers are mozzi's results for its robot
    for (here, there) in [(&whole, &fixed), (&fixed, &whole)] {
        let source = question("massless.urdf").source;
        let question = Question::new(source, here, 3, 1).unwrap();
        let mut answer = answer("massless_pinocchio.json");
        let from = answer.robot.as_mut().unwrap();
        from.side = crate::compare::numbers::Side::of(there, &question, "Pinocchio").unwrap();
        from.constants = crate::compare::constants::Constants::of(there).unwrap();
        let verdict = judge(here, &question, &answer, answer.robot.as_ref().unwrap(), false).unwrap();
        assert!(verdict.is_explained() && !verdict.agrees(), "{verdict:?}");
        if here.joints[1].kind == JointKind::Fixed {
            assert_eq!((kinds(&verdict).len(), &verdict.extra[..]), (0, &[("pan".to_string(), 1)][..]));
        } else {
            assert_eq!((kinds(&verdict), verdict.extra.len()), (vec!["held"], 0));
            assert!(!verdict.before.agree());
        }
    }
}

#[test]
fn a_place_without_a_reason_is_no_explanation() {
    let (verdict, answer) = judged(3, |robot| robot.links[3].inertia = robot.links[3].inertia.map(|x| 1.01 * x));
    assert_eq!(kinds(&verdict), ["unknown"]);
    assert!(verdict.after.agree() && !verdict.is_explained());
    let words = crate::compare::vocabulary::cause(&verdict.causes[0].cause, &answer);
    assert!(words.contains("`arm` 2.02 / 2 kg"), "{words}");
    let (verdict, _) = judged(3, |robot| robot.joints[2].origin.p.0[0] += 0.1);
    assert!(kinds(&verdict).contains(&"axes") && !verdict.is_explained(), "{verdict:?}");
}

#[test]
fn what_nothing_explains_is_named() {
    let mut answer = answer("massless_pinocchio.json");
    let from = answer.robot.as_mut().unwrap();
    from.side.states[1].M[(1, 0)] += 0.5;
    let (robot, question) = (robot("massless.urdf"), question("massless.urdf"));
    let from = answer.robot.as_ref().unwrap();
    let verdict = judge(&robot, &question, &answer, from, false).unwrap();
    let entry = verdict.first.as_ref().unwrap();
    assert!(!verdict.is_explained());
    assert_eq!((entry.quantity, entry.state, entry.joints.join(" ")), ("M", 1, "tilt pan".to_string()));
    assert!((entry.theirs - entry.mozzi - 0.5).abs() < 1e-12);
}

#[test]
fn states_are_the_same_everywhere_and_within_the_limits() {
    let (robot, question) = (robot("doctor.urdf"), question("doctor.urdf"));
    for state in &question.states {
        let at = |name: &str| state.theta[question.names.iter().position(|known| known == name).unwrap()];
        assert!((at("finger_right") - (0.1 - 0.5 * at("finger_left"))).abs() < 1e-15);
        for joint in robot.joints.iter().filter(|joint| joint.mimic.is_none()) {
            if let Some([low, high]) = joint.limits.position {
                assert!(low < at(&joint.name) && at(&joint.name) < high, "{}", joint.name);
            }
        }
    }
    assert_ne!(question.states[0].theta, question.states[1].theta);
}

#[test]
fn answers_that_are_none() {
    let good: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(folder().join("massless_pinocchio.json")).unwrap()).unwrap();
    let broken = |pointer: &str, value: serde_json::Value| {
        let mut answer = good.clone();
        *answer.pointer_mut(pointer).unwrap() = value;
        Answer::read(&answer).is_none()
    };
    assert!(!broken("/version", serde_json::Value::Null));
    assert!(broken("/states/0/M", serde_json::json!([[1.0]])));
    assert!(broken("/joints/1/parent", 1.into()));
    assert!(broken("/joints/0/axes", "z".into()));
    assert!(broken("/library", serde_json::Value::Null));
    assert!(!broken("/states/0/g", serde_json::json!([null, 0.0])), "NaN is a number that differs");
}

/// `MOZZI_PYTHON=… cargo test -p mozzi-report -- --ignored record` calls the libraries again.
#[test]
#[ignore = "writes the records; needs Python with pin and mujoco"]
fn record() {
    let python = std::env::var("MOZZI_PYTHON").unwrap();
    for (file, peer, record) in RECORDS {
        let value = python::raw(Path::new(&python), &question(file), peer).unwrap();
        let text = serde_json::to_string(&value).unwrap().replace(folder().to_str().unwrap(), "tests/peers");
        std::fs::write(folder().join(record), text + "\n").unwrap();
    }
}
