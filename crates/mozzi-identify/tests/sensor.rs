//! Torques that were measured behind the gears, but taken for the motors'.

use crate::common;

use common::{cases, motion, with_forces};
use mozzi::random::Random;
use mozzi_identify::judgement::judge;
use mozzi_identify::signals::{Cutoff, Filter};
use mozzi_identify::{Choice, Columns, Log, Options, Sensor, identify};

fn findings(model: &mozzi::Model, log: &Log, sensor: Sensor, cutoff: Cutoff) -> Vec<String> {
    let filter = Filter { cutoff, ..Filter::default() };
    let options = Options { choice: Choice::all(sensor), filter, ..Options::default() };
    let found = identify(model, std::slice::from_ref(log), &options, &|| false).expect("an identification");
    let judged = judge(&found, std::slice::from_ref(log)).expect("a judgement");
    let of_sensor = judged.findings.iter().filter(|finding| finding.code == "behind_the_gears");
    of_sensor.map(|finding| finding.text.clone()).collect()
}

/// A UR5 with friction, and with this armature.
fn simulated(armature: f64) -> (mozzi::Model, Log) {
    let model = mozzi_urdf::open("ur5").expect("embedded").description.build().expect("sound");
    let choice = Choice::all(Sensor::Motor);
    let columns = Columns::new(&model, choice.clone()).expect("columns");
    let mut x = columns.prior();
    for (k, unknown) in columns.unknowns.iter().enumerate().filter(|(_, unknown)| unknown.kind.is_positive()) {
        x[k] = if unknown.name.ends_with(".armature") { armature } else { 1.0 };
    }
    let log = motion(&model, 20.0, 100.0, 1.0, 3);
    let log = with_forces(&log, &model, &choice, &x, &[0.3, 0.3, 0.2, 0.05, 0.05, 0.05], &mut Random(5));
    (model, log)
}

#[test]
fn torques_behind_the_gears_are_noticed() {
    let (model, log) = simulated(0.0);
    let found = findings(&model, &log, Sensor::Motor, Cutoff::None);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("`--torque link` gives the robot no armature"), "{}", found[0]);
    assert!(findings(&model, &log, Sensor::Link, Cutoff::None).is_empty());
    let (model, log) = simulated(0.3);
    let found = findings(&model, &log, Sensor::Motor, Cutoff::None);
    assert!(found.is_empty(), "{found:?}");
}

#[test]
fn of_real_logs_the_ones_of_link_sensors_are_noticed() {
    for case in cases() {
        let found = findings(&case.model, &case.log, Sensor::Motor, Cutoff::Hz(case.cutoff));
        eprintln!("{}: {found:?}", case.name);
        // the Panda's sensors are behind its gears, the UR10's torques are its motors' currents
        assert_eq!(found.len(), usize::from(case.name == "Panda"), "{}: {found:?}", case.name);
    }
}
